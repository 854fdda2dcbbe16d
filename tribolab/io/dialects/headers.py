"""Delimited text: where its tables start and end, and what their headers say."""

from __future__ import annotations

import codecs
import functools
import mmap
import re
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import AnyStr, NamedTuple

from tribolab.errors import ReadError, shown
from tribolab.io import cures
from tribolab.io.dialects.model import Dialect
from tribolab.io.dialects.patterns import Guarded
from tribolab.io.dialects.signature import File, peek
from tribolab.io.dialects.spelling import is_unusual, usual, without_commas_in_quotes
from tribolab.io.dialects.thousands import without_thousands

_BOM = b"\xef\xbb\xbf"
# one class of letters: a repeated group would take sixty bytes of memory for each line
_BLANK = re.compile(rb"(?:[ \t\r\n]*\n)?")
_ODD_ENDS = 3  # a line end that went through two programs is CR CR LF; more were not seen
LONGEST_LINE = 4 << 20  # bytes: some 300 000 columns; what is longer is no row of a table


class Table(NamedTuple):
    """One table of a text file: offsets of its first byte and of the byte after its last."""

    names: tuple[str, ...]
    units: tuple[str | None, ...]
    width: int
    start: int
    stop: int
    line: int
    before: str


class RawText(NamedTuple):
    """A text file on disk, or its content in memory if its line ends had to be mended."""

    file: File
    memory: bytes | None
    tables: tuple[Table, ...]

    @property
    def preamble(self) -> str:
        """Text before the first table."""
        return self.tables[0].before


def split_name(text: str) -> tuple[str, str | None]:
    """Separate a header's name from the unit in its brackets.

    >>> split_name("Fx [N]")
    ('Fx', 'N')
    >>> split_name("COF")
    ('COF', None)
    """
    text = text.strip()
    start = max(text.rfind("["), text.rfind("("))
    unit = text[start + 1 : -1]
    if start < 0 or not text.endswith(("]", ")")) or "]" in unit or ")" in unit:
        return text, None
    return text[:start].strip(), unit.strip() or None


def split_row(line: str, delimiter: str) -> list[str]:
    """Cells of one line, without quotes and blanks around them.

    >>> split_row('1.5, "run, 2" ,3', ",")
    ['1.5', 'run, 2', '3']
    """
    if delimiter == "whitespace":
        cells = line.split()
    elif '"' in line:
        cells = _outside_quotes(line, delimiter)
    else:
        cells = line.split(delimiter)
    return [cell.strip().strip('"').strip() for cell in cells]


_QUOTED = re.compile(r'"[^"]*"')


def _outside_quotes(line: str, delimiter: str) -> list[str]:
    """Cells of a line in which a delimiter between quotes parts nothing."""
    texts = _QUOTED.findall(line)
    if not any(delimiter in text for text in texts):
        return line.split(delimiter)
    cells = [""]
    for part, text in zip(_QUOTED.split(line), [*texts, ""], strict=True):
        first, *more = part.split(delimiter)
        cells[-1] += first
        cells += more
        cells[-1] += text
    return cells


def find_tables(path: str | Path | File, dialect: Dialect, *, head_only: bool = False) -> RawText:
    """Find the tables of a text file.

    Parameters
    ----------
    path
        The file.
    dialect
        How the file is written.
    head_only
        Whether its first megabyte is enough, as it is to recognise a file.

    Raises
    ------
    ReadError
        If there is no header where the dialect expects it, or nothing stands below it.
    """
    file = path if isinstance(path, File) else peek(path)
    memory = _mended(file, dialect, head_only)
    if not head_only:
        memory = _without_lines(file, memory, dialect)
    respell = respelling(dialect, file.head)
    if respell is not None:
        memory = _respelt(file, memory, dialect, respell, head_only)
    if memory is not None:
        return RawText(file, memory, tuple(_scan(file, memory, len(memory), dialect)))
    if head_only or not dialect.header.repeats:
        return RawText(file, None, tuple(_scan(file, file.head, file.size, dialect)))
    try:
        with file.path.open("rb") as handle, mmap.mmap(handle.fileno(), 0, prot=1) as content:
            return RawText(file, None, tuple(_scan(file, content, len(content), dialect)))
    except (OSError, ValueError) as error:
        raise ReadError(f"{file.path}: the file cannot be read any more: {error}") from error


