"""Reading of scans without a dialect; the first bytes of a file show its format."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from tribolab.core.errors import ReadError
from tribolab.reading.raw.containers.workbook import sheets_of
from tribolab.reading.raw.containers.xml_workbook import is_xml_workbook, refuse_cut_short
from tribolab.reading.raw.unpacked import ZIP, has_arrays, is_workbook, of_the_file, unpacked
from tribolab.reading.scans.formats.arrays import read_scan_arrays
from tribolab.reading.scans.formats.converted import as_standard, is_sdf_draft, is_sur, plain_sur
from tribolab.reading.scans.formats.gauges import is_gauge, read_gauge
from tribolab.reading.scans.formats.matrix import read_matrix
from tribolab.reading.scans.formats.named_arrays import is_of_arrays
from tribolab.reading.scans.formats.named_units import units_in_name
from tribolab.reading.scans.formats.nanoscope import is_nanoscope, read_nanoscope
from tribolab.reading.scans.formats.profilometers import MissingUnitError, read_foreign
from tribolab.reading.scans.formats.surfer import is_surfer, read_surfer
from tribolab.reading.scans.formats.x3p import is_iso_xml, main_of, read_iso_xml, read_x3p
from tribolab.reading.scans.formats.zygo_xyz import is_zygo_xyz, read_zygo_xyz

_HEAD = 1 << 14  # bytes sufficient to recognise a format


def is_own_text(path: Path) -> bool:
    """Whether a file is text in a format with a reader in tribolab, which gives specific errors."""
    with path.open("rb") as file:
        head = file.read(_HEAD)
    named = is_surfer(head) or is_zygo_xyz(head) or is_nanoscope(head)
    return named or is_iso_xml(head) or is_gauge(head)


def read_undescribed(path: Path, x_unit: str | None, height_unit: str | None) -> xr.Dataset:
    """Read a scan without a dialect, with a reader of tribolab or else with SurfaceTopography.

    Parameters
    ----------
    path
        The file; it may be compressed.
    x_unit, height_unit
        Units of positions and heights, for files that state none.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (x) or (y, x); of several profiles in a file (scan, x).

    Raises
    ------
    ReadError
        If its format is unknown, or it is damaged.

    Notes
    -----
    tribolab reads formats that SurfaceTopography 1.27 supports in part or not at all: x3p and its
    bare XML, SMD and PRF text of softgauges, compressed Surf files, SDF of the draft standard,
    matrices of heights with their size in a header, and named arrays.
    """
    try:
        return _read(path, x_unit, height_unit)
    except MissingUnitError:
        named = units_in_name(path)
        if not ((named.x and x_unit is None) or (named.height and height_unit is None)):
            raise
        scan = _read(path, x_unit or named.x, height_unit or named.height)
        units = [f"x in {named.x}"] if named.x and x_unit is None else []
        units += [f"heights in {named.height}"] if named.height and height_unit is None else []
        return scan.assign_attrs(units_by_file_name=", ".join(units))


def _read(path: Path, x_unit: str | None, height_unit: str | None) -> xr.Dataset:
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if is_of_arrays(path, head):
        return _read_arrays(path, x_unit, height_unit)
    inside = as_standard(path) if is_sdf_draft(head) else unpacked(path, head)
    if inside != path:
        try:
            return _read(inside, x_unit, height_unit)
        except ReadError as error:
            raise of_the_file(error, inside, path) from error
    if is_zygo_xyz(head):
        return read_zygo_xyz(path, x_unit)
    if is_surfer(head):
        return read_surfer(path, x_unit, height_unit)
    if head.startswith(ZIP) and (main := main_of(path)) is not None:
        return read_x3p(path, main)
    if is_iso_xml(head):
        return read_iso_xml(path)
    if is_xml_workbook(head):
        refuse_cut_short(path)
        raise ReadError("no sheet of this workbook can be read as a profile", where=path)
    if is_gauge(head):
        return read_gauge(path)
    if is_nanoscope(head):
        return read_nanoscope(path)
    if b"\0" not in head or head.startswith((b"\xff\xfe", b"\xfe\xff")):
        return _read_text(path, x_unit, height_unit)
    if head.startswith(ZIP) and is_workbook(path):
        sheets_of(path)  # raises an error that names the missing package, if any
    return read_foreign(plain_sur(path) if is_sur(head) else path, x_unit, height_unit)


def _read_arrays(path: Path, x_unit: str | None, height_unit: str | None) -> xr.Dataset:
    """Read named arrays, else use SurfaceTopography."""
    scan = read_scan_arrays(path, x_unit, height_unit)
    if scan is None and has_arrays(path):
        raise ReadError(
            "no array of this archive is named as heights are, such as 'z_um' next to 'x_mm'",
            where=path,
        )
    return read_foreign(path, x_unit, height_unit) if scan is None else scan


def _read_text(path: Path, x_unit: str | None, height_unit: str | None) -> xr.Dataset:
    """Read a text map with our own readers, else use SurfaceTopography."""
    try:
        scan = read_matrix(path, x_unit, height_unit)
    except MissingUnitError as lacking:
        try:
            return read_foreign(path, x_unit, height_unit)
        except MissingUnitError as error:
            if x_unit is None:  # report the error of our own reader
                raise lacking from error
            raise
        except ReadError as error:
            raise lacking from error
    return read_foreign(path, x_unit, height_unit) if scan is None else scan
