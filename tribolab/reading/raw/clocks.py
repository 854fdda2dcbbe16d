"""Interpolation of columns with separate clocks to one of these clocks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.raw.model import Clock, RawColumn, Setting

INTERVAL_KEY = "wf_increment"  # LabVIEW's name of the sampling interval
INTERVAL_PATTERN = rf"^{INTERVAL_KEY}: (\S+)"


class OneClock(NamedTuple):
    """Columns at the times of one clock, and the original clocks of interpolated ones."""

    values: list[np.ndarray]
    clock: Clock
    others: dict[int, Clock]

    @property
    def setting(self) -> Setting:
        """Sampling interval [s] as a setting of the table."""
        return Setting(INTERVAL_KEY, repr(self.clock.interval))


def on_one_clock(columns: Sequence[RawColumn], lead: int | None = None) -> OneClock | None:
    """Return columns with separate clocks, interpolated to the times of one of them.

    Parameters
    ----------
    columns
        The columns.
    lead
        Index of the column whose clock is used; by default that with the shortest interval.

    Returns
    -------
    OneClock or None
        None if a column has no clock. Other columns are interpolated linearly. Outside their range
        they are NaN, but rows at the ends are left out if a column misses them by at most one of
        its intervals.

    Raises
    ------
    ReadError
        If the columns do not overlap in time.

    Examples
    --------
    >>> fast = RawColumn("F", "N", np.arange(5.0), clock=Clock(0.0, 1.0))
    >>> slow = RawColumn("v", "m/s", np.array([1.0, 3.0]), clock=Clock(0.5, 2.0))
    >>> on_one_clock([fast, slow]).values[1].tolist()
    [1.5, 2.5]
    """
    clocks = [column.clock for column in columns if column.clock is not None]
    numeric = all(column.values.dtype.kind in "fiu" and column.values.size for column in columns)
    if not columns or len(clocks) < len(columns) or not numeric:
        return None
    order = sorted(range(len(columns)), key=lambda k: (clocks[k].interval, -columns[k].values.size))
    lead = order[0] if lead is None else lead
    clock, rows = clocks[lead], columns[lead].values.size
    at = clock.times(rows)
    values, others = [], {}
    begin, end = 0, rows
    for place, column in enumerate(columns):
        own = clocks[place]
        if own == clock and column.values.size == rows:
            values.append(column.values)
            continue
        when = own.times(column.values.size)
        if when[-1] < at[0] or when[0] > at[-1]:
            raise ReadError(
                f"'{shown(column.label)}' was recorded from {when[0]:.6g} to {when[-1]:.6g} s, "
                f"'{shown(columns[lead].label)}' from {at[0]:.6g} to {at[-1]:.6g} s: they are no "
                "signals of one run"
            )
        values.append(np.interp(at, when, column.values, left=np.nan, right=np.nan))
        if own != clock:
            others[place] = own
        # a gap of at most one interval at either end is cut off instead of filled with NaN
        if when[0] - at[0] <= own.interval:
            begin = max(begin, int(np.searchsorted(at, when[0])))
        if at[-1] - when[-1] <= own.interval:
            end = min(end, int(np.searchsorted(at, when[-1], "right")))
    clock = Clock(float(at[begin]), clock.interval)
    return OneClock([numbers[begin:end] for numbers in values], clock, others)
