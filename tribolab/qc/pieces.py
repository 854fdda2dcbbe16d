"""A long record piece by piece: what is worked on at a time fits into the cache."""

from __future__ import annotations

from collections.abc import Iterator

PIECE = 1 << 17  # samples


def pieces(start: int, stop: int, length: int = PIECE) -> Iterator[tuple[int, int]]:
    """Cut a stretch of samples into pieces.

    Parameters
    ----------
    start, stop
        First sample, and that behind the last.
    length
        Samples of a piece, at most.

    Yields
    ------
    tuple of int
        First sample of a piece, and that behind its last.

    Examples
    --------
    >>> list(pieces(2, 9, length=3))
    [(2, 5), (5, 8), (8, 9)]
    """
    for first in range(start, stop, length):
        yield first, min(first + length, stop)
