"""Maps as a single column of heights, row after row, with the row length in the header.

Force microscopes export their images as such text.
"""

from __future__ import annotations

import functools
import re
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import shown
from tribolab.reading.lexicon.lexicon import plain_text, text_pattern
from tribolab.reading.raw.missing_marks import measurable, take_marks
from tribolab.reading.scans.extent import RefusedScanError
from tribolab.reading.scans.formats.matrix import texts_of, value_of
from tribolab.reading.scans.header import MapHeader, map_header

_HEAD = 1 << 16  # bytes in which a column must begin
_HEAD_LINES = 500  # most lines above it
_MIN_ROWS = 8  # least rows, and heights of each
_ROWS = 20  # numbers needed to recognise a column
_FAST = r"(?:\S+ ){{0,4}}?{fastest}"


@functools.cache
def _order_pattern(what: str) -> re.Pattern[str]:
    """Return a pattern for normalised lines (`plain_text`) that state an order of heights."""
    column, row, each, fastest, order = (
        f"(?:{text_pattern(name).pattern})"
        for name in ("map_column", "map_row", "one_by_one", "fastest", "stated_order")
    )
    of_columns = rf"{column}\w* ?(?:{each} ?)?{column}|\by {_FAST.format(fastest=fastest)}"
    of_rows = rf"{row}\w* ?(?:{each} ?)?{row}|\bx {_FAST.format(fastest=fastest)}"
    forms = {
        "by_columns": of_columns,
        "by_rows": of_rows,
        "to_and_fro": rf"{order}.*(?:{column}|{row}|\b[xy]\b)",
    }
    return re.compile(f"{forms[what]}|{text_pattern(what).pattern}")


def _states(line: str, what: str) -> bool:
    return _order_pattern(what).search(plain_text(line)) is not None


def read_column_map(path: Path) -> xr.Dataset | None:
    """Read a map whose heights are in one column.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    xarray.Dataset or None
        ``height`` [m] (y, x); None if the file is not such a column, or does not state row length,
        pitch and unit.

    Raises
    ------
    RefusedScanError
        If the text states an unknown order.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if not any(_begin(text.splitlines()) for text in texts_of(head)):
        return None
    for text in texts_of(path.read_bytes()):
        lines = text.splitlines()
        begin = _begin(lines)
        if begin is None:
            continue
        place, mark = begin
        header = _header(lines[:place], mark)
        if header is None or header.rows is None or header.columns is None:
            continue
        heights = _numbers(lines[place:], mark)
        if heights.size != header.rows * header.columns:
            continue
        if _is_column_by_column(path, lines[:place]):
            return _map(heights.reshape(header.columns, header.rows).T, header)
        return _map(heights.reshape(header.rows, header.columns), header)
    return None


def _is_column_by_column(path: Path, above: list[str]) -> bool:
    """Whether the heights are stored column by column; raise if a stated order is unknown."""
    if any(_states(line, "by_columns") for line in above):
        return True
    turning = [line for line in above if _states(line, "to_and_fro")]
    if turning and not any(_states(line, "by_rows") for line in above):
        raise RefusedScanError(
            f"the order of the heights is not understood: '{shown(turning[0].strip(), 80)}'",
            where=path,
            cure="save it as a matrix, or say 'row by row' or 'column by column'",
        )
    return False


def _map(heights: np.ndarray, header: MapHeader) -> xr.Dataset:
    assert header.dx and header.dy and header.height  # otherwise `_header` returns None
    attrs = {"instrument": "map in one column, by its header"}
    attrs |= {"doubtful": header.doubt} if header.doubt else {}
    if marks := take_marks([heights.reshape(-1)]):
        attrs["taken_for_missing"] = "; ".join(f"height: {mark.words}" for mark in marks)
    rows, columns = heights.shape
    return xr.Dataset(
        {"height": (("y", "x"), measurable(header.height * heights))},
        {"y": header.dy * np.arange(rows), "x": header.dx * np.arange(columns)},
        attrs,
    )


def _header(above: list[str], mark: str) -> MapHeader | None:
    """Return the header, if it states everything needed."""
    counts = map_header(above, (1, 1), mark)
    if (
        counts.rows is None
        or counts.columns is None
        or min(counts.rows, counts.columns) < _MIN_ROWS
    ):
        return None
    found = map_header(above, (counts.rows, counts.columns), mark)
    return found if found.dx and found.dy and found.height else None


def _begin(lines: list[str]) -> tuple[int, str] | None:
    """Return the line at which a column of numbers begins, and its decimal mark."""
    for place in range(1, min(len(lines) - _ROWS, _HEAD_LINES)):
        first = [line.strip() for line in lines[place : place + _ROWS]]
        if not first[0] or first[0][0] not in "+-.,0123456789":
            continue
        for mark in ".,":
            if all(cell and value_of(cell, mark) is not None for cell in first):
                return place, mark
    return None


def _numbers(lines: list[str], mark: str) -> np.ndarray:
    """Return the numbers up to the first other line; blank lines are ignored."""
    values = []
    for line in lines:
        if not (cell := line.strip()):
            continue
        number = value_of(cell, mark)
        if number is None:
            break
        values.append(number)
    return np.array(values)
