"""Headers of delimited text: their position, names and units."""

from __future__ import annotations

import functools
import mmap
import re
from collections.abc import Sequence
from itertools import islice

from tribolab.core.errors import ReadError, shown
from tribolab.reading import cures
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.text.bounded_patterns import Guarded
from tribolab.reading.text.cells import split_name, split_row
from tribolab.reading.text.first_bytes import File

BOM = b"\xef\xbb\xbf"
_CLASS = re.compile(r"(?<!\\)\[")
LONGEST_LINE = 4 << 20  # bytes, some 300 000 columns; longer lines are not rows of a table


def header_starts(file: File, content: bytes | mmap.mmap, dialect: Dialect) -> list[int]:
    """Return the offset [bytes] of each header line."""
    header = dialect.header
    first = 3 if content[:3] == BOM else 0
    if header.pattern is not None:
        matches = compiled(header.pattern, dialect).all(content, first)
        wanted = None if header.repeats else 1  # more headers would require reading the whole head
        starts = [
            max(content.rfind(b"\n", 0, m.start() + 1) + 1, first) for m in islice(matches, wanted)
        ]
        if not starts:
            raise ReadError(
                f"no line matches '{shown(header.pattern)}', which begins the table in files of "
                f"'{dialect.name}'",
                where=file.path,
                cure=cures.name_instrument(say="if another instrument wrote it, say so with"),
            )
        return starts
    position = first
    for _ in range((header.line or 1) - 1):
        position = content.find(b"\n", position) + 1
        if position == 0:
            raise ReadError(
                f"{file.path}: the header should be in line {header.line}, but the file (or "
                "its first megabyte) has fewer lines"
            )
    return [position]


def read_header(
    file: File, content: bytes | mmap.mmap, start: int, dialect: Dialect
) -> tuple[int, tuple[str, ...], tuple[str | None, ...]]:
    """Return the offset [bytes] after a header, and the names and units of its columns."""
    header, delimiter = dialect.header, dialect.text.delimiter
    if header.line is None and header.pattern is None:
        for _ in range(header.skip):
            start = line_at(file, content, start, dialect)[1]
        return start, (), ()
    line, here = line_at(file, content, start, dialect)
    names, units = _columns(line, delimiter, header.units == "brackets")
    if header.units == "row":
        for _ in range(header.units_line):
            line, here = line_at(file, content, here, dialect)
        while not line.strip() and here < len(content):  # only delimiters, or empty
            line, here = line_at(file, content, here, dialect)
        row = [unit.strip("[]() ") or None for unit in split_row(line, delimiter)]
        units = tuple((row + [None] * len(names))[: len(names)])
    for _ in range(header.skip):
        here = line_at(file, content, here, dialect)[1]
    return here, names, units


@functools.lru_cache(maxsize=2)  # a dozen dialects inspect the same header in turn
def _columns(
    line: str, delimiter: str, brackets: bool
) -> tuple[tuple[str, ...], tuple[str | None, ...]]:
    """Return the names of the columns in a header line, and units in brackets."""
    cells = split_row(line, delimiter)
    if not brackets:
        return tuple(cells), (None,) * len(cells)
    names, units = zip(*map(split_name, cells), strict=True)
    return names, units


def parted_as_numbers(
    names: tuple[str, ...], units: tuple[str | None, ...], width: int, dialect: Dialect
) -> tuple[tuple[str, ...], tuple[str | None, ...]]:
    """Return names and units of a header in which blanks also separate words of one name.

    Units in brackets belong to the names before them. If there are still more or fewer names than
    columns, none is returned.
    """
    fits = len(names) == width or dialect.text.delimiter != "whitespace"
    if fits or any(column.position is None for column in dialect.column):
        return names, units
    joined: list[str] = []
    # the header may begin with a comment mark: "# t [s] x [mm]"
    marked = len(names) > width and not any(map(str.isalnum, names[0]))
    for name in names[marked:]:
        if joined and name[:1] in "([":
            joined[-1] += f" {name}"
        else:
            joined.append(name)
    if len(joined) != width:
        return (), ()
    return tuple(split_name(name)[0] for name in joined), (None,) * width


def counts_its_rows(rows: Sequence[str], delimiter: str) -> bool:
    """Whether two rows begin with consecutive row numbers, which the header does not name.

    Unless blanks separate the cells, row numbers must be in quotes, as in R's `write.table`;
    without quotes they may be a time in seconds.
    File: xlook of biaxial rigs (jrleeman/LeemanNatComm2016).
    """
    blanks = delimiter == "whitespace"
    first = [row.split(None if blanks else delimiter)[0] for row in rows if row.strip()]
    if not blanks and not all(cell.startswith('"') for cell in first):
        return False
    first = [cell.strip('"') for cell in first]
    return len(first) == 2 and all(map(str.isdigit, first)) and int(first[1]) == int(first[0]) + 1


def line_at(
    file: File, content: bytes | mmap.mmap, start: int, dialect: Dialect
) -> tuple[str, int]:
    """Return the line that starts at an offset, and the offset of the next."""
    end = content.find(b"\n", start, start + LONGEST_LINE)
    if end < 0:
        end = len(content)
    if end - start > LONGEST_LINE:
        raise ReadError(endless(content[:start].count(b"\n") + 1), where=file.path)
    text = content[start:end].decode(table_encoding(dialect), errors="replace")
    return text.rstrip("\r"), min(end + 1, len(content))


def endless(line: int) -> str:
    """Return the error message for a line that is longer than any table row."""
    return (
        f"line {line} is longer than {LONGEST_LINE >> 20} MB, as no row of a table is; "
        "export the file with line ends"
    )


def table_encoding(dialect: Dialect) -> str:
    """Return the encoding of the text to parse, which may have been converted to UTF-8."""
    return "utf-8" if is_wide(dialect) else dialect.text.encoding


def is_wide(dialect: Dialect) -> bool:
    """Whether text must be converted to UTF-8: it is UTF-16 or 32, or `missing` is not ASCII."""
    encoding = dialect.text.encoding.lower().replace("_", "-")
    words = not all(word.isascii() for word in dialect.text.missing)
    plain = encoding.startswith(("utf-8", "ascii"))
    return encoding.startswith(("utf-16", "utf-32")) or (words and not plain)


def compiled(pattern: str, dialect: Dialect) -> Guarded[bytes]:
    """Compile a pattern for lines of bytes, in which ``$`` also matches before CR LF."""
    # after "\s*", another repetition of blanks would take quadratic time
    if dialect.text.delimiter == "whitespace" and not _CLASS.search(pattern):
        pattern = re.sub(" +", r"[\\t ]+", pattern)  # blanks were replaced by tabs, see `mended`
    if pattern.endswith("$") and not pattern.endswith((r"\$", r"\s*$")):
        pattern = pattern[:-1] + r"[ \t\r]*$"
    return Guarded(_as_bytes(pattern, table_encoding(dialect)))


def _as_bytes(pattern: str, encoding: str) -> bytes:
    """Return a pattern encoded as bytes; letters of several bytes are escaped and grouped.

    >>> re.search(_as_bytes("^[ ]*\u30fc+$", "cp932"), "  \u30fc".encode("cp932")) is not None
    True
    """
    parts = []
    inside = escaped = False  # within a character class; after a backslash
    for sign in pattern:
        code = sign.encode(encoding, errors="replace")
        plain = sign.isascii() or inside or len(code) == 1
        parts.append(code if plain else b"(?:" + re.escape(code) + b")")
        if not escaped and sign in "[]":
            inside = sign == "["
        escaped = sign == "\\" and not escaped
    return b"".join(parts)
