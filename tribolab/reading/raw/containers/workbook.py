"""Reading of workbooks: cells of all sheets, or the table and settings of one sheet."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.raw.containers.xml_workbook import XmlWorkbook, is_xml_workbook
from tribolab.reading.raw.model import Place, RawColumn, RawFile, RawTable, Setting
from tribolab.reading.raw.opening import isolated, report_damage

_MAX_CELLS = 50_000_000  # most cells of a sheet
_MAX_ROWS, _MAX_WIDE = 100, 12  # largest block of settings: rows and columns
_HEAD = 4096  # bytes sufficient to recognise a workbook in XML
_SUMMARY = 30  # most rows of a summary below a table
_MAX_SETTING = 200  # most characters of a setting
Cells = Sequence[Sequence[object]]


@isolated("python_calamine")
def sheets_of(path: Path, rows: int | None = None) -> dict[str, Cells]:
    """Return the cells of every sheet by name, in the order of the workbook.

    Parameters
    ----------
    path
        The workbook.
    rows
        Number of rows of each sheet; by default all.

    Raises
    ------
    ReadError
        If the file is damaged, or a sheet is larger than a table of numbers.
    """
    cells: dict[str, Cells] = {}
    with report_damage(path, "workbook"):
        book = _book(path)
        for name in book.sheet_names:
            page = book.get_sheet_by_name(name)
            if rows is None:
                _check_size(path, name, page)
            cells[name] = page.to_python(skip_empty_area=False, nrows=rows)
    return cells


@isolated("python_calamine")
def _sheet_and_settings(path: Path, sheet: str | None) -> tuple[str, Cells, list[Cells]]:
    """Return a sheet's name and cells, and the cells of other small sheets."""
    with report_damage(path, "workbook"):
        book = _book(path)
        sheet = sheet or book.sheet_names[0]
        if sheet not in book.sheet_names:
            there = ", ".join(map(shown, book.sheet_names[:8]))
            raise ReadError(f"there is no sheet '{shown(sheet)}'; there are {there}", where=path)
        page = book.get_sheet_by_name(sheet)
        _check_size(path, sheet, page)
        rows = page.to_python(skip_empty_area=False)
        others = (book.get_sheet_by_name(name) for name in book.sheet_names if name != sheet)
        few: list[Cells] = [
            page.to_python(skip_empty_area=False) for page in others if is_small(page)
        ]
    return sheet, rows, few


def _book(path: Path) -> Any:
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if is_xml_workbook(head):
        return XmlWorkbook(path)
    # imported late: python_calamine loads slowly
    from python_calamine import CalamineWorkbook

    return CalamineWorkbook.from_path(path)


def read_sheet(
    path: Path, sheet: str | None, line: int, skip: int = 0, *, units_below: bool = False
) -> RawFile:
    """Read the table of one sheet.

    Parameters
    ----------
    path
        The workbook.
    sheet
        Name of the sheet; by default the first.
    line, skip
        Row of names, from 1, and number of rows below it to skip.
    units_below
        Whether units are in the row below the names.

    Raises
    ------
    ReadError
        If the sheet does not exist, or ends before the table.
    """
    sheet, rows, few = _sheet_and_settings(path, sheet)
    table = _table_below(path, sheet, rows, line, skip, units_below=units_below)
    others = [setting for page in few for setting in _settings_above(page)]
    return RawFile(path, "excel", (table._replace(name=""),), (*table.settings, *others))


def _table_below(
    path: Path, sheet: str, rows: Cells, line: int, skip: int = 0, *, units_below: bool = False
) -> RawTable:
    """Return the table below a row of names, with the settings above it."""
    if len(rows) <= line:
        raise ReadError(f"sheet '{shown(sheet)}' ends before row {line + 1}", where=path)
    names = [str(cell) for cell in rows[line - 1]]
    units: list[str | None] = [None] * len(names)
    first = line + skip
    if units_below:
        units = [str(cell).strip("[]() ") or None for cell in rows[line]]
        units += [None] * (len(names) - len(units))
        first += 1
    body = _rows_above_summary(rows[first:])
    columns = []
    for place, (name, unit) in enumerate(zip(names, units, strict=False)):
        cells = [row[place] if place < len(row) else "" for row in body]
        # empty cells below the last value do not belong to the column
        filled = [n for n, cell in enumerate(cells) if cell != ""]
        values = of_cells(cells[: filled[-1] + 1 if filled else 0])
        columns.append(RawColumn(name, unit, values, path=name))
    return RawTable(sheet, tuple(columns), tuple(_settings_above(rows[: line - 1][:_MAX_ROWS])))


def _rows_above_summary(body: Cells) -> Cells:
    """Return the rows above a summary that follows an empty row, e.g. "Mean" and its value."""
    for place in range(max(len(body) - _SUMMARY, 0), len(body)):
        if any(cell not in ("", None) for cell in body[place]):
            continue
        below = [cell for row in body[place:] for cell in row if isinstance(cell, str)]
        return body[:place] if any(text.strip(" .,-") for text in below) else body
    return body


def _check_size(path: Path, sheet: str, page: object) -> None:
    height, width = (getattr(page, f"total_{side}") for side in ("height", "width"))
    if height * width > _MAX_CELLS:
        raise ReadError(f"sheet '{shown(sheet)}' is larger than a table of numbers", where=path)


def is_small(page: object) -> bool:
    """Whether a sheet (of calamine) is so small that it may contain settings."""
    height, width = (getattr(page, f"total_{side}") for side in ("height", "width"))
    return bool(height <= _MAX_ROWS and width <= _MAX_WIDE)


def _settings_above(rows: Cells) -> list[Setting]:
    """Return each row that contains words as a setting."""
    settings = []
    for line, row in enumerate(rows, start=1):
        cells = [" ".join(str(cell).split()) for cell in row[:_MAX_WIDE] if cell not in ("", None)]
        if cells and any(map(str.isalpha, "".join(cells))):
            text = "\t".join(cells)[:_MAX_SETTING]
            settings.append(Setting("", text, Place(line=line)))
    return settings


def of_cells(cells: Sequence[object]) -> np.ndarray:
    """Return a sheet column as numbers, dates or times of day; if impossible, its first bad cell.

    >>> of_cells(["0,5", "", 2]).tolist(), of_cells([1.0, "error"]).tolist()
    ([0.5, nan, 2.0], ['error'])
    """
    first = next((cell for cell in cells if cell != ""), None)
    if isinstance(first, dt.datetime):
        moments = [c if isinstance(c, dt.datetime) else None for c in cells]
        return np.array(moments, dtype="datetime64[us]")
    if isinstance(first, dt.time | dt.timedelta):
        return np.array([_passed(cell) for cell in cells], dtype="timedelta64[us]")
    try:
        return np.array([_number(cell) for cell in cells], dtype=float)
    except ValueError:
        return np.array([next(str(cell) for cell in cells if not _is_number(cell))])


def _passed(cell: object) -> dt.timedelta | None:
    if isinstance(cell, dt.time):
        return dt.datetime.combine(dt.date.min, cell) - dt.datetime.min
    return cell if isinstance(cell, dt.timedelta) else None


def _number(cell: object) -> float:
    if isinstance(cell, int | float):
        return float(cell)
    text = str(cell).strip()
    return float(text.replace(",", ".")) if text else np.nan


def _is_number(cell: object) -> bool:
    try:
        _number(cell)
    except ValueError:
        return False
    return True
