"""Analysis of the model of one measured curve: curve, fit, profiles and uncertainty."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from tribolab.campaign.models.plan import PlannedModel
from tribolab.campaign.models.shear_stress import (
    area_enhancement,
    areas,
    fit_model,
    model_and_points,
    with_other_area,
)
from tribolab.campaign.store.data_files import optional_data, read_data
from tribolab.contact.area import alternative_area_theory
from tribolab.contact.geometry import Contact, make_contact
from tribolab.contact.hertz import hertz_half_width
from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError
from tribolab.core.untyped import Arguments
from tribolab.core.wording import explain, speed_text
from tribolab.fit.input_error import model_inputs, moved_friction
from tribolab.fit.left_out import effects_not_modelled
from tribolab.fit.model_error import model_uncertainty
from tribolab.fit.unknowns import Unknowns
from tribolab.lubrication.factors import flow_factors
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.limits import MAX_VISCOUS_HEATING
from tribolab.lubrication.parameters import Parameters, parameters_of
from tribolab.lubrication.solved_curve import solve_curve
from tribolab.lubrication.stribeck import with_shear_stress
from tribolab.lubrication.thinning import rheometer_table, viscous_heating
from tribolab.records.parts import Finding, limit_findings
from tribolab.units.stamping import stamp

if TYPE_CHECKING:
    pass

_PROFILES = 5
_A_DECADE = 2  # speeds per decade at which sensitivities are computed
_SEPARATIONS = np.geomspace(0.1, 6.0, 120)  # separation / h_rms at which the factors are shown


def analyse_model(model: PlannedModel, folder: Path) -> tuple[dict[str, xr.Dataset], list[Finding]]:
    """Return the groups of a model's data file, and the findings.

    ``curve``: the model over the campaign's speeds; ``fit``: model and points at the measured
    speeds, with the fitted shear stress as attribute; ``profiles`` and ``factors`` of the leading
    model of a surface; ``uncertainty`` if requested; ``left_out``: effects that are not in the
    model.

    Raises
    ------
    TribolabError
        If the curve cannot be computed.
    """
    measured = read_data(folder / model.curve.data_file)
    psd = read_data(folder / model.surface_file, "psd")
    contact = make_contact(**model.contact)
    load = contact.load(model.normal_force)
    settings, body = model.settings, _model_settings(model, contact, measured)
    grid = np.geomspace(settings["slowest"], settings["fastest"], settings["points"])
    points = measured["sliding_speed"].values
    speeds = np.union1d(grid, points[points > 0])
    parameters = parameters_of(model.viscosity, 0.0, **body)
    computed = solve_curve(contact, psd, load, speeds, parameters).curve
    groups = {"curve": computed.sel(sliding_speed=grid)}
    findings = _temperature(model)
    if (points > 0).any():
        findings += _heating(contact, load, computed, float(points.max()))

    def attempt(what: str, name: str, compute: Any) -> None:
        try:
            groups[name] = compute()
        except AnalysisError as error:  # recorded: the curve is kept without it
            findings.append(Finding("suspect", f"{what}: {explain(error)[0]}"))

    fit = inputs = None
    try:
        inputs = _input_sensitivities(model, points[points > 0], contact, psd, load, body)
        enhancement = area_enhancement(model, folder)
        fit = fit_model(model, measured, contact, psd, load, computed, enhancement, inputs)
    except AnalysisError as error:  # recorded, as above
        findings.append(Finding("suspect", f"shear stress: {explain(error)[0]}"))
    if fit is not None:
        # negative shear stress is unphysical: the curve is shown with zero instead
        groups["curve"] = with_shear_stress(groups["curve"], max(fit.shear_stress, 0.0))
        other, moved = with_other_area(computed), inputs and with_other_area(inputs)
        again = fit_model(model, measured, contact, psd, load, other, enhancement, moved)
        groups["fit"] = model_and_points(fit, measured).assign_attrs(
            area_enhancement_low=enhancement[1],
            area_enhancement_high=enhancement[2],
            area=model.area,
            adhesion="without" if model.work_of_adhesion is None else "with",
            other_area=alternative_area_theory(model.area),
            **areas(model.contact_area, contact, load, fit.curve, measured),
            shear_stress_other_area_Pa=again.shear_stress,
        )
    groups["curve"].attrs["abscissa_error"] = model.abscissa_error
    traction = optional_data(folder / model.curve.data_file, "traction")
    if fit is not None and traction is not None:
        stress = max(fit.shear_stress, 0.0)
        attempt(
            "traction curve",
            "traction",
            lambda: _traction(traction, contact, psd, load, parameters, stress),
        )
    if fit is not None and inputs is not None:
        groups["curve"] = _add_sensitivities(groups["curve"], inputs, max(fit.shear_stress, 0.0))
    if model.leading:
        attempt("profiles", "profiles", lambda: _profiles(points, contact, psd, load, parameters))
        attempt("factors", "factors", lambda: _factors(psd, settings["rough_body"]))
    if model.uncertain and fit is not None and fit.shear_stress > 0:
        unknowns = Unknowns(
            viscosity=model.viscosity_range,
            youngs_modulus=model.youngs_modulus_range,
            load=_range_of(load, model.input_errors.get("load", 0.0)),
            radius=_range_of(contact.radius, model.input_errors.get("radius", 0.0)),
            work_of_adhesion=model.work_of_adhesion_range,
            shear_stress_error=fit.total_error,
            outlet=not settings["outlet"],
        )
        liquid, interface, solver = parameters_of(*parameters, shear_stress=fit.shear_stress)
        attempt(
            "uncertainty of the model",
            "uncertainty",
            lambda: model_uncertainty(
                contact, psd, liquid, load, interface, solver=solver, unknowns=unknowns
            ),
        )
    found = effects_not_modelled(contact, load, model.viscosity, psd)
    groups["left_out"] = xr.Dataset(
        {
            "size": ("effect", np.array([effect.size for effect in found], dtype=str)),
            "reason": ("effect", np.array([effect.why for effect in found], dtype=str)),
        },
        {"effect": np.array([effect.name for effect in found], dtype=str)},
    )
    return groups, findings + limit_findings(groups)


def _model_settings(model: PlannedModel, contact: Contact, measured: xr.Dataset) -> Arguments:
    """Return the settings of a model besides contact, spectrum, load, viscosity and speed."""
    settings = model.settings
    body = {name: settings[name] for name in ("rough_body", "friction_factors")}
    body["inlet_length"] = _extent(model, contact)
    if settings["outlet"]:
        body["outlet"] = settings["outlet"]
    body |= {"area": model.area, "work_of_adhesion": model.work_of_adhesion}
    if (slide_roll := measured.attrs.get("slide_roll_ratio")) is not None:
        body |= {"slide_roll": abs(float(slide_roll)), "abscissa": "sliding_speed"}
    if model.flow_curve is not None:
        body["thinning"] = rheometer_table(*model.flow_curve)[1]
    if contact.is_round:
        body["method"] = "auto"
    return body


def _heating(contact: Contact, load: float, computed: xr.Dataset, fastest: float) -> list[Finding]:
    """Return a finding if viscous heating at the highest speed exceeds the limit."""
    at = computed.sel(sliding_speed=fastest)
    half_width = float(hertz_half_width(load, contact))
    across = 2 * load / (np.pi * half_width) if contact.is_round else load
    rise = viscous_heating(float(at["friction_coefficient"]), across, fastest, half_width)
    if rise <= MAX_VISCOUS_HEATING.value:
        return []
    text = (
        f"viscous heating of the liquid is about {rise:.2g} K at {speed_text(fastest)}, so its "
        "viscosity is lower than in the model. Exclude these speeds (fit_speeds), or cool the "
        "contact"
    )
    return [Finding("suspect", text)]


def _temperature(model: PlannedModel) -> list[Finding]:
    if model.temperature is None:
        return []
    celsius = model.temperature - 273.15
    text = f"viscosity {model.viscosity:.3g} Pa s, at the recorded {celsius:.1f} °C"
    if not model.tempered:
        text = (
            f"the runs recorded {celsius:.1f} °C; the viscosity is taken as stated. State "
            f"temperature and viscosity_per_kelvin in [medium.{model.curve.medium}]"
        )
    return [Finding("note", text)]


def _input_sensitivities(
    model: PlannedModel,
    speed: np.ndarray,
    contact: Contact,
    psd: xr.Dataset,
    load: float,
    body: Arguments,
) -> xr.Dataset | None:
    """Return how the curve changes with load, radius and modulus; None without stated errors."""
    if not model.input_errors or not speed.size:
        return None
    decades = np.log10(speed.max() / speed.min())
    coarse = np.geomspace(speed.min(), speed.max(), int(np.ceil(_A_DECADE * decades)) + 2)
    return model_inputs(contact, psd, model.viscosity, load, coarse, model.input_errors, **body)


def _range_of(value: float, error: float) -> tuple[float, float] | None:
    """Return the 95 % range of a value with a relative standard uncertainty; None if that is 0."""
    factor = float(np.exp(NORMAL * error))
    return (value / factor, value * factor) if error > 0 else None


def _add_sensitivities(curve: xr.Dataset, inputs: xr.Dataset, stress: float) -> xr.Dataset:
    """Add the change of the computed friction due to each input (model_input, sliding_speed)."""
    moved = moved_friction(inputs, stress, curve["sliding_speed"].values)
    names = inputs["model_input"].values
    parts = curve.assign(model_part=(("model_input", "sliding_speed"), moved))
    return stamp(parts.assign_coords(model_input=names))


def _profiles(
    points: np.ndarray, contact: Contact, psd: xr.Dataset, load: float, parameters: Parameters
) -> xr.Dataset:
    """Return film profiles at a few speeds between the slowest and fastest measured ones."""
    moving = points[points > 0]
    speeds = [
        float(f"{v:.2g}") for v in np.geomspace(moving.min(), moving.max(), _PROFILES).tolist()
    ]
    liquid, interface, solver = parameters
    return film_profile(contact, psd, liquid, load, speeds, interface, solver)


def _traction(
    measured: xr.Dataset,
    contact: Contact,
    psd: xr.Dataset,
    load: float,
    parameters: Parameters,
    shear_stress: float,
) -> xr.Dataset:
    """Return the computed friction at the slide-roll ratio and entrainment speed of each point."""
    ratios, speeds = measured["slide_roll_ratio"].values, measured["rolling_speed"].values
    friction = np.full(ratios.size, np.nan)
    for ratio in np.unique(np.round(ratios, 3)):
        own = np.round(ratios, 3) == ratio
        asked = parameters_of(
            *parameters,
            slide_roll=float(ratio),
            abscissa="entrainment_speed",
            shear_stress=shear_stress,
        )
        friction[own] = solve_curve(contact, psd, load, speeds[own], asked).curve[
            "friction_coefficient"
        ]
    known = measured[["rolling_speed", "slide_roll_ratio"]]
    return stamp(known.assign(friction_coefficient=("point", friction)))


def _extent(model: PlannedModel, contact: Contact) -> float | None:
    """Return the inlet length [m]; None for a ball without a stated one (its radius is used)."""
    return model.settings["inlet_length"] or (None if contact.is_round else np.inf)


def _factors(psd: xr.Dataset, rough_body: Any) -> xr.Dataset:
    factors = flow_factors(psd, rough_body)
    return factors.dataset(_SEPARATIONS * factors.rms_roughness)
