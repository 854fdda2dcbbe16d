"""Output of results on the command line: short tables, and paths of the files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.table import Table

from tribolab.app.ranges import range_of
from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.files import inputs_outside
from tribolab.campaign.store.outcome import Outcome
from tribolab.core.provenance import as_text
from tribolab.core.wording import LOAD_MEASURED, LOAD_VARIES, Count, load_text
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import CurveOutcome, Row, RunOutcome, SurfaceOutcome
from tribolab.records.runs.notice_words import CHANGES, DOUBTFUL_COLUMNS, STICK_SLIP, STROKE_ENDS
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import RunningIn, mean_of_steady, steady_levels
from tribolab.records.surfaces.roughness_words import FORM, roughness_in_words
from tribolab.records.verdict import (
    SUSPECT,
    contradicts_repeats,
    furthest_repeat,
    has_unknown_zero,
    uncertain_mean,
    uncertain_words,
    verdict_of,
)

if TYPE_CHECKING:
    from tribolab.friction.points.mean_of_repeats import Mean

_SHOWN, _HANDFUL = 10, 5
_MAX_POINTS = 16  # most rows in a terminal
_NONE = "–"
_COUNTS = ("load", "runs", "segments")


def verdict_line(outcome: Outcome) -> str:
    """Return the verdict in one word, and the numbers of usable runs and scans."""
    uncertain = bool(_uncertain(outcome))
    word, counts = verdict_of(outcome.runs, outcome.surfaces, uncertain=uncertain)
    return f"{word:7s} {counts}{', with doubts listed below' * (word == SUSPECT)}"


def _uncertain(outcome: Outcome) -> list[tuple[float, str]]:
    """Return the conditions whose repeats leave their mean uncertain: U95 over mean, and name."""
    found = []
    for curve in outcome.curves:
        entry = outcome.store.get("curve", curve.name, CurveRecord) if curve.done else None
        if entry and (share := uncertain_mean(entry.record.points)) is not None:
            load = load_text(curve.normal_force, "")
            name = ", ".join(filter(None, (curve.surface, curve.medium, load)))
            levels = dict(zip(curve.run_names, entry.record.levels, strict=False))
            levels |= steady_levels(_running_in(curve, outcome))
            odd = {run for run in curve.run_names if _is_odd(run, outcome)}
            found.append((share, name + furthest_repeat(levels, odd)))
    return found


def _is_odd(name: str, outcome: Outcome) -> bool:
    entry = outcome.store.get("run", name, RunRecord)
    return entry is not None and contradicts_repeats(map(asdict, entry.record.facts.checks))


def outcome_table(outcome: Outcome) -> Table:
    """Return one row per measured curve: conditions, speeds and friction."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    done = [curve for curve in outcome.curves if curve.done]
    # without labels the run's name distinguishes rows
    nameless = any(not (curve.surface or curve.medium) for curve in done)
    for heading in (*(("run",) if nameless else ()), "surface", "medium"):
        table.add_column(heading)
    for heading in (*_COUNTS, "speeds", "friction coefficient", "± U95"):
        table.add_column(heading, justify="right")
    for curve in done:
        load = load_text(None, curve.load_from) if curve.load_from == LOAD_VARIES else _NONE
        if curve.normal_force is not None:
            measured = " measured" if curve.load_from == LOAD_MEASURED else ""
            load = f"{curve.normal_force:g} N{measured}"
        known = (curve.surface or _NONE, curve.medium or _NONE, load)
        run = curve.run_names[0] if len(curve.run_names) == 1 else _NONE
        first = (run,) if nameless else ()
        table.add_row(*first, *known, *_numbers(curve, outcome))
    return table


