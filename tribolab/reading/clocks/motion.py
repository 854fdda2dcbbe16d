"""When a table moves and which way, from a velocity with noise, steps or jitter in it.

A velocity reads a little more than zero at rest: noise of a tachometer, steps of an encoder. It is
averaged over as few samples as bring that noise below a fiftieth of the fastest speed; what still
lies within the noise, or leads nowhere, is rest. A stroke so slow that an encoder counts only now
and then is a stroke: between two counts it moves at the speed that they tell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits

_MAX_HALF_WIDTH = 64  # samples on either side, at most, in an average
_NOISE_BLOCK = 16  # samples, in which noise is looked at
_REST_PERCENTILE = 3.0  # percentile of the noise in blocks that is taken for that at rest
_TOP_PERCENTILE = 99.0  # percentile of the speed that is called the fastest


class Motion(NamedTuple):
    """Velocity [m/s] that is 0 at rest, the way (-1, 0, 1), and the time averaged over [s]."""

    velocity: Array
    way: NDArray[np.int64]
    averaged: float


def clean_motion(time: Array, velocity: Array) -> Motion:
    """Tell motion from rest.

    Parameters
    ----------
    time, velocity
        Motion log: its clock [s] and the signed velocity [m/s], finite.

    Examples
    --------
    >>> t = np.arange(2000.0)
    >>> noise = 0.01 * np.random.default_rng(0).standard_normal(t.size)
    >>> way = clean_motion(t, np.where(t < 1000, 0.0, 1.0) + noise).way
    >>> np.unique(way[:1000]).tolist(), np.unique(way[1000:]).tolist()
    ([0], [1])
    """
    path = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (velocity[1:] + velocity[:-1]))])
    velocity = _between_counts(time, velocity, path)
    half, smooth = 0, velocity
    noise = _noise(velocity, 1)
    while noise > limits.MAX_NOISE_OF_SPEED.value * _fastest(smooth) and half < min(
        _MAX_HALF_WIDTH, len(time) // 64
    ):
        wider = max(1, 2 * half)
        tried = _averaged(time, path, wider)
        left = _noise(tried, 2 * wider)
        if left > 0.8 * noise:
            break
        half, smooth, noise = wider, tried, left
    way = _way(smooth, noise)
    way = _without_short(path, way)
    plain = _way(velocity, 0.0)
    # it is quiet at rest: nothing has to be done
    if _turns(plain) <= limits.MAX_CHANGES_OF_NOISE.value * _turns(way):
        return Motion(np.where(plain != 0, velocity, 0.0), plain, 0.0)
    interval = float(np.percentile(np.diff(time), 5))
    return Motion(np.where(way != 0, smooth, 0.0), way, 2 * half * interval)


def _between_counts(time: Array, velocity: Array, path: Array) -> Array:
    """Give the time between an encoder's counts the speed that they tell.

    Counts follow each other one way, evenly: those of a table that trembles at rest turn back, and
    the rest between two strokes lasts longer than what lies between two counts.
    """
    way = _way(velocity, 0.0)  # without the dust of rounding
    edges = np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way)]])
    first, last = edges[:-1][way[edges[:-1]] != 0], edges[1:][way[edges[:-1]] != 0]
    if len(first) < limits.MIN_COUNTS_OF_STROKE.value:
        return velocity
    at = 0.5 * (time[first] + time[last - 1])
    gap = np.diff(at)
    usual = np.minimum(np.append(gap[1:], np.inf), np.concatenate([[np.inf], gap[:-1]]))
    bridged = (way[first[1:]] == way[first[:-1]]) & (first[1:] > last[:-1])
    bridged &= gap < limits.MAX_INTERVAL_OF_COUNTS.value * usual
    # as many of them in a row as make a stroke
    number = np.concatenate([[0], np.cumsum(~bridged)])
    bridged &= np.bincount(number)[number[1:]] >= limits.MIN_COUNTS_OF_STROKE.value
    out, between = velocity.copy(), np.append(bridged, False)
    inside = np.repeat(between, np.diff(np.append(first, len(way))))
    begun = np.flatnonzero(between)
    if not len(begun):
        return velocity
    middles = np.interp(at, time, path)
    speed = np.diff(middles) / gap
    rows = np.arange(first[0], len(way))[inside]
    out[rows] = speed[np.searchsorted(first, rows, side="right") - 1]
    return out


def _fastest(velocity: Array) -> float:
    return float(np.percentile(np.abs(velocity), _TOP_PERCENTILE))


def _averaged(time: Array, path: Array, half: int) -> Array:
    """Mean velocity between `half` samples before and after."""
    at = np.arange(len(time))
    first, last = np.maximum(at - half, 0), np.minimum(at + half, len(time) - 1)
    return (path[last] - path[first]) / (time[last] - time[first])


def _noise(velocity: Array, apart: int) -> float:
    """Noise where it is least, from second differences of values that share no samples."""
    second = np.diff(velocity[:: max(apart, 1)], 2)
    blocks = len(second) // _NOISE_BLOCK
    if blocks < 4:
        return 0.0
    rms = np.sqrt(
        (second[: blocks * _NOISE_BLOCK].reshape(blocks, _NOISE_BLOCK) ** 2).mean(axis=1) / 6.0
    )
    return float(np.percentile(rms, _REST_PERCENTILE))


def _way(velocity: Array, noise: float) -> NDArray[np.int64]:
    """Sign of what rises well above the noise, from where it leaves it to where it enters it."""
    speed = np.abs(velocity)
    least = 10.0**-limits.DECADES_TO_REST.value * float(speed.max())
    above = speed > max(noise, least)
    way = np.where(above, np.sign(velocity), 0.0).astype(np.int64)
    edges = np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way)]])
    number = np.repeat(np.arange(len(edges) - 1), np.diff(edges))
    highest = np.maximum.reduceat(speed, edges[:-1])
    return np.where(
        (highest > max(limits.MIN_SPEED_OVER_NOISE.value * noise, least))[number], way, 0
    )


def _turns(way: NDArray[np.int64]) -> int:
    return int(np.count_nonzero(np.diff(way)))


def _without_short(path: Array, way: NDArray[np.int64]) -> NDArray[np.int64]:
    """Take what leads nowhere for rest."""
    edges = np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way)]])
    moved = np.abs(path[np.minimum(edges[1:], len(path) - 1)] - path[edges[:-1]])
    short = moved < limits.MIN_DISTANCE_OF_MOTION.value * moved.max(initial=0.0)
    number = np.repeat(np.arange(len(short)), np.diff(edges))
    return np.where(short[number], 0, way)
