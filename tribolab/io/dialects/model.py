"""What a dialect may say: the typed description of one instrument's raw files.

The keys are those of the TOML files in ``raw_data_schema/instruments``; the JSON Schema beside
them is generated from these classes.
"""

from __future__ import annotations

import codecs
import contextlib
import re
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    NonNegativeInt,
    PositiveInt,
    model_validator,
)

from tribolab.errors import TribolabError, nearest, shown
from tribolab.io.dialects.dates import Epoch, is_form
from tribolab.io.dialects.formula import names_in, parse_formula
from tribolab.io.dialects.patterns import PatternError, guarded
from tribolab.io.zero_reading import parse_zero
from tribolab.quantities import QUANTITIES, quantity
from tribolab.turns import Counted, reciprocal
from tribolab.units import base_unit, conversion, positive, to_si


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


def _is_quantity(name: str) -> str:
    try:
        quantity(name)
    except TribolabError as error:
        raise ValueError(str(error)) from error
    return name


def _is_formula(text: str) -> str:
    try:
        parse_formula(text)
    except TribolabError as error:
        raise ValueError(str(error)) from error
    return text


def _is_zero(text: str) -> str:
    try:
        parse_zero(text)
    except TribolabError as error:
        raise ValueError(str(error)) from error
    return text


Pattern = Annotated[str, AfterValidator(_is_pattern)]
Encoding = Annotated[str, AfterValidator(_is_encoding)]
QuantityName = Annotated[str, AfterValidator(_is_quantity)]
Formula = Annotated[str, AfterValidator(_is_formula)]


def _is_field(text: str) -> str:
    name, _, kind = text.strip().rpartition(" ")
    if not name.strip() or not _BINARY_TYPE.fullmatch(kind):
        raise ValueError(f"'{shown(text)}' is not a name and a type, e.g. 'Fx <f4'")
    return text


_BINARY_TYPE = re.compile(r"[<>|=]?[fiu][1248]")
BinaryField = Annotated[str, AfterValidator(_is_field)]
ZeroText = Annotated[str, AfterValidator(_is_zero)]
Symbol = Annotated[str, Field(pattern=r"^[A-Za-z_]\w*$")]
Sign = Literal[1, -1]
FRICTION = ("friction_force", "friction_coefficient")  # signals whose zero can be stated


class _Strict(BaseModel):
    """Frozen, and an unknown key is an error."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)


class Recognise(_Strict):
    """Rules that must all hold for a file to be taken for this instrument's; none: never."""

    preamble: tuple[Pattern, ...] = Field((), description="patterns found in the file's first text")
    header: tuple[str, ...] = Field((), description="names that the header has, units included")
    columns: PositiveInt | None = Field(None, description="columns of a file without a header")
    linked: tuple[tuple[PositiveInt, PositiveInt], ...] = Field(
        (), description="pairs of columns (counted from 1), each a straight line of the other"
    )
    file_name: Pattern | None = Field(None, description="pattern found in the file's name")


class Text(_Strict):
    """How delimited text is written."""

    encoding: Encoding = Field("utf-8", description="utf-8 (a BOM is ignored), latin-1, ...")
    delimiter: str = Field(",", description="one character, or 'whitespace'")
    decimal: Literal[".", ","] = Field(".", description="decimal mark")
    missing: tuple[str, ...] = Field((), description="texts that stand for no value, error codes")
    end: Pattern | None = Field(None, description="a line matching this ends the table")
    skip_lines: Pattern | None = Field(
        None, description="lines below the header matching this are passed over: comments, marks"
    )

    @model_validator(mode="after")
    def _delimiter_is_usable(self) -> Self:
        if self.delimiter != "whitespace" and len(self.delimiter) != 1:
            raise ValueError("delimiter is one character, or the word 'whitespace'")
        if self.delimiter == self.decimal:
            raise ValueError(f"delimiter and decimal mark are both '{self.decimal}'")
        return self


class Header(_Strict):
    """How the table's header is found; with neither `line` nor `pattern` there is none."""

    line: PositiveInt | None = Field(None, description="number of the header's line, from 1")
    pattern: Pattern | None = Field(None, description="the first line matching this is the header")
    units: Literal["brackets", "row", "dialect"] = Field(
        "brackets", description="in brackets after the name, in the next row, or only here"
    )
    repeats: bool = Field(False, description="a header block stands at each step")
    step: Pattern | None = Field(
        None, description="group 1 is the step's number in the text before its header"
    )
    skip: NonNegativeInt = Field(0, description="lines to pass over after the header")
    sheet: str | None = Field(None, description="Excel only: name of the sheet; else the first")

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if self.line and self.pattern:
            raise ValueError("give either header.line or header.pattern, not both")
        if self.repeats and not self.pattern:
            raise ValueError("header.repeats needs header.pattern")
        return self


