"""Format of a table that the dialect leaves to the file: delimiter, decimal mark, units."""

from __future__ import annotations

import functools
import re
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from tribolab.core.errors import ReadError
from tribolab.reading.dialect.containers import PythonReader, with_columns
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.numbers import NUMBER
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.reading.text.cells import split_name, split_row
from tribolab.reading.text.first_bytes import File, peek

_ANY = "any"
_DELIMITERS = ("\t", ";", "|", ",")  # if several split a header equally, the first is used
_ROWS = 20  # lines inspected below the names
_WIDE = (b"\xff\xfe", b"\xfe\xff")
_OF_NUMBERS = "0123456789.,;|+-eE \t"  # characters of numbers; a line with no others is no header
_COMMA, _POINT = re.compile(r"\d,\d"), re.compile(r"\d\.\d")


def as_written(path: str | Path | File, dialect: Dialect) -> Dialect:
    """Return a dialect completed with the table format of a file: delimiter, decimal mark, units.

    Parameters
    ----------
    path
        The file.
    dialect
        The dialect. One with a stated delimiter is returned unchanged.

    Returns
    -------
    Dialect
        Dialect with the delimiter that splits the header into most cells, the decimal mark and
        encoding of the rows, and units from the next line if the header has none. For a Python
        reader, with the columns that it finds.

    Raises
    ------
    ReadError
        If the header is missing.
    """
    if isinstance(dialect, PythonReader):
        return with_columns(dialect, Path(path.path if isinstance(path, File) else path))
    if dialect.text.delimiter != _ANY:
        return dialect
    file = path if isinstance(path, File) else peek(path)
    if file.format != "text":  # the reader reports the wrong format
        return dialect
    lines, encoding = _lines_of(file.head)
    header, *below = _from_header(file, lines, dialect)
    delimiter = max(_DELIMITERS, key=lambda mark: len(split_row(header, mark)))
    if len(split_row(header, delimiter)) < 2:
        delimiter = "whitespace"
    written = {"delimiter": delimiter, "encoding": encoding, "decimal": _decimal(below, delimiter)}
    units = dialect.header.units
    named = any(split_name(cell)[1] for cell in split_row(header, delimiter))
    if units == "brackets" and not named and below:
        numeric = any(re.fullmatch(NUMBER, cell) for cell in split_row(below[0], delimiter))
        units = units if numeric else "row"
    return dialect.model_copy(
        update={
            "text": dialect.text.model_copy(update=written),
            "header": dialect.header.model_copy(update={"units": units}),
        }
    )


class _Lines(NamedTuple):
    """Lines of a text, and the indices of those that contain more than numbers."""

    lines: list[str]
    named: list[int]


@functools.lru_cache(maxsize=2)  # a dozen dialects inspect the same file in turn
def _lines_of(head: bytes) -> tuple[_Lines, str]:
    text, encoding = _decoded(head)
    lines = text.splitlines()
    return _Lines(lines, [n for n, line in enumerate(lines) if line.strip(_OF_NUMBERS)]), encoding


def _decoded(head: bytes) -> tuple[str, str]:
    """Return the text at the start of a file, and its encoding."""
    if head.startswith(_WIDE):
        return head.decode("utf-16", errors="ignore"), "utf-8"  # the encoding after conversion
    try:
        return head.decode("utf-8-sig"), "utf-8"
    except UnicodeDecodeError as error:
        if error.start > len(head) - 4:  # the first megabyte ends within a character
            return head.decode("utf-8-sig", errors="ignore"), "utf-8"
        return head.decode("latin-1"), "latin-1"


def _from_header(file: File, text: _Lines, dialect: Dialect) -> list[str]:
    """Return the header line and the following lines that are not blank."""
    lines = text.lines
    header = dialect.header
    if header.pattern is not None:
        pattern = guarded(header.pattern)
        start = next((n for n in text.named if pattern.search(lines[n])), len(lines))
    else:
        start = (header.line or 1) - 1
    if start >= len(lines):
        raise ReadError(
            f"no line has the names of the columns that files of '{dialect.name}' have",
            where=file.path,
        )
    below = (line for line in islice(lines, start + 1, None) if line.strip())
    return [lines[start], *islice(below, _ROWS)]


def _decimal(rows: list[str], delimiter: str) -> str:
    """Return the decimal mark of rows of numbers."""
    if delimiter != ",":
        comma = any(_COMMA.search(row) for row in rows)
        return "," if comma and not any(_POINT.search(row) for row in rows) else "."
    quoted = [text for row in rows for text in re.findall(r'"([^"]*)"', row)]
    return "," if any(_COMMA.search(text) for text in quoted) else "."
