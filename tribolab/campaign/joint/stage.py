"""All loads of a surface in one liquid in one fit, where a campaign has two or more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.campaign.recorded import Recorded
from tribolab.campaign.settings.plan import safe_name
from tribolab.campaign.store.catalogue import Store, fingerprint_of
from tribolab.campaign.store.data_files import read_data, write_data
from tribolab.provenance import sha256_of
from tribolab.records.joint_record import JointRecord
from tribolab.records.part_records import CurveRecord, ModelRecord
from tribolab.records.parts import ModelOutcome, number_of
from tribolab.untyped import Arguments
from tribolab.words import explain, force_text

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.settings.config import Campaign
    from tribolab.fit.joint.load_curve import LoadCurve
    from tribolab.fit.joint.priors import JointPriors

_NORMAL = 1.959963984540054
ADHESIVE = "adhesive area"
_CURVE = (
    "friction_coefficient_couette",
    "friction_coefficient_pressure",
    "friction_coefficient_solid",
    "friction_without_factors",
    "friction_per_shear_stress",
)


@dataclass(frozen=True)
class JointTask:
    """The curves of a surface in one liquid, their models, and what else the fit wants to know.

    Parameters
    ----------
    name, surface, medium
        What it is of.
    models
        The models, by load.
    measured
        Data files of the measured curves, as the models.
    enhancement
        Real contact area with adhesion over that without [1], at each load; None if not known.
    contact
        The table [contact].
    viscosity, viscosity_range
        Of the liquid as stated [Pa s].
    folder, fingerprint
        Where, and what shapes it.
    """

    name: str
    surface: str
    medium: str
    models: tuple[ModelOutcome, ...]
    measured: tuple[str, ...]
    enhancement: tuple[float | None, ...]
    contact: Arguments
    viscosity: float
    viscosity_range: tuple[float, float] | None
    folder: Path
    fingerprint: str = ""

    @property
    def file(self) -> str:
        """Data file relative to the results folder."""
        return f"data/{self.name}.nc"


class JointFits(Recorded[JointTask, JointRecord, JointRecord]):
    """The stage of the joint fits.

    Parameters
    ----------
    campaign
        It knows the liquids and the contact.
    curves, models
        What is recorded of them.
    store
        What is known, and where it is written down.
    """

    name = "joint fits"
    kind = "joint"
    record = JointRecord

    def __init__(
        self,
        campaign: Campaign,
        curves: Sequence[CurveRecord],
        models: Sequence[ModelRecord],
        store: Store,
    ) -> None:
        super().__init__(store)
        self._campaign = campaign
        self._files = {c.outcome.name: c.outcome.data_file for c in curves if c.outcome.done}
        self._models = [
            model
            for model in models
            if model.outcome.done and model.outcome.normal_force and model.rows is not None
        ]

    def plan(self) -> list[JointTask]:
        """Return a task for each surface and liquid with two loads or more."""
        groups: dict[tuple[str, str], list[ModelRecord]] = {}
        for model in self._models:
            groups.setdefault((model.outcome.surface, model.outcome.medium), []).append(model)
        tasks = []
        for (surface, medium), members in groups.items():
            if len({model.outcome.normal_force for model in members}) < 2:
                continue
            members.sort(key=lambda model: model.outcome.normal_force or 0.0)
            outcomes = tuple(replace(model.outcome, seconds=0.0) for model in members)
            liquid = self._campaign.viscosity_of(medium)
            assert liquid is not None  # else there were no models
            task = JointTask(
                name=f"joint_{safe_name('_'.join(filter(None, (surface, medium))))}",
                surface=surface,
                medium=medium,
                models=outcomes,
                measured=tuple(self._files[outcome.curve] for outcome in outcomes),
                enhancement=tuple(_enhancement(model) for model in members),
                contact=self._campaign.contact.line(),
                viscosity=liquid.value,
                viscosity_range=liquid.bounds,
                folder=self._store.folder,
            )
            files = [*task.measured, *(outcome.data_file for outcome in outcomes)]
            shaping = [
                [task.name, task.enhancement, task.contact, task.viscosity, task.viscosity_range],
                [self._store.identity(file) for file in files],
            ]
            tasks.append(replace(task, fingerprint=fingerprint_of(sha256_of(shaping))))
        return tasks

    def linked(self, task: JointTask, record: JointRecord) -> bool:
        """Have the data file among the new ones."""
        return self._store.link(self.kind, task.name, record.file, record.file)

    @staticmethod
    def work(task: JointTask) -> JointRecord:
        """Fit one surface in one liquid."""
        return fitted(task)

    def failed(self, task: JointTask, error: BaseException) -> JointRecord:
        """Return the record of a fit that failed: the single fits stand without it."""
        names = tuple(model.curve for model in task.models)
        reason = explain(error)[0]
        return JointRecord(task.name, task.surface, task.medium, names, "failed", reason)


def _enhancement(model: ModelRecord) -> float | None:
    fit = model.rows.fit if model.rows is not None else None
    return None if fit is None else number_of(fit, "area_enhancement")


def fitted(task: JointTask) -> JointRecord:
    """Fit all loads together, compare models, write the data file, and return the record.

    Raises
    ------
    TribolabError
        If the curves cannot be fitted, or the file not be written.
    """
    import xarray as xr

    from tribolab.fit.joint.comparison import compared
    from tribolab.fit.joint.loads import fit_loads
    from tribolab.records.joint_record import (
        correlation_rows,
        model_rows_of_comparison,
        parameter_rows,
    )

    priors = _priors(task)
    curves, band = _curves(task), _band(task)
    given: Arguments = {"spectrum_error": {task.surface: band}} if band is not None else {}
    fits = {
        name: fit_loads(variant, task.viscosity, prior, **given)
        for name, (variant, prior) in _variants(task, curves, priors).items()
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


def _priors(task: JointTask) -> JointPriors:
    """Return the usual priors, the viscosity's from its range where that is stated."""
    from tribolab.fit.joint.priors import JointPriors

    if task.viscosity_range is None:
        return JointPriors()
    low, high = task.viscosity_range
    spread = max(np.log(task.viscosity / low), np.log(high / task.viscosity)) / _NORMAL
    return JointPriors(viscosity_spread=float(spread))


