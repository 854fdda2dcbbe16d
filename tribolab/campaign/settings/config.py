"""The campaign file: what was measured, where the raw files lie, how to analyse them."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, PrivateAttr, model_validator

from tribolab.campaign.settings.fields import (
    LabelPattern,
    MiddleShare,
    Patterns,
    PositiveSi,
    ShareOfEnds,
    ShareOfMass,
    Si,
    Spread,
    Text,
    ZeroPlace,
)
from tribolab.campaign.settings.media import MediumViscosity, medium_viscosity
from tribolab.campaign.settings.table import Table
from tribolab.campaign.settings.theory import Joint, Model, Rubber
from tribolab.errors import ConfigError, TribolabError, nearest, shown
from tribolab.io.uncertainty import Uncertainty
from tribolab.untyped import Arguments, Json

if TYPE_CHECKING:
    from tribolab.contact.geometry import LineContact

SCHEMA_FILE = "campaign.schema.json"


class About(Table):
    """What the campaign is called and where its files lie."""

    name: Text
    """Title of the report."""
    raw: Text = "raw"
    """Folder of the raw files, relative to this file."""
    output: Text = "results"
    """Folder of the results, relative to this file."""
    note: Text | None = None
    """What every reader of the report should know first; it stands at its top."""


class Contact(Table):
    """The cylinder and the elastomer, as far as they are known."""

    radius: Annotated[float, PositiveSi("m", "7 cm")] | None = None
    """Radius of the cylinder."""
    length: Annotated[float, PositiveSi("m", "10 cm")] | None = None
    """Length of the line contact."""
    youngs_modulus: Annotated[float, PositiveSi("Pa", "1.5 MPa")] | None = None
    """Young's modulus of the elastomer at low frequency."""
    youngs_modulus_range: (
        tuple[
            Annotated[float, PositiveSi("Pa", "1.35 MPa")],
            Annotated[float, PositiveSi("Pa", "1.65 MPa")],
        ]
        | None
    ) = None
    """Between which values it is uncertain; model curves get a band from it."""
    poisson_ratio: Annotated[float, Field(gt=-1, le=0.5)] | None = None
    """Poisson's ratio of the elastomer."""
    area: Literal["persson", "corrected", "numerics"] = "persson"
    """Theory of the contact area: Persson's as in the paper; corrected for the elastic energy that
    partial contact saves; or as fitted to boundary elements."""
    normal_forces: tuple[Annotated[float, PositiveSi("N", "31 N")], ...] = ()
    """Normal forces at which contact and adhesion are computed, beside those of the runs."""
    modulus_file: Text | None = None
    """Storage and loss modulus over frequency (DMA), relative to the raw folder."""

    def line(self) -> dict[str, float | None]:
        """Return the arguments of `LineContact`, as far as they are known."""
        return self.model_dump(include={"radius", "length", "youngs_modulus", "poisson_ratio"})

    def whole(self) -> LineContact | None:
        """Return the line contact; None as long as something of it is not known."""
        from tribolab.contact.geometry import LineContact

        known = {name: value for name, value in self.line().items() if value is not None}
        return LineContact(**known) if len(known) == len(self.line()) else None


class Medium(Table):
    """What is between the surfaces, as far as it is known."""

    viscosity: Annotated[float, PositiveSi("Pa s", "1.4 Pa s")] | None = None
    """Dynamic viscosity."""
    viscosity_range: (
        tuple[
            Annotated[float, PositiveSi("Pa s", "1.2 Pa s")],
            Annotated[float, PositiveSi("Pa s", "1.6 Pa s")],
        ]
        | None
    ) = None
    """Between which values it is uncertain; model curves get a band from it."""
    work_of_adhesion: Annotated[float, Si("J/m2", "51 mJ/m^2")] | None = None
    """Work of adhesion of the surfaces in this medium."""
    work_of_adhesion_range: (
        tuple[Annotated[float, Si("J/m2", "21 mJ/m^2")], Annotated[float, Si("J/m2", "59 mJ/m^2")]]
        | None
    ) = None
    """Between which values it is uncertain; contact areas get bounds from it."""
    temperature: Annotated[float, PositiveSi("K", "20 °C")] | None = None
    """Temperature at which it was measured; with it the viscosity of "glycerol", "water" and
    "silicone oil 1000 cSt" (any grade) is known where none is stated."""
    water_content: ShareOfMass | None = None
    """Mass fraction of water in glycerol."""
    liquid: Text | None = None
    """What it is, where the table's name does not say it: "silicone oil 350 cSt"."""


