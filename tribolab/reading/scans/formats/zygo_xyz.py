"""Text maps of Zygo's MetroPro: pixels and heights, "No Data" for missing ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, brief
from tribolab.reading import cures
from tribolab.reading.raw.missing_marks import measurable
from tribolab.reading.scans.formats.profilometers import MissingUnitError
from tribolab.units.conversion import conversion

_BEGIN = b"Zygo XYZ Data File"
_HEIGHT = 1e-6  # m per unit in the file
_SIZES, _LENGTHS = 3, 7  # numbers of header lines, from 0
_RESOLUTION = 6  # index of the camera's resolution [m] in its line


def is_zygo_xyz(head: bytes) -> bool:
    """Whether a file begins like a text map of MetroPro."""
    return head.startswith(_BEGIN)


def read_zygo_xyz(path: Path, x_unit: str | None = None) -> xr.Dataset:
    """Read a text map of MetroPro.

    Parameters
    ----------
    path
        The file.
    x_unit
        Size of a pixel, if the camera was not calibrated: ``"1.5 um"``.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (y, x).

    Raises
    ------
    MissingUnitError
        If the size of a pixel is not stated.
    ReadError
        If the file is damaged.
    """
    above, mark, below = path.read_text("latin-1").partition("\n#")
    try:
        lines = above.splitlines()
        columns, rows = (int(size) for size in lines[_SIZES].split()[2:4])
        pixel = float(lines[_LENGTHS].split()[_RESOLUTION])
        body = below.partition("#")[0].replace("No Data", "nan")
        points = np.array(body.split(), dtype=float).reshape(-1, 3)
    except (ValueError, IndexError) as error:
        raise ReadError(f"the map is damaged: {brief(error)}", where=path) from error
    if not mark or len(points) != rows * columns or not len(points):
        raise ReadError(
            f"{len(points)} points are in the file, but it says that they are {columns} x "
            f"{rows}; is it whole?",
            where=path,
        )
    if not pixel > 0 and x_unit is None:
        what = "it does not say how large a pixel is: its camera was not calibrated"
        raise MissingUnitError(what, where=path, cure=cures.SIZE)
    pixel = pixel if pixel > 0 or x_unit is None else conversion(x_unit, "m")[0]
    x, y = (points[:, axis] - points[:, axis].min() for axis in (0, 1))
    grid = np.full((rows, columns), np.nan)
    try:
        grid[y.astype(int), x.astype(int)] = _HEIGHT * points[:, 2]
    except (IndexError, ValueError) as error:
        raise ReadError("a point lies outside of its map", where=path) from error
    return xr.Dataset(
        {"height": (("y", "x"), measurable(grid))},
        {"y": pixel * np.arange(rows), "x": pixel * np.arange(columns)},
        {"instrument": "Zygo XYZ text"},
    )