def _curves(task: JointTask, *, friction_factors: bool = True) -> list[LoadCurve]:
    """Return the measured curves with what is computed beside them."""
    from tribolab.contact.geometry import LineContact
    from tribolab.fit.joint.load_curve import LoadCurve
    from tribolab.fit.joint.response import response_of

    contact = LineContact(**task.contact)
    curves = []
    for model, file in zip(task.models, task.measured, strict=True):
        assert model.normal_force is not None  # else it were not in the plan
        response = response_of(_computed(task, model), friction_factors=friction_factors)
        curves.append(
            LoadCurve(
                name=force_text(model.normal_force),
                surface=task.surface,
                load=contact.load(model.normal_force),
                measured=read_data(task.folder / file),
                response=response,
            )
        )
    return curves


def _computed(task: JointTask, model: ModelOutcome) -> xr.Dataset:
    """Return the computed curve over the campaign's speeds and those that were measured."""
    import xarray as xr

    path = task.folder / model.data_file
    groups = [read_data(path, name) for name in ("curve", "fit") if name in model.parts]
    parts = [group[[name for name in _CURVE if name in group]] for group in groups]
    curve = xr.concat(parts, "sliding_speed", join="outer", combine_attrs="override").sortby(
        "sliding_speed"
    )
    return curve.assign_attrs(viscosity_Pa_s=task.viscosity)


def _band(task: JointTask) -> xr.Dataset | None:
    """Return what is not known of the model, at the load for which it was computed."""
    for model in task.models:
        if "uncertainty" in model.parts:
            return read_data(task.folder / model.data_file, "uncertainty")
    return None


def _variants(
    task: JointTask, curves: Sequence[LoadCurve], priors: JointPriors
) -> dict[str, tuple[Sequence[LoadCurve], JointPriors]]:
    """Return the models that are compared: for each its curves and priors, the usual one first."""
    from tribolab.fit.joint.comparison import CONSTANT, POWER_LAW, WITHOUT_FACTORS

    constant = replace(priors, speed_exponent=0.0, load_exponent=0.0)
    variants: dict[str, tuple[Sequence[LoadCurve], JointPriors]] = {
        POWER_LAW: (curves, priors),
        CONSTANT: (curves, constant),
        WITHOUT_FACTORS: (_curves(task, friction_factors=False), priors),
    }
    known = [factor for factor in task.enhancement if factor is not None and factor > 0]
    if len(known) == len(curves) and max(known) > 1.001:
        larger = [
            curve._replace(response=curve.response.enlarged(factor))
            for curve, factor in zip(curves, known, strict=True)
        ]
        variants[ADHESIVE] = (larger, priors)
    return variants
