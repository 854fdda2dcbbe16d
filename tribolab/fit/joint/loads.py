"""Joint fit of computed responses to the friction curves measured at several loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError
from tribolab.fit.joint.common_errors import calibration_covariance, model_covariance
from tribolab.fit.joint.load_curve import LoadCurve, MeasuredPoints, points_of
from tribolab.fit.joint.model import (
    REFERENCE_SPEED,
    Curve,
    JointModel,
    Parameters,
    Points,
    parameters_of,
    shared_by_points,
)
from tribolab.fit.joint.posterior import Posterior, mixture_quantile, posterior_of
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.result import JointFit, Marginal
from tribolab.units.stamping import stamp

_INTERVAL_ENDS = 0.025, 0.975
_RAYLEIGH_QUANTILES = 0.22502413, 2.71620258  # 2.5 % and 97.5 % quantiles for a scale of 1
_ROUNDING_OF_INTERVAL = 1e-9  # share of its interval below which a value is a rounding error
_DRAWN_SPEEDS = 61  # number of speeds in a plotted curve


def fit_loads(
    curves: Sequence[LoadCurve],
    viscosity: float,
    priors: JointPriors | None = None,
    *,
    common_error: float = 0.0,
    speed_error: float = 0.0,
    spectrum_error: Mapping[str, xr.Dataset] | None = None,
    area_ratio_error: float | Mapping[str, float] = 0.0,
    speed_range: tuple[float, float] = (0.0, np.inf),
) -> JointFit:
    """Fit shear stress, its exponents and viscosity to the curves of all loads together.

    Parameters
    ----------
    curves
        Curves measured in one liquid and, if available, dry, for one or several surfaces.
    viscosity
        Stated viscosity of the liquid [Pa s].
    priors
        Default: `JointPriors`.
    common_error
        Relative standard error [1] of the shear stress common to all loads.
    speed_error
        Relative standard error [1] of the sliding speeds common to all points.
    spectrum_error
        By surface, from `model_uncertainty` at one of the loads: effects of the uncertain spectrum,
        and of load, radius and modulus if varied.
    area_ratio_error
        Standard error of ln(dry/wet contact area) for the dry curves; one for all, or by surface.
    speed_range
        Lowest and highest speed [m/s] to use.

    Returns
    -------
    JointFit

    Raises
    ------
    AnalysisError
        If there is no wet curve, or too few points.
    """
    priors = priors or JointPriors()
    wet = [curve for curve in curves if not curve.dry]
    if not wet:
        raise AnalysisError("no curve was measured in the liquid")
    surfaces = list(dict.fromkeys(curve.surface for curve in curves))
    measured = points_of(curves, speed_range)
    reference = float(np.exp(np.mean(np.log(np.unique([curve.load for curve in wet])))))
    computed = [
        Curve(
            curve.response,
            surfaces.index(curve.surface),
            float(np.log(curve.load / reference)),
            curve.dry,
        )
        for curve in curves
    ]
    measured_dry = {curve.surface for curve in curves if curve.dry}
    errors = (
        area_ratio_error
        if isinstance(area_ratio_error, Mapping)
        else dict.fromkeys(surfaces, area_ratio_error)
    )
    transfer = [  # 0 fixes the dry shear stress of a surface without dry curves
        float(np.hypot(priors.dry_over_wet, errors.get(surface, 0.0)))
        if surface in measured_dry
        else 0.0
        for surface in surfaces
    ]
    parameters = parameters_of(len(surfaces), viscosity, priors, transfer if measured_dry else ())
    model = JointModel(measured.points, computed, parameters, reference)
    posterior = posterior_of(model, priors, parameters.mean)
    alone = _left_out(model, priors, posterior, curves)
    shared = parameters.stress
    posterior.covariance[:, shared, shared] += common_error**2
    added = calibration_covariance(model, posterior, priors, curves, speed_error)
    posterior = posterior._replace(covariance=posterior.covariance + added)
    if spectrum_error:
        bands = {surfaces.index(surface): band for surface, band in spectrum_error.items()}
        added = model_covariance(model, posterior, priors, bands)
        posterior = posterior._replace(covariance=posterior.covariance + added)
    names = surfaces if len(surfaces) > 1 else [""]
    return JointFit(
        marginals=tuple(_marginals(parameters, posterior, priors, names)),
        correlation=_correlation(posterior.spread),
        reference_speed=REFERENCE_SPEED,
        reference_load=reference,
        log_evidence=posterior.log_evidence,
        left_out=alone,
        points=_points(model, posterior, priors, curves, measured),
        curves=_bands(model, posterior, curves),
        common_error=common_error,
        spectrum_error=tuple(spectrum_error or ()),
        skipped=measured.left_out,
    )


def _left_out(
    model: JointModel, priors: JointPriors, posterior: Posterior, curves: Sequence[LoadCurve]
) -> dict[str, float]:
    """Return, for each lubricated curve, ln p(points of the curve | all other points)."""
    if np.unique(model.points.curve).size < 2:
        return {}
    rest = {}
    for number, curve in enumerate(curves):
        if not curve.dry:
            others = posterior_of(model.without(np.array([number])), priors, posterior.centre)
            rest[curve.name] = posterior.log_evidence - others.log_evidence
    return rest


def _marginals(
    parameters: Parameters, posterior: Posterior, priors: JointPriors, surfaces: Sequence[str]
) -> list[Marginal]:
    """Return median, interval and prior of every parameter; logarithms are converted back."""
    middle, low, high = (posterior.quantile(p) for p in (0.5, *_INTERVAL_ENDS))
    spread = np.sqrt(np.diag(posterior.spread))
    reach = NORMAL * parameters.spread
    marginals = []
    everything = np.array([middle, low, high, parameters.mean - reach, parameters.mean + reach])
    for index, (name, surface, logarithmic) in enumerate(_names_of(parameters, surfaces)):
        values = everything[:, index]
        if logarithmic:
            values = np.exp(values)
        before = parameters.spread[index]
        reduction = max(0.0, 1 - float(spread[index] / before)) if before else np.nan
        value, *ends = map(float, values)
        if abs(value) < _ROUNDING_OF_INTERVAL * (ends[1] - ends[0]):
            value = 0.0  # a rounding error
        marginals.append(
            Marginal(name, surface, value, ends[0], ends[1], ends[2], ends[3], reduction)
        )
    for name, scale in (("level", priors.level), ("correlated", priors.correlated)):
        value, first, last = (posterior.shared_quantile(name, p) for p in (0.5, *_INTERVAL_ENDS))
        least, most = (scale * quantile for quantile in _RAYLEIGH_QUANTILES)
        reduction = max(0.0, 1 - (last - first) / (most - least))
        marginals.append(Marginal(name, "", value, first, last, least, most, reduction))
    return marginals


def _names_of(parameters: Parameters, surfaces: Sequence[str]) -> list[tuple[str, str, bool]]:
    """Return name and surface of each fitted parameter, and whether it is a logarithm."""
    names = [("", "", False)] * parameters.mean.size
    for indices, name, logarithmic in (
        (parameters.stress, "shear_stress", True),
        (parameters.speed, "speed_exponent", False),
        (parameters.load, "load_exponent", False),
        (parameters.dry, "dry_over_wet", True),
    ):
        for index, surface in zip(indices, surfaces, strict=False):
            names[index] = name, surface, logarithmic
    names[parameters.viscosity] = "viscosity", "", True
    return names


def _correlation(covariance: np.ndarray) -> np.ndarray:
    size = np.sqrt(np.diag(covariance))
    fixed = size == 0
    size = np.where(fixed, 1.0, size)
    return covariance / np.outer(size, size) + np.diag(fixed.astype(float))


def _points(
    model: JointModel,
    posterior: Posterior,
    priors: JointPriors,
    curves: Sequence[LoadCurve],
    measured: MeasuredPoints,
) -> xr.Dataset:
    """Return the measured points with fitted friction, residuals and their shared part."""
    points = model.points
    shared = shared_by_points(points, points, priors.correlation_length)
    computed, ascribed = np.zeros(points.log_speed.size), np.zeros(points.log_speed.size)
    for weight, tau, kappa, theta in zip(
        posterior.weight, posterior.level, posterior.correlated, posterior.mean, strict=True
    ):
        if weight < 1e-4 * posterior.weight.max():
            continue
        value, _ = model.predicted(theta)
        together = tau**2 * shared.level + kappa**2 * shared.near
        whole = together + np.diag(points.error**2)
        computed += weight * value
        ascribed += weight * (together @ np.linalg.solve(whole, points.log_friction - value))
    total = posterior.weight[posterior.weight >= 1e-4 * posterior.weight.max()].sum()
    friction = np.exp(points.log_friction)
    columns = {
        "surface": np.array([curves[k].surface for k in points.curve], dtype=str),
        "curve": np.array([curves[k].name for k in points.curve], dtype=str),
        "run_number": measured.run,
        "sliding_speed": np.exp(points.log_speed),
        "friction_coefficient": friction,
        "friction_coefficient_sem": friction * points.error,
        "friction_coefficient_model": np.exp(computed / total),
        "relative_residual": points.log_friction - computed / total,
        "shared_residual": ascribed / total,
    }
    return stamp(xr.Dataset({name: ("point", values) for name, values in columns.items()}))


def _bands(model: JointModel, posterior: Posterior, curves: Sequence[LoadCurve]) -> xr.Dataset:
    """Return the fitted friction at speeds and loads, with 95 % bands of fit and prediction."""
    ends = model.points.log_speed.min(), model.points.log_speed.max()
    grid = np.linspace(*ends, _DRAWN_SPEEDS)
    number = np.repeat(np.arange(len(curves)), grid.size)
    at = Points(np.tile(grid, len(curves)), number, number, number, number)
    used = posterior.weight >= 1e-4 * posterior.weight.max()
    weight = posterior.weight[used] / posterior.weight[used].sum()
    rows: list[np.ndarray] = []
    variances, shared = [], []
    for k in np.flatnonzero(used):
        value, slopes = model.predicted(posterior.mean[k], at)
        rows.append(value)
        variances.append(np.einsum("pi,ij,pj->p", slopes, posterior.covariance[k], slopes))
        shared.append(posterior.level[k] ** 2 + posterior.correlated[k] ** 2)
    means, alone = np.array(rows), np.sqrt(variances)
    whole = np.sqrt(np.array(variances) + np.array(shared)[:, None])
    friction = {
        f"friction_coefficient{ending}": (
            ("curve", "sliding_speed"),
            np.exp(mixture_quantile(weight, means, deviation, probability)).reshape(
                len(curves), grid.size
            ),
        )
        for ending, deviation, probability in (
            ("", alone, 0.5),
            ("_low", alone, _INTERVAL_ENDS[0]),
            ("_high", alone, _INTERVAL_ENDS[1]),
            ("_load_low", whole, _INTERVAL_ENDS[0]),
            ("_load_high", whole, _INTERVAL_ENDS[1]),
        )
    }
    named = {
        "curve": np.array([curve.name for curve in curves], dtype=str),
        "sliding_speed": np.exp(grid),
        "load": ("curve", np.array([curve.load for curve in curves])),
        "surface": ("curve", np.array([curve.surface for curve in curves], dtype=str)),
    }
    return stamp(xr.Dataset(friction, named))
