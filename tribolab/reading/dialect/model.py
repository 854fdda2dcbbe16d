"""Typed description of one instrument's raw files: all rules of a dialect.

The keys are those of the TOML files in ``raw_data_schema/instruments``; the JSON Schema next to
them is generated from these classes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tribolab.core.errors import nearest, shown
from tribolab.reading.dialect.checked_text import Formula, QuantityName, Strict, ZeroText
from tribolab.reading.dialect.column_rule import Column, Value
from tribolab.reading.dialect.file_layout import (
    Binary,
    Header,
    Marks,
    Pair,
    Recognise,
    Rows,
    Text,
)
from tribolab.reading.dialect.formula import names_in, parse_formula
from tribolab.reading.dialect.time_rule import Speed, Time
from tribolab.reading.dialect.uncertainty import Uncertainty
from tribolab.units.conversion import positive


class Derived(Strict):
    """A quantity computed from columns, values and numbers with units."""

    quantity: QuantityName
    formula: Formula = Field(
        description="+ - * / ( ) of quantities and symbols of columns, names of values, pi, and "
        "numbers with units in quotes: \"torque / (radius + '5 mm')\""
    )
    optional: bool = Field(
        False,
        description="omitted for files that lack an input of the formula; of several such "
        "formulas for one quantity, the first that can be computed is used",
    )
    beside: tuple[str, ...] = Field(
        (), description="column that the file must also contain for the formula to be used"
    )
    zero: ZeroText | None = Field(
        None, description="interval of the zero to subtract from the result, as for a column"
    )


class Dialect(Strict):
    """Description of the raw files of one instrument."""

    name: Annotated[str, Field(pattern=r"^[a-z0-9_]+$")]
    title: str = Field(description="name of the instrument, for people")
    format: Literal[
        "text",
        "mat",
        "tdms",
        "hdf5",
        "parquet",
        "feather",
        "excel",
        "npz",
        "json",
        "declared records",
        "binary",
    ] = Field(
        "text",
        description="'hdf5' includes MATLAB 7.3; 'npz' is a NumPy archive; 'declared records' are "
        "binary numbers after a text header; files of any format may be compressed (gz, zip)",
    )
    from_file: bool = Field(
        True,
        description="false: written from documentation or a standard, without a file of the "
        "instrument; runs say so",
    )
    recognise: Recognise = Recognise()
    text: Text = Text()
    header: Header = Header()
    time: Time = Time()
    rows: Rows = Rows()
    moving_mass: str | None = Field(
        None,
        description="mass between contact and force sensor, e.g. '1.2 kg': its inertia is "
        "subtracted from the friction force",
    )
    speed: Speed = Speed()
    pitch: str | None = Field(
        None, description="point spacing of a profile without x, e.g. '0.25 um'"
    )
    pitch_value: str | None = Field(None, description="the [[value]] (in m) with the pitch")
    length_value: str | None = Field(
        None,
        description="the [[value]] (in m) with the length of an evenly spaced profile without x",
    )
    pair: Pair | None = None
    marks: Marks | None = None
    binary: Binary | None = None
    column: tuple[Column, ...] = Field(min_length=1)
    value: tuple[Value, ...] = ()
    derived: tuple[Derived, ...] = ()
    uncertainty: Uncertainty = Uncertainty()

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        names = [column.key for column in self.column]
        side_by_side = {"height"} if "y" not in names else set()  # profiles of one surface
        for name in sorted({name for name in names if names.count(name) > 1} - side_by_side):
            if not all(column.optional for column in self.column if column.key == name):
                raise ValueError(
                    f"'{name}' is given by two columns; if each file fills one of them, say "
                    "optional = true for all: the first that is filled is taken"
                )
        sure = {column.key for column in self.column if not column.optional}
        values = [v.name for v in self.value if v.unit is not None]
        _check_formulas(self.derived, names, values, sure)
        profile = "height" in names and self.time == Time()  # heights have no time
        timed = self.time.source in ("column", "period")
        if ("time" in names) != timed and not (profile and "time" not in names):
            raise ValueError(
                "a column for 'time' and time.source = 'column' or 'period' belong together; "
                "without such a column say under [time] source = 'rate' and rate = '100 Hz'"
            )
        if self.time.source == "position" and "position" not in names:
            raise ValueError("time.source = 'position' needs a column for 'position'")
        if self.moving_mass is not None:
            positive(self.moving_mass, "kg", "moving_mass")
        if (self.format == "binary") != (self.binary is not None):
            raise ValueError("format = 'binary' and [binary] belong together")
        without_header = self.header.line is None and self.header.pattern is None
        if without_header and self.text.delimiter == "any":
            raise ValueError("text.delimiter = 'any' needs header.line or header.pattern")
        if self.format == "text" and without_header:
            for column in self.column:
                if column.position is None or column.unit is None:
                    raise ValueError(
                        f"column '{column.key}': in a file without a header it needs "
                        "position and unit"
                    )
        _check_pitch(self.pitch, self.pitch_value, self.length_value, self.value, names)
        for key, value in self.speed.values_named.items():
            if value not in {v.name for v in self.value} | {c.symbol for c in self.column}:
                raise ValueError(
                    f"speed.{key}: there is no value and no symbol of a column '{shown(value)}'"
                )
        return self

    @property
    def values_used(self) -> set[str]:
        """Names of the values, columns and quantities that the speed or formulas use."""
        formulas = (names_in(parse_formula(rule.formula)) for rule in self.derived)
        return set(self.speed.values_named.values()).union(*formulas)


def _check_formulas(
    derived: tuple[Derived, ...], columns: list[str], values: list[str], sure: set[str]
) -> None:
    """Raise if a formula uses a name that is no column, value with a unit, or earlier result.

    A quantity with a required column must not have a formula; for an optional column the formula is
    a substitute.
    """
    known = {*columns, *values}
    for rule in derived:
        for name in sorted({*names_in(parse_formula(rule.formula)), *rule.beside} - known):
            raise ValueError(
                f"formula of '{rule.quantity}': there is no column, value with a unit or derived "
                f"quantity before it called '{shown(name)}'{nearest(name, known)}"
            )
        if rule.quantity in sure:
            raise ValueError(f"'{rule.quantity}' is given by a column and by a formula")
        known.add(rule.quantity)


def _check_pitch(
    pitch: str | None,
    pitch_value: str | None,
    length_value: str | None,
    values: Sequence[Value],
    columns: Sequence[str],
) -> None:
    """Raise unless the pitch or length of a profile is given once, and in metres."""
    keys = {"pitch": pitch, "pitch_value": pitch_value, "length_value": length_value}
    given = {key: text for key, text in keys.items() if text is not None}
    if not given:
        return
    if len(given) > 1:
        raise ValueError(f"give either {' or '.join(given)}, not all of them")
    if "height" not in columns or "x" in columns or "y" in columns:
        raise ValueError("pitch is for a column of 'height' without one of 'x'")
    [(key, text)] = given.items()
    if key == "pitch":
        positive(text, "m", "pitch")
    elif not any(v.name == text and v.unit is not None and v.si_unit == "m" for v in values):
        raise ValueError(f"{key}: there is no value '{shown(text)}' with a unit and to = 'm'")
