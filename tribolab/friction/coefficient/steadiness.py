"""Steadiness of friction along a segment: steady, not steady, or undecided."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from tribolab.friction.coefficient.limits import (
    FAILING_DRIFT,
    MIN_EFFECTIVE_SAMPLES,
    MIN_SEGMENTS_OF_STRICTER_TREND,
    SUSPECT_DRIFT,
    TREND_BY_CHANCE,
)

if TYPE_CHECKING:
    import xarray as xr

LIMITS = {
    "suspect": SUSPECT_DRIFT.value,
    "fail": FAILING_DRIFT.value,
    "chance": TREND_BY_CHANCE.value,
    "samples": MIN_EFFECTIVE_SAMPLES.value,
}

IS_NOT_STEADY, IS_STEADY, NOT_DECIDED = 0, 1, 2
STEADINESS_WORDS = {IS_NOT_STEADY: "not steady", IS_STEADY: "steady", NOT_DECIDED: "undecided"}


def chance_limit(samples: np.ndarray, limits: Mapping[str, float] = LIMITS) -> np.ndarray:
    """Return the p value below which a line through a segment is a trend (segment).

    Above 20 segments the p value must decrease with the square of their number: in a hundred
    strokes one is below 0.01 by chance, and with Bonferroni's proportional correction every fifth
    of many such runs would contain one. A crank makes hundreds of segments with few effective
    samples each. Their correlation cannot be resolved, and noise looks like a trend in one of
    twenty: the limit is 0, so that no segment has a significant trend.

    Parameters
    ----------
    samples
        Effective samples (segment).
    limits
        `LIMITS`, or those of the check on steadiness.

    Examples
    --------
    >>> chance_limit(np.array([90.0, 3.0])).tolist(), chance_limit(np.full(20, 4.0)).tolist()[0]
    ([0.01, 0.01], 0.0)
    >>> round(float(chance_limit(np.full(100, 90.0))[0]), 9)
    0.0004
    """
    known = samples[np.isfinite(samples)]
    short = (
        known.size >= MIN_SEGMENTS_OF_STRICTER_TREND.value and np.median(known) < limits["samples"]
    )
    single = (
        limits["chance"] * min(1.0, MIN_SEGMENTS_OF_STRICTER_TREND.value / max(known.size, 1)) ** 2
    )
    return np.full(samples.shape, 0.0 if short else single)


def undecided(
    change: np.ndarray, chance: np.ndarray, samples: np.ndarray, limits: Mapping[str, float]
) -> np.ndarray:
    """Return a mask of segments whose trend is neither significant nor excluded.

    Either the change exceeds the check's limit, with too few effective samples for a test; or it is
    so large that the segment is not called steady, although the test finds no trend.

    Parameters
    ----------
    change
        Change along the line relative to the typical friction [1] (segment).
    chance, samples
        The line's p value, and effective samples (segment).
    limits
        `LIMITS`, or those of the check on steadiness.

    Examples
    --------
    >>> p, n = np.array([0.36, 0.36, 1e-4, 0.36]), np.array([2.8, 90.0, 2.8, 90.0])
    >>> undecided(np.array([-0.2, -0.2, -0.2, -6.2]), p, n, LIMITS)
    array([ True, False, False,  True])
    """
    size = np.abs(change)
    open_ = (size > limits["suspect"]) & (samples < limits["samples"])
    return (open_ | (size > limits["fail"])) & (chance >= chance_limit(samples, limits))


def relative_change(friction: xr.Dataset) -> np.ndarray | None:
    """Return the change of friction along each segment's trend, relative to typical friction [1].

    It is relative to the run's friction, because that of a fast segment in a liquid can be almost
    zero.

    Parameters
    ----------
    friction
        Result of `friction_coefficient`.

    Returns
    -------
    numpy.ndarray or None
        (segment); None without a trend or without any friction.
    """
    name = next((n for n in ("friction_coefficient", "friction_force") if n in friction), "")
    if "trend_change" in friction:
        change = friction["trend_change"].values
    elif "force_trend" in friction:
        duration = friction["trimmed_stop"].values - friction["trimmed_start"].values
        change = friction["force_trend"].values * duration
    else:
        return None
    typical = np.abs(friction[name].values)
    if not (typical > 0).any():
        return None
    return change / float(np.nanmean(typical))


def judged(friction: xr.Dataset) -> xr.Dataset:
    """Add ``steady`` (segment), a flag with three values.

    Parameters
    ----------
    friction
        Result of `friction_coefficient` with ``trend_p_value`` and ``effective_samples``.
    """
    chance, samples = friction["trend_p_value"].values, friction["effective_samples"].values
    change = relative_change(friction)
    if change is None:
        change = np.full(chance.shape, np.nan)
    open_ = ~np.isfinite(chance) | undecided(change, chance, samples, LIMITS)
    flag = np.where(
        open_, NOT_DECIDED, np.where(chance < chance_limit(samples), IS_NOT_STEADY, IS_STEADY)
    )
    attrs = {
        "flag_values": np.array(list(STEADINESS_WORDS), np.int8),
        "flag_meanings": " ".join(word.replace(" ", "_") for word in STEADINESS_WORDS.values()),
    }
    return friction.assign(steady=("segment", flag.astype(np.int8), attrs))
