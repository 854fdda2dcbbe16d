"""Reading of runs from netCDF files, written by tribolab or other programs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError
from tribolab.core.untyped import Json
from tribolab.reading.dialect.find import UnknownFileError
from tribolab.reading.raw.hdf5_safety import check_self_contained
from tribolab.reading.raw.opening import CrashedError
from tribolab.units.quantities import QUANTITIES

_NUMBERS = "fiub"
_DESCRIBE = "of others a description says which is which (raw_data_schema/README.md)"
# expected types of attributes that tribolab uses; values of other types are ignored
_KINDS: Mapping[str, type | tuple[type, ...]] = {"columns_used": dict, "findings": (list, tuple)}
_UNITS = ("_s", "_m", "_N", "_m_s", "_m_per_s", "_Hz", "_K", "_Pa")
_COUNTS = {"rows_not_covered", "rows_left_out", "rows_in_file"}


def read_own_run(path: Path, content: Path | None = None) -> xr.Dataset:
    """Read a run from a netCDF file of any origin.

    Parameters
    ----------
    path
        The file.
    content
        Path of the unpacked content, if the file is compressed.

    Returns
    -------
    xarray.Dataset
        Dim ``time`` [s]. Variables that are unknown or not numeric over time are left out and
        listed in ``columns_not_used``, as are attributes of unexpected types.

    Raises
    ------
    ReadError
        If the file cannot be read, has no time, or a quantity is not numeric over time.
    """
    # imported late for a quick start
    from tribolab.reading.netcdf.netcdf import read_netcdf

    cure = "columns of one length, with names and units, are read as they are: " + _DESCRIBE
    try:
        run = read_netcdf(content or path, group="run?")
    except CrashedError as error:  # the library can crash on valid HDF5 that is not netCDF
        check_self_contained(content or path)
        what = "this HDF5 file is no netCDF"
        raise UnknownFileError(what, where=path, cure=cure) from error
    if "time" not in run.coords or run.sizes.get("time", 0) == 0:
        what = "this netCDF or HDF5 file holds no run: it has no coordinate 'time'"
        raise UnknownFileError(what, where=path, cure=cure)
    numeric = {str(name) for name in run.variables if run[name].dtype.kind in _NUMBERS}
    along = {str(name) for name in run.variables if run[name].dims in (("time",), ())}
    strange = [str(name) for name in run.variables if name not in numeric & along]
    for name in strange:
        if name == "time" or name in QUANTITIES:
            dims = ", ".join(map(str, run[name].dims))
            kind = "numbers" if name in numeric else "text or dates"
            raise ReadError(
                f"{path}: variable '{name}' ({dims}) holds {kind}; a run's quantities "
                "are numbers along (time): write it so, or leave it out"
            )
    run = run.drop_vars(strange)
    run.attrs = _attributes(run.attrs)
    for variable in run.variables:
        run[variable].attrs = {
            key: value
            for key, value in run[variable].attrs.items()
            if isinstance(value, str) or key not in ("units", "long_name", "standard_name")
        }
    if strange:
        known = str(run.attrs.get("columns_not_used", ""))
        run.attrs["columns_not_used"] = "; ".join(filter(None, [known, *strange]))
    return run


def _attributes(attrs: Mapping[Any, Any]) -> Json:
    return {str(name): value for name, value in attrs.items() if _is_valid(str(name), value)}


def _is_valid(name: str, value: Any) -> bool:
    if name in _KINDS:
        return isinstance(value, _KINDS[name])
    if name in _COUNTS or name.endswith(_UNITS):
        return isinstance(value, int | float | None)
    return not isinstance(value, np.ndarray)