class Time(_Strict):
    """Where time comes from: a column (the default), intervals, a sample rate, or nowhere."""

    source: Literal["column", "period", "rate", "none"] = Field(
        "column",
        description="'period': the column of 'time' holds what has passed since the row before, "
        "and is summed; 'none': rows are counted as seconds, and the run says so",
    )
    format: str | None = Field(
        None,
        description="the column holds dates and times (or times of day): 'iso', 'iso with zone', "
        "or as for strptime, e.g. '%d.%m.%Y %H:%M:%S,%f'",
    )
    epoch: Epoch | None = Field(
        None,
        description="the column counts from a date, which tells when it was recorded: 'excel' "
        "(days since 1899-12-30: unit = \"d\"), 'labview' (1904, UTC), 'unix' (1970, UTC)",
    )
    rate: str | None = Field(None, description="sample rate with unit, e.g. '2 kHz'")
    rate_pattern: Pattern | None = Field(None, description="group 1 is the rate in the preamble")
    rate_unit: str = "Hz"
    restart: Literal["error", "continue"] = Field(
        "error",
        description="'continue': where the clock starts anew (in a table, at a step, in a file), "
        "time goes on",
    )
    wrap: str | None = Field(
        None, description="the clock's counter begins anew after this time, e.g. '65.536 s'"
    )
    on_repeat: Literal["error", "drop", "interpolate"] = Field(
        "error",
        description="rows whose time is not later than all before: 'drop' leaves them out, "
        "'interpolate' gives them times evenly between their neighbours'",
    )
    start_pattern: Pattern | None = Field(
        None, description="group 1 is the date and time at which a step (or the file) starts"
    )
    start_format: str | None = Field(None, description="its format as for strptime")

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.source == "rate") != bool(self.rate or self.rate_pattern):
            raise ValueError("source = 'rate' and rate (or rate_pattern) belong together")
        if self.source != "column" and (self.format or self.epoch):
            raise ValueError("format and epoch are for source = 'column'")
        if self.format and self.epoch:
            raise ValueError("format and epoch exclude one another")
        if self.format and not is_form(self.format):
            raise ValueError(
                f"format: 'iso', 'iso with zone', or codes such as %d and %H; not "
                f"'{shown(self.format)}'"
            )
        if self.rate:
            to_si(self.rate, "Hz", "time.rate")
        if self.wrap:
            positive(self.wrap, "s", "time.wrap")
        if bool(self.start_pattern) != bool(self.start_format):
            raise ValueError("start_pattern and start_format belong together")
        return self


class Rows(_Strict):
    """What may be lost of a table's rows."""

    left_out: float = Field(
        0.0,
        ge=0,
        le=1,
        description="share of the rows that may be left out because it is meant; beyond it, and "
        "beyond the limits of the check `rows_left_out`, the run is suspect or fails",
    )


