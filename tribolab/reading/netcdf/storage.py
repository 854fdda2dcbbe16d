"""Datasets into an open netCDF file: first all is defined, then all is written.

The library writes the definitions to the disk whenever data follow them: variable by variable
that costs more than the bytes of a run.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import pieces
from tribolab.core.untyped import Arguments
from tribolab.reading.netcdf.attributes import encoded

if TYPE_CHECKING:
    import netCDF4

CHUNK = 65_536  # samples; a default chunk would be the whole array
_LONG = 1024  # values; what is shorter is stored as it is
_COMPRESSION = 1  # noise does not become smaller by trying harder
_WORTH = 0.95  # of the bytes; what stays longer is not worth the time that reading it back takes
_BLOCKS, _BLOCK = 4, 1024  # samples that are tried: how many pieces, how long
_PIECE = 16 * CHUNK  # samples that are handed to the library at once: it copies them
_CACHE = 1 << 20  # bytes that the library keeps for a variable; whole chunks need no more
# What xarray understands as an order rather than as a note.
COORDINATES = "coordinates"  # attribute that names the variables that are coordinates
ORDERS = {"_FillValue", "missing_value", "scale_factor", "add_offset", COORDINATES, "dtype"}
ORDERS |= {"_Unsigned", "_Encoding"}


def write_into(file: netCDF4.Dataset, groups: Mapping[str | None, xr.Dataset]) -> None:
    """Write datasets as groups of a file that is open for writing; None stands for the root.

    Parameters
    ----------
    file
        The file.
    groups
        Dataset by name of the group.

    Notes
    -----
    xarray reads back what it would have read had it written itself. What is rare in results
    (truth values, dates, a group that is there already) is left to it.
    """
    waiting: list[tuple[netCDF4.Variable[Any], np.ndarray]] = []
    left: dict[str | None, xr.Dataset] = {}
    for name, data in groups.items():
        fresh = name not in file.groups if name else not (file.variables or file.dimensions)
        if fresh and all(_common(str(key), v) for key, v in data.variables.items()):
            waiting += _define(file.createGroup(name) if name else file, data)
        else:
            left[name] = data
    for target, values in waiting:
        target.set_auto_maskandscale(False)
        if values.ndim == 1:
            for start, stop in pieces(0, values.size, _PIECE):
                target[start:stop] = values[start:stop]
        else:
            target[...] = values
    for name, data in left.items():
        _by_xarray(file, name, data)


def _define(
    target: netCDF4.Dataset, data: xr.Dataset
) -> list[tuple[netCDF4.Variable[Any], np.ndarray]]:
    variables, attrs = xr.conventions.encode_dataset_coordinates(data)
    target.setncatts(encoded(attrs))
    for dim, length in data.sizes.items():
        target.createDimension(str(dim), length)
    waiting = []
    for name, variable in variables.items():
        values = variable.values
        if values.dtype.kind in "UO":
            values = values.astype(object)
        kind = str if values.dtype.kind == "O" else values.dtype.newbyteorder("=")
        stored = target.createVariable(
            name, kind, variable.dims, chunk_cache=_CACHE, **storage(values)
        )
        stored.setncatts(encoded(variable.attrs))
        if values.size:
            waiting.append((stored, values))
    return waiting


def _common(name: str, variable: xr.Variable) -> bool:
    """Whether a variable is of the kinds that results are made of: numbers and text."""
    if "/" in name or any("/" in str(dim) for dim in variable.dims):
        return False
    if not ORDERS.isdisjoint(variable.attrs):
        return False
    if variable.dtype.kind == "O":  # of what an empty one holds xarray has an opinion of its own
        return variable.size > 0 and all(isinstance(value, str) for value in variable.values.flat)
    return variable.dtype.kind in "fiuU"


def _by_xarray(file: netCDF4.Dataset, group: str | None, data: xr.Dataset) -> None:
    copy = data.copy()
    copy.attrs = encoded(data.attrs)
    for name in copy.variables:
        variable = copy[name]
        variable.attrs = encoded(data[name].attrs)
        number = variable.dtype.kind in "fiu"
        variable.encoding = {"_FillValue": None} | storage(variable.values) if number else {}
    copy.dump_to_store(xr.backends.NetCDF4DataStore(file, group=group))


def storage(values: np.ndarray) -> Arguments:
    """Say how an array is stored: chunks and filters as netCDF4 takes them; none if it is short.

    Notes
    -----
    A signal from a converter has few distinct values, each eight bytes that come again and again:
    zlib finds them as they stand, and not once the bytes are shuffled. A smooth signal is the
    other way round, and the noise of a computed one does neither. Some samples of the array tell.

    Examples
    --------
    >>> volt = np.random.default_rng(0).integers(0, 200, 9000) * 0.0153
    >>> storage(volt)["shuffle"], storage(np.linspace(0, 1, 9000))["shuffle"]
    (False, True)
    >>> storage(volt[:100])
    {}
    """
    if values.dtype.kind not in "fiu" or not values.ndim or values.size <= _LONG:
        return {}
    layout: Arguments = {"chunksizes": tuple(min(n, CHUNK) for n in values.shape)}
    sample = _sample(values)
    plain, shuffled = (
        len(zlib.compress(block.tobytes(), _COMPRESSION)) for block in (sample, sample.T)
    )
    if min(plain, shuffled) > _WORTH * sample.size:
        return layout
    return layout | {
        "zlib": True,
        "complevel": _COMPRESSION,
        "shuffle": shuffled < plain,
    }


def _sample(values: np.ndarray) -> np.ndarray:
    """Bytes (sample, byte of the number) of a few pieces of an array."""
    flat = values.reshape(-1)
    starts = np.linspace(0, max(0, flat.size - _BLOCK), _BLOCKS).astype(int)
    if flat.size > _BLOCKS * _BLOCK:
        flat = np.concatenate([flat[start : start + _BLOCK] for start in starts])
    return np.ascontiguousarray(flat).view(np.uint8).reshape(flat.size, -1)
