"""Sliding time and number of repeats for a required uncertainty of friction."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, special

from tribolab.core.errors import AnalysisError

MOST_RUNS = 1000
_RUNS = np.arange(2, MOST_RUNS + 1)


@dataclass(frozen=True)
class Pilot:
    """Scatter of friction in a pilot campaign at one speed.

    Parameters
    ----------
    within
        Standard deviation of the coefficient along a run.
    memory
        Integrated autocorrelation time [s] of the coefficient along a run.
    between
        Standard deviation between runs, without the contribution of scatter within runs.
    """

    within: float
    memory: float
    between: float


def run_variance(pilot: Pilot, sliding_time: float) -> float:
    """Return the variance of the mean of a run with a given sliding time [s].

    Notes
    -----
    s_b^2 + (2 tau s^2 / T) [1 - (tau/T)(1 - exp(-T/tau))], the variance of the mean of a signal
    whose correlation falls exponentially.

    Examples
    --------
    >>> run_variance(Pilot(0.1, 0.0, 0.02), 10.0)
    0.0004
    """
    tau, share = pilot.memory, 1.0
    if tau <= 0:
        return pilot.between**2
    ratio = tau / sliding_time
    share = 2 * ratio * (1 - ratio * -math.expm1(-1 / ratio))
    return pilot.between**2 + pilot.within**2 * share


def runs_for_standard_error(
    variance: float,
    standard_error: float,
    assurance: float | None = None,
    pilot_runs: int | None = None,
) -> int | None:
    """Return the number of runs for a required standard error of the mean.

    Parameters
    ----------
    variance
        Variance of the mean of one run, from `run_variance`.
    standard_error
        Required standard error.
    assurance
        Probability that the estimated error is at most the required one; 50 % if not given.
    pilot_runs
        Number of runs from which the variance was estimated; None if it is known.

    Returns
    -------
    int or None
        Two or more; None if a thousand runs are too few.

    Notes
    -----
    n = v/u^2. With assurance q, v is multiplied by chi^2_q(n - 1)/(n - 1), the quantile of the
    estimated variance, or by F_q(n - 1, m - 1) if v is from m pilot runs. With a pilot and without
    assurance q is a half: the variance of few runs is more often too small than too large (the
    median for three is 0.69 of the true value), so that a plan with it would be insufficient.

    Examples
    --------
    >>> runs_for_standard_error(0.01, 0.05), runs_for_standard_error(0.01, 0.05, 0.9)
    (4, 8)
    """
    reached = np.sqrt(variance * _worst(assurance, pilot_runs) / _RUNS)
    return _first(reached, standard_error)


def runs_for_half_interval(
    variance: float,
    half_interval: float,
    assurance: float | None = None,
    pilot_runs: int | None = None,
) -> int | None:
    """Return the number of runs for a required half width of the 95 % interval.

    Examples
    --------
    >>> runs_for_half_interval(0.01, 0.1)
    7
    """
    student = np.asarray(special.stdtrit(_RUNS - 1, 0.975), float)
    reached = student * np.sqrt(variance * _worst(assurance, pilot_runs) / _RUNS)
    return _first(reached, half_interval)


@functools.lru_cache(maxsize=64)
def _worst(assurance: float | None, pilot_runs: int | None) -> NDArray[np.float64]:
    """Return, by number of runs, the ratio of variances not exceeded with a probability."""
    if pilot_runs is not None:
        chance = 0.5 if assurance is None else assurance
        return np.asarray(special.fdtri(_RUNS - 1, pilot_runs - 1, chance))
    if assurance is None:
        return np.ones(_RUNS.size)
    return np.asarray(special.chdtri(_RUNS - 1, 1 - assurance) / (_RUNS - 1))


def _first(reached: NDArray[np.float64], wanted: float) -> int | None:
    """Return the smallest number of runs with an uncertainty not above the required one."""
    enough = np.flatnonzero(reached <= wanted * (1 + 1e-12))
    return int(_RUNS[enough[0]]) if enough.size else None


def cheapest_sliding_time(pilot: Pilot, setup_time: float, longest: float) -> float:
    """Return the sliding time per run [s] that gives the shortest total time.

    Parameters
    ----------
    pilot
        Scatter from a pilot study.
    setup_time
        Time for each run besides sliding [s].
    longest
        Longest sliding time of the rig [s]; returned if runs do not differ.

    Notes
    -----
    T minimises (t_s + T) v(T); for T much longer than the correlation time it is sqrt(t_s 2 tau s^2
    / s_b^2).

    Examples
    --------
    >>> round(cheapest_sliding_time(Pilot(0.1, 1.0, 0.01), 600.0, 1e5), -1)
    350.0
    """
    if setup_time <= 0:
        raise AnalysisError(f"a setup time of {setup_time:g} s: it has to be above zero")
    least = max(pilot.memory, 1e-6 * longest)
    if pilot.within == 0 or pilot.memory <= 0 or least >= longest:
        return min(least, longest)
    made = optimize.minimize_scalar(
        lambda log: math.log((setup_time + math.exp(log)) * run_variance(pilot, math.exp(log))),
        bounds=(math.log(least), math.log(longest)),
        method="bounded",
    )
    return float(math.exp(made.x))
