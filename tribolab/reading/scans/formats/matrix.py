"""Text maps of any maker: a matrix of heights below lines that state its size.

Keyence, Alicona, Bruker and Zygo microscopes export such maps, each with its own words.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, shown
from tribolab.reading import cures
from tribolab.reading.raw.missing_marks import Marked, measurable, take_marks
from tribolab.reading.scans.formats.named_units import unit_remedy
from tribolab.reading.scans.formats.profilometers import MissingUnitError
from tribolab.reading.scans.header import MapHeader, map_header, unit_of_range, unit_of_resolution
from tribolab.reading.scans.sentinels import take_stated
from tribolab.units.conversion import conversion

_HEAD = 1 << 20  # bytes in which a matrix must begin
_CUT = 8  # most bytes of an incomplete character at the end of the head
_HEAD_LINES = 200  # most lines above a matrix
_MIN_COLUMNS = 8  # fewest columns of a matrix; fewer may be a table
_MAX_OF_LINE = 24  # most numbers per line of a profile that continues on the next line
_NUMBERED = re.compile(r"([^\W\d_]\D{0,20})(\d{1,6})")  # a word followed by a number
_ROWS = 4  # rows of equal width needed to recognise a matrix
_MARKS = frozenset(
    ("", "no data", *"bad nan -nan n/a na inf -inf null none invalid void nodata".split())
)
_SIGNS = frozenset("*-#?")
_ENCODINGS = ("utf-8-sig", "cp932", "gb18030", "latin-1")
_GRAMMARS = (
    *(("\t", "."), ("\t", ","), (";", "."), (";", ","), (",", "."), (None, "."), (None, ",")),
)


class _Matrix(NamedTuple):
    """Matrix of numbers in a text; `above` are the lines before it.

    `alone`: no other rows of numbers follow. `ragged`: a shorter row follows.
    """

    above: list[str]
    rows: list[list[float]]
    delimiter: str | None
    mark: str
    columns: int
    alone: bool = True
    ragged: bool = False


def read_matrix(
    path: Path, x_unit: str | None = None, height_unit: str | None = None
) -> xr.Dataset | None:
    """Read a map from a text file with a matrix of heights.

    Parameters
    ----------
    path
        The file.
    x_unit, height_unit
        Units of positions and heights, for files that state none.

    Returns
    -------
    xarray.Dataset or None
        ``height`` [m] (y, x), with rows in the order of the file; None if it is not a matrix.

    Raises
    ------
    MissingUnitError
        If the pitch or the unit of heights is not stated.
    ReadError
        If the numbers of rows and columns differ from the stated ones, or there are several
        matrices.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if not any(_matrix(text.splitlines()) for text in _texts_of(head)):
        return None
    found: tuple[_Matrix, MapHeader] | None = None
    for text in _texts_of(path.read_bytes()):
        matrix = _matrix(text.splitlines())
        if matrix is None:
            continue
        shape = len(matrix.rows), matrix.columns
        commas = matrix.delimiter == ","
        header = map_header(
            matrix.above, shape, matrix.mark, commas_part=commas, x_unit=x_unit or ""
        )
        if header.height is None and height_unit is not None:
            header = header._replace(height=conversion(height_unit, "m")[0])
        if found is None or (header.dx and header.dy and header.height):
            found = matrix, header
    if found is None:
        return None
    matrix, header = found
    if matrix.columns < _MIN_COLUMNS and header.columns != matrix.columns:
        return None
    heights = np.array(matrix.rows)
    if _even(heights[0, 1:]) and _even(heights[1:, 0]):
        return None  # the first row and the first column are positions
    counted = any(0 <= n - heights.size < matrix.columns for _, n in header.stated)
    wrapped = matrix.ragged or (counted and matrix.columns <= _MAX_OF_LINE)
    if wrapped and header.columns is None:
        return None  # a profile whose heights continue on the next line
    whole = (heights == np.round(heights)) | np.isnan(heights)
    if header.gauge_step not in (None, header.height) and whole.all():
        header = header._replace(height=None)  # the heights may be counts of the gauge step
    if header.height is None:
        unit = unit_of_range(header, heights) or unit_of_resolution(header, heights)
        header = header._replace(height=unit)
    _refuse(path, matrix, header)
    return map_of(heights, header, "matrix of heights, by its header")


