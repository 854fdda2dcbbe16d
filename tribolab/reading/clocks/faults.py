"""Faults of a clock, row by row: restarts, wraps, stray time stamps, stops.

A clock that falls back and continues from there restarts (or wraps, if it fell by the range of a
counter). A fall within the scatter of the time steps is jitter. If a fall and a jump cancel each
other, the stamps between them are stray, and the clock was continuous. Other rows that are not
later than all before them in their part are stops or jitter.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import chosen, pieces
from tribolab.arrays.medians import median
from tribolab.arrays.scratch import room
from tribolab.reading.clocks import limits

_BLOCK_SAMPLES = 1 << 18  # samples per block, to save memory

_COUNTER_TICKS = [10.0**k for k in range(-9, 1)]
# ranges of counters [s]: 2^bits clock ticks, half a day, a day; a fall by a range is a wrap
_COUNTERS = tuple(
    sorted(
        {
            2.0**bits * tick
            for bits in (8, 10, 12, 14, 15, 16, 18, 20, 24, 31, 32)
            for tick in _COUNTER_TICKS
        }
    )
)
_COUNTERS += (43_200.0, 86_400.0)


class Start(NamedTuple):
    """Row at which the clock restarts; `ahead` is the offset to add from there on [s]."""

    row: int
    ahead: float
    period: float  # period of the counter that wrapped; 0 without a wrap


class Faults(NamedTuple):
    """Rows at which the clock restarts, and masks of stray and missing stamps (time)."""

    starts: tuple[Start, ...]
    astray: np.ndarray
    missing: np.ndarray

    def offsets(self) -> np.ndarray:
        """Return the offsets [s] (time) that make the clock continuous if added to the times."""
        edges = [0, *(start.row for start in self.starts), self.astray.size]
        ahead = np.concatenate([[0.0], np.cumsum([start.ahead for start in self.starts])])
        result = room(self.astray.size)
        for first, last, by in zip(edges, edges[1:], ahead, strict=False):
            result[first:last] = by
        return result


def first_fault(time: np.ndarray) -> int | None:
    """Return the row (from 0) of the first time that is missing or does not increase."""
    for start, _ in pieces(0, len(time), _BLOCK_SAMPLES):
        part = time[max(start - 1, 0) : start + _BLOCK_SAMPLES]
        if start == 0 and not np.isfinite(part[0]):
            return 0
        with np.errstate(invalid="ignore"):  # between two infinite times
            bad = ~(np.diff(part) > 0) | ~np.isfinite(part[1:])
        if bad.any():
            return max(start - 1, 0) + int(np.argmax(bad)) + 1
    return None


def find_faults(time: np.ndarray, wrap: float = 0.0) -> Faults:
    """Distinguish restarts and wraps of a clock from stray stamps and jitter.

    Parameters
    ----------
    time
        Time [s] (time) of one table.
    wrap
        Period of the counter [s], if known: a fall by more than half of it is a wrap.

    Examples
    --------
    >>> find_faults(np.array([0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0])).starts
    (Start(row=4, ahead=4.0, period=0.0),)
    >>> find_faults(np.array([0.0, 1.0, 2.0, 1.9, 4.0, 5.0])).starts  # jitter
    ()
    """
    missing = ~np.isfinite(time)
    if not missing.any():
        search = _Search(time, wrap)
        search.run()
        return Faults(tuple(search.starts), search.astray, missing)
    search = _Search(chosen(time, ~missing), wrap)
    search.run()
    astray = np.zeros(time.size, dtype=bool)
    astray[~missing] = search.astray
    rows = np.flatnonzero(~missing)
    starts = tuple(start._replace(row=int(rows[start.row])) for start in search.starts)
    return Faults(starts, astray, missing)


def rows_at_fault(time: np.ndarray, faults: Faults) -> np.ndarray:
    """Return a mask of rows whose time is missing, stray, or not later than every earlier time.

    Parameters
    ----------
    time
        Time [s] (time), after parts have been joined.
    faults
        Faults of this clock.
    """
    good = ~(faults.missing | faults.astray)
    highest = np.nan
    for first, last in pieces(0, time.size):
        own = np.where(good[first:last], time[first:last], np.nan)
        before = np.fmax.accumulate(np.concatenate([[highest], own]))
        good[first:last] &= ~(time[first:last] <= before[:-1])
        highest = before[-1]
    return ~good


def _usual_and_spread(steps: np.ndarray) -> tuple[float, float]:
    """Return the median of the positive steps, and their median absolute deviation."""
    rising = chosen(steps, steps > 0)
    if not rising.size:
        return 1.0, 0.0
    usual = float(np.median(rising, overwrite_input=True))
    for first, last in pieces(0, rising.size):  # the median reordered the steps, which is harmless
        rising[first:last] = np.abs(rising[first:last] - usual)
    return usual, float(np.median(rising, overwrite_input=True))


class _Search:
    """Classification of all backward jumps of a clock, from first to last."""

    def __init__(self, time: np.ndarray, wrap: float):
        self.time, self.wrap = time, wrap
        self.steps = room(max(time.size - 1, 0))
        for first, last in pieces(0, self.steps.size):
            self.steps[first:last] = np.diff(time[first : last + 1])
        self.usual, spread = _usual_and_spread(self.steps)
        self.scatter = limits.MAX_SCATTER_OF_JITTER.value * 1.4826 * spread
        self.small = limits.MAX_JITTER.value * self.usual + self.scatter
        self.astray = np.zeros(time.size, dtype=bool)
        self.reach = max(10, time.size // limits.MIN_ROWS_PER_STRAY_BLOCK.value)
        self.starts: list[Start] = []

    def run(self) -> None:
        """Classify every backward jump of the clock."""
        falls = np.flatnonzero(self.steps < 0) + 1
        size = -self.steps[falls - 1]
        if np.count_nonzero(size <= self.small) > limits.MAX_BACKWARD_STEPS.value:
            falls = falls[size > self.small]
        self.first, self.top = 0, -np.inf  # first row and latest time of the current part
        done = 0  # rows classified so far
        for row in falls.tolist():
            if row < done:
                continue
            good = self.time[done:row][~self.astray[done:row]]
            self.top = max(self.top, float(good.max(initial=-np.inf)))
            done = row
            if self.time[row] > self.top:  # not back in time: the rows before it were stray
                continue
            if (stop := self._end_of_fall(row)) is not None:
                self.astray[row:stop] = True
                done = stop
            elif (start := self._start_of_jump(row)) is not None:
                self.astray[start:row] = True
                part = slice(self.first, start)
                self.top = float(self.time[part][~self.astray[part]].max())
            elif self._is_start(row):
                self._start(row)
        self._settle_wraps()

    def _fall(self, row: int) -> float:
        return self.top - float(self.time[row])

    def _end_of_fall(self, row: int) -> int | None:
        """Return the row at which a forward jump cancels a fall; None without such a jump."""
        ahead = self.time[row : row + self.reach + 1]
        back = np.flatnonzero(ahead > self.top)
        if not back.size:
            return None
        count = int(back[0])
        jump = float(ahead[count] - ahead[count - 1])
        lag = float(ahead[count]) - self.top - (count + 1) * self.usual
        return row + count if self._cancels(self._fall(row), jump, lag, count) else None

    def _start_of_jump(self, row: int) -> int | None:
        """Return the first row that had jumped ahead before a fall; None without such a jump."""
        begin = max(self.first, row - self.reach - 1)
        below = (self.time[begin:row] < self.time[row]) & ~self.astray[begin:row]
        below = np.flatnonzero(below)
        if not below.size:
            return None
        last = begin + int(below[-1])
        count = row - 1 - last
        jump = float(self.time[last + 1] - self.time[last])
        lag = float(self.time[row] - self.time[last]) - (count + 1) * self.usual
        return last + 1 if self._cancels(self._fall(row), jump, lag, count) else None

    def _cancels(self, fall: float, jump: float, lag: float, count: int) -> bool:
        """Whether a jump cancels a fall and the clock is then continuous."""
        slack = 3 + 0.1 * count if fall > self.small else 0.5 * (count + 1)
        return jump >= max(0.5 * fall, 1.5 * self.usual) and abs(lag) <= slack * self.usual

    def _is_start(self, row: int) -> bool:
        """Whether a fall is a restart: too large for jitter, or back to the start of the part."""
        begin = float(self.time[self.first])
        back = self.time[row] <= begin + 0.5 * self.usual and self.top - begin >= 1.5 * self.usual
        return bool((back and self._fall(row) > self.scatter) or self._fall(row) > self.small)

    def _start(self, row: int) -> None:
        fall, interval = self._fall(row), self._interval(row)
        period = self.wrap if self.wrap and fall > 0.5 * self.wrap else 0.0
        if not period:
            near = min(_COUNTERS, key=lambda counter: abs(fall + interval - counter))
            alike = abs(fall + interval - near) <= 1.5 * interval and 20 * interval < near > fall
            if alike and np.ptp(self.time[self.first : row]) <= near + interval:
                period = near
        self.starts.append(Start(row, period or fall + interval, period))
        self.first, self.top = row, float(self.time[row])

    def _interval(self, row: int) -> float:
        """Return the usual time step before a backward jump of the clock."""
        before = self.steps[max(self.first, row - 10) : row - 1]
        before = before[before > 0]
        return float(median(before)) if before.size else self.usual

    def _settle_wraps(self) -> None:
        """Decide whether the falls of a clock are wraps or restarts.

        A clock that restarts falls to its start, occasionally by the range of a counter. A counter
        always falls by its range, or by less if rows are missing at the wrap.
        """
        periods = {start.period for start in self.starts} - {0.0}
        if not periods or self.wrap:
            return
        others = [start for start in self.starts if not start.period]
        period = min(periods)
        lands_ahead = all(
            self.time[start.row] > 3 * self.usual and 0.5 * period < start.ahead < period
            for start in others
        )
        single = len(periods) == 1 and lands_ahead and np.ptp(self.time[~self.astray]) <= period
        if single or not others and len(periods) == 1:
            self.starts = [Start(start.row, period, period) for start in self.starts]
        else:
            self.starts = [start._replace(period=0.0) for start in self.starts]
