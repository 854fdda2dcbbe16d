"""Tables of results: a row for each speed, where a record of signals is wanted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.draft.model import DraftColumn

_MOST = 200  # rows; a ramp that is sampled so seldom is no record either
_FEWEST = 3
_RISE = 1.02  # from speed to speed


def results_told(columns: Sequence[DraftColumn], numbers: np.ndarray) -> list[str]:
    """Say so where every row has another speed, one above the other.

    Parameters
    ----------
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.

    Returns
    -------
    list of str
        One guess, or none.
    """
    held = {column.quantity: column for column in columns if column.used}
    speed = held.get("sliding_velocity") or held.get("rotation_speed")
    if speed is None or not _FEWEST <= len(numbers) <= _MOST:
        return []
    size = np.abs(numbers[:, speed.place - 1])
    steps = (size[1:] > _RISE * size[:-1], size[1:] * _RISE < size[:-1])
    if not any(step.all() for step in steps):
        return []
    return [
        f"each row is of another speed: {len(numbers)} results, of whose error nothing is known, "
        "and no record of signals; give the file that they were made of"
    ]
