"""Profiles and maps in named arrays: `z` (y, x) with `x` and `y` or a pitch."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, shown
from tribolab.core.untyped import Json
from tribolab.reading.lexicon.lexicon import plain_words
from tribolab.reading.raw.missing_marks import measurable, take_marks
from tribolab.reading.scans.formats.array_units import (
    UNITS,
    scaled,
    stated_unit,
    tokens,
    unit_of_scale,
)
from tribolab.reading.scans.formats.named_arrays import NamedArray, NamedArrays, read_arrays
from tribolab.reading.scans.formats.named_units import unit_remedy
from tribolab.reading.scans.formats.profilometers import MissingUnitError
from tribolab.reading.scans.grid import even
from tribolab.reading.scans.header import map_header
from tribolab.reading.text.cells import split_name
from tribolab.units.conversion import conversion
from tribolab.units.spellings import unit_of_length

_MIN_ROWS = 8  # least rows, and heights of each
_HEIGHTS = plain_words("height_array")
_PERHAPS = frozenset(
    "surface surf depth depths profile profiles profil profils relief trace traces data map".split()
)
_NO_HEIGHTS = frozenset(
    "intensity intensities i image images img rgb color colour mask valid invalid quality qc flag "
    "flags std sigma error err weight weights amplitude phase brightness laser reflectance "
    "contrast confidence snr count counts time t force forces load velocity speed temp".split()
)
_OF_RUNS = frozenset(
    "time t force forces load fx fy fz fn ft friction cof mu velocity speed torque".split()
)
_TABLES = {"columns", "column_names", "names", "labels", "channels"}  # keys of a matrix of signals
_VALID = frozenset("valid mask good quality".split())
_ALONG = {
    "x": frozenset("x xx xs xdata xaxis xpos".split()),
    "y": frozenset("y yy ys ydata".split()),
}
_PLACES = frozenset("pos position positions distance lateral abscissa weg".split())


def read_scan_arrays(
    path: Path, x_unit: str | None = None, height_unit: str | None = None
) -> xr.Dataset | None:
    """Read a profile, profiles side by side, or a map.

    Parameters
    ----------
    path
        The file.
    x_unit, height_unit
        Units of positions and heights, for files that state none.

    Returns
    -------
    xarray.Dataset or None
        ``height`` [m] (x), (scan, x) of several profiles, or (y, x); None if no array has a name of
        heights, or the other arrays are those of a run.

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
    z = np.asarray(heights.values, dtype=float)
    attrs: dict[str, str | float] = {"instrument": "arrays by name"}
    along = {name: _positions(stored.arrays, name, heights) for name in "xy"}
    z, along = _orient(path, heights.name, z, along)
    unit = _unit_of(heights, "z", stored) or height_unit
    z, unit, lost = scaled(heights, z, unit, stored.arrays)
    lost += _without_invalid(stored.arrays, heights, z)
    lost += [f"height: {mark.words}" for mark in take_marks([z.reshape(-1)])]
    if lost:
        attrs["taken_for_missing"] = "; ".join(lost)
    steps = _steps(heights, stored, z.shape, along, x_unit)
    lacking = [f"the unit of the heights ('{shown(heights.name)}')"] if unit is None else []
    is_map = z.ndim == 2 and (along["y"] is not None or steps["y"] is not None)
    if z.ndim == 2 and not is_map and along["x"] is None:
        lacking.append("how far the points lie apart along x and y")
    elif steps["x"] is None:
        place = along["x"]
        of = (
            f"the unit of the positions ('{shown(place.name)}')"
            if place
            else "how far its points lie apart"
        )
        lacking.append(of)
    if lacking or unit is None:
        raise MissingUnitError(
            f"{' and '.join(lacking)} {'is' if len(lacking) == 1 else 'are'} not said",
            where=path,
            cure=unit_remedy(path, along=steps["x"] is None, up=unit is None),
        )
    z = measurable(conversion(unit, "m")[0] * z)
    x, z, evened = _on_even_grid(path, steps["x"], z)
    attrs |= evened
    if z.ndim == 1:
        return xr.Dataset({"height": ("x", z)}, {"x": x}, attrs)
    if not is_map:
        return xr.Dataset({"height": (("scan", "x"), z)}, {"x": x}, attrs)
    assert steps["y"] is not None
    y, turned, _ = _on_even_grid(path, steps["y"], z.T)
    return xr.Dataset({"height": (("y", "x"), turned.T)}, {"y": y, "x": x}, attrs)


