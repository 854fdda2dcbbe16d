"""Tables in reverse order of time, as written by programs that show the latest row first."""

from __future__ import annotations

import numpy as np

from tribolab.reading.content.model import Content

_MIN_ROWS = 8  # rows needed to recognise the order


def is_newest_first(time: np.ndarray) -> bool:
    """Whether time decreases from each row to the next.

    >>> is_newest_first(np.arange(9.0)[::-1]), is_newest_first(np.arange(9.0))
    (True, False)
    """
    if time.size < _MIN_ROWS or not time[0] > time[-1]:
        return False
    return bool((time[1:] < time[:-1]).all())


def oldest_first(content: Content) -> Content:
    """Return a file with its single table in order of time, with a note if it was reversed."""
    if len(content.pieces) != 1 or not is_newest_first(content.pieces[0].columns["time"]):
        return content
    [piece] = content.pieces
    turned = {name: np.ascontiguousarray(part[::-1]) for name, part in piece.columns.items()}
    notes = {**content.notes, "rows_turned_round": "the newest row came first"}
    return content._replace(pieces=[piece._replace(columns=turned)], notes=notes)
