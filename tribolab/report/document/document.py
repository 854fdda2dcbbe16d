"""Report of a campaign as plain data: verdict, findings and records, for report.json and page."""

from __future__ import annotations

import datetime as dt
import json
import platform
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter

from tribolab.core.provenance import sha256_of_file
from tribolab.core.untyped import Json
from tribolab.core.wording import load_label, many, span
from tribolab.friction.running_in.kinds import NONE
from tribolab.records.judgement import THRESHOLDS, is_bad, is_odd, status_word
from tribolab.records.parts import Row, number_of
from tribolab.records.verdict import is_ramp, uncertain_mean
from tribolab.records.wording import SYMBOLS, UNITS, plain_value
from tribolab.report.document.schema import (
    CampaignFile,
    CampaignVerdict,
    Extent,
    ReportedCurve,
    ReportedFinding,
    ReportedMode,
    ReportedModel,
    ReportedSurface,
    ReportHead,
    SourceFile,
)

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.store.outcome import Outcome
    from tribolab.records.models.joint_record import JointRecord
    from tribolab.records.part_records import FigureRecord
    from tribolab.records.parts import CurveOutcome, Notice, RunOutcome, SurfaceOutcome

_BY_HAND = ("rejected", "accepted")  # manual decisions on a run
_HEAD = TypeAdapter(ReportHead)
_INSTRUMENTS = 3  # most instruments with separate ranges in the headline
_LIBRARIES = ["numpy", "scipy", "pandas", "xarray", "netCDF4", "matplotlib"]


def labels(what: RunOutcome | CurveOutcome) -> Row:
    """Return surface, medium and nominal load as a row with the column names of all tables."""
    return {
        "surface": what.surface,
        "medium": what.medium,
        "nominal_normal_force_N": load_label(what.normal_force),
    }


def report_document(head: ReportHead) -> Json:
    """Return the content of report.json without runs as dictionaries, lists and numbers."""
    return plain_value(_HEAD.dump_python(head, by_alias=True))


