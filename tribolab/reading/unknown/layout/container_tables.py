"""Layout of unknown files with named columns: Excel, Parquet, Feather, HDF5, MAT, TDMS and npz.

Their columns become a table below a line of names, with unchanged numbers.
"""

from __future__ import annotations

import datetime as dt
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.dialect.containers import name_and_unit
from tribolab.reading.lexicon.lexicon import known_words
from tribolab.reading.numbers import decimal
from tribolab.reading.raw.clocks import INTERVAL_PATTERN, OneClock, on_one_clock
from tribolab.reading.raw.containers.read import CONTAINERS, read_container
from tribolab.reading.raw.containers.workbook import read_sheet, sheets_of
from tribolab.reading.raw.model import RawColumn, RawFile, Setting, text_of
from tribolab.reading.si_tables.containers import seconds_of
from tribolab.reading.text.cells import split_name
from tribolab.reading.text.first_bytes import File
from tribolab.reading.unknown.layout.header import Block, Heading, names_any
from tribolab.reading.unknown.layout.text_layout import Held, Layout
from tribolab.reading.unknown.model import Understood

DRAFTED_FROM = CONTAINERS | {"excel"}


def layout_of_columns(file: File) -> tuple[Layout, tuple[HeldColumn, ...]]:
    """Return the columns of a file as a table below a line of names, and the columns themselves.

    Raises
    ------
    ReadError
        If the file has no columns of numbers of equal length, or is damaged.
    """
    try:
        held, raw = _workbook(file) if file.container == "excel" else _container(file)
    except (ReadError, ImportError):
        raise
    except Exception as error:  # each of these libraries reports damage differently
        raise ReadError(f"this {file.container} file cannot be read", where=file.path) from error
    placed, settings, clocks, guesses = _whole(raw)
    text = text_of(([clocks.setting] if clocks else []) + settings)
    every = [_held(column, table, held.form) for table, column in placed]
    every = [column for column in every if column.values.dtype.kind in "fiu" and column.values.size]
    length = max((c.values.size for c in every), default=0)
    columns = one_of_each([c for c in every if c.values.size == length])
    if not columns or length < 2:
        raise ReadError("no columns of numbers are in the file", where=file.path)
    if held.form != "excel":
        held = held._replace(others=others_alike(columns, every))
    held = held._replace(increment=clocks.clock.interval if clocks else 0.0)
    if held.others:
        guesses = (*guesses, f"the longest of several alike is meant, not {held.others}")
    layout = _laid_out(file, columns, text, length)
    return layout._replace(held=held, guesses=guesses), tuple(columns)


def _container(file: File) -> tuple[Held, RawFile]:
    """Return the format of a container file, and its tables."""
    form = {"netcdf": "hdf5"}.get(file.container, file.container)  # both have the same first bytes
    return Held(form), _without_units(read_container(file.path, form))


def _workbook(file: File) -> tuple[Held, RawFile]:
    """Return the location and the content of the main sheet of a workbook."""
    held = main_sheet(file.path)
    sheet = read_sheet(file.path, held.sheet, held.line, units_below=held.units_below)
    return held, _without_units(sheet)


def _without_units(raw: RawFile) -> RawFile:
    """Return the file with the units of columns removed from labels and paths."""
    tables = []
    for table in raw.tables:
        columns = []
        for column in table.columns:
            name, unit = name_and_unit(column)
            path = split_name(column.path)[0]
            columns.append(column._replace(label=name, unit=unit, path=path))
        tables.append(table._replace(columns=tuple(columns)))
    return raw._replace(tables=tuple(tables))


_Placed = list[tuple[str, RawColumn]]  # columns, each with the name of its table


def _whole(raw: RawFile) -> tuple[_Placed, list[Setting], OneClock | None, tuple[str, ...]]:
    """Return all columns (interpolated to one clock if each has one), settings, clock and doubts.

    Of TDMS channels without a common clock, only the group with the most numbers is returned.
    """
    placed = [(t.name, c) for t in raw.tables for c in t.columns if c.values.size]
    doubts: tuple[str, ...] = ()
    try:
        clocks = on_one_clock([column for _, column in placed])
    except ReadError as error:
        clocks, doubts = None, (str(error),)
    if clocks is None and raw.container == "tdms" and len(raw.tables) > 1:
        best = max(raw.tables, key=lambda table: sum(c.values.size for c in table.columns))
        return (*_whole(raw._replace(tables=(best,)))[:3], doubts)
    if clocks is not None:
        values = zip(placed, clocks.values, strict=True)
        placed = [(name, column._replace(values=x)) for (name, column), x in values]
    return placed, list(raw.as_one_table().settings), clocks, doubts


def _held(column: RawColumn, table: str, form: str) -> HeldColumn:
    """Return a column with the name that the reader uses; dates become seconds from the first."""
    label, unit, values = column.label, column.unit, column.values
    name = label if form == "tdms" else column.path or label
    if values.dtype.kind in "Mm":
        seconds = seconds_of(values)
        known = seconds[np.isfinite(seconds)]
        passed = seconds - known[0] if known.size else seconds
        return HeldColumn(name, label, "s", passed, table, said=False, shown=f"time {label}")
    return HeldColumn(name, label, unit, values, table, shown=better_name(label, column.meaning))


