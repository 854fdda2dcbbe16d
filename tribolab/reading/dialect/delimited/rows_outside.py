"""Text outside the tables that are read: rows of numbers, and the text below."""

from __future__ import annotations

import re

from tribolab.core.errors import ReadError
from tribolab.reading.dialect.delimited.tables import RawText
from tribolab.reading.dialect.model import Dialect

_MAX_FOOT = 1 << 16  # bytes
# line that begins with a number and contains no words, times of day or dates
_NUMBERS = re.compile(rb'^[ \t"]*[-+.]?\d[^\r\nA-DF-Za-df-z:/#%]*\r?$', re.MULTILINE)


def rows_outside(raw: RawText, delimiter: str) -> int:
    """Count the rows of numbers before, between and below the tables of a file.

    A row has at least two cells, and between half and twice as many as the tables have columns; a
    few numbers in a line are settings or results.

    Raises
    ------
    ReadError
        If the file can no longer be read.
    """
    tables = raw.tables
    size = raw.file.size if raw.memory is None else len(raw.memory)
    edges = [0, *(place for table in tables for place in (table.start, table.stop)), size]
    gaps = [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b > a]
    width = max(table.width for table in tables)
    mark = b"\t" if delimiter == "whitespace" else delimiter.encode()
    return sum(_count(_bytes(raw, *gap), mark, width) for gap in gaps)


def foot_of(raw: RawText, dialect: Dialect) -> str:
    """Return the text below the last table of a file; only the end of a long text.

    Raises
    ------
    ReadError
        If the file can no longer be read.
    """
    size = raw.file.size if raw.memory is None else len(raw.memory)
    stop = raw.tables[-1].stop
    if not stop < size:
        return ""
    text = _bytes(raw, max(stop, size - _MAX_FOOT), size)
    return text.decode(dialect.text.encoding, errors="replace").replace("\r", "\n")


def _bytes(raw: RawText, start: int, stop: int) -> bytes:
    if raw.memory is not None:
        return raw.memory[start:stop]
    if stop <= len(raw.file.head):
        return raw.file.head[start:stop]
    try:
        with raw.file.path.open("rb") as file:
            file.seek(start)
            return file.read(stop - start)
    except OSError as error:
        raise ReadError(f"{raw.file.path}: the file cannot be read any more: {error}") from error


def _count(text: bytes, mark: bytes, width: int) -> int:
    rows = 0
    for line in _NUMBERS.findall(text):
        cells = sum(bool(cell.strip(b' "\r')) for cell in line.split(mark))
        rows += max(2, width / 2) <= cells <= 2 * width
    return rows
