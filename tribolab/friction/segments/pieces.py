"""Plateaus, ramps and rests of a velocity record: join equal ones, reclassify doubtful ones."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import one_by_one
from tribolab.friction.segments import limits
from tribolab.friction.segments.constancy import MeanVelocities, constant_part, is_constant
from tribolab.friction.segments.proof import is_proven

KEPT = ("constant", "at rest")


class VelocityPiece(NamedTuple):
    """Piece of a velocity record: samples [first, last), kind, velocity, its change and error."""

    first: int
    last: int
    kind: str
    velocity: float
    change: float
    error: float


class ConstancyLimits(NamedTuple):
    """Limits that define constant speed; see `find_segments`."""

    resolution: float
    drift: float
    min_samples: int
    rest_speed: float | None


def moving(
    time: np.ndarray,
    pieces: list[VelocityPiece],
    constancy: ConstancyLimits,
    velocity: np.ndarray | None = None,
) -> list[VelocityPiece]:
    """Return the pieces; creep that is far slower than the highest speed is marked as rest.

    Also reclassify the noise of a speed recorded without its sign, whose mean is not zero.

    Parameters
    ----------
    time, pieces
        Samples [s], and pieces of the whole record.
    constancy
        If these include a `rest_speed`, it alone decides.
    velocity
        The record [m/s], if the speed was recorded.
    """
    kept = [p for p in pieces if p.kind == "constant"]
    if constancy.rest_speed is not None or not kept:
        return pieces
    top = max(abs(p.velocity) for p in kept)
    way = [abs(p.velocity) * (time[p.last - 1] - time[p.first]) for p in pieces]
    least = limits.MIN_DISTANCE_OF_CREEP.value * max(
        d for d, p in zip(way, pieces, strict=True) if p.kind == "constant"
    )
    return join_equal(
        [
            p._replace(kind="at rest")
            if p.kind == "constant"
            and (
                (abs(p.velocity) <= limits.MAX_CREEP_SPEED.value * top and d < least)
                or (
                    velocity is not None
                    and abs(p.velocity) <= limits.MAX_SPEED_OF_NOISE.value * top
                    and _is_folded_noise(velocity[p.first : p.last])
                )
            )
            else p
            for d, p in zip(way, pieces, strict=True)
        ],
        constancy,
    )


def _is_folded_noise(velocity: np.ndarray) -> bool:
    """Return whether a speed is rectified noise about zero: its scatter is 0.76 of its mean."""
    if (
        velocity.size < limits.MIN_SAMPLES_OF_UNSIGNED_NOISE.value
        or velocity.min() < 0 < velocity.max()
    ):
        return False
    size = np.abs(velocity)
    mean = float(size.mean())
    return bool(
        size.std() > limits.MIN_SCATTER_OF_UNSIGNED_NOISE.value * mean > 0
        and np.mean(size < limits.MAX_SMALL_OF_UNSIGNED_NOISE.value * mean)
        > limits.MIN_SHARE_OF_SMALL.value
    )


def trimmed(
    data: MeanVelocities, pieces: list[VelocityPiece], constancy: ConstancyLimits
) -> list[VelocityPiece]:
    """Keep the part of each plateau with constant speed; the remainder becomes a ramp.

    Parameters
    ----------
    data
        The record of the pieces.
    pieces
        From `locate`, in samples of the record.
    constancy
        Limits of constant speed.
    """
    result: list[VelocityPiece] = []
    for piece in one_by_one(pieces):
        if piece.kind != "constant":
            result.append(piece)
            continue
        first, last = constant_part(data, piece.first, piece.last, constancy.drift)
        kind = "constant" if is_constant(data, first, last, constancy.drift) else "ramp"
        parts = (piece.first, first, "ramp"), (first, last, kind), (last, piece.last, "ramp")
        result += [piece._replace(first=a, last=b, kind=k) for a, b, k in parts if b > a]
    return _merge_short(data, _merge_pauses(join_equal(result, constancy), constancy), constancy)


def _merge_short(
    data: MeanVelocities, pieces: list[VelocityPiece], constancy: ConstancyLimits
) -> list[VelocityPiece]:
    """Merge a short plateau into an adjacent ramp unless the data show that it is distinct.

    A ramp extends from one plateau or rest to the next.
    """
    result = list(pieces)
    for i, piece in enumerate(pieces):
        if piece.kind != "constant":
            continue
        begin, end = data.time[piece.first], data.time[piece.last - 1]
        before, after = (_time_to_plateau(data.time, pieces, i, way) for way in (-1, 1))
        if max(before, after) <= limits.MAX_RAMP_OVER_PLATEAU.value * (end - begin):
            continue
        sides = before > end - begin, after > end - begin
        if not is_proven(data.readings, begin, end, constancy.drift * abs(piece.velocity), sides):
            result[i] = piece._replace(kind="ramp")
    return join_equal(result, constancy)


def _time_to_plateau(time: np.ndarray, pieces: list[VelocityPiece], index: int, way: int) -> float:
    """Return the time [s] from a piece to the next plateau or rest on one side, without pauses."""
    at = index + way
    while 0 <= at < len(pieces) and pieces[at].kind not in KEPT:
        at += way
    piece = pieces[index]
    if way < 0:
        between = time[pieces[at].last - 1 if at >= 0 else 0 : piece.first + 1]
    else:
        between = time[piece.last - 1 : (pieces[at].first if at < len(pieces) else time.size) + 1]
    usual = float(time[piece.last - 1] - time[piece.first]) / max(piece.last - piece.first - 1, 1)
    spans = np.diff(between)
    return float(spans[spans <= limits.MIN_INTERVALS_OF_PAUSE.value * usual].sum())


def _merge_pauses(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Merge a short plateau into a long ramp that continues after it in the same direction."""
    result = list(pieces)
    for i in range(1, len(pieces) - 1):
        before, piece, after = pieces[i - 1 : i + 2]
        if piece.kind != "constant" or before.kind != "ramp" or after.kind != "ramp":
            continue
        shortest = min(before.last - before.first, after.last - after.first)
        one_way = (piece.velocity - before.velocity) * (after.velocity - piece.velocity) > 0
        if one_way and shortest > limits.MIN_RAMP_OVER_PAUSE.value * (piece.last - piece.first):
            result[i] = piece._replace(kind="ramp")
    return join_equal(result, constancy)


