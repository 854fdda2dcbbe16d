"""Checks on the time: order, jitter, gaps, and changes of the sampling rate.

Each is a plain function from an array and limits to flags (see :mod:`tribolab.qc.flags`).
"""

from __future__ import annotations

import numpy as np

from tribolab.arrays.chunks import pieces
from tribolab.arrays.medians import median, medians_of_rows
from tribolab.arrays.scratch import filled
from tribolab.friction.time_weights import without_gaps
from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT, uniform

_PARTS = 16  # number of parts whose sampling rates are compared
_BLOCK = 64  # samples over which the usual sampling interval is determined


def time_order(time: np.ndarray) -> np.ndarray:
    """Return flags on samples whose time does not exceed that of the previous sample.

    Parameters
    ----------
    time
        Sample times [s].

    Returns
    -------
    ndarray
        fail where time does not increase, good elsewhere.

    Examples
    --------
    >>> time_order(np.array([0.0, 1.0, 1.0, 2.0]))
    array([1, 1, 4, 1], dtype=int8)
    """
    back = [
        start + np.flatnonzero(~(time[start:stop] > time[start - 1 : stop - 1]))
        for start, stop in pieces(1, time.size)
    ]
    rows = np.concatenate([np.zeros(0, int), *back])
    if not rows.size:
        return uniform(time.size, GOOD)
    flags = filled(time.size, GOOD, np.int8)
    flags[rows] = FAIL
    return flags


def time_gaps(
    time: np.ndarray, suspect: float = 5.0, pauses: np.ndarray | None = None
) -> np.ndarray:
    """Return flags on the samples after each gap in time.

    Parameters
    ----------
    time
        Sample times [s].
    suspect
        Length of a gap in local sampling intervals. The local interval is the median of the three
        before or of the three after, whichever is longer, so that a slower rate is not a gap.
    pauses
        Indices of samples before which the instrument paused on purpose.

    Returns
    -------
    ndarray
        suspect at the first sample after a gap, good elsewhere; not evaluated below eight samples.

    Examples
    --------
    >>> time_gaps(np.array([0, 1, 2, 3, 4, 15, 16, 17, 18.0]))
    array([1, 1, 1, 1, 1, 3, 1, 1, 1], dtype=int8)
    """
    if time.size < 8:
        return np.full(time.size, NOT_EVALUATED, np.int8)
    late = [
        start + np.flatnonzero(_late_intervals(time, start, stop, suspect))
        for start, stop in pieces(0, time.size - 1)
    ]
    after = np.concatenate(late) + 1
    if not after.size:
        return uniform(time.size, GOOD)
    flags = filled(time.size, GOOD, np.int8)
    flags[after] = SUSPECT
    if pauses is not None:
        flags[pauses] = GOOD
    return flags


def _late_intervals(time: np.ndarray, start: int, stop: int, longest: float) -> np.ndarray:
    """Return a mask of the sampling intervals that are much longer than their neighbours."""
    count = time.size - 1
    low, high = max(start - 3, 0), min(stop + 3, count)
    interval = np.diff(time[low : high + 1])
    three = _middle(interval[:-2], interval[1:-1], interval[2:])
    before, after = np.zeros(stop - start), np.zeros(stop - start)
    first, last = min(max(start, 3), stop), max(min(stop, count - 3), start)
    before[first - start :] = three[first - 3 - low : stop - 3 - low]
    after[: last - start] = three[start + 1 - low : last + 1 - low]
    return interval[start - low : stop - low] > longest * np.maximum(before, after)


