"""Unknown files that hold columns by name: Excel, Parquet, Feather, HDF5, MAT and TDMS.

Their columns are laid out as the lines of a text table, and understood as such.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from tribolab.draft.file.held_column import ROWS, HeldColumn, leaf, others_alike
from tribolab.draft.file.layout import Held, Layout, find_layout
from tribolab.draft.file.sheets import read_sheet
from tribolab.draft.model import Understood
from tribolab.errors import ReadError
from tribolab.io.dialects.cells import split_name
from tribolab.io.dialects.signature import HEAD, File
from tribolab.io.tables import columnar
from tribolab.io.tables.columnar import seconds_of
from tribolab.io.tables.mat5 import read_variables
from tribolab.io.tables.tdms_file import INCREMENT_PATTERN, on_one_grid, open_tdms

_CELL = 16  # bytes of a number as text


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
    every = [_in_numbers(c) for c in columns if c.values.dtype.kind in "fiuMm" and c.values.size]
    length = max((c.values.size for c in every), default=0)
    columns = [c for c in every if c.values.size == length]
    if held.form != "excel":
        held = held._replace(others=others_alike(columns, every))
    if not columns or length < 2:
        raise ReadError("no columns of numbers are in the file", where=file.path)
    rows = min(length, ROWS, max(HEAD // (_CELL * len(columns)), 2))
    text = io.BytesIO()
    labels = "\t".join(_label(column) for column in columns)
    table = np.column_stack([np.asarray(c.values[:rows], dtype=float) for c in columns])
    np.savetxt(text, table, "%.9g", "\t", header=labels, comments="", encoding="utf-8")
    beside = f"{held.text}\n\n" if held.text else ""
    head = beside.encode() + text.getvalue()
    layout = find_layout(File(file.path, "text", len(head), head))
    if layout.width != len(columns) or layout.heading is None:
        raise ReadError("its columns have no names", where=file.path)
    guesses = (f"the longest of several alike is meant, not {held.others}",) if held.others else ()
    layout = layout._replace(held=held, encoding="utf-8", guesses=(*layout.guesses, *guesses))
    return layout, tuple(columns)


def as_held(understood: Understood, columns: Sequence[HeldColumn], held: Held) -> Understood:
    """Return what was understood, with the columns named as the file's reader finds them."""
    named = []
    for column, own in zip(understood.columns, columns, strict=True):
        unit = column.unit if own.said or column.unit is not None else own.unit
        named.append(column._replace(name=own.name, unit=unit, group=own.group, occurrence=1))
    timed = any(column.used and column.quantity == "time" for column in named)
    if held.increment and understood.kind == "run" and not timed:
        understood = understood._replace(rate_pattern=INCREMENT_PATTERN, rate_unit="s")
    return understood._replace(columns=tuple(named), missing=())


def _in_numbers(column: HeldColumn) -> HeldColumn:
    """Return a column of moments or durations as one of time, in seconds from its first value."""
    if column.values.dtype.kind not in "Mm":
        return column
    seconds = seconds_of(column.values)
    known = seconds[np.isfinite(seconds)]
    passed = seconds - known[0] if known.size else seconds
    return column._replace(values=passed, unit="s", said=False, shown=f"time {column.name}")


def _label(column: HeldColumn) -> str:
    """Return a column's own name, without the folder that it lies in, and its unit."""
    name = " ".join(leaf(column.shown or column.name).split())
    return f"{name} [{column.unit}]" if column.unit else name


def _of_table(form: str) -> Callable[[Path], tuple[Held, list[HeldColumn]]]:
    """Return what reads a format that needs no more than to be opened."""

    def read(path: Path) -> tuple[Held, list[HeldColumn]]:
        table = columnar.open_columns(path, form, columnar.ColumnLayout())
        columns = []
        for place, (label, unit) in enumerate(zip(table.names, table.units, strict=True)):
            name, own = split_name(label)
            columns.append(HeldColumn(name, unit or own, table.column(place)))
        return Held(form, text=table.text), columns

    return read


def _mat(path: Path) -> tuple[Held, list[HeldColumn]]:
    columns = []
    for variable in read_variables(path):
        name, numbers = variable.name, variable.numbers
        if numbers is not None and numbers.size and numbers.size == max(numbers.shape):
            columns.append(HeldColumn(name, None, numbers.ravel()))
    return Held("mat"), columns


def _tdms(path: Path) -> tuple[Held, list[HeldColumn]]:
    """Return the channels of the group that holds most numbers, and what shares its clock."""
    groups = open_tdms(path, "read").groups()
    size = [sum(len(channel) for channel in group.channels()) for group in groups]
    if not groups:
        return Held("tdms"), []
    best = groups[int(np.argmax(size))]
    every = [channel for group in groups for channel in group.channels()]
    grid = on_one_grid(every)
    if grid is None:
        channels, values = best.channels(), [channel[:] for channel in best.channels()]
    else:
        channels, values = every, grid.values
    columns = []
    for channel, numbers in zip(channels, values, strict=True):
        name, unit = split_name(channel.name)
        stated = str(channel.properties.get("unit_string", "")).strip() or None
        columns.append(
            HeldColumn(name, unit or stated, numbers, channel.group_name, said=unit is not None)
        )
    return Held("tdms", increment=grid.increment if grid else 0.0), columns


READERS: dict[str, Callable[[Path], tuple[Held, list[HeldColumn]]]] = {
    "excel": read_sheet,
    "parquet": _of_table("parquet"),
    "feather": _of_table("feather"),
    "hdf5": _of_table("hdf5"),
    "netcdf": _of_table("hdf5"),  # both begin alike
    "tdms": _tdms,
    "mat": _mat,
}
