"""Unknown files with named columns: Excel, Parquet, Feather, HDF5, MAT, TDMS and npz.

Their columns are laid out as a table below a line of names, with their numbers as they are.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.content.containers import seconds_of
from tribolab.reading.dialect.containers import name_and_unit
from tribolab.reading.raw.clocks import INTERVAL_PATTERN, OneClock, on_one_clock
from tribolab.reading.raw.containers.read import CONTAINERS, read_container
from tribolab.reading.raw.containers.workbook import read_sheet
from tribolab.reading.raw.model import RawColumn, RawFile, Setting, text_of
from tribolab.reading.text.cells import split_name
from tribolab.reading.text.first_bytes import File
from tribolab.reading.unknown.layout.container_column import (
    ROWS,
    HeldColumn,
    better_name,
    one_of_each,
    others_alike,
)
from tribolab.reading.unknown.layout.header import Block, Heading
from tribolab.reading.unknown.layout.sheets import main_sheet
from tribolab.reading.unknown.layout.text_layout import Held, Layout
from tribolab.reading.unknown.model import Understood

DRAFTED_FROM = CONTAINERS | {"excel"}


def layout_of_columns(file: File) -> tuple[Layout, tuple[HeldColumn, ...]]:
    """Lay the columns of a file out as a table below a line of names.

    Raises
    ------
    ReadError
        If it has no columns of numbers of equal length, or is damaged.
    """
    try:
        held, raw = _workbook(file) if file.container == "excel" else _container(file)
    except (ReadError, ImportError):
        raise
    except Exception as error:  # each of these libraries reports damage in its own way
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
    """Return where columns are in a container, and its tables."""
    form = {"netcdf": "hdf5"}.get(file.container, file.container)  # both begin alike
    return Held(form), _without_units(read_container(file.path, form))


def _workbook(file: File) -> tuple[Held, RawFile]:
    """Return the main sheet of a workbook."""
    held = main_sheet(file.path)
    sheet = read_sheet(file.path, held.sheet, held.line, units_below=held.units_below)
    return held, _without_units(sheet)


def _without_units(raw: RawFile) -> RawFile:
    """Return a file with the units of columns apart from their labels and paths."""
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
    """Return all columns, on one clock if each has one, the settings, and doubts about the clock.

    Of channels that have no common clock those of the group with most numbers are returned.
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
    """Return a column, of moments as seconds from the first."""
    label, unit, values = column.label, column.unit, column.values
    name = label if form == "tdms" else column.path or label
    if values.dtype.kind in "Mm":
        seconds = seconds_of(values)
        known = seconds[np.isfinite(seconds)]
        passed = seconds - known[0] if known.size else seconds
        return HeldColumn(name, label, "s", passed, table, said=False, shown=f"time {label}")
    return HeldColumn(name, label, unit, values, table, shown=better_name(label, column.meaning))


def _laid_out(file: File, columns: Sequence[HeldColumn], text: str, rows: int) -> Layout:
    """Return the layout of a table of so many rows, below a text and the names of columns."""
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
    """Return a column's label or meaning, with its unit."""
    name = " ".join((column.shown or column.label).split())
    return f"{name} [{column.unit}]" if column.unit else name


def as_held(understood: Understood, columns: Sequence[HeldColumn], held: Held) -> Understood:
    """Return what was understood, with the columns named as the file's reader finds them."""
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
