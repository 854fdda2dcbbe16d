"""Standstills that the position shows although the recorded velocity is not zero."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import anywhere, one_by_one
from tribolab.friction.segments import slopes
from tribolab.friction.segments.limits import (
    MAX_ERROR_OF_BLOCK,
    MAX_SPEED_MISFIT,
    MIN_DIGITS_OF_BLOCK,
    MIN_SAMPLES_OF_BLOCK,
    MIN_SHARE_OF_SPEED,
    MIN_STANDSTILL,
)
from tribolab.friction.segments.noise import quantum
from tribolab.friction.segments.stretches import Stretch, track

# numbers of blocks per segment, tried until the noise of the position allows it
_BLOCK_COUNTS = (32, 16, 8)


def without_standstills(run: xr.Dataset, stretches: list[Stretch]) -> tuple[list[Stretch], float]:
    """Return the intervals, with standstills marked as rest, and the total standstill time [s].

    Parameters
    ----------
    run
        With ``sliding_velocity``; without ``position`` no interval changes.
    stretches
        Intervals from the recorded velocity. A standstill in their first or last tenth does not
        count: a stage needs time to start.

    Notes
    -----
    A velocity without noise is often a set-point. A position that agrees with it for most of the
    time, and stops for a part of a segment, shows that the stage stopped. A position that never
    agrees is another quantity, or has another unit, and is ignored.
    """
    if "position" not in run or not anywhere(np.isfinite, run["position"].values):
        return stretches, 0.0
    time, position = track(run)
    if time.size < 3 * MIN_SAMPLES_OF_BLOCK.value:
        return stretches, 0.0
    noise, digit = slopes.position_noise(time, position), quantum(position)
    result: list[Stretch] = []
    standstill = agreeing = examined = 0.0
    for stretch in one_by_one(stretches):
        first, last = np.searchsorted(time, [stretch.start, stretch.stop])
        size = _block(time[first:last], stretch, noise, digit)
        if not size:
            result.append(stretch)
            continue
        lasted = stretch.stop - stretch.start
        _, slope = slopes.block_slopes(time[first:last], position[first:last], size)
        share = np.abs(slope / stretch.velocity)
        examined += lasted
        agreeing += lasted * float(np.mean(np.abs(share - 1) < MAX_SPEED_MISFIT.value))
        begin, end = _standstills(share)
        standstill += lasted * float((end - begin).sum()) / share.size
        # a block at either end of a standstill may be half moving
        begin, end = np.maximum(begin - 1, 0) * size, (end + 1) * size
        result += _split(stretch, time[first:last], begin, end)
    return (result, standstill) if agreeing > 0.5 * examined else (stretches, 0.0)


def _block(time: np.ndarray, stretch: Stretch, noise: float, digit: float) -> int:
    """Return how many samples of the position resolve the speed; 0 if no block length does."""
    if stretch.kind != "constant" or not stretch.velocity:
        return 0
    for parts in _BLOCK_COUNTS:
        size = time.size // parts
        way = abs(stretch.velocity) * (stretch.stop - stretch.start) / parts
        error = noise * np.sqrt(12 / max(size, 1))
        clear = error <= MAX_ERROR_OF_BLOCK.value * way and MIN_DIGITS_OF_BLOCK.value * digit <= way
        if size >= MIN_SAMPLES_OF_BLOCK.value and clear:
            return size
    return 0


def _standstills(share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return first block and end of each standstill, from the ratio of the two speeds."""
    slow = share < MIN_SHARE_OF_SPEED.value
    edges = np.flatnonzero(np.diff(np.concatenate([[False], slow, [False]])))
    begin, end = edges[::2], edges[1::2]
    margin = 0.1 * share.size
    inside = np.minimum(end, share.size - margin) - np.maximum(begin, margin)
    long = inside >= max(2, MIN_STANDSTILL.value * share.size)
    return begin[long], end[long]


def _split(stretch: Stretch, time: np.ndarray, begin: np.ndarray, end: np.ndarray) -> list[Stretch]:
    """Return an interval split into sliding parts and the given parts at rest."""
    result, at = [], 0
    ends = [*time.tolist(), stretch.stop]
    for a, b in zip(begin.tolist(), np.minimum(end, time.size).tolist(), strict=True):
        result.append((at, max(a, at), stretch))
        result.append((max(a, at), b, Stretch(0.0, 0.0, "at rest", 0.0)))
        at = b
    result.append((at, time.size, stretch))
    ends[0] = stretch.start
    return [
        each._replace(start=ends[a], stop=ends[b])
        if b - a >= MIN_SAMPLES_OF_BLOCK.value or len(result) == 1
        else Stretch(ends[a], ends[b], "too short", np.nan)
        for a, b, each in result
        if b > a
    ]