def map_of(heights: np.ndarray, header: MapHeader, instrument: str) -> xr.Dataset:
    """Return a map [m] (y, x) from the heights as in the file; sentinels become NaN."""
    assert header.dx and header.dy and header.height  # otherwise refused
    attrs = {"instrument": instrument}
    attrs |= {"doubtful": header.doubt} if header.doubt else {}
    if missing := _remove_sentinels(heights, header):
        attrs["taken_for_missing"] = missing
    rows, columns = heights.shape
    return xr.Dataset(
        {"height": (("y", "x"), measurable(header.height * heights))},
        {"y": header.dy * np.arange(rows), "x": header.dx * np.arange(columns)},
        attrs,
    )


def _remove_sentinels(heights: np.ndarray, header: MapHeader) -> str:
    """Replace sentinels by NaN, and return a text that lists them."""
    stated = take_stated(heights, header.stated)
    marks = [
        f"height: {Marked(number, count).words}, as the header states ('{shown(name, 30)}')"
        for name, number, count in stated
    ]
    marks += [f"height: {mark.words}" for mark in take_marks([heights.reshape(-1)])]
    return "; ".join(marks)


def _texts_of(content: bytes) -> list[str]:
    """Return the content decoded with each encoding that fits; usually only one does."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return [content.decode("utf-16", "replace")]
    if b"\0" in content[:8192]:
        return []
    texts = []
    for encoding in _ENCODINGS:
        try:
            texts.append(content.decode(encoding))
        except UnicodeDecodeError as error:
            if len(content) - error.start < _CUT and encoding != "latin-1":
                texts.append(content[: error.start].decode(encoding))  # incomplete character
        if texts and encoding == "utf-8-sig":
            break
    return texts


def _matrix(lines: list[str]) -> _Matrix | None:
    """Return the first matrix of numbers in a text; None if column names are above it."""
    for start in range(min(len(lines), _HEAD_LINES)):
        first = lines[start : start + _ROWS]
        if len(first) < _ROWS or not first[0].strip():
            continue
        for delimiter, mark in _GRAMMARS:
            columns = len(_cells_of(first[0], delimiter))
            trial = _Matrix(lines[:start], [], delimiter, mark, columns)
            if columns < _ROWS or any(_numbers(line, trial) is None for line in first):
                continue
            names = _cells_of(_last_line(trial), delimiter)[1:]
            if len(names) == columns - 1 and are_numbered(names):
                return _without_numbers(_complete(lines[start:], trial))
            return None if _is_named(trial) else _complete(lines[start:], trial)
    return None


def are_numbered(names: Sequence[str]) -> bool:
    """Whether names are the same word followed by consecutive numbers, like the points of a map.

    File: an area of an Olympus OLS5000, "DataLine", "POS = 0" to "POS = 1023"
    (jarredclloyd/GeochemistryTools.jl).

    >>> are_numbered(["POS = 0", "POS = 1", "POS = 2"]), are_numbered(["CH1", "CH3", "T"])
    (True, False)
    """
    found = [match for name in names if (match := _NUMBERED.fullmatch(name))]
    alike = len(found) == len(names) > 1 and len({match[1] for match in found}) == 1
    return alike and bool((np.diff([int(match[2]) for match in found]) == 1).all())


def _without_numbers(matrix: _Matrix) -> _Matrix | None:
    """Return the matrix without its first column; None unless that column numbers the rows."""
    if any(row[0] != matrix.rows[0][0] + place for place, row in enumerate(matrix.rows)):
        return None
    above = matrix.above[: matrix.above.index(_last_line(matrix))]
    rows = [row[1:] for row in matrix.rows]
    return matrix._replace(above=above, rows=rows, columns=matrix.columns - 1)


def _last_line(matrix: _Matrix) -> str:
    return next((line for line in reversed(matrix.above) if line.strip()), "")


def _is_named(matrix: _Matrix) -> bool:
    """Whether names or positions of columns are above the matrix."""
    names = _cells_of(_last_line(matrix), matrix.delimiter)
    return len(names) >= max(_ROWS, matrix.columns - 1)


def _complete(lines: Sequence[str], like: _Matrix) -> _Matrix:
    """Return the matrix with all its rows; `alone` is whether no other rows follow."""
    rows: list[list[float]] = []
    for number, line in enumerate(lines):
        values = _numbers(line, like) if line.strip() else None
        if values is None:
            rest = (_numbers(below, like) for below in lines[number:] if below.strip())
            alone = all(values is None for values in rest)
            return like._replace(rows=rows, alone=alone, ragged=_is_part(line, like))
        rows.append(values)
    return like._replace(rows=rows)


def _is_part(line: str, like: _Matrix) -> bool:
    """Whether a line is a shorter row of numbers."""
    cells = _cells_of(line, like.delimiter) if line.strip() else []
    part = like._replace(columns=len(cells))
    return 0 < len(cells) < like.columns and _numbers(line, part) is not None


def _cells_of(line: str, delimiter: str | None) -> list[str]:
    """Return the cells of a line, without an empty one after a final delimiter."""
    cells = [cell.strip().strip('"') for cell in line.split(delimiter)]
    return cells[:-1] if delimiter is not None and line.rstrip().endswith(delimiter) else cells


def _numbers(line: str, like: _Matrix) -> list[float] | None:
    """Return the numbers of a row, with NaN for missing heights; None for any other line."""
    cells = _cells_of(line, like.delimiter)
    if len(cells) == like.columns - 1 and like.delimiter is not None:
        cells.append("")  # the last height is missing
    if len(cells) != like.columns:
        return None
    if like.mark == ".":
        try:
            return [*map(float, cells)]
        except ValueError:
            pass
    values = [_value_of(cell, like.mark) for cell in cells]
    return None if None in values else [value for value in values if value is not None]


def _value_of(cell: str, mark: str) -> float | None:
    """Return the number in a cell, NaN for a missing height, None for any other text."""
    try:
        return float(cell if mark == "." else cell.replace(".", "x").replace(mark, "."))
    except ValueError:
        bare = cell.lower()
        return float("nan") if bare in _MARKS or set(bare) <= _SIGNS else None


def _even(values: np.ndarray) -> bool:
    """Whether numbers increase in even steps, as positions do."""
    steps = np.diff(values)
    return bool(steps.size > 1 and (np.abs(steps - steps[0]) < 1e-3 * abs(steps[0])).all())


def _refuse(path: Path, matrix: _Matrix, header: MapHeader) -> None:
    """Raise if a matrix is incomplete, or its header insufficient."""
    rows, columns = len(matrix.rows), matrix.columns
    apart = "how far its points lie apart along x and y"
    if header.without_unit:
        apart = f"the unit of '{shown(header.without_unit, 40)}'"
    lacking = [
        what
        for what, known in (
            (apart, header.dx and header.dy),
            ("in which unit its heights are", header.height),
        )
        if not known
    ]
    if lacking:
        what = f"a matrix of {rows} x {columns} numbers that does not say {' or '.join(lacking)}"
        write = "write it above the numbers, as 'Pixel size: 0.5 um' and 'Height unit: um'"
        along = not (header.dx and header.dy)
        if along and not header.without_unit:  # a unit in the file name would not suffice
            raise MissingUnitError(what, where=path, cure=write)
        cure = unit_remedy(path, along=along, up=header.height is None)
        raise MissingUnitError(what, where=path, cure=cures.either(write, cure))
    if not matrix.alone:
        raise ReadError(
            f"{path}: the file contains several matrices of numbers; leave only the heights"
        )
    if matrix.ragged:
        raise ReadError(
            f"{path}: below {rows} rows of {columns} numbers stands a row of fewer; is it whole?"
        )
    if header.rows not in (None, rows) or header.columns not in (None, columns):
        raise ReadError(
            f"{path}: {rows} rows of {columns} numbers are in the file, but it says that they "
            f"are {header.rows or rows} rows of {header.columns or columns}; is it whole?"
        )
