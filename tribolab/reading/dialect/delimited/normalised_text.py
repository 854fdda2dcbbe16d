"""Normalisation of text that the parser cannot read directly: line ends, encoding, numbers."""

from __future__ import annotations

import codecs
import functools
import re
from collections.abc import Callable
from typing import AnyStr

from tribolab.core.errors import ReadError
from tribolab.reading.dialect.delimited.headers import (
    compiled,
    header_starts,
    is_wide,
    table_encoding,
)
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.text.first_bytes import File
from tribolab.reading.text.number_spelling import (
    is_unusual,
    usual,
    without_commas_in_quotes,
    without_thousands,
)

_ODD_ENDS = 3  # a line end converted twice is CR CR LF; longer ones are unknown


def mended(file: File, dialect: Dialect, head_only: bool) -> bytes | None:
    """Return the normalised content (or head); None if the file can be parsed directly."""
    memory = _normalise_lines(file, dialect, head_only)
    if not head_only:
        memory = _skip_lines(file, memory, dialect)
    respell = _number_normaliser(dialect, file.head)
    return (
        memory if respell is None else _normalise_numbers(file, memory, dialect, respell, head_only)
    )


def _normalise_lines(file: File, dialect: Dialect, head_only: bool) -> bytes | None:
    """Return the content as UTF-8 with LF; None if encoding and line ends are usable."""
    head = file.head
    wide = is_wide(dialect) or head.startswith((b"\xff\xfe", b"\xfe\xff"))
    odd_ends = b"\r" in head and re.search(rb"\r(?!\n)", head[:-1]) is not None
    spaced = dialect.text.delimiter == "whitespace"
    if not (wide or odd_ends or spaced):
        return None
    content = _content(file, head_only)
    if wide:
        marked = head[:2] in (b"\xff\xfe", b"\xfe\xff")
        decoder = codecs.getincrementaldecoder("utf-16" if marked else dialect.text.encoding)()
        try:
            content = decoder.decode(content, final=not head_only).encode()
        except UnicodeDecodeError as error:
            raise ReadError(f"{file.path}: the file cannot be read: {error}") from error
    content = line_feeds(content)
    return _tabs_for_blanks(content) if spaced else content


def _content(file: File, head_only: bool) -> bytes:
    try:
        return file.head if head_only else file.path.read_bytes()
    except OSError as error:
        raise ReadError(f"{file.path}: the file cannot be read: {error}") from error


def line_feeds(content: AnyStr) -> AnyStr:
    r"""Return text or bytes with LF instead of any other line end.

    Examples
    --------
    >>> line_feeds("one\rtwo\r\nthree\r\r\n\nfive")
    'one\ntwo\nthree\n\nfive'
    """
    cr, lf = ("\r", "\n") if isinstance(content, str) else (b"\r", b"\n")
    for _ in range(_ODD_ENDS):
        content = content.replace(cr + lf, lf)
    return content.replace(cr, lf)


def _tabs_for_blanks(content: bytes) -> bytes:
    """Replace blanks between the cells of a line by one tab, and remove those around them.

    Regular expressions would take quadratic time for a row of blanks.
    """
    content = content.replace(b" ", b"\t")
    while b"\t\t" in content:
        content = content.replace(b"\t\t", b"\t")
    content = content.replace(b"\n\t", b"\n").replace(b"\t\n", b"\n")
    return content.removeprefix(b"\t").removesuffix(b"\t")


def _skip_lines(file: File, content: bytes | None, dialect: Dialect) -> bytes | None:
    """Return the content without the lines that match `skip_lines`, below the first header."""
    if dialect.text.skip_lines is None:
        return content
    content = _content(file, False) if content is None else content
    header = dialect.header
    starts = header_starts(file, content, dialect)
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


def _number_normaliser(dialect: Dialect, head: bytes) -> Callable[[str], str] | None:
    """Return a function that normalises a table's numbers; None if they are already readable."""
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


@functools.lru_cache(maxsize=4)  # dozens of dialects inspect the same head in turn
def _is_unusual(head: bytes, encoding: str) -> bool:
    return is_unusual(head.decode(encoding, errors="replace"))


def _normalise_numbers(
    file: File,
    content: bytes | None,
    dialect: Dialect,
    respell: Callable[[str], str],
    head_only: bool,
) -> bytes:
    """Return the content with normalised numbers in the table; the preamble is unchanged."""
    content = _content(file, head_only) if content is None else content
    start = header_starts(file, content, dialect)[0]
    encoding = table_encoding(dialect)
    table = respell(content[start:].decode(encoding, errors="surrogateescape"))
    return content[:start] + table.encode(encoding, errors="surrogateescape")