class Column(_Strict):
    """Which column is which quantity: value in SI = sign * (scale * x + offset) * unit."""

    quantity: QuantityName | None = None
    symbol: Symbol | None = Field(
        None, description="instead of a quantity: a name of your own, for formulas of [[derived]]"
    )
    name: str | None = Field(None, description="name in the header without its unit")
    occurrence: PositiveInt = Field(1, description="which one, when a name is used twice")
    position: PositiveInt | None = Field(None, description="number of the column, from 1")
    group: str | None = Field(None, description="TDMS only: the channel's group")
    unit: str | None = Field(None, description="goes before the unit in the file")
    scale: float = 1.0
    offset: float = 0.0
    sign: Sign = 1
    optional: bool = Field(
        False,
        description="may be missing or empty in some files; of several such columns for one "
        "quantity the first that is filled is taken",
    )
    zero_uncertainty: str | None = Field(
        None, description="standard uncertainty of its zero with unit, e.g. '0.2 N': friction only"
    )
    zero: ZeroText | None = Field(
        None,
        description="where its zero is read and taken off: 'first 200 samples', 'first 2 s', "
        "'1.5 s to 3 s', or 'file blank.csv' for a run without contact beside it",
    )
    rectified: bool | None = Field(
        None, description="recorded without sign (true) or surely with it (false): friction only"
    )

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.quantity is None) == (self.symbol is None):
            raise ValueError("a column has either a quantity or a symbol")
        if self.symbol in QUANTITIES:
            raise ValueError(f"'{self.symbol}' is a quantity: say quantity = '{self.symbol}'")
        if (self.name is None) == (self.position is None):
            raise ValueError(f"column '{self.key}': give either name or position")
        if self.unit is not None:
            _check_unit(self.unit, self.si_unit(self.unit), self.bare)
        stated = {"zero_uncertainty": self.zero_uncertainty, "rectified": self.rectified}
        for key, value in stated.items():
            if value is not None and self.quantity not in FRICTION:
                raise ValueError(f"column '{self.key}': {key} is for {' and '.join(FRICTION)} only")
        if self.zero is not None and (self.symbol or self.quantity in ("time", "x", "y")):
            raise ValueError(f"column '{self.key}': only a signal has a zero")
        if self.zero_uncertainty is not None:
            to_si(self.zero_uncertainty, self.si_unit(None), "zero_uncertainty")
        return self

    @property
    def key(self) -> str:
        """What the column is called here: its quantity, or its symbol."""
        return self.quantity or str(self.symbol)

    @property
    def bare(self) -> Counted | None:
        """What a unit per time counts that does not say it."""
        return quantity(self.quantity).bare if self.quantity else None

    def si_unit(self, unit: str | None) -> str:
        """SI unit that numbers in a unit are turned into."""
        if self.quantity:
            return quantity(self.quantity).unit
        return base_unit(unit) if unit not in (None, "", "1", "-", "%") else "1"

    @property
    def attributes(self) -> dict[str, float | bool]:
        """What is stated of its zero and sign, as attributes of the run."""
        attrs: dict[str, float | bool] = {}
        if self.zero_uncertainty is not None:
            unit = self.si_unit(None)
            ending = "" if unit == "1" else f"_{unit}"
            value = abs(to_si(self.zero_uncertainty, unit, "zero_uncertainty"))
            attrs[f"{self.quantity}_zero_uncertainty{ending}"] = value
        if self.rectified is not None:
            attrs[f"{self.quantity}_rectified"] = self.rectified
        return attrs


class Value(_Strict):
    """A single value that stands outside the table; it becomes an attribute of the run.

    From a step, a number becomes a variable along time, and text one attribute for all steps.
    """

    name: str = Field(description="a quantity, or a name of your own")
    source: Literal["preamble", "file name", "step"] = "preamble"
    pattern: Pattern = Field(description="group 1 is the value")
    unit: str | None = Field(None, description="without a unit the value is kept as text")
    to: str | None = Field(None, description="SI unit to keep it in, if the name is no quantity")
    scale: float = 1.0
    sign: Sign = 1

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if guarded(self.pattern).groups < 1:
            raise ValueError(
                f"value '{shown(self.name)}': the pattern needs a group ( ) for the value"
            )
        if self.unit is not None:
            _check_unit(self.unit, self.si_unit, self.bare)
        return self

    @property
    def bare(self) -> Counted | None:
        """What a unit per time counts that does not say it, if the name is a quantity."""
        return QUANTITIES[self.name].bare if self.name in QUANTITIES and self.to is None else None

    @property
    def si_unit(self) -> str:
        """Unit in which a number is kept."""
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
        """SI unit of the unit given: of a quantity of its kind, else of base units."""
        units = dict.fromkeys(known.unit for known in QUANTITIES.values())
        if reciprocal(str(self.unit)):  # cycles stay cycles
            units = dict.fromkeys(("1/s", "Hz", "rad/s", *units))
        for unit in units:
            with contextlib.suppress(TribolabError):
                conversion(str(self.unit), unit)
                return unit
        return base_unit(str(self.unit))

    @property
    def attribute(self) -> str:
        """Name of the run's attribute: the SI unit is its ending."""
        if self.unit is None or self.si_unit in ("", "1"):
            return self.name
        return f"{self.name}_{re.sub(r'[^A-Za-z0-9]+', '_', self.si_unit)}"


class Derived(_Strict):
    """A quantity that no column holds: a formula of columns, values and quantities with units."""

    quantity: QuantityName
    formula: Formula = Field(
        description="+ - * / ( ) of quantities and symbols of columns, names of values, pi, and "
        "numbers with units in quotes: \"torque / (radius + '5 mm')\""
    )


