"""Which measured curves are fitted together, and what else the fits want to know."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.settings.plan import safe_name
from tribolab.campaign.store.catalogue import Store, fingerprint_of
from tribolab.provenance import sha256_of
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import ModelOutcome, number_of
from tribolab.untyped import Arguments

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.contact.area import AreaTheory

_FEWEST_LOADS = {"always": 1, "two loads": 2}


@dataclass(frozen=True)
class Work:
    """A work of adhesion [J/m2] and what it may be; bounds that are not stated are equal to it."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class JointDry:
    """Friction measured without the liquid, at some loads of one surface.

    Parameters
    ----------
    surface
        Whose.
    surface_file
        Data file with its spectrum.
    normal_forces, measured
        Loads [N], and the data files of the curves.
    dry, wet
        Works of adhesion without the liquid and in it.
    """

    surface: str
    surface_file: str
    normal_forces: tuple[float, ...]
    measured: tuple[str, ...]
    dry: Work
    wet: Work


@dataclass(frozen=True)
class JointTask:
    """Measured curves in one liquid, their models, and what else the fit wants to know.

    Parameters
    ----------
    name, surfaces, medium
        What it is of.
    models
        The models, by surface and load.
    measured
        Data files of the measured curves, as the models.
    enhancement
        Real contact area with adhesion over that of the model [1], as the models; None if not
        known.
    dry
        Friction measured without the liquid, by surface; none if it is not to be used.
    contact
        The table [contact].
    area, adhesion
        Theory of the contact area, and whether the models' area is that with adhesion.
    viscosity, viscosity_range
        Of the liquid as stated [Pa s].
    folder, fingerprint
        Where, and what shapes it.
    """

    name: str
    surfaces: tuple[str, ...]
    medium: str
    models: tuple[ModelOutcome, ...]
    measured: tuple[str, ...]
    enhancement: tuple[float | None, ...]
    dry: tuple[JointDry, ...]
    contact: Arguments
    area: AreaTheory
    adhesion: bool
    viscosity: float
    viscosity_range: tuple[float, float] | None
    folder: Path
    fingerprint: str = ""

    @property
    def file(self) -> str:
        """Data file relative to the results folder."""
        return f"data/{self.name}.nc"

    @property
    def surface(self) -> str:
        """The surfaces as they are said."""
        *before, last = self.surfaces
        return f"{', '.join(before)} and {last}" if before else last


class JointParts:
    """What is recorded of a campaign's curves, models and surfaces, put together for joint fits.

    Parameters
    ----------
    campaign
        It knows the liquids and the contact.
    curves, models, surfaces
        What is recorded of them.
    store
        It knows the files.
    """

    def __init__(
        self,
        campaign: Campaign,
        curves: Sequence[CurveRecord],
        models: Sequence[ModelRecord],
        surfaces: Sequence[SurfaceRecord],
        store: Store,
    ) -> None:
        self._campaign, self._store = campaign, store
        self._curves = [curve.outcome for curve in curves if curve.outcome.done]
        self._files = {curve.name: curve.data_file for curve in self._curves}
        self._spectra = {s.outcome.name: s.outcome.data_file for s in surfaces if s.outcome.done}
        self._models = [
            model
            for model in models
            if model.outcome.done and model.outcome.normal_force and model.rows is not None
        ]

    def tasks(self) -> list[JointTask]:
        """Return a task for each surface and liquid, and for surfaces that belong together."""
        settings = self._campaign.joint
        if settings.compute == "never":
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
        fewest = _FEWEST_LOADS[settings.compute]
        return [
            self._task(surfaces, medium, members)
            for (surfaces, medium), members in groups.items()
            if len({model.outcome.normal_force for model in members}) >= fewest
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
        liquid = self._campaign.viscosity_of(medium)
        assert liquid is not None  # else there were no models
        task = JointTask(
            name=f"joint_{safe_name('_'.join(filter(None, (*surfaces, medium))))}",
            surfaces=surfaces,
            medium=medium,
            models=outcomes,
            measured=tuple(self._files[outcome.curve] for outcome in outcomes),
            enhancement=tuple(_enhancement(model) for model in ordered),
            dry=self._dry(surfaces, medium),
            contact=self._campaign.contact.line(),
            area=self._campaign.contact.area,
            adhesion=self._campaign.model.adhesion,
            viscosity=liquid.value,
            viscosity_range=liquid.bounds,
            folder=self._store.folder,
        )
        files = [*task.measured, *(outcome.data_file for outcome in outcomes)]
        for dry in task.dry:
            files += [dry.surface_file, *dry.measured]
        shaping = [
            [task.name, task.enhancement, task.contact, task.viscosity, task.viscosity_range],
            [task.area, task.adhesion, [asdict(dry) for dry in task.dry]],
            [self._store.identity(file) for file in files],
        ]
        return replace(task, fingerprint=fingerprint_of(sha256_of(shaping)))

    def _dry(self, surfaces: Sequence[str], medium: str) -> tuple[JointDry, ...]:
        """Return the friction without liquid of each surface, where it is to be used."""
        name = self._campaign.joint.dry
        without, within = self._work(name), self._work(medium)
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

    def _work(self, medium: str | None) -> Work | None:
        table = self._campaign.medium.get(medium or "")
        if table is None or table.work_of_adhesion is None:
            return None
        value = table.work_of_adhesion
        return Work(value, *(table.work_of_adhesion_range or (value, value)))


def _enhancement(model: ModelRecord) -> float | None:
    fit = model.rows.fit if model.rows is not None else None
    return None if fit is None else number_of(fit, "area_enhancement")
