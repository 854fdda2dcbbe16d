"""What an uncertain spectrum does to the parameters of a joint fit, at all loads alike."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from tribolab.errors import AnalysisError
from tribolab.fit.joint.model import JointModel, Points, shared_errors
from tribolab.fit.joint.posterior import Posterior
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.spectrum_error import SPECTRUM

_NORMAL = 1.959963984540054
_FEWEST = 4


def spectrum_covariance(
    model: JointModel,
    posterior: Posterior,
    priors: JointPriors,
    uncertainty: Mapping[int, xr.Dataset],
) -> np.ndarray:
    """Return what uncertain spectra add to the covariance of the parameters.

    Parameters
    ----------
    model, posterior, priors
        Of the fit with the spectra as they are.
    uncertainty
        From `model_uncertainty` at one load, for each surface's number.

    Returns
    -------
    numpy.ndarray
        Covariance (parameter, parameter).

    Raises
    ------
    AnalysisError
        If the band is of another load than those fitted, or of too few speeds.

    Notes
    -----
    A rougher surface touches in fewer places and parts from the flat at higher speed: it is as if
    the shear stress were lower and the liquid thinner, at all loads alike. Each end of a variation
    of the spectrum is therefore told by a shear stress, an exponent of speed and a viscosity:
    ln(mu varied/mu) over the measured speeds, at the load for which it was computed, is projected
    on their derivatives. What these do at all loads to the fit is ``Sigma J' V^-1 delta``. The
    ends are some 95 %, the variations independent of each other.
    """
    weights = posterior.weight
    tau, kappa = weights @ posterior.level, weights @ posterior.correlated
    points, where = model.points, model.parameters
    shared = shared_errors(points, points, priors.correlation_length)
    whole = np.diag(points.error**2) + tau**2 * shared.level + kappa**2 * shared.near
    _, slopes = model.predicted(posterior.centre)
    free = where.spread > 0
    weighed = np.linalg.solve(whole, slopes[:, free]).T
    normal = weighed @ slopes[:, free] + np.diag(where.spread[free] ** -2.0)
    answer = np.zeros(slopes.T.shape)  # of the parameters to changed points
    answer[free] = np.linalg.solve(normal, weighed)
    added = np.zeros((free.size, free.size))
    for surface, band in uncertainty.items():
        columns = [where.stress[surface], where.speed[surface], where.viscosity]
        columns = [column for column in columns if where.spread[column] > 0]
        of_surface = np.array([model.curves[k].surface == surface for k in points.curve])
        wet = np.array([not model.curves[k].dry for k in points.curve])
        for ends in _told(model, posterior.centre, surface, columns, band):
            moved = ends @ (slopes[:, columns] * (of_surface & wet)[:, None]).T @ answer.T
            added += moved.T @ moved / len(ends) / _NORMAL**2
    return added


def _told(
    model: JointModel,
    theta: np.ndarray,
    surface: int,
    columns: list[int],
    band: xr.Dataset,
) -> list[np.ndarray]:
    """Return for each variation of the spectrum what its ends are told by (end, parameter)."""
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
    inside = (log_speed > measured.min() - 0.01) & (log_speed < measured.max() + 0.01)
    if inside.sum() < _FEWEST:
        raise AnalysisError(
            f"the model's uncertainty is known at {inside.sum()} of the measured speeds' range; "
            f"at least {_FEWEST} are wanted"
        )
    count = np.full(inside.sum(), number)
    _, slopes = model.predicted(theta, Points(log_speed[inside], count, count, count, count))
    chosen = [name for name in band["variation"].values.tolist() if name in SPECTRUM]
    ends_of = band["friction_coefficient_varied"].sel(variation=chosen)
    varied = ends_of.transpose("variation", "range_end", "sliding_speed").values[..., inside]
    change = np.log(varied / band["friction_coefficient"].values[inside])
    backwards = np.linalg.pinv(slopes[:, columns])
    return [
        ends[np.isfinite(ends).all(axis=1)] @ backwards.T
        for ends in change
        if np.isfinite(ends).all(axis=1).any()
    ]