def report_head(
    outcome: Outcome,
    runs: Sequence[Mapping[str, Any]],
    findings: Sequence[Notice],
    *,
    curves: Iterable[ReportedCurve],
    surfaces: Iterable[ReportedSurface],
    modes: Iterable[ReportedMode],
    models: Iterable[ReportedModel],
    joints: Iterable[JointRecord],
    figures: Mapping[str, Sequence[FigureRecord]],
) -> ReportHead:
    """Return the content of report.json except the runs.

    Parameters
    ----------
    outcome
        Outcome of the campaign.
    runs
        Result of `brief_run` for each run.
    findings
        All findings, most severe first.
    curves, surfaces, modes, models, joints
        Records from `tribolab.report.document.parts`, and joint fits.
    figures
        Figures by section.
    """
    rejected = [surface.name for surface in outcome.surfaces if surface.quality in _BAD]
    curves = tuple(curves)
    uncertain = sum(uncertain_mean(curve.points) is not None for curve in curves)
    return ReportHead(
        made_at=dt.datetime.now(dt.UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        campaign=_campaign(outcome.campaign),
        verdict=verdict(
            runs,
            rejected,
            len(outcome.lost_decisions),
            uncertain,
            [
                mu
                for curve in curves
                for row in curve.points
                if (mu := number_of(row, "friction_coefficient")) is not None
            ],
        )
        if outcome.campaign.run
        else _scan_verdict(outcome.surfaces, rejected),
        thresholds=THRESHOLDS,
        findings=tuple(ReportedFinding(*finding) for finding in findings),
        sources=tuple(SourceFile(*source) for source in outcome.sources),
        versions=versions(),
        curves=curves,
        surfaces=tuple(surfaces),
        sliding_mode=tuple(modes),
        models=tuple(models),
        joint_fits=tuple(joints),
        figures=tuple(figures["figures"]),
        surface_figures=tuple(figures["surface_figures"]),
        model_figures=tuple(figures["model_figures"]),
        sliding_figures=tuple(figures["sliding_figures"]),
    )


def _scan_verdict(surfaces: Sequence[SurfaceOutcome], rejected: Sequence[str]) -> CampaignVerdict:
    """Return the verdict on a campaign with scans but without runs."""
    scanned = [surface for surface in surfaces if surface.files]
    done = sum(surface.done for surface in scanned)
    suspect = sum(surface.quality == "suspect" for surface in scanned if surface.done)
    failed = [surface.name for surface in scanned if set(_BAD) & set(surface.objections)]
    files = sum(len(surface.files) for surface in scanned)
    text = f"{many(files, 'scan')}, {done} of {many(len(scanned), 'surface')} usable"
    text += f" ({suspect} suspect)" * bool(suspect)
    if rejected:
        text += f"; scans of {', '.join(rejected)} rejected"
    elif failed:
        text += f"; a scan of {', '.join(failed)} rejected"
    sound = done == len(scanned) and not rejected and not failed
    status = "complete" if sound else "incomplete"
    status = status if done else "nothing"
    return replace(verdict((), rejected), status=status, text=text, suspect=suspect)


def verdict(
    runs: Sequence[Mapping[str, Any]],
    rejected_scans: Sequence[str] = (),
    lost_decisions: int = 0,
    uncertain: int = 0,
    means: Sequence[float] = (),
) -> CampaignVerdict:
    """Return the verdict on a campaign: its status, a sentence, and the numbers in it.

    Parameters
    ----------
    runs
        As in report.json.
    rejected_scans
        Surfaces whose scans failed their checks.
    lost_decisions
        Number of decisions on runs that do not exist.
    uncertain
        Number of conditions whose repeats leave their mean uncertain.
    means
        Friction coefficients of the measured curves: means of repeats.
    """
    done = [run for run in runs if run["status"] == "done"]
    failed = len(runs) - len(done)
    sound = [run for run in done if not is_bad(run)]
    by_hand = {word: sum(run["quality"] == word for run in done) for word in _BY_HAND}
    rejected = len(done) - len(sound) - by_hand["rejected"]
    segments = sum(run["segments_found"] for run in done)
    segments_rejected = sum(run["segments_rejected"] for run in done)
    quantities = {run["quantity"] for run in sound if run["value_min"] is not None}
    kept = sum(bool(run.get("kept")) for run in done)
    empty = sum(run["value_min"] is None and not is_ramp(run) for run in sound)
    status = "incomplete" if done else "nothing"
    if done and not (failed or rejected or empty or rejected_scans or kept or lost_decisions):
        status = "complete"
    doubtful = sum(status_word(run) == "suspect" for run in runs)
    odd = sum(status_word(run) == "suspect" and is_odd(run) for run in runs)
    doubts = [f"{odd} odd"] * bool(odd) + [f"{doubtful - odd} suspect"] * (doubtful > odd)
    ramps = sum(map(is_ramp, sound))
    parts = [
        f"{len(sound)} of {many(len(runs), 'run')} usable"
        + f" ({', '.join(doubts)})" * bool(doubts)
    ]
    if ramps:
        parts.append(many(ramps, "speed ramp"))
    if failed:
        parts.append(f"{failed} failed")
    if empty:
        parts.append(f"{empty} without a friction value")
    if kept:
        parts.append(f"{kept} kept from before")
    if rejected:
        parts.append(f"{rejected} rejected by {'its' if rejected == 1 else 'their'} checks")
    if rejected_scans:
        parts.append(f"scans of {', '.join(rejected_scans)} rejected")
    parts += [f"{count} {word} by hand" for word, count in by_hand.items() if count]
    if lost_decisions:
        parts.append(f"{many(lost_decisions, 'decision')} on no run")
    out = f" ({segments_rejected} rejected by hand)" if segments_rejected else ""
    if segments or not ramps:
        parts.append(f"{many(segments, 'segment')}{out}")
    ranges = {}
    for name in ("friction_coefficient", "half_loop", "friction_force"):
        if name in quantities:
            mine = [run for run in sound if run["quantity"] == name]
            known = _bounds(mine)
            ranges[name] = Extent(min(known), max(known))
            steady = _steady(mine) if name == "friction_coefficient" else []
            one_rig = len({run.get("instrument") for run in mine}) == 1
            if means and one_rig and name == "friction_coefficient":
                text = span(steady or means, "")
            else:
                text = span(steady, "") if steady else _ranges(mine, UNITS[name])
            of = f"steady {SYMBOLS[name]}" if steady else SYMBOLS[name]
            parts.append(f"{of} {'from ' if ' to ' in text else ''}{text}")
    return CampaignVerdict(
        status=status,
        text="; ".join(parts),
        runs=len(runs),
        done=len(done),
        failed=failed,
        rejected=rejected,
        suspect=doubtful,
        uncertain=uncertain,
        without_value=empty,
        rejected_by_hand=by_hand["rejected"],
        accepted_by_hand=by_hand["accepted"],
        kept=kept,
        reused=sum(run["reused"] for run in runs),
        segments=segments,
        segments_rejected=segments_rejected,
        ranges=ranges,
    )


def state_of(verdict: Mapping[str, Any]) -> str:
    """Return the verdict as the first word of page and terminal: OK, SUSPECT, CHECK or FAIL.

    Examples
    --------
    >>> state_of({"status": "complete", "suspect": 1}), state_of({"status": "incomplete"})
    ('SUSPECT', 'CHECK')
    >>> state_of({"status": "complete", "suspect": 0, "uncertain": 0})
    'OK'
    """
    if verdict["status"] == "complete":
        return "SUSPECT" if verdict["suspect"] or verdict["uncertain"] else "OK"
    return "CHECK" if verdict["status"] == "incomplete" else "FAIL"


_BAD = ("fail", "error")


def _bounds(runs: Iterable[Mapping[str, Any]]) -> list[float]:
    bounds = [run[key] for run in runs for key in ("value_min", "value_max")]
    return [bound for bound in bounds if bound is not None]


def _steady(runs: Iterable[Mapping[str, Any]]) -> list[float]:
    """Return the steady friction of each run; empty unless friction changes and settles in all."""
    settled = [run.get("running_in", ()) for run in runs]
    if not all(len(rows) == 1 and rows[0]["verdict"] != NONE for rows in settled):
        return []
    steady = [rows[0]["steady_friction_coefficient"] for rows in settled]
    return [] if None in steady else steady


def _ranges(runs: Sequence[Mapping[str, Any]], unit: str) -> str:
    """Return text on the range of the measured values, separately for up to three instruments."""
    apart: dict[str, list[Mapping[str, Any]]] = {}
    for run in runs:
        if run["value_min"] is not None:
            apart.setdefault(str(run.get("instrument", "")), []).append(run)
    if len(apart) == 1:
        return span(_bounds(runs), unit)
    if len(apart) > _INSTRUMENTS or not all(apart):
        return f"{span(_bounds(runs), unit)}, of {many(len(apart), 'instrument')} together"
    own = [f"{span(_bounds(mine), unit)} ({name})" for name, mine in apart.items()]
    return f"{', '.join(own[:-1])} and {own[-1]}"


def brief_run(run: Mapping[str, Any]) -> Json:
    """Return the entry of a run in report.json without its long lists, for the table of runs."""
    brief = {key: value for key, value in run.items() if key not in _LONG_LISTS}
    objections = [row for row in run["checks"] if row["status"] in ("suspect", "fail", "error")]
    return brief | {"checks": objections}


_LONG_LISTS = ("segments", "flagged", "history", "signals", "files", "checks", "columns_not_used")


def _campaign(campaign: Campaign) -> CampaignFile:
    file = Path(campaign.file)
    there = file.is_file()
    return CampaignFile(
        name=campaign.name,
        file=file.name,
        sha256=sha256_of_file(file) if there else "",
        text=file.read_text(encoding="utf-8-sig") if there else "",
    )


def versions() -> dict[str, str]:
    """Return the versions of Python, tribolab and the numerical libraries."""
    # imported late: looks up the installed package
    from tribolab.version import __version__

    known = {"tribolab": __version__, "python": platform.python_version()}
    for name in _LIBRARIES:
        try:
            known[name] = version(name)
        except PackageNotFoundError:  # e.g. in a bundle without package metadata
            known[name] = "unknown"
    return known


def write_json(document: Mapping[str, Any], runs: Iterable[Mapping[str, Any]], path: Path) -> None:
    """Write report.json in UTF-8, without NaN, and with one run per line."""

    def text(value: Any, indent: int | None = 1) -> str:
        return json.dumps(value, ensure_ascii=False, indent=indent, allow_nan=False)

    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write("{\n")
        for key, value in document.items():
            file.write(f"{text(key)}: {text(value)},\n")
        file.write('"runs": [')
        for number, run in enumerate(runs):
            file.write(",\n" if number else "\n")
            file.write(text(run, None))
        file.write("\n]\n}\n")
