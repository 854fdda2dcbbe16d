"""Tables for the terminal that suit the type of test: running-in, rests of a slider, ramps."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import RunningIn, length_text
from tribolab.records.runs.starts import starts_of
from tribolab.records.wording import error_text

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome
    from tribolab.figures.spec import FigureSpec

_MAX_ROWS = 12
_NONE = "–"


def answer_table(outcome: Outcome) -> Table | None:
    """Return the table that answers the test, for a few runs; None if the curves do so."""
    return _starts_or_ramps(outcome) or running_in_table(outcome)


def _table(*headings: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column(headings[0])
    for heading in headings[1:]:
        table.add_column(heading, justify="right")
    return table


def _starts_or_ramps(outcome: Outcome) -> Table | None:
    """Return static friction after rests, or the extremes of ramps; None for other tests."""
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
    table = _table(*numbers.heads)
    for row in numbers.rows:
        table.add_row(*row.cells)
    return table


def running_in_table(outcome: Outcome) -> Table | None:
    """Return running-in, steady and mean friction of a few runs, or None if none runs in."""
    found: list[tuple[str, RunningIn]] = []
    for run in outcome.runs[: _MAX_ROWS + 1]:
        entry = outcome.store.get("run", run.name, RunRecord)
        settled = entry.record.facts.running_in if entry is not None else ()
        found += [(run.name, settled[0])] if len(settled) == 1 else []
    if len(outcome.runs) > _MAX_ROWS or not any(row.changes for _, row in found):
        return None
    table = _table("run", "running-in distance", "steady µ ± U95", "whole-run mean")
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
