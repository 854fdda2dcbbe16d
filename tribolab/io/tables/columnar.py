"""Files that hold columns by name: Parquet, Feather, HDF5, MATLAB 7.3, Excel, and plain records."""

from __future__ import annotations

import datetime as dt
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.errors import ReadError, shown
from tribolab.io.seal import is_sealed
from tribolab.trials import try_out, workbook_tried

_MOST_CELLS = 50_000_000  # of a sheet
_OF_HDF5 = {"units", "unit", "CLASS", "NAME", "TITLE", "VERSION", "DIMENSION_LIST", "_FillValue"}
_MOST_ROWS, _MOST_WIDE = 100, 12  # of settings that stand in cells
_SHORT = 200  # characters of a setting


class ColumnLayout(NamedTuple):
    """Where columns and their names are: of a sheet, or records behind a header of some bytes."""

    sheet: str | None = None
    line: int = 1
    units_below: bool = False
    skip: int = 0
    record: np.dtype[np.void] | None = None
    offset: int = 0


class NamedColumns(NamedTuple):
    """Names of columns, units where the file says them, what gives the numbers; text beside."""

    names: list[str]
    units: list[str | None]
    column: Callable[[int], np.ndarray]
    text: str = ""


def open_columns(path: Path, form: str, layout: ColumnLayout) -> NamedColumns:
    """Open a file of columns.

    Parameters
    ----------
    path
        The file.
    form
        "parquet", "feather", "hdf5", "excel" or "binary".
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


def _of_arrow(table: object) -> NamedColumns:
    # late: pyarrow takes long to load
    import pyarrow as pa

    assert isinstance(table, pa.Table)
    names = list(table.column_names)

    def column(place: int) -> np.ndarray:
        values: np.ndarray = table.column(place).to_numpy()
        return values

    return NamedColumns(names, [None] * len(names), column)


def _parquet(path: Path, layout: ColumnLayout) -> NamedColumns:
    # late: pyarrow takes long to load
    import pyarrow.parquet as pq

    return _of_arrow(pq.read_table(path))


def _feather(path: Path, layout: ColumnLayout) -> NamedColumns:
    # late: pyarrow takes long to load
    from pyarrow import feather

    return _of_arrow(feather.read_table(path))


def _hdf5(path: Path, layout: ColumnLayout) -> NamedColumns:
    # late: h5py takes long to load
    import h5py

    names: list[str] = []
    units: list[str | None] = []
    arrays: list[np.ndarray] = []

    def take(name: str, values: np.ndarray, unit: object) -> None:
        if values.dtype.kind not in "fiu" or values.size == 0:
            return
        if values.size != max(values.shape, default=0):
            return  # not one column
        unit = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else unit
        names.append(name)
        units.append(str(unit) if unit is not None else None)
        arrays.append(values.ravel())

    said: list[str] = []

    def tell(name: str, item: object) -> None:
        for key, value in getattr(item, "attrs", {}).items():
            if np.size(value) == 1 and key not in _OF_HDF5:
                value = np.asarray(value).item()
                value = value.decode("utf-8", "replace") if isinstance(value, bytes) else value
                said.append(f"{key}: {value}"[:_SHORT].replace("\n", " "))
        if isinstance(item, h5py.Dataset) and item.shape == () and item.dtype.kind in "fiu":
            unit = item.attrs.get("units", item.attrs.get("unit", ""))
            unit = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else unit
            said.append(f"{name.split('/')[-1]}: {item[()]} {unit}".strip())

    if not is_sealed(path):
        try_out(path, "HDF5")
    with h5py.File(path, "r") as file:
        tell("", file)

        def visit(name: str, item: object) -> None:
            tell(name, item)
            if not isinstance(item, h5py.Dataset) or item.size is None:
                return
            labels = _labels_of_matrix(item)
            if item.dtype.names:  # rows of several numbers, as tables are kept
                for field in item.dtype.names:
                    take(f"{name}/{field}", item[field], None)
            elif labels:
                matrix = item[()]
                for place, label in enumerate(labels):
                    take(f"{name}/{label}", matrix[:, place], None)
            elif item.dtype.kind in "fiu" and item.size == max(item.shape, default=0):
                take(name, item[()], item.attrs.get("units", item.attrs.get("unit")))

        file.visititems(visit)
    return NamedColumns(names, units, arrays.__getitem__, "\n".join(said[:_MOST_ROWS]))


def _labels_of_matrix(item: object) -> list[str]:
    """Return the names of a matrix' columns, where its attributes say them."""
    # late: h5py takes long to load
    import h5py

    assert isinstance(item, h5py.Dataset)
    if len(item.shape) != 2:
        return []
    for key in ("columns", "column_names", "names", "labels", "channels"):
        said = item.attrs.get(key)
        if said is not None and np.shape(said) == item.shape[1:]:
            return [t.decode("utf-8", "replace") if isinstance(t, bytes) else str(t) for t in said]
    return []


