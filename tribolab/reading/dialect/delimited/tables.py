"""Start and end of the tables in delimited text, and the text outside of them."""

from __future__ import annotations

import mmap
import re
from pathlib import Path
from typing import NamedTuple

from tribolab.core.errors import ReadError
from tribolab.reading.dialect.delimited.headers import (
    BOM,
    compiled,
    counts_its_rows,
    header_starts,
    line_at,
    parted_as_numbers,
    read_header,
    table_encoding,
)
from tribolab.reading.dialect.delimited.normalised_text import mended
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.text.cells import split_row
from tribolab.reading.text.first_bytes import File, peek

# one character class: a repeated group would take 60 bytes of memory per line
_BLANK = re.compile(rb"(?:[ \t\r\n]*\n)?")


class TextTable(NamedTuple):
    """Table in a text file, with names, units, and the offsets [bytes] of its start and end."""

    names: tuple[str, ...]
    units: tuple[str | None, ...]
    width: int
    start: int
    stop: int
    line: int
    before: str


class RawText(NamedTuple):
    """Text file on disk, or its content in memory if it had to be normalised."""

    file: File
    memory: bytes | None
    tables: tuple[TextTable, ...]

    @property
    def preamble(self) -> str:
        """Text before the first table."""
        return self.tables[0].before


def find_tables(path: str | Path | File, dialect: Dialect, *, head_only: bool = False) -> RawText:
    """Find the tables of a text file.

    Parameters
    ----------
    path
        The file.
    dialect
        Format of the file.
    head_only
        Whether to use only the first megabyte, which suffices to recognise a file.

    Raises
    ------
    ReadError
        If the expected header is missing, or has no rows below it.
    """
    file = path if isinstance(path, File) else peek(path)
    memory = mended(file, dialect, head_only)
    if memory is not None:
        return RawText(file, memory, tuple(_scan(file, memory, len(memory), dialect)))
    if head_only or not (dialect.header.repeats or dialect.text.end):
        return RawText(file, None, tuple(_scan(file, file.head, file.size, dialect)))
    try:
        with file.path.open("rb") as handle, mmap.mmap(handle.fileno(), 0, prot=1) as content:
            return RawText(file, None, tuple(_scan(file, content, len(content), dialect)))
    except (OSError, ValueError) as error:
        raise ReadError(f"{file.path}: the file cannot be read any more: {error}") from error


def _scan(file: File, content: bytes | mmap.mmap, size: int, dialect: Dialect) -> list[TextTable]:
    """Return the tables in `content`, the start (or all) of a file of `size` bytes."""
    header, text = dialect.header, dialect.text
    starts = header_starts(file, content, dialect)
    end = compiled(text.end, dialect) if text.end else None
    tables: list[TextTable] = []
    origin = 3 if content[:3] == BOM else 0
    line, counted = 1, 0
    for number, start in enumerate(starts):
        limit = starts[number + 1] if number + 1 < len(starts) else size
        here, names, units = read_header(file, content, start, dialect)
        blank = _BLANK.match(content, here)
        body = blank.end() if blank else here
        stop = limit
        if end is not None and (last := end.search(content, body, min(limit, len(content)))):
            stop = last.start()
        width = _width(file, content, body, dialect)
        if len(names) == width - 1 and _counted(file, content, body, dialect):
            names, units = ("", *names), (None, *units)
        names, units = parted_as_numbers(names, units, width, dialect)
        before = _decode(content[origin : start if start > origin else body], file, dialect)
        if header.line is None and header.pattern is None and not header.skip:
            before = ""
        line, counted = line + content[counted:body].count(b"\n"), body
        if body < stop:
            tables.append(TextTable(names, units, width, body, stop, line, before))
        origin = min(stop, len(content))
    if not tables:
        raise ReadError(f"{file.path}: the file has a header, but no row of numbers below it")
    return tables


def _width(file: File, content: bytes | mmap.mmap, body: int, dialect: Dialect) -> int:
    """Return the number of cells of a row; superfluous delimiters in the first row do not count."""
    first, below = line_at(file, content, body, dialect)
    cells = split_row(first, dialect.text.delimiter)
    if cells[-1] or below >= len(content):
        return len(cells)
    second = len(split_row(line_at(file, content, below, dialect)[0], dialect.text.delimiter))
    return second if 0 < second < len(cells) and not any(cells[second:]) else len(cells)


def _counted(file: File, content: bytes | mmap.mmap, body: int, dialect: Dialect) -> bool:
    first, below = line_at(file, content, body, dialect)
    second = line_at(file, content, below, dialect)[0]
    return counts_its_rows([first, second], dialect.text.delimiter)


def _decode(content: bytes, file: File, dialect: Dialect) -> str:
    try:
        return content.decode(table_encoding(dialect)).replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise ReadError(
            f"{file.path}: byte {error.start} is not {dialect.text.encoding}; name the encoding "
            "in the dialect, e.g. encoding = 'latin-1'"
        ) from error


_MAX_FOOT = 1 << 16  # most bytes that are read of the text below a table
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
