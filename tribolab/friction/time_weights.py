"""Weights by time for means over unevenly sampled rows.

Notes
-----
Each row has the weight of half the interval before it and half the interval after it (trapezoidal
rule). A gap counts as one usual interval, because the signal is unknown there. A slower rate is not
a gap: it has at least three such intervals in a row.
"""

from __future__ import annotations

import numpy as np

from tribolab.friction.limits import MAX_UNEVEN, MIN_GAP

_COMPARED_ROWS = 1024  # rows of a first check for even sampling, before all rows are compared
_INTERVALS_AROUND = 5  # intervals whose median is the usual one


def sample_weights(time: np.ndarray) -> np.ndarray | None:
    """Return weights by time, summing to one; None for even sampling.

    Parameters
    ----------
    time
        Increasing sample times [s].

    Examples
    --------
    >>> time = np.concatenate([np.arange(0.0, 10.0, 0.1), np.arange(10.0, 30.0, 2.0)])
    >>> weight = sample_weights(time)
    >>> round(float(weight[time < 10].sum()), 2), sample_weights(np.arange(50.0)) is None
    (0.34, True)
    """
    if time.size < 3:
        return None
    marked = time
    if time.size > _COMPARED_ROWS:
        marked = time[np.linspace(0, time.size - 1, _COMPARED_ROWS).astype(int)]
    if not _is_uneven(marked):
        return None
    steps = without_gaps(np.diff(time))
    cumulative = np.concatenate([[0.0], np.cumsum(steps)])
    if not _is_uneven(cumulative):
        return None
    weight = np.append(steps, steps[-1]) + np.append(steps[0], steps)
    return weight / weight.sum()


def without_gaps(steps: np.ndarray) -> np.ndarray:
    """Return the intervals between rows, with gaps replaced by the usual interval around them.

    Parameters
    ----------
    steps
        Intervals [s].

    Examples
    --------
    >>> without_gaps(np.array([1.0, 1.0, 1.0, 50.0, 1.0, 1.0])).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    """
    # imported late: it loads slowly, and most records need none of it
    from scipy import ndimage

    usual = ndimage.median_filter(steps, min(_INTERVALS_AROUND, steps.size), mode="nearest")
    return np.where(steps > MIN_GAP.value * usual, usual, steps)


def _is_uneven(time: np.ndarray) -> bool:
    """Return whether sample times deviate from even spacing by a relevant share of the duration."""
    lasted = float(time[-1] - time[0])
    if not lasted > 0:
        return False
    even = np.linspace(0.0, 1.0, time.size)
    ahead = float(np.abs((time - time[0]) / lasted - even).max())
    # one row is allowed in addition, else no short record would count as even
    return ahead > MAX_UNEVEN.value + 1 / time.size


def on_grid(time: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Return means over `count` equal time intervals; empty ones are interpolated.

    Parameters
    ----------
    time, values
        Increasing sample times [s], and the signal (time).
    count
        Number of intervals.
    """
    weight = sample_weights(time)
    if weight is None:
        if count == values.size:
            return values
        weight = np.ones(time.size)
    edges = np.linspace(time[0], time[-1], count + 1)
    first = np.searchsorted(time, edges[:-1], side="left")
    last = np.append(first[1:], time.size)
    full = last > first
    result = np.full(count, np.nan)
    total = np.add.reduceat(weight, first[full])
    result[full] = np.add.reduceat(weight * values, first[full]) / total
    place = np.arange(count)
    result[~full] = np.interp(place[~full], place[full], result[full])
    return result
