"""Earlier results that are kept because what they were made from cannot be read now.

A file that is empty, locked or away for an hour must not take good results with it. What is kept
says so, and since when; it is dropped when the campaign no longer names its files.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from tribolab.campaign.outcome import Finding, ModelOutcome, RunOutcome
from tribolab.campaign.plan import label_of, safe_name
from tribolab.campaign.surface_plan import PlannedSurface
from tribolab.campaign.surface_work import SurfaceRecord, earlier_surface
from tribolab.campaign.work import RunRecord, Source

if TYPE_CHECKING:
    from tribolab.campaign.config import Campaign, RunEntry

# The files were read, and the answer is about what is in them: it stands.
_VERDICTS = ("AnalysisError",)
_GONE = "it is not there"


@dataclass(frozen=True)
class EarlierRun:
    """A run of the earlier report: name, files as reports show them, data file, quality."""

    name: str
    files: tuple[str, ...]
    data_file: str
    segments: int
    quality: str
    normal_force: float | None


@dataclass(frozen=True)
class Earlier:
    """What an earlier report knows: its runs that were done, and (sha256, bytes) of each file."""

    folder: Path
    runs: tuple[EarlierRun, ...] = ()
    sources: dict[str, Source] | None = None

    @classmethod
    def read(cls, folder: Path | None) -> Earlier:
        """Read the report of a results folder; none, or a damaged one, knows nothing."""
        if folder is None:
            return cls(Path())
        try:
            report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
            runs = tuple(
                EarlierRun(
                    name=str(run["name"]),
                    files=tuple(map(str, run["files"])),
                    data_file=str(run["data_file"]),
                    segments=int(run["segments_found"]),
                    quality=str(run["quality"]),
                    normal_force=run["nominal_normal_force_N"],
                )
                for run in report["runs"]
                if run["status"] == "done" and (folder / run["data_file"]).is_file()
            )
            rows = [(str(s["file"]), str(s["sha256"]), int(s["bytes"])) for s in report["sources"]]
        except (OSError, ValueError, LookupError, TypeError):
            return cls(folder)
        return cls(folder, runs, {row[0]: row for row in rows})


def keep_runs(
    campaign: Campaign, earlier: Earlier, staging: Path, records: Sequence[RunRecord]
) -> list[RunRecord]:
    """Put earlier results in the place of runs whose files cannot be read now.

    Parameters
    ----------
    campaign
        It says which files it still names.
    earlier
        What the results of before know.
    staging
        Folder that is being written; data files that are kept are linked into it.
    records
        What the runs came to now.

    Returns
    -------
    list of RunRecord
        In the same order; runs of files that are gone come last.
    """
    kept = list(records)
    if not earlier.runs:
        return kept
    bad = {
        label: record.outcome.reason
        for record in records
        if not record.outcome.done and record.outcome.error not in _VERDICTS
        for label in record.outcome.files
    }
    there = {label for record in records for label in record.outcome.files}
    content = {source[1] for record in records for source in record.sources}
    known = earlier.sources or {}
    for run in earlier.runs:
        entry = _entry_of(campaign, run.files)
        gone = [label for label in run.files if label not in there]
        moved = any(known.get(label, ("", "", 0))[1] in content for label in gone)
        why = [bad[label] for label in run.files if label in bad]
        why += [f"{PurePosixPath(label).name}: {_GONE}" for label in gone]
        if not why or entry is None or (gone and moved):
            continue
        outcome = _kept_run(run, entry, earlier.folder, why[0])
        mine = [record for record in kept if set(record.outcome.files) <= set(run.files)]
        names = {record.outcome.name for record in kept if record not in mine}
        data_file = run.data_file
        if outcome.name in names:  # another run has its name now
            name = safe_name(f"{run.name}_kept")
            outcome = replace(outcome, name=name, data_file=f"data/{name}.nc")
        link(earlier.folder / data_file, staging / outcome.data_file)
        sources = tuple(known[label] for label in run.files if label in known)
        place = kept.index(mine[0]) if mine else len(kept)
        kept = [record for record in kept if record not in mine]
        kept.insert(place, RunRecord(outcome, sources))
    return kept


def kept_surface(
    campaign: Campaign,
    planned: PlannedSurface,
    previous: Path | None,
    staging: Path,
    record: SurfaceRecord,
) -> SurfaceRecord:
    """Return the earlier record of a surface some of whose files cannot be read now.

    They are its scans and its modulus. Without such files, or without earlier results, the record
    comes back as it is.
    """
    now = record.outcome
    if previous is None or now.reused or now.status == "skipped":
        return record
    path = previous / planned.data_file
    earlier = earlier_surface(path, now)
    if earlier is None:
        return record
    patterns = next(s.scans or () for s in campaign.surface if s.name == now.name)
    sources, before = earlier
    names = [label for label, _, _ in sources]
    content = {checksum for _, checksum, _ in record.sources}
    spoilt = _left_out(now.findings, names) - _left_out(before.findings, names)
    gone = {
        label
        for label, checksum, _ in sources
        if label not in {mine for mine, _, _ in record.sources}
        and checksum not in content
        and _names(campaign, patterns, label)
    }
    why = sorted(f"{PurePosixPath(label).name}: {_GONE}" for label in gone)
    why += sorted(f"{PurePosixPath(label).name} cannot be read" for label in spoilt)
    what = "scans"
    if planned.modulus_file is not None and planned.modulus_file[1] in names:
        lost = {"modulus"} & {*before.parts} - {*now.parts}
        if lost and any(f.severity in ("fail", "error") for f in now.findings if not f.check):
            what = "scans" if why else "its modulus"
            why.append(f"{planned.modulus_file[0].name} cannot be read")
    if not now.done and now.error not in _VERDICTS:
        why.append(now.reason)
    if not why:
        return record
    text = _text(path, f"{what} cannot be read now ({why[0]})")
    link(path, staging / before.data_file)
    findings = (*before.findings, Finding("fail", text))
    return SurfaceRecord(replace(before, findings=findings, reused=False, kept=text), sources)


def kept_model(
    model: ModelOutcome, earlier: ModelOutcome | None, previous: Path, staging: Path
) -> ModelOutcome:
    """Return the earlier outcome of a model that could not be computed now, if there is one."""
    if model.status != "failed" or model.error in _VERDICTS or earlier is None:
        return model
    path = previous / earlier.data_file
    text = _text(path, f"the model cannot be computed now ({model.reason})")
    link(path, staging / earlier.data_file)
    findings = (*earlier.findings, Finding("fail", text))
    return replace(earlier, findings=findings, reused=False, kept=text)


def link(old: Path, new: Path) -> None:
    """Have a data file of earlier results in the new folder, too.

    Raises
    ------
    FileNotFoundError
        If it is not there (any more).
    """
    try:
        os.link(old, new)
    except FileNotFoundError:
        raise
    except OSError:  # a file system without hard links
        shutil.copy2(old, new)


def _kept_run(run: EarlierRun, entry: RunEntry, folder: Path, why: str) -> RunOutcome:
    return RunOutcome(
        name=run.name,
        files=run.files,
        surface=entry.surface or "",
        medium=entry.medium or "",
        normal_force=run.normal_force if entry.normal_force is None else entry.normal_force,
        status="done",
        data_file=run.data_file,
        segments=run.segments,
        quality=run.quality,
        kept=_text(folder / run.data_file, f"the raw file cannot be read now ({why})"),
    )


def _text(path: Path, why: str) -> str:
    from tribolab.io.netcdf import opened

    try:
        with opened(path) as file:
            when = str(getattr(file, "history", "")).split(" ")[0]
    except (OSError, RuntimeError):
        when = ""
    return f"kept from {when or 'before'}: {why}"


def _entry_of(campaign: Campaign, labels: Iterable[str]) -> RunEntry | None:
    """Return the [[run]] that names all these files, also if they are not there now."""
    labels = list(labels)
    for entry in campaign.run:
        if all(_names(campaign, entry.files, label) for label in labels):
            return entry
    return None


def _names(campaign: Campaign, patterns: Iterable[str], label: str) -> bool:
    raw = PurePosixPath(label_of(campaign, campaign.raw))
    path = PurePosixPath(label)
    if not path.is_relative_to(raw):
        return False
    parts = path.relative_to(raw).parts
    return any(_matches(parts, PurePosixPath(pattern).parts) for pattern in patterns)


def _matches(parts: tuple[str, ...], pattern: tuple[str, ...]) -> bool:
    if not pattern:
        return not parts
    if pattern[0] == "**":
        rest = range(len(parts) + 1)
        return any(_matches(parts[n:], pattern[1:]) for n in rest)
    if not parts or not (parts[0] == pattern[0] or fnmatchcase(parts[0], pattern[0])):
        return False
    return _matches(parts[1:], pattern[1:])


def _left_out(findings: Iterable[Finding], labels: Iterable[str]) -> set[str]:
    """Return the files of which findings say that they could not be read."""
    grave = [f.message for f in findings if f.severity == "fail" and not f.check]
    return {label for label in labels for text in grave if f"scan {label} is left out" in text}
