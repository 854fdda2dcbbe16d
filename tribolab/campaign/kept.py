"""Earlier results that are kept because what they were made from cannot be read now.

A file that is empty, locked or away for an hour must not take good results with it. What is kept
says so, and since when; it is dropped when the campaign no longer names its files.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from tribolab.campaign.plan import label_of, safe_name
from tribolab.campaign.review import review_beside
from tribolab.campaign.runs import RunCame, keep_earlier
from tribolab.friction.decisions.decision import REJECT, Decision
from tribolab.records.part_records import ModelRecord, SurfaceRecord
from tribolab.records.parts import Finding, RunOutcome
from tribolab.records.run_record import DecisionRow, RunRecord

if TYPE_CHECKING:
    from tribolab.campaign.config import Campaign, RunEntry
    from tribolab.campaign.store import Entry, Store
    from tribolab.campaign.surface_plan import PlannedSurface

# The files were read, and the answer is about what is in them: it stands.
_VERDICTS = ("AnalysisError",)
_GONE = "it is not there"
REJECTED = "rejected"  # quality of a run, by a person
_LATER = "what was decided since reaches no segment of it, only the run as a whole"


def keep_runs(campaign: Campaign, store: Store, runs: Sequence[RunCame]) -> list[RunCame]:
    """Put earlier results in the place of runs whose files cannot be read now.

    Parameters
    ----------
    campaign
        It says which files it still names.
    store
        It knows the results of before, and what is kept is written down there.
    runs
        What the runs came to now.

    Returns
    -------
    list of RunCame
        In the same order; runs of files that are gone come last.
    """
    kept = list(runs)
    bad = {
        label: came.outcome.reason
        for came in runs
        if not came.outcome.done and came.outcome.error not in _VERDICTS
        for label in came.outcome.files
    }
    there = {label for came in runs for label in came.outcome.files}
    content = {checksum for came in runs for _, checksum, _ in came.sources}
    decisions = review_beside(campaign.file)
    for before in store.before.outcomes("run", RunOutcome):
        gone = [label for label in before.files if label not in there]
        why = [bad[label] for label in before.files if label in bad]
        why += [f"{PurePosixPath(label).name}: {_GONE}" for label in gone]
        entry = _entry_of(campaign, before.files) if before.done and why else None
        known = store.before.get("run", before.name, RunRecord) if entry else None
        if known is None or entry is None or store.previous is None:
            continue
        sums = {label: checksum for label, checksum, _ in known.record.sources}
        if gone and any(sums.get(label) in content for label in gone):
            continue  # it was renamed
        path = store.previous / before.data_file
        outcome = _kept_run(before, entry, path, why[0])
        decided = decisions.get(before.name, ())
        outcome, known = _with_decisions(outcome, known, decided)
        mine = [came for came in kept if set(came.outcome.files) <= set(before.files)]
        names = {came.outcome.name for came in kept if came not in mine}
        if outcome.name in names:  # another run has its name now
            name = safe_name(f"{before.name}_kept")
            outcome = replace(outcome, name=name, data_file=f"data/{name}.nc")
        place = kept.index(mine[0]) if mine else len(kept)
        came = keep_earlier(store, known, outcome, len(runs))
        if came is None:
            continue
        kept = [other for other in kept if other not in mine]
        kept.insert(place, came)
    if kept != list(runs):
        store.order("run", [came.outcome.name for came in kept])
    return kept


def kept_surface(
    campaign: Campaign, planned: PlannedSurface, store: Store, record: SurfaceRecord
) -> tuple[SurfaceRecord, bool]:
    """Return the earlier record of a surface some of whose files cannot be read now.

    They are its scans and its modulus. Without such files, or without earlier results, the record
    comes back as it is.

    Returns
    -------
    tuple of SurfaceRecord and bool
        The record, and whether it is an earlier one.
    """
    now = record.outcome
    known = store.before.get("surface", now.name, SurfaceRecord)
    if known is None or store.previous is None or now.status == "skipped":
        return record, False
    before, sources = known.record.outcome, known.record.sources
    if not before.done:
        return record, False
    patterns = next(s.scans or () for s in campaign.surface if s.name == now.name)
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
        return record, False
    text = _text(store.previous / before.data_file, f"{what} cannot be read now ({why[0]})")
    if not store.link("surface", now.name, before.data_file, planned.data_file):
        return record, False
    said = [f for f in before.findings if f.message != before.kept]
    outcome = replace(
        before,
        data_file=planned.data_file,
        findings=(*said, Finding("fail", text)),
        reused=False,
        kept=text,
    )
    return replace(known.record, outcome=outcome), True


def kept_model(store: Store, record: ModelRecord) -> tuple[ModelRecord, bool]:
    """Return the earlier record of a model that could not be computed now, if there is one.

    Returns
    -------
    tuple of ModelRecord and bool
        The record, and whether it is an earlier one.
    """
    now = record.outcome
    if now.status != "failed" or now.error in _VERDICTS or store.previous is None:
        return record, False
    known = store.before.get("model", now.name, ModelRecord)
    if known is None or not known.record.outcome.done:
        return record, False
    before = known.record.outcome
    path = store.previous / before.data_file
    text = _text(path, f"the model cannot be computed now ({now.reason})")
    if not store.link("model", now.name, before.data_file, before.data_file):
        return record, False
    said = [f for f in before.findings if f.message != before.kept]
    outcome = replace(before, findings=(*said, Finding("fail", text)), reused=False, kept=text)
    return replace(known.record, outcome=outcome), True


def _kept_run(run: RunOutcome, entry: RunEntry, path: Path, why: str) -> RunOutcome:
    return replace(
        run,
        surface=entry.surface or "",
        medium=entry.medium or "",
        normal_force=run.normal_force if entry.normal_force is None else entry.normal_force,
        reused=False,
        kept=_text(path, f"the raw file cannot be read now ({why})"),
    )


def _with_decisions(
    outcome: RunOutcome, known: Entry[RunRecord], decided: tuple[Decision, ...]
) -> tuple[RunOutcome, Entry[RunRecord]]:
    """Return an earlier run with what was decided on it since, as far as that needs no file."""
    record = known.record
    if [one.plain() for one in decided] == [_plain(row) for row in record.facts.decisions]:
        return outcome, known
    out = any(one.action == REJECT and one.interval is None for one in decided)
    rows = tuple(DecisionRow(**one.plain(), effect=_LATER) for one in decided)
    facts = replace(record.facts, decisions=rows)
    outcome = replace(outcome, kept=f"{outcome.kept}; {_LATER}")
    if out and outcome.quality != REJECTED:
        found = outcome.quality_as_found or outcome.quality
        outcome = replace(outcome, quality=REJECTED, quality_as_found=found)
        facts = replace(facts, quality=REJECTED)
    return outcome, known._replace(record=replace(record, facts=facts))


def _plain(row: DecisionRow) -> dict[str, object]:
    """Return a decision as `Decision.plain` does."""
    names = ("action", "start_s", "stop_s", "new_start_s", "new_stop_s", "reason", "author", "date")
    return {name: getattr(row, name) for name in names}


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
