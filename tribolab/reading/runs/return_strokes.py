"""Detection of return strokes without load, e.g. of a lifted sled."""

from __future__ import annotations

import numpy as np

_BLOCKS = 4000  # blocks of rows, whose means show the turning points
_WAY = 0.05  # share of the whole range below which a motion is not a stroke
_BEGINNING, _CLEAR = 5, 4.0  # rows, and multiple of the scatter, beyond which motion has started
_MORE = 3  # rows of margin
_SLOW = 0.25  # share of the usual speed on a return stroke below which it is at rest


def has_return_strokes(position: np.ndarray) -> np.ndarray:
    """Return a mask of rows in strokes opposite to the first one (time).

    Parameters
    ----------
    position
        Position along the sliding direction (time); missing values are not in return strokes.

    Notes
    -----
    Rests at the ends belong to no stroke. Turning points are found from means of blocks, so that
    noise does not create any.

    Examples
    --------
    >>> way = np.concatenate([np.zeros(10), np.arange(20), np.full(10, 19), 19 - np.arange(20.0)])
    >>> way = np.repeat(way, 3)
    >>> back = has_return_strokes(way)
    >>> back[:110].any(), back[125:175].all()
    (np.False_, np.True_)
    """
    size = position.size
    edges = np.unique(np.linspace(0, size, min(_BLOCKS, size) + 1).astype(int))
    counts = np.add.reduceat(np.isfinite(position).astype(float), edges[:-1])
    sums = np.add.reduceat(np.nan_to_num(position), edges[:-1])
    known = np.flatnonzero(counts > 0)
    if known.size < 3:
        return np.zeros(size, dtype=bool)
    middle = 0.5 * (edges[known] + edges[known + 1])
    means = np.interp(0.5 * (edges[:-1] + edges[1:]), middle, sums[known] / counts[known])
    turns = _turns(means, _WAY * float(np.ptp(means)))
    back = np.zeros(size, dtype=bool)
    for first, last in zip(turns[1::2], turns[2::2], strict=False):
        steps = np.abs(np.diff(means[first : last + 1]))
        usual = np.median(steps[steps > 0.1 * steps.max(initial=0.0)]) if steps.any() else 0.0
        moving = first + np.flatnonzero(steps > _SLOW * usual)
        if moving.size:
            start, stop = edges[moving[0]], edges[min(moving[-1] + 2, means.size)]
            # a margin of some rows, so that no loaded rest of the stroke remains
            start += max(_rows_at_rest(position[start:stop]) - _MORE, 0)
            stop -= max(_rows_at_rest(position[start:stop][::-1]) - _MORE, 0)
            back[start:stop] = True
    return back


def _rows_at_rest(way: np.ndarray) -> int:
    """Return the number of rows at rest at the beginning of a stroke.

    The scatter is estimated from row-to-row differences.
    """
    steps = np.diff(way[np.isfinite(way)])
    scatter = 1.4826 * float(np.median(np.abs(steps - np.median(steps)))) if steps.size else 0.0
    first = np.nanmedian(way[:_BEGINNING]) if np.isfinite(way[:_BEGINNING]).any() else way[0]
    there = np.flatnonzero(np.abs(way[: way.size // 2] - first) <= _CLEAR * scatter)
    return int(there[-1]) + 1 if there.size else 0


def _turns(means: np.ndarray, least: float) -> list[int]:
    """Return the turning points of strokes; the first is the start of the first stroke."""
    turns, low, high, way = [0], 0, 0, 0
    for place, value in enumerate(means.tolist()):
        low = place if value <= means[low] else low
        high = place if value >= means[high] else high
        if way >= 0 and means[high] - value > least:  # upward, or direction still unknown
            turns += [high] if way else []
            way, low = -1, place
        elif way <= 0 and value - means[low] > least:
            turns += [low] if way else []
            way, high = 1, place
    return [*turns, high if way > 0 else low]
