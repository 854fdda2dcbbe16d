"""Validation of texts in a dialect, and base classes of its rules."""

from __future__ import annotations

import codecs
import re
from collections.abc import Callable
from typing import Annotated, Any, Literal, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationInfo, field_validator

from tribolab.core.errors import TribolabError, shown
from tribolab.reading.dialect.formula import parse_formula
from tribolab.reading.dialect.zero_reading import parse_zero
from tribolab.reading.text.bounded_patterns import PatternError, guarded
from tribolab.units.conversion import conversion
from tribolab.units.quantities import quantity
from tribolab.units.reciprocals import Counted


def _is_pattern(text: str) -> str:
    try:
        guarded(text)
    except PatternError as error:
        raise ValueError(f"'{shown(text)}' is not a regular expression: {error}") from error
    return text


def _is_encoding(text: str) -> str:
    try:
        codecs.lookup(text)
    except LookupError as error:
        raise ValueError(
            f"'{shown(text)}' is not an encoding; write e.g. 'utf-8' or 'latin-1'"
        ) from error
    return text


def _is_field(text: str) -> str:
    name, _, kind = text.strip().rpartition(" ")
    if not name.strip() or not _BINARY_TYPE.fullmatch(kind):
        raise ValueError(f"'{shown(text)}' is not a name and a type, e.g. 'Fx <f4'")
    return text


_RULE = 'symbol = "{0}" in its [[column]], and [[derived]] quantity = "{1}", formula as "{2}"'
_INSTEAD = {
    "torque": _RULE.format("torque", "friction_force", "torque / '20 mm'"),
    "angle": _RULE.format("angle", "position", "angle * '20 mm'"),
    "turns": _RULE.format("turns", "position", "2 * pi * turns * '20 mm'"),
    "strain": _RULE.format("strain", "friction_force", "strain * '5 kN'"),
    "counts": _RULE.format("counts", "friction_force", "counts * '0.5 mN'"),
    "radius": _RULE.format("radius", "sliding_velocity", "rotation_speed * radius"),
    "stress": 'quantity = "shear_stress" or "normal_stress"',
}
_SYNONYMS = {
    **dict.fromkeys(("moment", "couple", "drehmoment"), "torque"),
    **dict.fromkeys(("laps", "lap", "revolutions", "rotations", "revs"), "turns"),
    **dict.fromkeys(("digits", "adc", "bits", "raw", "count"), "counts"),
    **dict.fromkeys(("bridge", "deformation"), "strain"),
}


def _is_quantity(name: str) -> object:
    """Raise if a name is not a quantity; the message states how to derive one."""
    try:
        return quantity(name)
    except TribolabError as error:
        words = [_SYNONYMS.get(word, word) for word in name.lower().split("_")]
        rule = next((_INSTEAD[word] for word in words if word in _INSTEAD), None)
        if rule is None:
            raise
        raise TribolabError(f"no quantity is called '{shown(name)}': say {rule}") from error


def _validator(check: Callable[[str], object]) -> AfterValidator:
    """Return a validator that reports errors of a check as errors of the dialect."""

    def validated(text: str) -> str:
        try:
            check(text)
        except TribolabError as error:
            raise ValueError(str(error)) from error
        return text

    return AfterValidator(validated)


_BINARY_TYPE = re.compile(r"[<>|=]?[fiu][1248]")
Pattern = Annotated[str, AfterValidator(_is_pattern)]
Encoding = Annotated[str, AfterValidator(_is_encoding)]
BinaryField = Annotated[str, AfterValidator(_is_field)]
QuantityName = Annotated[str, _validator(_is_quantity)]
Formula = Annotated[str, _validator(parse_formula)]
ZeroText = Annotated[str, _validator(parse_zero)]
Symbol = Annotated[str, Field(pattern=r"^[A-Za-z_]\w*$")]
Sign = Literal[1, -1]


class NoSwitches(BaseModel):
    """Base model that rejects true and false where a number or a text is expected.

    Examples
    --------
    >>> class Rule(NoSwitches):
    ...     share: float = 1.0
    ...     optional: bool = False
    >>> Rule(share=0.5, optional=True)
    Rule(share=0.5, optional=True)
    """

    @field_validator("*", mode="before")
    @classmethod
    def _no_switch(cls, value: Any, info: ValidationInfo) -> Any:
        held = value if isinstance(value, list | tuple) else [value]
        switches = [item for item in held if isinstance(item, bool)]
        if switches and not _takes_switch(cls.model_fields[str(info.field_name)].annotation):
            told = str(switches[0]).lower()
            raise ValueError(f"{told} stands where a number or a text belongs")
        return value


def _takes_switch(annotation: Any) -> bool:
    return annotation is bool or any(_takes_switch(part) for part in get_args(annotation))


class Strict(NoSwitches):
    """Base class of the rules: frozen, unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)


def check_unit(unit: str, si_unit: str, bare: Counted | None = None) -> None:
    """Raise if a unit cannot be converted to another."""
    try:
        conversion(unit, si_unit, bare)
    except TribolabError as error:
        raise ValueError(str(error)) from error
