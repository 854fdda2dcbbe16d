"""Whether a model is sufficient for a measured curve: a test with the errors of both."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy import special

from tribolab.fit.point_covariance import PointErrors, shared_errors

SUFFICIENT = 0.10  # rms misfit over the largest friction below which a model is sufficient
_CHANCE = 0.05  # probability under which a misfit is no chance
_FITTED = 1  # the shear stress


def misfit_numbers(measured: xr.Dataset, model: xr.Dataset, off: np.ndarray) -> dict[str, float]:
    """Return how far a model misses a measured curve, and what the errors say of it.

    Parameters
    ----------
    measured
        Measured curve (sliding_speed); of its errors ``_sem`` and ``uncertainty_part`` count.
    model
        Computed curve (sliding_speed); its attribute ``abscissa_error`` is the relative standard
        uncertainty of viscosity times speed, its ``model_part`` (model_input, sliding_speed) what
        the errors of load, radius and modulus make of it.
    off
        Computed less measured (sliding_speed); NaN where the model was not computed.

    Returns
    -------
    dict
        ``model_misfit``: root of the mean square over the largest friction [1];
        ``model_misfit_p_value``: probability that errors alone make the points miss so far, by the
        chi-square of their full covariance; ``model_misfit_resolved``: what the errors make of such
        a misfit [1]. NaN where they are not known.
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
    place = np.log(model["sliding_speed"].values)
    moved = list(model["model_part"].values) if "model_part" in model else []
    if (relative := float(model.attrs.get("abscissa_error", 0.0))) > 0:
        moved.append(relative * np.gradient(model["friction_coefficient"].values, place))
    for part in moved:
        errors = errors.with_part(np.interp(np.log(speed), place, part))
    errors = errors.at(fine)
    white = errors.whitened(off[fine])
    freedom = int(fine.sum()) - _FITTED
    numbers["model_misfit_p_value"] = float(special.chdtrc(freedom, white @ white))
    spread = np.sqrt(np.mean(np.diag(errors.covariance)))
    numbers["model_misfit_resolved"] = float(spread / highest)
    return numbers


def is_sufficient(numbers: dict[str, float]) -> bool | None:
    """Return whether a model is sufficient; None where the errors are too large to tell.

    A misfit that errors alone would make is none, if the errors would have shown one of a tenth
    of the largest friction; one that they would not make counts from that tenth on.

    Examples
    --------
    >>> def found(off, chance, errors):
    ...     return {"model_misfit": off, "model_misfit_p_value": chance,
    ...             "model_misfit_resolved": errors}
    >>> is_sufficient(found(0.02, 0.4, 0.02)), is_sufficient(found(0.05, 1e-9, 0.001))
    (True, True)
    >>> is_sufficient(found(0.2, 1e-9, 0.01)), is_sufficient(found(0.2, 0.3, 0.2))
    (False, None)
    """
    off, chance = numbers["model_misfit"], numbers.get("model_misfit_p_value", float("nan"))
    if np.isnan(chance) or chance < _CHANCE:
        return bool(off < SUFFICIENT)
    return True if numbers["model_misfit_resolved"] < SUFFICIENT else None
