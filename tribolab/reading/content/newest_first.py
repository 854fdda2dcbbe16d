"""Tables whose newest row comes first, as programs write them that show the latest on top."""

from __future__ import annotations

import numpy as np

from tribolab.reading.content.model import Content

_FEW = 8  # rows that show an order


def is_newest_first(time: np.ndarray) -> bool:
    """Whether time falls from each row to the next.

    >>> is_newest_first(np.arange(9.0)[::-1]), is_newest_first(np.arange(9.0))
    (True, False)
    """
    if time.size < _FEW or not time[0] > time[-1]:
        return False
    return bool((time[1:] < time[:-1]).all())


def oldest_first(content: Content) -> Content:
    """Return a file's one table with its oldest row first, and say so if it was turned round."""
    if len(content.pieces) != 1 or not is_newest_first(content.pieces[0].columns["time"]):
        return content
    [piece] = content.pieces
    turned = {name: np.ascontiguousarray(part[::-1]) for name, part in piece.columns.items()}
    notes = {**content.notes, "rows_turned_round": "the newest row came first"}
    return content._replace(pieces=[piece._replace(columns=turned)], notes=notes)
