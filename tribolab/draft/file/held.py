"""Unknown files that hold columns by name: Excel, Parquet, Feather, HDF5, MAT and TDMS.

Their columns are laid out as the lines of a text table, and understood as such.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from tribolab.draft.file.held_column import (
    ROWS,
    HeldColumn,
    better_name,
    leaf,
    one_of_each,
    others_alike,
)
from tribolab.draft.file.layout import Held, Layout, find_layout
from tribolab.draft.file.sheets import main_sheet, read_sheet
from tribolab.draft.file.steps import HeldSteps, find_steps, lines_of, unit_beside
from tribolab.draft.model import Understood
from tribolab.errors import ReadError
from tribolab.io.dialects.cells import split_name
from tribolab.io.dialects.held_tables import HELD_IN_GROUPS, open_sheets, open_tables, settings_text
from tribolab.io.dialects.signature import HEAD, File
from tribolab.io.tables import columnar
from tribolab.io.tables.columnar import seconds_of
from tribolab.io.tables.mat5 import read_variables
from tribolab.io.tables.tdms_file import (
    INCREMENT_PATTERN,
    on_one_grid,
    open_tdms,
    text_beside,
    unit_of,
)

_CELL = 16  # bytes of a number as text
_FILLED = 0.9  # of what is looked at, by rows of steps: their settings want room, too
_UNLOADED = 0.3  # of the usual load; its zero may be as large
_FORMS = {"netcdf": "hdf5"}  # both begin alike
_WITH_ZERO = {"friction_force", "normal_force", "friction_coefficient", None}


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
        steps = _steps(file)
        held, columns = (Held(file.format), []) if steps else READERS[file.format](file.path)
    except (ReadError, ImportError):
        raise
    except Exception as error:  # each of these libraries has its own ways to say "damaged"
        raise ReadError(f"this {file.format} file cannot be read", where=file.path) from error
    if steps is not None:
        return _layout_of_steps(file, *steps)
    every = [_in_numbers(c) for c in columns if c.values.dtype.kind in "fiuMm" and c.values.size]
    length = max((c.values.size for c in every), default=0)
    columns = one_of_each([c for c in every if c.values.size == length])
    if held.form != "excel":
        held = held._replace(others=others_alike(columns, every))
    if not columns or length < 2:
        raise ReadError("no columns of numbers are in the file", where=file.path)
    rows = min(length, ROWS, max(HEAD // (_CELL * len(columns)), 2))
    text = io.BytesIO()
    labels = "\t".join(_label(column) for column in columns)
    table = np.column_stack([np.asarray(c.values[:rows], dtype=float) for c in columns])
    np.savetxt(text, table, "%.17g", "\t", header=labels, comments="", encoding="utf-8")
    beside = f"{held.text}\n\n" if held.text else ""
    layout = _laid_out(file, beside.encode() + text.getvalue(), columns)
    guesses = (f"the longest of several alike is meant, not {held.others}",) if held.others else ()
    layout = layout._replace(held=held, encoding="utf-8", guesses=(*layout.guesses, *guesses))
    return layout, tuple(columns)


def _laid_out(file: File, head: bytes, columns: Sequence[HeldColumn]) -> Layout:
    layout = find_layout(File(file.path, "text", len(head), head))
    if layout.width != len(columns) or layout.heading is None:
        raise ReadError("its columns have no names", where=file.path)
    return layout


def _steps(file: File) -> tuple[Held, HeldSteps] | None:
    """Return tables that are steps of one run, and how a dialect finds them; None if none are."""
    if file.format == "excel":
        held, names = main_sheet(file.path)
        wanted = [split_name(name)[0] for name in names]
        tables = open_sheets(file.path, wanted, held.line, units_below=held.units_below)
    elif file.format in HELD_IN_GROUPS:
        held, tables = (
            Held(_FORMS.get(file.format, file.format)),
            open_tables(file.path, file.format),
        )
    else:
        return None
    found = find_steps(tables)
    if found is None:
        return None
    clocked = file.format == "tdms" and "wf_increment:" in found.steps[0].text
    increment = 1.0 if clocked else 0.0  # the text of each step says its own
    return held._replace(steps=found.pattern, zero=found.zero, increment=increment), found


def _layout_of_steps(
    file: File, held: Held, found: HeldSteps
) -> tuple[Layout, tuple[HeldColumn, ...]]:
    """Lay steps out as the text of a file that has a table for each."""
    first, said = found.steps[0], "\n".join([found.text, found.steps[0].text])
    meanings = first.meanings or ("",) * len(first.names)
    columns = []
    for place, (name, unit, meaning) in enumerate(
        zip(first.names, first.units, meanings, strict=True)
    ):
        values = np.concatenate([table.arrays[place] for table in found.steps])
        counted = values.dtype.kind in "iu"
        beside = None if unit else unit_beside(said, name, counted=counted)
        column = HeldColumn(name, unit or beside, values, said=beside is None)
        if values.dtype.kind not in "Mm" and (better := better_name(name, meaning)):
            column = column._replace(shown=better)
        columns.append(_in_numbers(column))
    tables = tuple(t._replace(arrays=tuple(map(_seconds, t.arrays))) for t in found.steps)
    most = max(int(_FILLED * HEAD) // (_CELL * len(columns) * len(tables)), 2)
    text = lines_of(found._replace(steps=tables), [_label(c) for c in columns], min(most, ROWS))
    layout = _laid_out(file, text.encode("utf-8", "replace"), columns)
    zeros = {n: a for table in found.zeros for n, a in zip(table.names, table.arrays, strict=True)}
    columns = [column._replace(unloaded=zeros.get(column.name)) for column in columns]
    return layout._replace(held=held, encoding="utf-8"), tuple(columns)


def _seconds(values: np.ndarray) -> np.ndarray:
    return seconds_of(values) if values.dtype.kind in "Mm" else values


def as_held(understood: Understood, columns: Sequence[HeldColumn], held: Held) -> Understood:
    """Return what was understood, with the columns named as the file's reader finds them."""
    named = []
    loaded = held.zero and _is_loaded(understood, columns)
    for column, own in zip(understood.columns, columns, strict=True):
        unit = column.unit if own.said or column.unit is not None else own.unit
        told = own.unloaded is not None and column.quantity in _WITH_ZERO and not loaded
        zero = held.zero if told else ""
        column = column._replace(name=own.name, group=own.group, occurrence=1)
        named.append(column._replace(unit=unit, zero=zero))
    if loaded:
        guess = f"{held.zero} is no step of the run by its name, though it is under load"
        understood = understood._replace(guesses=(*understood.guesses, guess))
    timed = any(column.used and column.quantity == "time" for column in named)
    if held.increment and understood.kind == "run" and not timed:
        understood = understood._replace(rate_pattern=INCREMENT_PATTERN, rate_unit="s")
    return understood._replace(columns=tuple(named), missing=())


