"""Tables of numbers and settings of a file, independent of its format."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

MAX_SETTINGS = 200  # a file of parameters has fewer, an event log more


class Place(NamedTuple):
    """Position in a file for messages: a line and a cell, or a path inside the file."""

    path: str = ""
    line: int | None = None
    column: int | None = None


class Setting(NamedTuple):
    """Setting stated in a file outside its columns, e.g. "radius: 15 mm" or an attribute.

    `key` is empty for text alone, such as a title.
    """

    key: str
    text: str
    place: Place = Place()

    @property
    def line(self) -> str:
        """Setting as text for the patterns of a dialect."""
        return f"{self.key}: {self.text}" if self.key else self.text


class Clock(NamedTuple):
    """Sampling times of a column: first time [s] and interval [s]."""

    start: float
    interval: float

    def times(self, rows: int) -> np.ndarray:
        """Return the sampling times [s] of the first `rows` values (row)."""
        return self.start + self.interval * np.arange(rows)


class RawColumn(NamedTuple):
    """Column with its label and unit in the file, and its numbers (row).

    `meaning` is a further description in the file; `path` its name in a file whose tables are
    joined. `clock` are its own sampling times, if any.
    """

    label: str
    unit: str | None
    values: np.ndarray
    meaning: str = ""
    path: str = ""
    clock: Clock | None = None


class RawTable(NamedTuple):
    """Table with its name (of a sheet or group, "" for a whole file) and columns."""

    name: str
    columns: tuple[RawColumn, ...]
    settings: tuple[Setting, ...] = ()

    @property
    def rows(self) -> int:
        """Number of rows of the longest column."""
        return max((column.values.size for column in self.columns), default=0)


class RawFile(NamedTuple):
    """Tables of a file in order, and common settings.

    `notes` are remarks on the file for attributes of a run, e.g. that it is incomplete.
    """

    path: Path
    container: str
    tables: tuple[RawTable, ...]
    settings: tuple[Setting, ...] = ()
    notes: Mapping[str, str] = {}

    def as_one_table(self) -> RawTable:
        """Return all columns as one table, labelled by their paths, with all settings."""
        columns = [
            column._replace(label=column.path or column.label)
            for table in self.tables
            for column in table.columns
        ]
        settings = [*self.settings, *(s for table in self.tables for s in table.settings)]
        return RawTable("", tuple(columns), tuple(settings))


def text_of(settings: Iterable[Setting]) -> str:
    """Return settings as text, one per line, for the patterns of a dialect."""
    lines = dict.fromkeys(setting.line for setting in settings if setting.line)
    return "\n".join(list(lines)[:MAX_SETTINGS])
