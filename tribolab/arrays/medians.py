"""Medians and quantiles by sorting, several times faster than `numpy.median`.

The checks of numpy cost more than the median of a few hundred values, and sorting uses vector
instructions that partitioning does not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import pieces

_MAX_SORTED = 1 << 20  # samples up to which a record is sorted as a whole
_STRETCHES, _SHORT = 256, 256  # number and length of the sampled parts of a long record
_AROUND = (0.05, 0.3)  # share of the values kept on each side of a quantile: first, second try


def median(values: np.ndarray) -> np.float64:
    """Return the median of all values; NaN if any value is NaN, or if there are none.

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
    """Return the median of the values that are not NaN; NaN if there are none.

    Examples
    --------
    >>> median_of_known(np.array([3.0, np.nan, 1.0]))
    np.float64(2.0)
    """
    return _median_of_sorted(np.sort(np.asarray(values, float), axis=None))


def medians_of_rows(rows: np.ndarray) -> np.ndarray:
    """Return the median of each row (row, column); NaN if any value in it is NaN.

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
    """Return the median of values that are computed piece by piece; NaN is ignored.

    Only values near the median of a long record are kept; the median is exact.

    Parameters
    ----------
    part
        Function from the first sample and the end of a piece to its values, of which there may be
        fewer than samples.
    count
        Samples of the record.

    Examples
    --------
    >>> squares = np.arange(5.0) ** 2
    >>> median_in_pieces(lambda a, b: squares[a:b], 5)
    np.float64(4.0)
    """
    about = _guess_bracket(part, count, 0.5)
    return np.float64((about.below + about.above) / 2) if about.beyond else about.below


def quantile_in_pieces(part: Callable[[int, int], np.ndarray], count: int, share: float) -> float:
    """Return a quantile of values computed piece by piece, as by `numpy.quantile`; NaN if none.

    Parameters
    ----------
    part, count
        As for `median_in_pieces`.
    share
        Share of the numbers that are not above the quantile [1].

    Examples
    --------
    >>> squares = np.arange(5.0) ** 2
    >>> round(quantile_in_pieces(lambda a, b: squares[a:b], 5, 0.9), 9)
    13.2
    """
    about = _guess_bracket(part, count, share)
    return float(np.quantile([about.below, about.above], about.beyond))


class _About(NamedTuple):
    """The two values around a quantile, and its position between them [1]; NaN if none."""

    below: np.float64
    above: np.float64
    beyond: float


def _guess_bracket(part: Callable[[int, int], np.ndarray], count: int, share: float) -> _About:
    if count >= _MAX_SORTED:
        tried = _sample_parts(part, count)
        for around in _AROUND if tried.size else ():
            low, high = np.quantile(tried, [max(share - around, 0), min(share + around, 1)])
            about = _bracketed_quantile(
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
    known = int(np.searchsorted(ordered, np.nan))  # NaN is sorted last
    about = _quantile_bracket(ordered, 0, known, share)
    return _About(np.float64(np.nan), np.float64(np.nan), 0.0) if about is None else about


def _sample_parts(part: Callable[[int, int], np.ndarray], count: int) -> np.ndarray:
    """Return samples from short parts of a record, which show where a quantile roughly is."""
    starts = np.linspace(0, count - _SHORT, _STRETCHES).astype(int).tolist()
    tried = np.concatenate([part(start, start + _SHORT) for start in starts])
    return tried[~np.isnan(tried)]


def _bracketed_quantile(
    part: Callable[[int, int], np.ndarray], count: int, bracket: tuple[float, float], share: float
) -> _About | None:
    """Return the values around a quantile if it is in a bracket, else None."""
    low, high = bracket
    below, known = 0, 0
    kept = [np.zeros(0)]
    for ends in pieces(0, count):
        numbers = part(*ends)
        numbers = numbers[~np.isnan(numbers)]
        known += numbers.size
        below += int(np.count_nonzero(numbers < low))
        kept.append(numbers[(numbers >= low) & (numbers <= high)])
    return _quantile_bracket(np.sort(np.concatenate(kept)), below, known, share)


def _quantile_bracket(ordered: np.ndarray, below: int, known: int, share: float) -> _About | None:
    """Return the values around a quantile; `ordered` lacks the `below` smallest values."""
    rank = share * (known - 1)
    first = int(np.floor(rank))
    last = first if first == rank else first + 1
    if not known or first < below or last - below >= ordered.size:
        return None
    return _About(ordered[first - below], ordered[last - below], rank - first)


def _median_of_sorted(numbers: np.ndarray) -> np.float64:
    """Return the median of sorted values, ignoring NaN at their end."""
    known = int(np.searchsorted(numbers, np.nan))
    return _middle(numbers[:known]) if known else np.float64(np.nan)


def _middle(ordered: np.ndarray) -> np.float64:
    """Return the median of one or more sorted values."""
    half = ordered.size // 2
    if ordered.size % 2:
        return ordered[half]
    return (ordered[half - 1] + ordered[half]) / 2
