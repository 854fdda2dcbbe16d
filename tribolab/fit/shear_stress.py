"""Shear stress in the real contact area, from a measured and a computed Stribeck curve."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from scipy import special
from scipy.optimize import least_squares

from tribolab.contact.geometry import Contact
from tribolab.core.errors import AnalysisError
from tribolab.fit.fit_settings import FitSettings, merge_old_settings
from tribolab.fit.fitted_points import over_speed, points, regression, runs_p_value, valid_range
from tribolab.fit.input_error import moved_friction
from tribolab.fit.point_covariance import PointErrors, shared_errors
from tribolab.fit.residual_error import residual_error
from tribolab.fit.shear_stress_fit import ShearStressFit
from tribolab.lubrication.parameters import (
    Interface,
    Liquid,
    Solver,
    parameters_of,
    renamed,
    warn_of_old,
)
from tribolab.lubrication.solved_curve import solve_curve
from tribolab.lubrication.stribeck import with_shear_stress
from tribolab.units.conversion import positive
from tribolab.units.stamping import stamp

_MIN_CONTACT_AREA = 1e-19  # contact area [m2] below which the bodies do not touch
_LN_STEP = 1e-2  # step of ln(viscosity) and ln(modulus), for derivatives
_Computed = Callable[
    [np.ndarray], xr.Dataset
]  # computes a curve from the logarithms of the free parameters


@renamed(viscosity="liquid")
def fit_shear_stress(
    measured: xr.Dataset,
    contact: Contact,
    psd: xr.Dataset,
    liquid: Liquid | str | float,
    load: str | float,
    interface: Interface | None = None,
    solver: Solver | None = None,
    settings: FitSettings | None = None,
    **options: Any,
) -> ShearStressFit:
    """Fit the shear stress sigma_f in the real contact area to a measured Stribeck curve.

    Parameters
    ----------
    measured
        ``friction_coefficient`` (sliding_speed) with ``_sem`` or else ``_std``. Points that are not
        finite, or at speed 0, are left out. The segments of one run, as `friction_coefficient`
        returns them, are combined by `measured_stribeck_curve` first. Parts of the uncertainty that
        the points share (``uncertainty_part``, from `tribolab.metrology.uncertainty_budget`) are
        treated as shared.
    contact, psd, liquid, load, interface, solver
        As for `stribeck_curve`, with one load; the shear stress of the interface is ignored.
    settings
        `FitSettings`; None fits only sigma_f to all points.
    **options
        Single fields of `Liquid`, `Interface`, `Solver` and `FitSettings`: arguments of the last
        release.

    Returns
    -------
    ShearStressFit

    Raises
    ------
    AnalysisError
        If there are too few points, an error bar is negative, or the surfaces do not touch.

    Notes ----- Since ``mu = mu_fluid + sigma_f a`` with a = int (A/A0) dx/(F_N/L), sigma_f is a
    weighted linear regression: ``sum w a (mu - mu_fluid) / sum w a^2``, ``error = 1/sqrt(sum w
    a^2)`` with w the points' 1/error^2. A point whose error is unknown or 0 gets the median of the
    others; if none is known, weights are equal, the error comes from the scatter, and chi-square
    contains no information. An error common to all points does not average out. It does not change
    the estimate; its contribution to the error of sigma_f, ``common_error`` times the response of
    the regression to ``mu``, is added. Errors shared through calibration, abscissa, and load,
    radius and modulus of the model are in the covariance of the points, ``C = diag(e^2) + sum c c^T
    u^2`` with ``c = d mu/d ln(viscosity v)`` for the abscissa (`PointErrors`). The square root of
    its diagonal is ``friction_coefficient_residual_u`` of the curve; regression, chi-square and the
    error of sigma_f are those of generalised least squares. The errors of neighbouring speeds may
    be correlated, because a run's level drifts: the correlation is estimated from the residuals and
    increases the error bar (`residual_error`). The runs test is that of Wald and Wolfowitz [1]_,
    exact and one-sided; the ratio is Birge's [2]_.

    References
    ----------
    .. [1] A. Wald, J. Wolfowitz, Ann. Math. Stat. 11, 147 (1940). doi:10.1214/aoms/1177731909
    .. [2] R. T. Birge, Phys. Rev. 40, 207 (1932). doi:10.1103/PhysRev.40.207

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> q, c = np.array([423.0, 9e4, 3e9]), [1.63e-22, 1.63e-22, 4e-42]
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, coords={"wavenumber": q})
    >>> from tribolab.contact.geometry import LineContact
    >>> from tribolab.lubrication.stribeck import stribeck_curve
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> speed = np.geomspace(1e-6, 1e-2, 5)
    >>> curve = stribeck_curve(contact, psd, 1.4, 310.0, "0.84 MPa", speed)
    >>> measured = curve[["friction_coefficient"]]
    >>> measured["friction_coefficient_sem"] = 0.01 + 0 * measured.friction_coefficient
    >>> fit = fit_shear_stress(measured, contact, psd, "1.4 Pa s", "310 N/m")
    >>> f"{fit.shear_stress / 1e6:.3f} MPa"
    '0.840 MPa'
    """
    settings, model = merge_old_settings(settings, options)
    warn_of_old("fit_shear_stress", model)
    free, curve, inputs = settings.free, settings.curve, settings.inputs
    method = {"method": "auto"} if contact.is_round and solver is None else {}
    base = parameters_of(liquid, interface or 0.0, solver, **{**method, **model, "shear_stress": 0})
    eta, force = base.liquid.viscosity, positive(load, contact.load_unit, "load")
    measured = over_speed(measured)
    speed, mu, error, used, source = points(measured, settings.speed_range, 2 + len(free))
    shared = shared_errors(measured, speed) if source != "scatter" else np.zeros((0, speed.size))
    errors = PointErrors(error, shared)

    def computed(extra: np.ndarray) -> xr.Dataset:
        if curve is not None and not free:
            return curve.sel(sliding_speed=speed)
        given = dict(zip(free, np.exp(extra), strict=True))
        body = replace(contact, youngs_modulus=given.get("youngs_modulus", contact.youngs_modulus))
        parameters = parameters_of(*base, viscosity=given.get("viscosity", eta))
        return solve_curve(body, psd, force, speed, parameters).curve

    start = np.log([{"viscosity": eta, "youngs_modulus": contact.youngs_modulus}[n] for n in free])
    model_curve, best = computed(start), start
    least = _MIN_CONTACT_AREA / contact.force(force)
    if not np.any(_parts(model_curve)[1][used] > least):
        raise AnalysisError(
            "at none of these speeds do the bodies touch; take lower speeds",
            function="fit_shear_stress",
        )
    if free:
        best = _fit_free(computed, start, mu[used], errors.at(used), used)
        model_curve = computed(best)
    fluid, area = _parts(model_curve)
    area = np.where(area > least, area, 0.0)
    stress = regression(mu[used], fluid[used], area[used], errors.at(used))
    dense = model_curve if curve is None or free else curve
    moved = _model_errors(dense, stress, speed, settings.abscissa_error, inputs, free)
    if moved.size:
        errors = errors.with_part(moved)
        if free:  # refit with the full covariance
            best = _fit_free(computed, best, mu[used], errors.at(used), used)
            model_curve = computed(best)
            fluid, area = _parts(model_curve)
            area = np.where(area > least, area, 0.0)
        stress = regression(mu[used], fluid[used], area[used], errors.at(used))
    residual = mu - fluid - stress * area
    freedom = int(used.sum()) - 1 - len(free)
    if source == "scatter":
        own = np.full_like(error, np.sqrt(np.sum(residual[used] ** 2) / freedom))
        errors = errors._replace(own=own)
    known = errors.at(used)
    off = known.whitened(residual[used])
    chi_square = float(off @ off)
    birge = float(np.sqrt(chi_square / freedom))
    jacobian = known.whitened(_jacobian(computed, best, stress, area, used))
    covariance = _covariance(jacobian, np.exp(best))
    level = known.whitened((fluid + stress * area)[used])
    common = abs(float(settings.common_error) * float((np.linalg.pinv(jacobian) @ level)[0]))
    spread = float(np.sqrt(covariance[0, 0]))
    scatter = residual_error(
        off,
        jacobian,
        np.ones(off.size),
        np.log(speed[used]),
        known=source != "scatter",
    )
    model_curve = with_shear_stress(model_curve, stress).assign(
        friction_coefficient_residual=("sliding_speed", residual),
        friction_coefficient_residual_u=("sliding_speed", np.sqrt(np.diag(errors.covariance))),
        used=("sliding_speed", used.astype(int)),
    )
    return ShearStressFit(
        shear_stress=stress,
        shear_stress_error=spread,
        shear_stress_error_inflated=max(spread, scatter.error),
        scatter_half_interval=scatter.half_interval,
        residual_correlation=scatter.correlation,
        chi_square=chi_square,
        degrees_of_freedom=freedom,
        chi_square_p_value=float(special.chdtrc(freedom, chi_square)),
        birge_ratio=birge,
        runs_p_value=runs_p_value(residual[used]),
        common_error=common,
        common_freedom=float(settings.common_freedom),
        valid_speed_range=valid_range(speed[used], mu[used], fluid[used], area[used], known),
        area_enhancement=float(settings.area_enhancement),
        area_enhancement_error=float(settings.area_enhancement_error),
        error_from=source,
        spectrum_error=settings.spectrum_error,
        spectrum_scanned="psd_2d_low" in (psd if psd is not None else ()),
        curve=stamp(model_curve),
        parameters={"shear_stress": stress, **dict(zip(free, np.exp(best).tolist(), strict=True))},
        covariance=covariance,
    )


def _parts(curve: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return fluid friction, and solid friction per shear stress [1/Pa], of a computed curve."""
    return curve["friction_coefficient"].values, curve["friction_per_shear_stress"].values


