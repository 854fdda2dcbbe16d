"""Tables of the campaign file that say what was measured: contact, media, surfaces, runs."""

from __future__ import annotations

import datetime as dt
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from tribolab.campaign.settings.analysed import Segments
from tribolab.campaign.settings.fields import (
    LabelPattern,
    Patterns,
    PositiveSi,
    ShareOfMass,
    Si,
    SomeText,
    Spread,
    ZeroPlace,
)
from tribolab.campaign.settings.table import Table
from tribolab.core.untyped import Arguments

if TYPE_CHECKING:
    from tribolab.contact.geometry import LineContact, PointContact


class Contact(Table):
    """The cylinder or ball and the elastomer, as far as they are known."""

    geometry: Literal["cylinder", "ball"] = "cylinder"
    """Which body is pressed on the flat."""
    radius: Annotated[float, PositiveSi("m", "7 cm")] | None = None
    """Radius of the cylinder or ball."""
    length: Annotated[float, PositiveSi("m", "10 cm")] | None = None
    """Length of the line contact; a ball has none."""
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
    thickness: Annotated[float, PositiveSi("m", "5 mm")] | None = None
    """Thickness of the elastomer, bonded to a rigid base; by default it is a half-space."""
    counter_modulus: Annotated[float, PositiveSi("Pa", "2 MPa")] | None = None
    """Young's modulus of the cylinder or ball; by default it is rigid."""
    counter_poisson_ratio: Annotated[float, Field(gt=-1, le=0.5)] | None = None
    """Poisson's ratio of the cylinder or ball."""
    area: Literal["persson", "corrected", "numerics"] = "persson"
    """Theory of the contact area: Persson's as in the paper; corrected for the elastic energy that
    partial contact saves; or as fitted to boundary elements."""
    normal_forces: tuple[Annotated[float, PositiveSi("N", "31 N")], ...] = ()
    """Normal forces at which contact and adhesion are computed, beside those of the runs."""
    modulus_file: SomeText | None = None
    """Storage and loss modulus over frequency (DMA, rheometer), relative to the raw folder."""
    sweep: int | SomeText | None = None
    """Which sweep of `modulus_file`, if it holds several: its number from 0, or "25 C"."""
    modulus_unit: SomeText | None = None
    """Unit of the moduli in `modulus_file`, if the file does not state it."""

    def bodies(self) -> Arguments:
        """Return the arguments of `make_contact`; None for what is wanted and not known."""
        ball = self.geometry == "ball"
        wanted = {"radius", "youngs_modulus", "poisson_ratio"} | (set() if ball else {"length"})
        bodies = self.model_dump(include=wanted)
        optional = {"thickness", "counter_modulus", "counter_poisson_ratio"}
        bodies |= self.model_dump(include=optional, exclude_none=True)
        return bodies | ({"geometry": "ball"} if ball else {})

    def whole(self) -> LineContact | PointContact | None:
        """Return the contact; None as long as something of it is not known."""
        # late: starting stays quick
        from tribolab.contact.geometry import make_contact

        bodies = self.bodies()
        return None if None in bodies.values() else make_contact(**bodies)


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
    liquid: SomeText | None = None
    """What it is, where the table's name does not say it: "silicone oil 350 cSt"."""


class Surface(Table):
    """One surface and its topography scans."""

    name: SomeText
    """What it is called in the [[run]] tables and in the report."""
    scans: Patterns | None = None
    """Profilometer files, relative to the raw folder."""
    instrument: SomeText | None = None
    """Dialect of the scans; left out, the files tell by themselves."""


class RunEntry(Table):
    """Runs that were measured alike."""

    files: Patterns
    """Raw files, relative to the raw folder: a pattern, or a list of patterns."""
    surface: SomeText | None = None
    """Name of a [[surface]]."""
    medium: SomeText | None = None
    """Name of a [medium.*] table."""
    normal_force: Annotated[float, PositiveSi("N", "31 N")] | None = None
    """Set-point of the normal force; it is the load where the files record none, and left out, the
    measured load tells which runs are under the same."""
    sliding_speed: Annotated[float, PositiveSi("m/s", "6 mm/min")] | None = None
    """Set-point of the speed; it is the sliding speed where the files record none."""
    clock_shift: Annotated[float, Si("s", "0.42 s")] | None = None
    """What added to the companion log's clock gives the main log's; else the signals tell."""
    instrument: SomeText | None = None
    """Name of a dialect, or a dialect's TOML file; left out, the files tell by themselves."""
    zero_uncertainty: Spread | None = None
    """Standard uncertainty of the zero of the friction signal, where no stroke or rest tells it: a
    force, a torque where one was measured, or a pure number of a coefficient."""
    zero: ZeroPlace | None = None
    """Where the zero of the friction signal is read: "first 200 samples", "first 2 s",
    "1.5 s to 3 s", or "file blank.csv", a run without contact in the raw folder."""
    moving_mass: Annotated[float, PositiveSi("kg", "1.2 kg")] | None = None
    """Mass between the contact and the force sensor, whose inertia is taken out of the force."""
    stiffness: Annotated[float, PositiveSi("N/m", "12 kN/m")] | None = None
    """Stiffness of the rig between drive and contact, in the direction of sliding: stick-slip says
    how far it is from the critical stiffness."""
    rectified: bool | None = None
    """Whether friction was recorded without its sign; left out, the reversals tell."""
    operator: SomeText | None = None
    """Who measured these runs: for `tribolab lab repeatability`, as are the next five."""
    mount: SomeText | None = None
    """Which mounting of the specimen they belong to."""
    day: SomeText | None = None
    """Day on which they were measured; by default as the files say."""
    specimen: SomeText | None = None
    """Which specimen was measured."""
    labels: dict[SomeText, SomeText] = {}
    """Whatever else may tell runs apart, e.g. labels.batch = "7"."""
    labels_in_name: LabelPattern | None = None
    """Where such labels stand in a file's name, without its ending: "*_{mount}_{operator}_*"; {}
    stands for letters and digits, * for anything."""
    cycles: bool = False
    """The files are consecutive cycles of one run, not runs of their own."""
    segments: Segments | None = None
    """Overrides of [segments] for these runs."""


class Reference(Table):
    """Runs on a reference sample, by which `tribolab lab history` tells whether the rig changed."""

    files: Patterns | None = None
    """Their raw files, as in [[run]]."""
    dead_weight: Annotated[float, PositiveSi("N", "19.62 N")] | None = None
    """The weight that loads them, where it is a dead weight: it tells the gain of the force. Put
    on or taken off within a record that need not slide, or lying on during the strokes."""


class CalibrationTable(Table):
    """The last calibration of the instrument, for `tribolab lab history` and `tribolab pack`."""

    date: dt.date | None = None
    """When it was, e.g. 2026-03-02."""
    interval: Annotated[float, PositiveSi("s", "1 year")] | None = None
    """How long it holds at most."""
    limit: Annotated[float, PositiveSi("1", "2 %")] | None = None
    """How far gain or reference may drift until it wants to be done anew."""
    serial: SomeText | None = None
    """Serial number of the instrument."""
    certificate: SomeText | None = None
    """Number or place of the certificate."""
