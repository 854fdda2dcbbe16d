"""Tables of the campaign file on the theory: models and rubber friction."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tribolab.campaign.settings.fields import PositiveSi, SomeText
from tribolab.campaign.settings.table import Table


class Model(Table):
    """Model Stribeck curves for comparison with the measured ones."""

    compute: bool = True
    """Whether to compute them."""
    slowest: Annotated[float, PositiveSi("m/s", "1 nm/s")] = 1e-9
    """Lowest sliding speed."""
    fastest: Annotated[float, PositiveSi("m/s", "10 cm/s")] = 0.1
    """Highest sliding speed."""
    points: Annotated[int, Field(ge=5, le=200)] = 33
    """Number of speeds, logarithmically spaced."""
    rough_body: Literal["stationary", "moving"] = "stationary"
    """Which body is rough; it determines the sign of the shear flow factor."""
    friction_factors: bool = True
    """Whether the friction factors of the roughness apply to the friction of the liquid."""
    inlet_length: Annotated[float, PositiveSi("m", "20 mm")] | None = None
    """Distance from the contact centre at which the liquid begins (for a ball: ends). Default:
    unlimited for a line contact, the radius for a ball."""
    outlet: Literal["vented", "flooded"] | None = None
    """Whether gas enters the gap behind the contact ("vented") or the liquid sustains tension there
    ("flooded"). Default: vented, with both in the uncertainty band."""
    fit_speeds: (
        tuple[
            Annotated[float, PositiveSi("m/s", "1 um/s")],
            Annotated[float, PositiveSi("m/s", "1 cm/s")],
        ]
        | None
    ) = None
    """Speed range for the fit of the shear stress; default: all measured speeds."""
    adhesion: bool = False
    """Whether adhesion (the medium's work_of_adhesion) increases the solid contact area in the
    liquid; fitted shear stresses then refer to that area."""
    area: Literal["persson", "corrected", "numerics"] = "persson"
    """Theory of the contact area: Persson's original theory; corrected for the lower elastic energy
    of partial contact; or fitted to boundary elements."""
    normal_forces: tuple[Annotated[float, PositiveSi("N", "31 N")], ...] = ()
    """Additional normal forces for contact and adhesion; those of the runs are included."""
    joint: bool = True
    """Whether to fit all loads of a surface in one liquid jointly, in addition to the single fits.
    With one load the load exponent keeps its prior."""
    together: tuple[SomeText, ...] = ()
    """Surfaces to fit together; in one liquid they share its viscosity."""
    dry_medium: SomeText | None = None
    """Medium without liquid whose friction constrains the shear stress in the joint fit. The works
    of adhesion and their ranges determine the larger dry contact area."""
    uncertainty: Literal["lowest load", "all", "none"] = "lowest load"
    """Loads of a surface for which the model uncertainty is computed."""

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        for low, high, what in (
            (self.slowest, self.fastest, "slowest and fastest"),
            (*(self.fit_speeds or (0.0, 1.0)), "fit_speeds"),
        ):
            if not low < high:
                raise ValueError(f"{what}: {low:g} m/s is not below {high:g} m/s")
        if len(set(self.together)) == 1:
            raise ValueError("together: two surfaces or more are wanted")
        return self


class Rubber(Table):
    """Input for the rubber hysteresis, in addition to modulus_file in [contact]."""

    prony_moduli: tuple[Annotated[float, PositiveSi("Pa", "1 MPa")], ...] = ()
    """Moduli of a Prony series; its static modulus is youngs_modulus in [contact]."""
    prony_times: tuple[Annotated[float, PositiveSi("s", "1 ms")], ...] = ()
    """Relaxation times of the Prony series, one for each modulus."""
    temperature: Annotated[float, PositiveSi("K", "40 °C")] | None = None
    """Rubber temperature during sliding; the modulus is shifted to it."""
    reference_temperature: Annotated[float, PositiveSi("K", "20 °C")] | None = None
    """Temperature at which modulus_file or the Prony series is valid."""
    c1: Annotated[float, Field(gt=0)] | None = None
    """Constant C1 of the Williams-Landel-Ferry equation at the reference temperature."""
    c2: Annotated[float, PositiveSi("K", "51.6 K")] | None = None
    """Constant C2 of the Williams-Landel-Ferry equation."""
    adhesion: SomeText | None = None
    """Medium whose work_of_adhesion increases the contact at every wavenumber; default: none."""

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
