"""Medians, by sorting: `numpy.median` takes several times as long, for few values and for many.

Its checks cost more than the median of a few hundred values, and the sorting of numbers uses
instructions of the processor that the search for a single rank does not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import pieces

_MANY = 1 << 20  # samples; fewer are sorted as a whole
_STRETCHES, _SHORT = 256, 256  # of a long record that are tried, and their samples
_AROUND = (0.05, 0.3)  # share of the numbers on each side of a quantile that are kept, at first


def median(values: np.ndarray) -> np.float64:
    """Return the median of all values; NaN if there is one among them, or none at all.

    Examples
    --------
    >>> median(np.array([3.0, 1.0, 2.0])), median(np.array([[4, 1], [2, 3]]))
    (np.float64(2.0), np.float64(2.5))
    """
    ordered = np.sort(np.asarray(values, float), axis=None)
    if not ordered.size or np.isnan(ordered[-1]):
        return np.float64(np.nan)
    return _middle(ordered)


def median_of_known(values: np.ndarray) -> np.float64:
    """Return the median of the values that are no NaN; NaN if there are none.

    Examples
    --------
    >>> median_of_known(np.array([3.0, np.nan, 1.0]))
    np.float64(2.0)
    """
    return _of_ordered(np.sort(np.asarray(values, float), axis=None))


def medians_of_rows(rows: np.ndarray) -> np.ndarray:
    """Return the median of each row (row, column); NaN where there is one in it.

    Examples
    --------
    >>> medians_of_rows(np.array([[3.0, 1.0, 2.0, 9.0], [0.0, 0.0, 5.0, np.nan]]))
    array([2.5, nan])
    """
    ordered = np.sort(rows, axis=1)
    half, odd = divmod(rows.shape[1], 2)
    middle = ordered[:, half] if odd else (ordered[:, half - 1] + ordered[:, half]) / 2
    return np.where(np.isnan(ordered[:, -1]), np.nan, middle)


def median_in_pieces(part: Callable[[int, int], np.ndarray], count: int) -> np.float64:
    """Return the median of numbers that are computed piece by piece, NaN left out.

    Of a long record only what lies near the median is kept; the median is the same.

    Parameters
    ----------
    part
        Gives the numbers of a piece, from its first sample and that behind its last; there may
        be fewer than samples.
    count
        Samples of the record.

    Examples
    --------
    >>> squares = np.arange(5.0) ** 2
    >>> median_in_pieces(lambda a, b: squares[a:b], 5)
    np.float64(4.0)
    """
    about = _about(part, count, 0.5)
    return np.float64((about.below + about.above) / 2) if about.beyond else about.below


def quantile_in_pieces(part: Callable[[int, int], np.ndarray], count: int, share: float) -> float:
    """Return a quantile of such numbers, as `numpy.quantile` gives it; NaN of none.

    Parameters
    ----------
    part, count
        As of `median_in_pieces`.
    share
        Of the numbers that are not above the quantile [1].

    Examples
    --------
    >>> squares = np.arange(5.0) ** 2
    >>> round(quantile_in_pieces(lambda a, b: squares[a:b], 5, 0.9), 9)
    13.2
    """
    about = _about(part, count, share)
    return float(np.quantile([about.below, about.above], about.beyond))


class _About(NamedTuple):
    """The numbers on both sides of a quantile, and its place between them [1]; NaN of none."""

    below: np.float64
    above: np.float64
    beyond: float


def _about(part: Callable[[int, int], np.ndarray], count: int, share: float) -> _About:
    if count >= _MANY:
        tried = _tried(part, count)
        for around in _AROUND if tried.size else ():
            low, high = np.quantile(tried, [max(share - around, 0), min(share + around, 1)])
            about = _near(
                part,
                count,
                (low if share > around else -np.inf, high if share + around < 1 else np.inf),
                share,
            )
            if about is not None:
                return about
    numbers, end = np.empty(count), 0
    for ends in pieces(0, count):
        own = part(*ends)
        numbers[end : end + own.size] = own
        end += own.size
    ordered = np.sort(numbers[:end])
    known = int(np.searchsorted(ordered, np.nan))  # NaN is sorted behind all numbers
    about = _between(ordered, 0, known, share)
    return _About(np.float64(np.nan), np.float64(np.nan), 0.0) if about is None else about


def _tried(part: Callable[[int, int], np.ndarray], count: int) -> np.ndarray:
    """Return the numbers of short stretches of a record, which tell about where a quantile lies."""
    starts = np.linspace(0, count - _SHORT, _STRETCHES).astype(int).tolist()
    tried = np.concatenate([part(start, start + _SHORT) for start in starts])
    return tried[~np.isnan(tried)]


def _near(
    part: Callable[[int, int], np.ndarray], count: int, bracket: tuple[float, float], share: float
) -> _About | None:
    """Tell by the numbers in a bracket what is about a quantile; None if it lies elsewhere."""
    low, high = bracket
    below, known = 0, 0
    kept = [np.zeros(0)]
    for ends in pieces(0, count):
        numbers = part(*ends)
        numbers = numbers[~np.isnan(numbers)]
        known += numbers.size
        below += int(np.count_nonzero(numbers < low))
        kept.append(numbers[(numbers >= low) & (numbers <= high)])
    return _between(np.sort(np.concatenate(kept)), below, known, share)


def _between(ordered: np.ndarray, below: int, known: int, share: float) -> _About | None:
    """Take what is about a quantile of so many known numbers from a part, so many above the least.

    None if it is not among them.
    """
    rank = share * (known - 1)
    first = int(np.floor(rank))
    last = first if first == rank else first + 1
    if not known or first < below or last - below >= ordered.size:
        return None
    return _About(ordered[first - below], ordered[last - below], rank - first)


def _of_ordered(numbers: np.ndarray) -> np.float64:
    """Return the median of what is no NaN; NaN is sorted behind all numbers."""
    known = int(np.searchsorted(numbers, np.nan))
    return _middle(numbers[:known]) if known else np.float64(np.nan)


def _middle(ordered: np.ndarray) -> np.float64:
    """Return the median of numbers in their order, one at least."""
    half = ordered.size // 2
    if ordered.size % 2:
        return ordered[half]
    return (ordered[half - 1] + ordered[half]) / 2
