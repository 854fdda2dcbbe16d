"""Reference profiles of national laboratories for software tests: SMD and PRF text.

SMD is the format of ISO 5436-2:2001; PRF is that of Talyprofile. Both name the axes in lines that
begin with CX and CZ. The layouts are those of NPL's softgauges.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, UnitError, brief
from tribolab.reading.raw.missing_marks import measurable
from tribolab.reading.scans.grid import even
from tribolab.units.conversion import conversion

_AXIS = re.compile(
    rb"^[ \t]*C(?P<axis>[XYZ])[ \t]+(?P<kind>[IAM])[ \t]+(?P<number>[\d.eE+]+)[ \t]+(?P<unit>\w+)"
    rb"[ \t]+(?P<scale>[-+\d.eE]+)[ \t]+[ILFD](?:[ \t]+(?P<step>[-+\d.eE]+))?[ \t]*$",
    re.MULTILINE,
)
_SPACING = re.compile(rb"^[ \t]*SPACING[ \t]+CX[ \t]+([-+\d.eE]+)", re.MULTILINE)
_TIP = re.compile(rb"^[ \t]*STYLUS_RADIUS[ \t]+([-+\d.eE]+)[ \t]+(\w+)", re.MULTILINE)
_BREAK = re.compile(rb"[\r\n]+")
_END = re.compile(rb"[\x03\x1a]+")  # SMD separates records by ETX


def is_gauge(head: bytes) -> bool:
    """Whether a file begins like SMD or PRF text."""
    axes = {match["axis"] for match in _AXIS.finditer(_lines(head[:8192]))}
    return {b"X", b"Z"} <= axes


def read_gauge(path: Path) -> xr.Dataset:
    """Read a profile in SMD or PRF text.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (x); ``tip_radius_m`` if stated.

    Raises
    ------
    ReadError
        If heights are fewer than stated, or the pitch is missing.
    """
    content = _lines(path.read_bytes())
    axes = {match["axis"]: match for match in _AXIS.finditer(content)}
    x, z = axes[b"X"], axes[b"Z"]
    try:
        number = int(float(z["number"]))
        x_scale, z_scale = (
            float(axis["scale"]) * conversion(axis["unit"].decode().lower(), "m")[0]
            for axis in (x, z)
        )
        spacing = _SPACING.search(content)
        step = x["step"] or (spacing[1] if spacing else None)
        pitch = x_scale * float(step) if step else 0.0
        attrs: dict[str, str | float] = {"instrument": "SMD or PRF text"}
        if (tip := _TIP.search(content)) is not None:
            attrs["tip_radius_m"] = float(tip[1]) * conversion(tip[2].decode().lower(), "m")[0]
        heights = z_scale * _column(content[z.end() :], number)
    except (ValueError, OverflowError, UnicodeDecodeError, UnitError) as error:
        raise ReadError(
            f"{path}: its header is damaged: {brief(error)}; export it again"
        ) from error
    if heights.size < number or number < 2:
        raise ReadError(
            f"{path}: {heights.size} heights are in the file, but it says that they are "
            f"{number}; is it whole?"
        )
    if not pitch > 0:
        raise ReadError(f"{path}: the file does not say how far its points lie apart (CX)")
    place = pitch * np.arange(number)
    pitch, heights, evened = even(str(path), place, measurable(heights))
    return xr.Dataset({"height": ("x", heights)}, {"x": place}, {**attrs, **evened})


def _lines(content: bytes) -> bytes:
    return _BREAK.sub(b"\n", _END.sub(b"\n#\n", content))


def _column(content: bytes, number: int) -> np.ndarray:
    """Return the longest block of lines with one number each; a checksum may follow."""
    longest: list[float] = []
    current: list[float] = []
    for line in content.split(b"\n"):
        try:
            current.append(float(line))
        except ValueError:
            longest, current = max(longest, current, key=len), []
    longest = max(longest, current, key=len)
    return np.array(longest[:number])
