"""Rule of a dialect for one value outside the table."""

from __future__ import annotations

import contextlib
import re
from typing import Literal, Self

from pydantic import Field, model_validator

from tribolab.core.errors import TribolabError, nearest, shown
from tribolab.reading.dialect.checked_text import Pattern, Sign, Strict, check_unit
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.units.conversion import base_unit, conversion, to_si
from tribolab.units.quantities import QUANTITIES, quantity
from tribolab.units.reciprocals import Counted, reciprocal


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
        """Events counted by a unit per time that does not name them, if the name is a quantity."""
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
        """Return the SI unit for the given unit: of a quantity of its kind, else base units."""
        units = dict.fromkeys(known.unit for known in QUANTITIES.values())
        if reciprocal(str(self.unit)):  # cycles remain cycles
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