def join_equal(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Join adjacent pieces of equal kind and velocity."""
    result: list[VelocityPiece] = []
    for piece in pieces:
        if result and _same(result[-1], piece, constancy):
            last = result.pop()
            n, k = last.last - last.first, piece.last - piece.first
            kind = max(last, piece, key=lambda p: p.last - p.first).kind
            piece = VelocityPiece(
                last.first,
                piece.last,
                kind,
                (n * last.velocity + k * piece.velocity) / (n + k),
                last.change if n > k else piece.change,
                min(last.error, piece.error),
            )
        result.append(piece)
    return result


def _same(a: VelocityPiece, b: VelocityPiece, constancy: ConstancyLimits) -> bool:
    if a.kind == b.kind and a.kind != "constant":
        return True
    short, long = sorted((a, b), key=lambda p: p.last - p.first)
    if long.kind not in KEPT or short.kind not in (long.kind, "too short"):
        return False
    apart = abs(a.velocity - b.velocity)
    size = max(abs(a.velocity), abs(b.velocity))
    return apart <= max(
        limits.MAX_DIFFERENCE_OF_EQUAL_SPEED.value * constancy.resolution * size,
        limits.MAX_ERRORS_OF_EQUAL_SPEED.value * np.hypot(a.error, b.error),
    )


def bridge_bumps(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Join two plateaus of equal velocity across a disturbance that is short compared with both."""
    result: list[VelocityPiece] = []
    for piece in pieces:
        if len(result) > 1 and piece.kind == "constant" == result[-2].kind:
            left, odd = result[-2], result[-1]
            least = limits.MIN_PLATEAUS_OVER_BUMP.value * (odd.last - odd.first)
            brief = least < piece.last - left.first
            wide = constancy._replace(
                resolution=limits.MAX_RESOLUTIONS_ACROSS_BUMP.value * constancy.resolution
            )
            if odd.kind == "too short" and brief and _same(left, piece, wide):
                del result[-2:]
                result += join_equal([left, piece._replace(first=odd.first)], wide)
                continue
        result.append(piece)
    return result


def drop_unproven(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Reclassify a short plateau as a ramp unless the data show that its speed is constant."""
    result = list(pieces)
    for i, piece in enumerate(pieces):
        around = pieces[max(i - 2, 0) : i] + pieces[i + 1 : i + 3]
        size = piece.last - piece.first
        longest = max((p.last - p.first for p in around), default=0)
        error = limits.MIN_ERRORS_OF_UNPROVEN.value * np.sqrt(12) * piece.error
        uncertain = error > constancy.drift * abs(piece.velocity)
        ramp = max((p.last - p.first for p in around if p.kind == "ramp"), default=0)
        speck = limits.MIN_RAMP_OVER_SPECK.value * size < ramp
        short = limits.MIN_NEIGHBOUR_OVER_SHORT.value * size < longest
        if piece.kind == "constant" and ((uncertain and short) or speck):
            result[i] = piece._replace(kind="ramp")
    return join_equal(result, constancy)


def drop_transient(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Reclassify a short drifting piece next to a long plateau as a ramp."""
    result = list(pieces)
    for i, piece in enumerate(pieces):
        if piece.kind != "constant":
            continue
        for other in pieces[max(i - 1, 0) : i] + pieces[i + 1 : i + 2]:
            apart = abs(piece.velocity - other.velocity)
            if (
                other.kind == "constant"
                and limits.MIN_NEIGHBOUR_OVER_SHORT.value * (piece.last - piece.first)
                < other.last - other.first
                and apart
                < limits.MAX_DRIFTS_OF_TRANSIENT.value * constancy.drift * abs(other.velocity)
                and abs(piece.change) > limits.MIN_CHANGE_OF_TRANSIENT.value * apart
            ):
                result[i] = piece._replace(kind="ramp")
    return join_equal(result, constancy)
