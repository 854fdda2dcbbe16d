"""Clock of a drafted dialect: restarts, rows out of order, tables of results without a clock."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from tribolab.arrays.medians import median
from tribolab.reading.clocks.faults import find_faults, rows_at_fault
from tribolab.reading.lexicon.lexicon import normalise_label, part_pattern, plain_words
from tribolab.reading.si_tables.steps import is_newest_first
from tribolab.reading.text.cells import split_name
from tribolab.reading.unknown.columns.rotating_parts import angle_of, turns_of
from tribolab.reading.unknown.columns.unit_and_sign import IN_SECONDS
from tribolab.reading.unknown.model import DraftColumn, proceeds_by_seconds
from tribolab.units.quantities import unit_conversion

if TYPE_CHECKING:
    from tribolab.reading.unknown.layout.text_layout import Layout
    from tribolab.reading.unknown.model import DraftColumn

_FEW_AT_FAULT = 0.01  # of the rows
_DAY, _HOUR = 86400.0, 3600.0  # [s]
OnRepeat = Literal["", "drop", "interpolate"]


def summed(columns: list[DraftColumn], numbers: np.ndarray) -> bool:
    """Replace a time column of intervals by their running sum; return whether there is one."""
    column = next((c for c in columns if c.used and c.quantity == "time" and not c.form), None)
    if column is None or normalise_label(split_name(column.label)[0]) not in plain_words(
        "interval"
    ):
        return False
    passed = numbers[:, column.place - 1]
    if len(passed) < 2 or not (passed >= 0).all() or (np.diff(passed) > 0).all():
        return False
    numbers[:, column.place - 1] = np.cumsum(passed)
    return True


def in_seconds(columns: list[DraftColumn], numbers: np.ndarray) -> list[DraftColumn]:
    """Take a clock without a unit as seconds if its steps suggest it and no speed depends on it."""
    moved = any(c.used and c.quantity == "position" for c in columns)
    if moved or angle_of(columns) is not None or turns_of(columns, numbers) is not None:
        return columns
    return [
        column._replace(guessed=(), options=())
        if column.guessed == (IN_SECONDS,) and proceeds_by_seconds(numbers[:, column.place - 1])
        else column
        for column in columns
    ]


def find_clock(
    layout: Layout, columns: list[DraftColumn], numbers: np.ndarray
) -> tuple[OnRepeat, bool, list[DraftColumn]]:
    """Return the settings `on_repeat` and `restart` with which time increases, and the columns.

    Rows are left out only if they repeat the row before or are empty.
    """
    column = next((c for c in columns if c.used and c.quantity == "time"), None)
    if column is None:
        return "", False, columns
    time = numbers[:, column.place - 1] * unit_conversion(column.read_unit or "s", "time")[0]
    if len(layout.blocks) == 1 and is_newest_first(time):
        return "", False, _replaced(columns, _reversed(column))
    edges = np.cumsum([0, *(len(block.rows) for block in layout.blocks)])
    edges = np.unique(np.minimum(edges, len(time)))  # `numbers` has no damaged rows
    restart = any(not time[b] > time[b - 1] for b in edges[1:-1])
    bad, wraps = np.zeros(len(time), dtype=bool), []
    for first, last in itertools.pairwise(edges):
        faults = find_faults(time[first:last])
        # a time of day starts again at midnight, minutes and seconds at the hour
        starts = [s for s in faults.starts if not (column.form and s.period in (_DAY, _HOUR))]
        restart |= bool(starts)
        bad[first:last] = rows_at_fault(time[first:last] + faults.offsets(), faults)
        wraps += sorted({start.period for start in starts if start.period})
    on_repeat: OnRepeat = ""
    if bad.any():
        lossless = _loses_nothing(np.delete(numbers, column.place - 1, axis=1), numbers, bad)
        on_repeat = "drop" if lossless else "interpolate"
        column = _with_repeats(column, time, bad, lossless=lossless)
    if wraps:  # certain: time falls by exactly the range of such a counter
        note = "; ".join(f"its counter wraps every {p:.9g} s" for p in dict.fromkeys(wraps))
        column = column._replace(note=f"{column.note}; {note}" if column.note else note)
    return on_repeat, restart, _replaced(columns, column)


def _replaced(columns: list[DraftColumn], column: DraftColumn) -> list[DraftColumn]:
    return [column if c.place == column.place else c for c in columns]


def _reversed(column: DraftColumn) -> DraftColumn:
    """Return a clock with the note that the newest row is first; a guess if it may count down."""
    note = "the newest row comes first, and the rows are turned round"
    if part_pattern("time_left").search(normalise_label(split_name(column.label)[0])):
        return column._replace(note="", guessed=(note,))
    return column._replace(note=note)


def _loses_nothing(others: np.ndarray, numbers: np.ndarray, bad: np.ndarray) -> bool:
    """Whether all faulty rows repeat the row before them, or are empty except for the time."""
    twin = np.zeros(len(numbers), dtype=bool)
    twin[1:] = ((numbers[1:] == numbers[:-1]) | np.isnan(numbers[1:])).all(axis=1)
    return bool((twin | np.isnan(others).all(axis=1))[bad].all())


def _with_repeats(
    column: DraftColumn, time: np.ndarray, bad: np.ndarray, *, lossless: bool
) -> DraftColumn:
    """Return the clock with a note or guess on how rows whose time does not increase are read."""
    rows = f"{int(bad.sum())} rows whose time is not later than before"
    if lossless:
        return column._replace(note=f"{rows} are left out: they add nothing")
    note = f"{rows} get times between the others'"
    if _fill_one_interval(time, bad):
        return column._replace(note=note)
    return column._replace(guessed=(*column.guessed, note))


def _fill_one_interval(time: np.ndarray, bad: np.ndarray) -> bool:
    """Whether faulty rows are rare, and each fills a gap of one sample between its neighbours."""
    rows = np.flatnonzero(bad)
    inside = rows[(rows > 0) & (rows < time.size - 1)]
    if inside.size < rows.size or rows.size > _FEW_AT_FAULT * time.size:
        return False
    span = (time[rows + 1] - time[rows - 1]) / median(np.diff(time))
    return bool((~bad[rows + 1] & ~bad[rows - 1] & (np.abs(span - 2) < 0.5)).all())


_MAX_ROWS = 400  # rows
_MIN_ROWS = 3
_RISE = 1.02  # least ratio of speeds in successive rows
_SWEEP = 8  # least rows of a sweep up or down


def are_points(columns: Sequence[DraftColumn], numbers: np.ndarray) -> bool:
    """Whether each row is a result at one speed: the speeds sweep up and down."""
    held = {column.quantity: column for column in columns if column.used}
    speeds = ("sliding_velocity", "rotation_speed", "rolling_speed")
    column = next((held[name] for name in speeds if name in held), None)
    if column is None or not _MIN_ROWS <= len(numbers) <= _MAX_ROWS:
        return False
    size = np.abs(numbers[:, column.place - 1])
    size = size[np.isfinite(size)]
    if size.size < _MIN_ROWS or not (size > 0).all():
        return False
    steps = np.log(size[1:] / size[:-1])
    way = np.sign(steps)
    turns = np.flatnonzero(way[1:] != way[:-1])
    # the last speed of one sweep may be the first of the next
    repeated = np.abs(steps) < np.log(_RISE)
    return bool(turns.size <= size.size / _SWEEP) and int(repeated.sum()) <= turns.size / 2
