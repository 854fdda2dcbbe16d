"""Files that hold columns by name: Parquet, Feather, HDF5, MATLAB 7.3, Excel, and plain records."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tribolab.errors import ReadError
from tribolab.io.tables.settings_text import plain, setting_lines, text_of
from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.opening import damage_told, isolated

_OF_LIBRARIES = (b"pandas", b"ARROW:schema", b"PANDAS_ATTRS")


class ColumnLayout(NamedTuple):
    """Where columns and their names are: of a sheet, or records behind a header of some bytes."""

    sheet: str | None = None
    line: int = 1
    units_below: bool = False
    skip: int = 0
    record: np.dtype[np.void] | None = None
    offset: int = 0


class NamedColumns(NamedTuple):
    """Names of columns, units where the file says them, what gives the numbers; text beside.

    `meanings` is what the file says of each column besides, if it does.
    """

    names: list[str]
    units: list[str | None]
    column: Callable[[int], np.ndarray]
    text: str = ""
    meanings: tuple[str, ...] = ()


def open_columns(path: Path, form: str, layout: ColumnLayout) -> NamedColumns:
    """Open a file of columns.

    Parameters
    ----------
    path
        The file.
    form
        "parquet", "feather", "hdf5", "excel", "npz" or "binary".
    layout
        Where its columns are.

    Raises
    ------
    ReadError
        If it has no such sheet, or is shorter than a record.
    ImportError
        If the library for it is not installed; other libraries' own errors if it is damaged.
    """
    return _READERS[form](path, layout)


def seconds_of(values: np.ndarray) -> np.ndarray:
    """Return moments as seconds since 1970, and durations as seconds; NaN where there is none.

    >>> seconds_of(np.array(["1970-01-01T00:01:00.5", "NaT"], dtype="datetime64[ms]")).tolist()
    [60.5, nan]
    """
    known = ~np.isnat(values)
    since = values.astype("datetime64[ns]" if values.dtype.kind == "M" else "timedelta64[ns]")
    return np.where(known, since.astype(np.int64) / 1e9, np.nan)


class _ArrowColumns(NamedTuple):
    """Names of columns, their units and values; text beside."""

    names: list[str]
    units: list[str | None]
    arrays: list[np.ndarray]
    text: str


@isolated("pyarrow", "pyarrow.parquet", "pyarrow.feather")
def _arrow_columns(path: Path, form: str) -> _ArrowColumns:
    # late: pyarrow takes long to load
    import pyarrow as pa
    from pyarrow import feather
    from pyarrow import parquet as pq

    with damage_told(path, f"{form} file"):
        read = pq.read_table if form == "parquet" else feather.read_table
        table = read(path, use_threads=False, memory_map=False)
    names = list(table.column_names)
    units = [_unit_of_field(table.schema.field(place)) for place in range(len(names))]
    arrays = []
    for place in range(len(names)):
        values = table.column(place)
        if pa.types.is_dictionary(values.type):  # words, or numbers that are kept once
            values = values.cast(values.type.value_type)
        if pa.types.is_decimal(values.type):
            values = values.cast(pa.float64())
        with damage_told(path, f"{form} file"):
            numbers = values.to_numpy()
        # what is no number (words, lists, structures) is of no use as a column
        arrays.append(numbers if numbers.dtype.kind in "fiubMm" else np.empty(0, "U1"))
    said = dict(table.schema.metadata or {})
    kept = {plain(key): value for key, value in said.items() if key not in _OF_LIBRARIES}
    lines = [line for key, value in kept.items() for line in setting_lines(str(key), value)]
    return _ArrowColumns(names, units, arrays, text_of(lines))


def _unit_of_field(field: Any) -> str | None:
    """Return the unit that a column's own metadata says."""
    said = {str(plain(k)).lower(): str(plain(v)) for k, v in (field.metadata or {}).items()}
    return next((said[key] for key in keys_of("unit") if said.get(key, "").strip()), None)


def _parquet(path: Path, layout: ColumnLayout) -> NamedColumns:
    names, units, arrays, text = _arrow_columns(path, "parquet")
    return NamedColumns(names, units, arrays.__getitem__, text)


def _feather(path: Path, layout: ColumnLayout) -> NamedColumns:
    names, units, arrays, text = _arrow_columns(path, "feather")
    return NamedColumns(names, units, arrays.__getitem__, text)


def _hdf5(path: Path, layout: ColumnLayout) -> NamedColumns:
    # late: h5py takes long to load
    from tribolab.io.tables.hdf5 import read_hdf5

    names, units, arrays, meanings, said = read_hdf5(path)
    text = text_of([line for lines in said.values() for line in lines])
    return NamedColumns(names, units, arrays.__getitem__, text, tuple(meanings))


def _npz(path: Path, layout: ColumnLayout) -> NamedColumns:
    # late: starting stays quick
    from tribolab.io.tables.npz import read_npz

    columns, said = read_npz(path)
    names = [f"{table}/{name}" if table else name for table, name, _ in columns]
    text = text_of([line for lines in said.values() for line in lines])
    return NamedColumns(names, [None] * len(names), lambda place: columns[place][2], text)


def _excel_sheet(path: Path, layout: ColumnLayout) -> NamedColumns:
    # late: starting stays quick
    from tribolab.io.tables.workbook import read_sheet

    sheet = read_sheet(path, layout.sheet, layout.line, layout.skip, units_below=layout.units_below)
    return NamedColumns(sheet.names, sheet.units, sheet.column, sheet.text)


def _binary(path: Path, layout: ColumnLayout) -> NamedColumns:
    record, offset = layout.record, layout.offset
    assert record is not None  # a dialect of this format has one
    size = path.stat().st_size - offset
    if size < record.itemsize:
        raise ReadError(
            f"the file has {max(size, 0)} bytes behind its header, a record has {record.itemsize}",
            where=path,
        )
    count = size // record.itemsize
    rows = np.memmap(path, dtype=record, mode="r", offset=offset, shape=count)
    names = list(record.names or ())
    return NamedColumns(names, [None] * len(names), lambda place: np.array(rows[names[place]]))


_READERS: dict[str, Callable[[Path, ColumnLayout], NamedColumns]] = {
    "parquet": _parquet,
    "feather": _feather,
    "hdf5": _hdf5,
    "excel": _excel_sheet,
    "npz": _npz,
    "binary": _binary,
}
