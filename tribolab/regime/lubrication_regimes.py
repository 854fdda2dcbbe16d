"""Boundary, mixed and hydrodynamic regimes of measured and computed Stribeck curves."""

from __future__ import annotations

import numpy as np
import xarray as xr

_BOUNDARY, _MIXED, _HYDRODYNAMIC = "boundary", "mixed", "hydrodynamic"
_FLAT = 0.15  # relative change of friction up to which a curve is a plateau
_SIGMAS = 3.0  # the same change in standard errors; the larger of both limits applies
_RISE = 1.2  # ratio of friction to its minimum from which the regime is hydrodynamic
_CARRIED = 0.9  # share of the load carried by solid or fluid that decides the regime


def measured_regimes(curve: xr.Dataset) -> np.ndarray:
    """Return the regime at each speed of a measured curve, from the shape of the curve.

    Parameters
    ----------
    curve
        From `measured_stribeck_curve`, in a fluid.

    Returns
    -------
    ndarray
        Text (sliding_speed).

    Notes
    -----
    Boundary: from the lowest speed on as long as friction stays within 15 % (or three standard
    errors) of its median over the three lowest speeds, for at least three speeds. Hydrodynamic:
    above the minimum, where friction has risen by a fifth. Mixed: between.

    Examples
    --------
    >>> mu = [1.0, 1.02, 0.98, 0.5, 0.1, 0.12, 0.3]
    >>> curve = xr.Dataset(
    ...     {"friction_coefficient": ("sliding_speed", mu)},
    ...     {"sliding_speed": np.geomspace(1e-6, 1e-2, 7)},
    ... )
    >>> [str(word)[0] for word in measured_regimes(curve)]
    ['b', 'b', 'b', 'm', 'm', 'm', 'h']
    """
    mu = curve["friction_coefficient"].values
    error = np.zeros(mu.size)
    if "friction_coefficient_sem" in curve:
        error = np.nan_to_num(curve["friction_coefficient_sem"].values)
    regimes = np.full(mu.size, _MIXED, dtype=object)
    if mu.size < 3:
        return regimes
    level = float(np.median(mu[:3]))
    flat = np.abs(mu - level) <= np.maximum(_FLAT * abs(level), _SIGMAS * error)
    count = int(np.argmin(np.append(flat, False)))
    if count >= 3:
        regimes[:count] = _BOUNDARY
    lowest = int(np.argmin(mu))
    risen = np.arange(mu.size) > lowest
    risen &= mu > np.maximum(_RISE * mu[lowest], mu[lowest] + _SIGMAS * error)
    if count < mu.size:
        regimes[risen & (regimes != _BOUNDARY)] = _HYDRODYNAMIC
    return regimes


def model_regimes(curve: xr.Dataset) -> np.ndarray:
    """Return the regime at each speed of a computed curve, from the loads on solid and fluid.

    Parameters
    ----------
    curve
        From `stribeck_curve`, with ``solid_load_share`` (sliding_speed).

    Returns
    -------
    ndarray
        Text (sliding_speed).
    """
    share = curve["solid_load_share"].values
    solid, fluid = share >= _CARRIED, share <= 1 - _CARRIED
    return np.where(solid, _BOUNDARY, np.where(fluid, _HYDRODYNAMIC, _MIXED)).astype(object)


def end_of_boundary(speed: np.ndarray, regimes: np.ndarray) -> float:
    """Return the highest speed in the boundary regime [m/s]; NaN if there is none."""
    inside = speed[regimes == _BOUNDARY]
    return float(inside.max()) if inside.size else float("nan")