def is_map_file(path: Path) -> bool:
    """Whether a file certainly contains a matrix of heights, by its name or unit.

    Raises
    ------
    ReadError
        If it is damaged, or several arrays may be the heights.
    """
    stored = read_arrays(path)
    heights = _heights(path, stored)
    if heights is None or heights.values.ndim != 2:
        return False
    sure = bool(tokens(heights.name) & _HEIGHTS) or _own_unit(heights) is not None
    return sure or any(_positions(stored.arrays, axis, heights) is not None for axis in "xy")


def _heights(path: Path, stored: NamedArrays) -> NamedArray | None:
    """Return the only array with a name of heights, or the only matrix with a unit of length."""
    large = [a for a in stored.arrays if a.values.ndim in (1, 2) and a.values.size >= _MIN_ROWS]
    if any(tokens(a.name) & _OF_RUNS for a in large if a.values.ndim == 1):
        return None
    matrices = [a for a in large if a.values.ndim == 2 and max(a.values.shape) >= _MIN_ROWS]
    matrices = [a for a in matrices if min(a.values.shape) > 1 and not a.attrs.keys() & _TABLES]
    for words in (_HEIGHTS, _PERHAPS):
        for some in (matrices, [a for a in large if a.values.ndim == 1]):
            named = [a for a in some if tokens(a.name) & words and not tokens(a.name) & _NO_HEIGHTS]
            if len(named) > 1:
                names = ", ".join(f"'{shown(a.name)}'" for a in named[:5])
                raise ReadError(
                    f"{len(named)} arrays may be the heights: {names}; save one alone", where=path
                )
            if named and (some is matrices or _positions(stored.arrays, "x", named[0]) is not None):
                return named[0]
    axes = [*_ALONG["x"], *_ALONG["y"]]
    left = [a for a in matrices if not tokens(a.name) & {*_NO_HEIGHTS, *axes}]
    known = [a for a in left if _own_unit(a) is not None]
    return known[0] if len(known) == 1 else None


def _positions(arrays: Sequence[NamedArray], axis: str, heights: NamedArray) -> NamedArray | None:
    """Return the array of positions along an axis; of a mesh one line."""
    for words in (_ALONG[axis], _PLACES if axis == "x" else frozenset()):
        for array in arrays:
            values = np.asarray(array.values)
            if array is heights or values.size < 2 or not tokens(array.name) & words:
                continue
            if values.ndim == 2 and values.shape == heights.values.shape:
                first, other = (values[0], values[:, 0])
                values = first if np.ptp(first) > np.ptp(other) else other
            if values.ndim == 1 and values.size in heights.values.shape:
                return array._replace(values=values.astype(float))
    return None


def _orient(
    path: Path, name: str, z: np.ndarray, along: dict[str, NamedArray | None]
) -> tuple[np.ndarray, dict[str, NamedArray | None]]:
    """Return heights with x along the last dimension, and the positions by axis."""
    if z.ndim == 1:
        return z, {**along, "y": None}
    x, y = along["x"], along["y"]
    if y is None and x is not None and min(z.shape) == z.shape[0] == z.shape[1]:
        return z, along
    sizes = tuple(None if a is None else a.values.size for a in (y, x))
    for turned in (z, z.T):
        if all(size in (None, own) for size, own in zip(sizes, turned.shape, strict=True)):
            return turned, along
    raise ReadError(
        f"'{shown(name)}' has {z.shape[0]} x {z.shape[1]} heights, but there are {sizes[1]} "
        f"positions along x and {sizes[0]} along y",
        where=path,
    )


