"""Detection of motion and its direction, from a velocity with noise, steps or jitter.

A velocity signal is not exactly zero at rest, because of noise or encoder steps. It is averaged
over as few samples as bring the noise below a fiftieth of the highest speed; intervals within the
noise or without displacement are rest. In a stroke so slow that an encoder counts only
occasionally, the speed between two counts is their mean speed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits

_MAX_HALF_WIDTH = 64  # most samples on either side of an average
_NOISE_BLOCK = 16  # samples per block for estimating noise
_REST_PERCENTILE = 3.0  # percentile of the noise in blocks that counts as noise at rest
_TOP_PERCENTILE = 99.0  # percentile of the speed that counts as the fastest


class Motion(NamedTuple):
    """Velocity [m/s], 0 at rest, direction (-1, 0, 1), and averaging time [s]."""

    velocity: Array
    way: NDArray[np.int64]
    averaged: float


def clean_motion(time: Array, velocity: Array) -> Motion:
    """Return the velocity and direction of a motion log, both zero at rest.

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
    path = integral(time, velocity)
    velocity = _fill_between_counts(time, velocity, path)
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
    way = _directions(smooth, noise)
    way = _without_short_motion(path, way)
    plain = _directions(velocity, 0.0)
    # the velocity is quiet at rest, so it needs no averaging
    if _turns(plain) <= limits.MAX_CHANGES_OF_NOISE.value * _turns(way):
        return Motion(np.where(plain != 0, velocity, 0.0), plain, 0.0)
    interval = float(np.percentile(np.diff(time), 5))
    return Motion(np.where(way != 0, smooth, 0.0), way, 2 * half * interval)


def integral(time: Array, values: Array) -> Array:
    """Return the integral of a signal over time, by trapezoids, from the first sample on."""
    return np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (values[1:] + values[:-1]))])


def _fill_between_counts(time: Array, velocity: Array, path: Array) -> Array:
    """Fill the time between an encoder's counts with their mean speed.

    Only evenly spaced counts in one direction are joined: vibration at rest reverses direction, and
    the rest between two strokes is longer than the time between two counts.
    """
    way = _directions(velocity, 0.0)  # rounding errors count as rest
    edges = np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way)]])
    first, last = edges[:-1][way[edges[:-1]] != 0], edges[1:][way[edges[:-1]] != 0]
    if len(first) < limits.MIN_COUNTS_OF_STROKE.value:
        return velocity
    at = 0.5 * (time[first] + time[last - 1])
    gap = np.diff(at)
    usual = np.minimum(np.append(gap[1:], np.inf), np.concatenate([[np.inf], gap[:-1]]))
    bridged = (way[first[1:]] == way[first[:-1]]) & (first[1:] > last[:-1])
    bridged &= gap < limits.MAX_INTERVAL_OF_COUNTS.value * usual
    # fewer counts in a row are not a stroke
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
    """Return the mean velocity over `half` samples before and after."""
    at = np.arange(len(time))
    first, last = np.maximum(at - half, 0), np.minimum(at + half, len(time) - 1)
    return (path[last] - path[first]) / (time[last] - time[first])


def _noise(velocity: Array, apart: int) -> float:
    """Return the noise at rest [m/s], from second differences of every `apart`-th velocity."""
    second = np.diff(velocity[:: max(apart, 1)], 2)
    blocks = len(second) // _NOISE_BLOCK
    if blocks < 4:
        return 0.0
    rms = np.sqrt(
        (second[: blocks * _NOISE_BLOCK].reshape(blocks, _NOISE_BLOCK) ** 2).mean(axis=1) / 6.0
    )
    return float(np.percentile(rms, _REST_PERCENTILE))


def _directions(velocity: Array, noise: float) -> NDArray[np.int64]:
    """Return directions (-1, 0, 1); an interval moves if its peak is well above the noise."""
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


def _without_short_motion(path: Array, way: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the directions, with 0 also for intervals of negligible displacement."""
    edges = np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way)]])
    moved = np.abs(path[np.minimum(edges[1:], len(path) - 1)] - path[edges[:-1]])
    short = moved < limits.MIN_DISTANCE_OF_MOTION.value * moved.max(initial=0.0)
    number = np.repeat(np.arange(len(short)), np.diff(edges))
    return np.where(short[number], 0, way)
