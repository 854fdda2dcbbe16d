"""Processing of long records in pieces that fit into the processor's cache."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TypeVar

import numpy as np

from tribolab.arrays.scratch import let_go, room

PIECE = 1 << 17  # samples per piece
_GIVEN_BACK = 1 << 21  # samples between returns of memory to the system; each return is slow
_Part = TypeVar("_Part")


def pieces(
    start: int, stop: int, length: int | None = None, *, block: int = 1
) -> Iterator[tuple[int, int]]:
    """Yield the first sample and the end (exclusive) of each piece of a range.

    The memory of the pieces is released after every few of them, and after the last.

    Parameters
    ----------
    start, stop
        First sample, and the end (exclusive).
    length
        Largest length of a piece; by default `PIECE` samples.
    block
        Samples per block, if `start` and `stop` count blocks.

    Yields
    ------
    tuple of int
        First sample of a piece, and the one after its last.

    Examples
    --------
    >>> list(pieces(2, 9, length=3))
    [(2, 5), (5, 8), (8, 9)]
    """
    length = length or max(1, PIECE // block)
    looked_at = 0
    for first in range(start, stop, length):
        yield first, min(first + length, stop)
        looked_at += length * block
        if looked_at >= _GIVEN_BACK or first + length >= stop:
            let_go()
            looked_at = 0


def whole_blocks(edges: np.ndarray) -> Iterator[tuple[int, int]]:
    """Yield the first block and the end (exclusive) of each piece; pieces have whole blocks.

    Parameters
    ----------
    edges
        First sample of each block, and the end of the last (block + 1).

    Yields
    ------
    tuple of int
        First block of a piece, and the one after its last.

    Examples
    --------
    >>> list(whole_blocks(np.array([0, PIECE // 2, PIECE, 9 * PIECE])))
    [(0, 2), (2, 3)]
    """
    first, count = 0, edges.size - 1
    while first < count:
        last = int(np.searchsorted(edges, edges[first] + PIECE, "right")) - 1
        last = min(max(last, first + 1), count)
        yield first, last
        let_go()
        first = last


def one_by_one(parts: Iterable[_Part]) -> Iterator[_Part]:
    """Yield the parts of a record one by one, and free the memory of each before the next.

    Examples
    --------
    >>> list(one_by_one([slice(0, 2), slice(4, 5)]))
    [slice(0, 2, None), slice(4, 5, None)]
    """
    for part in parts:
        yield part
        let_go()


def anywhere(test: Callable[[np.ndarray], np.ndarray], values: np.ndarray) -> bool:
    """Return whether any sample passes a test; stops at the first that does.

    Examples
    --------
    >>> anywhere(np.isfinite, np.array([np.nan, 1.0])), anywhere(np.isfinite, np.array([np.nan]))
    (True, False)
    """
    return any(test(values[a:b]).any() for a, b in _all_of(values))


def samples_where(test: Callable[[np.ndarray], np.ndarray], values: np.ndarray) -> np.ndarray:
    """Return the indices of the samples for which a test is true.

    Examples
    --------
    >>> samples_where(np.isnan, np.array([1.0, np.nan, 2.0, np.nan])).tolist()
    [1, 3]
    """
    hits = [first + np.flatnonzero(test(values[first:last])) for first, last in _all_of(values)]
    return np.concatenate([np.zeros(0, int), *hits])


def _all_of(values: np.ndarray) -> Iterator[tuple[int, int]]:
    return pieces(0, len(values))


def stretches(has_property: Callable[[int, int], np.ndarray], count: int) -> np.ndarray:
    """Return the intervals of a record within which a condition is true.

    Parameters
    ----------
    has_property
        Function from the first sample and the end of a piece to its mask.
    count
        Samples of the record.

    Returns
    -------
    ndarray
        First sample and end of each interval (stretch, 2).

    Examples
    --------
    >>> values = np.array([1, 5, 6, 2, 7])
    >>> stretches(lambda a, b: values[a:b] > 3, 5).tolist()
    [[1, 3], [4, 5]]
    """
    edges, before = [np.zeros(0, int)], False
    for first, last in pieces(0, count):
        now = has_property(first, last)
        edges.append(first + np.flatnonzero(now != np.concatenate([[before], now[:-1]])))
        before = bool(now[-1])
    end = np.array([count] if before else [], dtype=int)
    return np.concatenate([*edges, end]).reshape(-1, 2)


def concatenate_parts(parts: Sequence[np.ndarray]) -> np.ndarray:
    """Return the parts of a record joined to one array.

    Examples
    --------
    >>> concatenate_parts([np.array([1.0, 2.0]), np.array([3.0])]).tolist()
    [1.0, 2.0, 3.0]
    """
    whole = room(sum(len(part) for part in parts), np.result_type(*parts))
    end = 0
    for part in parts:
        for first, last in pieces(0, len(part)):
            whole[end + first : end + last] = part[first:last]
        end += len(part)
    return whole


def chosen(values: np.ndarray, keep: np.ndarray) -> np.ndarray:
    """Return the samples that a mask selects.

    Examples
    --------
    >>> chosen(np.array([1.0, 2.0, 3.0]), np.array([True, False, True])).tolist()
    [1.0, 3.0]
    """
    left = room(int(np.count_nonzero(keep)), values.dtype)
    end = 0
    for first, last in pieces(0, values.size):
        some = values[first:last][keep[first:last]]
        left[end : end + some.size] = some
        end += some.size
    return left


def lowered(values: np.ndarray, by: float) -> np.ndarray:
    """Return values minus a constant.

    Examples
    --------
    >>> lowered(np.array([1.0, 2.0]), 0.5).tolist()
    [0.5, 1.5]
    """
    result = room(values.size)
    for first, last in pieces(0, values.size):
        result[first:last] = values[first:last] - by
    return result


def running_total(values: np.ndarray, level: float = 0.0) -> np.ndarray:
    """Return the cumulative sum of values minus a level, starting with 0.

    Examples
    --------
    >>> running_total(np.array([1.0, 2.0]), 0.5).tolist()
    [0.0, 0.5, 2.0]
    """
    total = room(values.size + 1)
    total[0] = 0.0
    for first, last in pieces(0, values.size):
        part = total[first : last + 1]
        # add the previous sum first, so that the result does not depend on the size of the pieces
        part[1:] = values[first:last] - level
        np.cumsum(part, out=part)
    return total
