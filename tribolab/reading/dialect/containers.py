"""Selection of tables and columns in files with named columns, as a dialect states."""

from __future__ import annotations

from pathlib import Path

from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.python_reader import PythonReader
from tribolab.reading.raw.containers.declared_records import read_records
from tribolab.reading.raw.containers.read import read_container
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable
from tribolab.reading.raw.readers import read_with
from tribolab.reading.text.cells import split_name


def open_as(path: Path, dialect: Dialect) -> RawFile:
    """Open a container that a dialect describes.

    Raises
    ------
    ReadError
        If the sheet does not exist, or the file is shorter than a record.
    ImportError
        If the library for it is not installed; other libraries' own errors if it is damaged.
    """
    header = dialect.header
    if isinstance(dialect, PythonReader):
        return read_with(dialect.reader, path)
    if dialect.binary is not None:
        return read_records(path, dialect.binary.record, dialect.binary.offset)
    if dialect.format != "excel":
        return read_container(path, dialect.format)
    # imported late for a quick start
    from tribolab.reading.raw.containers.workbook import read_sheet

    below = header.units == "row"
    return read_sheet(path, header.sheet, header.line or 1, header.skip, units_below=below)


def table_of(file: RawFile, dialect: Dialect) -> RawTable:
    """Return the whole file as one table; of TDMS only the groups of the dialect's columns."""
    if dialect.format != "tdms":
        return file.as_one_table()
    groups = {column.group for column in dialect.column}
    read = [table for table in file.tables if table.name in groups]
    whole = file._replace(tables=tuple(read)).as_one_table()
    # names of channels exclude their group
    return whole._replace(columns=tuple(c for table in read for c in table.columns))


def name_and_unit(column: RawColumn) -> tuple[str, str | None]:
    """Return a column's name without its unit, and the unit, in brackets or stated by the file."""
    name, unit = split_name(column.label)
    return name, unit or column.unit


def column_names(path: Path, dialect: Dialect) -> set[str]:
    """Return the column names of a file, with and without units; empty if it is damaged."""
    try:
        table = table_of(open_as(path, dialect), dialect)
    except Exception:  # then it cannot be from this instrument
        return set()
    named = [name_and_unit(column) for column in table.columns]
    return {name for name, _ in named} | {f"{name} [{unit}]" for name, unit in named if unit}
