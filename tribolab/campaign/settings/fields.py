"""Types of the values in a campaign file: texts, patterns, quantities and uncertainties."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import (
    BeforeValidator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    WithJsonSchema,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import core_schema

from tribolab.campaign.settings.name_pattern import NamePattern
from tribolab.core.errors import UnitError, shown
from tribolab.core.untyped import Json
from tribolab.friction.running_in.amount import discard_amount
from tribolab.reading.dialect.zero_reading import parse_zero
from tribolab.units.conversion import to_si

_NUMBER_WITH_UNIT = r"^\s*[+-]?(\d+(?:\.\d*)?|\.\d+)([eE][+-]?\d+)?\s*[^\s\d].*$"


@dataclass(frozen=True)
class Si:
    """Annotation of a quantity: text with a unit in the file, converted to a float in SI.

    Parameters
    ----------
    unit
        SI unit of the float.
    example
        Example of the text in the file.
    """

    unit: str
    example: str

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Return the pydantic schema that converts the text to a float in SI."""
        return core_schema.with_info_before_validator_function(self._converted, handler(source))

    def __get_pydantic_json_schema__(
        self, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the JSON schema of the quantity, for editors."""
        return {
            "type": "string",
            "pattern": _NUMBER_WITH_UNIT,
            "examples": [self.example],
            "unit": self.unit,  # our extension of JSON Schema, as in run.schema.json
        }

    def _converted(self, value: Any, info: core_schema.ValidationInfo[Any]) -> float:
        in_file = bool(info.context and info.context.get("in_file"))
        if in_file and not isinstance(value, str):
            raise ValueError(f"{shown(repr(value))} has no unit; write e.g. {self.example!r}")
        try:
            return to_si(value, self.unit, name="")
        except UnitError as error:
            text = f"{str(error).removeprefix(': ')} (e.g. {self.example!r})"
            raise ValueError(text) from error


class PositiveSi(Si):
    """Annotation of a quantity that is greater than zero."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Return the pydantic schema that refuses zero and negative values."""
        converted = super().__get_pydantic_core_schema__(source, handler)
        return core_schema.no_info_after_validator_function(_positive, converted)


def _positive(value: float) -> float:
    if not value > 0:
        raise ValueError(f"{value:g} is not greater than zero")
    return value


SomeText = Annotated[str, Field(min_length=1)]
Patterns = Annotated[
    tuple[SomeText, ...],
    BeforeValidator(lambda value: (value,) if isinstance(value, str) else value),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "minLength": 1},
                {"type": "array", "items": {"type": "string", "minLength": 1}, "minItems": 1},
            ]
        }
    ),
]


def _name_pattern(value: Any) -> Any:
    """Check that a pattern contains at least one label."""
    if isinstance(value, str):
        try:
            NamePattern(value)
        except ValueError as error:
            raise ValueError(f"{shown(repr(value))}: {error}") from error
    return value


LabelPattern = Annotated[SomeText, BeforeValidator(_name_pattern), Field(examples=["*_{mount}_*"])]


def _share(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    try:
        return to_si(value, "1", name="")
    except UnitError as error:
        raise ValueError(f"{shown(repr(value))} is no share; write e.g. 0.1 or '10 %'") from error


def _number_or_text(example: str, **limits: float) -> WithJsonSchema:
    text: Json = {"type": "string", "pattern": _NUMBER_WITH_UNIT, "examples": [example]}
    return WithJsonSchema({"anyOf": [{"type": "number", **limits}, text]})


# fraction below one half: it is cut off at both ends
ShareOfEnds = Annotated[
    float,
    Field(ge=0, lt=0.5),
    BeforeValidator(_share),
    _number_or_text("10 %", minimum=0, exclusiveMaximum=0.5),
]


# fraction of a stroke, up to 1
MiddleShare = Annotated[
    float,
    Field(gt=0, le=1),
    BeforeValidator(_share),
    _number_or_text("40 %", exclusiveMinimum=0, maximum=1),
]


# mass fraction, up to 1
ShareOfMass = Annotated[
    float,
    Field(ge=0, le=1),
    BeforeValidator(_share),
    _number_or_text("1 %", minimum=0, maximum=1),
]


def _place(value: Any) -> str:
    """Check the text that states where the zero is read."""
    try:
        parse_zero(str(value))
    except UnitError as error:
        raise ValueError(str(error)) from error
    return str(value)


ZeroPlace = Annotated[str, BeforeValidator(_place), Field(examples=["first 2 s"])]


def _discard(value: Any) -> str:
    """Check the text that states how much of the start of a run is left out."""
    try:
        discard_amount(str(value))
    except UnitError as error:
        raise ValueError(str(error)) from error
    return str(value)


Discard = Annotated[str, BeforeValidator(_discard), Field(examples=["50 m", "60 s", "100 cycles"])]


def _spread(value: Any) -> str:
    """Check an uncertainty: of a force, a torque, or a recorded friction coefficient."""
    if isinstance(value, str):
        for unit in ("N", "1", "N m"):
            with contextlib.suppress(UnitError):
                if to_si(value, unit, name="") >= 0:
                    return value
    raise ValueError(
        f"{shown(repr(value))} is no force, torque or pure number; write e.g. '0.2 N', '5 N mm' or "
        "'2 %'"
    )


# stays text, because its unit depends on the signal to which it applies
Spread = Annotated[
    str,
    BeforeValidator(_spread),
    WithJsonSchema(
        {"type": "string", "pattern": _NUMBER_WITH_UNIT, "examples": ["0.2 N", "5 N mm", "2 %"]}
    ),
]
