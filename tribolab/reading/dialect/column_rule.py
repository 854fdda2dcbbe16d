"""Rules of a dialect for one column, and for one value outside the table."""

from __future__ import annotations

import contextlib
import re
from typing import Literal, Self

from pydantic import Field, PositiveInt, model_validator

from tribolab.core.errors import TribolabError, nearest, shown
from tribolab.reading.dialect.checked_text import (
    Pattern,
    QuantityName,
    Sign,
    Strict,
    Symbol,
    ZeroText,
    check_unit,
)
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.units.conversion import base_unit, conversion, to_si
from tribolab.units.quantities import QUANTITIES, quantity
from tribolab.units.reciprocals import Counted, reciprocal
from tribolab.units.spellings import plain_unit

_TURNING = {"cycles": "Hz", "radians": "rad/s"}
FRICTION_SIGNALS = ("friction_force", "friction_coefficient")  # signals whose zero can be stated


class Column(Strict):
    """Quantity of a column: value in SI = sign * (scale * x + offset) * unit."""

    quantity: QuantityName | None = None
    symbol: Symbol | None = Field(
        None, description="instead of a quantity: your own name, for formulas of [[derived]]"
    )
    name: str | None = Field(None, description="name in the header without its unit")
    name_pattern: Pattern | None = Field(
        None, description="instead of a name: pattern for the whole name without its unit"
    )
    occurrence: PositiveInt = Field(1, description="which column, if a name is used twice")
    position: PositiveInt | None = Field(None, description="number of the column, from 1")
    group: str | None = Field(None, description="TDMS only: the channel's group")
    unit: str | None = Field(None, description="overrides the unit in the file")
    scale: float = 1.0
    offset: float = 0.0
    sign: Sign | Literal["pressed"] = Field(
        1,
        description="1 or -1; 'pressed' for a normal force of either sign: chosen so that its "
        "largest values are positive",
    )
    optional: bool = Field(
        False,
        description="may be missing or empty in some files; of several such columns for one "
        "quantity, the first with values is used",
    )
    zero_uncertainty: str | None = Field(
        None, description="friction only: standard uncertainty of the zero with unit, e.g. '0.2 N'"
    )
    zero: ZeroText | None = Field(
        None,
        description="interval of the zero to subtract: 'first 200 samples', 'first 2 s', "
        "'1.5 s to 3 s', 'file blank.csv' (a run without contact in the same folder)",
    )
    rectified: bool | None = Field(
        None, description="friction only: recorded without sign (true) or with it (false)"
    )

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.quantity is None) == (self.symbol is None):
            raise ValueError("a column has either a quantity or a symbol")
        if self.symbol in QUANTITIES:
            raise ValueError(f"'{self.symbol}' is a quantity: say quantity = '{self.symbol}'")
        places = (self.name, self.name_pattern, self.position)
        if sum(place is not None for place in places) != 1:
            raise ValueError(f"column '{self.key}': give either name, name_pattern or position")
        if self.unit is not None:
            check_unit(self.unit, self.si_unit(self.unit), self.bare)
        stated = {"zero_uncertainty": self.zero_uncertainty, "rectified": self.rectified}
        for key, value in stated.items():
            if value is not None and self.quantity not in FRICTION_SIGNALS:
                raise ValueError(
                    f"column '{self.key}': {key} is for {' and '.join(FRICTION_SIGNALS)} only"
                )
        if self.sign == "pressed" and self.quantity != "normal_force":
            raise ValueError(f"column '{self.key}': sign = 'pressed' is for normal_force only")
        if self.zero is not None and self.quantity in ("time", "x", "y"):
            raise ValueError(f"column '{self.key}': only a signal has a zero")
        if self.zero_uncertainty is not None:
            key = f"column '{self.key}': zero_uncertainty"
            to_si(self.zero_uncertainty, self.si_unit(None), key)
        return self

    @property
    def key(self) -> str:
        """Key of the column: its quantity, or its symbol."""
        return self.quantity or str(self.symbol)

    @property
    def bare(self) -> Counted | None:
        """Meaning of a unit such as 1/s for this quantity: cycles, radians or nothing."""
        return quantity(self.quantity).bare if self.quantity else None

    def si_unit(self, unit: str | None) -> str:
        """Return the SI unit to which numbers in a unit are converted."""
        if self.quantity:
            return quantity(self.quantity).unit
        if unit in (None, "", "1", "-", "%"):
            return "1"
        turning = reciprocal(plain_unit(str(unit)))  # cycles are not converted to radians
        return _TURNING.get(turning.counts if turning else "") or base_unit(str(unit))

    @property
    def attributes(self) -> dict[str, float | bool]:
        """Attributes of the run: stated zero uncertainty, and whether the signal is rectified."""
        attrs: dict[str, float | bool] = {}
        if self.zero_uncertainty is not None:
            unit = self.si_unit(None)
            ending = "" if unit == "1" else f"_{unit}"
            value = abs(to_si(self.zero_uncertainty, unit, "zero_uncertainty"))
            attrs[f"{self.quantity}_zero_uncertainty{ending}"] = value
        if self.rectified is not None:
            attrs[f"{self.quantity}_rectified"] = self.rectified
        return attrs


