"""Errors of a joint fit due to uncertain spectra, model inputs and calibrations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError
from tribolab.fit import limits
from tribolab.fit.joint.load_curve import LoadCurve
from tribolab.fit.joint.model import JointModel, Points, shared_by_points
from tribolab.fit.joint.posterior import Posterior
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.spectrum_error import SPECTRUM
from tribolab.metrology.budget_curve import shared_parts

_INPUTS = ("load", "radius", "Young's modulus")  # uncertain inputs that are common to all surfaces


def model_covariance(
    model: JointModel,
    posterior: Posterior,
    priors: JointPriors,
    uncertainty: Mapping[int, xr.Dataset],
) -> np.ndarray:
    """Return the covariance of the fitted parameters due to uncertain spectra and model inputs.

    Parameters
    ----------
    model, posterior, priors
        Of the fit with the nominal spectra.
    uncertainty
        By number of the surface, the result of `model_uncertainty` at one load.

    Returns
    -------
    numpy.ndarray
        Covariance (parameter, parameter).

    Raises
    ------
    AnalysisError
        If the band is for a load that is not fitted, or for too few speeds.

    Notes
    -----
    A rougher surface has less contact area and separates at higher speed, as with a lower shear
    stress and a thinner liquid, at all loads alike. Each end of a variation of the spectrum is
    therefore expressed by changes of shear stress, exponent of speed and viscosity: ln(mu
    varied/mu) over the measured speeds, at the load for which it was computed, is projected on
    their derivatives. Their effect on the fit at all loads is ``Sigma J' V^-1 delta``. The ends
    have some 95 % coverage; the variations and the spectra of the surfaces are independent of each
    other. Load, radius and modulus are treated alike, with errors common to all surfaces.
    """
    points, where = model.points, model.parameters
    slopes, answer = _response(model, posterior, priors)
    added = np.zeros((where.spread.size, where.spread.size))
    together: dict[str, np.ndarray] = {}
    for surface, band in uncertainty.items():
        columns = [where.stress[surface], where.speed[surface], where.viscosity]
        columns = [column for column in columns if where.spread[column] > 0]
        of_surface = np.array([model.curves[k].surface == surface for k in points.curve])
        wet = np.array([not model.curves[k].dry for k in points.curve])
        for name, ends in _project(model, posterior.centre, surface, columns, band).items():
            moved = ends @ (slopes[:, columns] * (of_surface & wet)[:, None]).T @ answer.T
            if name in _INPUTS:
                together[name] = together.get(name, 0.0) + moved
            else:
                added += moved.T @ moved / len(ends) / NORMAL**2
    for moved in together.values():
        added += moved.T @ moved / len(moved) / NORMAL**2
    return added


def calibration_covariance(
    model: JointModel,
    posterior: Posterior,
    priors: JointPriors,
    curves: Sequence[LoadCurve],
    speed_error: float = 0.0,
) -> np.ndarray:
    """Return the covariance of the fitted parameters due to calibrations that curves share.

    Parameters
    ----------
    model, posterior, priors
        Of the fit.
    curves
        Measured curves with ``uncertainty_part``, from `curve_uncertainty`; parts of equal name are
        one error of all curves.
    speed_error
        Relative standard error [1] common to all sliding speeds.

    Returns
    -------
    numpy.ndarray
        Covariance (parameter, parameter), the sum over all shared parts of the squared parameter
        change ``Sigma J' V^-1 c``; c is the change of ln mu by one standard uncertainty. For the
        speed c follows from d ln mu/d ln v, the sum of d ln mu/d ln eta and of the effect of n.
    """
    points = model.points
    rows: dict[str, np.ndarray] = {}
    for number, curve in enumerate(curves):
        mine = points.curve == number
        data = curve.measured
        if "run" in data["friction_coefficient"].dims:
            continue  # such shared errors belong to the mean of the runs, not to each run
        log_speed = np.log(data.get("measured_speed", data["sliding_speed"]).values.astype(float))
        for name, part in shared_parts(data):
            relative = part / data["friction_coefficient"].values
            known = np.isfinite(relative) & np.isfinite(log_speed)
            if known.any():
                row = rows.setdefault(name, np.zeros(points.log_speed.size))
                row[mine] = np.interp(points.log_speed[mine], log_speed[known], relative[known])
    slopes, answer = _response(model, posterior, priors)
    if speed_error > 0:
        rows["speed"] = speed_error * _speed_slope(model, posterior.centre, slopes)
    moved = np.array(list(rows.values())).reshape(-1, points.log_speed.size) @ answer.T
    return moved.T @ moved


def _speed_slope(model: JointModel, theta: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Return d ln mu/d ln v at the points; only lubricated friction depends on the viscosity."""
    where = model.parameters
    solid = slopes[:, where.stress] @ theta[where.speed]
    return np.asarray(slopes[:, where.viscosity] + solid)


