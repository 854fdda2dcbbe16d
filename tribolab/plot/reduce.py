"""A long trace drawn with few points and no spike lost."""

from __future__ import annotations

import numpy as np


def envelope(x: np.ndarray, y: np.ndarray, columns: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Reduce a trace to the smallest and the largest point of each pixel column.

    Parameters
    ----------
    x
        Abscissa, never decreasing, without NaN (n).
    y
        Ordinate (n); NaN is a gap.
    columns
        Number of pixel columns over the whole range of `x`.

    Returns
    -------
    x, y
        Points of the trace in their order, at most two a column; a column with nothing but NaN
        keeps one NaN, so that the line breaks there. A trace that is short already is returned
        as it is.

    Notes
    -----
    A mean or a stride per column would let a spike of one sample vanish or appear by chance
    (aliasing); the extremes of every column are what a plot of all points would cover.

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
    """Return which points of a trace `envelope` keeps, in their order.

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
    span = x[-1] - x[0]
    # dividing before the product keeps the ratio finite for any span
    place = (x - x[0]) / span if span > 0 else np.linspace(0, 1, x.size)
    column = np.minimum((place * columns).astype(np.int64), columns - 1)
    starts = np.flatnonzero(np.r_[True, np.diff(column) > 0])
    group = np.repeat(np.arange(starts.size), np.diff(np.r_[starts, x.size]))
    order = np.arange(x.size)

    def first_where(hit: np.ndarray) -> np.ndarray:
        return np.minimum.reduceat(np.where(hit, order, x.size), starts)

    lowest = first_where(y == np.fmin.reduceat(y, starts)[group])
    highest = first_where(y == np.fmax.reduceat(y, starts)[group])
    empty = lowest == x.size  # NaN equals nothing: the column has no number
    lowest[empty] = highest[empty] = starts[empty]
    return np.unique(np.r_[lowest, highest])
