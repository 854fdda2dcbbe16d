"""Repeatability of the friction level between runs, an error that all points of a curve share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

from tribolab.friction.points.limits import SPEED_TOLERANCE
from tribolab.friction.stribeck import measured_stribeck_curve


def run_levels(
    frictions: Sequence[xr.Dataset], speed_tolerance: float = SPEED_TOLERANCE.value
) -> np.ndarray:
    """Return the friction of each run relative to the mean of all repeats, over all speeds.

    Parameters
    ----------
    frictions
        Results of `friction_coefficient` of repeats, one for each run.
    speed_tolerance
        As for `measured_stribeck_curve`.

    Returns
    -------
    numpy.ndarray
        Level [1] of each run relative to the mean of the repeats; NaN if none of its points has a
        speed and a positive friction.

    Notes
    -----
    Mean of mu_run/mu over the speeds, weighted by the squared relative errors of the run's points
    if they have any.
    """
    together = measured_stribeck_curve(frictions, speed_tolerance)
    speed = np.log(together["sliding_speed"].values)
    levels = []
    for friction in frictions:
        own = measured_stribeck_curve([friction], speed_tolerance)
        if not own.sizes["sliding_speed"]:  # e.g. steps of unknown speed
            levels.append(np.nan)
            continue
        place = np.abs(np.log(own["sliding_speed"].values)[:, None] - speed).argmin(axis=1)
        whole = together["friction_coefficient"].values[place]
        mu, sem = (own[f"friction_coefficient{end}"].values for end in ("", "_sem"))
        known = np.isfinite(sem) & (sem > 0)
        if not known.any():  # results of the instrument, without errors
            known, sem = np.ones(mu.size, bool), mu
        fine = (mu > 0) & (whole > 0) & known
        weight = (mu[fine] / sem[fine]) ** 2
        levels.append(weight @ (mu / whole)[fine] / weight.sum() if fine.any() else np.nan)
    return np.array(levels, dtype=float)


def pooled_repeatability(levels: Iterable[np.ndarray]) -> tuple[float, int]:
    """Return the relative standard deviation of a run's friction level, pooled over conditions.

    Parameters
    ----------
    levels
        For each condition the levels of its runs, from `run_levels`.

    Returns
    -------
    tuple
        Standard deviation [1] and its degrees of freedom; 0 and 0 if no condition was repeated.

    Notes
    -----
    Two repeats determine their scatter poorly. If all conditions were repeated on one rig, their
    scatter is pooled: ``s^2 = sum (l - mean)^2 / sum (k - 1)``.

    Examples
    --------
    >>> s, freedom = pooled_repeatability([np.array([0.99, 1.01]), np.array([1.0, 1.0])])
    >>> round(s, 4), freedom
    (0.01, 2)
    """
    squares, freedom = 0.0, 0
    for level in levels:
        known = np.asarray(level, dtype=float)
        known = known[np.isfinite(known)]
        if known.size > 1:
            squares += float(np.sum((known - known.mean()) ** 2))
            freedom += known.size - 1
    return (float(np.sqrt(squares / freedom)), freedom) if freedom else (0.0, 0)
