"""Rules of a dialect for the file: recognition, text, header, rows, groups, records."""

from __future__ import annotations

from typing import Literal, Self

import numpy as np
from pydantic import Field, NonNegativeInt, PositiveInt, model_validator

from tribolab.reading.dialect.checked_text import BinaryField, Encoding, Pattern, Strict


class Recognise(Strict):
    """Rules to recognise a file of this instrument; all must match. No rules: never recognised."""

    preamble: tuple[Pattern, ...] = Field((), description="patterns in the text before the table")
    header: tuple[str, ...] = Field((), description="names in the header, units included")
    columns: PositiveInt | None = Field(
        None, description="number of columns, if there is no header"
    )
    linked: tuple[tuple[PositiveInt, PositiveInt], ...] = Field(
        (), description="pairs of columns (from 1) that are linear functions of each other"
    )
    file_name: Pattern | None = Field(None, description="pattern in the file name")


class Text(Strict):
    """Format of delimited text."""

    encoding: Encoding = Field("utf-8", description="utf-8 (a BOM is ignored), latin-1, ...")
    delimiter: str = Field(
        ",",
        description="one character, 'whitespace', or 'any': detected from the header, with decimal "
        "mark, encoding and a line of units below the names",
    )
    decimal: Literal[".", ","] = Field(
        ".",
        description="decimal mark; may equal the delimiter if numbers are in quotes",
    )
    thousands: Literal["", ".", ",", "'", " ", "\u00a0", "\u202f"] = Field(
        "", description="thousands separator, like the comma of '1,234.5'"
    )
    missing: tuple[str, ...] = Field((), description="marks of missing values, error codes")
    end: Pattern | None = Field(None, description="the first line matching this ends the table")
    skip_lines: Pattern | None = Field(
        None, description="lines below the header to ignore: comments, marks"
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
    def is_quoted(self) -> bool:
        """Whether commas separate cells and are decimal marks in quotes: "0,1","2,5"."""
        return self.delimiter == self.decimal == ","

    @property
    def table_decimal(self) -> str:
        """Decimal mark of the table after normalisation."""
        return "." if self.is_quoted else self.decimal


class Header(Strict):
    """Header of the table; omit `line` and `pattern` if there is no header."""

    line: PositiveInt | None = Field(None, description="line number of the header, from 1")
    pattern: Pattern | None = Field(None, description="the first line matching this is the header")
    units: Literal["brackets", "row", "dialect"] = Field(
        "brackets",
        description="in brackets after the name, in the next row, or only in the dialect",
    )
    units_line: PositiveInt = Field(
        1, description="for units = 'row': number of the line below the names, from 1"
    )
    repeats: bool = Field(False, description="each step begins with a header")
    step: Pattern | None = Field(
        None, description="group 1 is the step number in the text above its header"
    )
    skip: NonNegativeInt = Field(0, description="number of lines to skip after the header")
    sheet: str | None = Field(None, description="Excel only: name of the sheet; default: the first")

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if self.line and self.pattern:
            raise ValueError("give either header.line or header.pattern, not both")
        if self.repeats and not self.pattern:
            raise ValueError("header.repeats needs header.pattern")
        return self


class Rows(Strict):
    """Meaning of the rows."""

    are: Literal["samples", "points", "either"] = Field(
        "samples",
        description="'points': each row is a result, the mean at one speed; 'either': only if no "
        "speed is kept over several rows",
    )


_IN_A_NAME = r"^[^/\\\x00]+$"  # the companion is in the same folder


class Pair(Strict):
    """A second log with its own clock; the file names differ only in their ending."""

    own: str = Field(description="ending of this file's name, e.g. '_force'", pattern=_IN_A_NAME)
    other: str = Field(
        description="ending of the companion's name, e.g. '_motion'", pattern=_IN_A_NAME
    )
    instrument: str = Field(description="dialect of the companion")


class Marks(Strict):
    """TDMS only: a group with a channel of times that divide the run into steps."""

    group: str
    time: str = Field(description="name of the time channel, without its unit")
    unit: str | None = None
    labels: Pattern | None = Field(None, description="properties of the group to use as labels")


class Binary(Strict):
    """Binary only: consecutive records of one type."""

    offset: NonNegativeInt = Field(0, description="bytes before the first record")
    fields: tuple[BinaryField, ...] = Field(
        min_length=1,
        description="name and NumPy type ('<f8', '<f4', '>i2' ...) of each field in order, e.g. "
        "'Fx <f4'; use these names in [[column]]",
    )

    @property
    def record(self) -> np.dtype[np.void]:
        """Type of a record."""
        return np.dtype([tuple(field.rsplit(maxsplit=1)) for field in self.fields])
