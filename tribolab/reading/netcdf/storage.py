"""Writing of datasets into an open netCDF file: first all definitions, then all data.

The library writes all definitions to the disk each time data follow a definition. Variable by
variable, this would take longer than writing the data of a run. Unsupported attributes become JSON
text.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import pieces
from tribolab.core.untyped import Arguments, Json

if TYPE_CHECKING:
    import netCDF4

CHUNK = 65_536  # samples; a default chunk would be the whole array
_MIN_COMPRESSED = 1024  # fewest values of an array that is compressed
_COMPRESSION = 1  # higher levels hardly compress noise better
_MAX_SHARE = 0.95  # compressed share of the bytes above which compression is not worthwhile
_BLOCKS, _BLOCK = 4, 1024  # number and length of the pieces from which the filter is chosen
_PIECE = 16 * CHUNK  # samples passed to the library at once, as it copies them
_CACHE = 1 << 20  # bytes that the library caches per variable; enough for whole chunks
# attributes that xarray interprets
COORDINATES = "coordinates"  # attribute with the names of coordinate variables
ORDERS = {"_FillValue", "missing_value", "scale_factor", "add_offset", COORDINATES, "dtype"}
ORDERS |= {"_Unsigned", "_Encoding"}


def write_into(file: netCDF4.Dataset, groups: Mapping[str | None, xr.Dataset]) -> None:
    """Write datasets as groups of a file that is open for writing; None is the root.

    Parameters
    ----------
    file
        The file.
    groups
        Dataset by name of the group.

    Notes
    -----
    xarray reads such a file as if it had written it. Rare cases (truth values, dates, an existing
    group) are written by xarray.
    """
    waiting: list[tuple[netCDF4.Variable[Any], np.ndarray]] = []
    left: dict[str | None, xr.Dataset] = {}
    for name, data in groups.items():
        fresh = name not in file.groups if name else not (file.variables or file.dimensions)
        if fresh and all(_has_common_type(str(key), v) for key, v in data.variables.items()):
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


def _has_common_type(name: str, variable: xr.Variable) -> bool:
    """Whether a variable has a common type: numbers or text."""
    if "/" in name or any("/" in str(dim) for dim in variable.dims):
        return False
    if not ORDERS.isdisjoint(variable.attrs):
        return False
    if variable.dtype.kind == "O":  # xarray has special rules for empty object arrays
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
    """Return chunks and filters for storing an array with netCDF4; empty for a short one.

    Notes
    -----
    A digitised signal has few distinct values of eight bytes, whose repetition zlib finds only
    without shuffling. A smooth signal is better shuffled, and noise is hardly compressible. The
    choice is made from some samples of the array.

    Examples
    --------
    >>> volt = np.random.default_rng(0).integers(0, 200, 9000) * 0.0153
    >>> storage(volt)["shuffle"], storage(np.linspace(0, 1, 9000))["shuffle"]
    (False, True)
    >>> storage(volt[:100])
    {}
    """
    if values.dtype.kind not in "fiu" or not values.ndim or values.size <= _MIN_COMPRESSED:
        return {}
    layout: Arguments = {"chunksizes": tuple(min(n, CHUNK) for n in values.shape)}
    sample = _sample(values)
    plain, shuffled = (
        len(zlib.compress(block.tobytes(), _COMPRESSION)) for block in (sample, sample.T)
    )
    if min(plain, shuffled) > _MAX_SHARE * sample.size:
        return layout
    return layout | {"zlib": True, "complevel": _COMPRESSION, "shuffle": shuffled < plain}


def _sample(values: np.ndarray) -> np.ndarray:
    """Return the bytes (sample, byte of the number) of a few pieces of an array."""
    flat = values.reshape(-1)
    starts = np.linspace(0, max(0, flat.size - _BLOCK), _BLOCKS).astype(int)
    if flat.size > _BLOCKS * _BLOCK:
        flat = np.concatenate([flat[start : start + _BLOCK] for start in starts])
    return np.ascontiguousarray(flat).view(np.uint8).reshape(flat.size, -1)


_MARK, _TUPLE = "json:", "json-tuple:"


def encoded(attrs: Mapping[Any, Any]) -> Json:
    """Return attributes in types that netCDF supports.

    True, False, None, dicts and lists become JSON text with the prefix ``json:``, tuples with
    ``json-tuple:``.

    Examples
    --------
    >>> encoded({"trim": 0.1, "known": None})
    {'trim': 0.1, 'known': 'json:null'}
    """
    return {str(name): _encode(value) for name, value in attrs.items()}


def decoded(attrs: Mapping[Any, Any]) -> Json:
    """Return the original attributes; inverse of `encoded`.

    Examples
    --------
    >>> decoded({"trim": 0.1, "known": "json:null"})
    {'trim': 0.1, 'known': None}
    """
    return {str(name): _decode(value) for name, value in attrs.items()}


def _encode(value: Any) -> Any:
    if isinstance(value, str):
        # text that happens to begin with the prefix must be restored as text
        return _MARK + json.dumps(value) if value.startswith((_MARK, _TUPLE)) else value
    if isinstance(value, np.bool_):
        value = bool(value)
    if isinstance(value, np.ndarray | np.generic):
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return value
    mark = _TUPLE if isinstance(value, tuple) else _MARK
    return mark + json.dumps(value, ensure_ascii=False, default=_plain)


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    return str(value)


def _decode(value: Any) -> Any:
    if isinstance(value, str) and value.startswith(_TUPLE):
        return tuple(json.loads(value.removeprefix(_TUPLE)))
    if isinstance(value, str):
        return json.loads(value.removeprefix(_MARK)) if value.startswith(_MARK) else value
    if isinstance(value, np.integer):
        return int(value)
    if isinstance(value, np.floating):
        return float(value)
    return value
