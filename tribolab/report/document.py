"""Everything that the report says, as plain data: report.json, and what the page is made from."""

from __future__ import annotations

import datetime as dt
import json
import platform
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.provenance import sha256_of_file
from tribolab.report.judgement import THRESHOLDS, is_bad
from tribolab.report.wording import SYMBOLS, UNITS, plain_value
from tribolab.words import many, span

if TYPE_CHECKING:
    from tribolab.campaign.outcome import CurveOutcome, Outcome, RunOutcome
    from tribolab.report.run_summary import RunSummary

SCHEMA_VERSION = "1.3"
_LIBRARIES = ["numpy", "scipy", "pandas", "xarray", "netCDF4", "matplotlib"]


def labels(what: RunOutcome | CurveOutcome) -> dict[str, Any]:
    """Return surface, medium and nominal load, as every table and record names them."""
    return {
        "surface": what.surface,
        "medium": what.medium,
        "nominal_normal_force_N": what.normal_force,
    }


def report_document(
    outcome: Outcome,
    summaries: dict[str, RunSummary],
    curves: Sequence[dict[str, Any]],
    figures: Sequence[dict[str, str]],
    findings: Sequence[dict[str, str]],
) -> dict[str, Any]:
    """Return the whole report as plain data, ready for JSON.

    Parameters
    ----------
    outcome
        What the campaign came to.
    summaries
        Of the runs that are done, by name.
    curves
        Measured curves with their points.
    figures
        Figures over several runs: file, kind, caption, alt.
    findings
        All findings, gravest first.
    """
    runs = [_run(run, summaries.get(run.name)) for run in outcome.runs]
    document = {
        "schema_version": SCHEMA_VERSION,
        "made_at": dt.datetime.now(dt.UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "campaign": _campaign(outcome.campaign),
        "verdict": verdict(runs, [one.name for one in outcome.surfaces if one.quality in _BAD]),
        "runs": runs,
        "curves": list(curves),
        "figures": list(figures),
        "thresholds": THRESHOLDS,
        "findings": list(findings),
        "sources": [
            {"file": file, "sha256": checksum, "bytes": size}
            for file, checksum, size in outcome.sources
        ],
        "versions": versions(),
    }
    return plain_value(document)


def verdict(runs: Sequence[dict[str, Any]], rejected_scans: Sequence[str] = ()) -> dict[str, Any]:
    """Return what came of the campaign in one sentence and its numbers.

    Parameters
    ----------
    runs
        As in report.json.
    rejected_scans
        Surfaces whose scans failed their checks.
    """
    done = [run for run in runs if run["status"] == "done"]
    failed = len(runs) - len(done)
    sound = [run for run in done if not is_bad(run)]
    rejected = len(done) - len(sound)
    segments = sum(run["segments_found"] for run in done)
    quantities = {run["quantity"] for run in sound if run["value_min"] is not None}
    kept = sum(bool(run.get("kept")) for run in done)
    status = "incomplete" if done else "nothing"
    if done and not (failed or rejected or rejected_scans or kept):
        status = "complete"
    parts = [f"{len(done)} of {many(len(runs), 'run')} done"]
    if failed:
        parts.append(f"{failed} failed")
    if kept:
        parts.append(f"{kept} kept from before")
    if rejected:
        parts.append(f"{rejected} rejected by {'its' if rejected == 1 else 'their'} checks")
    if rejected_scans:
        parts.append(f"scans of {', '.join(rejected_scans)} rejected")
    parts.append(many(segments, "segment"))
    ranges = {}
    for name in ("friction_coefficient", "half_loop", "friction_force"):
        if name in quantities:
            mine = [run for run in sound if run["quantity"] == name]
            bounds = [run[key] for run in mine for key in ("value_min", "value_max")]
            known = [b for b in bounds if b is not None]
            ranges[name] = {"min": min(known), "max": max(known)}
            parts.append(f"{SYMBOLS[name]} from {span(known, UNITS[name])}")
    return {
        "status": status,
        "text": "; ".join(parts),
        "runs": len(runs),
        "done": len(done),
        "failed": failed,
        "rejected": rejected,
        "kept": kept,
        "reused": sum(run["reused"] for run in runs),
        "segments": segments,
        "ranges": ranges,
    }


_BAD = ("fail", "error")

# What a run has in the report when it failed: the same keys, nothing in them.
_EMPTY: dict[str, Any] = {
    "quantity": None,
    "value_min": None,
    "value_max": None,
    "relative_scatter": None,
    "relative_drift": None,
    "unsteady_segments": 0,
    "stick_slip": None,
    "sliding_speed_min_m_s": None,
    "sliding_speed_max_m_s": None,
    "offset": "",
    "trim": None,
    "position_range_m": None,
    "velocity_source": "",
    "instrument": "",
    "quality": "",
    "checks": [],
    "recorded_at": "",
    "duration_s": None,
    "samples": 0,
    "signals": [],
    "columns_not_used": [],
    "clock_shift_s": None,
    "clock_shift_uncertainty_s": None,
    "clock_shift_source": "",
    "history": "",
    "highlights": [],
    "omitted": [],
    "segments": [],
    "figures": [],
    "flagged": [],
}


def _run(run: RunOutcome, summary: RunSummary | None) -> dict[str, Any]:
    facts = _EMPTY | (summary.facts if summary else {})
    return {
        "name": run.name,
        "status": run.status,
        "reason": run.reason,
        "error": run.error,
        **labels(run),
        "files": list(run.files),
        "data_file": run.data_file,
        "reused": run.reused,
        "kept": run.kept,
        "seconds": run.seconds,
        "segments_found": len(facts["segments"]),
        **facts,
    }


def _campaign(campaign: Any) -> dict[str, Any]:
    file = Path(campaign.file)
    there = file.is_file()
    return {
        "name": campaign.name,
        "file": file.name,
        "sha256": sha256_of_file(file) if there else "",
        "text": file.read_text(encoding="utf-8-sig") if there else "",
    }


def versions() -> dict[str, str]:
    """Return the versions of Python, of tribolab and of what computes for it."""
    from tribolab.version import __version__

    found = {"tribolab": __version__, "python": platform.python_version()}
    for name in _LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:  # e.g. in a bundle without package metadata
            found[name] = "unknown"
    return found


def write_json(document: dict[str, Any], path: Path) -> None:
    """Write the report as strict JSON: UTF-8, no NaN."""
    text = json.dumps(document, ensure_ascii=False, indent=1, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")
