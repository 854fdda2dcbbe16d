"""Maps as grids of the program Surfer: text (DSAA) or single precision (DSBB), without units."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, brief
from tribolab.reading.raw.missing_marks import measurable
from tribolab.reading.scans.formats.named_units import unit_remedy
from tribolab.reading.scans.formats.profilometers import MissingUnitError
from tribolab.units.conversion import conversion

_TEXT, _SINGLE = b"DSAA", b"DSBB"
_BLANK = 1.70141e38  # sentinel; larger numbers are sentinels, too
_MAX_HEIGHTS = 100_000_000  # most heights


def is_surfer(head: bytes) -> bool:
    """Whether a file begins like a Surfer grid."""
    return head.startswith((_TEXT, _SINGLE))


def read_surfer(
    path: Path, x_unit: str | None = None, height_unit: str | None = None
) -> xr.Dataset:
    """Read a Surfer grid as a map.

    Parameters
    ----------
    path
        The file.
    x_unit, height_unit
        Units of positions and heights.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (y, x).

    Raises
    ------
    MissingUnitError
        If the units are not given.
    ReadError
        If the file is damaged.
    """
    content = path.read_bytes()
    try:
        if content.startswith(_TEXT):
            numbers = np.array(content[len(_TEXT) :].split(), dtype=float)
            sizes, ends, heights = numbers[:2], numbers[2:8], numbers[8:]
        else:
            sizes = np.array(struct.unpack_from("<hh", content, 4), dtype=float)
            ends = np.array(struct.unpack_from("<6d", content, 8))
            heights = np.frombuffer(content[56:], "<f4").astype(float)
        columns, rows = (int(size) for size in sizes)
    except (ValueError, OverflowError, struct.error) as error:
        raise ReadError(f"the grid is damaged: {brief(error)}", where=path) from error
    if ends.size < 6 or min(rows, columns) < 2 or rows * columns > _MAX_HEIGHTS:
        raise ReadError(f"{columns} x {rows} points, as it says, are no map", where=path)
    if heights.size != rows * columns:
        raise ReadError(
            f"{heights.size} heights are in the file, but it says that they are {columns} x "
            f"{rows}; is it whole?",
            where=path,
        )
    if x_unit is None or height_unit is None:
        lacking = [
            f"the unit of {what}"
            for what, unit in (("its positions", x_unit), ("its heights", height_unit))
            if unit is None
        ]
        raise MissingUnitError(
            f"a Surfer grid does not say {' and '.join(lacking)}",
            where=path,
            cure=unit_remedy(path, along=x_unit is None, up=height_unit is None),
        )
    heights[heights >= _BLANK] = np.nan
    along, up = conversion(x_unit, "m")[0], conversion(height_unit, "m")[0]
    dx, dy = (
        along * (ends[2 * axis + 1] - ends[2 * axis]) / (number - 1)
        for axis, number in enumerate((columns, rows))
    )
    if not (dx > 0 and dy > 0):
        raise ReadError("its points do not proceed along x and y", where=path)
    return xr.Dataset(
        {"height": (("y", "x"), measurable(up * heights.reshape(rows, columns)))},
        {"y": dy * np.arange(rows), "x": dx * np.arange(columns)},
        {"instrument": "Surfer grid"},
    )
