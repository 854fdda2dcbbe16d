"""Surface data of ISO 25178-72: x3p archives and the bare XML of softgauges.

SurfaceTopography (1.27) does not read all of them: it requires ``main.xml`` at the top of the
archive, an areal feature with even axes, one revision, and heights in a binary member.
"""

from __future__ import annotations

import contextlib
import posixpath
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, brief, shown
from tribolab.reading.raw.missing_marks import measurable
from tribolab.reading.raw.opening import isolated
from tribolab.reading.raw.unpacked import ZIP_DAMAGE
from tribolab.reading.raw.xml_safety import parsed
from tribolab.reading.scans.grid import even, gridded

_MAIN = "main.xml"
_ROOT = b"ISO5436_2"
_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}
_MAX_POINTS = 1 << 31  # most points of a map
_UNKNOWN = {"", "unknown", "not available", "n/a", "none"}
_FIELDS = {
    "recorded_at": "Record2/Date",
    "instrument_vendor": "Record2/Instrument/Manufacturer",
    "instrument_name": "Record2/Instrument/Model",
    "instrument_serial": "Record2/Instrument/Serial",
    "probing_system": "Record2/ProbingSystem/Type",
}


class _Axis(NamedTuple):
    """Axis with even steps or a stored position of each point, and the conversion to metres."""

    name: str
    even: bool
    type: str
    increment: float
    offset: float

    def metres(self, values: np.ndarray) -> np.ndarray:
        """Return stored numbers in m."""
        return values.astype(float) * self.increment + self.offset


