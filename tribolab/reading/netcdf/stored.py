"""Fast reading of groups of an open netCDF file written by `netcdf.storage`.

xarray prepares every variable for lazy loading, scaling, dates and characters. For the hundred
mostly short variables of a run, that takes longer than reading them.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from tribolab.arrays.scratch import is_long
from tribolab.core.untyped import Json
from tribolab.reading.netcdf.storage import COORDINATES, ORDERS, decoded

if TYPE_CHECKING:
    import netCDF4

_ORDERS = ORDERS - {COORDINATES} | {"least_significant_digit"}


def read_plain(group: netCDF4.Dataset, only: Collection[str] | None = None) -> xr.Dataset | None:
    """Read a group of an open file, if it contains only short arrays of numbers and text.

    Parameters
    ----------
    group
        The group, or the file for its root.
    only
        Variables to read, with the coordinates on their dims; None reads all.

    Returns
    -------
    xarray.Dataset or None
        The same as xarray would read without decoding; None if decoding is needed or an array is
        long.
    """
    attrs = group.__dict__
    names = [name for name in group.variables if only is None or name in only]
    noted = {name: group.variables[name].__dict__ for name in names}
    dims = {dim for name in names for dim in group.variables[name].dimensions}
    named = " ".join(str(its.pop(COORDINATES, "")) for its in (attrs, *noted.values())).split()
    coordinates = dims.union(named).intersection(group.variables)
    for name in coordinates.difference(names):
        if dims.issuperset(group.variables[name].dimensions):
            noted[name] = group.variables[name].__dict__
            noted[name].pop(COORDINATES, None)
    if not all(_is_plain(group.variables[name], its) for name, its in noted.items()):
        return None
    # coordinates last, as in xarray
    names = sorted((n for n in group.variables if n in noted), key=lambda name: name in coordinates)
    read = {name: _read(group.variables[name], noted[name]) for name in names}
    data = xr.Dataset(read, attrs=decoded(attrs))
    return data.set_coords([name for name in names if name in coordinates])


def _is_plain(stored: netCDF4.Variable[Any], attrs: Json) -> bool:
    if is_long(stored.size) or not _ORDERS.isdisjoint(attrs):
        return False
    kind = stored.datatype
    if stored.dtype is str:  # xarray has special rules for empty object arrays
        return stored.size > 0
    return isinstance(kind, np.dtype) and kind.kind in "fiu" and kind.isnative


def _read(stored: netCDF4.Variable[Any], attrs: Json) -> xr.Variable:
    stored.set_auto_maskandscale(False)
    values = np.asarray(stored[...])
    values = values.astype(str) if stored.dtype is str else values
    return xr.Variable(stored.dimensions, values, decoded(attrs))
