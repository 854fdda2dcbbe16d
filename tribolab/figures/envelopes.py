"""Reduction of long traces to few points: extremes if noisy, every n-th point if smooth."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.chunks import whole_blocks


def envelope(x: np.ndarray, y: np.ndarray, columns: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Reduce a trace to its smallest and largest point in each pixel column.

    Parameters
    ----------
    x
        Abscissa (point), never decreasing, without NaN.
    y
        Ordinate (point); NaN is a gap.
    columns
        Number of pixel columns over the whole range of `x`.

    Returns
    -------
    x, y
        Points of the trace in order, at most two per column. A column with only NaN keeps one, as a
        gap. A short trace is unchanged.

    Notes
    -----
    Means would lose spikes of a single sample; every n-th point would show them only by chance. The
    extremes of each column cover the same area as a plot of all points.

    Examples
    --------
    >>> x = np.arange(10_000.0)
    >>> y = np.zeros(10_000)
    >>> y[4321] = 7.0
    >>> short_x, short_y = envelope(x, y, columns=50)
    >>> short_x.size <= 100, short_y.max(), short_x[short_y.argmax()]
    (True, np.float64(7.0), np.float64(4321.0))
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    chosen = envelope_index(x, y, columns)
    return (x, y) if chosen.size == x.size else (x[chosen], y[chosen])


def envelope_index(x: np.ndarray, y: np.ndarray, columns: int = 400) -> np.ndarray:
    """Return the indices of the points that `envelope` keeps, in increasing order.

    Parameters
    ----------
    x, y, columns
        As for `envelope`.

    Examples
    --------
    >>> envelope_index(np.arange(8.0), np.array([0, 5, 1, 0, 0, -2, 0, 0.5]), columns=2)
    array([0, 1, 5, 7])
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.size <= 2 * columns:
        return np.arange(x.size)
    return extremes_index(y, _starts(x, columns))


def extremes_index(y: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Return the indices of the first minimum and maximum of each column, in increasing order.

    Parameters
    ----------
    y
        Samples.
    starts
        Index of the first sample of each column, increasing; the last one ends with the record.

    Examples
    --------
    >>> extremes_index(np.array([0, 5, 1, 0, 0, -2, 0, 0.5]), np.array([0, 4]))
    array([0, 1, 5, 7])
    """
    edges = np.append(starts, y.size)
    kept = []
    for first, last in whole_blocks(edges):
        begin = edges[first]
        kept.append(begin + _extremes(y[begin : edges[last]], starts[first:last] - begin))
    return np.concatenate(kept)


def thinned(count: int, most: int = 400) -> np.ndarray:
    """Return the indices of at most `most` evenly spaced points of a curve, with both ends.

    Examples
    --------
    >>> thinned(5).tolist(), thinned(1000, 5).tolist()
    ([0, 1, 2, 3, 4], [0, 250, 500, 749, 999])
    """
    if count <= most:
        return np.arange(count)
    return np.round(np.linspace(0, count - 1, most)).astype(int)


def _starts(x: np.ndarray, columns: int) -> np.ndarray:
    """Return the index of the first point in each pixel column that contains points."""
    edges = np.arange(1, columns) / columns
    if x[-1] > x[0]:  # a weighted mean of both ends is finite for any span
        starts = np.searchsorted(x, x[0] * (1 - edges) + x[-1] * edges)
    else:
        starts = np.ceil(edges * (x.size - 1)).astype(np.int64)
    starts = np.unique(np.append(0, starts))
    return starts[starts < x.size]


def _extremes(y: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Return the indices of the first minimum and first maximum of each column."""
    ends = np.append(starts[1:], y.size)
    lowest, highest = (
        _first_at(y, extreme.reduceat(y, starts), starts, ends) for extreme in (np.fmin, np.fmax)
    )
    both = np.stack([np.minimum(lowest, highest), np.maximum(lowest, highest)], axis=1).ravel()
    return both[np.diff(both, prepend=-1) > 0]


def _first_at(y: np.ndarray, level: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return for each column the first index at which y equals a level, e.g. its maximum."""
    hits = np.append(np.flatnonzero(y == np.repeat(level, ends - starts)), y.size)
    first = hits[np.searchsorted(hits, starts)]
    return np.where(first < ends, first, starts)  # without a hit, as for NaN, the first index