def _slope(curve: xr.Dataset, stress: float, speed: np.ndarray) -> np.ndarray:
    """Return d mu/d ln v of the computed curve at speeds, which equals d mu/d ln(viscosity)."""
    fluid, area = _parts(curve)
    log_speed = np.log(curve["sliding_speed"].values)
    slope = np.gradient(fluid + stress * area, log_speed)
    return np.interp(np.log(speed), log_speed, slope)


def _model_errors(
    curve: xr.Dataset,
    stress: float,
    speed: np.ndarray,
    abscissa_error: float,
    inputs: xr.Dataset | None,
    free: Sequence[str],
) -> np.ndarray:
    """Return the changes of friction due to uncertain model inputs (part, speed)."""
    rows = np.zeros((0, speed.size))
    if abscissa_error > 0 and "viscosity" not in free:
        rows = np.vstack([rows, abscissa_error * _slope(curve, stress, speed)])
    if inputs is not None:
        fixed = ~np.isin(inputs["model_input"].values, list(free))
        rows = np.vstack([rows, moved_friction(inputs.isel(model_input=fixed), stress, speed)])
    return rows


def _fit_free(
    computed: _Computed, start: np.ndarray, mu: np.ndarray, errors: PointErrors, used: np.ndarray
) -> np.ndarray:
    """Return the logarithms of the free parameters by least squares; sigma_f follows from them."""

    def residual(extra: np.ndarray) -> np.ndarray:
        fluid, area = (part[used] for part in _parts(computed(extra)))
        return errors.whitened(mu - fluid - regression(mu, fluid, area, errors) * area)

    steps = np.full(start.size, _LN_STEP)
    fit = least_squares(residual, start, diff_step=steps, x_scale=1.0, xtol=1e-6, ftol=1e-8)
    if not fit.success:
        raise AnalysisError(
            f"no least squares ({fit.message}); free fewer", function="fit_shear_stress"
        )
    return fit.x


def _jacobian(
    computed: _Computed, best: np.ndarray, stress: float, area: np.ndarray, used: np.ndarray
) -> np.ndarray:
    """Return the derivatives of mu with respect to sigma_f and ln(each free parameter)."""
    columns = [area[used]]
    for step in _LN_STEP * np.eye(best.size):
        above, below = (
            fluid + stress * per_stress
            for fluid, per_stress in (_parts(computed(best + s)) for s in (step, -step))
        )
        columns.append((above - below)[used] / (2 * _LN_STEP))
    return np.stack(columns, axis=1)


def _covariance(weighted: np.ndarray, extra: np.ndarray) -> np.ndarray:
    """Return the covariance of sigma_f and the free parameters in SI, from weighted derivatives."""
    size = np.linalg.norm(weighted, axis=0)
    inverse = np.linalg.pinv(weighted / size)
    scale = np.append(1.0, extra) / size
    return inverse @ inverse.T * np.outer(scale, scale)
