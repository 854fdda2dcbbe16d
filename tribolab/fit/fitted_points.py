"""Measured points that a fit uses, and tests of its residuals along the speeds."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy import special

from tribolab.core.errors import AnalysisError, Cure, shown
from tribolab.fit import limits
from tribolab.fit.point_covariance import PointErrors
from tribolab.friction.stribeck import measured_stribeck_curve
from tribolab.units.conversion import to_si


def runs_p_value(residual: np.ndarray) -> float:
    """Return the p-value of the runs test: few sign changes of the residuals give a small value.

    Examples
    --------
    >>> runs_p_value(np.array([1.0, 2, 1, 3, -1, -2, -1, -3]))  # 2 of the 70 orders
    0.02857142857142857
    """
    sign = residual[residual != 0] > 0
    plus, minus = int(sign.sum()), int((~sign).sum())
    if plus == 0 or minus == 0:
        return 1.0  # residuals of one sign cannot change sign
    seen = 1 + int(np.count_nonzero(sign[1:] != sign[:-1]))
    ways = 0.0
    for runs in range(2, seen + 1):
        half = runs // 2
        if runs % 2 == 0:
            ways += float(2 * special.comb(plus - 1, half - 1) * special.comb(minus - 1, half - 1))
        else:
            ways += float(special.comb(plus - 1, half) * special.comb(minus - 1, half - 1))
            ways += float(special.comb(plus - 1, half - 1) * special.comb(minus - 1, half))
    return float(ways / special.comb(plus + minus, plus))


def over_speed(measured: xr.Dataset) -> xr.Dataset:
    """Return a measured curve in order of speed; segments are averaged to a curve first."""
    given = measured.get("friction_coefficient")
    if given is not None and given.dims == ("segment",):
        measured = measured_stribeck_curve([measured])
    elif given is None or given.dims != ("sliding_speed",):
        over = "is not in it"
        cure = (
            "tl.measured_stribeck_curve makes such a curve from the results of friction_coefficient"
        )
        if given is not None:
            over = f"is over {', '.join(map(repr, given.dims)) or 'none'}"
            if "sliding_speed" in given.dims:
                cure = "tl.fit.fit_shear_stresses fits every curve"
        raise AnalysisError(
            f"measured: a 'friction_coefficient' over 'sliding_speed' is wanted, but it {over}",
            cure=Cure(notebook=cure),
        )
    return measured.sortby("sliding_speed")


def points(
    measured: xr.Dataset, speed_range: tuple[str | float, str | float] | None, least: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, str]:
    """Return speeds, friction, errors, mask of fitted points, and the source of the errors."""
    speed = measured["sliding_speed"].values.astype(float)
    mu = measured["friction_coefficient"].values.astype(float)
    if speed_range is None:
        low, high = 0.0, np.inf
    else:
        low, high = (to_si(end, "m/s", name="speed_range") for end in speed_range)
    used = np.isfinite(mu) & (speed > 0) & (speed >= low) & (speed <= high)
    if used.sum() < least:
        raise AnalysisError(
            f"measured: {used.sum()} points from {low:g} to {high:g} m/s; at least {least} are "
            "wanted to fit and still see a misfit"
        )
    keep = speed > 0
    for source in ("sem", "std"):
        name = f"friction_coefficient_{source}"
        if name not in measured:
            continue
        error = measured[name].values.astype(float)
        if np.any(error < 0):
            raise AnalysisError(
                f"measured: '{shown(name)}' is negative at {speed[error < 0][0]:g} m/s"
            )
        known = np.isfinite(error) & (error > 0)
        if np.any(known & used):
            error = np.where(known, error, np.median(error[known & used]))
            return speed[keep], mu[keep], error[keep], used[keep], source
    return speed[keep], mu[keep], np.ones(keep.sum()), used[keep], "scatter"


def valid_range(
    speed: np.ndarray, mu: np.ndarray, fluid: np.ndarray, area: np.ndarray, errors: PointErrors
) -> tuple[float, float]:
    """Return the widest range of neighbouring speeds (in ln v) that one sigma_f describes."""
    best, widest = (np.nan, np.nan), 0.0
    for first in range(speed.size):
        for stop in range(first + limits.MIN_SPEEDS_OF_RANGE.value, speed.size + 1):
            part = slice(first, stop)
            width = np.log(speed[stop - 1] / speed[first])
            if width <= widest or not np.any(area[part] > 0):
                continue
            known = errors.at(part)
            stress = regression(mu[part], fluid[part], area[part], known)
            miss = known.whitened(mu[part] - fluid[part] - stress * area[part])
            if (
                special.chdtrc(stop - first - 1, float(miss @ miss))
                > limits.MIN_CHANCE_OF_MISFIT.value
            ):
                best, widest = (float(speed[first]), float(speed[stop - 1])), width
    return best


def regression(mu: np.ndarray, fluid: np.ndarray, area: np.ndarray, errors: PointErrors) -> float:
    """Return the shear stress that fits friction best, with correlated errors."""
    solid = errors.whitened(area)
    return float(solid @ errors.whitened(mu - fluid) / (solid @ solid))