def _laid_out(file: File, columns: Sequence[HeldColumn], text: str, rows: int) -> Layout:
    """Return the layout of a table of `rows` rows below a text and a line of column names."""
    cells = tuple(_cell(column) for column in columns)
    if not any(cells):
        raise ReadError("its columns have no names", where=file.path)
    lines = [*text.split("\n"), "\t".join(cells)] if text else ["\t".join(cells)]
    heading = Heading(len(lines) - 1, None, cells, (), True)
    shown = min(rows, ROWS)
    block = Block(len(lines), len(lines), tuple(range(shown)), len(cells), heading)
    numbers = np.empty((shown, len(columns)))
    for place, column in enumerate(columns):
        numbers[:, place] = column.values[:shown]
    return Layout(file, "\t", len(cells), tuple(lines), (block,), heading, numbers=numbers)


def _cell(column: HeldColumn) -> str:
    """Return the header cell of a column: its name or meaning, with the unit in brackets."""
    name = " ".join((column.shown or column.label).split())
    return f"{name} [{column.unit}]" if column.unit else name


def as_held(understood: Understood, columns: Sequence[HeldColumn], held: Held) -> Understood:
    """Return the interpretation with the column names by which the reader finds the columns."""
    named = []
    for column, own in zip(understood.columns, columns, strict=True):
        unit = column.unit if own.said or column.unit is not None else own.unit
        group = own.table if held.form == "tdms" else ""
        column = column._replace(name=own.name, group=group, occurrence=1)
        named.append(column._replace(unit=unit))
    timed = any(column.used and column.quantity == "time" for column in named)
    if held.increment and understood.kind == "run" and not timed:
        understood = understood._replace(rate_pattern=INTERVAL_PATTERN, rate_unit="s")
    return understood._replace(columns=tuple(named), missing=())


ROWS = 20_000  # rows that are inspected
_LISTED = 4  # other tables that are named in a guess


class HeldColumn(NamedTuple):
    """Column of a file: name for the reader, label in the table, unit and numbers.

    `said` is True if the reader finds the unit in the file; `shown` is a name for interpretation
    if the label has no meaning.
    """

    name: str
    label: str
    unit: str | None
    values: np.ndarray
    table: str = ""
    said: bool = True
    shown: str = ""


def better_name(name: str, meaning: str) -> str:
    """Return the description of a column if its name alone has no meaning; else "".

    >>> better_name("F_nrm", "normal force, by the leaf spring"), better_name("Fx", "lateral force")
    ('normal force', '')
    """
    words = re.split(r"[,;:(\[]|\s[-–—]\s", meaning)[0].strip()
    quantities = [word.quantity for word in known_words("run")]
    if not words or names_any(name, *quantities) or not names_any(words, *quantities):
        return ""
    return words


def one_of_each(columns: Sequence[HeldColumn]) -> list[HeldColumn]:
    """Return the columns without tables whose column names an earlier table also has."""
    kept: dict[str, set[str]] = {}
    left: set[str] = set()
    tables: dict[str, list[str]] = {}
    for column in columns:
        tables.setdefault(column.table, []).append(column.label)
    for table, names in tables.items():
        if len(names) > 1 and any(len(set(names) & known) > 1 for known in kept.values()):
            left.add(table)
        else:
            kept[table] = set(names)
    return [column for column in columns if column.table not in left]


def others_alike(chosen: Sequence[HeldColumn], every: Sequence[HeldColumn]) -> str:
    """Return the names of other tables that have the column names of the chosen one, or ""."""
    names = {column.label for column in chosen}
    meant = set(map(id, chosen))
    alike: dict[str, int] = {}
    for column in every:
        if id(column) not in meant and column.label in names:
            alike[column.table] = alike.get(column.table, 0) + 1
    tables = [f"'{shown(table, 30)}'" for table, count in alike.items() if table and count > 1]
    return ", ".join(tables[:_LISTED])


_ABOVE = 40  # rows of a sheet above its names
_MOMENTS = (dt.datetime, dt.time, dt.timedelta)


def main_sheet(path: Path) -> Held:
    """Return the sheet with the most rows of numbers, and the line of its column names.

    Raises
    ------
    ReadError
        If no sheet has such rows.
    """
    tables: list[tuple[int, Held, set[str]]] = []
    for sheet, rows in sheets_of(path, ROWS).items():
        place = _names_row(rows)
        if place is not None:
            held = Held("excel", sheet, place + 1, not _is_numeric(rows[place + 1]))
            tables.append((len(rows) - place, held, {str(c) for c in rows[place] if c != ""}))
    if not tables:
        raise ReadError("no sheet holds numbers below names", where=path)
    _, held, names = max(tables, key=lambda table: table[0])
    alike = [t[1].sheet for t in tables if t[1] is not held and len(t[2] & names) > 1]
    return held._replace(others=", ".join(f"'{shown(sheet, 30)}'" for sheet in alike[:4]))


def _names_row(rows: Sequence[Sequence[object]]) -> int | None:
    """Return the index of the first row of words above numbers, or above units and numbers."""
    for index in range(min(len(rows) - 2, _ABOVE)):
        words = [cell for cell in rows[index] if isinstance(cell, str) and cell.strip()]
        if len(words) < 2 or _is_numeric(rows[index]):
            continue
        if _is_numeric(rows[index + 1]):
            return index
        units = sum(1 for cell in rows[index + 1] if isinstance(cell, str) and cell.strip())
        if 2 * units >= len(words) and _is_numeric(rows[index + 2]):
            return index
    return None


def _is_numeric(row: Sequence[object]) -> bool:
    filled = [cell for cell in row if cell not in ("", None)]
    numbers = sum(map(_is_number, filled))
    return numbers >= 2 and 2 * numbers >= len(filled)


def _is_number(cell: object) -> bool:
    """Whether a cell is a number, a date or time, or a number that was typed as text."""
    if isinstance(cell, str):
        return not math.isnan(decimal(cell))
    return isinstance(cell, (int, float, *_MOMENTS)) and not isinstance(cell, bool)
