"""Fit the curves of one joint task under several models, and write the results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab.campaign.joint.plan import JointDry, JointTask, Work
from tribolab.campaign.store.data_files import read_data, write_data
from tribolab.core.coverage import NORMAL
from tribolab.core.untyped import Arguments
from tribolab.core.wording import force_text
from tribolab.records.models.joint_record import (
    JointRecord,
    correlation_rows,
    model_rows_of_comparison,
    parameter_rows,
)

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.contact.area import AreaTheory
    from tribolab.contact.geometry import Contact
    from tribolab.fit.joint.load_curve import LoadCurve
    from tribolab.fit.joint.priors import JointPriors
    from tribolab.records.parts import ModelOutcome

_SAME_LOAD = 0.02  # largest relative difference of forces that count as one load
_ADHESIVE = "adhesive area"
_OTHER_AREA = {"persson": "corrected area"}  # other theory, by that of the fit
_CURVE = (
    "friction_coefficient_couette",
    "friction_coefficient_pressure",
    "friction_coefficient_solid",
    "friction_without_factors",
    "friction_per_shear_stress",
    "friction_per_shear_stress_other",
)


def fitted(task: JointTask) -> JointRecord:
    """Fit all loads together, compare models, write the data file, and return the record.

    Raises
    ------
    TribolabError
        If the curves cannot be fitted or the file cannot be written.
    """
    # imported late: xarray loads slowly
    import xarray as xr

    from tribolab.fit.joint.comparison import compared
    from tribolab.fit.joint.loads import fit_loads

    dry = {of.surface: contacts for of in task.dry if (contacts := _dry_contacts(task, of))}
    given: Arguments = {
        "speed_error": task.speed_error,
        "spectrum_error": _model_uncertainties(task),
        "area_ratio_error": {
            surface: max(contact.error for contact in contacts) for surface, contacts in dry.items()
        },
    }
    fits = {
        name: fit_loads(variant, task.viscosity, prior, **given)
        for name, (variant, prior) in _variants(task, dry).items()
    }
    fit = next(iter(fits.values()))
    root = xr.Dataset(attrs={"surface": task.surface, "medium": task.medium})
    groups = {None: root, "points": fit.points, "curves": fit.curves}
    write_data(groups, task.folder / task.file)
    return JointRecord(
        name=task.name,
        surface=task.surface,
        medium=task.medium,
        curves=tuple(model.curve for model in task.models),
        status="done",
        file=task.file,
        reference_speed_m_s=fit.reference_speed,
        reference_load_N_m=fit.reference_load,
        described=fit.described,
        parameters=parameter_rows(fit),
        correlations=correlation_rows(fit),
        sentences=tuple(fit.words),
        models=model_rows_of_comparison(compared(fits)),
    )


class DryContact(NamedTuple):
    """Curve measured without liquid, with the contact areas that scale its shear stress.

    Parameters
    ----------
    name, load
        Name of the curve, and its load F_N/L [N/m].
    measured
        Measured curve.
    area, other_area
        Real contact area per load [1/Pa], by the theory of the fit and by the other theory.
    growth
        Ratio of the area with adhesion in the liquid to that of the model [1].
    error
        Standard error of ln(ratio of areas), from the ranges of the works of adhesion.
    """

    name: str
    load: float
    measured: xr.Dataset
    area: float
    other_area: float
    growth: float
    error: float


def _dry_contacts(task: JointTask, dry: JointDry) -> list[DryContact]:
    """Return the dry contacts of a surface at the loads that were also measured in the liquid."""
    # imported late for a quick start
    from tribolab.contact.geometry import make_contact
    from tribolab.contact.hertz import hertz_mean_pressure
    from tribolab.lubrication.parameters import Solver
    from tribolab.lubrication.stribeck import stribeck_curve

    wet = [m.normal_force for m in task.models if m.surface == dry.surface and m.normal_force]
    kept = [
        (force, file)
        for force, file in zip(dry.normal_forces, dry.measured, strict=True)
        if any(abs(force / other - 1) < _SAME_LOAD for other in wet)
    ]
    if not kept:
        return []
    contact = make_contact(**task.contacts[dry.surface])
    psd = read_data(task.folder / dry.surface_file, "psd")
    load = np.array([contact.load(force) for force, _ in kept])
    pressure = np.asarray(hertz_mean_pressure(load, contact))
    without, within = (
        _growth(pressure, psd, contact, task.area, work) for work in (dry.dry, dry.wet)
    )
    rest = stribeck_curve(contact, psd, task.viscosity, load, 0.0, [0.0], Solver(area=task.area))
    at_rest, other = (rest[f"friction_per_shear_stress{end}"].values[0] for end in ("", "_other"))
    ratio = without.value if task.adhesion else without.value / within.value
    return [
        DryContact(
            name=f"{_curve_name(task, dry.surface, force)} dry",
            load=float(load[k]),
            measured=read_data(task.folder / file),
            area=float(at_rest[k] * ratio[k]),
            other_area=float(other[k] * ratio[k]),
            growth=float(1.0 if task.adhesion else within.value[k]),
            error=float(np.hypot(without.error[k], 0.0 if task.adhesion else within.error[k])),
        )
        for k, (force, file) in enumerate(kept)
    ]


class _Growth(NamedTuple):
    """Area with adhesion divided by area without it, and standard error of the ln (load)."""

    value: np.ndarray
    error: np.ndarray


def _growth(
    pressure: np.ndarray, psd: xr.Dataset, contact: Contact, area: AreaTheory, work: Work
) -> _Growth:
    # imported late for a quick start
    from tribolab.contact.adhesive_contact import adhesion_by_works

    works = [max(w, 0.0) for w in (work.value, work.low, work.high)]
    solved = adhesion_by_works(pressure, psd, contact.effective_modulus, works, area)
    value, low, high = (part["area_enhancement"].values for part in solved)
    return _Growth(value, np.log(high / low) / (2 * NORMAL))


def _curve_name(task: JointTask, surface: str, force: float) -> str:
    """Name a curve by its load, and also by its surface if the task has several."""
    text = force_text(force)
    return f"{surface} at {text}" if len(task.surfaces) > 1 else text


def _priors(task: JointTask) -> JointPriors:
    """Return the priors of the fit; the viscosity prior follows from the stated range, if any."""
    from tribolab.fit.joint.priors import JointPriors  # imported late for a quick start

    if task.viscosity_range is None:
        return JointPriors()
    low, high = task.viscosity_range
    spread = max(np.log(task.viscosity / low), np.log(high / task.viscosity)) / NORMAL
    return JointPriors(viscosity_spread=float(spread))


class _WetCurve(NamedTuple):
    """Curve measured in the liquid, with the curve computed for it."""

    name: str
    surface: str
    load: float
    measured: xr.Dataset
    computed: xr.Dataset

    def with_response(self, other_area: bool, friction_factors: bool) -> LoadCurve:
        """Return the input of a joint fit under one of the compared models."""
        # imported late for a quick start
        from tribolab.fit.joint.load_curve import LoadCurve
        from tribolab.fit.joint.response import response_of

        computed = self.computed
        if other_area:
            other = computed["friction_per_shear_stress_other"]
            computed = computed.assign(friction_per_shear_stress=other)
        response = response_of(computed, friction_factors=friction_factors)
        return LoadCurve(self.name, self.surface, self.load, self.measured, response)


def _read_wet_curves(task: JointTask) -> list[_WetCurve]:
    """Read the curves measured in the liquid, and the curves computed for them."""
    from tribolab.contact.geometry import make_contact  # imported late for a quick start

    contacts = {surface: make_contact(**known) for surface, known in task.contacts.items()}
    curves = []
    for model, file in zip(task.models, task.measured, strict=True):
        assert model.normal_force is not None  # else it would not be in the plan
        curves.append(
            _WetCurve(
                name=_curve_name(task, model.surface, model.normal_force),
                surface=model.surface,
                load=contacts[model.surface].load(model.normal_force),
                measured=read_data(task.folder / file),
                computed=_computed_curve(task, model),
            )
        )
    return curves


def other_area_name(task: JointTask) -> str:
    """Return the name of the model with the other theory of the contact area."""
    return _OTHER_AREA.get(task.area, "Persson's area")


def _computed_curve(task: JointTask, model: ModelOutcome) -> xr.Dataset:
    """Return the computed curve at the campaign's speeds and the measured speeds."""
    # imported late: xarray loads slowly
    import xarray as xr

    path = task.folder / model.data_file
    groups = [read_data(path, name) for name in ("curve", "fit") if name in model.parts]
    parts = [group[[name for name in _CURVE if name in group]] for group in groups]
    curve = xr.concat(parts, "sliding_speed", join="outer", combine_attrs="override").sortby(
        "sliding_speed"
    )
    return curve.assign_attrs(viscosity_Pa_s=task.viscosity)