def _mended(file: File, dialect: Dialect, head_only: bool) -> bytes | None:
    """Whole content as UTF-8 with LF, where line ends or encoding forbid reading it as it lies."""
    head = file.head
    wide = dialect.text.encoding.lower().replace("_", "-").startswith(("utf-16", "utf-32"))
    wide = wide or head.startswith((b"\xff\xfe", b"\xfe\xff"))
    odd_ends = b"\r" in head and re.search(rb"\r(?!\n)", head[:-1]) is not None
    spaced = dialect.text.delimiter == "whitespace"
    if not (wide or odd_ends or spaced):
        return None
    try:
        content = head if head_only else file.path.read_bytes()
        if wide:
            marked = head[:2] in (b"\xff\xfe", b"\xfe\xff")
            decoder = codecs.getincrementaldecoder("utf-16" if marked else dialect.text.encoding)()
            content = decoder.decode(content, final=not head_only).encode()
    except (OSError, UnicodeDecodeError) as error:
        raise ReadError(f"{file.path}: the file cannot be read: {error}") from error
    content = line_feeds(content)
    return _tabbed(content) if spaced else content


def line_feeds(content: AnyStr) -> AnyStr:
    r"""Return text or bytes with LF at the end of each line, whatever stood there.

    Examples
    --------
    >>> line_feeds("one\rtwo\r\nthree\r\r\n\nfive")
    'one\ntwo\nthree\n\nfive'
    """
    cr, lf = ("\r", "\n") if isinstance(content, str) else (b"\r", b"\n")
    for _ in range(_ODD_ENDS):
        content = content.replace(cr + lf, lf)
    return content.replace(cr, lf)


def _tabbed(content: bytes) -> bytes:
    """Put one tab between the cells of a line and none around them, whatever blanks there were.

    Patterns would take a time that grows with the square of a row of blanks.
    """
    content = content.replace(b" ", b"\t")
    while b"\t\t" in content:
        content = content.replace(b"\t\t", b"\t")
    content = content.replace(b"\n\t", b"\n").replace(b"\t\n", b"\n")
    return content.removeprefix(b"\t").removesuffix(b"\t")


def _without_lines(file: File, content: bytes | None, dialect: Dialect) -> bytes | None:
    """Whole content without the lines below the first header that are to be passed over."""
    if dialect.text.skip_lines is None:
        return content
    try:
        content = file.path.read_bytes() if content is None else content
    except OSError as error:
        raise ReadError(f"{file.path}: the file cannot be read: {error}") from error
    header = dialect.header
    starts = _header_starts(file, content, dialect)
    first = content.count(b"\n", 0, starts[0])
    deep = header.skip + (header.units_line if header.units == "row" else 0)
    whole = header.line is not None or header.pattern is not None
    kept = {content.count(b"\n", 0, start) + k for start in starts for k in range(deep + whole)}
    pattern = compiled(dialect.text.skip_lines, dialect)
    return b"\n".join(
        line
        for number, line in enumerate(content.split(b"\n"))
        if number < first or number in kept or not pattern.search(line)
    )


def respelling(dialect: Dialect, head: bytes) -> Callable[[str], str] | None:
    """Return what makes a table's numbers such as the parser reads; None where they are."""
    text = dialect.text
    steps: list[Callable[[str], str]] = []
    if text.thousands:
        steps.append(lambda table: without_thousands(table, text.thousands, text.delimiter))
    if text.is_quoted:
        steps.append(without_commas_in_quotes)
    if _is_unusual(head, text.encoding):
        steps.append(usual)
    if not steps:
        return None
    return lambda table: functools.reduce(lambda so_far, step: step(so_far), steps, table)


@functools.lru_cache(maxsize=4)  # dozens of dialects look at the same head, one after the other
def _is_unusual(head: bytes, encoding: str) -> bool:
    return is_unusual(head.decode(encoding, errors="replace"))


def _respelt(
    file: File,
    content: bytes | None,
    dialect: Dialect,
    respell: Callable[[str], str],
    head_only: bool,
) -> bytes:
    """Content whose table's numbers are written as the parser reads them; the text before stays."""
    if content is None:
        try:
            content = file.head if head_only else file.path.read_bytes()
        except OSError as error:
            raise ReadError("the file cannot be read", where=file.path) from error
    start = _header_starts(file, content, dialect)[0]
    encoding = _encoding(dialect)
    table = respell(content[start:].decode(encoding, errors="surrogateescape"))
    return content[:start] + table.encode(encoding, errors="surrogateescape")