def _middle(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Return the median of three arrays, element by element."""
    return np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))


def lost_time(time: np.ndarray, flags: np.ndarray) -> float:
    """Return the share of the record's duration [1] that gaps take."""
    return float(lengths_of_gaps(time, flags).sum() / (time[-1] - time[0]))


def lengths_of_gaps(time: np.ndarray, flags: np.ndarray) -> np.ndarray:
    """Return the lengths [s] of the gaps that end at flagged samples."""
    after = np.flatnonzero(flags[1:] == SUSPECT) + 1
    return time[after] - time[after - 1]


def time_jitter(time: np.ndarray, suspect: float = 0.25) -> np.ndarray:
    """Return flags on parts of the record with irregular sampling intervals.

    Parameters
    ----------
    time
        Sample times [s].
    suspect
        Robust standard deviation of an interval, relative to it, within a block of some 64
        samples, above which the whole block is flagged.

    Returns
    -------
    ndarray
        suspect over blocks that jitter, good elsewhere; not evaluated below one block.

    Notes
    -----
    The standard deviation is the median of |difference of neighbouring intervals| / mean, divided
    by 0.6745 sqrt(2). A change of the rate within a block is then a single outlier.
    """
    if time.size < _BLOCK:
        return np.full(time.size, NOT_EVALUATED, np.int8)
    # two neighbouring intervals need three samples
    changes = time.size - 2
    blocks = max(1, changes // _BLOCK)
    edges = np.linspace(0, changes, blocks + 1).astype(int)
    length = changes // blocks
    scatter = np.empty(blocks)
    for first, last in pieces(0, blocks, block=length):
        start = edges[first]
        odd = _interval_change(time[start : edges[last - 1] + length + 2])
        whole = np.lib.stride_tricks.sliding_window_view(odd, length)[edges[first:last] - start]
        scatter[first:last] = medians_of_rows(whole)
    bad = scatter / (0.6745 * np.sqrt(2)) > suspect
    if not bad.any():
        return uniform(time.size, GOOD)
    flags = filled(time.size, GOOD, np.int8)
    flags[1:-1][np.repeat(bad, np.diff(edges))] = SUSPECT
    return flags


def _interval_change(time: np.ndarray) -> np.ndarray:
    """Return the relative change of the interval at each sample except the first and last."""
    interval = np.diff(time)
    both = interval[1:] + interval[:-1]
    return np.abs(np.diff(interval)) / np.where(both > 0, both / 2, np.inf)


def rate_change(time: np.ndarray, factor: float = 1.5) -> int | None:
    """Return the index of the sample at which the sampling rate changes; None without a change.

    Parameters
    ----------
    time
        Sample times [s].
    factor
        Smallest ratio of the intervals before and after that counts as a change.

    Returns
    -------
    int or None
        Index of the first sample at the new rate, within some samples; None if it is constant.

    Examples
    --------
    >>> rate_change(np.concatenate([np.arange(100.0), 100 + 0.1 * np.arange(100)]))
    100
    """
    if time.size < 2:
        return None
    interval = without_gaps(np.diff(time))
    if 0 < interval.max() <= factor * interval.min():
        return None
    least = _fastest_interval(interval, factor) or _uneven_interval(interval, factor)
    if not least:
        return None
    # find the split into two levels with the least scatter of the logarithms
    level = np.log(np.maximum(interval, 1e-3 * least))
    count = np.arange(1, level.size)
    total = np.cumsum(level)
    means = total[:-1] / count, (total[-1] - total[:-1]) / (level.size - count)
    cut = int(np.argmax(count * (level.size - count) * (means[0] - means[1]) ** 2)) + 1
    return cut


def _fastest_interval(interval: np.ndarray, factor: float) -> float:
    """Return the smallest mean interval among parts with equal row counts; 0 if all are similar."""
    parts = min(_PARTS, interval.size // 8)
    if parts < 2:
        return 0.0
    edges = np.linspace(0, interval.size, parts + 1).astype(int)
    means = np.add.reduceat(interval, edges[:-1]) / np.diff(edges)
    return float(means.min()) if means.max() > factor * means.min() else 0.0


def _uneven_interval(interval: np.ndarray, factor: float) -> float:
    """Return the usual interval if equal periods have very different row counts; else 0."""
    cumulative = np.cumsum(interval)
    marks = np.linspace(0, cumulative[-1], _PARTS + 1)
    rows = np.diff(np.searchsorted(cumulative, marks))
    # for irregular intervals, row counts scatter by at most their square root
    clear = rows.max() > factor * rows.min() + 4 * np.sqrt(rows.max())
    return float(median(interval)) if clear else 0.0


def rate_changes(time: np.ndarray, factor: float = 1.5, stretch: int = 32) -> np.ndarray:
    """Return the indices of samples from which the sampling rate differs for some time.

    Parameters
    ----------
    time
        Sample times [s].
    factor
        Smallest ratio of the mean intervals before and after, without gaps, that is a change.
    stretch
        Number of samples over which a rate must be constant.

    Returns
    -------
    ndarray of int
        Index of the first sample at each new rate, within some samples.
    """
    if time.size <= 2 * stretch:
        return np.zeros(0, dtype=int)
    blocks = (time.size - 1) // stretch
    level = np.empty(blocks)
    for begin, end in pieces(0, blocks, block=stretch):
        # two more intervals on either side, because gaps are found by comparison with neighbours
        low, high = max(begin * stretch - 2, 0), end * stretch + 2
        interval = without_gaps(np.diff(time[low : high + 1]))
        own = interval[begin * stretch - low :][: (end - begin) * stretch]
        level[begin:end] = own.reshape(-1, stretch).mean(axis=1)
    level = np.log(np.maximum(level, np.finfo(float).tiny))
    # compare the blocks on both sides of the one in which the rate changes
    jump = np.abs(level[2:] - level[:-2]) > np.log(factor)
    begins = np.flatnonzero(jump & ~np.concatenate([[False], jump[:-1]]))
    changes = []
    for block in begins:
        start = block * stretch
        cut = rate_change(time[start : start + 3 * stretch + 1], factor)
        if cut is not None:
            changes.append(start + cut)
    return np.array(changes, dtype=int)