class Segments(Table):
    """How segments of constant speed are found."""

    trim: ShareOfEnds = 0.10
    """Share of a segment that is left out at each end."""
    position_range: (
        tuple[Annotated[float, Si("m", "5 mm")], Annotated[float, Si("m", "32 mm")]] | None
    ) = None
    """Only this part of the track is used."""
    stroke_middle: MiddleShare | None = None
    """Of a slider that moves to and fro without a constant speed: the share of each stroke's length
    about its middle that is used, e.g. "40 %"."""
    resolution: Annotated[float, Field(gt=0, lt=1)] | None = None
    """Relative difference of speed that separates two neighbouring plateaus."""
    drift: Annotated[float, Field(gt=0)] | None = None
    """Relative change of speed within one plateau above which it is a ramp."""
    min_samples: Annotated[int, Field(ge=2)] | None = None
    """Fewest samples in a segment."""
    min_duration: Annotated[float, PositiveSi("s", "0.5 s")] | None = None
    """Shorter segments are left out."""
    max_gap: Annotated[float, PositiveSi("s", "2 s")] | None = None
    """Longest pause between two samples within a segment; by default a twentieth of it."""
    rest_speed: Annotated[float, PositiveSi("m/s", "0.1 um/s")] | None = None
    """Speed below which the slider is at rest; by default 1e-5 of the highest."""


class Friction(Table):
    """How the friction coefficient is computed."""

    offset: Literal["auto", "half loop", "zero load", "none"] = "auto"
    """Which offset of the friction force is removed."""
    pair_tolerance: Annotated[float, Field(gt=0, lt=2)] = 0.25
    """Up to which difference of speed, over their mean, two strokes have the same friction."""


class Roughness(Table):
    """How the power spectrum is made from the scans."""

    form: Literal["auto", "none", "mean", "tilt", "circle", "polynomial"] = "auto"
    """What is taken away from the scans first; by default a circle from profiles."""
    q_low: Annotated[float, PositiveSi("1/m", "423 1/m")] | None = None
    """Smallest wavenumber; by default pi over the Hertz width at the lowest load."""
    q_high: Annotated[float, PositiveSi("1/m", "3.14e9 1/m")] | None = None
    """Largest wavenumber; by default pi / 1 nm."""
    fit_decade: (
        tuple[
            Annotated[float, PositiveSi("1/m", "1e5 1/m")],
            Annotated[float, PositiveSi("1/m", "1e6 1/m")],
        ]
        | None
    ) = None
    """Wavenumbers between which the power law is fitted that goes on to the largest."""
    tip_radius: Annotated[float, PositiveSi("m", "2 um")] | None = None
    """Radius of the stylus, if the files do not say it."""


class Surface(Table):
    """One surface and its topography scans."""

    name: Text
    """What it is called in the [[run]] tables and in the report."""
    scans: Patterns | None = None
    """Profilometer files, relative to the raw folder."""
    instrument: Text | None = None
    """Dialect of the scans; left out, the files tell by themselves."""


