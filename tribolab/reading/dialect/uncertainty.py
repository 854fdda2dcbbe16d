"""Uncertainty of calibration, mount and medium: the tables [uncertainty.NAME]."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import AfterValidator, Field, model_validator

from tribolab.core.errors import TribolabError, UnitError, shown
from tribolab.core.untyped import Json
from tribolab.reading.dialect.checked_text import Strict
from tribolab.units.conversion import conversion, to_si

Distribution = Literal["standard", "expanded", "half-width", "triangular", "step"]
Varies = Literal["calibration", "mount", "run", "stroke"]

# divisor of a stated value (JCGM 100:2008, 4.3); "expanded" states its own factor
_DIVISOR = {"standard": 1.0, "half-width": 3**0.5, "triangular": 6**0.5, "step": 12**0.5}


class Known(NamedTuple):
    """Standard uncertainty for a budget.

    Parameters
    ----------
    standard
        Standard uncertainty, in the SI unit given for its name in `NAMES`.
    dof
        Its degrees of freedom.
    varies
        Level at which its value changes: calibration, mount, run or stroke.
    distribution
        How it was stated: as standard or expanded uncertainty, half-width, triangular or step.
    source
        Source of the statement.
    """

    standard: float
    dof: float
    varies: str
    distribution: str
    source: str


class StatedUncertainty(Strict):
    """One uncertainty, as a certificate, a data sheet or a measurement states it."""

    value: str = Field(
        min_length=1, examples=["0.2 %"], description="Size of the uncertainty, with its unit."
    )
    kind: Distribution = Field(
        alias="as",
        description="Kind: standard uncertainty, expanded uncertainty (`k`), half-width "
        "of a rectangular or triangular distribution, or step of a digital reading.",
    )
    k: Annotated[float, Field(gt=0)] | None = Field(
        None, description='Coverage factor, with `as = "expanded"`.'
    )
    dof: Annotated[float, Field(ge=1)] | None = Field(
        None,
        description="Degrees of freedom of the value; default: infinite.",
    )
    varies: Varies | None = Field(
        None,
        description="What changes its value. Contributions that vary with run or mount are not "
        "added again if repeats include them. Default: by NAME.",
    )
    source: str | None = Field(
        None, description="Source of the value: certificate, data sheet, date."
    )
    full_scale: Annotated[str, Field(min_length=1, examples=["100 N"])] | None = Field(
        None,
        description="Full scale to which a value in per cent refers (linearity of a channel).",
    )

    @model_validator(mode="after")
    def _factor_is_stated(self) -> Self:
        if (self.kind == "expanded") != (self.k is not None):
            raise ValueError('as = "expanded" and k = 2 (or what the certificate says) go together')
        return self

    def size(self, unit: str) -> float:
        """Return the stated value in an SI unit.

        Raises
        ------
        UnitError
            If it is not a number with such a unit, or is negative.
        """
        if self.full_scale is not None:
            if unit != "N":
                raise UnitError(
                    "value: full_scale belongs to the linearity of a force channel only"
                )
            return _difference(self.value, "1") * _difference(self.full_scale, "N")
        if unit == "N" and self.value.strip().endswith("%"):
            raise UnitError('value: a share of what? add full_scale = "100 N" to it')
        return _difference(self.value, unit)

    def known(self, unit: str, usual: str) -> Known:
        """Return the standard uncertainty in an SI unit, with the usual level if none is stated."""
        divisor = _DIVISOR.get(self.kind, self.k or 1.0)
        return Known(
            self.size(unit) / divisor,
            math.inf if self.dof is None else self.dof,
            self.varies or usual,
            self.kind,
            self.source or "",
        )


def _difference(text: str, unit: str) -> float:
    """Return an uncertainty in an SI unit; a temperature is a difference, without offset."""
    size = to_si(text, unit, name="value")
    if unit == "K":
        size -= conversion(text.strip().lstrip("+-.0123456789eE "), unit)[1]
    if size < 0:
        raise UnitError(f"value: {shown(repr(text))} is below zero; an uncertainty is not")
    return size


def _in(unit: str) -> Callable[[StatedUncertainty], StatedUncertainty]:
    def checked(stated: StatedUncertainty) -> StatedUncertainty:
        try:
            stated.size(unit)
        except TribolabError as error:
            raise ValueError(str(error)) from error
        return stated

    return checked


_Relative = Annotated[StatedUncertainty, AfterValidator(_in("1"))] | None
_Angle = Annotated[StatedUncertainty, AfterValidator(_in("rad"))] | None
_Force = Annotated[StatedUncertainty, AfterValidator(_in("N"))] | None
_Difference = Annotated[StatedUncertainty, AfterValidator(_in("K"))] | None

# SI unit of each name, and the level at which it varies by default
NAMES: dict[str, tuple[str, Varies]] = {
    "friction_gain": ("1", "calibration"),
    "normal_gain": ("1", "calibration"),
    "friction_linearity": ("N", "calibration"),
    "normal_linearity": ("N", "calibration"),
    "tilt": ("rad", "mount"),
    "yaw": ("rad", "mount"),
    "cross_talk_friction_from_normal": ("1", "calibration"),
    "cross_talk_normal_from_friction": ("1", "calibration"),
    "friction_zero": ("N", "run"),
    "normal_zero": ("N", "run"),
    "zero_drift": ("N", "stroke"),
    "resolution": ("N", "stroke"),
    "temperature": ("K", "run"),
    "water_content": ("1", "calibration"),
    "speed": ("1", "calibration"),
    "load": ("1", "calibration"),
    "radius": ("1", "calibration"),
    "youngs_modulus": ("1", "calibration"),
}

# model inputs; the last two affect the liquid's viscosity
MODEL_INPUTS = ("speed", "load", "radius", "youngs_modulus", "temperature", "water_content")


class Uncertainty(Strict):
    """Uncertainties of the instrument, the mount and the medium."""

    friction_gain: _Relative = Field(
        None, description='Gain of the friction channel, relative: "0.2 %".'
    )
    normal_gain: _Relative = Field(None, description="Gain of the normal force channel, relative.")
    friction_linearity: _Force = Field(
        None,
        description='Linearity and hysteresis of the friction channel ("class"): "0.1 %" of '
        "full_scale, or N.",
    )
    normal_linearity: _Force = Field(
        None, description="Linearity and hysteresis of the normal force channel."
    )
    tilt: _Angle = Field(
        None,
        description="Angle between the force cell and the contact, in the plane of sliding: "
        '"0.5 deg".',
    )
    yaw: _Angle = Field(
        None,
        description="Angle between the friction axis and the direction of sliding, in the plane of "
        "contact.",
    )
    cross_talk_friction_from_normal: _Relative = Field(
        None, description="Fraction of the normal force in the friction channel."
    )
    cross_talk_normal_from_friction: _Relative = Field(
        None, description="Fraction of the friction force in the normal force channel."
    )
    friction_zero: _Force = Field(
        None, description="Zero of the friction channel, if the run does not determine it."
    )
    normal_zero: _Force = Field(
        None, description="Zero of the normal force channel, if the run does not determine it."
    )
    zero_drift: _Force = Field(
        None, description="Drift of the zero of the friction channel between two strokes."
    )
    resolution: _Force = Field(
        None, description='Resolution of the friction channel; `as = "step"` for one count.'
    )
    temperature: _Difference = Field(
        None, description='Temperature of the medium, as a difference: "0.5 K".'
    )
    water_content: _Relative = Field(
        None, description='Mass fraction of water in the medium, absolute: "0.5 %" of the mass.'
    )
    speed: _Relative = Field(None, description="Sliding speed, relative.")
    load: _Relative = Field(None, description="Normal force for the model, relative.")
    radius: _Relative = Field(None, description="Radius of the cylinder, relative.")
    youngs_modulus: _Relative = Field(
        None, description="Young's modulus of the elastomer, relative."
    )

    def plain(self) -> Json:
        """Return the stated uncertainties for attributes of runs: by name, in SI."""
        return {
            name: stated.known(*NAMES[name])._asdict()
            for name in NAMES
            if (stated := getattr(self, name)) is not None
        }
