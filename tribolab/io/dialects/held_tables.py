"""Tables that lie beside each other in one file: sheets, groups, elements of a structure.

Where several of them have the same columns, they are the steps of one run.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.errors import ReadError
from tribolab.io.dialects.cells import split_name
from tribolab.io.tables.mat5 import Variable, read_variables
from tribolab.io.tables.npz import read_npz
from tribolab.io.tables.settings_text import folder_and_leaf, setting_lines, text_of
from tribolab.io.tables.tdms_file import on_one_grid, open_tdms, properties_of, text_beside, unit_of
from tribolab.io.tables.workbook import Cells, settings_above, sheets_of, table_below

_ABOVE = 40  # rows of a sheet above its names
_FEW = 100  # rows of a sheet of settings
_NUMBERS = re.compile(r"\d+")


class HeldTable(NamedTuple):
    """A table: what it is called, its columns with their units, and what is said of it alone.

    `said` is which units a reader finds by itself, `meanings` what the file says of each column.
    """

    name: str
    names: tuple[str, ...]
    units: tuple[str | None, ...]
    arrays: tuple[np.ndarray, ...]
    text: str = ""
    meanings: tuple[str, ...] = ()

    @property
    def rows(self) -> int:
        """How many rows its longest column has."""
        return max((values.size for values in self.arrays), default=0)


class HeldFile(NamedTuple):
    """The tables of a file in its order, and what it says of all of them."""

    tables: tuple[HeldTable, ...]
    text: str


def open_tables(path: Path, form: str) -> HeldFile:
    """Open a file whose columns lie in groups or structures.

    Parameters
    ----------
    path
        The file.
    form
        "hdf5", "mat", "tdms" or "npz".

    Raises
    ------
    ReadError
        If it is damaged; other libraries have errors of their own.
    """
    return _READERS[form](path)


def in_natural_order(names: Sequence[str]) -> list[str]:
    """Sort names so that a second comes before a tenth.

    >>> in_natural_order(["step10", "step9", "step1"])
    ['step1', 'step9', 'step10']
    """

    def key(name: str) -> list[tuple[str, int]]:
        numbers = [int(digits) for digits in _NUMBERS.findall(name)[:20]]
        return list(zip(_NUMBERS.split(name), [*numbers, 0], strict=False))

    return sorted(names, key=key)


class _Gathered:
    """Columns and settings of tables, by their names."""

    def __init__(self) -> None:
        self._columns: dict[str, list[tuple[str, str | None, np.ndarray, str]]] = {}
        self.said: dict[str, list[str]] = {}

    def column(
        self, table: str, name: str, unit: str | None, values: np.ndarray, meaning: str = ""
    ) -> None:
        self._columns.setdefault(table, []).append((name, unit, values, meaning))

    def file(self, *, sort: bool) -> HeldFile:
        order = in_natural_order(list(self._columns)) if sort else list(self._columns)
        tables = []
        for name in order:
            names, units, arrays, meanings = zip(*self._columns[name], strict=True)
            text = text_of([name, *self.said.get(name, [])] if name else [])
            tables.append(HeldTable(name, names, units, arrays, text, meanings))
        # one column beside settings is one of them
        apart = {name for name in order if name and len(self._columns[name]) > 1}
        beside = [x for name, lines in self.said.items() if name not in apart for x in lines]
        return HeldFile(tuple(tables), text_of(beside))


def _hdf5(path: Path) -> HeldFile:
    # late: h5py takes long to load
    from tribolab.io.tables.hdf5 import read_hdf5

    found = _Gathered()
    names, units, arrays, meanings, said = read_hdf5(path)
    found.said = said
    for label, unit, values, meaning in zip(names, units, arrays, meanings, strict=True):
        table, _, name = label.rpartition("/")
        name, own = split_name(name)
        if values.size > 1:
            found.column(table, name, own or unit, values, meaning)
    return found.file(sort=True)


def _mat(path: Path) -> HeldFile:
    found = _Gathered()
    for variable in read_variables(path):
        table, name = folder_and_leaf(variable.name)
        if variable.numbers is None or variable.numbers.size == 1:
            found.said.setdefault(table, []).extend(settings_of(variable))
        elif variable.numbers.size and variable.numbers.size == max(variable.numbers.shape):
            found.column(table, name, None, variable.numbers.ravel())
    return found.file(sort=False)


def _own(folder: str) -> str:
    return folder.rsplit("/", 1)[-1].rsplit(".", 1)[-1]


def settings_of(variable: Variable) -> list[str]:
    """Return what a variable that is no column says: a single number or a text.

    Parameters
    ----------
    variable
        From `tribolab.io.tables.mat5.read_variables`.
    """
    folder, name = folder_and_leaf(variable.name)
    if _own(folder).lower() in ("unit", "units", "einheit", "einheiten"):
        name = f"{name}_unit"
    if variable.numbers is not None:
        single = variable.numbers.size == 1
        return setting_lines(name, variable.numbers.ravel()) if single else []
    return setting_lines(name, variable.text or list(variable.texts))


def settings_text(variables: Sequence[Variable]) -> str:
    """Return what the variables of a MAT file say that are no columns, a line for each."""
    return text_of([line for variable in variables for line in settings_of(variable)])


def _tdms(path: Path) -> HeldFile:
    file = open_tdms(path)
    found = _Gathered()
    found.said[""] = text_beside(file, [], 0.0).split("\n")
    for group in file.groups:
        channels = [channel for channel in group.channels if channel.values.size]
        grid = on_one_grid(channels)
        clock = [f"wf_increment: {grid.increment!r}"] if grid else []
        found.said[group.name] = [*clock, *properties_of(group)]
        for place, channel in enumerate(channels):
            name, unit = split_name(channel.name)
            values = grid.values[place] if grid else channel.values
            meaning = str(channel.properties.get("description", ""))
            found.column(group.name, name, unit or unit_of(channel), values, meaning)
    return found.file(sort=False)


def open_sheets(
    path: Path, wanted: Sequence[str], line: int, *, units_below: bool = False
) -> HeldFile:
    """Open the sheets of a workbook that hold the same table; what others say holds for all.

    Parameters
    ----------
    path
        The workbook.
    wanted
        Names of columns, without units: a sheet that has none of them is no table.
    line, units_below
        As for `tribolab.io.tables.workbook.read_sheet`; where the names stand in another row of a
        sheet, they are found there.

    Raises
    ------
    ReadError
        If the workbook cannot be read.
    """
    tables, beside = [], []
    for sheet, rows in sheets_of(path).items():
        place = _row_of_names(rows, set(wanted), line)
        if place is None:
            if len(rows) <= _FEW:
                beside.append(settings_above(rows))
            continue
        table = table_below(path, sheet, rows, place, units_below=units_below)
        columns = []
        for index, (label, unit) in enumerate(zip(table.names, table.units, strict=True)):
            name, own = split_name(label)
            try:
                columns.append((name, own or unit, table.column(index)))
            except ReadError:  # a column of words
                continue
        names, units, arrays = zip(*((n, u, a) for n, u, a in columns if n), strict=True)
        text = "\n".join(filter(None, [sheet, table.text]))
        tables.append(HeldTable(sheet, names, units, arrays, text))
    return HeldFile(tuple(tables), text_of("\n".join(beside).split("\n")))


def _row_of_names(rows: Cells, wanted: set[str], line: int) -> int | None:
    """Return the row, from 1, in which most of the wanted names stand; None if in no row."""

    def held(row: Sequence[object]) -> int:
        return len(wanted & {split_name(cell)[0] for cell in row if isinstance(cell, str)})

    places = [line - 1, *range(min(len(rows), _ABOVE))]
    counts = {place: held(rows[place]) for place in places if place < len(rows) - 1}
    best = max(counts, key=lambda place: counts[place], default=0)
    return best + 1 if counts.get(best, 0) >= min(2, len(wanted)) else None


def _npz(path: Path) -> HeldFile:
    found = _Gathered()
    columns, found.said = read_npz(path)
    for table, label, values in columns:
        name, unit = split_name(label)
        found.column(table, name, unit, values)
    return found.file(sort=False)


_READERS: dict[str, Callable[[Path], HeldFile]] = {
    "hdf5": _hdf5,
    "netcdf": _hdf5,  # both begin alike
    "mat": _mat,
    "tdms": _tdms,
    "npz": _npz,
}
HELD_IN_GROUPS = frozenset(_READERS)
