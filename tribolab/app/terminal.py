"""Lines on the results of a campaign: verdict, doubts, failures, and paths of the files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.app.result_tables import running_in_of
from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.files import inputs_outside
from tribolab.campaign.store.outcome import Outcome
from tribolab.core.provenance import as_text
from tribolab.core.wording import Count, load_text
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import RunOutcome, SurfaceOutcome
from tribolab.records.runs.notice_words import CHANGES, DOUBTFUL_COLUMNS, STICK_SLIP, STROKE_ENDS
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import steady_levels
from tribolab.records.surfaces.roughness_words import FORM, roughness_in_words
from tribolab.records.verdict import (
    SUSPECT,
    contradicts_repeats,
    furthest_repeat,
    uncertain_mean,
    uncertain_words,
    verdict_of,
)

if TYPE_CHECKING:
    pass

_SHOWN, _HANDFUL = 10, 5


def verdict_line(outcome: Outcome) -> str:
    """Return the verdict on a campaign in one word, and the numbers of usable runs and scans."""
    uncertain = bool(_uncertain(outcome))
    word, counts = verdict_of(outcome.runs, outcome.surfaces, uncertain=uncertain)
    return f"{word:7s} {counts}{', with doubts listed below' * (word == SUSPECT)}"


def _uncertain(outcome: Outcome) -> list[tuple[float, str]]:
    """Return U95 divided by the mean, and the name, of each condition with an uncertain mean."""
    found = []
    for curve in outcome.curves:
        entry = outcome.store.get("curve", curve.name, CurveRecord) if curve.done else None
        if entry and (share := uncertain_mean(entry.record.points)) is not None:
            load = load_text(curve.normal_force, "")
            name = ", ".join(filter(None, (curve.surface, curve.medium, load)))
            levels = dict(zip(curve.run_names, entry.record.levels, strict=False))
            levels |= steady_levels(running_in_of(curve, outcome))
            odd = {run for run in curve.run_names if _is_odd(run, outcome)}
            found.append((share, name + furthest_repeat(levels, odd)))
    return found


def _is_odd(name: str, outcome: Outcome) -> bool:
    entry = outcome.store.get("run", name, RunRecord)
    return entry is not None and contradicts_repeats(map(asdict, entry.record.facts.checks))


def outcome_lines(outcome: Outcome) -> list[str]:
    """Return lines on the runs, segments and surfaces of a campaign, and on doubts about them."""
    done = [run for run in outcome.runs if run.done]
    reused = sum(run.reused for run in done)
    line = f"{len(done)} of {Count(len(outcome.runs)):run|runs} read"
    if empty := sum(not run.segments for run in done):
        line += f" ({empty} without a segment of constant speed)"
    line += f", {Count(outcome.segments):segment|segments}"
    if reused:
        line += f"; {reused} unchanged since the last analysis"
    lines = [line] if outcome.campaign.run else []
    for quality, what in (
        ("error", ("check crashed")),
        ("fail", "check failed"),
        ("suspect", "suspect"),
    ):
        runs = [run for run in outcome.runs if run.quality == quality]
        # records are read only for runs whose reasons are listed
        names = _alike((run.name, _reasons_of_run(run, outcome)) for run in runs[:_HANDFUL])
        names += [run.name for run in runs[_HANDFUL:]]
        for surface in outcome.surfaces:
            if quality in surface.objections:
                names.append(f"scans of {surface.name}{_reasons(surface.checks, quality)}")
        lines += [f"{what}: {name}" for name in names[:_HANDFUL]]
        if len(names) > _HANDFUL:
            file = from_here(outcome.folder / "tables" / "checks.csv")
            lines.append(f"{what}: {len(names) - _HANDFUL} more, see {file}")
    if uncertain := _uncertain(outcome):
        lines.append(uncertain_words(uncertain))
    contradictions = outcome.campaign.contradicting_viscosities()
    lines += [f"medium {name}: {text}" for name, text in contradictions.items()]
    lines += _run_notices(done, outcome)
    lines += _undecided(done, outcome)
    lines += _decisions(outcome)
    if known := [surface for surface in outcome.surfaces if surface.files]:
        computed = sum(surface.done for surface in known)
        of = f"{computed} of {Count(len(known)):surface|surfaces}"
        lines.append(f"computed for {of}: {_computed(outcome)}")
        lines += _roughness(outcome)
        few = known if len(known) <= _HANDFUL else ()
        lines += [f"{surface.name}: {text}" for surface in few for text in _doubts(surface)]
    lines += _left_out(outcome)
    lines += [f"no curve of {c.name}: {c.reason}" for c in outcome.curves if not c.done]
    if _is_uncalibrated(outcome):
        lines.append(
            "calibration not stated: every uncertainty is statistical only "
            "([uncertainty] in the campaign file)"
        )
    return lines


def where_to_look(outcome: Outcome) -> list[str]:
    """Return lines with the paths of the results."""
    lines = []
    if any(curve.done for curve in outcome.curves):
        file = from_here(outcome.folder / "tables" / "stribeck.csv")
        lines.append(f"tables: {file} (friction at each speed), friction.csv (each segment)")
    return [*lines, f"report: {from_here(outcome.folder / 'report.html')}"]


def _run_notices(done: Sequence[RunOutcome], outcome: Outcome) -> list[str]:
    """Return the notices on trimmed strokes, running-in, wear and stick-slip, if runs are few."""
    few = done if len(done) <= _HANDFUL else ()
    return _alike(
        (run.name, f": {'left out: ' * (notice.where == STROKE_ENDS)}{notice.message}")
        for run in few
        if (entry := outcome.store.get("run", run.name, RunRecord)) is not None
        for notice in entry.record.notices
        if notice.where in (*CHANGES, STROKE_ENDS, DOUBTFUL_COLUMNS, STICK_SLIP)
    )


def _undecided(done: Sequence[RunOutcome], outcome: Outcome) -> list[str]:
    """Return a line with the number of segments whose trend is undecided."""
    # imported late for a quick start
    from tribolab.records.runs.trends import undecided_trends

    entries = [(run.name, outcome.store.get("run", run.name, RunRecord)) for run in done]
    facts = [(name, entry.record.facts) for name, entry in entries if entry is not None]
    # runs whose friction changes have a separate notice
    facts = [(name, each) for name, each in facts if not any(r.changes for r in each.running_in)]
    text = undecided_trends((name, each.segments, each.quantity or "") for name, each in facts)
    return [text] if text else []


def _is_uncalibrated(outcome: Outcome) -> bool:
    """Whether any curve has an uncertainty that excludes the calibration of the instrument."""
    entries = [outcome.store.get("curve", c.name, CurveRecord) for c in outcome.curves if c.done]
    return any("statistical only" in entry.record.uncertainty_says for entry in entries if entry)


def _decisions(outcome: Outcome) -> list[str]:
    """Return a line on manual decisions, and where they are listed."""
    decided = [run for run in outcome.runs if run.quality_as_found]
    if not decided:
        return []
    counts = [
        (f"{Count(sum(run.quality == word for run in decided)):run|runs} {word}", word)
        for word in ("rejected", "accepted")
    ]
    parts = [text for text, word in counts if any(run.quality == word for run in decided)]
    of = [run for run in decided if run.segments_rejected and run.quality != "rejected"]
    if count := sum(run.segments_rejected for run in of):
        parts.append(f"{Count(count):segment|segments} of {Count(len(of)):run|runs} rejected")
    text = ", ".join(parts) or f"on {Count(len(decided)):run|runs}"
    return [
        f"decided by hand: {text}: see {from_here(outcome.folder / 'tables' / 'decisions.csv')}"
    ]


def _alike(reasons: Iterable[tuple[str, str]]) -> list[str]:
    """Return a line for each reason, which names all runs that have it."""
    named: dict[str, list[str]] = {}
    for name, reason in reasons:
        named.setdefault(reason, []).append(name)
    return [f"{', '.join(names)}{reason}" for reason, names in named.items()]


def _reasons_of_run(run: RunOutcome, outcome: Outcome) -> str:
    entry = outcome.store.get("run", run.name, RunRecord)
    rows = [] if entry is None else [asdict(row) for row in entry.record.facts.checks]
    return _reasons(rows, run.quality)


def _reasons(rows: Iterable[Mapping[str, Any]], status: str) -> str:
    """Return the names and messages of the checks with a given status, as the end of a line."""
    mine = [row for row in rows if row["status"] == status and not row.get("decision")]
    texts = [f"{row['check'].replace('_', ' ')}: {_of_scan(row)}{row['message']}" for row in mine]
    return "".join(f": {' '.join(text.split())}" for text in ["; ".join(texts)] if text)


def _of_scan(row: Mapping[str, Any]) -> str:
    """Return the name of the scan that a check refers to; "" if the message begins with it."""
    scan = row.get("scan", "")
    return f"{scan} " if scan and not row["message"].startswith(scan) else ""


def _computed(outcome: Outcome) -> str:
    """Return in words what was computed for the surfaces, e.g. spectrum and contact."""
    words = {"psd": "spectrum", "contact": "contact", "adhesion": "adhesion"}
    parts = {part for surface in outcome.surfaces for part in surface.parts}
    return ", ".join(word for part, word in words.items() if part in parts) or (
        "roughness" if parts else "no results"
    )


def _roughness(outcome: Outcome) -> list[str]:
    """Return lines on the ISO roughness of the surfaces, with the cut-off."""
    rows = []
    for surface in outcome.surfaces:
        entry = outcome.store.get("surface", surface.name, SurfaceRecord)
        if entry and entry.record.rows and entry.record.rows.roughness:
            rows.append((surface.name, entry.record.rows.roughness))
    return roughness_in_words(rows)


def _left_out(outcome: Outcome) -> list[str]:
    """Return a line on the effects that the first model omits; the page estimates their sizes."""
    for model in outcome.models:
        entry = outcome.store.get("model", model.name, ModelRecord)
        if entry and entry.record.rows and entry.record.rows.not_in_model:
            effects = entry.record.rows.not_in_model
            names = ", ".join(str(effect["effect"]) for effect in effects)
            return [f"not in the model: {names} (estimated sizes in the report)"]
    return []


def _doubts(surface: SurfaceOutcome) -> list[str]:
    """Return the suspect findings on a surface, except those from the checks of its scans.

    The check of the form is included, because the roughness depends on the form.
    """
    return [
        finding.message
        for finding in surface.findings
        if finding.check == FORM or (not finding.check and finding.severity == "suspect")
    ]


def outside_lines(campaign: Campaign) -> list[str]:
    """Return lines that name the files read outside the campaign's folders, and what to do."""
    files = inputs_outside(campaign)
    if not files:
        return []
    return [
        f"{campaign.file.name} reads {Count(len(files)):file|files} outside of its own folder and "
        f"that of campaign.raw: {_handful(list(map(as_text, files)))}; the results contain their "
        "data. Copy them into the campaign's folder, or use --i-know to hide this message"
    ]


