"""Profiles whose sensor went to and fro: passes over one line, with rests and turns between them.

Rows at rest are many at one place; as they stand they would weigh as a long piece of surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.wording import Count

_END = 0.2  # of the way, at each of its ends, where the sensor turns
_JUMP = 0.1  # of the way: so far no sensor goes between two rows of a pass
_MIN_PLACES = 16  # places of a pass
_GAP = 3.5  # steps without a height, over which none is interpolated
_UNEVEN = 0.3  # of the places that an even pass would have, at least


class Passes(NamedTuple):
    """Heights [m] (pass, x) over one even grid of places, its distance [m], and what was done."""

    pitch: float
    heights: np.ndarray
    start: float
    told: str


def find_passes(x: np.ndarray, height: np.ndarray) -> Passes | None:
    """Part positions that go to and fro, or rest, into passes; None where they are one plain way.

    Parameters
    ----------
    x, height
        Positions and heights [m] (row), in the order in which they were taken.

    Returns
    -------
    Passes or None
        Places that were met several times in a pass count once, with their mean height.

    Examples
    --------
    >>> there = np.concatenate([np.zeros(40), np.arange(1.0, 99.0), np.full(30, 99.0)])
    >>> x = np.concatenate([there, there[::-1]])
    >>> found = find_passes(x, np.sin(x))
    >>> found.heights.shape, found.pitch
    ((2, 100), 1.0)
    """
    known = np.isfinite(x)
    x, height = x[known], height[known]
    steps = np.diff(x)
    if steps.size < _MIN_PLACES or (steps > 0).all() or (steps < 0).all():
        return None
    low, reach = float(x.min()), float(np.ptp(x))
    if not reach > 0 or np.abs(steps).max() > _JUMP * reach:
        return None
    places = [
        pass_
        for first, last in _ways(x, low, reach)
        if (pass_ := _pass(x[first : last + 1], height[first : last + 1])) is not None
    ]
    if not places:
        return None
    pitch = float(np.median([float(median(np.diff(place))) for place, _ in places]))
    if min(place.size for place, _ in places) < _UNEVEN * reach / pitch:
        return None
    start = max(float(place[0]) for place, _ in places)
    end = min(float(place[-1]) for place, _ in places)
    grid = start + pitch * np.arange(int((end - start) / pitch * (1 + 1e-9)) + 1)
    heights = np.stack([_on(grid, place, values, pitch) for place, values in places])
    told = (
        f"{Count(len(places)):pass|passes} over one line, of {Count(x.size):row|rows}; places at "
        f"rest count once, heights are interpolated to steps of {1e6 * pitch:.4g} um"
    )
    return Passes(pitch, heights, start, told)


def _ways(x: np.ndarray, low: float, reach: float) -> list[tuple[int, int]]:
    """First and last row of each way from one end to the other."""
    at = np.where(x <= low + _END * reach, -1, np.where(x >= low + (1 - _END) * reach, 1, 0))
    ends = np.flatnonzero(at)
    side = at[ends]
    edges = np.flatnonzero(np.diff(side))
    firsts = np.concatenate([[0], edges + 1])
    lasts = np.concatenate([edges, [ends.size - 1]])
    stays = [
        (ends[first], ends[last], side[first]) for first, last in zip(firsts, lasts, strict=True)
    ]
    ways = []
    for (begin, leave, own), (arrive, done, _) in zip(stays, stays[1:], strict=False):
        here, there = own * x[begin : leave + 1], -own * x[arrive : done + 1]
        first = leave - int(np.argmax(here[::-1]))  # where it left the end
        ways.append((int(first), int(arrive + np.argmax(there))))
    return ways


def _pass(x: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Places of one pass from left to right, and the mean height at each."""
    places, place = np.unique(x, return_inverse=True)
    if places.size < _MIN_PLACES:
        return None
    here = np.isfinite(height)
    number = np.bincount(place[here], minlength=places.size)
    total = np.bincount(place[here], height[here], places.size)
    mean = np.full(places.size, np.nan)
    np.divide(total, number, out=mean, where=number > 0)
    return places, mean


def _on(grid: np.ndarray, places: np.ndarray, heights: np.ndarray, pitch: float) -> np.ndarray:
    """Interpolate along straight lines; NaN inside gaps."""
    here = np.isfinite(heights)
    if here.sum() < _MIN_PLACES:
        return np.full(grid.size, np.nan)
    x, z = places[here], heights[here]
    after = np.clip(np.searchsorted(x, grid), 1, x.size - 1)
    gap = (x[after] - x[after - 1] > _GAP * pitch) & (grid > x[after - 1]) & (grid < x[after])
    outside = (grid < x[0] - 0.5 * pitch) | (grid > x[-1] + 0.5 * pitch)
    return np.where(gap | outside, np.nan, np.interp(grid, x, z))
