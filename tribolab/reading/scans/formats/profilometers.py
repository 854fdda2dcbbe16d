"""Profilometers' own formats, read by the SurfaceTopography package."""

from __future__ import annotations

import contextlib
import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, TribolabError, brief
from tribolab.core.untyped import Arguments, Json
from tribolab.reading import cures
from tribolab.reading.raw.missing_marks import measurable, take_marks
from tribolab.reading.raw.opening import isolated
from tribolab.reading.scans.formats.profilometer_safety import formats_to_try
from tribolab.reading.scans.grid import even
from tribolab.reading.text.first_bytes import peek
from tribolab.units.conversion import conversion, to_si

# errors that say nothing about the file
_OF_PROGRAM = (LookupError, TypeError, AttributeError, AssertionError)


class MissingUnitError(ReadError):
    """Raised if a scan lacks only a unit or a size, which the user can state."""


@isolated("xarray", "SurfaceTopography", "SurfaceTopography.IO")
def read_foreign(
    path: Path, x_unit: str | None = None, height_unit: str | None = None
) -> xr.Dataset:
    """Read a scan with SurfaceTopography: Mitutoyo xlsx, SDF, X3P, SUR, GWY, AL3D and others.

    Parameters
    ----------
    path
        The file.
    x_unit, height_unit
        Units of positions and heights, for files that state none.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (x) or (y, x), with information on the instrument as attributes.

    Raises
    ------
    ReadError
        If SurfaceTopography is missing, or format or unit is unknown.
    """
    try:
        # imported late: SurfaceTopography loads slowly
        from SurfaceTopography.IO import open_topography, readers
        from SurfaceTopography.IO.Reader import MagicMatch
    except ImportError as error:
        raise ReadError(
            "no dialect fits, and other formats need the package SurfaceTopography: "
            "pip install 'tribolab[formats]'",
            where=path,
        ) from error
    with path.open("rb") as file:
        head = file.read(512)
    match = {reader.format(): reader.can_read(head) for reader in readers}
    sure = [name for name, how in match.items() if how == MagicMatch.YES]
    possible = [name for name, how in match.items() if how != MagicMatch.NO]
    formats = formats_to_try(path, sure, possible)
    with _read_errors(path), warnings.catch_warnings():
        # ignore warnings on pictures in a workbook, and on overflows: infinite heights count as
        # missing
        warnings.simplefilter("ignore")
        with _opened(path, formats, open_topography) as reader:
            channel, topography, vertical = _topography(path, reader, x_unit, height_unit)
            masked: np.ma.MaskedArray = np.ma.asarray(topography.heights(), dtype=float)
            heights = masked.filled(np.nan)
            x = topography.positions() if topography.dim == 1 else ()
            sizes, points = topography.physical_sizes, topography.nb_grid_pts
    try:
        lateral = conversion(topography.unit, "m")[0]
        attrs = _instrument(channel.info or {})
    except (TribolabError, KeyError, TypeError, ValueError) as error:
        raise ReadError(
            f"{path}: what the file says of units and instrument cannot be understood: {error}; "
            "export the profile as text (csv)"
        ) from error
    attrs["instrument"] = f"{_name(reader)} (SurfaceTopography)"
    vertical = lateral if vertical is None else vertical
    with np.errstate(over="ignore", invalid="ignore"):
        heights = heights * vertical
    heights[~np.isfinite(heights)] = np.nan
    # formats without a mark for missing points contain sentinels
    if marks := take_marks([heights.reshape(-1)], vertical):
        attrs["taken_for_missing"] = "; ".join(f"height: {mark.words}" for mark in marks)
    heights = measurable(heights)
    if sizes is None or len(sizes) != len(points):
        raise ReadError(f"{path}: the file does not say how large the scan is in each direction")
    if len(points) == 2:
        # SurfaceTopography's first index is x
        steps = [float(s) * lateral / n for s, n in zip(sizes, points, strict=True)]
        if 1 in points and max(points) > 1:  # a profile stored as a map
            pitch, heights = steps[int(points[0] == 1)], heights.ravel()
            return xr.Dataset(
                {"height": ("x", heights)}, {"x": pitch * np.arange(heights.size)}, attrs
            )
        return xr.Dataset(
            {"height": (("y", "x"), heights.T)},
            {"y": steps[1] * np.arange(points[1]), "x": steps[0] * np.arange(points[0])},
            attrs,
        )
    pitch, heights, evened = even(str(path), np.asarray(x, dtype=float) * lateral, heights)
    return xr.Dataset(
        {"height": ("x", heights)}, {"x": pitch * np.arange(heights.size)}, {**attrs, **evened}
    )