def points_table(outcome: Outcome) -> Table | None:
    """Return friction at each speed if there is only one curve with a few points; else None."""
    done = [curve for curve in outcome.curves if curve.done]
    rows = _points(done[0], outcome) if len(done) == 1 else ()
    known = [
        (row, speed)
        for row in rows
        if isinstance(speed := row["sliding_speed_m_s"], float)
        and row["friction_coefficient"] is not None
    ]
    if not 1 <= len(known) <= _MAX_POINTS:
        return None
    table = Table(box=None, pad_edge=False, header_style="bold")
    unit, scale = ("m/s", 1.0) if max(speed for _, speed in known) >= 1 else ("mm/s", 1e3)
    for heading in (f"speed ({unit})", "friction coefficient", "± U95", "scatter", "segments"):
        table.add_column(heading, justify="right")
    for row, speed in known:
        cells = [
            _NONE if (value := row.get(f"friction_coefficient{end}")) is None else f"{value:{form}}"
            for end, form in (("", ".4f"), ("_U95", ".2g"), ("_std", ".2g"))
        ]
        segments = str(int(row.get("segments") or 0))
        table.add_row(f"{scale * speed:.4g}", *cells, segments)
    return table


def _points(curve: CurveOutcome, outcome: Outcome) -> Sequence[Row]:
    entry = outcome.store.get("curve", curve.name, CurveRecord)
    return [] if entry is None else entry.record.points


def _numbers(curve: CurveOutcome, outcome: Outcome) -> tuple[str, ...]:
    points = _points(curve, outcome)
    speed = [row["sliding_speed_m_s"] for row in points if row["sliding_speed_m_s"] is not None]
    mu = [v for row in points if (v := row["friction_coefficient"]) is not None]
    if not speed or not mu:
        return _segment_cells(curve, outcome)
    segments = sum(int(row.get("segments") or 0) for row in points)
    if len(points) == 1 and (steady := _steady(curve, outcome)) is not None:
        friction = f"{steady.mean:.3f} steady"
        points = [dict(points[0]) | {"friction_coefficient_U95": steady.u95}]
    else:
        friction = range_of(f"{min(mu):.3f}", f"{max(mu):.3f}")
    return (
        str(len(curve.run_names)),
        str(segments) if "segments" in points[0] else "",
        f"{range_of(f'{min(speed):.3g}', f'{max(speed):.3g}')} m/s",
        friction,
        _largest_error(points, with_zero=not _zero_unknown(curve, outcome)),
    )


def _largest_error(points: Sequence[Row], with_zero: bool = True) -> str:
    """Return the largest U95, and whether it is within or between runs."""
    own = [row.get("friction_coefficient_U95") for row in points]
    known = [float(v) for v in own if v is not None]
    if not known:
        return _NONE
    several = [int(row.get("runs") or 1) > 1 for row in points]
    source = "within or between runs"
    if all(several) or not any(several):
        source = "between runs" if several[0] else "within the run"
    source = source if with_zero else "zero unknown"
    return f"{'at most ' if len(known) > 1 else ''}{max(known):.2g} ({source})"


def _steady(curve: CurveOutcome, outcome: Outcome) -> Mean | None:
    """Return the mean steady friction of a few repeats that run in; else None."""
    rows = _running_in(curve, outcome)
    settled = [row for each in rows.values() for row in each]
    if not steady_levels(rows) or not any(row.changes for row in settled):
        return None
    return mean_of_steady(settled)


def _running_in(curve: CurveOutcome, outcome: Outcome) -> dict[str, tuple[RunningIn, ...]]:
    """Return the running-in of a few runs of a curve, by name."""
    few = curve.run_names if len(curve.run_names) <= _SHOWN else ()
    entries = {name: outcome.store.get("run", name, RunRecord) for name in few}
    return {name: entry.record.facts.running_in for name, entry in entries.items() if entry}


def _zero_unknown(curve: CurveOutcome, outcome: Outcome) -> bool:
    """Return whether U95 of a few runs does not include their zero."""
    few = curve.run_names if len(curve.run_names) <= _SHOWN else ()
    entries = [outcome.store.get("run", name, RunRecord) for name in few]
    checks = [asdict(row) for entry in entries if entry for row in entry.record.facts.checks]
    return has_unknown_zero(checks)


