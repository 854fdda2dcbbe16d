"""Reading of scans of any instrument; for text of an unknown one, a dialect is drafted."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Literal, overload

import xarray as xr

from tribolab.core.aliases import PathLike
from tribolab.core.errors import ReadError
from tribolab.reading import cures
from tribolab.reading.dialect.find import Dialect, Instrument
from tribolab.reading.file_patterns import is_pattern
from tribolab.reading.folder_content import files_with
from tribolab.reading.raw.source import read_unchanged
from tribolab.reading.scans.extent import RefusedScanError, doubt_about_heights, impossible_heights
from tribolab.reading.scans.formats.undescribed import is_own_text
from tribolab.reading.scans.read_scan import files_of, read_known_scans, stacked
from tribolab.reading.unknown.proposal.questions import (
    GuessedError,
    how_to_keep,
    questions,
    understood_columns,
)
from tribolab.reading.unknown_run import DRAFTED, draft_of, left_open, measures_other_things
from tribolab.units.stamping import stamp

_TRACE = ", trace "


@overload
def read_scans(
    paths: PathLike | Sequence[PathLike],
    instrument: Instrument | None = None,
    *,
    x_unit: str | None = None,
    height_unit: str | None = None,
    stack: Literal[True] = True,
) -> xr.Dataset: ...


@overload
def read_scans(
    paths: PathLike | Sequence[PathLike],
    instrument: Instrument | None = None,
    *,
    x_unit: str | None = None,
    height_unit: str | None = None,
    stack: Literal[False],
) -> list[xr.Dataset]: ...


def read_scans(
    paths: PathLike | Sequence[PathLike],
    instrument: Instrument | None = None,
    *,
    x_unit: str | None = None,
    height_unit: str | None = None,
    stack: bool = True,
) -> xr.Dataset | list[xr.Dataset]:
    r"""Read scans of one surface, from files of known instruments or text with a clear header.

    Parameters
    ----------
    paths
        A file, a pattern with ``*`` or a folder, for the scans among its files in order of name,
        or a list of files and patterns.
    instrument
        Dialect of a text file: its name, the path of a TOML file, or a dialect. By default text is
        recognised by its content, and the other formats of `formats.undescribed` are read. Text of
        an unknown instrument is read if its header names the columns, or states the pitch; the
        attribute ``instrument`` is then "drafted from the file".
    x_unit, height_unit
        Units of positions and heights, for files that state none and have no dialect.
    stack
        False: return a list with a dataset for each file, or for each trace in a file; they may
        differ in pitch and length.

    Returns
    -------
    xarray.Dataset or list of xarray.Dataset
        Profiles: ``height`` [m] (scan, x), ``x`` [m] from 0, also for one file, and the files'
        names as ``file`` (scan); each of several traces in a file is a scan. One map:
        ``height`` [m] (y, x), several: (scan, y, x). Missing heights are NaN.
        Attributes: ``pitch_m``, ``length_m`` (from the first point to the last), ``tip_radius_m``,
        ``lambda_c_m`` and the instrument's own results (``instrument_Ra_m``, ...) if the file
        states them. Attributes that differ between stacked scans are joined by ``"; "``.

    Raises
    ------
    ReadError
        If there is no such file, it cannot be read, contains results only, or the scans differ in
        pitch or length. For a file with too little information the message lists the guesses.

    Notes
    -----
    Positions that deviate from an even grid by no more than the rounding of their last digit are
    taken as even. Others are interpolated, and the attribute ``resampled`` says so.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "line.txt"
    >>> _ = file.write_text("Point spacing: 0.25 um\nZ [um]\n1.0\n1.5\n1.25\n1.0\n")
    >>> scan = read_scans(file)
    >>> scan.attrs["instrument"], scan.attrs["pitch_m"], scan.sizes["x"]
    ('drafted from the file', 2.5e-07, 4)
    """
    if instrument is None and isinstance(paths, str | Path):
        several = is_pattern(paths) or Path(paths).is_dir()
        paths = files_with("scan", paths) if several else paths
    files = files_of(paths)
    units = {"x_unit": x_unit, "height_unit": height_unit}

    def read_file(file: Path) -> list[xr.Dataset]:
        if instrument is not None:
            return read_known_scans([file], instrument, **units)
        return _read(file, units)

    read = [read_unchanged([file], partial(read_file, file)) for file in files]
    traces = [(file, scan) for file, scans in zip(files, read, strict=True) for scan in scans]
    if not stack:
        return [stamp(scan) for _, scan in traces]
    return stacked([file for file, _ in traces], [scan for _, scan in traces])


def read_traces(path: Path, instrument: Instrument | None = None) -> dict[Path, xr.Dataset]:
    """Read all scans of one file, each under its own name.

    Parameters
    ----------
    path
        The file.
    instrument
        As for `read_scans`.

    Returns
    -------
    dict
        The scan of a file with one scan under the file's path; each of several traces under the
        path with the trace's number: "line.txt, trace 2".

    Raises
    ------
    ReadError
        As for `read_scans`.
    """
    scans = read_scans([path], instrument, stack=False)
    if len(scans) == 1:
        return {path: scans[0]}
    return {path.with_name(f"{path.name}{_TRACE}{k}"): scan for k, scan in enumerate(scans, 1)}


def file_of(trace: Path) -> Path:
    """Return the path of the file that contains a trace, from the trace's key in `read_traces`.

    >>> file_of(Path("line.txt, trace 2")).name, file_of(Path("line.txt")).name
    ('line.txt', 'line.txt')
    """
    name, mark, number = trace.name.rpartition(_TRACE)
    return trace.with_name(name) if mark and number.isdecimal() else trace


def _read(file: Path, units: dict[str, str | None]) -> list[xr.Dataset]:
    try:
        scans = read_known_scans([file], **units)
        return [_doubted(scan, impossible_heights(scan)) for scan in scans]
    except RefusedScanError:
        raise
    except ReadError as error:
        dialect = None if any(units.values()) else _drafted(file, error)
        if dialect is None:
            raise
        origin = {"instrument": DRAFTED, "to_keep_it": how_to_keep(file)}
        scans = read_known_scans([file], dialect)
        return [_doubted(scan.assign_attrs(origin), doubt_about_heights(scan)) for scan in scans]


def _doubted(scan: xr.Dataset, doubt: str) -> xr.Dataset:
    doubts = "; ".join(filter(None, [scan.attrs.get("doubtful", ""), doubt]))
    return scan.assign_attrs(doubtful=doubts) if doubts else scan


def _drafted(file: Path, error: ReadError) -> Dialect | None:
    """Return the dialect drafted from the file of a scan; None if the file is no scan."""
    draft = draft_of(file)
    if draft is None or draft.known or is_own_text(file):
        return None
    if draft.unsaid:
        raise left_open(draft) or error from error
    if draft.kind == "table" and measures_other_things(draft):
        raise ReadError(draft.answer, where=file) from error
    if draft.kind != "scan":
        return None
    understood = draft.understood
    asked = questions(draft)
    if asked and not draft.named and not (understood is not None and understood.pitched):
        return None
    if asked:
        known = understood_columns(draft)
        raise GuessedError(file, asked, cures.SURFACE, (), known) from error
    return draft.dialect