@contextlib.contextmanager
def _read_errors(path: Path) -> Iterator[None]:
    """Convert any exception of SurfaceTopography's readers to ReadError."""
    try:
        yield
    except TribolabError:
        raise
    except Exception as error:
        raise ReadError(
            f"{path}: SurfaceTopography cannot read the file: {type(error).__name__}: "
            f"{brief(error)}"
        ) from error


@contextlib.contextmanager
def _opened(path: Path, formats: list[str], open_topography: Any) -> Iterator[Any]:
    """Open a file as the first of several formats that can read it."""
    reader = None
    for name in formats:
        try:
            reader = open_topography(str(path), format=name)
            break
        except Exception as error:  # unsuitable formats raise different errors
            refused = error
    if reader is None:
        reason = "" if isinstance(refused, _OF_PROGRAM) else f": {brief(refused)}"
        tried = f" ({formats[0]}{reason})" if len(formats) == 1 else ""
        if not _is_text(path):
            raise ReadError(
                f"{path}: neither text nor a format that SurfaceTopography reads{tried}; "
                "export the profile as text (csv)"
            )
        raise ReadError(
            f"its format is not known to tribolab or SurfaceTopography{tried}",
            where=path,
            cure=cures.unknown_instrument(path, cures.SURFACE),
        )
    with reader:
        yield reader


def _topography(
    path: Path, reader: Any, x_unit: str | None, height_unit: str | None
) -> tuple[Any, Any, float | None]:
    """Return channel and topography, and the unit of heights in m if the channel states none."""
    channel = reader.default_channel
    given: Arguments = {}
    if channel.physical_sizes is None:
        if x_unit is None:
            raise MissingUnitError(
                f"the file does not say how large the scan is ({_name(reader)})",
                where=path,
                cure=cures.SIZE,
            )
        given["physical_sizes"] = tuple(float(n) for n in np.atleast_1d(channel.nb_grid_pts))
    if channel.unit is None:
        if x_unit is None or height_unit is None:
            raise MissingUnitError(
                f"the file states no units ({_name(reader)})", where=path, cure=cures.MEND_UNITS
            )
        given["unit"] = x_unit
    vertical = conversion(height_unit, "m")[0] if channel.unit is None else None
    return channel, channel.topography(**given), vertical


def _is_text(path: Path) -> bool:
    try:
        return peek(path).format == "text"
    except ReadError:
        return False


def _name(reader: Any) -> str:
    return str(reader.format())


def _instrument(info: Json) -> dict[str, str | float]:
    """Return attributes from SurfaceTopography's information on the file."""
    attrs: dict[str, str | float] = {}
    if "acquisition_time" in info:
        attrs["recorded_at"] = str(info["acquisition_time"])
    instrument = info.get("instrument", {})
    for key in ("vendor", "name", "serial"):
        if key in instrument:
            attrs[f"instrument_{key}"] = str(instrument[key])
    tip = instrument.get("parameters", {}).get("tip_radius")
    if tip:
        attrs["tip_radius_m"] = to_si(f"{tip['value']} {tip['unit']}", "m", "tip radius")
    raw = info.get("raw_metadata", {})
    if "cut_off" in raw:
        cut = raw["cut_off"]
        attrs["lambda_c_m"] = to_si(f"{cut['value']} {cut['unit']}", "m", "cut-off")
    for metric in raw.get("roughness_metrics", []):
        attrs.update(result(str(metric["key"]), float(metric["value"]), str(metric["unit"])))
    return attrs


def result(name: str, value: float, unit: str) -> dict[str, float]:
    """Return an instrument's own result as an attribute in SI, with the unit in its name.

    >>> result("Rq", 3.959, "µm")
    {'instrument_Rq_m': 3.959e-06}
    """
    key = "instrument_" + re.sub(r"[^A-Za-z0-9]+", "_", name.replace("µ", "u")).strip("_")
    if unit == "%":
        return {f"{key}_percent": value}
    if unit in ("", "1", "-"):
        return {key: value}
    si_unit, ending = ("1/m", "_1_m") if unit.startswith("/") else ("m", "_m")
    scale = conversion(f"1{unit}" if unit.startswith("/") else unit, si_unit)[0]
    return {key + ending: float(f"{value * scale:.15g}")}
