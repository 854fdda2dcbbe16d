"""Sentinels that instruments write for missing values: -9999, 65535, 9.9E37.

A sentinel is repeated exactly, is a number that programs choose for the purpose, and is far outside
the other values of its column. SCPI instruments return 9.9E37 for an overload and 9.91E37 for not a
number; 1.70141E+38 and 3.40282E+38 are the largest numbers of old programs.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import anywhere, pieces

LARGEST = 1e60  # SI; larger numbers count as damage; the fourth power of this limit is finite
_NO_SIGNAL = 9.8e29  # in the file's unit; larger numbers are sentinels even if they occur once
_NINES = (999.0, 9999.0, 99999.0, 999999.0, 9999999.0, 99999999.0)
_MARKS = np.array(
    [
        *_NINES,
        *(nines + part for nines in _NINES[:4] for part in (0.9, 0.99, 0.999)),
        999.25,
        *(32767.0, 32768.0, 65535.0, 8388607.0, 8388608.0, 16777215.0),
        *(2147483647.0, 2147483648.0, 4294967295.0),
    ]
)
# full-scale values of 24- and 16-bit converters, possibly divided by a power of ten: -8388.608
_FULL = np.array([8388607.0, 8388608.0, 16777215.0, 32767.0, 32768.0, 65535.0])
_FULL = np.concatenate([_FULL / 10.0**power for power in range(1, 7)])
_ROUNDED = 1e-5  # relative rounding of a sentinel with few decimals
_SINGLE = 2e-7  # relative rounding in single precision
_TWICE = 2  # fewest occurrences of a sentinel
_OUTSIDE = 5.0  # least ratio of a sentinel to the largest other number
_KINDS = 4  # most different sentinels per column


class Marked(NamedTuple):
    """Sentinel as written in the file, and how often it occurs."""

    number: float
    rows: int

    @property
    def words(self) -> str:
        """Sentinel and number of occurrences in words."""
        times = "once" if self.rows == 1 else f"{self.rows} times"
        return f"{self.number:.9g} {times}"


def take_marks(
    parts: Sequence[np.ndarray], scale: float = 1.0, offset: float = 0.0
) -> list[Marked]:
    """Replace the sentinels of a column by NaN, and return them.

    Parameters
    ----------
    parts
        A column in pieces (row); changed in place.
    scale, offset
        Conversion of the file's numbers x to SI: ``scale * x + offset``.

    Returns
    -------
    list of Marked
        Sentinels that were replaced; empty for most columns.

    Examples
    --------
    >>> column = np.array([1.0, -9999.0, 1.2, -9999.0, 9.9e37])
    >>> [mark.words for mark in take_marks([column])], column.tolist()
    (['-9999 2 times', '9.9e+37 once'], [1.0, nan, 1.2, nan, nan])
    >>> take_marks([np.array([9998.0, 9999.0, 9999.0])])
    []
    """
    taken: list[Marked] = []
    for _ in range(_KINDS):
        ends = [end for end in _extremes(parts) if _may_be_mark((end - offset) / scale)]
        if not ends:
            break
        rest = _largest_other(parts, ends, scale, offset)
        marks = [mark for end in ends if (mark := _sentinel_of(end, parts, rest, scale, offset))]
        if not marks:
            break
        taken += [Marked(number, count) for _, number, count in marks]
        for end, _, _ in marks:
            _mask_mark(parts, end)
    return taken


def _extremes(parts: Sequence[np.ndarray]) -> list[float]:
    """Return the lowest and highest finite number of a column."""
    filled = [part for part in parts if part.size]
    ends = {float(np.fmin.reduce(part)) for part in filled}
    ends |= {float(np.fmax.reduce(part)) for part in filled}
    finite = [end for end in ends if np.isfinite(end)]
    return sorted({min(finite), max(finite)}) if finite else []


def _may_be_mark(number: float) -> bool:
    size = abs(number)
    if size > _NO_SIGNAL or (np.abs(_MARKS - size) <= _SINGLE * size).any():
        return True
    return bool((np.abs(_FULL - size) <= _ROUNDED * size).any())


def _sentinel_of(
    end: float, parts: Sequence[np.ndarray], rest: float, scale: float, offset: float
) -> tuple[float, float, int] | None:
    """Return a sentinel in SI and as in the file, with its count; None if it is a measurement."""
    number = (end - offset) / scale
    count = sum(int((part[a:b] == end).sum()) for part in parts for a, b in pieces(0, part.size))
    number = float(f"{number:.9g}")
    if abs(number) > _NO_SIGNAL:
        return end, number, count
    far = np.isfinite(rest) and abs(number) >= _OUTSIDE * rest
    return (end, number, count) if far and count >= _TWICE else None


def _largest_other(
    parts: Sequence[np.ndarray], ends: Sequence[float], scale: float, offset: float
) -> float:
    """Return the largest magnitude of all other numbers, in the file's unit; -inf without any."""
    largest = -np.inf
    for part in parts:
        for first, last in pieces(0, part.size):
            piece = part[first:last]
            other = piece[np.isfinite(piece) & ~np.isin(piece, ends)]
            if other.size:
                largest = max(largest, float(np.abs((other - offset) / scale).max()))
    return largest


def _mask_mark(parts: Sequence[np.ndarray], number: float) -> None:
    for part in parts:
        if not anywhere(lambda piece: piece == number, part):
            continue
        for first, last in pieces(0, part.size):
            piece = part[first:last]
            piece[piece == number] = np.nan


def measurable(values: np.ndarray) -> np.ndarray:
    """Return values with impossibly large ones as NaN, and negligibly small ones as 0.

    This keeps squares and ratios of the values finite. Infinite values are kept here, and refused
    or left out later.

    >>> measurable(np.array([1.0, -1e300, 1e-310])).tolist()
    [1.0, nan, 0.0]
    """
    if values.dtype.kind != "f" or not anywhere(_odd, values):
        return values
    return np.where(beyond_range(values), np.nan, np.where(_is_negligible(values), 0.0, values))


def _odd(values: np.ndarray) -> np.ndarray:
    return beyond_range(values) | _is_negligible(values)


def beyond_range(values: np.ndarray) -> np.ndarray:
    """Return a mask of finite numbers that are physically impossible."""
    return (np.abs(values) > LARGEST) & np.isfinite(values)


def _is_negligible(values: np.ndarray) -> np.ndarray:
    """Return a mask of numbers that are negligibly small."""
    size = np.abs(values)
    return (size < 1 / LARGEST) & (size > 0)
