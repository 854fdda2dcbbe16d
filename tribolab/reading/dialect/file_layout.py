"""How a file lies on the disk: by what it is known, its text, header, rows, groups, records."""

from __future__ import annotations

from typing import Literal, Self

import numpy as np
from pydantic import Field, NonNegativeInt, PositiveInt, model_validator

from tribolab.reading.dialect.checked_text import BinaryField, Encoding, Pattern, Strict

TEXT_CONTAINERS = ("json", "declared records")  # files that begin as text and name their columns


class Recognise(Strict):
    """Rules that must all hold for a file to be taken for this instrument's; none: never."""

    preamble: tuple[Pattern, ...] = Field((), description="patterns found in the file's first text")
    header: tuple[str, ...] = Field((), description="names that the header has, units included")
    columns: PositiveInt | None = Field(None, description="columns of a file without a header")
    linked: tuple[tuple[PositiveInt, PositiveInt], ...] = Field(
        (), description="pairs of columns (counted from 1), each a straight line of the other"
    )
    file_name: Pattern | None = Field(None, description="pattern found in the file's name")


class Text(Strict):
    """How delimited text is written."""

    encoding: Encoding = Field("utf-8", description="utf-8 (a BOM is ignored), latin-1, ...")
    delimiter: str = Field(
        ",",
        description="one character, 'whitespace', or 'any': that which parts the header's line "
        "most; decimal mark, encoding and a line of units below the names are then as in the file",
    )
    decimal: Literal[".", ","] = Field(
        ".",
        description="decimal mark; a comma may part the cells, too, where numbers are in quotes",
    )
    thousands: Literal["", ".", ",", "'", " ", "\u00a0", "\u202f"] = Field(
        "", description="mark between the thousands of a number, as the comma of '1,234.5'"
    )
    missing: tuple[str, ...] = Field(
        (), description="texts that mean no value, such as error codes"
    )
    arrangement: Literal["below names", "json", "declared records"] = Field(
        "below names",
        description="'json', or the 'declared records' of binary numbers behind text, where the "
        "numbers are not in lines below a line of names",
    )
    end: Pattern | None = Field(None, description="a line matching this ends the table")
    skip_lines: Pattern | None = Field(
        None, description="lines below the header matching this are passed over: comments, marks"
    )

    @model_validator(mode="after")
    def _delimiter_is_usable(self) -> Self:
        if self.delimiter not in ("whitespace", "any") and len(self.delimiter) != 1:
            raise ValueError("delimiter is one character, or the word 'whitespace' or 'any'")
        if self.delimiter == self.decimal and not self.is_quoted:
            raise ValueError(f"delimiter and decimal mark are both '{self.decimal}'")
        if self.thousands == self.decimal:
            raise ValueError(f"decimal mark and mark of thousands are both '{self.decimal}'")
        return self

    @property
    def container(self) -> str:
        """What holds the columns by name, of text that does; "" of lines of text."""
        return self.arrangement if self.arrangement in TEXT_CONTAINERS else ""

    @property
    def is_quoted(self) -> bool:
        """Whether commas part the cells and are decimal marks in quotes: "0,1","2,5"."""
        return self.delimiter == self.decimal == ","

    @property
    def table_decimal(self) -> str:
        """Decimal mark of the table once its spelling is the usual one."""
        return "." if self.is_quoted else self.decimal


class Header(Strict):
    """How the table's header is found; with neither `line` nor `pattern` there is none."""

    line: PositiveInt | None = Field(None, description="number of the header's line, from 1")
    pattern: Pattern | None = Field(None, description="the first line matching this is the header")
    units: Literal["brackets", "row", "dialect"] = Field(
        "brackets", description="in brackets after the name, in the next row, or only here"
    )
    units_line: PositiveInt = Field(
        1, description="for units = 'row': in which line below the names, from 1"
    )
    repeats: bool = Field(False, description="each step begins with a header block")
    only: Pattern | None = Field(
        None, description="profiles only: of several tables those whose title matches this"
    )
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


class Rows(Strict):
    """What rows are, and what may be lost of them."""

    are: Literal["samples", "points", "either"] = Field(
        "samples",
        description="'points': each row is a result of the instrument's own, the mean at one "
        "speed; 'either': where no speed is held over several rows",
    )

    left_out: float = Field(
        0.0,
        ge=0,
        le=1,
        description="share of the rows that may be left out because it is meant; beyond it, and "
        "beyond the limits of the check `rows_left_out`, the run is suspect or fails",
    )


_IN_A_NAME = r"^[^/\\\x00]+$"  # the companion lies beside the file


class Pair(Strict):
    """A second log with a clock of its own: the names differ by one ending."""

    own: str = Field(description="ending of this file's stem, e.g. '_force'", pattern=_IN_A_NAME)
    other: str = Field(
        description="ending of the companion's stem, e.g. '_motion'", pattern=_IN_A_NAME
    )
    instrument: str = Field(description="dialect of the companion")


class Marks(Strict):
    """TDMS only: the group whose channel of times divides the run into steps."""

    group: str
    time: str = Field(description="name of the channel of times, without its unit")
    unit: str | None = None
    labels: Pattern | None = Field(None, description="properties of the group that hold labels")


class Tables(Strict):
    """Several tables of the same columns in one file: sheets, groups, elements of a structure."""

    steps: Pattern = Field(
        description="tables whose name matches are steps of the run, in the order of the file: a "
        "sheet, the path of an HDF5 group, a TDMS group, an element of a structure as in MATLAB "
        "('exp.stage(2)'); columns are named without it, settings of a step are its text"
    )


class Binary(Strict):
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