def _segment_cells(curve: CurveOutcome, outcome: Outcome) -> tuple[str, ...]:
    """Return the friction of the segments; without a speed there is no curve."""
    entries = [outcome.store.get("run", name, RunRecord) for name in curve.run_names]
    rows = [row for entry in entries if entry for row in entry.record.facts.segments]
    known = [v for row in rows if (v := row.get("friction_coefficient")) is not None]
    text = range_of(f"{min(known):.3f}", f"{max(known):.3f}") if known else _NONE
    is_known = any(row.get("sliding_speed_m_s") is not None for row in rows)
    note = _NONE if is_known else "speed unknown"
    runs = [run for run in outcome.runs if run.name in curve.run_names]
    return str(len(runs)), str(sum(run.segments for run in runs)), note, text, _largest_error(rows)


def outcome_lines(outcome: Outcome) -> list[str]:
    """Return lines on the numbers of runs done, reused and failed, with notes on them."""
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
        # read only the records that are named
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
    """Return notices on a few runs, e.g. on trimmed strokes, running-in and wear."""
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
    # a run whose friction changes along it has a notice of its own
    facts = [(name, each) for name, each in facts if not any(r.changes for r in each.running_in)]
    text = undecided_trends((name, each.segments, each.quantity or "") for name, each in facts)
    return [text] if text else []


def _is_uncalibrated(outcome: Outcome) -> bool:
    """Whether the uncertainty of a curve excludes the calibration of its instrument."""
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
    """Return names with their reasons, and once each reason that several have in common."""
    named: dict[str, list[str]] = {}
    for name, reason in reasons:
        named.setdefault(reason, []).append(name)
    return [f"{', '.join(names)}{reason}" for reason, names in named.items()]


def _reasons_of_run(run: RunOutcome, outcome: Outcome) -> str:
    entry = outcome.store.get("run", run.name, RunRecord)
    rows = [] if entry is None else [asdict(row) for row in entry.record.facts.checks]
    return _reasons(rows, run.quality)


def _reasons(rows: Iterable[Mapping[str, Any]], status: str) -> str:
    """Return the checks with this status, and their messages."""
    mine = [row for row in rows if row["status"] == status and not row.get("decision")]
    texts = [f"{row['check'].replace('_', ' ')}: {_of_scan(row)}{row['message']}" for row in mine]
    return "".join(f": {' '.join(text.split())}" for text in ["; ".join(texts)] if text)


def _of_scan(row: Mapping[str, Any]) -> str:
    """Return the scan of a check, if its message does not begin with it."""
    scan = row.get("scan", "")
    return f"{scan} " if scan and not row["message"].startswith(scan) else ""


def _computed(outcome: Outcome) -> str:
    """Return the computed results of surfaces as a list in words."""
    words = {"psd": "spectrum", "contact": "contact", "adhesion": "adhesion"}
    parts = {part for surface in outcome.surfaces for part in surface.parts}
    return ", ".join(word for part, word in words.items() if part in parts) or (
        "roughness" if parts else "no results"
    )


def _roughness(outcome: Outcome) -> list[str]:
    """Return the roughness of surfaces in the standard form, with its cut-off."""
    rows = []
    for surface in outcome.surfaces:
        entry = outcome.store.get("surface", surface.name, SurfaceRecord)
        if entry and entry.record.rows and entry.record.rows.roughness:
            rows.append((surface.name, entry.record.rows.roughness))
    return roughness_in_words(rows)


def _left_out(outcome: Outcome) -> list[str]:
    """Return a line on effects that the models leave out; the page has their sizes."""
    for model in outcome.models:
        entry = outcome.store.get("model", model.name, ModelRecord)
        if entry and entry.record.rows and entry.record.rows.not_in_model:
            effects = entry.record.rows.not_in_model
            names = ", ".join(str(effect["effect"]) for effect in effects)
            return [f"not in the model: {names} (estimated sizes in the report)"]
    return []


def _doubts(surface: SurfaceOutcome) -> list[str]:
    """Return suspect findings on a surface other than those of the checks of its scans.

    A doubtful form is included, because the roughness depends on it.
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
    """Return lines that name damaged results and foreign files."""
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
    """Return a path relative to the current folder, if it is inside."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)
