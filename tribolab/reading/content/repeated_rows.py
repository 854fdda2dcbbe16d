"""Tables in which each row stands several times, as programs write them that log too fast."""

from __future__ import annotations

import numpy as np

from tribolab.reading.content.model import Content, Piece

_FEW = 8  # rows that show a habit
_MOST = 10  # times that a row may stand there


def times_over(columns: dict[str, np.ndarray]) -> int:
    """Return how often each row of a table stands there, one after the other: 1 if only once.

    Parameters
    ----------
    columns
        Arrays of the table by name, ``time`` among them (row).

    Examples
    --------
    >>> times_over({"time": np.repeat(np.arange(9.0), 2), "force": np.repeat(np.ones(9), 2)})
    2
    """
    time = columns["time"]
    first = time[: _MOST + 1]
    times = int(np.count_nonzero(first == first[0])) if first.size else 1
    if not 1 < times <= _MOST or time.size % times or time.size < _FEW * times:
        return 1
    once = time[::times]
    if (once[1:] == once[:-1]).any():
        return 1  # a clock with coarse ticks
    for values in columns.values():
        for offset in range(1, times):
            if not np.array_equal(values[::times], values[offset::times], equal_nan=True):
                return 1
    return times


def each_row_once(content: Content) -> Content:
    """Return a file's tables with each row once, and say so if it stood there more often."""
    pieces, most = [], 1
    for piece in content.pieces:
        times = times_over(piece.columns)
        most = max(most, times)
        pieces.append(_thinned(piece, times) if times > 1 else piece)
    if most == 1:
        return content
    how_often = "twice" if most == 2 else f"{most} times"
    notes = {**content.notes, "rows_repeated": f"each row stands {how_often}, and is taken once"}
    return content._replace(pieces=pieces, notes=notes)


def _thinned(piece: Piece, times: int) -> Piece:
    kept = {name: np.ascontiguousarray(part[::times]) for name, part in piece.columns.items()}
    return piece._replace(columns=kept)
