"""Whether friction is steady along a segment: steady, not steady, or not decided."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

SIGNIFICANT = 0.01  # chance of a trend below which a segment is not steady: runs have hundreds
SUSPECT_DRIFT = 0.05  # of the run's typical friction: above the usual spread of repeats
FAILING_DRIFT = 0.50  # of the run's typical friction: a mean over such a change has no meaning
SAMPLES = 10.0  # fewer effective samples do not tell a trend from slow wandering
_MANY = 20  # segments
LIMITS = {
    "suspect": SUSPECT_DRIFT,
    "fail": FAILING_DRIFT,
    "chance": SIGNIFICANT,
    "samples": SAMPLES,
}

IS_NOT_STEADY, IS_STEADY, NOT_DECIDED = 0, 1, 2
STEADINESS_WORDS = {IS_NOT_STEADY: "not steady", IS_STEADY: "steady", NOT_DECIDED: "undecided"}


def chance_limit(samples: np.ndarray, limits: Mapping[str, float] = LIMITS) -> np.ndarray:
    """Return the p value below which a line through each segment is a trend (segment).

    Of more than 20 segments the p value has to be smaller, by the square of their number: in a
    hundred strokes one would be below 0.01 by chance, and of many runs with hundreds each every
    fifth would hold one if it were in proportion (Bonferroni). A crank makes hundreds of segments
    of few effective samples. Their memory cannot be seen in so short a record, and in one of
    twenty noise looks like a trend: no single one of them tells.

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
    short = known.size >= _MANY and np.median(known) < limits["samples"]
    single = limits["chance"] * min(1.0, _MANY / max(known.size, 1)) ** 2
    return np.full(samples.shape, 0.0 if short else single)


def undecided(
    change: np.ndarray, chance: np.ndarray, samples: np.ndarray, limits: Mapping[str, float]
) -> np.ndarray:
    """Return where a line through the friction shows neither a trend nor that there is none.

    It changes by as much as is objected to, but of so few effective samples that the test would
    hardly have seen it; or by so much that no test makes it steady.

    Parameters
    ----------
    change
        Along the line, of the typical friction [1] (segment).
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
    """Change of friction along the trend of each segment, of the run's typical friction [1].

    At high speed in a liquid hardly any friction is left to divide by: hence the run's.

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
