"""Plan of the models: one for each measured curve in a liquid, with all its inputs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from tribolab.campaign.settings.contact_pairs import contact_of_label, contact_table
from tribolab.campaign.settings.media import Recorded
from tribolab.core.coverage import NORMAL
from tribolab.core.provenance import join_sources, sha256_of, source_attributes
from tribolab.core.untyped import Arguments

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.settings.measured import Contact
    from tribolab.campaign.settings.media import MediumViscosity
    from tribolab.contact.area import AreaTheory
    from tribolab.records.part_records import CurveRecord, SurfaceRecord
    from tribolab.records.parts import CurveOutcome, SurfaceOutcome

_ELSEWHERE = {  # keys of [model] that do not affect a single model curve
    "compute",
    "uncertainty",
    "adhesion",
    "area",
    "normal_forces",
    "joint",
    "together",
    "dry_medium",
}
_DIGITS = 2  # digits of a repeatability; one more run should not change every model


@dataclass(frozen=True)
class PlannedModel:
    """Model of one measured curve, with everything that a worker needs.

    Parameters
    ----------
    curve
        The measured curve; its data file has the points.
    surface_file
        Data file of the surface with its spectrum.
    contact
        Table of the contact, [contact] or [contact.NAME].
    viscosity
        Viscosity [Pa s].
    viscosity_range, youngs_modulus_range
        Their ranges [Pa s], [Pa]; None if not stated.
    settings
        Table [model].
    area
        Theory of the contact area.
    leading
        Whether this is the surface's model at its lowest load, with profiles and factors.
    uncertain
        Whether the model's own uncertainty is computed.
    repeatability, freedom
        Relative standard deviation of a run's friction level, and its degrees of freedom.
    abscissa_error
        Relative standard uncertainty of viscosity times speed.
    input_errors
        Relative standard uncertainties of load, radius and modulus, if stated.
    work_of_adhesion, work_of_adhesion_range
        Value in the medium [J/m2] and its bounds; None without [model] adhesion.
    flow_curve
        Shear rates [1/s] and relative viscosities [1] of a shear-thinning liquid.
    temperature, tempered
        Temperature recorded while sliding [K] or None, and whether the viscosity depends on it.
    contact_area
        Measured contact area [m2]; None if unknown.
    missing
        Message on missing inputs; "" if the model can be computed.
    source, source_sha256
        Source files of curve and spectrum.
    config_sha256
        Checksum of everything that affects the result, including the data.
    """

    curve: CurveOutcome
    surface_file: str
    contact: Arguments
    viscosity: float
    viscosity_range: tuple[float, float] | None
    youngs_modulus_range: tuple[float, float] | None
    settings: Arguments
    area: AreaTheory
    leading: bool
    uncertain: bool
    repeatability: float
    freedom: int
    abscissa_error: float = 0.0
    input_errors: Mapping[str, float] = field(default_factory=dict)
    work_of_adhesion: float | None = None
    work_of_adhesion_range: tuple[float, float] | None = None
    flow_curve: tuple[tuple[float, ...], tuple[float, ...]] | None = None
    temperature: float | None = None
    tempered: bool = False
    contact_area: float | None = None
    missing: str = ""
    source: str = ""
    source_sha256: str = ""
    config_sha256: str = field(default="", compare=False)

    @property
    def name(self) -> str:
        """Name of the model and of its data file."""
        return "model_" + self.curve.name.removeprefix("curve_")

    @property
    def normal_force(self) -> float:
        """Load of the measured curve [N]; 0 if unknown, as `missing` then states."""
        return self.curve.normal_force or 0.0

    @property
    def data_file(self) -> str:
        """Path of the data file relative to the results folder."""
        return f"data/{self.name}.nc"


def plan_models(
    campaign: Campaign, curves: Iterable[CurveRecord], surfaces: Iterable[SurfaceRecord]
) -> tuple[PlannedModel, ...]:
    """Return the models of all measured curves in a fluid, in the order of the curves.

    Parameters
    ----------
    campaign
        From `load_campaign`.
    curves, surfaces
        Their records.
    """
    done = [curve for curve in curves if curve.outcome.done]
    if not campaign.model.compute:
        return ()
    wet = [
        (curve, viscosity)
        for curve in done
        if (viscosity := _viscosity(campaign, curve)) is not None
    ]
    if not wet:
        return ()
    spread, freedom = _repeatability(done)
    known = {surface.outcome.name: surface for surface in surfaces}
    settings = campaign.model.model_dump(exclude=_ELSEWHERE)
    planned, led = [], set()
    for record, viscosity in sorted(wet, key=lambda pair: pair[0].outcome.normal_force or np.inf):
        curve, surface = record.outcome, known.get(record.outcome.surface)
        stated = campaign.stated_errors(record.model_inputs)
        contact = contact_of_label(campaign, curve.surface)
        modulus_range = _modulus_range(contact, stated.get("youngs_modulus"))
        table = contact_table(campaign, curve.surface)
        missing = _missing(curve, table, contact.bodies(), surface.outcome if surface else None)
        work, works = _adhesion(campaign, curve.medium)
        if campaign.model.adhesion and work is None:
            missing = missing or f"[medium.{curve.medium}] wants work_of_adhesion"
        first = not missing and (curve.surface, curve.medium) not in led
        if first:
            led.add((curve.surface, curve.medium))
        model = PlannedModel(
            curve=curve,
            surface_file=surface.outcome.data_file if surface else "",
            contact=contact.bodies(),
            viscosity=viscosity.value,
            flow_curve=_flow_curve(campaign, curve.medium),
            temperature=record.temperature_K,
            tempered=campaign.tempered(curve.medium),
            contact_area=record.contact_area_m2,
            viscosity_range=viscosity.bounds,
            youngs_modulus_range=modulus_range,
            abscissa_error=float(np.hypot(viscosity.error, stated.get("speed", 0.0))),
            input_errors=_input_errors(stated, modulus_range),
            work_of_adhesion=work,
            work_of_adhesion_range=works,
            settings=settings,
            area=campaign.model.area,
            leading=first,
            uncertain={"all": True, "none": False}.get(campaign.model.uncertainty, first),
            repeatability=spread,
            freedom=freedom,
            missing=missing,
        )
        planned.append(
            model if missing or surface is None else _add_checksum(model, record, surface)
        )
    order = {curve.outcome.name: number for number, curve in enumerate(done)}
    return tuple(sorted(planned, key=lambda model: order[model.curve.name]))


def _viscosity(campaign: Campaign, curve: CurveRecord) -> MediumViscosity | None:
    """Return the viscosity at the recorded temperature; as stated if none was recorded."""
    kelvin = curve.temperature_K
    recorded = None if kelvin is None else Recorded(kelvin, curve.temperature_spread_K)
    return campaign.viscosity_of(curve.outcome.medium, curve.model_inputs, recorded)


def _flow_curve(
    campaign: Campaign, medium: str
) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
    known = campaign.flow_curve_of(medium)
    if known is None:
        return None
    relative = known.viscosity / known.viscosity[0]
    return tuple(known.shear_rate.tolist()), tuple(relative.tolist())


def _modulus_range(contact: Contact, error: float | None) -> tuple[float, float] | None:
    """Return the range of Young's modulus [Pa], as stated or from its uncertainty."""
    modulus, stated = contact.youngs_modulus, contact.youngs_modulus_range
    if stated is not None or modulus is None or error is None:
        return stated
    factor = float(np.exp(NORMAL * error))
    return modulus / factor, modulus * factor