def _steps(
    heights: NamedArray,
    stored: NamedArrays,
    shape: tuple[int, ...],
    along: dict[str, NamedArray | None],
    x_unit: str | None,
) -> dict[str, np.ndarray | None]:
    """Return positions along x and y [m], from arrays or from a stated pitch; None if unknown."""
    rows, columns = shape if len(shape) == 2 else (1, shape[0])
    own = [
        NamedArray(key, np.asarray(value).reshape(-1)[0], _unit_attribute(heights.attrs, key))
        for key, value in heights.attrs.items()
        if isinstance(value, int | float | np.number) or _is_one_number(value)
    ]
    lines = [
        f"{_words_without_unit(array.name)} [{unit}]: {float(array.values):.12g}"
        for array in (*stored.arrays, *own)
        if array.values.ndim == 0 and (unit := _unit_of(array, "x", stored) or x_unit)
    ]
    lines += [f"{key.replace('_', ' ')}: {text}" for key, text in stored.texts.items()]
    header = map_header(lines, (rows, columns), ".")
    steps: dict[str, np.ndarray | None] = {}
    for axis, number, pitch in (("x", columns, header.dx), ("y", rows, header.dy)):
        array = along[axis]
        steps[axis] = None if pitch is None else pitch * np.arange(number)
        if array is not None:
            unit = _unit_of(array, axis, stored) or x_unit
            steps[axis] = None if unit is None else conversion(unit, "m")[0] * array.values
    if len(shape) == 2 and along["x"] is not None and along["y"] is None and rows < columns:
        steps["y"] = None  # side-by-side profiles
    return steps


def _unit_of(array: NamedArray, axis: str, stored: NamedArrays) -> str | None:
    return _own_unit(array) or stated_unit(stored.texts, axis)


def _own_unit(array: NamedArray) -> str | None:
    """Return the unit of length in an array's attributes or name; None without one."""
    own_unit = next((value for key, value in array.attrs.items() if key.lower() in UNITS), None)
    name, bracket = split_name(array.name)
    last = re.split(r"[\W_]+", name)[-1]
    for unit in (own_unit, bracket, last if len(re.split(r"[\W_]+", name)) > 1 else None):
        if isinstance(unit, str) and (length := unit_of_length(unit)):
            return length
    return unit_of_scale(array.attrs)


def _is_one_number(value: object) -> bool:
    """Whether an attribute is one number for both axes: ``pixel_size = [0.9, 0.9]``."""
    if not isinstance(value, np.ndarray | list | tuple):
        return False
    both = np.asarray(value)
    return bool(both.size and both.dtype.kind in "iuf" and (both == both.flat[0]).all())


def _unit_attribute(attrs: Json, key: str) -> Json:
    """Return the unit of an attribute from another attribute, e.g. ``pixel_size_unit``.

    It may apply to both axes.

    >>> _unit_attribute({"pixel_size_unit": "um"}, "pixel_size_x")
    {'unit': 'um'}
    """
    both = re.sub(r"^[xy]_|_[xy]$", "", key)
    names = [name for base in (key, both) for u in UNITS for name in (f"{base}_{u}", f"{u}_{base}")]
    texts = (attrs.get(name) for name in names)
    return next(({"unit": text} for text in texts if isinstance(text, str)), {})


def _words_without_unit(name: str) -> str:
    """Return a name in words without its unit: 'pixel_size_um' becomes 'pixel size'.

    >>> _words_without_unit("scan/pixel_size_um"), _words_without_unit("dx")
    ('pixel size', 'dx')
    """
    words = re.split(r"[_\s]+", re.split(r"[./]", split_name(name)[0])[-1])
    return " ".join(words[:-1] if len(words) > 1 and unit_of_length(words[-1]) else words)


def _without_invalid(arrays: Iterable[NamedArray], heights: NamedArray, z: np.ndarray) -> list[str]:
    """Replace heights marked as invalid by a mask array by NaN, and note their number."""
    removed = []
    for array in arrays:
        values = np.asarray(array.values)
        words = tokens(array.name)
        if values.shape != heights.values.shape or not words & {*_VALID, "invalid", "bad"}:
            continue
        if not np.isin(values, (0, 1)).all() or array.values.dtype.kind not in "biu":
            continue
        good = values.astype(bool)
        if words & {"invalid", "bad"} or ("mask" in words and good.mean() < 0.5):
            good = ~good
        good = good if good.shape == z.shape else good.T
        lost = int((~good & np.isfinite(z)).sum())
        z[~good] = np.nan
        if lost:
            removed.append(f"height: {lost} by '{shown(array.name)}'")
    return removed


def _on_even_grid(
    path: Path, positions: np.ndarray | None, z: np.ndarray
) -> tuple[np.ndarray, np.ndarray, dict[str, float | str]]:
    """Interpolate all rows of heights to one even grid."""
    assert positions is not None
    rows = z.reshape(-1, z.shape[-1])
    made = [even(str(path), positions, row) for row in rows]
    pitch, _, attrs = made[0]
    return (
        pitch * np.arange(z.shape[-1]),
        np.stack([row for _, row, _ in made]).reshape(z.shape),
        attrs,
    )
