"""Earlier results of runs that are kept because their raw files cannot be read."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from tribolab.campaign.runs.stage import RunHandle, keep_earlier
from tribolab.campaign.settings.naming.named import is_named
from tribolab.campaign.settings.naming.run_names import safe_name
from tribolab.campaign.settings.review import read_decisions
from tribolab.campaign.store.kept import GONE, VERDICTS, kept_text
from tribolab.core.wording import LOAD_STATED
from tribolab.friction.decisions.decision import REJECT, Decision
from tribolab.records.parts import RunOutcome
from tribolab.records.runs.run_record import DecisionRow, RunRecord

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.settings.measured import RunEntry
    from tribolab.campaign.store.catalogue import Entry
    from tribolab.campaign.store.new_catalogue import Store

_REJECTED = "rejected"  # quality of a run, by a person
_LATER = "what was decided since reaches no segment of it, only the run as a whole"


def keep_runs(campaign: Campaign, store: Store, runs: Sequence[RunHandle]) -> list[RunHandle]:
    """Replace runs whose files cannot be read by their earlier results.

    Parameters
    ----------
    campaign
        Campaign with the files it still names.
    store
        Earlier results, and storage of those kept.
    runs
        Present outcomes of the runs.

    Returns
    -------
    list of RunHandle
        Runs in the same order; those of missing files come last.
    """
    kept = list(runs)
    bad = {
        label: came.outcome.reason
        for came in runs
        if not came.outcome.done and came.outcome.error not in VERDICTS
        for label in came.outcome.files
    }
    there = {label for came in runs for label in came.outcome.files}
    content = {checksum for came in runs for _, checksum, _ in came.sources}
    decisions = read_decisions(campaign.file)
    for before in store.before.outcomes("run", RunOutcome):
        gone = [label for label in before.files if label not in there]
        why = [bad[label] for label in before.files if label in bad]
        why += [f"{PurePosixPath(label).name}: {GONE}" for label in gone]
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
        outcome, known = _apply_decisions(outcome, known, decided)
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


def _kept_run(run: RunOutcome, entry: RunEntry, path: Path, why: str) -> RunOutcome:
    return replace(
        run,
        surface=entry.surface or "",
        medium=entry.medium or "",
        normal_force=run.normal_force if entry.normal_force is None else entry.normal_force,
        load_from=run.load_from if entry.normal_force is None else LOAD_STATED,
        measured_load=run.measured_load if entry.normal_force is None else None,
        measured_levels=run.measured_levels if entry.normal_force is None else (),
        load_levels=run.load_levels if entry.normal_force is None else (),
        reused=False,
        kept=kept_text(path, f"the raw file cannot be read now ({why})"),
    )


def _apply_decisions(
    outcome: RunOutcome, known: Entry[RunRecord], decided: tuple[Decision, ...]
) -> tuple[RunOutcome, Entry[RunRecord]]:
    """Return an earlier run with the decisions made since, if they need no raw file."""
    record = known.record
    plain = [decision.plain() for decision in decided]
    if plain == [_plain(row) for row in record.facts.decisions]:
        return outcome, known
    out = any(decision.action == REJECT and decision.interval is None for decision in decided)
    rows = tuple(DecisionRow(**decision.plain(), effect=_LATER) for decision in decided)
    facts = replace(record.facts, decisions=rows)
    outcome = replace(outcome, kept=f"{outcome.kept}; {_LATER}")
    if out and outcome.quality != _REJECTED:
        quality = outcome.quality_as_found or outcome.quality
        outcome = replace(outcome, quality=_REJECTED, quality_as_found=quality)
        facts = replace(facts, quality=_REJECTED)
    return outcome, known._replace(record=replace(record, facts=facts))


def _plain(row: DecisionRow) -> dict[str, object]:
    """Return the decision as plain data, as from `Decision.plain`."""
    names = ("action", "start_s", "stop_s", "new_start_s", "new_stop_s", "reason", "author", "date")
    return {name: getattr(row, name) for name in names}


def _entry_of(campaign: Campaign, labels: Iterable[str]) -> RunEntry | None:
    """Find the [[run]] that names all these files, even if they are missing now."""
    labels = list(labels)
    for entry in campaign.run:
        if all(is_named(campaign, entry.files, label) for label in labels):
            return entry
    return None
