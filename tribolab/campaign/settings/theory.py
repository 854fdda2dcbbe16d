"""Tables of the campaign file that choose what is computed: models, joint fits, rubber friction."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tribolab.campaign.settings.fields import PositiveSi, SomeText
from tribolab.campaign.settings.table import Table


class Model(Table):
    """How the model Stribeck curves beside the measured ones are computed."""

    compute: bool = True
    """Whether they are computed."""
    slowest: Annotated[float, PositiveSi("m/s", "1 nm/s")] = 1e-9
    """Lowest sliding speed."""
    fastest: Annotated[float, PositiveSi("m/s", "10 cm/s")] = 0.1
    """Highest sliding speed."""
    points: Annotated[int, Field(ge=5, le=200)] = 33
    """Number of speeds, evenly over their logarithm."""
    rough_body: Literal["stationary", "moving"] = "stationary"
    """Which body is the rough one: it sets the sign of the shear flow factor."""
    friction_factors: bool = True
    """Whether the fluid's friction takes the friction factors of the roughness."""
    inlet_length: Annotated[float, PositiveSi("m", "20 mm")] | None = None
    """Where the liquid begins, before the contact's middle, and around a ball ends; by default a
    line's is everywhere, and a ball's ends at its radius."""
    outlet: Literal["vented", "flooded"] | None = None
    """Whether gas gets into the gap behind the contact ("vented"), or the liquid holds tension
    there ("flooded"); left out, it is vented, and the band includes both."""
    fit_speeds: (
        tuple[
            Annotated[float, PositiveSi("m/s", "1 um/s")],
            Annotated[float, PositiveSi("m/s", "1 cm/s")],
        ]
        | None
    ) = None
    """Between which speeds the shear stress is fitted; by default all that were measured."""
    adhesion: bool = False
    """Whether the solid contact under the liquid has the area that the medium's work_of_adhesion
    gives it; the shear stresses are then those in that area."""
    uncertainty: Literal["lowest load", "all", "none"] = "lowest load"
    """For which loads of a surface the model's own uncertainty is computed."""

    @model_validator(mode="after")
    def _ends_are_in_order(self) -> Self:
        for low, high, what in (
            (self.slowest, self.fastest, "slowest and fastest"),
            (*(self.fit_speeds or (0.0, 1.0)), "fit_speeds"),
        ):
            if not low < high:
                raise ValueError(f"{what}: {low:g} m/s is not below {high:g} m/s")
        return self


class Joint(Table):
    """How all loads of a surface in one liquid are fitted at once, beside the single fits."""

    compute: Literal["always", "two loads", "never"] = "always"
    """Whether it is done: also of one load, which leaves the exponent of load as assumed; where
    there are two loads or more; or not."""
    together: tuple[SomeText, ...] = ()
    """Surfaces that are also fitted with each other: in one liquid they share its viscosity."""
    dry: SomeText | None = None
    """Medium without liquid whose friction tells beforehand of the shear stress. Works of adhesion
    and their ranges say how much larger the area is in it."""

    @model_validator(mode="after")
    def _are_several(self) -> Self:
        if len(set(self.together)) == 1:
            raise ValueError("together: two surfaces or more are wanted")
        return self


class Rubber(Table):
    """What the friction of the rubber itself is computed with, beside [contact] modulus_file."""

    prony_moduli: tuple[Annotated[float, PositiveSi("Pa", "1 MPa")], ...] = ()
    """Moduli of the relaxations of a Prony series; at rest it has [contact] youngs_modulus."""
    prony_times: tuple[Annotated[float, PositiveSi("s", "1 ms")], ...] = ()
    """Its relaxation times, one for each modulus."""
    temperature: Annotated[float, PositiveSi("K", "40 °C")] | None = None
    """Temperature of the rubber when it slid; modulus_file or the series is shifted to it."""
    reference_temperature: Annotated[float, PositiveSi("K", "20 °C")] | None = None
    """Temperature that modulus_file or the series is for."""
    c1: Annotated[float, Field(gt=0)] | None = None
    """Constant C1 of the law of Williams, Landel and Ferry about the reference temperature."""
    c2: Annotated[float, PositiveSi("K", "51.6 K")] | None = None
    """Constant C2 of that law."""
    adhesion: SomeText | None = None
    """Medium whose work_of_adhesion adds to the contact at every wavenumber; by default none."""

    @model_validator(mode="after")
    def _belong_together(self) -> Self:
        if len(self.prony_moduli) != len(self.prony_times):
            raise ValueError(
                f"prony_times: {len(self.prony_times)} for {len(self.prony_moduli)} prony_moduli; "
                "one for each is wanted"
            )
        shift = ("temperature", "reference_temperature", "c1", "c2")
        missing = [name for name in shift if getattr(self, name) is None]
        if 0 < len(missing) < len(shift):
            raise ValueError(f"{missing[0]}: wanted for the shift of the modulus to a temperature")
        return self
