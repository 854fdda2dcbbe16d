"""Table of running-in and steady friction of runs at one speed, for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import RunningIn, length_text
from tribolab.records.wording import error_text

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

_MOST_ROWS = 12
_NONE = "–"


def running_in_table(outcome: Outcome) -> Table | None:
    """Return running-in, steady and mean friction of a few runs, or None if none runs in."""
    found: list[tuple[str, RunningIn]] = []
    for run in outcome.runs[: _MOST_ROWS + 1]:
        entry = outcome.store.get("run", run.name, RunRecord)
        settled = entry.record.facts.running_in if entry is not None else ()
        found += [(run.name, settled[0])] if len(settled) == 1 else []
    if len(outcome.runs) > _MOST_ROWS or not any(row.changes for _, row in found):
        return None
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("run")
    for heading in ("runs in over", "steady µ ± U95", "mean over all"):
        table.add_column(heading, justify="right")
    for name, row in found:
        table.add_row(name, *_cells(row))
    return table


def _cells(settled: RunningIn) -> tuple[str, str, str]:
    mean = error_text(settled.mean_friction_coefficient, settled.mean_friction_coefficient_U95)
    whole = length_text(settled.end_m)
    if settled.steady_friction_coefficient is None:
        return f"not in {whole}", _NONE, mean
    steady = error_text(
        settled.steady_friction_coefficient, settled.steady_friction_coefficient_U95
    )
    return f"{length_text(settled.start_m)} of {whole}", steady, mean