class RunEntry(Table):
    """Runs that were measured alike."""

    files: Patterns
    """Raw files, relative to the raw folder: a pattern, or a list of patterns."""
    surface: Text | None = None
    """Name of a [[surface]]."""
    medium: Text | None = None
    """Name of a [medium.*] table."""
    normal_force: Annotated[float, PositiveSi("N", "31 N")] | None = None
    """Set-point of the normal force."""
    sliding_speed: Annotated[float, PositiveSi("m/s", "6 mm/min")] | None = None
    """Set-point of the speed; it is the sliding speed where the files record none."""
    clock_shift: Annotated[float, Si("s", "0.42 s")] | None = None
    """What added to the companion log's clock gives the main log's; else the signals tell."""
    instrument: Text | None = None
    """Name of a dialect, or a dialect's TOML file; left out, the files tell by themselves."""
    zero_uncertainty: Spread | None = None
    """Standard uncertainty of the zero of the friction force, where no stroke or rest tells it."""
    zero: ZeroPlace | None = None
    """Where the zero of the friction signal is read: "first 200 samples", "first 2 s",
    "1.5 s to 3 s", or "file blank.csv", a run without contact in the raw folder."""
    moving_mass: Annotated[float, PositiveSi("kg", "1.2 kg")] | None = None
    """Mass between the contact and the force sensor, whose inertia is taken out of the force."""
    rectified: bool | None = None
    """Whether friction was recorded without its sign; left out, the reversals tell."""
    operator: Text | None = None
    """Who measured these runs: for `tribolab repeatability`, as are the next five."""
    mount: Text | None = None
    """Which mounting of the specimen they belong to."""
    day: Text | None = None
    """Day on which they were measured; by default as the files say."""
    specimen: Text | None = None
    """Which specimen was measured."""
    labels: dict[Text, Text] = {}
    """Whatever else may tell runs apart, e.g. labels.batch = "7"."""
    labels_in_name: LabelPattern | None = None
    """Where such labels stand in a file's name, without its ending: "*_{mount}_{operator}_*"; {}
    stands for letters and digits, * for anything."""
    cycles: bool = False
    """The files are consecutive cycles of one run, not runs of their own."""
    segments: Segments | None = None
    """Overrides of [segments] for these runs."""


class Reference(Table):
    """Runs on a reference sample, by which `tribolab history` tells whether the rig changed."""

    files: Patterns | None = None
    """Their raw files, as in [[run]]."""
    dead_weight: Annotated[float, PositiveSi("N", "19.62 N")] | None = None
    """The weight that loads them, where it is a dead weight: it tells the gain of the force. Put
    on or taken off within a record that need not slide, or lying on during the strokes."""


class Calibration(Table):
    """The last calibration of the instrument, for `tribolab history` and `tribolab pack`."""

    date: dt.date | None = None
    """When it was, e.g. 2026-03-02."""
    interval: Annotated[float, PositiveSi("s", "1 year")] | None = None
    """How long it holds at most."""
    limit: Annotated[float, PositiveSi("1", "2 %")] | None = None
    """How far gain or reference may drift until it wants to be done anew."""
    serial: Text | None = None
    """Serial number of the instrument."""
    certificate: Text | None = None
    """Number or place of the certificate."""