def _response(
    model: JointModel, posterior: Posterior, priors: JointPriors
) -> tuple[np.ndarray, np.ndarray]:
    """Return d ln mu/d theta (point, parameter), and d theta/d ln mu of the fit (its transpose)."""
    weights = posterior.weight
    tau, kappa = weights @ posterior.level, weights @ posterior.correlated
    points, where = model.points, model.parameters
    shared = shared_by_points(points, points, priors.correlation_length)
    whole = np.diag(points.error**2) + tau**2 * shared.level + kappa**2 * shared.near
    _, slopes = model.predicted(posterior.centre)
    free = where.spread > 0
    weighed = np.linalg.solve(whole, slopes[:, free]).T
    normal = weighed @ slopes[:, free] + np.diag(where.spread[free] ** -2.0)
    answer = np.zeros(slopes.T.shape)
    answer[free] = np.linalg.solve(normal, weighed)
    return slopes, answer


def _project(
    model: JointModel, theta: np.ndarray, surface: int, columns: list[int], band: xr.Dataset
) -> dict[str, np.ndarray]:
    """Return the parameter changes equivalent to both ends of each variation (end, parameter)."""
    load = float(band.attrs["load_N_m"])
    offs = {
        number: abs(curve.log_load - model.log_reference(load))
        for number, curve in enumerate(model.curves)
        if curve.surface == surface and not curve.dry
    }
    number = min(offs, key=lambda key: offs[key])
    if offs[number] > 0.01:
        raise AnalysisError(f"the model's uncertainty is of {load:g} N/m, which is not fitted")
    measured = model.points.log_speed[model.points.curve == number]
    log_speed = np.log(band["sliding_speed"].values)
    known = (*SPECTRUM, *_INPUTS)
    chosen = [name for name in band["variation"].values.tolist() if name in known]
    ends_of = band["friction_coefficient_varied"].sel(variation=chosen)
    varied = ends_of.transpose("variation", "range_end", "sliding_speed").values
    change = np.log(varied / band["friction_coefficient"].values)
    inside = (log_speed > measured.min() - 0.01) & (log_speed < measured.max() + 0.01)
    # few closely spaced measured speeds: interpolate the model's band to them
    if inside.sum() < limits.MIN_SPEEDS_OF_BAND.value:
        within = (measured > log_speed[0] - 0.01) & (measured < log_speed[-1] + 0.01)
        at = np.clip(measured[within], log_speed[0], log_speed[-1])
        below = np.clip(np.searchsorted(log_speed, at) - 1, 0, log_speed.size - 2)
        share = (at - log_speed[below]) / (log_speed[below + 1] - log_speed[below])
        change = (1 - share) * change[..., below] + share * change[..., below + 1]
    else:
        at, change = log_speed[inside], change[..., inside]
    if not at.size:
        raise AnalysisError("the model's uncertainty is not known at any of the measured speeds")
    count = np.full(at.size, number)
    _, slopes = model.predicted(theta, Points(at, count, count, count, count))
    backwards = np.linalg.pinv(slopes[:, columns])
    return {
        name: ends[np.isfinite(ends).all(axis=1)] @ backwards.T
        for name, ends in zip(chosen, change, strict=True)
        if np.isfinite(ends).all(axis=1).any()
    }