def _excel(path: Path, layout: ColumnLayout) -> NamedColumns:
    # late: python_calamine takes long to load
    from python_calamine import CalamineWorkbook

    with workbook_tried(path):
        book = CalamineWorkbook.from_path(path)
        sheet = layout.sheet or book.sheet_names[0]
        if sheet not in book.sheet_names:
            there = ", ".join(map(shown, book.sheet_names[:8]))
            raise ReadError(f"there is no sheet '{shown(sheet)}'; there are {there}", where=path)
        page = book.get_sheet_by_name(sheet)
        if page.total_height * page.total_width > _MOST_CELLS:
            raise ReadError(f"sheet '{shown(sheet)}' is larger than a table of numbers", where=path)
        rows = page.to_python(skip_empty_area=False)
    line = layout.line
    if len(rows) <= line:
        raise ReadError(f"sheet '{shown(sheet)}' ends before row {line + 1}", where=path)
    names = [str(cell) for cell in rows[line - 1]]
    units: list[str | None] = [None] * len(names)
    first = line + layout.skip
    if layout.units_below:
        units = [str(cell).strip("[]() ") or None for cell in rows[line]]
        units += [None] * (len(names) - len(units))
        first += 1
    body = rows[first:]

    def column(place: int) -> np.ndarray:
        cells = [row[place] if place < len(row) else "" for row in body]
        # an empty row ends the table
        filled = [n for n, cell in enumerate(cells) if cell != ""]
        return _of_cells(path, cells[: filled[-1] + 1 if filled else 0])

    others = (book.get_sheet_by_name(name) for name in book.sheet_names if name != sheet)
    few = (page.to_python(skip_empty_area=False) for page in others if _is_small(page))
    text = [_settings(rows[: line - 1][:_MOST_ROWS]), *map(_settings, few)]
    return NamedColumns(names, units[: len(names)], column, "\n".join(filter(None, text)))


def _is_small(page: object) -> bool:
    """Whether a sheet may hold settings rather than a table."""
    height, width = (getattr(page, f"total_{side}") for side in ("height", "width"))
    return bool(height <= _MOST_ROWS and width <= _MOST_WIDE)


def _settings(rows: Sequence[Sequence[object]]) -> str:
    """Return rows of cells as lines, such as a text file has above its table."""
    lines = []
    for row in rows:
        cells = [" ".join(str(cell).split()) for cell in row[:_MOST_WIDE] if cell not in ("", None)]
        if cells and any(map(str.isalpha, "".join(cells))):
            lines.append("\t".join(cells)[:_SHORT])
    return "\n".join(lines)


def _of_cells(path: Path, cells: Sequence[object]) -> np.ndarray:
    """Return the numbers of a sheet's column, or its moments or times of day."""
    first = next((cell for cell in cells if cell != ""), None)
    if isinstance(first, dt.datetime):
        moments = [c if isinstance(c, dt.datetime) else None for c in cells]
        return np.array(moments, dtype="datetime64[us]")
    if isinstance(first, dt.time | dt.timedelta):
        return np.array([_passed(cell) for cell in cells], dtype="timedelta64[us]")
    return np.array([_cell(path, cell) for cell in cells])


def _passed(cell: object) -> dt.timedelta | None:
    if isinstance(cell, dt.time):
        return dt.datetime.combine(dt.date.min, cell) - dt.datetime.min
    return cell if isinstance(cell, dt.timedelta) else None


def _cell(path: Path, cell: object) -> float:
    if isinstance(cell, int | float):
        return float(cell)
    text = str(cell).strip()
    if not text:
        return np.nan
    try:
        return float(text.replace(",", "."))
    except ValueError as error:
        raise ReadError(f"'{shown(text, 40)}' is not a number", where=path) from error


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
    "excel": _excel,
    "binary": _binary,
}