class Qc(Table):
    """When a finding makes the whole run count as failed."""

    fail_on: Literal["suspect", "fail", "never"] = "fail"
    """The mildest finding that gives exit code 1."""
    skip: tuple[Text, ...] = ()
    """Checks on runs and on scans that are left out."""
    limits: dict[Text, dict[Text, float | Text]] = {}
    """Limits of checks by name, e.g. limits.spikes.noise = 10; numbers in SI or with a unit."""

    @property
    def _by_default(self) -> bool:
        return not (self.limits or self.skip)  # then the checks, half a second, need no import

    def run_options(self) -> Arguments:
        """Return limits and names to skip, as far as they are of checks on runs."""
        if self._by_default:
            return {"limits": {}, "skip": ()}
        from tribolab.qc.run.checks import RUN_CHECKS

        return self._of(RUN_CHECKS)

    def scan_options(self) -> Arguments:
        """Return limits and names to skip, as far as they are of checks on scans."""
        if self._by_default:
            return {"limits": {}, "skip": ()}
        from tribolab.qc.scan.checks import SCAN_CHECKS

        return self._of(SCAN_CHECKS)

    def _of(self, checks: Mapping[str, Any]) -> Arguments:
        return {
            "limits": {name: of for name, of in self.limits.items() if name in checks},
            "skip": tuple(name for name in self.skip if name in checks),
        }

    @model_validator(mode="after")
    def _names_are_known(self) -> Self:
        if self._by_default:
            return self
        from tribolab.qc.register import resolve_limits
        from tribolab.qc.run.checks import RUN_CHECKS
        from tribolab.qc.scan.checks import SCAN_CHECKS

        known = RUN_CHECKS | SCAN_CHECKS
        try:
            resolve_limits(known, self.limits)
            for name in self.skip:
                if name not in known:
                    raise ConfigError(f"no check is called '{shown(name)}'{nearest(name, known)}")
        except TribolabError as error:
            raise ValueError(str(error)) from error
        return self


class Campaign(Table):
    """A friction campaign as tribolab analyses it."""

    campaign: About
    contact: Contact = Contact()
    medium: dict[Text, Medium] = {}
    segments: Segments = Segments()
    friction: Friction = Friction()
    roughness: Roughness = Roughness()
    model: Model = Model()
    joint: Joint = Joint()
    rubber: Rubber = Rubber()
    surface: tuple[Surface, ...] = ()
    run: tuple[RunEntry, ...] = ()
    qc: Qc = Qc()
    reference: Reference = Reference()
    calibration: Calibration = Calibration()
    uncertainty: Uncertainty = Uncertainty()

    _file: Path = PrivateAttr(default=Path("campaign.toml"))

    @property
    def file(self) -> Path:
        """The campaign file; all its paths are relative to its folder."""
        return self._file

    def lies_at(self, path: Path) -> None:
        """Say where the campaign file lies: its folders are relative to it."""
        self._file = path

    def quality_options(self, entry: RunEntry) -> Arguments:
        """Return the arguments of `check_run` for a run."""
        options = self.qc.run_options()
        contact = self.contact.whole()
        if contact is not None and entry.normal_force is not None:
            from tribolab.contact.hertz import hertz_half_width

            load = contact.load(entry.normal_force)
            options["contact_width"] = 2 * float(hertz_half_width(load, contact))
        return options

    def scan_quality_options(self) -> Arguments:
        """Return the arguments of `check_scan_set` for the scans of a surface."""
        return self.qc.scan_options()

    def viscosity_of(self, medium: str) -> MediumViscosity | None:
        """Return the viscosity of a medium, stated or from its temperature; None if not known.

        Parameters
        ----------
        medium
            Name of a [medium.*] table.
        """
        table = self.medium.get(medium)
        if table is None:
            return None
        return medium_viscosity(
            table.liquid or medium,
            table.viscosity,
            table.viscosity_range,
            table.temperature,
            table.water_content,
            self.uncertainty,
        )

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
        """Arguments of `friction_coefficient` for the runs of an entry."""
        stated = {"zero_uncertainty": entry.zero_uncertainty, "rectified": entry.rectified}
        known = {key: value for key, value in stated.items() if value is not None}
        return self.friction.model_dump() | known

    def segment_options(self, entry: RunEntry) -> Arguments:
        """Arguments of `find_segments` for the runs of an entry: its own over the campaign's."""
        options = self.segments.model_dump(exclude_none=True)
        if entry.segments is not None:
            options |= entry.segments.model_dump(exclude_unset=True, exclude_none=True)
        return options


def campaign_schema() -> Json:
    """Return the JSON Schema (2020-12) of the campaign file."""
    schema = Campaign.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
