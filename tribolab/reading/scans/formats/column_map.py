"""Maps as one column of heights, row after row, below lines that say how many make a row.

So export force microscopes their images as text.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.errors import ReadError, shown
from tribolab.reading.raw.missing_marks import measurable, take_marks
from tribolab.reading.scans.formats.matrix import texts_of, value_of
from tribolab.reading.scans.header import MapHeader, map_header

_HEAD = 1 << 16  # bytes in which a column begins
_HEAD_LINES = 500  # above it
_FEWEST = 8  # rows, and heights of each
_ROWS = 20  # numbers that tell a column
_LINE = (
    r"(?:columns?|kolom(?:men)?|spalten?|colonn\w+|column\w+|colun\w+|sloup\w+|kolumn\w*|sarak\w+"
    r"|oszlop\w*|столб\w+|列)"
)
_ROW = (
    r"(?:rows?|rij(?:en)?|zeilen?|lignes?|filas?|righ[ei]|linhas?|rader?|rækk\w+|wiersz\w*|řád\w*"
    r"|rivi\w*|sor\w*|строк\w*|行)"
)
_BY = r"\W{1,3}(?:by|after|voor|na|für|nach|par|por|per|za|po|till|för|kerrallaan|за|逐)?\W{0,3}"
_FAST = (
    r"\W.{0,30}(?:fast|snel|schnell|vite|rápid|rapid|veloc|szybc|rychl|hurt|nope|gyors|быстр|快|速)"
)
_BY_COLUMNS = re.compile(
    rf"{_LINE}{_BY}{_LINE}|column[\s-]?major|fortran|spaltenweise|逐列|(?<![^\W\d_])y{_FAST}", re.I
)
_BY_ROWS = re.compile(
    rf"{_ROW}{_BY}{_ROW}|row[\s-]?major|zeilenweise|逐行|(?<![^\W\d_])x{_FAST}", re.I
)
_ORDER = re.compile(  # an order that is stated in other words
    r"(?<![^\W_])(?:order|volgorde|reihenfolge|ordre|orden|ordine|ordem|ordning|rækkefølge|rekkefølge"
    r"|kolejność|pořadí|järjestys|sorrend|sıra\w*|порядок|顺序|順序?)(?![^\W_])"
    rf".*(?:{_LINE}|{_ROW}|(?<![^\W\d_])[xy](?![^\W\d_]))|meander|serpentin|boustro",
    re.IGNORECASE,
)


class UnclearOrderError(ReadError):
    """The heights of a map stand in an order that is stated in words that are not known."""


def read_column_map(path: Path) -> xr.Dataset | None:
    """Read a map whose heights stand below each other.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    xarray.Dataset or None
        ``height`` [m] (y, x); None where the file is no such column, or does not say how many
        heights make a row, how far they lie apart and in what unit they are.

    Raises
    ------
    UnclearOrderError
        If the text states an order that is not known.
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
        if _goes_by_columns(path, lines[:place]):
            return _map(heights.reshape(header.columns, header.rows).T, header)
        return _map(heights.reshape(header.rows, header.columns), header)
    return None


def _goes_by_columns(path: Path, above: list[str]) -> bool:
    """Whether the heights stand column after column; a stated order that is not known is none."""
    if any(_BY_COLUMNS.search(line) for line in above):
        return True
    said = [line for line in above if _ORDER.search(line)]
    if said and not any(_BY_ROWS.search(line) for line in above):
        raise UnclearOrderError(
            f"the order of the heights is not understood: '{shown(said[0].strip(), 80)}'",
            where=path,
            cure="save it as a matrix, or say 'row by row' or 'column by column'",
        )
    return False


def _map(heights: np.ndarray, header: MapHeader) -> xr.Dataset:
    assert header.dx and header.dy and header.height  # else `_header` gives none
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
    """Return what stands above, if it says all that is needed."""
    counts = map_header(above, (1, 1), mark)
    if counts.rows is None or counts.columns is None or min(counts.rows, counts.columns) < _FEWEST:
        return None
    told = map_header(above, (counts.rows, counts.columns), mark)
    return told if told.dx and told.dy and told.height else None


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
    """Return the numbers up to the first line that is none; blank lines are passed over."""
    values = []
    for line in lines:
        if not (cell := line.strip()):
            continue
        number = value_of(cell, mark)
        if number is None:
            break
        values.append(number)
    return np.array(values)
