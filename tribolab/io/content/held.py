"""Runs whose steps are tables beside each other: sheets, groups, elements of a structure."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tribolab.errors import ReadError, shown
from tribolab.io.content.model import Content, Piece
from tribolab.io.content.steps import started
from tribolab.io.dialects.columnar import held_file, steps_of
from tribolab.io.dialects.columns import ReadColumn, resolve, scales_of, symbols
from tribolab.io.dialects.held_tables import HeldFile, HeldTable
from tribolab.io.dialects.model import Dialect
from tribolab.io.tables.columnar import seconds_of
from tribolab.provenance import sha256_of_file

_TOLD = 8  # tables that are named


def read_steps(path: Path, dialect: Dialect) -> Content:
    """Read the tables of a file that are steps of one run, each as a piece.

    Parameters
    ----------
    path
        The file.
    dialect
        Says which tables these are, and which column is which quantity.

    Raises
    ------
    ReadError
        If the file is damaged, no table is called so, or a column of a table is missing.
    """
    file = _opened(path, dialect)
    assert dialect.tables is not None  # whoever comes here has looked
    tables = steps_of(file, dialect)
    if not tables:
        there = ", ".join(shown(table.name, 30) for table in file.tables[:_TOLD]) or "none"
        raise ReadError(
            f"no table is called as '{shown(dialect.tables.steps)}' says; there are {there}",
            where=path,
        )
    pieces = []
    labels: dict[str, str] = {}
    unused: dict[str, None] = {}
    own: dict[str, str] = {}
    scales: dict[str, tuple[float, float]] = {}
    for number, table in enumerate(tables, start=1):
        signals, not_used = _resolved(path, table, dialect)
        before = "\n".join(filter(None, [file.text, table.text]))
        columns = _columns(path, table, signals)
        pieces.append(Piece(columns, number, started(before, path, dialect), before))
        labels |= {s.quantity: f"{s.label} [{s.unit}]" for s in signals}
        unused |= dict.fromkeys(not_used)
        own |= symbols(signals, dialect)
        scales |= scales_of(signals)
    named = ", ".join(table.name for table in tables[:_TOLD])
    notes = {"steps_are": f"{named}, ..." if len(tables) > _TOLD else named}
    sha256 = sha256_of_file(path)
    return Content(path, sha256, pieces, labels, tuple(unused), {}, notes, own, scales)


def read_table(path: Path, dialect: Dialect, name: str) -> dict[str, np.ndarray]:
    """Read those columns of one more table of a file that it holds, in SI.

    Parameters
    ----------
    path, dialect
        As for `read_steps`.
    name
        What the table is called.

    Raises
    ------
    ReadError
        If there is no such table.
    """
    tables = [table for table in _opened(path, dialect).tables if table.name == name]
    if not tables:
        raise ReadError(f"there is no table '{shown(name)}' to read a zero from", where=path)
    columns = tuple(column.model_copy(update={"optional": True}) for column in dialect.column)
    signals, _ = _resolved(path, tables[0], dialect.model_copy(update={"column": columns}))
    return {s.quantity: _numbers(path, tables[0], s) for s in signals}


def _opened(path: Path, dialect: Dialect) -> HeldFile:
    try:
        return held_file(path, dialect)
    except (ReadError, ImportError):
        raise
    except Exception as error:  # each of these libraries has its own ways to say "damaged"
        what = f"this {dialect.format} file cannot be read: {shown(str(error), 200)}"
        raise ReadError(what, where=path) from error


def _resolved(path: Path, table: HeldTable, dialect: Dialect) -> tuple[list[ReadColumn], list[str]]:
    where = f"{path}: table '{shown(table.name, 40)}'"
    return resolve(where, table.names, table.units, len(table.names), dialect)


def _columns(path: Path, table: HeldTable, signals: list[ReadColumn]) -> dict[str, np.ndarray]:
    columns = {signal.quantity: _numbers(path, table, signal) for signal in signals}
    lengths = sorted({len(column) for column in columns.values()})
    if len(lengths) > 1:
        what = f"the columns of '{shown(table.name, 40)}' differ in length: {lengths}"
        raise ReadError(what, where=path)
    return columns


def _numbers(path: Path, table: HeldTable, signal: ReadColumn) -> np.ndarray:
    values = table.arrays[signal.place]
    if values.dtype.kind in "Mm":
        values = seconds_of(values)
    if values.dtype.kind not in "fiub":
        raise ReadError(f"column '{shown(signal.label)}' holds no numbers", where=path)
    with np.errstate(over="ignore", invalid="ignore"):  # damaged numbers may be anything
        return np.asarray(values, dtype=float) * signal.scale + signal.offset
