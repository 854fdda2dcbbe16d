"""Comparison of a file's content with a dialect; every stated rule must match."""

from __future__ import annotations

import functools
import re

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.dialect.delimited.tables import find_tables
from tribolab.reading.dialect.file_layout import Recognise
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.text_form import as_written
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.reading.text.cells import split_row
from tribolab.reading.text.first_bytes import File, fits_format

_ROWS = 4000  # rows in which two columns are compared; enough to include motion
_FIRST_LINE = re.compile(r"\s*([^\r\n]*)")
_PREAMBLE = 1 << 13  # characters of the preamble that are searched
_LINKED = 0.999  # correlation of one signal in volts and in its unit


def mismatch(file: File, dialect: Dialect) -> str | None:
    """Return why a file cannot be from this instrument; None if it can."""
    rules = dialect.recognise
    if not fits_format(file.format, dialect.format):
        return f"it is {file.format}, not {dialect.format}"
    if rules == Recognise():
        return "the dialect has no rules to recognise it by"
    if rules.file_name and not guarded(rules.file_name).search(file.path.name):
        return "its name does not fit"
    if dialect.format == "mat":
        # imported late for a quick start
        from tribolab.reading.raw.containers.mat import read_variables

        return _names_missing(rules, {found.name for found in read_variables(file.path)})
    if dialect.format == "tdms":
        # imported late for a quick start
        from tribolab.reading.raw.containers.tdms import channel_names

        return _names_missing(rules, channel_names(file.path))
    if dialect.format != "text":
        # imported late for a quick start
        from tribolab.reading.dialect.containers import column_names

        return _names_missing(rules, column_names(file.path, dialect))
    return _text_mismatch(file, dialect)


def _names_missing(rules: Recognise, names: set[str]) -> str | None:
    missing = [name for name in rules.header if name not in names]
    return f"it has no '{shown(missing[0])}'" if missing else None


def _text_mismatch(file: File, dialect: Dialect) -> str | None:
    rules = dialect.recognise
    encoding = "utf-16" if file.head[:2] in (b"\xff\xfe", b"\xfe\xff") else dialect.text.encoding
    text = _text(file.head[: 1 << 16], encoding)
    for pattern in rules.preamble:
        if not guarded(pattern).search(text[:_PREAMBLE]):
            return f"nothing in it matches '{shown(pattern)}'"
    if b"\0" not in file.head:  # quicker than splitting the text into cells
        bare = {name: name.partition(" [")[0] for name in rules.header}
        absent = {
            n for n, word in bare.items() if word.isascii() and word.encode() not in file.head
        }
        if wanted := _names_missing(rules, set(bare) - absent):
            return wanted
    try:
        dialect = as_written(file, dialect)
        raw = find_tables(file, dialect, head_only=True)
    except ReadError as error:
        # if preamble and names match, the file is recognised, so that its error is reported
        named = all(name.partition(" [")[0] in text for name in rules.header)
        return None if rules.preamble and named else str(error)
    names = {
        f"{name} [{unit}]" if unit else name
        for name, unit in zip(raw.tables[0].names, raw.tables[0].units, strict=True)
    } | set(raw.tables[0].names)
    wanted = _names_missing(rules, names)
    if wanted:
        return wanted
    if rules.columns is not None:
        return _numbers_mismatch(text, dialect)
    return None


@functools.lru_cache(maxsize=4)  # a dozen dialects inspect the same file in turn
def _text(head: bytes, encoding: str) -> str:
    text = head.decode(encoding, errors="replace").replace("\r\n", "\n")
    return text.removeprefix("\ufeff")


def _numbers_mismatch(text: str, dialect: Dialect) -> str | None:
    """Return why a table without header lacks the stated number or relation of columns."""
    columns, delimiter = dialect.recognise.columns, dialect.text.delimiter
    first = _FIRST_LINE.match(text)  # this line is enough to exclude most files
    rows = []
    if first and len(split_row(first[1], delimiter)) == columns:
        lines = text.splitlines()[:-1][:_ROWS]
        rows = [split_row(line, delimiter) for line in lines if line.strip()]
    if not rows or any(len(row) != columns for row in rows):
        return f"it does not have {columns} columns"
    try:
        numbers = np.array(rows, dtype=float)
    except ValueError:
        return "it is not all numbers"
    for first_column, other in dialect.recognise.linked:
        a, b = numbers[:, first_column - 1], numbers[:, other - 1]
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            linked = np.ptp(a) > 0 and np.ptp(b) > 0 and abs(np.corrcoef(a, b)[0, 1]) >= _LINKED
        if not linked:
            return f"columns {first_column} and {other} are not the same signal"
    return None