class Value(Strict):
    """A single value outside the table; it becomes an attribute of the run.

    From a step, a number becomes a variable along time, and text one attribute for all steps.
    """

    name: str = Field(description="a quantity, or your own name")
    source: Literal["preamble", "file name", "step"] = Field(
        "preamble",
        description="'step': the text before each of several tables",
    )
    pattern: Pattern | None = Field(None, description="group 1 is the value")
    default: str | None = Field(
        None,
        description="value if the file does not state it, e.g. '1 mm', because the method or the "
        "instrument fixes it; the run says that it was used",
    )
    unit: str | None = Field(None, description="unit; without it the value is kept as text")
    to: str | None = Field(None, description="SI unit of the result, if the name is not a quantity")
    scale: float = 1.0
    sign: Sign = 1

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if self.pattern is None and self.default is None:
            raise ValueError(f"value '{shown(self.name)}': give a pattern, a default or both")
        if self.pattern is not None and guarded(self.pattern).groups < 1:
            raise ValueError(
                f"value '{shown(self.name)}': the pattern needs a group ( ) for the value"
            )
        if self.unit is not None:
            check_unit(self.unit, self.si_unit, self.bare)
        if self.default is not None:
            if self.unit is None or self.source == "step":
                raise ValueError(
                    f"value '{shown(self.name)}': a default is for a number with a unit that "
                    "holds for the whole file"
                )
            try:
                to_si(self.default, self.si_unit, "default")
            except TribolabError as error:
                raise ValueError(f"value '{shown(self.name)}': {error}") from error
        return self

    @property
    def bare(self) -> Counted | None:
        """Meaning of a unit such as 1/s (cycles, radians, nothing), if the name is a quantity."""
        return QUANTITIES[self.name].bare if self.name in QUANTITIES and self.to is None else None

    @property
    def si_unit(self) -> str:
        """SI unit of the stored number."""
        if self.to is not None:
            return self.to
        try:
            return quantity(self.name).unit
        except TribolabError as error:
            hint = nearest(self.name, QUANTITIES)
            hint = f"{hint[:-1]}, or " if "did you mean" in hint else "; "
            raise ValueError(
                f"value '{shown(self.name)}' is no known quantity{hint}add "
                f"to = '{self._own_unit()}', the "
                f"SI unit to keep it in"
            ) from error

    def _own_unit(self) -> str:
        """Return a suitable SI unit: that of a quantity of this dimension, else in base units."""
        units = dict.fromkeys(known.unit for known in QUANTITIES.values())
        if reciprocal(str(self.unit)):  # cycles are not converted to radians
            units = dict.fromkeys(("1/s", "Hz", "rad/s", *units))
        for unit in units:
            with contextlib.suppress(TribolabError):
                conversion(str(self.unit), unit)
                return unit
        return base_unit(str(self.unit))

    @property
    def attribute(self) -> str:
        """Name of the run's attribute, with the SI unit as suffix."""
        if self.unit is None or self.si_unit in ("", "1"):
            return self.name
        return f"{self.name}_{re.sub(r'[^A-Za-z0-9]+', '_', self.si_unit)}"