def _scan(file: File, content: bytes | mmap.mmap, size: int, dialect: Dialect) -> list[Table]:
    """Tables in `content`, the start of (or the whole of) a file of `size` bytes."""
    header, text = dialect.header, dialect.text
    starts = _header_starts(file, content, dialect)
    end = compiled(text.end, dialect) if text.end else None
    tables: list[Table] = []
    origin = 3 if content[:3] == _BOM else 0
    line, counted = 1, 0
    for number, start in enumerate(starts):
        limit = starts[number + 1] if number + 1 < len(starts) else size
        here, names, units = _read_header(file, content, start, dialect)
        blank = _BLANK.match(content, here)
        body = blank.end() if blank else here
        stop = limit
        if end is not None and (last := end.search(content, body, min(limit, len(content)))):
            stop = last.start()
        width = len(split_row(_line(file, content, body, dialect)[0], text.delimiter))
        before = _decode(content[origin : start if start > origin else body], file, dialect)
        if header.line is None and header.pattern is None and not header.skip:
            before = ""
        line, counted = line + content[counted:body].count(b"\n"), body
        if body < stop:
            tables.append(Table(names, units, width, body, stop, line, before))
        origin = min(stop, len(content))
    if not tables:
        raise ReadError(f"{file.path}: the file has a header, but no row of numbers below it")
    return tables


def _header_starts(file: File, content: bytes | mmap.mmap, dialect: Dialect) -> list[int]:
    """Offsets of the header lines."""
    header = dialect.header
    first = 3 if content[:3] == _BOM else 0
    if header.pattern is not None:
        matches = compiled(header.pattern, dialect).all(content, first)
        wanted = None if header.repeats else 1  # looking for more would read the whole head
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
                f"{file.path}: the header should stand in line {header.line}, but the file (or "
                "its first megabyte) has fewer lines"
            )
    return [position]


def _read_header(
    file: File, content: bytes | mmap.mmap, start: int, dialect: Dialect
) -> tuple[int, tuple[str, ...], tuple[str | None, ...]]:
    """Offset after the header block, names and units."""
    header, delimiter = dialect.header, dialect.text.delimiter
    if header.line is None and header.pattern is None:
        for _ in range(header.skip):
            start = _line(file, content, start, dialect)[1]
        return start, (), ()
    line, here = _line(file, content, start, dialect)
    names, units = _columns(line, delimiter, header.units == "brackets")
    if header.units == "row":
        for _ in range(header.units_line):
            line, here = _line(file, content, here, dialect)
        if not line.strip() and line:  # a row of delimiters between names and units
            line, here = _line(file, content, here, dialect)
        row = [unit.strip("[]() ") or None for unit in split_row(line, delimiter)]
        units = tuple((row + [None] * len(names))[: len(names)])
    for _ in range(header.skip):
        here = _line(file, content, here, dialect)[1]
    return here, names, units


@functools.lru_cache(maxsize=2)  # a dozen dialects look at the same header, one after the other
def _columns(
    line: str, delimiter: str, brackets: bool
) -> tuple[tuple[str, ...], tuple[str | None, ...]]:
    """Names of the columns in a header's line, and their units if these stand in brackets."""
    cells = split_row(line, delimiter)
    if not brackets:
        return tuple(cells), (None,) * len(cells)
    names, units = zip(*map(split_name, cells), strict=True)
    return names, units


def _line(file: File, content: bytes | mmap.mmap, start: int, dialect: Dialect) -> tuple[str, int]:
    """Return the line that starts at an offset, and the offset of the next."""
    end = content.find(b"\n", start, start + LONGEST_LINE)
    if end < 0:
        end = len(content)
    if end - start > LONGEST_LINE:
        raise ReadError(endless(content[:start].count(b"\n") + 1), where=file.path)
    text = content[start:end].decode(_encoding(dialect), errors="replace")
    return text.rstrip("\r"), min(end + 1, len(content))


def endless(line: int) -> str:
    """Say that a line is longer than any row of a table."""
    return (
        f"line {line} is longer than {LONGEST_LINE >> 20} MB, as no row of a table is; was the "
        "file written without line ends, or is it damaged?"
    )


def _encoding(dialect: Dialect) -> str:
    wide = dialect.text.encoding.lower().startswith(("utf-16", "utf-32", "utf_16", "utf_32"))
    return "utf-8" if wide else dialect.text.encoding


def _decode(content: bytes, file: File, dialect: Dialect) -> str:
    try:
        return content.decode(_encoding(dialect)).replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise ReadError(
            f"{file.path}: byte {error.start} is not {dialect.text.encoding}; name the encoding "
            "in the dialect, e.g. encoding = 'latin-1'"
        ) from error


def compiled(pattern: str, dialect: Dialect) -> Guarded[bytes]:
    """Return a pattern for lines of raw bytes: ``$`` also stands before CR LF."""
    # behind "\s*", a second wish for blanks would take a time that grows with their number squared
    if pattern.endswith("$") and not pattern.endswith((r"\$", r"\s*$")):
        pattern = pattern[:-1] + r"[ \t\r]*$"
    return Guarded(pattern.encode(_encoding(dialect), errors="replace"))
