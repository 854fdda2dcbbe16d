"""Where a slider turns, and the strokes between turns that hold their speed."""

from __future__ import annotations

import numpy as np

from tribolab.friction.segments import slopes
from tribolab.friction.segments.locate import ConstancyLimits, VelocityPiece

_HYSTERESIS = 0.25  # of the range: how far a position has to come back to be a turn
SAME = 1e-9  # of the range, or of the usual speed: what differs by less is the same, or zero
_STROKES = 3  # in a stretch, at least
_INNER = 0.8  # of a stroke: what turns and starts lies outside
_PARTS = 4  # of the inner part, whose speeds are compared
_STRAIGHT = 0.6  # of the strokes of a stretch that have to hold their speed
_SURE = 3.0  # standard errors
_ABOVE = 20.0  # times the noise of a reading: so far a slider goes to and fro


def last_side(values: np.ndarray, low: float | np.ndarray, high: float | np.ndarray) -> np.ndarray:
    """Say whether a signal was last above `high` (+1) or below `low` (-1); 0 before either.

    Parameters
    ----------
    values
        The signal (time).
    low, high
        Limits in its unit: one for all, or one for each sample.
    """
    state = np.where(values > high, 1, np.where(values < low, -1, 0))
    place = np.where(state != 0, np.arange(state.size), 0)
    return state[np.maximum.accumulate(place)]


def turns_of(position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the samples at which a position turns, and the ways (+1, -1) between them.

    Parameters
    ----------
    position
        Finite samples [m] (time).

    Returns
    -------
    tuple
        (turn) and (turn - 1); empty where there are not two turns. A turn is the farthest point
        on one side, between comings back by a quarter of the range.
    """
    low, high = np.percentile(position, [1, 99])
    middle, half = (low + high) / 2, (0.5 - _HYSTERESIS) * (high - low)
    state = last_side(position, middle - half, middle + half)
    # the first may be a coming in to the first side; where it began on one, that is no turn
    change = np.flatnonzero(np.diff(state)) + 1
    if change.size < 2 or not high > low:
        return np.empty(0, dtype=int), np.empty(0, dtype=int)
    back = abs(position[-1] - middle) < half
    change = np.append(change, position.size) if back else change
    # between two changes the position is on one side: its farthest point is a turn
    side = state[change[:-1]]
    inside = np.arange(change[0], change[-1])
    part = np.repeat(np.arange(side.size), np.diff(change))
    height = position[inside] * side[part]
    top = np.maximum.reduceat(height, change[:-1] - change[0])
    at = inside[height >= top[part] - SAME * (high - low)]
    return at[np.searchsorted(at, change[:-1])], -side[:-1]


def strokes_within(
    time: np.ndarray, position: np.ndarray, pieces: list[VelocityPiece], limits: ConstancyLimits
) -> list[VelocityPiece]:
    """Take what seems to ramp or to rest, and goes to and fro evenly, apart where it turns.

    Parameters
    ----------
    time, position
        Finite samples [s], [m].
    pieces
        Of the whole record, in samples of it.
    limits
        What counts as constant.

    Notes
    -----
    Slopes over blocks do not see strokes that last a few blocks only, and see no speed in as many
    ways to as fro; between its turns each can be looked at alone. A stroke of a crank is no
    straight line, and stays a ramp.
    """
    result: list[VelocityPiece] = []
    noise = slopes.position_noise(time, position)
    for piece in pieces:
        least = _STROKES * limits.min_samples
        few = piece.kind == "constant" or piece.last - piece.first < least
        result += [piece] if few else _apart(time, position, piece, limits, noise)
    return result


def _apart(
    time: np.ndarray,
    position: np.ndarray,
    piece: VelocityPiece,
    limits: ConstancyLimits,
    noise: float,
) -> list[VelocityPiece]:
    part = position[piece.first : piece.last]
    if np.ptp(part) < _ABOVE * noise:
        return [piece]  # to and fro is but noise
    turn = turns_of(part)[0] + piece.first
    edges = np.unique(np.concatenate([[piece.first], turn, [piece.last]]))
    if turn.size < _STROKES:
        return [piece]
    parts = []
    for first, last in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        speed = _speed_of(time[first:last], position[first:last], limits, noise)
        kind = "ramp" if speed is None else "constant"
        parts.append(piece._replace(first=first, last=last, kind=kind, velocity=speed or 0.0))
    straight = sum(part.kind == "constant" for part in parts)
    return parts if straight >= _STRAIGHT * len(parts) else [piece]


def _speed_of(
    time: np.ndarray, position: np.ndarray, limits: ConstancyLimits, noise: float
) -> float | None:
    """Return the velocity [m/s] of a stroke; None where it does not hold it."""
    if time.size < limits.min_samples:
        return None
    margin = (1 - _INNER) / 2
    inner = slice(round(margin * time.size), round((1 - margin) * time.size))
    t, x = time[inner], position[inner]
    edges = (t.size - 1) * np.arange(_PARTS + 1) // _PARTS
    lasted = np.diff(t[edges])
    if not (lasted > 0).all():
        return None
    speeds = np.diff(x[edges]) / lasted
    mean = float((x[-1] - x[0]) / (t[-1] - t[0]))
    error = np.sqrt(2) * noise / lasted
    off = np.abs(speeds - mean) - _SURE * error
    surely = abs(mean) > _SURE * float(np.median(error)) / np.sqrt(_PARTS)
    return mean if surely and (off <= limits.drift / 2 * abs(mean)).all() else None
