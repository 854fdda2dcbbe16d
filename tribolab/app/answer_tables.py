"""Tables for the terminal that suit the type of test: running-in, rests of a slider, ramps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from tribolab.core.wording import number
from tribolab.records.parts import number_of
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import RunningIn, length_text
from tribolab.records.runs.starts import starts_of
from tribolab.records.wording import NORMAL, error_text

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

_MAX_ROWS = 12
_NONE = "–"


def answer_table(outcome: Outcome) -> Table | None:
    """Return the table that answers the test, for a few runs; None if the curves do so."""
    return _static_table(outcome) or _ramp_table(outcome) or running_in_table(outcome)


def _table(*headings: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column(headings[0])
    for heading in headings[1:]:
        table.add_column(heading, justify="right")
    return table


def _static_table(outcome: Outcome) -> Table | None:
    """Return static and kinetic friction after each rest, or None for other tests."""
    table = _table("run", "rest (s)", "static µ ± U95", "kinetic µ")
    for run in outcome.runs[:_MAX_ROWS]:
        entry = outcome.store.get("run", run.name, RunRecord)
        for row in starts_of(entry.record) if entry is not None else ():
            error = number_of(row, "static_friction_coefficient_sem")
            table.add_row(
                run.name,
                number(number_of(row, "waiting_time_s") or 0.0),
                error_text(
                    number_of(row, "static_friction_coefficient"),
                    None if error is None else NORMAL * error,
                ),
                error_text(number_of(row, "friction_coefficient"), None),
            )
    return table if 0 < table.row_count <= _MAX_ROWS else None


def _ramp_table(outcome: Outcome) -> Table | None:
    """Return the range of friction of runs that consist of ramps; None for other tests."""
    # imported late for a quick start
    from tribolab.report.live.ramps import ramp_specs
    from tribolab.report.plain import plain_speed

    ramps = [run for run in outcome.runs if run.ramp and run.done]
    if not ramps or len(ramps) > _MAX_ROWS or any(run.segments for run in outcome.runs):
        return None
    table = _table("ramp", "speeds", "highest µ", "at", "lowest µ", "at")
    for leg in (leg for spec in ramp_specs(ramps, outcome.folder) for leg in spec.series):
        speeds, mu = leg.x, leg.y
        high, low = int(np.argmax(mu)), int(np.argmin(mu))
        table.add_row(
            leg.label,
            f"{plain_speed(min(speeds))} to {plain_speed(max(speeds))}",
            number(mu[high]),
            plain_speed(speeds[high]),
            number(mu[low]),
            plain_speed(speeds[low]),
        )
    return table if table.row_count else None


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