def _is_loaded(understood: Understood, columns: Sequence[HeldColumn]) -> bool:
    """Whether a table that is named as one without contact has a load all the same."""
    for column, own in zip(understood.columns, columns, strict=True):
        if column.quantity == "normal_force" and own.unloaded is not None:
            usual = float(np.nanpercentile(np.abs(own.values), 75))
            return abs(float(np.nanmedian(own.unloaded))) > _UNLOADED * usual
    return False


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
        meanings = table.meanings or ("",) * len(table.names)
        for place, (label, unit) in enumerate(zip(table.names, table.units, strict=True)):
            name, own = split_name(label)
            better = better_name(leaf(name), meanings[place])
            values = table.column(place)
            counted = values.dtype.kind in "iu"
            beside = None if unit or own else unit_beside(table.text, leaf(name), counted=counted)
            columns.append(
                HeldColumn(name, unit or own or beside, values, said=beside is None, shown=better)
            )
        return Held(form, text=table.text), columns

    return read


def _mat(path: Path) -> tuple[Held, list[HeldColumn]]:
    columns = []
    variables = read_variables(path)
    text = settings_text(variables)
    for name, numbers, *_ in variables:
        if numbers is not None and numbers.size and numbers.size == max(numbers.shape):
            unit = unit_beside(text, leaf(name), counted=numbers.dtype.kind in "iu")
            columns.append(HeldColumn(name, unit, numbers.ravel(), said=unit is None))
    return Held("mat", text=text), columns


def _tdms(path: Path) -> tuple[Held, list[HeldColumn]]:
    """Return the channels of the group that holds most numbers, and what shares its clock."""
    file = open_tdms(path)
    groups = file.groups
    size = [sum(channel.values.size for channel in group.channels) for group in groups]
    if not groups:
        return Held("tdms"), []
    best = groups[int(np.argmax(size))]
    every = [channel for group in groups for channel in group.channels]
    grid = on_one_grid(every)
    if grid is None:
        channels, values = best.channels, [channel.values for channel in best.channels]
    else:
        channels, values = every, grid.values
    columns = []
    for channel, numbers in zip(channels, values, strict=True):
        name, unit = split_name(channel.name)
        better = better_name(name, str(channel.properties.get("description", "")))
        own, said = unit or unit_of(channel), unit is not None
        columns.append(HeldColumn(name, own, numbers, channel.group_name, said, better))
    increment = grid.increment if grid else 0.0
    read = [group for group in groups if group.name in {c.group_name for c in channels}]
    return Held("tdms", increment=increment, text=text_beside(file, read, increment)), columns


READERS: dict[str, Callable[[Path], tuple[Held, list[HeldColumn]]]] = {
    "excel": read_sheet,
    "parquet": _of_table("parquet"),
    "feather": _of_table("feather"),
    "hdf5": _of_table("hdf5"),
    "npz": _of_table("npz"),
    "netcdf": _of_table("hdf5"),  # both begin alike
    "tdms": _tdms,
    "mat": _mat,
}
