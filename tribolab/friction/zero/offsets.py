"""Pairs of strokes in both directions, and the drift of the zero between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.friction.zero import limits


def pair_strokes(segments: xr.Dataset, tolerance: float) -> np.ndarray:
    """Return the pair number of each segment; -1 without a partner (segment).

    Successive strokes in opposite directions pair if their speeds differ by no more than
    `tolerance` of their mean. If the run has set speeds and `tolerance` is at most the default,
    these must agree, too.
    """
    direction = segments["direction"].values
    speed = segments["sliding_speed"].values
    pair = np.full(direction.size, -1)
    number = 0
    for i in range(direction.size - 1):
        if pair[i] >= 0 or direction[i] * direction[i + 1] != -1:
            continue
        mean = (speed[i] + speed[i + 1]) / 2
        alike = not abs(speed[i] - speed[i + 1]) > tolerance * mean  # true also for unknown speeds
        if "set_speed" in segments and tolerance <= limits.MAX_SPEED_DIFFERENCE_OF_PAIR.value:
            wanted = np.abs(segments["set_speed"].values[i : i + 2])
            alike &= not abs(wanted[0] - wanted[1]) > 1e-6 * abs(wanted).max()
        if alike:
            pair[i : i + 2] = number
            number += 1
    return pair


class Wander(NamedTuple):
    """Drift of a zero: variance from stroke to stroke [u2], and rate of a random walk [u2/s]."""

    fast: float
    rate: float


def wander(offset: np.ndarray, error: np.ndarray, time: np.ndarray) -> Wander:
    """Estimate the drift of the zero from the offsets of successive pairs of strokes.

    A zero that drifts slowly compared with a stroke is not visible within the stroke, but it biases
    the half loop: the backward stroke is later than the forward one.

    Parameters
    ----------
    offset, error
        Offsets of the pairs in order and their standard errors, in one unit u (pair).
    time
        Middle of each pair [s].

    Returns
    -------
    Wander
        s^2 and D of <d^2> = e_i^2 + e_{i+1}^2 + s^2 + D dt for the differences d of successive
        offsets, by weighted moments, each taken one standard error above its estimate; zero for
        fewer than two pairs. A single difference is attributed to s^2.
    """
    known = np.isfinite(offset) & np.isfinite(error)
    offset, variance, time = offset[known], error[known] ** 2, time[known]
    if offset.size < 2:
        return Wander(0.0, 0.0)
    apart = np.diff(time)
    noise = variance[1:] + variance[:-1]
    excess = np.diff(offset) ** 2 - noise
    if offset.size == 2:
        return Wander(max(0.0, float(excess[0])), 0.0)
    from scipy import optimize  # imported late: it takes a fifth of a second to load

    scale = apart.mean()
    parts = np.stack([np.ones(apart.size), apart / scale], axis=1)
    # the weights depend on the result: iterate. At first they are equal, because steps with a
    # small error of their own would otherwise dominate a step that no error explains
    expected = np.full(apart.size, np.max(excess + noise) + noise.max())
    if not expected[0] > 0:  # simulated without noise: no differences
        return Wander(0.0, 0.0)
    for _ in range(30):
        weight = 1 / np.maximum(expected, 1e-9 * expected.max() + 1e-150)
        variances, _ = optimize.nnls(parts * weight[:, None], excess * weight)
        expected = noise + parts @ variances
    # few squares determine a variance poorly: one standard error is added, as Student's t would
    # do; for each variance with the other fixed, as evenly spaced strokes do not separate the two
    variances = variances + np.sqrt(2 / ((parts * weight[:, None]) ** 2).sum(axis=0))
    return Wander(float(variances[0]), float(variances[1] / scale))
