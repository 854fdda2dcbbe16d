"""Plateaus of a velocity record, by block averaging, classification and recursion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import one_by_one
from tribolab.friction.segments import limits
from tribolab.friction.segments.constancy import MeanVelocities, constant_part, is_constant
from tribolab.friction.segments.plateaus import (
    Noise,
    estimate_noise,
    find_breaks,
    is_commanded,
    quantum,
    running_median,
    straight_pieces,
)
from tribolab.friction.segments.proof import is_proven

_MAX_BLOCKS = 16384  # more blocks cost time without benefit: leftovers are searched again
_LEFTOVER_BLOCKS = 512  # blocks in a second search
# the value of a block is the median of the means of its parts, robust to spikes
_PARTS_OF_BLOCK = 8
_KEPT = ("constant", "at rest")


class VelocityPiece(NamedTuple):
    """Piece of a velocity record: samples [first, last), mean velocity, and class."""

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


def locate(
    time: np.ndarray, velocity: np.ndarray, constancy: ConstancyLimits, floor: float = 0.0
) -> list[VelocityPiece]:
    """Return the contiguous pieces of a record without gaps.

    Parameters
    ----------
    time, velocity
        Finite samples [s], [m/s]; the spacing may change.
    constancy
        Limits of constant speed.
    floor
        Least noise of a sample [m/s], if known.
    """
    pieces = _locate(time, velocity, constancy, None, None, floor)
    pieces = _drop_transient(_bridge_bumps(_join_equal(pieces, constancy), constancy), constancy)
    return _drop_unproven(pieces, constancy)


def moving(
    time: np.ndarray,
    pieces: list[VelocityPiece],
    constancy: ConstancyLimits,
    velocity: np.ndarray | None = None,
) -> list[VelocityPiece]:
    """Reclassify creep as rest if it is slow compared with the highest speed.

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
    return _join_equal(
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
    return bool(size.std() > 0.6 * mean > 0 and np.mean(size < 0.3 * mean) > 0.1)


def trimmed(
    data: MeanVelocities, pieces: list[VelocityPiece], constancy: ConstancyLimits
) -> list[VelocityPiece]:
    """Keep the part of each plateau with constant speed; the rest becomes ramp.

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
    return _merge_short(data, _merge_pauses(_join_equal(result, constancy), constancy), constancy)


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
    return _join_equal(result, constancy)


def _time_to_plateau(time: np.ndarray, pieces: list[VelocityPiece], index: int, way: int) -> float:
    """Return the time [s] from a piece to the next plateau or rest on one side, without pauses."""
    at = index + way
    while 0 <= at < len(pieces) and pieces[at].kind not in _KEPT:
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
    """Merge a short pause into a long ramp that continues in the same direction."""
    result = list(pieces)
    for i in range(1, len(pieces) - 1):
        before, piece, after = pieces[i - 1 : i + 2]
        if piece.kind != "constant" or before.kind != "ramp" or after.kind != "ramp":
            continue
        shortest = min(before.last - before.first, after.last - after.first)
        one_way = (piece.velocity - before.velocity) * (after.velocity - piece.velocity) > 0
        if one_way and shortest > limits.MIN_RAMP_OVER_PAUSE.value * (piece.last - piece.first):
            result[i] = piece._replace(kind="ramp")
    return _join_equal(result, constancy)


def block_size(samples: int, most: int = _MAX_BLOCKS) -> int:
    """Return the samples per block: 1 for small records, else 8, 16, 32, ..."""
    if samples <= most:
        return 1
    return max(_PARTS_OF_BLOCK, 2 ** int(np.ceil(np.log2(samples / most))))


def _blocks(time: np.ndarray, velocity: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return time and robust mean velocity of each block."""
    if size == 1:
        return time, velocity
    count = time.size // size
    parts = (
        velocity[: count * size]
        .reshape(count * _PARTS_OF_BLOCK, size // _PARTS_OF_BLOCK)
        .mean(axis=1)
    )
    parts = np.sort(parts.reshape(count, _PARTS_OF_BLOCK), axis=1)
    robust = parts[:, 2:-2].mean(axis=1)  # the middle half: nearly as efficient as the mean
    begin, end = time[: count * size : size], time[size - 1 : count * size : size]
    return (begin + end) / 2, robust


def _despiked(velocity: np.ndarray, noise: Noise) -> np.ndarray:
    """Replace single samples that deviate far from their neighbours' median."""
    median = running_median(velocity)
    limit = 6 * np.sqrt(noise.variance(median))
    limit = np.maximum(limit, 1e-3 * np.abs(median))
    return np.where(np.abs(velocity - median) > limit, median, velocity)


def _locate(
    time: np.ndarray,
    velocity: np.ndarray,
    constancy: ConstancyLimits,
    noise: Noise | None,
    rest_speed: float | None,
    floor: float = 0.0,
) -> list[VelocityPiece]:
    size = block_size(time.size, _MAX_BLOCKS if noise is None else _LEFTOVER_BLOCKS)
    t, v = _blocks(time, velocity, size)
    if noise is None:
        noise = estimate_noise(v, floor / np.sqrt(size))
        # a steady reading may be off by half a step without scatter
        step = quantum(velocity)
        step = 0.0 if is_commanded(velocity, step) else step
        noise = noise._replace(floor=max(noise.floor, step / 2 / np.sqrt(size)))
    else:  # the parent's noise per sample, averaged over a block
        noise = noise.scaled(size**-0.5)
    single = noise.scaled(size**0.5)
    if rest_speed is None:
        rest_speed = constancy.rest_speed
    if rest_speed is None:
        top = float(np.quantile(np.abs(v), 0.98))
        rest_speed = max(limits.MIN_SPEED_OVER_TOP.value * top, 0.05 * single.floor)
    if size == 1:
        v = _despiked(v, noise)
    breaks = find_breaks(v, noise, constancy.resolution, rest_speed)
    straight = straight_pieces(t, v, noise, breaks, constancy.resolution)

    pieces: list[VelocityPiece] = []
    pending = 0  # first sample not yet in a kept piece
    edges = np.append(straight.first * size, time.size)
    fewest = constancy.min_samples if size == 1 else 4 * size
    for i in range(straight.first.size):
        first, last = int(edges[i]), int(edges[i + 1])
        mean, change = float(straight.mean[i]), float(straight.change[i])
        kind = _kind(
            mean,
            change,
            straight.mean_error[i],
            straight.change_error[i],
            rest_speed,
            constancy.drift,
        )
        if last - first < fewest and kind != "ramp":
            kind = "too short"
        if size > 1:
            if kind not in _KEPT and not (kind == "ramp" and last - first >= 4 * size):
                continue
            pieces += _leftover(time, velocity, constancy, single, rest_speed, pending, first)
            pending = last
        pieces.append(VelocityPiece(first, last, kind, mean, change, float(straight.mean_error[i])))
    if size > 1:
        pieces += _leftover(time, velocity, constancy, single, rest_speed, pending, time.size)
    return pieces


def _leftover(
    time: np.ndarray,
    velocity: np.ndarray,
    constancy: ConstancyLimits,
    noise: Noise,
    rest_speed: float,
    first: int,
    last: int,
) -> list[VelocityPiece]:
    """Search again, with finer blocks, between two accepted pieces."""
    if first >= last:
        return []
    if last - first == time.size:  # nothing was kept: continue with shorter intervals
        middle = (first + last) // 2
        return [
            piece
            for begin, end in ((first, middle), (middle, last))
            for piece in _leftover(time, velocity, constancy, noise, rest_speed, begin, end)
        ]
    inner = _locate(time[first:last], velocity[first:last], constancy, noise, rest_speed)
    return [p._replace(first=p.first + first, last=p.last + first) for p in inner]


def _kind(
    mean: float, change: float, error: float, change_error: float, rest_speed: float, drift: float
) -> str:
    sure = abs(change) - 3 * change_error
    if abs(mean) <= max(rest_speed, limits.MIN_ERRORS_FROM_REST.value * error):
        return "ramp" if sure > 2 * rest_speed else "at rest"
    return "ramp" if sure > drift * abs(mean) else "constant"


def _join_equal(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Join adjacent pieces of equal class and velocity."""
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
    if long.kind not in _KEPT or short.kind not in (long.kind, "too short"):
        return False
    apart = abs(a.velocity - b.velocity)
    size = max(abs(a.velocity), abs(b.velocity))
    return apart <= max(constancy.resolution / 2 * size, 3 * np.hypot(a.error, b.error))


def _bridge_bumps(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Join two plateaus of equal velocity across a disturbance that is short compared with both."""
    result: list[VelocityPiece] = []
    for piece in pieces:
        if len(result) > 1 and piece.kind == "constant" == result[-2].kind:
            left, odd = result[-2], result[-1]
            brief = 20 * (odd.last - odd.first) < piece.last - left.first
            wide = constancy._replace(resolution=2 * constancy.resolution)
            if odd.kind == "too short" and brief and _same(left, piece, wide):
                del result[-2:]
                result += _join_equal([left, piece._replace(first=odd.first)], wide)
                continue
        result.append(piece)
    return result


def _drop_unproven(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Reclassify a short piece as ramp unless the data show that its speed is constant."""
    result = list(pieces)
    for i, piece in enumerate(pieces):
        around = pieces[max(i - 2, 0) : i] + pieces[i + 1 : i + 3]
        size = piece.last - piece.first
        longest = max((p.last - p.first for p in around), default=0)
        uncertain = np.sqrt(12) * piece.error * 3 > constancy.drift * abs(piece.velocity)
        speck = 10 * size < max((p.last - p.first for p in around if p.kind == "ramp"), default=0)
        if piece.kind == "constant" and ((uncertain and 4 * size < longest) or speck):
            result[i] = piece._replace(kind="ramp")
    return _join_equal(result, constancy)


def _drop_transient(pieces: list[VelocityPiece], constancy: ConstancyLimits) -> list[VelocityPiece]:
    """Reclassify as ramp a short drifting piece that leads into a long plateau."""
    result = list(pieces)
    for i, piece in enumerate(pieces):
        if piece.kind != "constant":
            continue
        for other in pieces[max(i - 1, 0) : i] + pieces[i + 1 : i + 2]:
            apart = abs(piece.velocity - other.velocity)
            if (
                other.kind == "constant"
                and 4 * (piece.last - piece.first) < other.last - other.first
                and apart < 2 * constancy.drift * abs(other.velocity)
                and abs(piece.change) > apart / 2
            ):
                result[i] = piece._replace(kind="ramp")
    return _join_equal(result, constancy)
