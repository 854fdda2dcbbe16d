"""The campaign file: what was measured, where the raw files are, and how to analyse them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import PrivateAttr

from tribolab.campaign.settings.analysed import Friction, Qc, Roughness, Segments
from tribolab.campaign.settings.contacts import Contacts
from tribolab.campaign.settings.fields import LabelPattern, SomeText
from tribolab.campaign.settings.measured import (
    CalibrationTable,
    Medium,
    Reference,
    RunEntry,
    Surface,
)
from tribolab.campaign.settings.media import (
    LiquidStated,
    MediumViscosity,
    Recorded,
    contradicting_viscosity,
    medium_viscosity,
)
from tribolab.campaign.settings.table import Table
from tribolab.campaign.settings.theory import Model, Rubber
from tribolab.core.untyped import Arguments, Json
from tribolab.friction.segments.limits import DETECTION
from tribolab.reading.dialect.uncertainty import Uncertainty

if TYPE_CHECKING:
    from tribolab.reading.flow_curves import FlowCurve

CAMPAIGN_SCHEMA_FILE = "campaign.schema.json"


class About(Table):
    """Title of the campaign and its folders."""

    name: SomeText
    """Title of the report."""
    raw: SomeText = "raw"
    """Folder of the raw files, relative to this file."""
    output: SomeText = "results"
    """Folder of the results, relative to this file."""
    files_named: LabelPattern | None = None
    """Pattern of the run files' names, without extension:
    "{surface}_{medium}_{normal_force}_{repeat}"; also {sliding_speed}, {mount}, {specimen},
    {operator}, {day} and your own labels; * matches anything. Values stated in a [[run]] take
    precedence."""
    note: SomeText | None = None
    """Note at the top of the report."""


class Campaign(Table):
    """A friction campaign as tribolab analyses it."""

    campaign: About
    contact: Contacts = Contacts()
    medium: dict[SomeText, Medium] = {}
    segments: Segments = Segments()
    friction: Friction = Friction()
    roughness: Roughness = Roughness()
    model: Model = Model()
    rubber: Rubber = Rubber()
    surface: tuple[Surface, ...] = ()
    run: tuple[RunEntry, ...] = ()
    qc: Qc = Qc()
    reference: Reference = Reference()
    calibration: CalibrationTable = CalibrationTable()
    uncertainty: Uncertainty = Uncertainty()

    _file: Path = PrivateAttr(default=Path("campaign.toml"))

    @property
    def file(self) -> Path:
        """The campaign file; all its paths are relative to its folder."""
        return self._file

    def set_file(self, path: Path) -> None:
        """Set the path of the campaign file, to which its folders are relative."""
        self._file = path

    def quality_options(self, entry: RunEntry) -> Arguments:
        """Return the arguments of `check_run` for a run."""
        options = self.qc.run_options()
        contact = self.contact.by_name[entry.contact or ""].whole()
        if contact is not None and entry.normal_force is not None:
            from tribolab.contact.hertz import hertz_half_width  # imported late for a quick start

            load = contact.load(entry.normal_force)
            options["contact_width"] = 2 * float(hertz_half_width(load, contact))
        return options

    def stated_errors(self, of_instruments: Mapping[str, float]) -> dict[str, float]:
        """Return the standard uncertainties by name; the campaign file overrides instruments.

        Parameters
        ----------
        of_instruments
            Standard uncertainties by name, as stated in the files of the instruments.
        """
        own = {name: entry["standard"] for name, entry in self.uncertainty.plain().items()}
        return {**of_instruments, **own}

    def viscosity_of(
        self,
        medium: str,
        of_instruments: Mapping[str, float] | None = None,
        recorded: Recorded | None = None,
    ) -> MediumViscosity | None:
        """Return the viscosity of a medium, stated or from its temperature; None if unknown.

        For a shear-thinning liquid it is the viscosity at the lowest measured shear rate.

        Parameters
        ----------
        medium
            Name of a [medium.*] table.
        of_instruments
            Standard uncertainties by name, as the files of the instruments state them.
        recorded
            Temperature recorded in the runs; it overrides the temperature in the table.
        """
        table = self.medium.get(medium)
        if table is None:
            return None
        curve = self.flow_curve_of(medium)
        liquid = LiquidStated(
            table.liquid or medium,
            table.viscosity if curve is None else float(curve.viscosity[0]),
            table.viscosity_range,
            table.temperature,
            table.water_content,
            table.viscosity_per_kelvin,
        )
        return medium_viscosity(liquid, self.stated_errors(of_instruments or {}), recorded)

    def tempered(self, medium: str) -> bool:
        """Whether it is known how the viscosity of a medium changes with temperature."""
        from tribolab.lubrication.viscosity import knows_liquid  # imported late for a quick start

        table = self.medium.get(medium)
        if table is None:
            return False
        known = knows_liquid(table.liquid or medium)
        if table.viscosity is None and table.flow_curve is None:
            return known
        return table.temperature is not None and (known or table.viscosity_per_kelvin is not None)

    def flow_curve_of(self, medium: str) -> FlowCurve | None:
        """Return the flow curve of a medium (viscosity against shear rate); None if not stated.

        Raises
        ------
        ReadError
            If its file cannot be read.
        """
        table = self.medium.get(medium)
        if table is None or table.flow_curve is None:
            return None
        from tribolab.reading.flow_curves import read_flow_curve  # imported late for a quick start

        return read_flow_curve(self.raw / table.flow_curve)

    def contradicting_viscosities(self) -> dict[str, str]:
        """Return a message for each medium whose stated viscosity contradicts its known liquid."""
        found = {
            name: contradicting_viscosity(
                table.liquid or name, table.viscosity, table.temperature, table.water_content
            )
            for name, table in self.medium.items()
        }
        return {name: text for name, text in found.items() if text}

    @property
    def name(self) -> str:
        """Title of the campaign."""
        return self.campaign.name

    @property
    def raw(self) -> Path:
        """Folder of the raw files."""
        return self._file.parent / self.campaign.raw

    @property
    def output(self) -> Path:
        """Folder of the results."""
        return self._file.parent / self.campaign.output

    def friction_options(self, entry: RunEntry) -> Arguments:
        """Return the arguments of `friction_coefficient` for the runs of a [[run]] table."""
        stated = {"zero_uncertainty": entry.zero_uncertainty, "rectified": entry.rectified}
        known = {key: value for key, value in stated.items() if value is not None}
        return self.friction.model_dump() | known

    def segment_options(self, entry: RunEntry) -> Arguments:
        """Return the arguments of `find_segments`; those of the [[run]] override the campaign's."""
        of_curves = {"speed_tolerance"}
        options = self.segments.model_dump(exclude_none=True, exclude=of_curves)
        limits = self.qc.limits.get("segments", {})
        options |= {name: value for name, value in limits.items() if name in DETECTION and value}
        if entry.segments is not None:
            options |= entry.segments.model_dump(
                exclude_unset=True, exclude_none=True, exclude=of_curves
            )
        return options


def campaign_schema() -> Json:
    """Return the JSON Schema (2020-12) of the campaign file."""
    schema = Campaign.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
