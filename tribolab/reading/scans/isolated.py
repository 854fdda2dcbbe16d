"""Undeclared sentinels among heights: an exact number far from all others."""

from __future__ import annotations

import numpy as np

from tribolab.reading.raw.missing_marks import Marked
from tribolab.reading.scans.limits import (
    MAX_DIGITS_OF_MARK,
    MAX_SHARE_OF_MARK,
    MIN_DISTANCE_OF_MARK,
    MIN_DISTANCE_OF_SINGLE_MARK,
    MIN_OTHER_HEIGHTS,
)


def take_isolated(height: np.ndarray) -> list[Marked]:
    """Replace an exact height that is far outside all others by NaN.

    Parameters
    ----------
    height
        Heights [m], of any shape; changed in place.

    Returns
    -------
    list of Marked
        The number [m] and how often it occurred.

    Notes
    -----
    A sentinel is the lowest or highest height, or there are two, one at each end. A single height
    counts as sentinel only if it is a round number, unlike a dust particle.

    Examples
    --------
    >>> height = np.append(np.linspace(437.13e-6, 457.29e-6, 50), -1e-6)
    >>> [mark.rows for mark in take_isolated(height)], int(np.isnan(height).sum())
    ([1], 1)
    """
    known = height[np.isfinite(height)]
    if not known.size:
        return []
    low, high = float(known.min()), float(known.max())
    for ends in ([low], [high], [low, high]):
        counts = [int((known == end).sum()) for end in ends]
        if sum(counts) > MAX_SHARE_OF_MARK.value * known.size:
            continue
        rest = known[~np.isin(known, ends)]
        if np.unique(rest).size < MIN_OTHER_HEIGHTS.value:
            continue
        bottom, top = float(rest.min()), float(rest.max())
        if all(
            max(bottom - end, end - top) > _min_distance(end, count) * (top - bottom)
            for end, count in zip(ends, counts, strict=True)
        ):
            height[np.isin(height, ends)] = np.nan
            return [Marked(end, count) for end, count in zip(ends, counts, strict=True)]
    return []


def _min_distance(number: float, count: int) -> float:
    """Return the distance in height ranges above which a number with this count is a sentinel."""
    if count > 1:
        return MIN_DISTANCE_OF_MARK.value
    rounded = float(f"{number:.{int(MAX_DIGITS_OF_MARK.value)}g}")
    is_round = abs(number - rounded) <= 1e-9 * abs(number)
    return MIN_DISTANCE_OF_SINGLE_MARK.value if is_round else np.inf
