"""Checks on the time axis: order, jitter, gaps, changes of the sampling rate.

Each is a plain function from an array and limits to flags (see :mod:`tribolab.qc.flags`).
"""

from __future__ import annotations

import numpy as np

from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT

_BLOCK = 64  # samples over which a sampling interval is called local


def _local_interval(interval: np.ndarray) -> np.ndarray:
    """Return the median interval of each block of samples, repeated to the intervals' length."""
    blocks = max(1, interval.size // _BLOCK)
    edges = np.linspace(0, interval.size, blocks + 1).astype(int)
    whole = interval[: blocks * (interval.size // blocks)].reshape(blocks, -1)
    return np.repeat(np.median(whole, axis=1), np.diff(edges))


def time_order(time: np.ndarray) -> np.ndarray:
    """Flag samples whose time does not lie after the one before.

    Parameters
    ----------
    time
        [s] (time)

    Returns
    -------
    ndarray
        fail where time stands still or goes back, good elsewhere.

    Examples
    --------
    >>> time_order(np.array([0.0, 1.0, 1.0, 2.0]))
    array([1, 1, 4, 1], dtype=int8)
    """
    flags = np.full(time.size, GOOD, np.int8)
    flags[1:][~(np.diff(time) > 0)] = FAIL
    return flags


def time_gaps(time: np.ndarray, suspect: float = 5.0) -> np.ndarray:
    """Flag the samples that follow a gap in time.

    Parameters
    ----------
    time
        [s] (time)
    suspect
        Length of a gap, in local sampling intervals (median of some 64 neighbours, the longer
        of the two sides where the rate changes), above which it is one.

    Returns
    -------
    ndarray
        suspect at the first sample after a gap, good elsewhere; not evaluated below three samples.
    """
    if time.size < 3:
        return np.full(time.size, NOT_EVALUATED, np.int8)
    interval = np.diff(time)
    local = _local_interval(interval)
    step = min(_BLOCK, interval.size)
    usual = np.maximum(local, np.maximum(np.roll(local, step), np.roll(local, -step)))
    # the roll wraps at the ends: there only the block itself and its one neighbour count
    usual[:step] = np.maximum(local[:step], local[min(step, local.size - 1)])
    usual[-step:] = np.maximum(local[-step:], local[max(-step - 1, -local.size)])
    flags = np.full(time.size, GOOD, np.int8)
    flags[1:][interval > suspect * usual] = SUSPECT
    return flags


def lost_time(time: np.ndarray, flags: np.ndarray) -> float:
    """Share of the record's duration that lies in gaps [1]."""
    interval = np.diff(time)
    return float(interval[flags[1:] == SUSPECT].sum() / (time[-1] - time[0]))


def time_jitter(time: np.ndarray, suspect: float = 0.25) -> np.ndarray:
    """Flag stretches whose sampling intervals scatter.

    Parameters
    ----------
    time
        [s] (time)
    suspect
        Robust standard deviation of the intervals within a block of some 64, relative to their
        median, above which the whole block is flagged.

    Returns
    -------
    ndarray
        suspect over blocks that jitter, good elsewhere; not evaluated below three samples.
    """
    if time.size < 3:
        return np.full(time.size, NOT_EVALUATED, np.int8)
    interval = np.diff(time)
    local = _local_interval(interval)
    scatter = 1.4826 * _local_interval(np.abs(interval - local))
    flags = np.full(time.size, GOOD, np.int8)
    flags[1:][scatter > suspect * local] = SUSPECT
    return flags


def rate_changes(time: np.ndarray, factor: float = 1.5) -> np.ndarray:
    """Find the samples at which the sampling rate changes for good.

    Parameters
    ----------
    time
        [s] (time)
    factor
        Ratio of the median intervals before and after.

    Returns
    -------
    ndarray of int
        Index of the first sample of each new rate, found to within one block of some 64 samples.
    """
    if time.size < 4 * _BLOCK:
        return np.zeros(0, dtype=int)
    local = _local_interval(np.diff(time))
    jump = np.abs(np.diff(np.log(local)))
    places = np.flatnonzero(jump > 0) + 1
    if places.size == 0:
        return places
    # a block that straddles the change has a median of its own: compare across it
    before = np.log(local[np.maximum(places - 1, 0)])
    after = np.log(local[np.minimum(places + _BLOCK, local.size - 1)])
    places = places[np.abs(after - before) > np.log(factor)]
    if places.size == 0:
        return places
    apart = np.diff(places, prepend=-10 * _BLOCK) > 2 * _BLOCK
    return places[apart]
