"""Stage of the joint fits in one liquid: all loads of a surface, or several surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

from tribolab.campaign.joint.plan import JointDry, JointTask, Work
from tribolab.campaign.recorded import Recorded
from tribolab.campaign.settings.contact_pairs import contact_of_label
from tribolab.campaign.settings.naming.run_names import safe_name
from tribolab.campaign.store.catalogue import fingerprint_of
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.provenance import sha256_of
from tribolab.core.wording import explain
from tribolab.records.models.joint_record import JointRecord
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import ModelOutcome, number_of

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign


class JointFits(Recorded[JointTask, JointRecord, JointRecord]):
    """Stage that fits all loads of a surface, or several surfaces, together.

    Parameters
    ----------
    campaign
        Campaign with liquids and contacts.
    curves, models, surfaces
        Their records.
    store
        Known results, and storage of new ones.
    """

    name = "joint fits"
    kind = "joint"
    record = JointRecord

    def __init__(
        self,
        campaign: Campaign,
        curves: Sequence[CurveRecord],
        models: Sequence[ModelRecord],
        surfaces: Sequence[SurfaceRecord],
        store: Store,
    ) -> None:
        super().__init__(store)
        self._campaign = campaign
        self._curves = [curve.outcome for curve in curves if curve.outcome.done]
        self._files = {curve.name: curve.data_file for curve in self._curves}
        self._stated = {curve.outcome.name: curve.model_inputs for curve in curves}
        self._spectra = {s.outcome.name: s.outcome.data_file for s in surfaces if s.outcome.done}
        self._models = [
            model
            for model in models
            if model.outcome.done and model.outcome.normal_force and model.rows is not None
        ]

    def plan(self) -> list[JointTask]:
        """Return a task for each surface and liquid, and for each group of surfaces."""
        settings = self._campaign.model
        if not settings.joint:
            return []
        groups: dict[tuple[tuple[str, ...], str], list[ModelRecord]] = {}
        for model in self._models:
            of = model.outcome
            groups.setdefault(((of.surface,), of.medium), []).append(model)
        for medium in dict.fromkeys(model.outcome.medium for model in self._models):
            members = [
                model for name in settings.together for model in groups.get(((name,), medium), [])
            ]
            names = tuple(dict.fromkeys(model.outcome.surface for model in members))
            if len(names) > 1:
                groups[names, medium] = members
        return [
            self._task(surfaces, medium, members) for (surfaces, medium), members in groups.items()
        ]

    def _task(
        self, surfaces: tuple[str, ...], medium: str, members: Sequence[ModelRecord]
    ) -> JointTask:
        ordered = sorted(
            members,
            key=lambda model: (
                surfaces.index(model.outcome.surface),
                model.outcome.normal_force or 0.0,
            ),
        )
        outcomes = tuple(replace(model.outcome, seconds=0.0) for model in ordered)
        stated = self._largest_uncertainties(outcomes)
        liquid = self._campaign.viscosity_of(medium, stated)
        assert liquid is not None  # without a liquid there are no models
        contacts = {surface: contact_of_label(self._campaign, surface) for surface in surfaces}
        task = JointTask(
            name=f"joint_{safe_name('_'.join(filter(None, (*surfaces, medium))))}",
            surfaces=surfaces,
            medium=medium,
            models=outcomes,
            measured=tuple(self._files[outcome.curve] for outcome in outcomes),
            enhancement=tuple(_enhancement(model) for model in ordered),
            dry=self._dry_curves(surfaces, medium),
            contacts={surface: contact.bodies() for surface, contact in contacts.items()},
            area=self._campaign.model.area,
            adhesion=self._campaign.model.adhesion,
            viscosity=liquid.value,
            viscosity_range=liquid.bounds,
            speed_error=self._campaign.stated_errors(stated).get("speed", 0.0),
            folder=self._store.folder,
        )
        files = [*task.measured, *(outcome.data_file for outcome in outcomes)]
        for dry in task.dry:
            files += [dry.surface_file, *dry.measured]
        shaping = [
            [task.name, task.enhancement, task.contacts, task.viscosity, task.viscosity_range],
            [task.area, task.adhesion, [asdict(dry) for dry in task.dry], task.speed_error],
            [self._store.identity(file) for file in files],
        ]
        return replace(task, fingerprint=fingerprint_of(sha256_of(shaping)))

    def _largest_uncertainties(self, models: Sequence[ModelOutcome]) -> dict[str, float]:
        """Return the largest stated uncertainty of each model input over all curves."""
        each = [self._stated[model.curve] for model in models]
        names = dict.fromkeys(name for stated in each for name in stated)
        return {name: max(stated.get(name, 0.0) for stated in each) for name in names}

    def _dry_curves(self, surfaces: Sequence[str], medium: str) -> tuple[JointDry, ...]:
        """Return the friction of each surface without liquid, if the campaign uses it."""
        name = self._campaign.model.dry_medium
        without, within = self._work_of_adhesion(name), self._work_of_adhesion(medium)
        if name is None or without is None or within is None:
            return ()
        dry = []
        for surface in surfaces:
            curves = [
                (curve.normal_force, curve.data_file)
                for curve in self._curves
                if (curve.surface, curve.medium) == (surface, name) and curve.normal_force
            ]
            if curves and surface in self._spectra:
                forces, files = zip(*sorted(curves), strict=True)
                dry.append(
                    JointDry(surface, self._spectra[surface], forces, files, without, within)
                )
        return tuple(dry)

    def _work_of_adhesion(self, medium: str | None) -> Work | None:
        table = self._campaign.medium.get(medium or "")
        if table is None or table.work_of_adhesion is None:
            return None
        value = table.work_of_adhesion
        return Work(value, *(table.work_of_adhesion_range or (value, value)))

    def taken(self, task: JointTask, record: JointRecord) -> JointRecord | None:
        """Reuse a fit whose data file is intact."""
        return record if self.linked(task, record.file, record.file) else None

    @staticmethod
    def work(task: JointTask) -> JointRecord:
        """Fit the curves of one task."""
        from tribolab.campaign.joint.work import fitted  # imported late for a quick start

        return fitted(task)

    def failed(self, task: JointTask, error: BaseException) -> JointRecord:
        """Return the record of a failed fit; the single fits do not depend on it."""
        names = tuple(model.curve for model in task.models)
        reason = explain(error)[0]
        return JointRecord(task.name, task.surface, task.medium, names, "failed", reason)


def _enhancement(model: ModelRecord) -> float | None:
    fit = model.rows.fit if model.rows is not None else None
    return None if fit is None else number_of(fit, "area_enhancement")
