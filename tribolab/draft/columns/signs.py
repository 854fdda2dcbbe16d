"""The sign with which an instrument counts friction: against the motion, as a reaction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.draft.model import DraftColumn

_NOISE = 0.1  # of its lowest reading, what a sensor shows on the other side of zero
_ONE_WAY = 0.95  # share of the way of a motion that goes one way
_JUMP = 0.25  # of its range, from which a position is set back between two readings
_PARTS = 2000  # readings of a position that are looked at: of all, the noise would make a way


def as_against_motion(columns: Sequence[DraftColumn], numbers: np.ndarray) -> list[DraftColumn]:
    """Turn a friction force that stays below zero while everything slides forward.

    Parameters
    ----------
    columns
        As they are understood.
    numbers
        Their numbers (rows, columns) as written.

    Notes
    -----
    Where it slides both ways the sign says nothing of what is friction, and is left alone.
    """
    held = {column.quantity: column for column in columns if column.used}
    force = held.get("friction_force")
    motion = held.get("sliding_velocity") or held.get("position")
    if force is None or motion is None or force.sign < 0:
        return list(columns)
    read = numbers[:, force.place - 1]
    read = read[np.isfinite(read)]
    if not read.size or not read.min() < 0 or read.max() > -_NOISE * read.min():
        return list(columns)
    moved = motion.sign * _moved(motion, numbers[:, motion.place - 1])
    if not moved.size or not moved[moved > 0].sum() > _ONE_WAY * np.abs(moved).sum():
        return list(columns)
    return [
        column._replace(sign=-1, note="a reaction: below zero while it slides forward")
        if column is force
        else column
        for column in columns
    ]


def _moved(motion: DraftColumn, values: np.ndarray) -> np.ndarray:
    """Return the ways of a motion with their signs; where a position is set back it did not go."""
    values = values[np.isfinite(values)]
    if motion.quantity != "position" or not values.size:
        return values
    steps = np.diff(values[:: max(len(values) // _PARTS, 1)])
    return steps[np.abs(steps) < _JUMP * np.ptp(values)]
