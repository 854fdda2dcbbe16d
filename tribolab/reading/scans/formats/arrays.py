"""Profiles and maps in named arrays, e.g. `z` (y, x) with arrays `x` and `y` or with a pitch."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, shown
from tribolab.reading.lexicon.lexicon import keys_of, normalise_label, plain_words, words_of
from tribolab.reading.raw.missing_marks import measurable, take_marks
from tribolab.reading.scans.formats.named_arrays import NamedArray, read_arrays
from tribolab.reading.scans.formats.named_units import unit_remedy
from tribolab.reading.scans.formats.profilometers import MissingUnitError
from tribolab.reading.scans.grid import even
from tribolab.reading.scans.header import map_header
from tribolab.reading.text.cells import split_name
from tribolab.units.conversion import conversion
from tribolab.units.spellings import unit_of_length

_MIN_POINTS = 8  # fewest heights of a profile, or along one side of a map
_HEIGHTS = plain_words("height_array")
_UNITS = frozenset(keys_of("unit"))
_OF_RUNS = frozenset(
    "time t force forces load fx fy fz fn ft friction cof mu velocity speed torque".split()
)
_CF = ("scale_factor", "add_offset", "_FillValue", "missing_value")
_CHANGES_HEIGHTS = re.compile(
    r"scale|scaling|gain|factor|multipl|increment|lsb|slope|calibration|offset|intercept|valid|mask"
    r"|quality|bad|missing|no_?data|void|lost|undefined|fill",
    re.IGNORECASE,
)
_ALONG = {"x": frozenset(("x", "pos", "position", "positions", "distance")), "y": frozenset("y")}


def read_scan_arrays(
    path: Path, x_unit: str | None = None, height_unit: str | None = None
) -> xr.Dataset | None:
    """Read a profile, several profiles, or a map from the named arrays in a file.

    Parameters
    ----------
    path
        The file.
    x_unit, height_unit
        Units of positions and heights, for files that state none.

    Returns
    -------
    xarray.Dataset or None
        ``height`` [m] (x), (scan, x) of several profiles, or (y, x); None if no array is named like
        heights, or other arrays are named like the signals of a run.

    Raises
    ------
    MissingUnitError
        If the pitch or the unit of heights is not stated.
    ReadError
        If several arrays may be the heights, or their sizes match no positions.
    """
    stored = read_arrays(path)
    heights = _heights(path, stored)
    if heights is None:
        return None
    own = [NamedArray(k, np.asarray(v), {}) for k, v in heights.attrs.items() if _is_number(v)]
    stored += own
    _refuse_unknown_changes(path, heights, stored)
    x, y = (_positions(stored, axis) for axis in "xy")
    values = _oriented(path, heights, x, y)
    z, missing = _decoded(heights, values)
    along = _places(x, values.shape[-1], "x", values.shape, stored, x_unit)
    down = None if values.ndim == 1 else _places(y, len(values), "y", values.shape, stored, x_unit)
    if x is not None and y is None and values.ndim == 2 and len(values) < values.shape[1]:
        down = None  # separate profiles have no positions along y
    unit = _unit_of(heights) or height_unit
    lacking = [f"the unit of the heights ('{shown(heights.name)}')"] if unit is None else []
    if along is None or (down is None and values.ndim == 2 and x is None):
        of_positions = f"the unit of the positions ('{shown(x.name)}')" if x is not None else ""
        lacking.append(of_positions or "how far the points lie apart along x and y")
    if lacking or along is None or unit is None:
        raise MissingUnitError(
            f"{' and '.join(lacking)} {'is' if len(lacking) == 1 else 'are'} not said",
            where=path,
            cure=unit_remedy(path, along=along is None, up=unit is None),
        )
    z = measurable(conversion(unit, "m")[0] * z)
    x_even, z, attrs = _on_even_grid(path, along, z)
    attrs |= {"instrument": "arrays by name"}
    attrs |= {"taken_for_missing": "; ".join(missing)} if missing else {}
    if z.ndim == 1 or down is None:
        dims = ("x",) if z.ndim == 1 else ("scan", "x")
        return xr.Dataset({"height": (dims, z)}, {"x": x_even}, attrs)
    y_even, turned, _ = _on_even_grid(path, down, z.T)
    return xr.Dataset({"height": (("y", "x"), turned.T)}, {"y": y_even, "x": x_even}, attrs)


def is_map_file(path: Path) -> bool:
    """Whether a file contains a two-dimensional array that is named like heights.

    Raises
    ------
    ReadError
        If the file is damaged, or several arrays may be the heights.
    """
    heights = _heights(path, read_arrays(path))
    return heights is not None and heights.values.ndim == 2


def _words(name: str) -> frozenset[str]:
    """Return the normalised words in an array's name, without its groups.

    >>> sorted(_words("scan/heightMap"))
    ['height', 'heightmap', 'map']
    """
    leaf = re.split(r"[./]", name)[-1]
    return frozenset(normalise_label(word) for word in [*words_of(leaf), leaf])


def _heights(path: Path, stored: list[NamedArray]) -> NamedArray | None:
    """Return the array that is named like heights; a profile only if the file has its positions."""
    large = [a for a in stored if a.values.ndim in (1, 2) and a.values.size >= _MIN_POINTS]
    if any(_words(a.name) & _OF_RUNS for a in large if a.values.ndim == 1):
        return None
    named = [a for a in large if _words(a.name) & _HEIGHTS]
    maps = [a for a in named if a.values.ndim == 2 and max(a.values.shape) >= _MIN_POINTS]
    named = maps or [a for a in named if _positions(stored, "x") is not None]
    if len(named) > 1:
        names = ", ".join(f"'{shown(a.name)}'" for a in named[:5])
        what = f"{len(named)} arrays may be the heights: {names}; save one alone"
        raise ReadError(what, where=path)
    return named[0] if named else None


def _refuse_unknown_changes(path: Path, heights: NamedArray, stored: list[NamedArray]) -> None:
    """Raise if the file has a factor, offset or mask that may apply to heights, except CF's."""
    for array in stored:
        name = re.split(r"[./]", array.name)[-1]
        applies = array.values.ndim == 0 or array.values.shape == heights.values.shape
        if applies and name not in _CF and _CHANGES_HEIGHTS.search(name):
            what = f"'{shown(array.name)}' may change or exclude heights in a way not known here"
            raise ReadError(what, where=path, cure="apply it, and save the heights alone")