def main_of(path: Path) -> str | None:
    """Return the name of the main XML member of an x3p archive; None for other files.

    It may be in a folder of the archive, e.g. if a folder was zipped by hand.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            names = [name for name in archive.namelist() if posixpath.basename(name) == _MAIN]
    except ZIP_DAMAGE:
        return None
    return min(names, key=len, default=None)


def is_iso_xml(head: bytes) -> bool:
    """Whether a file begins like the bare XML of a softgauge."""
    return head.lstrip(b"\xef\xbb\xbf \r\n\t").startswith(b"<") and _ROOT in head[:4096]


@isolated()
def read_x3p(path: Path, main: str) -> xr.Dataset:
    """Read an x3p archive: a map or a profile, with its mask of valid points.

    Parameters
    ----------
    path
        The file.
    main
        Name of the main XML member, from `main_of`.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (y, x) or (x), NaN for invalid points, with information on the instrument as
        attributes.

    Raises
    ------
    ReadError
        If the archive is damaged, or contains neither a profile nor a map.

    References
    ----------
    .. [1] ISO 25178-72:2017, XML file format x3p.
    """
    folder = posixpath.dirname(main)
    try:
        with zipfile.ZipFile(path) as archive:

            def member(name: str) -> bytes:
                inside = posixpath.normpath(posixpath.join(folder, name.replace("\\", "/")))
                return archive.read(inside)

            return _dataset(path, archive.read(main), member)
    except (KeyError, *ZIP_DAMAGE) as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(
            f"{path}: the x3p archive is damaged: {brief(error)}; copy or export it again"
        ) from error


def read_iso_xml(path: Path) -> xr.Dataset:
    """Read a profile or map from bare XML that lists its heights.

    Raises
    ------
    ReadError
        As for `read_x3p`.
    """

    def member(name: str) -> bytes:
        raise ReadError(
            f"{path}: the heights are said to lie in '{shown(name)}', but this is the description "
            "alone; take the whole x3p archive"
        )

    return _dataset(path, path.read_bytes(), member)


def _dataset(path: Path, text: bytes, member: Callable[[str], bytes]) -> xr.Dataset:
    root = parsed(path, text)
    axes = {name: _axis(path, root, name) for name in ("CX", "CY", "CZ")}
    shape = _shape(path, root)
    columns = _columns(path, root, axes, shape, member)
    nx, ny = shape
    heights = measurable(np.where(np.isfinite(columns["CZ"]), columns["CZ"], np.nan))
    attrs = _attributes(root)
    x = columns.get("CX")
    if ny == 1:
        place = axes["CX"].increment * np.arange(nx) if x is None else x
        pitch, heights, evened = even(str(path), place, heights)
        result = xr.Dataset({"height": ("x", heights)}, {"x": pitch * np.arange(heights.size)})
        return result.assign_attrs({**attrs, **evened})
    if x is not None or "CY" in columns:
        rows, points = np.divmod(np.arange(nx * ny), nx)
        x = axes["CX"].increment * points if x is None else x
        y = columns.get("CY", axes["CY"].increment * rows)
        return gridded(str(path), x, y, heights).assign_attrs(attrs)
    steps = [_step(path, axes[name]) for name in ("CY", "CX")]
    return xr.Dataset(
        {"height": (("y", "x"), heights.reshape(ny, nx))},
        {"y": steps[0] * np.arange(ny), "x": steps[1] * np.arange(nx)},
        attrs,
    )


def _text(root: ElementTree.Element, place: str) -> str:
    return (root.findtext(place) or "").strip()


def _number(path: Path, root: ElementTree.Element, place: str, default: float) -> float:
    text = _text(root, place)
    if not text:
        return default
    try:
        value = float(text)
    except ValueError as error:
        raise ReadError(f"{path}: {place} in its XML is '{shown(text)}', no number") from error
    if not np.isfinite(value):
        raise ReadError(f"{path}: {place} in its XML is {value}")
    return value


def _axis(path: Path, root: ElementTree.Element, name: str) -> _Axis:
    place = f"Record1/Axes/{name}"
    kind = _text(root, f"{place}/DataType") or "D"
    if kind not in _TYPES:
        raise ReadError(f"{path}: the heights are said to be of type '{shown(kind)}'; I, L, F or D")
    return _Axis(
        name,
        name != "CZ" and _text(root, f"{place}/AxisType") != "A",
        _TYPES[kind],
        _number(path, root, f"{place}/Increment", 1.0),
        _number(path, root, f"{place}/Offset", 0.0),
    )


def _step(path: Path, axis: _Axis) -> float:
    if not axis.increment > 0:
        raise ReadError(
            f"{path}: the points along {axis.name[1].lower()} are {axis.increment:g} m apart, as "
            "the file says; that is no map"
        )
    return axis.increment


def _shape(path: Path, root: ElementTree.Element) -> tuple[int, int]:
    """Return the numbers of points along x and y; all points of a profile are along x."""
    if root.find("Record3/MatrixDimension") is not None:
        sizes = [
            int(_number(path, root, f"Record3/MatrixDimension/Size{axis}", 1)) for axis in "XYZ"
        ]
    elif _text(root, "Record1/FeatureType") == "PCL":
        raise ReadError(f"{path}: a cloud of points without a grid is neither profile nor map")
    else:
        sizes = [int(_number(path, root, "Record3/ListDimension", 0)), 1, 1]
    nx, ny, layers = sizes
    if nx < 1 or ny < 1 or nx * ny > _MAX_POINTS:
        raise ReadError(f"{path}: {nx} x {ny} points, as the file says, are no profile and no map")
    if layers != 1:
        raise ReadError(f"{path}: {layers} layers of heights are in the file, one is wanted")
    return (ny, nx) if nx == 1 else (nx, ny)


def _columns(
    path: Path,
    root: ElementTree.Element,
    axes: Mapping[str, _Axis],
    shape: tuple[int, int],
    member: Callable[[str], bytes],
) -> dict[str, np.ndarray]:
    """Return heights and uneven positions [m], one number per point, with x running fastest."""
    number = shape[0] * shape[1]
    given = [axis for axis in axes.values() if not axis.even]
    if shape[1] == 1:  # the y of a profile is ignored
        given = [axis for axis in given if axis.name != "CY"]
    link = _text(root, "Record3/DataLink/PointDataLink")
    listed = root.find("Record3/DataList")
    if link:
        kind = np.dtype([(axis.name, axis.type) for axis in given])
        raw = member(link)
        if len(raw) < number * kind.itemsize:
            raise ReadError(
                f"{path}: the file holds {len(raw) // kind.itemsize} points, but says that they "
                f"are {number}; is it whole?"
            )
        record = np.frombuffer(raw, kind, number)
        columns = {axis.name: axis.metres(record[axis.name]) for axis in given}
    elif listed is not None:
        columns = _listed(path, listed, given, number)
    else:
        raise ReadError(f"{path}: the file contains no heights, neither as a list nor as a member")
    valid = _text(root, "Record3/DataLink/ValidPointsLink")
    if valid:
        with contextlib.suppress(KeyError):  # the mask is missing: every point is valid
            columns["CZ"][~_valid(member(valid), number)] = np.nan
    return columns


def _listed(
    path: Path, listed: ElementTree.Element, given: list[_Axis], number: int
) -> dict[str, np.ndarray]:
    """Return heights and uneven positions from a list; NaN for invalid points."""
    cells = [(datum.text or "").replace(",", ";").split(";") for datum in listed.iter("Datum")]
    if len(cells) != number:
        raise ReadError(
            f"{path}: the list holds {len(cells)} points, but is said to hold {number}; is the "
            "file whole?"
        )
    columns = {axis.name: np.full(number, np.nan) for axis in given}
    for place, axis in enumerate(reversed(given), start=1):  # the height is the last cell
        try:
            values = [
                float(row[-place]) if len(row) >= place and row[-place].strip() else np.nan
                for row in cells
            ]
        except ValueError as error:
            raise ReadError(f"{path}: a point of the list is no number: {brief(error)}") from error
        columns[axis.name] = axis.metres(np.array(values))
    return columns


def _valid(mask: bytes, number: int) -> np.ndarray:
    """Return the mask of valid points, stored as bits (lowest first) or, by some makers, bytes."""
    values = np.frombuffer(mask, np.uint8)
    if values.size >= number > 8:
        return values[:number] != 0
    bits = np.unpackbits(values, bitorder="little")
    if bits.size < number:
        return np.ones(number, dtype=bool)
    return bits[:number].astype(bool)


def _attributes(root: ElementTree.Element) -> dict[str, str]:
    attrs = {"instrument": "x3p"}
    for name, place in _FIELDS.items():
        if (text := _text(root, place)).lower() not in _UNKNOWN:
            attrs[name] = shown(text, 100)
    return attrs
