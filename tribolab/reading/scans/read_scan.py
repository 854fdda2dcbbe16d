"""Reading of scans: profiles and maps of heights, by dialect or from profilometer formats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.aliases import PathLike
from tribolab.core.errors import Cure, ReadError, shown
from tribolab.core.provenance import as_text, made, sha256_of_file
from tribolab.core.untyped import Json
from tribolab.core.wording import Count
from tribolab.reading import cures
from tribolab.reading.dialect.containers import PythonReader, with_columns
from tribolab.reading.dialect.find import (
    Dialect,
    Instrument,
    every_dialect,
    is_scan,
    load_dialect,
)
from tribolab.reading.file_patterns import is_pattern, matching
from tribolab.reading.raw.opening import RefusedError
from tribolab.reading.raw.source import check_regular
from tribolab.reading.scans.extent import measured_part, refuse_impossible
from tribolab.reading.scans.formats.undescribed import read_undescribed
from tribolab.reading.scans.grid import even, gridded, rounder_pitch
from tribolab.reading.scans.sentinels import take_isolated
from tribolab.reading.si_tables.read_file import read_content
from tribolab.reading.text.first_bytes import File, peek, results_error
from tribolab.units.conversion import positive
from tribolab.units.stamping import stamp

# if scans of a surface differ, the narrowest bandwidth applies to all
_WORST = {"tip_radius_m": max, "lambda_s_m": max, "lambda_c_m": min}
_JOINED = ("source", "source_sha256")
_ONE_BY_ONE = Cure(notebook="read them with stack=False")


def read_known_scans(
    files: Sequence[Path],
    instrument: Instrument | None = None,
    *,
    x_unit: str | None = None,
    height_unit: str | None = None,
) -> list[xr.Dataset]:
    """Read scans of known instruments and profilometer formats.

    Parameters
    ----------
    files
        The files.
    instrument, x_unit, height_unit
        As for `tribolab.reading.scan_files.read_scans`.

    Returns
    -------
    list of xarray.Dataset
        One for each file, or for each trace in it: ``height`` [m] (x) or (y, x).

    Raises
    ------
    ReadError
        If the file does not exist, cannot be interpreted, or contains only results.
    """
    dialect = load_dialect(instrument) if instrument is not None else None
    if isinstance(dialect, PythonReader) and files:
        dialect = with_columns(dialect, Path(files[0]))
    if dialect is not None and not is_scan(dialect):
        scanning = ", ".join(d.name for d in every_dialect() if is_scan(d))
        raise ReadError(
            f"instrument '{dialect.name}' writes no profiles (no column is 'x' and 'height', and "
            f"there is no pitch); those that do are {scanning}"
        )
    return [scan for file in files for scan in _read(file, dialect, x_unit, height_unit)]


def files_of(paths: PathLike | Sequence[PathLike]) -> list[Path]:
    """Return the files for a name, a pattern, or a list of either.

    Raises
    ------
    ReadError
        If no file is given, or no file matches.
    """
    given = [paths] if isinstance(paths, str | Path) else list(paths)
    if not given:
        raise ReadError("no file is given", function="read_scans")
    files: list[Path] = []
    for path in given:
        files.extend(matching(path) if is_pattern(path) else [Path(path)])
    return files


def _read(
    path: Path, dialect: Dialect | None, x_unit: str | None, height_unit: str | None
) -> list[xr.Dataset]:
    check_regular(path)
    if dialect is None:
        dialect = _recognised(path)
    if dialect is not None:
        scans, sha256 = _read_by_dialect(path, dialect)
    else:
        scans = _split_profiles(read_undescribed(path, x_unit, height_unit))
        sha256 = sha256_of_file(path)
    return [_checked_scan(path, scan, sha256) for scan in scans]


def _split_profiles(scan: xr.Dataset) -> list[xr.Dataset]:
    """Return the profiles of a file as separate scans."""
    if "scan" not in scan.dims:
        return [scan]
    number = scan.sizes["scan"]
    return [scan.isel(scan=k).assign_attrs(traces=str(number)) for k in range(number)]


def _checked_scan(path: Path, scan: xr.Dataset, sha256: str) -> xr.Dataset:
    """Return a scan after checks of its size, with attributes on its source."""
    scan = _remove_isolated(scan)
    if not np.isfinite(scan.height.values).any():
        raise ReadError(f"{path}: not one height is a number")
    refuse_impossible(path, scan)
    name = as_text(path.name)
    scan = measured_part(
        scan.assign_attrs(**made(f"read {name}", source=name, source_sha256=sha256))
    )
    x = scan.x.values
    return scan.assign_attrs(
        pitch_m=float(x[-1] - x[0]) / (x.size - 1), length_m=float(x[-1] - x[0])
    )


def _remove_isolated(scan: xr.Dataset) -> xr.Dataset:
    """Replace sentinels among the heights by NaN, and list them in an attribute."""
    height = np.array(scan.height.values, dtype=float)
    marks = take_isolated(height)
    if not marks:
        return scan
    before = [scan.attrs["taken_for_missing"]] if "taken_for_missing" in scan.attrs else []
    removed = [
        f"height: {1e6 * mark.number:.9g} um {Count(mark.rows):time|times}, far from all other "
        "heights"
        for mark in marks
    ]
    scan = scan.assign(height=scan.height.copy(data=height))
    return scan.assign_attrs(taken_for_missing="; ".join([*before, *removed]))


def _recognised(path: Path) -> Dialect | None:
    """Return the dialect that matches a text or TDMS file; None without one."""
    # imported late for a quick start
    from tribolab.reading.dialect.recognise import mismatch

    try:
        file: File = peek(path)
    except RefusedError:
        raise
    except ReadError:
        if path.stat().st_size == 0:
            raise
        return None  # a format that possibly only SurfaceTopography can read
    if file.format not in ("text", "tdms"):
        return None
    if error := results_error(file.head, path):
        raise error
    known = [d for d in every_dialect() if mismatch(file, d) is None]
    fitting = [d for d in known if is_scan(d)]
    if known and not fitting:
        what = f"this looks like a run ({shown(known[0].title)})"
        raise ReadError(what, where=path, cure=cures.MEND_SIGNALS)
    if len(fitting) > 1:
        names = ", ".join(repr(d.name) for d in fitting)
        raise ReadError(
            f"more than one dialect fits: {names}",
            where=path,
            cure=cures.name_instrument(cures.SURFACE),
        )
    return fitting[0] if fitting else None


def _read_by_dialect(path: Path, dialect: Dialect) -> tuple[list[xr.Dataset], str]:
    """Return the scans of a file, one for each column of heights."""
    if isinstance(dialect, PythonReader):
        dialect = with_columns(dialect, path)
    several = [c for c in dialect.column if c.key == "height" and not c.optional]
    if len(several) < 2:
        return _of_columns(path, dialect)
    others = tuple(column for column in dialect.column if column not in several)
    scans: list[xr.Dataset] = []
    for column in several:
        mine, checksum = _of_columns(path, dialect.model_copy(update={"column": (*others, column)}))
        scans += mine
    for scan in scans:
        scan.attrs.pop("columns_not_used", None)  # the other columns are other traces
        scan.attrs["traces"] = str(len(scans))
    return scans, checksum


def _of_columns(path: Path, dialect: Dialect) -> tuple[list[xr.Dataset], str]:
    # imported late for a quick start
    from tribolab.reading.scans.traces import traces_of
    from tribolab.reading.si_tables.values import single_values

    content = read_content(path, dialect)
    pieces = traces_of(path, content.pieces)
    attrs = {"instrument": dialect.name, **single_values(content, dialect)}
    if content.not_used:
        attrs["columns_not_used"] = "; ".join(content.not_used)
    if content.left_out:
        attrs["rows_left_out_why"] = "; ".join(f"{n} {why}" for why, n in content.left_out.items())
    if "taken_for_missing" in content.notes:
        attrs["taken_for_missing"] = content.notes["taken_for_missing"]
    if len(pieces) > 1:
        attrs["traces"] = str(len(pieces))
    scans = [_scan_of(path, piece.columns, attrs, dialect) for piece in pieces]
    return scans, content.sha256


def _scan_of(
    path: Path, columns: Mapping[str, np.ndarray], attrs: Json, dialect: Dialect
) -> xr.Dataset:
    """Return the scan of one table, without isolated sentinels."""
    bare = _remove_isolated(xr.Dataset({"height": ("row", columns["height"])}, attrs=dict(attrs)))
    columns, attrs = {**columns, "height": bare.height.values}, dict(bare.attrs)
    line = _line_of(columns)
    if "y" in columns and line is None:
        scan = gridded(str(path), columns["x"], columns["y"], columns["height"])
        return scan.assign_attrs(attrs)
    if line is not None:
        columns = {"x": columns[line], "height": columns["height"]}
    if "x" not in columns:
        height = columns["height"]
        if height.size < 2:
            raise ReadError(f"{path}: a profile needs at least two points, it has {height.size}")
        pitch = _stated_pitch(path, dialect, attrs, height.size)
        x = pitch * np.arange(height.size, dtype=float)
        return xr.Dataset({"height": ("x", height)}, {"x": x}, attrs)
    pitch, height, evened = even(str(path), columns["x"], columns["height"])
    x = pitch * np.arange(height.size, dtype=float)
    return xr.Dataset({"height": ("x", height)}, {"x": x}, {**attrs, **evened})


def _line_of(columns: Mapping[str, np.ndarray]) -> str | None:
    """Return "x" or "y" for points on a line along that axis; None for any other points."""
    if "y" not in columns or not columns["height"].size > 1:
        return None
    still = [name for name in ("x", "y") if np.ptp(columns[name]) == 0]
    return {"x": "y", "y": "x"}[still[0]] if len(still) == 1 else None


def _stated_pitch(
    path: Path, dialect: Dialect, attrs: Mapping[str, str | float], points: int
) -> float:
    """Return the pitch [m] stated by the dialect or the file's header.

    Files seldom state whether a length ends at the last point or one step beyond it. The rounder of
    the two pitches is used; the difference is small.
    """
    if dialect.pitch is not None:
        return positive(dialect.pitch, "m", "pitch")
    source = dialect.pitch_value or dialect.length_value
    if source is None:
        raise ReadError(
            f"{path}: heights without positions: put the distance of neighbouring heights into the "
            f"dialect '{dialect.name}', pitch = \"0.25 um\" in its first lines"
        )
    [value] = [value for value in dialect.value if value.name == source]
    stated = attrs.get(value.attribute)
    if stated is None or not float(stated) > 0:
        what = "distance of its points" if dialect.pitch_value else "length of the profile"
        raise ReadError(
            f"{path}: the {what} is not in the file as the dialect "
            f"'{dialect.name}' expects it ([[value]] '{shown(value.name)}')"
        )
    return float(stated) if dialect.pitch_value else rounder_pitch(float(stated), points)


def stacked(files: Sequence[Path], scans: Sequence[xr.Dataset]) -> xr.Dataset:
    """Stack separately read scans, as for `scan_files.read_scans`.

    Raises
    ------
    ReadError
        If they differ in pitch or length, or one of several is a map.
    """
    maps = [file for file, scan in zip(files, scans, strict=True) if "y" in scan.dims]
    if maps and len(maps) < len(scans):
        raise ReadError("a map cannot be stacked with profiles", where=maps[0], cure=_ONE_BY_ONE)
    first = scans[0]
    if maps and len(scans) == 1:
        return stamp(first)
    dims = tuple(str(dim) for dim in first.height.dims)
    for file, scan in zip(files[1:], scans[1:], strict=True):
        for dim in dims:
            points, length = first.sizes[dim], float(np.ptp(first[dim].values))
            drift = abs(float(np.ptp(scan[dim].values)) - length) if points > 1 else 0.0
            if scan.sizes[dim] == points and drift <= 0.5 * length / max(points - 1, 1):
                continue
            own, usual = (
                1e6 * float(np.ptp(pitch_of[dim].values)) / max(pitch_of.sizes[dim] - 1, 1)
                for pitch_of in (scan, first)
            )
            raise ReadError(
                f"{scan.sizes[dim]} points of {own:.6g} um, but {files[0].name} has {points} "
                f"points of {usual:.6g} um: scans of different pitch or length do not stack",
                where=file,
                cure=_ONE_BY_ONE,
            )
    height = np.stack([scan.height.values for scan in scans])
    data = xr.Dataset(
        {"height": (("scan", *dims), height)},
        {
            "scan": np.arange(len(scans)),
            **{dim: first[dim].values for dim in dims},
            "file": ("scan", [as_text(file.name) for file in files]),
        },
    )
    return stamp(data, **_common([scan.attrs for scan in scans]))


def _common(attrs: list[Json]) -> Json:
    """Return the attributes of all scans; different values are joined as text."""
    result: Json = {}
    for key in dict.fromkeys(key for scan in attrs for key in scan):
        values = [scan.get(key) for scan in attrs]
        numbers = [value for value in values if isinstance(value, float)]
        alike = all(value == values[0] for value in values)
        if alike:
            result[key] = values[0]
        elif key == "history":
            result[key] = "\n".join(map(str, values))
        elif key in _JOINED or len(numbers) < len(values):
            result[key] = "; ".join("" if value is None else str(value) for value in values)
        elif key in ("pitch_m", "length_m"):
            result[key] = values[0]
        elif key in _WORST:
            result[key] = _WORST[key](numbers)
        else:
            result[key] = "; ".join(f"{value:.9g}" for value in numbers)
    return result
