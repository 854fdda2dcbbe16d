"""Text that Bruker's NanoScope exports: the heights of an image in one column, row after row."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, brief
from tribolab.reading.scans.formats.matrix import map_of
from tribolab.reading.scans.header import map_header

_MARK = b"\\Samps/line:"


def is_nanoscope(head: bytes) -> bool:
    """Whether a file begins like a text export of NanoScope with its header."""
    return _MARK in head and b"\0" not in head


def read_nanoscope(path: Path) -> xr.Dataset:
    """Read the heights of a NanoScope text export as a map.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (y, x).

    Raises
    ------
    ReadError
        If the file states no size or unit, contains several channels, or is incomplete.
    """
    lines = path.read_text("latin-1").split("\n")
    above = [n for n, line in enumerate(lines, 1) if line.strip()[:1] in ("\\", '"')]
    begin = max(above, default=0)
    counts = map_header(lines[:begin], (1, 1), ".")
    header = map_header(lines[:begin], (counts.rows or 1, counts.columns or 1), ".")
    if not (header.rows and header.columns and header.dx and header.dy and header.height):
        what = "its header does not state samples per line, lines, scan size and unit of heights"
        raise ReadError(what, where=path, cure="export it with its header and one channel")
    try:
        heights = np.array(lines[begin:] if lines[-1].strip() else lines[begin:-1], dtype=float)
        heights = heights.reshape(header.rows, header.columns)
    except ValueError as error:
        raise ReadError(
            f"the image is damaged: {brief(error)}; is it whole?", where=path
        ) from error
    return map_of(heights, header, "NanoScope text")
