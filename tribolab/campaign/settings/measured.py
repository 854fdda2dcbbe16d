"""Tables of the campaign file on what was measured: contact, media, surfaces, runs."""

from __future__ import annotations

import datetime as dt
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from tribolab.campaign.settings.analysed import Segments
from tribolab.campaign.settings.fields import (
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
    """The cylinder or ball, and the elastomer. State what you know."""

    geometry: Literal["cylinder", "ball"] = "cylinder"
    """Shape of the body pressed on the flat."""
    radius: Annotated[float, PositiveSi("m", "7 cm")] | None = None
    """Radius of the cylinder or ball."""
    length: Annotated[float, PositiveSi("m", "10 cm")] | None = None
    """Length of the line contact (not for a ball)."""
    youngs_modulus: Annotated[float, PositiveSi("Pa", "1.5 MPa")] | None = None
    """Young's modulus of the elastomer at low frequency."""
    youngs_modulus_range: (
        tuple[
            Annotated[float, PositiveSi("Pa", "1.35 MPa")],
            Annotated[float, PositiveSi("Pa", "1.65 MPa")],
        ]
        | None
    ) = None
    """Uncertainty range; contributes to the band of the model curves."""
    poisson_ratio: Annotated[float, Field(gt=-1, le=0.5)] | None = None
    """Poisson's ratio of the elastomer."""
    thickness: Annotated[float, PositiveSi("m", "5 mm")] | None = None
    """Thickness of the elastomer, bonded to a rigid base; default: a half-space."""
    counter_modulus: Annotated[float, PositiveSi("Pa", "2 MPa")] | None = None
    """Young's modulus of the cylinder or ball; default: rigid."""
    counter_poisson_ratio: Annotated[float, Field(gt=-1, le=0.5)] | None = None
    """Poisson's ratio of the cylinder or ball."""
    modulus_file: SomeText | None = None
    """File of storage and loss modulus over frequency, relative to the raw folder."""
    sweep: int | SomeText | None = None
    """Sweep of `modulus_file`, if it contains several: number from 0, or "25 C"."""
    modulus_unit: SomeText | None = None
    """Unit of the moduli in `modulus_file`, if the file does not state it."""

    def bodies(self) -> Arguments:
        """Return the arguments of `make_contact`; required ones that are unknown are None."""
        ball = self.geometry == "ball"
        wanted = {"radius", "youngs_modulus", "poisson_ratio"} | (set() if ball else {"length"})
        bodies = self.model_dump(include=wanted)
        optional = {"thickness", "counter_modulus", "counter_poisson_ratio"}
        bodies |= self.model_dump(include=optional, exclude_none=True)
        return bodies | ({"geometry": "ball"} if ball else {})

    def whole(self) -> LineContact | PointContact | None:
        """Return the contact; None if a required property is unknown."""
        from tribolab.contact.geometry import make_contact  # imported late for a quick start

        bodies = self.bodies()
        return None if None in bodies.values() else make_contact(**bodies)


class Medium(Table):
    """The medium between the surfaces. State what you know."""

    viscosity: Annotated[float, PositiveSi("Pa s", "1.4 Pa s")] | None = None
    """Dynamic viscosity."""
    viscosity_range: (
        tuple[
            Annotated[float, PositiveSi("Pa s", "1.2 Pa s")],
            Annotated[float, PositiveSi("Pa s", "1.6 Pa s")],
        ]
        | None
    ) = None
    """Uncertainty range; contributes to the band of the model curves."""
    work_of_adhesion: Annotated[float, Si("J/m2", "51 mJ/m^2")] | None = None
    """Work of adhesion of the surfaces in this medium."""
    work_of_adhesion_range: (
        tuple[Annotated[float, Si("J/m2", "21 mJ/m^2")], Annotated[float, Si("J/m2", "59 mJ/m^2")]]
        | None
    ) = None
    """Uncertainty range; gives bounds on the contact areas."""
    temperature: Annotated[float, PositiveSi("K", "20 °C")] | None = None
    """Temperature of the measurement. Gives the viscosity of "glycerol", "water" and "silicone oil
    1000 cSt" (any grade) if none is stated. Models use the viscosity at the recorded temperature,
    if the runs have one."""
    viscosity_per_kelvin: Annotated[float, Si("1/K", "8.6 %/K")] | None = None
    """Relative decrease of the viscosity per kelvin, for a liquid that is not known by name."""
    flow_curve: SomeText | None = None
    """File of viscosity over shear rate (rheometer), relative to the raw folder, for a
    shear-thinning liquid. The viscosity at the lowest rate is used as that at rest."""
    water_content: ShareOfMass | None = None
    """Mass fraction of water in glycerol."""
    liquid: SomeText | None = None
    """Liquid, if it differs from the table's name: "silicone oil 350 cSt"."""


class Surface(Table):
    """One surface and its topography scans."""

    name: SomeText
    """Name of the surface in the [[run]] tables and in the report."""
    scans: Patterns | None = None
    """Profilometer files, relative to the raw folder."""
    instrument: SomeText | None = None
    """Dialect of the scans; default: recognised from the files."""


class RunEntry(Table):
    """Runs under the same conditions."""

    files: Patterns
    """Raw files, relative to the raw folder: a pattern, or a list of patterns."""
    surface: SomeText | None = None
    """Name of a [[surface]]."""
    medium: SomeText | None = None
    """Name of a [medium.*] table."""
    contact: SomeText | None = None
    """Name of a [contact.*] table; default: [contact]."""
    normal_force: Annotated[float, PositiveSi("N", "31 N")] | None = None
    """Set-point of the normal force; used as the load if the files record none. Default: runs are
    grouped by measured load."""
    sliding_speed: Annotated[float, PositiveSi("m/s", "6 mm/min")] | None = None
    """Set-point of the speed; used as the sliding speed if the files record none."""
    clock_shift: Annotated[float, Si("s", "0.42 s")] | None = None
    """Time to add to the clock of the companion log; default: estimated from the signals."""
    instrument: SomeText | None = None
    """Name or TOML file of a dialect; default: recognised from the files."""
    zero_uncertainty: Spread | None = None
    """Standard uncertainty of the zero of the friction signal, if neither strokes nor rests
    determine it: a force, a torque (if measured), or a number (if a coefficient was recorded)."""
    zero: ZeroPlace | None = None
    """Interval in which the zero of the friction signal is read: "first 200 samples", "first 2 s",
    "1.5 s to 3 s", or "file blank.csv", a run without contact in the raw folder."""
    moving_mass: Annotated[float, PositiveSi("kg", "1.2 kg")] | None = None
    """Mass between contact and force sensor (next release: in the instrument's file only)."""
    stiffness: Annotated[float, PositiveSi("N/m", "12 kN/m")] | None = None
    """Stiffness of the rig between drive and contact, in the direction of sliding; compared with
    the critical stiffness for stick-slip."""
    contact_area: Annotated[float, PositiveSi("m2", "12 mm^2")] | None = None
    """Measured contact area (camera), if the files do not record it; its shear stress is shown next
    to that of the theory."""
    rectified: bool | None = None
    """Whether friction was recorded without its sign (next release: in the instrument's file)."""
    labels: dict[SomeText, SomeText] = {}
    """Labels for `tribolab lab repeatability`, e.g. { operator = "Ann", mount = "2" }. Default of
    `day`: from the files."""
    cycles: bool = False
    """Whether the files are consecutive cycles of one run instead of separate runs."""
    segments: Segments | None = None
    """Overrides of [segments] for these runs."""


class Reference(Table):
    """Runs on a reference sample: `tribolab lab history` uses them to detect changes of the rig."""

    files: Patterns | None = None
    """Raw files, as in [[run]]."""
    dead_weight: Annotated[float, PositiveSi("N", "19.62 N")] | None = None
    """Dead weight that applies the load, for the gain of the normal force: put on or removed during
    a record (sliding is not necessary), or present during the strokes."""


class CalibrationTable(Table):
    """The last calibration of the instrument, for `tribolab lab history` and `tribolab pack`."""

    date: dt.date | None = None
    """Date, e.g. 2026-03-02."""
    interval: Annotated[float, PositiveSi("s", "1 year")] | None = None
    """Calibration interval."""
    limit: Annotated[float, PositiveSi("1", "2 %")] | None = None
    """Drift of gain or reference at which a new calibration is due."""
    serial: SomeText | None = None
    """Serial number of the instrument."""
    certificate: SomeText | None = None
    """Number or location of the certificate."""
