"""Zero points: from rests without load, and from strokes that are run both ways."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.friction.statistics import describe

UNLOADED = 0.1  # share of the load below which a rest can be one without contact
FEWEST = 10  # samples that an unloaded rest needs


class Zero(NamedTuple):
    """Reading of a sensor without load, and its standard error [N]."""

    value: float
    error: float


def unloaded_rest(
    run: xr.Dataset, segments: xr.Dataset, load: float
) -> tuple[Zero | None, Zero | None]:
    """Zero of the friction force and of the normal force from rests without load.

    Parameters
    ----------
    run, segments
        The run and its segments, whose omitted stretches say where it was at rest.
    load
        Usual normal force of the segments [N].

    Returns
    -------
    tuple
        Zero of the friction force and of the normal force; None where no rest tells it. Several
        rests are averaged, and their spread (a drift of the zero) is part of the error.
    """
    if "normal_force" not in run or not load > 0:
        return None, None
    time = run["time"].values
    normal = run["normal_force"].values
    friction = run["friction_force"].values if "friction_force" in run else None
    zeros: dict[str, list[tuple[float, float]]] = {"normal": [], "friction": []}
    resting = segments["omitted_reason"].values == "at rest"
    limits = zip(
        segments["omitted_start"].values[resting],
        segments["omitted_stop"].values[resting],
        strict=True,
    )
    for start, stop in limits:
        first, last = np.searchsorted(time, [start, stop])
        light = first + np.flatnonzero(np.abs(normal[first:last]) < UNLOADED * load)
        if light.size < FEWEST:
            continue
        # the load's ramp begins in the same rest: readings far from the usual one are left out
        rest = np.abs(normal[light] - np.median(normal[light]))
        level = light[rest <= 5 * max(np.median(rest) / 0.6745, 1e-4 * load)]
        if level.size < FEWEST:
            continue
        found = describe(time[level], normal[level])
        zeros["normal"].append((found.mean, found.sem))
        if friction is not None:
            found = describe(time[level], friction[level])
            if found.samples >= FEWEST:
                zeros["friction"].append((found.mean, found.sem))
    return _mean_zero(zeros["friction"]), _mean_zero(zeros["normal"])


def _mean_zero(found: list[tuple[float, float]]) -> Zero | None:
    if not found:
        return None
    value, error = np.array(found).T
    k = value.size
    spread = np.var(value, ddof=1) / k if k > 1 else 0.0
    return Zero(float(value.mean()), float(np.sqrt((error**2).sum() / k**2 + spread)))


def pair_strokes(segments: xr.Dataset, tolerance: float) -> np.ndarray:
    """Return the number of the pair that each segment belongs to, -1 for none (segment).

    Neighbours in time of opposite direction pair if their speeds differ by no more than
    `tolerance` of their mean and, where the run has set speeds, those agree.
    """
    direction = segments["direction"].values
    speed = segments["sliding_speed"].values
    pair = np.full(direction.size, -1)
    number = 0
    for i in range(direction.size - 1):
        if pair[i] >= 0 or direction[i] * direction[i + 1] != -1:
            continue
        mean = (speed[i] + speed[i + 1]) / 2
        alike = not abs(speed[i] - speed[i + 1]) > tolerance * mean  # unknown speeds may pair
        if "set_speed" in segments:
            wanted = np.abs(segments["set_speed"].values[i : i + 2])
            alike &= not abs(wanted[0] - wanted[1]) > 1e-6 * abs(wanted).max()
        if alike:
            pair[i : i + 2] = number
            number += 1
    return pair


class Wander(NamedTuple):
    """How a zero moves: variance between neighbouring strokes [u2], and rate of its walk [u2/s]."""

    fast: float
    rate: float


def wander(offset: np.ndarray, error: np.ndarray, time: np.ndarray) -> Wander:
    """Tell how the zero moves from the offsets of successive pairs of strokes.

    A zero that moves more slowly than a stroke lasts does not show within the stroke, but it
    falsifies the half loop: the backward stroke comes later than the forward one.

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
        offsets, by weighted moments, each taken one standard error above its estimate; zeros below
        two pairs. One pair tells nothing, and a single difference is all s^2.
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
    from scipy import optimize  # not before it is needed: it takes a fifth of a second to load

    scale = apart.mean()
    parts = np.stack([np.ones(apart.size), apart / scale], axis=1)
    found = np.zeros(2)
    for _ in range(30):  # the weights depend on what is sought; this settles in a few rounds
        expected = noise + parts @ found
        weight = 1 / np.maximum(expected, 1e-9 * expected.max() + 1e-300)
        found, _ = optimize.nnls(parts * weight[:, None], excess * weight)
    # so few squares tell a variance poorly: one standard error above it, as Student's t would; each
    # with the other held, because even spacing does not tell them apart
    found = found + np.sqrt(2 / ((parts * weight[:, None]) ** 2).sum(axis=0))
    return Wander(float(found[0]), float(found[1] / scale))