def foreign_lines(outcome: Outcome) -> list[str]:
    """Return lines that name results changed by other programs, and files that are no results."""
    lines = []
    if outcome.damaged:
        lines.append(
            f"changed since tribolab wrote them, so computed again: {_handful(outcome.damaged)}; "
            "the changed versions are kept as *.changed-*"
        )
    if outcome.foreign:
        foreign = _handful(outcome.foreign)
        lines.append(f"other files in the results folder, kept: {foreign}")
    return lines


def _handful(names: Sequence[str]) -> str:
    more = len(names) - _HANDFUL
    return ", ".join(names[:_HANDFUL]) + (f" and {more} more" if more > 0 else "")


def failure_lines(outcome: Outcome) -> list[str]:
    """Return lines on failed runs, surfaces, scans and models, with reasons and advice."""
    # imported late for a quick start
    from tribolab.records.models.mode_record import condition

    failed = list(outcome.lost_decisions)
    failed += _alike((run.name, f" failed: {run.reason}") for run in outcome.failed)
    for surface in outcome.surfaces:
        failed += [f"surface {surface.name}: {finding.message}" for finding in surface.unreadable]
    failed += [f"{run.name}: {run.kept}" for run in outcome.runs if run.kept]
    failed += [f"no model of {condition(m)}: {m.reason or m.error}" for m in outcome.failed_models]
    lines = failed[:_SHOWN]
    if len(failed) > _SHOWN:
        lines.append(f"... and {len(failed) - _SHOWN} more; the report has all")
    return lines


def from_here(path: Path) -> str:
    """Return a path as text, relative to the current folder if it is inside."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)
