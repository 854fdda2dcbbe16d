"""Goodness of fit of a model to a measured curve, allowing for the errors of both."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy import special

from tribolab.fit.point_covariance import PointErrors, shared_errors

SUFFICIENT = 0.10  # rms misfit relative to maximum friction, below which a model is sufficient
_CHANCE = 0.05  # p value below which a misfit is significant
_FITTED = 1  # number of fitted parameters, the shear stress


def misfit_numbers(measured: xr.Dataset, model: xr.Dataset, off: np.ndarray) -> dict[str, float]:
    """Return the misfit of a model to a measured curve, its p value, and the bound of its error.

    Parameters
    ----------
    measured
        Measured curve (sliding_speed), with the errors ``_sem`` and ``uncertainty_part``.
    model
        Computed curve (sliding_speed); its attribute ``abscissa_error`` is the relative standard
        uncertainty of viscosity times speed, its ``model_part`` (model_input, sliding_speed) the
        effect of the errors of load, radius and modulus.
    off
        Computed minus measured (sliding_speed); NaN if the model was not computed.

    Returns
    -------
    dict
        ``model_misfit``: rms relative to the largest friction [1]; ``model_misfit_p_value``:
        probability of such a misfit by errors alone, by the chi-square of their full covariance;
        ``model_misfit_resolved``: 95 % bound of the change of the misfit by errors [1]. NaN if
        unknown.

    Notes
    -----
    With the true misfit d and errors e of covariance C, the rms of d + e differs from that of d by
    at most the rms of e. The sum of squares of e is approximated by a multiple of chi-square with
    its mean tr C and variance 2 tr C^2 [1]_. The direction of the fitted shear stress, c = friction
    per shear stress, is removed from C: C - c c^T/(c^T C^-1 c).

    References
    ----------
    .. [1] F. E. Satterthwaite, Biometrics Bull. 2, 110 (1946). doi:10.2307/3002019
    """
    nan = float("nan")
    mu, fine = measured["friction_coefficient"].values, np.isfinite(off)
    numbers = {"model_misfit": nan, "model_misfit_p_value": nan, "model_misfit_resolved": nan}
    if not fine.any():
        return numbers
    highest = np.nanmax(mu)
    numbers["model_misfit"] = float(np.sqrt(np.mean(off[fine] ** 2)) / highest)
    own = measured.get("friction_coefficient_sem")
    if own is None or not (own.values[fine] > 0).all() or fine.sum() <= _FITTED:
        return numbers
    speed = measured["sliding_speed"].values
    errors = PointErrors(own.values.astype(float), shared_errors(measured, speed))
    log_speed = np.log(model["sliding_speed"].values)
    moved = list(model["model_part"].values) if "model_part" in model else []
    if (relative := float(model.attrs.get("abscissa_error", 0.0))) > 0:
        moved.append(relative * np.gradient(model["friction_coefficient"].values, log_speed))
    for part in moved:
        errors = errors.with_part(np.interp(np.log(speed), log_speed, part))
    errors = errors.at(fine)
    white = errors.whitened(off[fine])
    freedom = int(fine.sum()) - _FITTED
    numbers["model_misfit_p_value"] = float(special.chdtrc(freedom, white @ white))
    if "friction_per_shear_stress" in model:
        solid = model["friction_per_shear_stress"].values
        solid = np.interp(np.log(speed), log_speed, solid)[fine]
    else:
        solid = np.zeros(fine.sum())
    numbers["model_misfit_resolved"] = _error_bound(errors, solid) / float(highest)
    return numbers


def _error_bound(errors: PointErrors, solid: np.ndarray) -> float:
    """Return the 95 % upper bound of the rms error that remains after fitting the shear stress."""
    covariance = errors.covariance
    if np.any(solid > 0):
        taken = errors.whitened(solid)
        covariance = covariance - np.outer(solid, solid) / float(taken @ taken)
    mean, square = float(np.trace(covariance)), float(np.sum(covariance**2))
    if not mean > 0:
        return 0.0
    scale, freedom = square / mean, mean**2 / square
    most = scale * float(special.chdtri(freedom, _CHANCE))
    return float(np.sqrt(most / solid.size))


def is_sufficient(numbers: dict[str, float]) -> bool | None:
    """Return whether the model is sufficient; None if the errors are too large to decide.

    A model is sufficient if its misfit plus the errors is below a tenth of the largest friction, or
    if the errors explain the misfit and could have revealed one of a tenth. It is not sufficient if
    the misfit is significant and exceeds a tenth after subtraction of the errors.

    Examples
    --------
    >>> def found(off, chance, errors):
    ...     return {"model_misfit": off, "model_misfit_p_value": chance,
    ...             "model_misfit_resolved": errors}
    >>> is_sufficient(found(0.02, 0.4, 0.02)), is_sufficient(found(0.05, 1e-9, 0.001))
    (True, True)
    >>> is_sufficient(found(0.2, 1e-9, 0.01)), is_sufficient(found(0.2, 0.3, 0.2))
    (False, None)
    >>> is_sufficient(found(0.09, 1e-3, 0.03)), is_sufficient(found(0.11, 1e-3, 0.03))
    (None, None)
    """
    off, chance = numbers["model_misfit"], numbers.get("model_misfit_p_value", float("nan"))
    if np.isnan(chance):
        return bool(off < SUFFICIENT)
    moved = numbers["model_misfit_resolved"]
    if off + moved < SUFFICIENT or (chance >= _CHANCE and moved < SUFFICIENT):
        return True
    return False if chance < _CHANCE and off - moved > SUFFICIENT else None
