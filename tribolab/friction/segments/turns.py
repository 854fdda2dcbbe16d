"""Reversals of a slider, and the strokes of constant speed between them."""

from __future__ import annotations

import numpy as np

from tribolab.friction.segments import limits, slopes
from tribolab.friction.segments.pieces import ConstancyLimits, VelocityPiece

EQUAL = 1e-9  # smaller differences, relative to the range or usual speed, count as zero
_INNER_PARTS = 4  # number of parts of a stroke (without its ends) whose speeds are compared


def last_side(values: np.ndarray, low: float | np.ndarray, high: float | np.ndarray) -> np.ndarray:
    """Return on which side a signal last was: above `high` (1), below `low` (-1), 0 before either.

    Parameters
    ----------
    values
        The signal (time).
    low, high
        Limits in the signal's unit: one for all, or one for each sample.
    """
    state = np.where(values > high, 1, np.where(values < low, -1, 0))
    place = np.where(state != 0, np.arange(state.size), 0)
    return state[np.maximum.accumulate(place)]


def turns_of(position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices of samples at which a position reverses, and directions in between.

    Parameters
    ----------
    position
        Finite samples [m] (time).

    Returns
    -------
    tuple
        Indices (turn) and directions, 1 or -1 (turn - 1); empty for fewer than two turns. A turn is
        the farthest point on one side, between returns by a quarter of the range.
    """
    low, high = np.percentile(position, [1, 99])
    middle, half = (low + high) / 2, (0.5 - limits.MIN_RETURN_OF_TURN.value) * (high - low)
    state = last_side(position, middle - half, middle + half)
    # the record may start between the sides, or on one of them: its start is no turn
    change = np.flatnonzero(np.diff(state)) + 1
    if change.size < 2 or not high > low:
        return np.empty(0, dtype=int), np.empty(0, dtype=int)
    back = abs(position[-1] - middle) < half
    change = np.append(change, position.size) if back else change
    # between two changes of side, the farthest point is a turn
    side = state[change[:-1]]
    inside = np.arange(change[0], change[-1])
    part = np.repeat(np.arange(side.size), np.diff(change))
    height = position[inside] * side[part]
    top = np.maximum.reduceat(height, change[:-1] - change[0])
    at = inside[height >= top[part] - EQUAL * (high - low)]
    return at[np.searchsorted(at, change[:-1])], -side[:-1]


def strokes_within(
    time: np.ndarray, position: np.ndarray, pieces: list[VelocityPiece], constancy: ConstancyLimits
) -> list[VelocityPiece]:
    """Return the pieces with a plateau added for each straight stroke that was missed.

    Parameters
    ----------
    time, position
        Finite samples [s], [m].
    pieces
        Pieces of the whole record, in samples.
    constancy
        Limits of constant speed.

    Notes
    -----
    A block of slopes may cover a turn or a dwell. Strokes of a few blocks then look like ramps or
    rest. Each is examined between its turns, first over the whole record and then within each ramp
    or rest. The strokes of a crank are not straight and remain ramps.
    """
    noise = slopes.position_noise(time, position)
    whole = VelocityPiece(0, time.size, "ramp", 0.0, 0.0, 0.0)
    if any(p.kind != "constant" and p.last - p.first >= constancy.min_samples for p in pieces):
        pieces = _add_strokes(pieces, _strokes_of(time, position, whole, constancy, noise))
    least = limits.MIN_STROKES_OF_STRETCH.value * constancy.min_samples
    result: list[VelocityPiece] = []
    for piece in pieces:
        few = piece.kind == "constant" or piece.last - piece.first < least
        strokes = [] if few else _strokes_of(time, position, piece, constancy, noise)
        result += _add_strokes([piece], strokes)
    return result


def _add_strokes(pieces: list[VelocityPiece], strokes: list[VelocityPiece]) -> list[VelocityPiece]:
    """Return the pieces with the strokes inserted, unless plateaus already cover them."""
    if not strokes:
        return pieces
    first, last = (np.array([getattr(p, k) for p in pieces]) for k in ("first", "last"))
    velocity = np.array([p.velocity if p.kind == "constant" else 0.0 for p in pieces])

    def found(stroke: VelocityPiece) -> bool:
        i = int(np.searchsorted(last, stroke.first, side="right"))
        j = int(np.searchsorted(first, stroke.last, side="left"))
        common = np.minimum(last[i:j], stroke.last) - np.maximum(first[i:j], stroke.first)
        alike = np.abs(
            velocity[i:j] - stroke.velocity
        ) < limits.MAX_SPEED_DIFFERENCE_OF_PLATEAU.value * abs(stroke.velocity)
        return bool(
            common[alike].sum() >= limits.MIN_COVERED_STROKE.value * (stroke.last - stroke.first)
        )

    if all(found(stroke) for stroke in strokes):
        return pieces
    # remainder of each piece between the strokes; a plateau cut by a stroke becomes a ramp
    begins = sorted([p.first for p in pieces] + [p.last for p in strokes])
    ends = sorted([p.last for p in pieces] + [p.first for p in strokes])
    rest: list[VelocityPiece] = []
    for begin, end in zip(begins, ends, strict=True):
        if end > begin:
            own = pieces[int(np.searchsorted(last, begin, side="right"))]
            cut = own.kind == "constant" and end - begin < own.last - own.first
            rest.append(own._replace(first=begin, last=end, kind="ramp" if cut else own.kind))
    return sorted(rest + strokes)


def _strokes_of(
    time: np.ndarray,
    position: np.ndarray,
    piece: VelocityPiece,
    constancy: ConstancyLimits,
    noise: float,
) -> list[VelocityPiece]:
    """Return the straight strokes of a piece; empty if most are not straight."""
    part = position[piece.first : piece.last]
    if np.ptp(part) < limits.MIN_STROKE_OVER_NOISE.value * noise:
        return []  # its motion is within the noise
    turn = turns_of(part)[0] + piece.first
    if turn.size < limits.MIN_STROKES_OF_STRETCH.value:
        return []
    edges = np.unique(np.concatenate([[piece.first], turn, [piece.last]])).tolist()
    own = [
        _straight_part(time[a:b], position[a:b], constancy, noise)
        for a, b in zip(edges[:-1], edges[1:], strict=True)
    ]
    found = [
        piece._replace(first=a + part[0], last=a + part[1], kind="constant", velocity=part[2])
        for a, part in zip(edges[:-1], own, strict=True)
        if part is not None
    ]
    return found if len(found) >= limits.MIN_STRAIGHT_STROKES.value * len(own) else []


def _straight_part(
    time: np.ndarray, position: np.ndarray, constancy: ConstancyLimits, noise: float
) -> tuple[int, int, float] | None:
    """Return sample range and velocity [m/s] of a stroke without dwells; None if not constant."""
    low, high = float(position.min()), float(position.max())
    margin = (1 - limits.INNER_PART_OF_STROKE.value) / 2 * (high - low)
    inside = np.flatnonzero((position > low + margin) & (position < high - margin))
    if inside.size < constancy.min_samples * limits.INNER_PART_OF_STROKE.value:
        return None
    inner = slice(inside[0], inside[-1] + 1)
    t, x = time[inner], position[inner]
    edges = (t.size - 1) * np.arange(_INNER_PARTS + 1) // _INNER_PARTS
    lasted = np.diff(t[edges])
    if not (lasted > 0).all():
        return None
    speeds = np.diff(x[edges]) / lasted
    offset, slope = slopes.line(t, x)
    error = np.sqrt(2) * noise / lasted
    off = np.abs(speeds - slope) - limits.MIN_ERRORS_OF_SLOPE.value * error
    surely = abs(slope) > limits.MIN_ERRORS_OF_SLOPE.value * float(np.median(error)) / np.sqrt(
        _INNER_PARTS
    )
    if not surely or not (off <= constancy.drift / 2 * abs(slope)).all():
        return None
    away = np.abs(
        position - offset - slope * time
    ) > limits.MIN_ERRORS_OF_SLOPE.value * noise + limits.MAX_DEPARTURE_FROM_LINE.value * (
        high - low
    )
    before = np.flatnonzero(away[: inside[0]])
    after = np.flatnonzero(away[inside[-1] :])
    first = int(before[-1]) + 1 if before.size else 0
    last = int(inside[-1] + after[0]) if after.size else time.size
    return (first, last, slope) if last - first >= constancy.min_samples else None
