"""Plateaus, ramps and rests of a velocity record, found in averaged blocks."""

from __future__ import annotations

import numpy as np

from tribolab.friction.segments import limits
from tribolab.friction.segments.noise import (
    Noise,
    estimate_noise,
    is_commanded,
    quantum,
    running_median,
)
from tribolab.friction.segments.pieces import (
    KEPT,
    ConstancyLimits,
    VelocityPiece,
    bridge_bumps,
    drop_transient,
    drop_unproven,
    join_equal,
)
from tribolab.friction.segments.plateaus import find_breaks, straight_pieces

_MAX_BLOCKS = 16384  # most blocks of a first search; intervals without a plateau are searched again
_LEFTOVER_BLOCKS = 512  # most blocks of such a second search
# a block is averaged over the middle half of its sorted part means, which spikes do not affect
_PARTS_OF_BLOCK = 8


def locate(
    time: np.ndarray, velocity: np.ndarray, constancy: ConstancyLimits, floor: float = 0.0
) -> list[VelocityPiece]:
    """Return the plateaus, ramps and rests that make up a velocity record.

    Parameters
    ----------
    time, velocity
        Finite samples [s], [m/s]; the spacing may change.
    constancy
        Limits of constant speed.
    floor
        Smallest possible noise of a sample [m/s], if known.
    """
    pieces = _locate(time, velocity, constancy, None, None, floor)
    pieces = drop_transient(bridge_bumps(join_equal(pieces, constancy), constancy), constancy)
    return drop_unproven(pieces, constancy)


def block_size(samples: int, most: int = _MAX_BLOCKS) -> int:
    """Return the number of samples per block: 1 for short records, else 8, 16, 32, ..."""
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
    """Return a velocity with spikes replaced by the median of the neighbouring samples."""
    median = running_median(velocity)
    limit = limits.MIN_SPIKE_OVER_NOISE.value * np.sqrt(noise.variance(median))
    limit = np.maximum(limit, limits.MIN_RELATIVE_SPIKE.value * np.abs(median))
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
        # a steady rounded reading may be off by half a step, although it does not scatter
        step = quantum(velocity)
        step = 0.0 if is_commanded(velocity, step) else step
        noise = noise._replace(floor=max(noise.floor, step / 2 / np.sqrt(size)))
    else:  # the noise per sample is known from the previous search
        noise = noise.scaled(size**-0.5)
    single = noise.scaled(size**0.5)
    if rest_speed is None:
        rest_speed = constancy.rest_speed
    if rest_speed is None:
        top = float(np.quantile(np.abs(v), 0.98))
        rest_speed = max(
            limits.MIN_SPEED_OVER_TOP.value * top,
            limits.MIN_REST_SPEED_OVER_NOISE.value * single.floor,
        )
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
        kind = _rest_ramp_or_constant(
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
            if kind not in KEPT and not (kind == "ramp" and last - first >= 4 * size):
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
    """Return the pieces of the interval between two accepted pieces, found with finer blocks."""
    if first >= last:
        return []
    if last - first == time.size:  # no piece was accepted: halve the interval
        middle = (first + last) // 2
        return [
            piece
            for begin, end in ((first, middle), (middle, last))
            for piece in _leftover(time, velocity, constancy, noise, rest_speed, begin, end)
        ]
    inner = _locate(time[first:last], velocity[first:last], constancy, noise, rest_speed)
    return [p._replace(first=p.first + first, last=p.last + first) for p in inner]


def _rest_ramp_or_constant(
    mean: float, change: float, error: float, change_error: float, rest_speed: float, drift: float
) -> str:
    """Decide whether a piece of the velocity [m/s] is at rest, a ramp, or at constant speed.

    It is at rest if its mean is below `rest_speed` or within the error of zero.
    """
    sure = abs(change) - limits.MIN_ERRORS_OF_RAMP.value * change_error
    if abs(mean) <= max(rest_speed, limits.MIN_ERRORS_FROM_REST.value * error):
        return "ramp" if sure > limits.MIN_CHANGE_AT_REST.value * rest_speed else "at rest"
    return "ramp" if sure > drift * abs(mean) else "constant"
