"""Sentinels among heights: an exact number far from all others, or one that the header states."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label
from tribolab.reading.raw.missing_marks import Marked
from tribolab.reading.scans.limits import (
    MAX_DIGITS_OF_MARK,
    MAX_SHARE_OF_MARK,
    MIN_DISTANCE_OF_MARK,
    MIN_DISTANCE_OF_SINGLE_MARK,
    MIN_OTHER_HEIGHTS,
)


def take_isolated(height: np.ndarray) -> list[Marked]:
    """Replace sentinels (exact heights far outside all others) by NaN, and return them.

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
        rest = known[np.all([known != end for end in ends], axis=0)]
        if not rest.size:
            continue
        bottom, top = float(rest.min()), float(rest.max())
        if (
            all(
                max(bottom - end, end - top) > _min_distance(end, count) * (top - bottom)
                for end, count in zip(ends, counts, strict=True)
            )
            and np.unique(rest).size >= MIN_OTHER_HEIGHTS.value
        ):
            height[np.isin(height, ends)] = np.nan
            return [Marked(end, count) for end, count in zip(ends, counts, strict=True)]
    return []


def _min_distance(number: float, count: int) -> float:
    """Return the least distance of a sentinel from the other heights, in units of their range."""
    if count > 1:
        return MIN_DISTANCE_OF_MARK.value
    rounded = float(f"{number:.{int(MAX_DIGITS_OF_MARK.value)}g}")
    is_round = abs(number - rounded) <= 1e-9 * abs(number)
    return MIN_DISTANCE_OF_SINGLE_MARK.value if is_round else np.inf


_SINGLE_PRECISION = 2e-7  # relative precision of a single-precision number
_TWICE = 2  # fewest occurrences of a sentinel whose name is unknown
_PARAMETER = re.compile(r"\b[RS]\w{1,2}\b")  # roughness parameters: Ra, Sq


def take_stated(
    values: np.ndarray, stated: Iterable[tuple[str, float]]
) -> list[tuple[str, float, int]]:
    """Replace sentinels stated in the header by NaN.

    Parameters
    ----------
    values
        Heights as in the file; changed in place.
    stated
        Names and numbers without units in the header.

    Returns
    -------
    list of tuple
        Name, number and occurrences of each sentinel. A number with an unknown name is a sentinel
        if it is repeated and far outside all other heights.

    Examples
    --------
    >>> heights = np.array([1.0, -999.0, 3.0, -999.0])
    >>> take_stated(heights, [("rows", 3.0), ("puuttuva arvo", -999.0)]), heights.tolist()
    ([('puuttuva arvo', -999.0, 2)], [1.0, nan, 3.0, nan])
    """
    taken = []
    for name, number in stated:
        here = np.abs(values - number) <= _SINGLE_PRECISION * abs(number)
        count = int(here.sum())
        if not count or not _is_mark(values, here, name, number):
            continue
        values[here] = np.nan
        taken.append((name, number, count))
    return taken


def _is_mark(values: np.ndarray, here: np.ndarray, name: str, number: float) -> bool:
    """Whether a stated number is a sentinel and not e.g. a count ("missing: 5").

    A number whose name says so may be within the range of heights: "no data value: 0".
    """
    rest = values[~here & np.isfinite(values)]
    if not rest.size:
        return False
    low, high = float(rest.min()), float(rest.max())
    outside = max(low - number, number - high)
    key = normalise_label(name)
    if key_pattern("no_height").search(key):
        counted = "%" in name or key_pattern("how_many").search(key)
        return outside > 0 or bool(key_pattern("as_value").search(key) and not counted)
    result = _PARAMETER.search(name) or key_pattern("of_heights").search(key)
    return outside > high - low and int(here.sum()) >= _TWICE and not result