def _input_errors(
    stated: Mapping[str, float], modulus_range: tuple[float, float] | None
) -> dict[str, float]:
    """Return the relative standard uncertainties of load, radius and modulus."""
    names = ("load", "radius", "youngs_modulus")
    errors = {name: stated[name] for name in names if stated.get(name, 0.0) > 0}
    if modulus_range is not None and "youngs_modulus" not in errors:
        errors["youngs_modulus"] = float(np.log(modulus_range[1] / modulus_range[0]) / (2 * NORMAL))
    return errors


def _adhesion(campaign: Campaign, medium: str) -> tuple[float | None, tuple[float, float] | None]:
    """Return a medium's work of adhesion and its range [J/m2], if the models include adhesion."""
    table = campaign.medium.get(medium)
    if not campaign.model.adhesion or table is None or table.work_of_adhesion is None:
        return None, None
    return table.work_of_adhesion, table.work_of_adhesion_range


def _missing(
    curve: CurveOutcome, table: str, contact: Arguments, surface: SurfaceOutcome | None
) -> str:
    unknown = [name for name, value in contact.items() if value is None]
    if unknown:
        return f"{table} wants {', '.join(unknown)}"
    if curve.normal_force is None or not curve.normal_force > 0:
        return "no normal force is known"
    if surface is None or not surface.done:
        return f"there is no spectrum of {curve.surface or 'a surface that is not named'}"
    return ""


def _repeatability(curves: Sequence[CurveRecord]) -> tuple[float, int]:
    """Return the pooled repeatability of all repeated curves, and its degrees of freedom."""
    # imported late for a quick start
    from tribolab.friction.coefficient.repeatability import pooled_repeatability

    spread, freedom = pooled_repeatability([np.array(c.levels, float) for c in curves if c.levels])
    return float(f"{spread:.{_DIGITS}g}"), freedom


def _add_checksum(model: PlannedModel, curve: CurveRecord, surface: SurfaceRecord) -> PlannedModel:
    """Add the sources, and the checksum of everything that affects the model."""
    joined = join_sources([asdict(curve.origin), source_attributes(surface.sources)])
    model = replace(
        model,
        source=joined.get("source", ""),
        source_sha256=joined.get("source_sha256", ""),
    )
    facts = asdict(model) | {"data": [curve.digest, surface.digest]}
    return replace(model, config_sha256=sha256_of(facts))
