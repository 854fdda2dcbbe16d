"""Opening of files with named columns, by a dialect or by a reader in Python."""

from __future__ import annotations

import re
from pathlib import Path

from tribolab.reading.dialect.column_rule import Column
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.time_rule import Speed, Time
from tribolab.reading.raw.clocks import INTERVAL_PATTERN
from tribolab.reading.raw.containers.declared_records import read_records
from tribolab.reading.raw.containers.read import read_container
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable
from tribolab.reading.raw.readers import answers, read_with, source_of
from tribolab.reading.text.cells import split_name
from tribolab.units.quantities import QUANTITIES


def open_as(path: Path, dialect: Dialect) -> RawFile:
    """Read the tables and settings of a container file as its dialect describes.

    Raises
    ------
    ReadError
        If the sheet does not exist, or the file is shorter than a record.
    ImportError
        If the library for the format is not installed. Damage may raise other errors.
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
    """Return all tables of a file as one; of TDMS only the groups that the dialect names."""
    if dialect.format != "tdms":
        return file.as_one_table()
    groups = {column.group for column in dialect.column}
    read = [table for table in file.tables if table.name in groups]
    whole = file._replace(tables=tuple(read)).as_one_table()
    # names of channels exclude their group
    return whole._replace(columns=tuple(c for table in read for c in table.columns))


def name_and_unit(column: RawColumn) -> tuple[str, str | None]:
    """Return a column's name, and its unit: in brackets after the name, or stated by the file."""
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


class PythonReader(Dialect):
    """Instrument whose files a Python reader opens; `reader` is its path or name."""

    reader: str


def python_reader(name: str) -> PythonReader:
    """Return a dialect for the files of a Python reader; columns are added for each file.

    Parameters
    ----------
    name
        Path of a Python file, or the name of an installed reader.

    Raises
    ------
    ConfigError
        If the file does not exist.
    """
    source = source_of(name)
    called = re.sub(r"[^a-z0-9]+", "_", Path(name).stem.lower()).strip("_") or "reader"
    time = Column(quantity="time", name="time")
    title = f"files that {source.name} reads"
    return PythonReader(name=called, title=title, format="hdf5", column=(time,), reader=name)


def recognised_by(head: bytes) -> list[Dialect]:
    """Return the installed readers that answer "yes" to the first bytes of a file, else "maybe"."""
    said = answers(head)
    sure = [name for name, answer in said.items() if answer == "yes"]
    return [python_reader(name) for name in sure or said]


def with_columns(dialect: PythonReader, path: Path) -> PythonReader:
    """Return a reader's dialect with the columns found in a file.

    Raises
    ------
    ReadError
        If the reader cannot read it.
    """
    columns = read_with(dialect.reader, path).as_one_table().columns
    names = dict.fromkeys(column.label for column in columns if column.label in QUANTITIES)
    found = tuple(Column(quantity=name, name=name, optional=name != "time") for name in names)
    clocked = "time" not in names and all(column.clock for column in columns)
    if "time" not in names and "height" not in names and not clocked:
        found = (*dialect.column, *found)  # missing time is reported later
    source = next((s for s, name in _SPEED_FROM if name in names), "none")
    update = {"column": found, "speed": Speed.model_validate({"source": source})}
    if clocked:
        update["time"] = Time(source="rate", rate_pattern=INTERVAL_PATTERN, rate_unit="s")
    return dialect.model_copy(update=update)


_SPEED_FROM = (("column", "sliding_velocity"), ("position", "position"))