def _model_uncertainties(task: JointTask) -> dict[str, xr.Dataset]:
    """Return the model uncertainty of each surface, at the first load for which it was computed."""
    bands: dict[str, xr.Dataset] = {}
    for model in task.models:
        if "uncertainty" in model.parts and model.surface not in bands:
            bands[model.surface] = read_data(task.folder / model.data_file, "uncertainty")
    return bands


CurvesAndPriors = tuple[Sequence["LoadCurve"], "JointPriors"]


def _variants(
    task: JointTask, dry: Mapping[str, Sequence[DryContact]]
) -> dict[str, CurvesAndPriors]:
    """Return the curves and priors of each compared model, the default model first."""
    # imported late for a quick start
    from tribolab.fit.joint.comparison import CONSTANT, POWER_LAW, WITHOUT_FACTORS

    priors = _priors(task)
    constant = replace(priors, speed_exponent=0.0, load_exponent=0.0)
    wet_curves = _read_wet_curves(task)
    wet, bare, other = (
        [curve.with_response(other_area=area, friction_factors=factors) for curve in wet_curves]
        for area, factors in ((False, True), (False, False), (True, True))
    )
    usual = [*wet, *_dry_load_curves(dry)]
    variants: dict[str, CurvesAndPriors] = {
        POWER_LAW: (usual, priors),
        CONSTANT: (usual, constant),
        WITHOUT_FACTORS: ([*bare, *_dry_load_curves(dry)], priors),
        other_area_name(task): ([*other, *_dry_load_curves(dry, other=True)], priors),
    }
    known = [factor for factor in task.enhancement if factor is not None and factor > 0]
    if len(known) == len(wet) and max(known) > 1.001:
        larger = [
            curve._replace(response=curve.response.enlarged(factor))
            for curve, factor in zip(wet, known, strict=True)
        ]
        variants[_ADHESIVE] = ([*larger, *_dry_load_curves(dry, enlarged=True)], priors)
    return variants


def _dry_load_curves(
    contacts: Mapping[str, Sequence[DryContact]],
    *,
    other: bool = False,
    enlarged: bool = False,
) -> list[LoadCurve]:
    """Return the dry curves as inputs of the joint fit, with the chosen contact area."""
    # imported late for a quick start
    from tribolab.fit.joint.load_curve import LoadCurve
    from tribolab.fit.joint.response import constant_response

    return [
        LoadCurve(
            name=dry.name,
            surface=surface,
            load=dry.load,
            measured=dry.measured,
            response=constant_response(
                (dry.other_area if other else dry.area) * (dry.growth if enlarged else 1.0)
            ),
            dry=True,
        )
        for surface, of_surface in contacts.items()
        for dry in of_surface
    ]
