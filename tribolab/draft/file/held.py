"""Unknown files that hold columns by name: Excel, Parquet, Feather, HDF5 and TDMS.

Their columns are laid out as the lines of a text table, and understood as such.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.draft.file.layout import Held, Layout, find_layout
from tribolab.draft.model import Understood
from tribolab.errors import ReadError
from tribolab.io.dialects.cells import split_name
from tribolab.io.dialects.signature import HEAD, File
from tribolab.io.tables import columnar
from tribolab.io.tables.tdms_file import open_tdms

_ROWS = 20_000  # rows looked at
_CELL = 16  # bytes of a number as text
_ABOVE = 40  # rows of a sheet above its names


class HeldColumn(NamedTuple):
    """A column: its name (and group) as the reader finds it, its unit, its numbers.

    `said` is whether the reader finds the unit by itself.
    """

    name: str
    unit: str | None
    values: np.ndarray
    group: str = ""
    said: bool = True


def layout_of_columns(file: File) -> tuple[Layout, tuple[HeldColumn, ...]]:
    """Lay the columns of a file out as the lines of a text table.

    Parameters
    ----------
    file
        The file, looked at by `tribolab.io.dialects.signature.peek`.

    Raises
    ------
    ReadError
        If it holds no columns of numbers of one length, or is damaged.
    """
    try:
        held, columns = READERS[file.format](file.path)
    except (ReadError, ImportError):
        raise
    except Exception as error:  # each of these libraries has its own ways to say "damaged"
        raise ReadError(f"this {file.format} file cannot be read", where=file.path) from error
    columns = [c for c in columns if c.values.dtype.kind in "fiu" and c.values.size]
    length = max((c.values.size for c in columns), default=0)
    columns = [c for c in columns if c.values.size == length]
    if not columns or length < 2:
        raise ReadError("no columns of numbers are in the file", where=file.path)
    rows = min(length, _ROWS, max(HEAD // (_CELL * len(columns)), 2))
    text = io.BytesIO()
    labels = "\t".join(_label(column) for column in columns)
    table = np.column_stack([np.asarray(c.values[:rows], dtype=float) for c in columns])
    np.savetxt(text, table, "%.9g", "\t", header=labels, comments="", encoding="utf-8")
    head = text.getvalue()
    layout = find_layout(File(file.path, "text", len(head), head))
    if layout.width != len(columns) or layout.heading is None:
        raise ReadError("its columns have no names", where=file.path)
    return layout._replace(held=held, encoding="utf-8"), tuple(columns)


def as_held(understood: Understood, columns: Sequence[HeldColumn]) -> Understood:
    """Return what was understood, with the columns named as the file's reader finds them."""
    named = []
    for column, held in zip(understood.columns, columns, strict=True):
        unit = column.unit if held.said or column.unit is not None else held.unit
        named.append(column._replace(name=held.name, unit=unit, group=held.group, occurrence=1))
    return understood._replace(columns=tuple(named), missing=())


def _label(column: HeldColumn) -> str:
    """Return a column's own name, without the folder that it lies in, and its unit."""
    name = " ".join(column.name.rsplit("/", 1)[-1].split())
    return f"{name} [{column.unit}]" if column.unit else name


def _of_table(form: str) -> Callable[[Path], tuple[Held, list[HeldColumn]]]:
    """Return what reads a format that needs no more than to be opened."""

    def read(path: Path) -> tuple[Held, list[HeldColumn]]:
        table = columnar.open_columns(path, form, columnar.Layout())
        columns = []
        for place, (label, unit) in enumerate(zip(table.names, table.units, strict=True)):
            name, own = split_name(label)
            columns.append(HeldColumn(name, unit or own, table.column(place)))
        return Held(form), columns

    return read


def _tdms(path: Path) -> tuple[Held, list[HeldColumn]]:
    """Return the channels of the group that holds most numbers."""
    groups = open_tdms(path, "read").groups()
    size = [sum(len(channel) for channel in group.channels()) for group in groups]
    columns = []
    for channel in groups[int(np.argmax(size))].channels() if groups else ():
        name, unit = split_name(channel.name)
        stated = str(channel.properties.get("unit_string", "")).strip() or None
        columns.append(
            HeldColumn(name, unit or stated, channel[:], channel.group_name, said=unit is not None)
        )
    return Held("tdms"), columns


def _excel(path: Path) -> tuple[Held, list[HeldColumn]]:
    """Return the columns of the sheet that holds most rows of numbers below names."""
    from python_calamine import CalamineWorkbook

    book = CalamineWorkbook.from_path(path)
    best: tuple[int, Held] | None = None
    for sheet in book.sheet_names:
        rows = book.get_sheet_by_name(sheet).to_python(skip_empty_area=False, nrows=_ROWS)
        names = _names_row(rows)
        if names is None:
            continue
        units = not _is_numeric(rows[names + 1])
        size = len(rows) - names
        if best is None or size > best[0]:
            best = size, Held("excel", sheet, names + 1, units)
    if best is None:
        raise ReadError("no sheet holds numbers below names", where=path)
    held = best[1]
    layout = columnar.Layout(held.sheet, held.line, held.units_below)
    table = columnar.open_columns(path, "excel", layout)
    columns = []
    for place, (label, unit) in enumerate(zip(table.names, table.units, strict=True)):
        name, own = split_name(label)
        try:
            values = table.column(place)
        except ReadError:  # a column of words
            values = np.empty(0)
        if label:
            columns.append(HeldColumn(name, unit or own, values))
    return held, columns


def _names_row(rows: Sequence[Sequence[object]]) -> int | None:
    """Return the first row of words with numbers below it, or below a row of units."""
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
    numbers = sum(isinstance(c, int | float) and not isinstance(c, bool) for c in filled)
    return numbers >= 2 and 2 * numbers >= len(filled)


READERS: dict[str, Callable[[Path], tuple[Held, list[HeldColumn]]]] = {
    "excel": _excel,
    "parquet": _of_table("parquet"),
    "feather": _of_table("feather"),
    "hdf5": _of_table("hdf5"),
    "netcdf": _of_table("hdf5"),  # both begin alike
    "tdms": _tdms,
}
