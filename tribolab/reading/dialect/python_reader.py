"""Dialect of a reader in Python, whose columns are named by quantities."""

from __future__ import annotations

import re
from pathlib import Path

from tribolab.reading.dialect.column_rule import Column
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.time_rule import Speed, Time
from tribolab.reading.raw.clocks import INTERVAL_PATTERN
from tribolab.reading.raw.readers import answers, read_with, source_of
from tribolab.units.quantities import QUANTITIES


class PythonReader(Dialect):
    """Instrument whose files a Python reader opens; `reader` is its path or name."""

    reader: str


def python_reader(name: str) -> PythonReader:
    """Return the dialect of a reader; its columns become known with a file.

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
    """Return the installed readers that accept a file by its first bytes; else those that may."""
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
