"""Read scans: profiles and maps of heights, from text by dialect or from profilometers' files."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, overload

import numpy as np
import xarray as xr

from tribolab.errors import Cure, ReadError, shown
from tribolab.io import cures
from tribolab.io.dialects.find import Dialect, every_dialect, is_scan, load_dialect, scan_dialects
from tribolab.io.dialects.signature import File, is_results, peek
from tribolab.io.patterns import is_pattern, matching
from tribolab.io.scans.extent import measured_part, refuse_impossible
from tribolab.io.scans.grid import even, gridded
from tribolab.io.scans.undescribed import read_undescribed
from tribolab.provenance import as_text, made, sha256_of_file
from tribolab.stamping import stamp
from tribolab.untyped import Json

PathLike = str | Path
# where the scans of a surface differ, the one that shows least counts for all
_WORST = {"tip_radius_m": max, "lambda_s_m": max, "lambda_c_m": min}
_JOINED = ("source", "source_sha256")
_ONE_BY_ONE = Cure(notebook="read them with stack=False")


@overload
def read_scans(
    paths: PathLike | Sequence[PathLike],
    instrument: str | Path | None = None,
    *,
    x_unit: str | None = None,
    height_unit: str | None = None,
    stack: Literal[True] = True,
) -> xr.Dataset: ...


@overload
def read_scans(
    paths: PathLike | Sequence[PathLike],
    instrument: str | Path | None = None,
    *,
    x_unit: str | None = None,
    height_unit: str | None = None,
    stack: Literal[False],
) -> list[xr.Dataset]: ...


def read_scans(
    paths: PathLike | Sequence[PathLike],
    instrument: str | Path | None = None,
    *,
    x_unit: str | None = None,
    height_unit: str | None = None,
    stack: bool = True,
) -> xr.Dataset | list[xr.Dataset]:
    r"""Read scans of one surface.

    Parameters
    ----------
    paths
        A file, a pattern with ``*``, or a list of either. A pattern's files come in order of name.
    instrument
        Dialect of a text file: its name or the path of a TOML file. Without it text is recognised
        by content, and what no dialect knows goes to SurfaceTopography (Mitutoyo xlsx, SDF, X3P,
        SUR, GWY, AL3D and some forty others).
    x_unit, height_unit
        Units of positions and heights, for files that state none and have no dialect.
    stack
        False: return a list with a dataset for each file, which may differ in pitch and length.

    Returns
    -------
    xarray.Dataset or list of xarray.Dataset
        Profiles: ``height`` [m] (scan, x), ``x`` [m] from 0, also for one file, and the files'
        names as ``file`` (scan). One map: ``height`` [m] (y, x), several: (scan, y, x). Missing
        heights are NaN.
        Attributes: ``pitch_m``, ``length_m`` (from the first point to the last), ``tip_radius_m``,
        ``lambda_c_m`` and the instrument's own results (``instrument_Ra_m``, ...) where the file
        has them. Attributes that differ between stacked scans are joined by ``"; "``.

    Raises
    ------
    ReadError
        If there is no such file, it cannot be understood, holds results only, or the scans differ
        in pitch or length.

    Notes
    -----
    Positions that deviate from an even grid by no more than the rounding of their last digit are
    taken as even. Others are interpolated, and the attribute ``resampled`` says so.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> head = "# Surftest profile\n# tip radius: 2 um\nx [mm],z [um]\n"
    >>> for number in (1, 2):
    ...     file = folder / f"sb-r_{number}.csv"
    ...     _ = file.write_text(head + f"0.0,{number}\n0.0005,2.5\n0.001,-1\n")
    >>> scans = read_scans(folder / "sb-r_*.csv")
    >>> scans.height.values.tolist(), scans.attrs["tip_radius_m"]
    ([[1e-06, 2.5e-06, -1e-06], [2e-06, 2.5e-06, -1e-06]], 2e-06)
    """
    files = _files(paths)
    dialect = load_dialect(instrument) if instrument is not None else None
    if dialect is not None and not is_scan(dialect):
        scanning = ", ".join(d.name for d in scan_dialects())
        raise ReadError(
            f"instrument '{dialect.name}' writes no profiles (no column is 'x' and 'height'); "
            f"those that do are {scanning}"
        )
    scans = [_read(file, dialect, x_unit, height_unit) for file in files]
    return stacked(files, scans) if stack else [stamp(scan) for scan in scans]


def _files(paths: PathLike | Sequence[PathLike]) -> list[Path]:
    given = [paths] if isinstance(paths, str | Path) else list(paths)
    if not given:
        raise ReadError("no file is given", function="read_scans")
    files: list[Path] = []
    for path in given:
        files.extend(matching(path) if is_pattern(path) else [Path(path)])
    return files


@functools.cache  # the descriptions do not change while a program runs
def _every_dialect() -> tuple[Dialect, ...]:
    return tuple(every_dialect())


def _read(
    path: Path, dialect: Dialect | None, x_unit: str | None, height_unit: str | None
) -> xr.Dataset:
    if not path.is_file():
        raise ReadError(f"{path}: there is no such file")
    if dialect is None:
        dialect = _recognised(path)
    if dialect is not None:
        scan, sha256 = _by_dialect(path, dialect)
    else:
        scan, sha256 = read_undescribed(path, x_unit, height_unit), sha256_of_file(path)
    if not np.isfinite(scan.height.values).any():
        raise ReadError(f"{path}: not one height is a number")
    refuse_impossible(path, scan)
    name = as_text(path.name)
    scan = measured_part(
        scan.assign_attrs(**made(f"read {name}", source=name, source_sha256=sha256))
    )
    x = scan.x.values
    return scan.assign_attrs(
        pitch_m=float(x[-1] - x[0]) / (x.size - 1),
        length_m=float(x[-1] - x[0]),
    )


def _recognised(path: Path) -> Dialect | None:
    """Return the text dialect that a file is written in; None for other formats."""
    from tribolab.io.dialects.recognise import mismatch

    try:
        file: File = peek(path)
    except ReadError:
        if path.stat().st_size == 0:
            raise
        return None  # a format that only SurfaceTopography may know
    if file.format not in ("text", "tdms"):
        return None
    if is_results(file.head):
        raise ReadError(
            "the file holds the results of a roughness tester, but no profile",
            where=path,
            cure=cures.TESTER_RESULTS,
        )
    known = [d for d in _every_dialect() if mismatch(file, d) is None]
    fitting = [d for d in known if is_scan(d)]
    if known and not fitting:
        what = f"this looks like a run ({shown(known[0].title)})"
        raise ReadError(what, where=path, cure=cures.SIGNALS)
    if len(fitting) > 1:
        names = ", ".join(repr(d.name) for d in fitting)
        raise ReadError(
            f"more than one dialect fits: {names}",
            where=path,
            cure=cures.name_instrument(cures.SURFACE),
        )
    return fitting[0] if fitting else None


def _by_dialect(path: Path, dialect: Dialect) -> tuple[xr.Dataset, str]:
    from tribolab.io.content.read import read_content
    from tribolab.io.content.values import single_values

    content = read_content(path, dialect)
    if len(content.pieces) != 1:
        raise ReadError(f"{path}: {len(content.pieces)} tables stand in the file, one is wanted")
    columns = content.pieces[0].columns
    attrs = {"instrument": dialect.name, **single_values(content, dialect)}
    if content.not_used:
        attrs["columns_not_used"] = "; ".join(content.not_used)
    if content.left_out:
        attrs["rows_left_out_why"] = "; ".join(f"{n} {why}" for why, n in content.left_out.items())
    if "y" in columns:
        scan = gridded(str(path), columns["x"], columns["y"], columns["height"])
        return scan.assign_attrs(attrs), content.sha256
    pitch, height, evened = even(str(path), columns["x"], columns["height"])
    x = pitch * np.arange(height.size, dtype=float)
    scan = xr.Dataset({"height": ("x", height)}, {"x": x}, {**attrs, **evened})
    return scan, content.sha256


def stacked(files: Sequence[Path], scans: Sequence[xr.Dataset]) -> xr.Dataset:
    """Put scans that were read one by one together, as `read_scans` does.

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
            found, usual = (
                1e6 * float(np.ptp(pitch_of[dim].values)) / max(pitch_of.sizes[dim] - 1, 1)
                for pitch_of in (scan, first)
            )
            raise ReadError(
                f"{scan.sizes[dim]} points of {found:.6g} um, but {files[0].name} has {points} "
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
    """Attributes of all scans; where they differ, joined as text."""
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
