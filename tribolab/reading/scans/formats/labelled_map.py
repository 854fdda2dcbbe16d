"""Maps with positions along two sides of the heights, in text or a workbook.

Spreadsheets and mathematics programs write such maps: x across the top, y down the side.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import islice, starmap
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.reading.raw.containers.workbook import sheets_of
from tribolab.reading.raw.missing_marks import measurable, take_marks
from tribolab.reading.raw.unpacked import ZIP, is_workbook
from tribolab.reading.scans.formats.matrix import GRAMMARS, cells_of, texts_of, value_of
from tribolab.reading.scans.formats.named_units import unit_remedy
from tribolab.reading.scans.formats.profilometers import MissingUnitError
from tribolab.reading.scans.header import map_header, unit_of_resolution
from tribolab.units.conversion import conversion

_HEAD_LINES = 60  # most lines above the positions
_MIN_ROWS = 8  # least rows, and heights of each
_HEAD = 1 << 20  # bytes in which a map must begin
_COUNT = re.compile(r"([^\W\d_][^\d]{0,19}?[\s=_]*)(\d+)")  # a label of a column: a word, a number
_EVEN = 1e-2  # rounding of positions, as share of a step


class _Map(NamedTuple):
    """Header lines, the corner cell, positions [file's unit] across and down, heights (y, x).

    Labels across such as "POS = 3" are `counted`: they number the points and are no positions.
    """

    above: list[str]
    corner: str
    x: np.ndarray
    y: np.ndarray
    heights: np.ndarray
    mark: str
    counted: bool


def read_labelled_map(
    path: Path, x_unit: str | None = None, height_unit: str | None = None
) -> xr.Dataset | None:
    """Read a map with positions along two sides.

    Parameters
    ----------
    path
        Text, or a workbook.
    x_unit, height_unit
        Units of positions and heights, if the file states none.

    Returns
    -------
    xarray.Dataset or None
        ``height`` [m] (y, x) by increasing positions; None if the file is not such a map.

    Raises
    ------
    MissingUnitError
        If units of positions or heights are not stated.
    """
    found = next(filter(None, starmap(_map_of, _tables(path))), None)
    if found is None:
        return None
    lines = [*found.above, found.corner]
    header = map_header(lines, found.heights.shape, found.mark)
    unit = conversion(x_unit, "m")[0] if x_unit else header.along
    along, down = (header.dx, header.dy) if found.counted else (unit, unit)
    height = conversion(height_unit, "m")[0] if height_unit else header.height
    height = unit_of_resolution(header, found.heights) if height is None else height
    if found.counted and (along is None or down is None):
        raise MissingUnitError(
            "a map whose rows and columns number its points, and whose pitch is not stated",
            where=path,
            cure="write it above the numbers, e.g. 'Pitch: 0.5 um'",
        )
    lacking = ["positions"] * (along is None) + ["heights"] * (height is None)
    if along is None or down is None or height is None:
        raise MissingUnitError(
            "a map with positions along two sides that does not say the unit of its "
            f"{' and '.join(lacking)}",
            where=path,
            cure=unit_remedy(path, along=along is None, up=height is None),
        )
    heights = height * found.heights
    attrs = {"instrument": "map with positions along two sides, by its header"}
    if marks := take_marks([heights.reshape(-1)]):
        attrs["taken_for_missing"] = "; ".join(f"height: {mark.words}" for mark in marks)
    scan = xr.Dataset(
        {"height": (("y", "x"), measurable(heights))},
        {"y": down * found.y, "x": along * found.x},
        attrs,
    )
    return scan.sortby(["y", "x"])


def _tables(path: Path) -> Iterator[tuple[list[list[str]], str]]:
    """Yield cells and decimal mark of each sheet, or of the text for each grammar."""
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if head.startswith(ZIP):
        sheets = sheets_of(path).values() if is_workbook(path) else ()
        yield from (([[_cell(cell) for cell in row] for row in sheet], ".") for sheet in sheets)
        return
    if not any(_grammars(text.splitlines()) for text in texts_of(head)):
        return
    for text in texts_of(path.read_bytes()):
        lines = text.splitlines()
        for delimiter, mark in _grammars(lines):
            yield [cells_of(line, delimiter) for line in lines], mark


def _grammars(lines: Sequence[str]) -> list[tuple[str | None, str]]:
    """Return the delimiters and decimal marks with which lines form such a map."""
    head = lines[: _HEAD_LINES + _MIN_ROWS]
    return [
        (delimiter, mark)
        for delimiter, mark in GRAMMARS
        if _begin([cells_of(line, delimiter) for line in head], mark) is not None
    ]


def _cell(cell: object) -> str:
    return repr(float(cell)) if isinstance(cell, int | float) else str(cell).strip()


def _begin(rows: Sequence[Sequence[str]], mark: str) -> int | None:
    """Return the row of positions at the start of such a map."""
    for place, row in enumerate(islice(rows, _HEAD_LINES)):
        below = rows[place + 1 : place + 1 + _MIN_ROWS]
        if len(row) <= _MIN_ROWS or len(below) < _MIN_ROWS or {len(r) for r in below} != {len(row)}:
            continue
        if _even(_across(row, mark)[0]) and _even(_numbers([r[0] for r in below], mark)):
            return place
    return None


def _across(row: Sequence[str], mark: str) -> tuple[np.ndarray | None, bool]:
    """Return the labels of columns as numbers, and whether words in them say that they count.

    File: Olympus OLS5000, "DataLine", "POS = 0", "POS = 1" (jarredclloyd/GeochemistryTools.jl).
    """
    counts = [_COUNT.fullmatch(cell.strip()) for cell in row[1:]]
    numbered = [match for match in counts if match]
    if len(numbered) == len(counts) and len({match[1] for match in numbered}) == 1:
        return np.array([float(match[2]) for match in numbered]), True
    return _numbers(row[1:], mark), False


def _numbers(cells: Sequence[str], mark: str) -> np.ndarray | None:
    """Return cells as numbers, with NaN for empty ones; None if a cell is other text."""
    values = [value_of(cell, mark) for cell in cells]
    return None if None in values else np.array(values, float)


def _even(values: np.ndarray | None) -> bool:
    """Whether numbers increase or decrease in even steps."""
    if values is None:
        return False
    steps = np.diff(values)
    usual = float(np.median(steps))
    return bool(usual and (np.abs(steps - usual) <= _EVEN * abs(usual)).all())


def _map_of(rows: Sequence[Sequence[str]], mark: str) -> _Map | None:
    place = _begin(rows, mark)
    across, counted = (None, False) if place is None else _across(rows[place], mark)
    if place is None or across is None:
        return None
    body = []
    for row in rows[place + 1 :]:
        values = _numbers(row, mark) if len(row) == across.size + 1 else None
        if values is None or np.isnan(values[0]):
            break
        body.append(values)
    table = np.array(body)
    if len(body) < _MIN_ROWS or not _even(table[:, 0]):
        return None
    above = [" ".join(filter(None, row)) for row in rows[:place]]
    x, y = (np.linspace(side[0], side[-1], side.size) for side in (across, table[:, 0]))
    return _Map(above, rows[place][0], x, y, table[:, 1:], mark, counted)
