"""Tables of results: each row is the mean at one speed, where a record of signals is usual."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.reading.unknown.model import DraftColumn

_MAX_ROWS = 400  # rows
_MIN_ROWS = 3
_RISE = 1.02  # from speed to speed
_SWEEP = 8  # rows of a sweep up or down, at least, where there are several


def are_points(columns: Sequence[DraftColumn], numbers: np.ndarray) -> bool:
    """Whether every row is of another speed than its neighbours, in sweeps up and down."""
    held = {column.quantity: column for column in columns if column.used}
    speeds = ("sliding_velocity", "rotation_speed", "rolling_speed")
    column = next((held[name] for name in speeds if name in held), None)
    if column is None or not _MIN_ROWS <= len(numbers) <= _MAX_ROWS:
        return False
    size = np.abs(numbers[:, column.place - 1])
    size = size[np.isfinite(size)]
    if size.size < _MIN_ROWS or not (size > 0).all():
        return False
    steps = np.log(size[1:] / size[:-1])
    way = np.sign(steps)
    turns = np.flatnonzero(way[1:] != way[:-1])
    # the last speed of one sweep may be the first of the next
    held_on = np.abs(steps) < np.log(_RISE)
    return bool(turns.size <= size.size / _SWEEP) and int(held_on.sum()) <= turns.size / 2
