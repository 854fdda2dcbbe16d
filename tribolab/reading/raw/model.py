"""A file as tables of numbers and typed settings, whatever container it is written in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

MAX_SETTINGS = 200  # of a file: a table of parameters has fewer, a log of events has more


class Place(NamedTuple):
    """Where something stands in a file, for messages: a line and a cell, or a path in it."""

    path: str = ""
    line: int | None = None
    column: int | None = None


class Setting(NamedTuple):
    """What a file says besides its columns: "radius: 15 mm", an attribute, a row of cells.

    `key` is empty for a text that stands alone, such as a title.
    """

    key: str
    text: str
    place: Place = Place()
    source: Literal["attribute", "cells", "title"] = "attribute"

    @property
    def line(self) -> str:
        """The setting as the patterns of a dialect see it."""
        return f"{self.key}: {self.text}" if self.key else self.text


class Clock(NamedTuple):
    """When the values of a column were taken: the first one [s] and the interval [s]."""

    start: float
    interval: float

    def times(self, rows: int) -> np.ndarray:
        """Return the time [s] of each of so many values (row)."""
        return self.start + self.interval * np.arange(rows)


class RawColumn(NamedTuple):
    """A column: its label and unit as the file has them, and its numbers (row).

    `meaning` is what the file says of it besides; `path` the name by which it is found in a file
    whose tables are not told apart. `clock` is its own, if it has one.
    """

    label: str
    unit: str | None
    values: np.ndarray
    meaning: str = ""
    path: str = ""
    clock: Clock | None = None


class RawTable(NamedTuple):
    """A table: its name (a sheet, the path of a group, "" for that of a whole file) and columns."""

    name: str
    columns: tuple[RawColumn, ...]
    settings: tuple[Setting, ...] = ()

    @property
    def rows(self) -> int:
        """How many rows its longest column has."""
        return max((column.values.size for column in self.columns), default=0)


class RawFile(NamedTuple):
    """The tables of a file in its order, and what it says of all of them.

    `notes` are remarks on the file as attributes of a run, such as that it is cut short.
    """

    path: Path
    container: str
    tables: tuple[RawTable, ...]
    settings: tuple[Setting, ...] = ()
    notes: Mapping[str, str] = {}

    def as_one_table(self) -> RawTable:
        """Return all columns as one table, called by their paths; all settings are its own."""
        columns = [
            column._replace(label=column.path or column.label)
            for table in self.tables
            for column in table.columns
        ]
        settings = [*self.settings, *(s for table in self.tables for s in table.settings)]
        kept = (setting for setting in settings if setting.source != "title")
        return RawTable("", tuple(columns), tuple(kept))


def text_of(settings: Iterable[Setting]) -> str:
    """Return settings as text, a line for each, as patterns of a dialect look into it."""
    lines = dict.fromkeys(setting.line for setting in settings if setting.line)
    return "\n".join(list(lines)[:MAX_SETTINGS])
