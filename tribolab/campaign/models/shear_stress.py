"""Fit of the shear stress to one measured curve, for the data file of its model."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.campaign.models.plan import PlannedModel
from tribolab.campaign.store.data_files import optional_data
from tribolab.contact.geometry import Contact
from tribolab.contact.hertz import hertz_half_width
from tribolab.core.coverage import NORMAL
from tribolab.fit.fit_settings import FitSettings
from tribolab.fit.shear_stress import fit_shear_stress
from tribolab.fit.shear_stress_fit import ShearStressFit
from tribolab.lubrication.stribeck import with_shear_stress
from tribolab.units.stamping import stamp


def fit_model(
    model: PlannedModel,
    measured: xr.Dataset,
    contact: Contact,
    psd: xr.Dataset,
    load: float,
    computed: xr.Dataset,
    enhancement: tuple[float, float, float],
    inputs: xr.Dataset | None,
) -> ShearStressFit:
    """Return the shear stress fitted to a measured curve, with the given area enhancement."""
    best, low, high = enhancement
    runs = float(np.median(measured["runs"].values))
    settings = FitSettings(
        speed_range=model.settings["fit_speeds"],
        area_enhancement=best,
        # the bounds may be asymmetric: the larger distance counts as the 95 % error
        area_enhancement_error=max(best - low, high - best) / NORMAL,
        common_error=model.repeatability / np.sqrt(runs),
        common_freedom=model.freedom,
        curve=computed,
        abscissa_error=model.abscissa_error,
        inputs=inputs,
    )
    return fit_shear_stress(measured, contact, psd, model.viscosity, load, settings=settings)


def with_other_area(computed: xr.Dataset) -> xr.Dataset:
    """Return a computed curve, or its sensitivities, with the contact area of the other theory."""
    names = ("friction_per_shear_stress", "solid_part")
    return computed.assign({n: computed[f"{n}_other"] for n in names if n in computed})


def area_enhancement(model: PlannedModel, folder: Path) -> tuple[float, float, float]:
    """Return the ratio of the area with adhesion to that of the model, and its bounds."""
    path = folder / model.surface_file
    adhesion = optional_data(path, "adhesion_loads")
    if adhesion is None or model.curve.medium not in adhesion.medium.values:
        return 1.0, 1.0, 1.0
    at = int(np.argmin(np.abs(adhesion["normal_force"].values.ravel() - model.normal_force)))
    mine = adhesion.sel(medium=model.curve.medium).isel(load=at)
    best, low, high = (float(mine[f"area_enhancement{end}"]) for end in ("", "_low", "_high"))
    if model.work_of_adhesion is not None:
        return 1.0, low / best, high / best
    return best, low, high


def model_and_points(fit: ShearStressFit, measured: xr.Dataset) -> xr.Dataset:
    """Return model and points at the measured speeds, with the fit in the attributes.

    If the fitted shear stress is negative, the model is that with zero shear stress.
    """
    curve = fit.curve
    if fit.shear_stress < 0:
        curve = with_shear_stress(curve, -fit.shear_stress)
        curve["friction_coefficient_solid"] = 0.0 * curve["friction_coefficient"]
    points = measured.sel(sliding_speed=curve["sliding_speed"])
    low, high = fit.valid_speed_range
    data = curve.rename(friction_coefficient="friction_coefficient_model").assign(
        {
            f"friction_coefficient{end}": points[f"friction_coefficient{end}"]
            for end in ("", "_std", "_sem", "_u", "_dof", "_U95")
            if f"friction_coefficient{end}" in points
        }
    )
    data["friction_coefficient_residual"] = (
        data["friction_coefficient"] - data["friction_coefficient_model"]
    )
    return stamp(
        data,
        shear_stress_Pa=fit.shear_stress,
        shear_stress_error_Pa=fit.shear_stress_error,
        shear_stress_error_inflated_Pa=fit.shear_stress_error_inflated,
        shear_stress_common_error_Pa=fit.common_error,
        shear_stress_total_error_Pa=fit.total_error,
        shear_stress_statistical_half_interval_Pa=fit.statistical_half_interval,
        residual_correlation=fit.residual_correlation,
        interval_says=fit.interval_says,
        chi_square=fit.chi_square,
        degrees_of_freedom=fit.degrees_of_freedom,
        chi_square_p_value=fit.chi_square_p_value,
        birge_ratio=fit.birge_ratio,
        runs_p_value=fit.runs_p_value,
        valid_speed_low_m_s=low,
        valid_speed_high_m_s=high,
        area_enhancement=fit.area_enhancement,
        area_enhancement_error=fit.area_enhancement_error,
        corrected_shear_stress_Pa=fit.corrected_shear_stress,
        corrected_shear_stress_error_Pa=float(fit.corrected_shear_stress_error),
        error_from=fit.error_from,
    )


def areas(
    measured_area: float | None,
    contact: Contact,
    load: float,
    curve: xr.Dataset,
    measured: xr.Dataset,
) -> dict[str, float]:
    """Return measured and computed areas [m2], and F/A [Pa], at the lowest fitted speed."""
    a = float(hertz_half_width(load, contact))
    nominal = float(np.pi * a**2 if contact.is_round else 2 * a * contact.force(1.0))
    slowest = curve.isel(sliding_speed=0)
    mu = float(measured["friction_coefficient"].sel(sliding_speed=slowest["sliding_speed"]))
    area = np.nan if measured_area is None else measured_area
    return {
        "measured_area_m2": area,
        "hertz_area_m2": nominal,
        "real_area_m2": float(slowest["contact_area_ratio"]) * nominal,
        "measured_shear_stress_Pa": mu * contact.force(load) / area,
    }
