"""What a drafted dialect has to say of the clock: it starts anew, and what single rows become."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal

import numpy as np

from tribolab.io.clocks.faults import find_faults, rows_at_fault
from tribolab.io.content.newest_first import is_newest_first
from tribolab.io.dialects.cells import split_name
from tribolab.medians import median
from tribolab.quantities import unit_conversion
from tribolab.reading.lexicon.lexicon import normalise_label

if TYPE_CHECKING:
    from tribolab.draft.file.layout import Layout
    from tribolab.draft.model import DraftColumn

_FEW_AT_FAULT = 0.01  # of the rows
_DAY, _HOUR = 86400.0, 3600.0  # [s]
_REMAINING = re.compile(r"left|remain|rest|countdown|togo|verbleib|restante|剩余|残り")
_INTERVALS = {"dt", "deltat", "δt", "interval", "intervall"}
OnRepeat = Literal["", "drop", "interpolate"]


def summed(columns: list[DraftColumn], numbers: np.ndarray) -> bool:
    """Sum a column of time that holds intervals by its name and its numbers; whether it does.

    Parameters
    ----------
    columns
        The columns.
    numbers
        Their numbers (rows, columns); changed in place.
    """
    column = next((c for c in columns if c.used and c.quantity == "time" and not c.form), None)
    if column is None or normalise_label(split_name(column.label)[0]) not in _INTERVALS:
        return False
    passed = numbers[:, column.place - 1]
    if len(passed) < 2 or not (passed >= 0).all() or (np.diff(passed) > 0).all():
        return False
    numbers[:, column.place - 1] = np.cumsum(passed)
    return True


def find_clock(
    layout: Layout, columns: list[DraftColumn], numbers: np.ndarray
) -> tuple[OnRepeat, bool, list[DraftColumn]]:
    """Find out what has to be said for time to increase: of single rows, and of new starts.

    Rows are left out only where nothing is lost with them: the row before says the same, or they
    are empty.
    """
    column = next((c for c in columns if c.used and c.quantity == "time"), None)
    if column is None:
        return "", False, columns
    time = numbers[:, column.place - 1] * unit_conversion(column.read_unit or "s", "time")[0]
    if len(layout.blocks) == 1 and is_newest_first(time):
        counts_down = _REMAINING.search(normalise_label(split_name(column.label)[0])) is not None
        told = "the newest row comes first, and the rows are turned round"
        column = column._replace(
            note="" if counts_down else told, guessed=(told,) if counts_down else column.guessed
        )
        return "", False, [column if c.place == column.place else c for c in columns]
    edges = np.cumsum([0, *(len(block.rows) for block in layout.blocks)])
    parts = list(zip(edges[:-1], edges[1:], strict=True))
    ends = [(time[b - 1], time[b]) for b in edges[1:-1]]
    restart = any(not later > earlier for earlier, later in ends)
    bad, notes, wraps = np.zeros(len(time), dtype=bool), [], []
    for first, last in parts:
        faults = find_faults(time[first:last])
        # a time of day begins anew at midnight, minutes and seconds at the hour
        starts = [s for s in faults.starts if not (column.form and s.period in (_DAY, _HOUR))]
        restart |= bool(starts)
        bad[first:last] = rows_at_fault(time[first:last] + faults.offsets(), faults)
        periods = {start.period for start in starts if start.period}
        wraps += [f"its counter wraps every {period:.9g} s" for period in sorted(periods)]
    on_repeat: OnRepeat = ""
    if bad.any():
        others = np.delete(numbers, column.place - 1, axis=1)
        twin = np.zeros(len(time), dtype=bool)
        twin[1:] = ((numbers[1:] == numbers[:-1]) | np.isnan(numbers[1:])).all(axis=1)
        lossless = (twin | np.isnan(others).all(axis=1))[bad].all()
        on_repeat = "drop" if lossless else "interpolate"
        told = f"{int(bad.sum())} rows whose time is not later than before"
        if lossless:  # no guess: nothing else could be done with them
            column = column._replace(note=f"{told} are left out: they say nothing new")
        elif _fill_one_interval(time, bad):  # no guess: one even time fits between the others
            column = column._replace(note=f"{told} get times between the others'")
        else:
            notes.append(f"{told} get times between the others'")
    if wraps:  # no guess: it falls by exactly what such a counter holds
        told = "; ".join(dict.fromkeys(wraps))
        column = column._replace(note=f"{column.note}; {told}" if column.note else told)
    column = column._replace(guessed=(*column.guessed, *dict.fromkeys(notes)))
    return on_repeat, restart, [column if c.place == column.place else c for c in columns]


def _fill_one_interval(time: np.ndarray, bad: np.ndarray) -> bool:
    """Whether each row at fault is one of many, and the rows around it leave room for just it."""
    rows = np.flatnonzero(bad)
    inside = rows[(rows > 0) & (rows < time.size - 1)]
    if inside.size < rows.size or rows.size > _FEW_AT_FAULT * time.size:
        return False
    span = (time[rows + 1] - time[rows - 1]) / median(np.diff(time))
    return bool((~bad[rows + 1] & ~bad[rows - 1] & (np.abs(span - 2) < 0.5)).all())
