"""Friction that is counted against the motion: its sign is the instrument's, not the contact's."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.draft.model import DraftColumn

_MOVES, _RESTS = 0.05, 0.005  # of the highest speed
_FEWEST = 20  # rows
_NEARLY_ALL = 0.95  # of the rows that move
_CLEAR = 3.0  # times the scatter
_SPEEDS = ("sliding_velocity", "rotation_speed")
COUNTED_SO = "it is counted against the motion: no friction drives what slides"


def against_motion(columns: Sequence[DraftColumn], numbers: np.ndarray) -> list[DraftColumn]:
    """Turn a friction force that points along the motion wherever it slides.

    Parameters
    ----------
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.

    Notes
    -----
    It has to be so with what the signal shows at rest taken off and with it, as an offset of the
    sensor has any sign. Of a record without rests nothing is known: what creeps at a low speed
    rests by no means, and may have more friction than what goes fast.
    """
    speed = next((c for c in columns if c.used and c.quantity in _SPEEDS), None)
    force = [c for c in columns if c.used and c.quantity == "friction_force" and not c.optional]
    if speed is None or len(force) != 1 or force[0].sign != 1:
        return list(columns)
    velocity, signal = (numbers[:, c.place - 1] for c in (speed, force[0]))
    known = np.isfinite(velocity) & np.isfinite(signal)
    size = np.abs(velocity)
    top = float(np.max(size[known], initial=0.0))
    rests, moves = known & (size < _RESTS * top), known & (size > _MOVES * top)
    if min(np.count_nonzero(rests), np.count_nonzero(moves)) < _FEWEST:
        return list(columns)
    if abs(float(np.median(velocity[rests]))) > _CLEAR * _scatter(velocity[rests]):
        return list(columns)  # it slides, only slowly
    way, zero = np.sign(velocity[moves]), float(np.median(signal[rests]))
    shown, along = way * signal[moves], way * (signal[moves] - zero)
    against = min((shown < 0).mean(), (along < 0).mean()) > _NEARLY_ALL
    if not against or not -np.median(along) > max(_CLEAR * _scatter(signal[rests]), abs(zero)):
        return list(columns)
    turned = force[0]._replace(sign=-1, note=force[0].note or COUNTED_SO)
    return [turned if column is force[0] else column for column in columns]


def _scatter(values: np.ndarray) -> float:
    return 1.4826 * float(np.median(np.abs(values - np.median(values))))