class Speed(_Strict):
    """How the sliding speed comes about."""

    source: Literal["column", "position", "rotation", "set speed", "none"] = "column"
    radius: str | None = Field(None, description="track radius with unit, for source 'rotation'")
    radius_value: str | None = Field(None, description="the [[value]] that holds the radius")

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.source == "rotation") != bool(self.radius or self.radius_value):
            raise ValueError("source = 'rotation' and radius (or radius_value) belong together")
        if self.radius:
            to_si(self.radius, "m", "speed.radius")
        return self


class Pair(_Strict):
    """A second log with a clock of its own: the names differ by one ending."""

    own: str = Field(description="ending of this file's stem, e.g. '_force'")
    other: str = Field(description="ending of the companion's stem, e.g. '_motion'")
    instrument: str = Field(description="dialect of the companion")


class Marks(_Strict):
    """TDMS only: the group whose channel of times divides the run into steps."""

    group: str
    time: str = Field(description="name of the channel of times, without its unit")
    unit: str | None = None
    labels: Pattern | None = Field(None, description="properties of the group that hold labels")


class Binary(_Strict):
    """Binary only: records of one kind, one behind the other."""

    offset: NonNegativeInt = Field(0, description="bytes before the first record")
    fields: tuple[BinaryField, ...] = Field(
        min_length=1,
        description="name and type of each field in order, '<f8', '<f4', '>i2' ... as in numpy: "
        "'Fx <f4'; the names are those of [[column]]",
    )

    @property
    def record(self) -> np.dtype[np.void]:
        """Type of a record."""
        return np.dtype([tuple(field.rsplit(maxsplit=1)) for field in self.fields])


class Dialect(_Strict):
    """One instrument's raw files."""

    name: Annotated[str, Field(pattern=r"^[a-z0-9_]+$")]
    title: str = Field(description="what the instrument is, for people")
    format: Literal["text", "mat", "tdms", "hdf5", "parquet", "feather", "excel", "binary"] = Field(
        "text",
        description="hdf5 is MATLAB 7.3, too; files of all formats may be compressed (gz, zip)",
    )
    recognise: Recognise = Recognise()
    text: Text = Text()
    header: Header = Header()
    time: Time = Time()
    rows: Rows = Rows()
    speed: Speed = Speed()
    pair: Pair | None = None
    marks: Marks | None = None
    binary: Binary | None = None
    column: tuple[Column, ...] = Field(min_length=1)
    value: tuple[Value, ...] = ()
    derived: tuple[Derived, ...] = ()

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        names = [column.key for column in self.column]
        for name in sorted({name for name in names if names.count(name) > 1}):
            if not all(column.optional for column in self.column if column.key == name):
                raise ValueError(
                    f"'{name}' is given by two columns; if each file fills one of them, say "
                    "optional = true for all: the first that is filled is taken"
                )
        _check_formulas(self.derived, names, [v.name for v in self.value if v.unit is not None])
        if ("time" in names) != (self.time.source in ("column", "period")):
            raise ValueError(
                "a column for 'time' and time.source = 'column' or 'period' belong together"
            )
        if (self.format == "binary") != (self.binary is not None):
            raise ValueError("format = 'binary' and [binary] belong together")
        without_header = self.header.line is None and self.header.pattern is None
        if self.format == "text" and without_header:
            for column in self.column:
                if column.position is None or column.unit is None:
                    raise ValueError(
                        f"column '{column.key}': in a file without a header it needs "
                        "position and unit"
                    )
        if self.speed.radius_value and self.speed.radius_value not in {v.name for v in self.value}:
            raise ValueError(
                f"speed.radius_value: there is no value '{shown(self.speed.radius_value)}'"
            )
        return self


def _check_formulas(derived: tuple[Derived, ...], columns: list[str], values: list[str]) -> None:
    """Each formula needs what there is: columns, values with a unit, results of those before it."""
    known = {*columns, *values}
    for one in derived:
        for name in sorted(names_in(parse_formula(one.formula)) - known):
            raise ValueError(
                f"formula of '{one.quantity}': there is no column, value with a unit or derived "
                f"quantity before it called '{shown(name)}'{nearest(name, known)}"
            )
        if one.quantity in columns:
            raise ValueError(f"'{one.quantity}' is given by a column and by a formula")
        known.add(one.quantity)


def _check_unit(unit: str, si_unit: str, bare: Counted | None = None) -> None:
    try:
        conversion(unit, si_unit, bare)
    except TribolabError as error:
        raise ValueError(str(error)) from error
