"""Tables of the results of a campaign for the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

from rich.table import Table

from tribolab.app.ranges import range_of
from tribolab.campaign.store.outcome import Outcome
from tribolab.core.wording import LOAD_MEASURED, LOAD_VARIES, load_text
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import CurveOutcome, Row
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import (
    RunningIn,
    length_text,
    mean_of_steady,
    steady_levels,
)
from tribolab.records.runs.starts import starts_of
from tribolab.records.verdict import has_unknown_zero
from tribolab.records.wording import error_text

if TYPE_CHECKING:
    from tribolab.figures.spec import FigureSpec
    from tribolab.friction.points.mean_of_repeats import Mean

_MAX_ROWS = 12  # most runs in a table
_MAX_POINTS = 16  # most speeds in a table
_MAX_READ = 10  # most runs of a curve whose records are read
_NONE = "–"


def answer_table(outcome: Outcome) -> Table | None:
    """Return a table of starts, ramps or running-in that suits the test; None if curves suffice."""
    return _starts_or_ramps(outcome) or running_in_table(outcome)


def _table(texts: Sequence[str], numbers: Sequence[str]) -> Table:
    """Return an empty table with columns of texts and right-aligned columns of numbers."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for heading in texts:
        table.add_column(heading)
    for heading in numbers:
        table.add_column(heading, justify="right")
    return table


def _starts_or_ramps(outcome: Outcome) -> Table | None:
    """Return static friction after each rest, or highest and lowest friction of speed ramps."""
    runs = outcome.runs[:_MAX_ROWS]
    entries = [outcome.store.get("run", run.name, RunRecord) for run in runs]
    started = [entry.record for entry in entries if entry and starts_of(entry.record)]
    ramps = [run for run in runs if run.ramp and run.done]
    specs: list[FigureSpec] = []
    if started:
        # imported late: most campaigns need neither
        from tribolab.report.page_figures.starts import static_figures

        specs = static_figures(started)
    elif ramps and not any(run.segments for run in outcome.runs):
        # imported late, as above
        from tribolab.report.page_figures.ramps import ramp_specs

        specs = ramp_specs(ramps, outcome.folder)
    if not specs or (numbers := specs[0].numbers) is None or len(numbers.rows) > _MAX_ROWS:
        return None
    table = _table(numbers.heads[:1], numbers.heads[1:])
    for row in numbers.rows:
        table.add_row(*row.cells)
    return table


def running_in_table(outcome: Outcome) -> Table | None:
    """Return running-in distance, steady and mean µ of up to 12 runs; None if no run runs in."""
    found: list[tuple[str, RunningIn]] = []
    for run in outcome.runs[: _MAX_ROWS + 1]:
        entry = outcome.store.get("run", run.name, RunRecord)
        settled = entry.record.facts.running_in if entry is not None else ()
        found += [(run.name, settled[0])] if len(settled) == 1 else []
    if len(outcome.runs) > _MAX_ROWS or not any(row.changes for _, row in found):
        return None
    headings = ("running-in distance", "steady µ ± U95", "whole-run mean")
    table = _table(["run"], headings)
    for name, row in found:
        table.add_row(name, *_cells(row))
    return table


def _cells(settled: RunningIn) -> tuple[str, str, str]:
    mean = error_text(settled.mean_friction_coefficient, settled.error_of_mean)
    whole = length_text(settled.end_m)
    if settled.steady_friction_coefficient is None:
        return f"not in {whole}", _NONE, mean
    steady = error_text(
        settled.steady_friction_coefficient, settled.steady_friction_coefficient_U95
    )
    return f"{length_text(settled.start_m)} of {whole}", steady, mean


def outcome_table(outcome: Outcome) -> Table:
    """Return a table with a row for each measured curve: conditions, speeds and friction."""
    done = [curve for curve in outcome.curves if curve.done]
    # without surface and medium, the names of the runs distinguish the rows
    nameless = any(not (curve.surface or curve.medium) for curve in done)
    texts = (*(("run",) if nameless else ()), "surface", "medium")
    counts = ("load", "runs", "segments")
    table = _table(texts, (*counts, "speeds", "friction coefficient", "± U95"))
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
    """Return a table of friction at each speed if there is a single, short curve; else None."""
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
    unit, scale = ("m/s", 1.0) if max(speed for _, speed in known) >= 1 else ("mm/s", 1e3)
    headings = (f"speed ({unit})", "friction coefficient", "± U95", "scatter", "segments")
    table = _table((), headings)
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
    """Return text on the largest U95 of some points, and its source."""
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
    """Return the mean steady friction of repeats with running-in; None without running-in."""
    rows = running_in_of(curve, outcome)
    settled = [row for each in rows.values() for row in each]
    if not steady_levels(rows) or not any(row.changes for row in settled):
        return None
    return mean_of_steady(settled)


def _zero_unknown(curve: CurveOutcome, outcome: Outcome) -> bool:
    """Whether the U95 of some run of a curve excludes the unknown zero of its friction force."""
    few = curve.run_names if len(curve.run_names) <= _MAX_READ else ()
    entries = [outcome.store.get("run", name, RunRecord) for name in few]
    checks = [asdict(row) for entry in entries if entry for row in entry.record.facts.checks]
    return has_unknown_zero(checks)


def _segment_cells(curve: CurveOutcome, outcome: Outcome) -> tuple[str, ...]:
    """Return the last cells of a row for runs without a curve: friction of their segments."""
    entries = [outcome.store.get("run", name, RunRecord) for name in curve.run_names]
    rows = [row for entry in entries if entry for row in entry.record.facts.segments]
    known = [v for row in rows if (v := row.get("friction_coefficient")) is not None]
    text = range_of(f"{min(known):.3f}", f"{max(known):.3f}") if known else _NONE
    is_known = any(row.get("sliding_speed_m_s") is not None for row in rows)
    note = _NONE if is_known else "speed unknown"
    runs = [run for run in outcome.runs if run.name in curve.run_names]
    return str(len(runs)), str(sum(run.segments for run in runs)), note, text, _largest_error(rows)


def running_in_of(curve: CurveOutcome, outcome: Outcome) -> dict[str, tuple[RunningIn, ...]]:
    """Return the running-in of each run of a curve, by name; empty if there are many runs."""
    few = curve.run_names if len(curve.run_names) <= _MAX_READ else ()
    entries = {name: outcome.store.get("run", name, RunRecord) for name in few}
    return {name: entry.record.facts.running_in for name, entry in entries.items() if entry}