def _positions(arrays: list[NamedArray], axis: str) -> NamedArray | None:
    """Return the array of positions along an axis."""
    lines = (a for a in arrays if a.values.ndim == 1 and a.values.size > 1)
    return next((a for a in lines if _words(a.name) & _ALONG[axis]), None)


def _oriented(
    path: Path, heights: NamedArray, x: NamedArray | None, y: NamedArray | None
) -> np.ndarray:
    """Return heights with x along the last dimension."""
    z = heights.values
    sizes = [None if a is None else a.values.size for a in ((y, x) if z.ndim == 2 else (x,))]
    for turned in (z, z.T):
        if all(size in (None, own) for size, own in zip(sizes, turned.shape, strict=True)):
            return turned
    raise ReadError(
        f"'{shown(heights.name)}' has {' x '.join(map(str, z.shape))} heights, but there are "
        f"{sizes[-1]} positions along x and {sizes[0]} along y",
        where=path,
    )


def _decoded(heights: NamedArray, values: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Return heights scaled by their CF attributes, with sentinels as NaN, and a list of these."""
    z, missing = values.astype(float), []
    for key in ("_FillValue", "missing_value"):
        number = heights.attrs.get(key)
        if _is_number(number) and (here := z == number).any():
            z[here] = np.nan
            missing.append(f"height: {number:.9g} {int(here.sum())} times, as '{key}' says")
    z = z * float(heights.attrs.get("scale_factor", 1)) + float(heights.attrs.get("add_offset", 0))
    return z, missing + [f"height: {mark.words}" for mark in take_marks([z.reshape(-1)])]


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _places(
    positions: NamedArray | None,
    number: int,
    axis: str,
    shape: tuple[int, ...],
    stored: list[NamedArray],
    x_unit: str | None,
) -> np.ndarray | None:
    """Return positions along an axis [m], from an array or a single pitch; None if unknown."""
    if positions is not None:
        unit = _unit_of(positions) or x_unit
        return None if unit is None else conversion(unit, "m")[0] * positions.values
    lines = [
        f"{_name_without_unit(a.name)} [{unit}]: {float(a.values):.12g}"
        for a in stored
        if a.values.ndim == 0 and (unit := _unit_of(a) or x_unit)
    ]
    header = map_header(lines, (shape[0] if len(shape) == 2 else 1, shape[-1]), ".")
    pitch = header.dx if axis == "x" else header.dy
    return None if pitch is None else pitch * np.arange(number)


def _unit_of(array: NamedArray) -> str | None:
    """Return the unit of length in an array's attributes or name; None without one."""
    stated = next((value for key, value in array.attrs.items() if key.lower() in _UNITS), None)
    name, bracket = split_name(array.name)
    parts = re.split(r"[\W_]+", name)
    units = (stated, bracket, parts[-1] if len(parts) > 1 else None)
    return next(
        (u for text in units if isinstance(text, str) and (u := unit_of_length(text))), None
    )


def _name_without_unit(name: str) -> str:
    """Return the words of an array's name without its groups and unit.

    >>> _name_without_unit("scan/pixel_size_um"), _name_without_unit("dx")
    ('pixel size', 'dx')
    """
    words = re.split(r"[_\s]+", re.split(r"[./]", split_name(name)[0])[-1])
    return " ".join(words[:-1] if len(words) > 1 and unit_of_length(words[-1]) else words)


def _on_even_grid(
    path: Path, positions: np.ndarray, z: np.ndarray
) -> tuple[np.ndarray, np.ndarray, dict[str, float | str]]:
    """Interpolate all rows of heights to one even grid."""
    rows = z.reshape(-1, z.shape[-1])
    made = [even(str(path), positions, row) for row in rows]
    pitch, _, attrs = made[0]
    heights = np.stack([row for _, row, _ in made]).reshape(z.shape)
    return pitch * np.arange(z.shape[-1]), heights, attrs
