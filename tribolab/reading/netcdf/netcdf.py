"""Lossless writing and reading of datasets as netCDF."""

from __future__ import annotations

import contextlib
import math
import sys
import tempfile
import threading
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import xarray as xr

from tribolab.arrays.chunks import pieces
from tribolab.arrays.scratch import is_long, room
from tribolab.core.errors import ReadError, TribolabError, shown
from tribolab.reading.netcdf.fresh import is_fresh
from tribolab.reading.netcdf.seal import check_seal, seal, unseal
from tribolab.reading.netcdf.storage import decoded, write_into
from tribolab.reading.netcdf.stored import read_plain
from tribolab.reading.raw.opening import isolated, report_damage
from tribolab.reading.raw.source import check_regular

if TYPE_CHECKING:
    import netCDF4

# the library is not thread-safe, and some executors use threads
_LIBRARY = threading.RLock()
_CACHE = 1 << 20  # bytes that the library caches of a long variable
_GROUPS = "groups"  # attribute of the root with the names of the groups
# errors of netCDF4 and xarray for unsupported data, and on a full disk
_REFUSED = (OSError, ValueError, TypeError, AttributeError, KeyError, RuntimeError)


def write_netcdf(
    data: xr.Dataset,
    path: str | Path,
    group: str | None = None,
    mode: Literal["w", "a"] | None = None,
) -> Path:
    """Write a dataset without loss: values, types, flags and attributes are restored on reading.

    Parameters
    ----------
    data
        The dataset.
    path
        The file.
    group
        Group in the file, so that several datasets can share one file.
    mode
        ``"w"`` writes a new file, ``"a"`` adds to it; by default a group is added to an existing
        file, and a dataset without a group starts a new file.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    TribolabError
        If the file cannot be written.

    Notes
    -----
    Long arrays are stored in chunks of 65 536 samples with zlib, shuffled if that makes them
    smaller. True, False, None, dicts and lists among the attributes become JSON text with the
    prefix ``json:``. The root's attribute ``groups`` lists the groups of a file. The file is sealed
    (see `tribolab.reading.netcdf.seal`).

    Examples
    --------
    >>> import tempfile
    >>> run = xr.Dataset({"friction_force": ("time", [1.0, 2.0])}, {"time": [0.0, 0.1]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = write_netcdf(run.assign_attrs(checked=True), Path(folder) / "run.nc", "run")
    ...     read_netcdf(path, "run").attrs["checked"]
    True
    """
    path = Path(path)
    mode = mode or ("a" if group and path.exists() else "w")
    return _write(path, {group: data}, mode)


def write_groups(groups: Mapping[str | None, xr.Dataset], path: str | Path) -> Path:
    """Write datasets as groups of a new file, opened only once; see `write_netcdf`.

    Parameters
    ----------
    groups
        Dataset by name of the group; None is the root.
    path
        File to write; an existing one is replaced.

    Raises
    ------
    TribolabError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> run = xr.Dataset({"friction_force": ("time", [1.0, 2.0])}, {"time": [0.0, 0.1]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = write_groups({None: xr.Dataset(), "run": run}, Path(folder) / "run.nc")
    ...     read_netcdf(path).attrs, read_netcdf(path, "run").identical(run)
    ({'groups': 'run'}, True)
    """
    return _write(Path(path), groups, "w")


def _write(path: Path, groups: Mapping[str | None, xr.Dataset], mode: Literal["w", "a"]) -> Path:
    # imported late: netCDF4 loads slowly
    import netCDF4

    try:
        if mode == "a" and path.is_file():
            unseal(path)
        with _LIBRARY, _plain_name(path) as name, netCDF4.Dataset(name, mode) as file:
            write_into(file, groups)
            if any(groups):  # visible when the file is opened without a group
                file.setncattr(_GROUPS, "; ".join(file.groups))
        seal(path)
    except _REFUSED as error:
        raise TribolabError(f"{path}: the netCDF file cannot be written: {error}") from error
    return path


@contextlib.contextmanager
def _plain_name(path: Path) -> Iterator[Path]:
    """Yield the path, or a link to it if the libraries cannot encode its name."""
    try:
        str(path).encode(sys.getfilesystemencoding())
    except UnicodeEncodeError:
        with tempfile.TemporaryDirectory() as folder:
            link = Path(folder) / "link.nc"
            link.symlink_to(path.absolute())
            yield link
    else:
        yield path


def read_netcdf(path: str | Path, group: str | None = None) -> xr.Dataset:
    """Read a dataset written by `write_netcdf` into memory.

    Parameters
    ----------
    path
        The file.
    group
        Group in the file. ``"run?"`` takes the group ``run`` if the file has one, else its root.

    Raises
    ------
    ReadError
        If the file or group does not exist, or the file is damaged or not netCDF.

    Notes
    -----
    The file is read in a child process, unless the running command wrote it. A file with a seal
    that does not match its content is refused.

    Examples
    --------
    >>> import tempfile
    >>> run = xr.Dataset({"friction_force": ("time", [1.0, 2.0])}, {"time": [0.0, 0.1]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     read_netcdf(write_netcdf(run, Path(folder) / "run.nc")).identical(run)
    True
    """
    return read_groups(path, [group])[group]


def read_groups(
    path: str | Path,
    groups: Iterable[str | None] | None = None,
    *,
    optional: bool = False,
    only: Mapping[str, Collection[str]] | None = None,
    most: float = math.inf,
) -> dict[str | None, xr.Dataset]:
    """Read several groups of a file, opened only once; see `read_netcdf`.

    Parameters
    ----------
    path
        The file.
    groups
        Names of the groups; None is the root. By default the root and all groups.
    optional
        Whether to ignore missing groups.
    only
        Variables to read, by group; by default all. Missing variables are ignored.
    most
        Most values in all variables of a group; a group with more is left out.

    Raises
    ------
    ReadError
        As for `read_netcdf`.
    """
    path = Path(path)
    check_regular(path)
    with contextlib.suppress(OSError):  # the reader reports why a file cannot be opened
        check_seal(path)
    wanted = {name: tuple(names) for name, names in (only or {}).items()}
    names = None if groups is None else list(groups)
    read = _groups_of if is_fresh(path) else _groups_in_child
    return read(path, names, optional=optional, only=wanted, most=most)


def _groups_of(
    path: Path,
    groups: list[str | None] | None,
    *,
    optional: bool,
    only: Mapping[str, Collection[str]],
    most: float,
) -> dict[str | None, xr.Dataset]:
    datasets = {}
    with _whole(path) as file:
        there = list(file.groups)
        for name in [None, *there] if groups is None else groups:
            group = ("run" if "run" in there else None) if name == "run?" else name
            if group is not None and group not in there:
                if optional:
                    continue
                raise ReadError(
                    f"{path}: there is no group '{shown(group)}'; there are "
                    f"{', '.join(there) or 'none'}"
                )
            stored = file if group is None else file[group]
            if sum(variable.size for variable in stored.variables.values()) <= most:
                datasets[name] = _group(file, group, only.get(name or ""))
    return datasets


_groups_in_child = isolated("netCDF4", "h5py", "xarray")(_groups_of)


@contextlib.contextmanager
def _whole(path: Path) -> Iterator[netCDF4.Dataset]:
    """Open a netCDF file for reading; any error of the library is reported as damage."""
    # imported late: netCDF4 loads slowly
    import netCDF4

    with report_damage(path, "netCDF file"):
        with _LIBRARY, _plain_name(path) as plain, netCDF4.Dataset(plain) as opened:
            yield opened


def _loaded(data: xr.Dataset) -> xr.Dataset:
    """Return a dataset with loaded values, long ones in scratch files."""
    for name, variable in list(data.data_vars.items()):
        if variable.ndim == 1 and variable.dtype.kind in "fiu" and is_long(variable.size):
            values = room(variable.size, variable.dtype)
            for first, last in pieces(0, variable.size):
                values[first:last] = variable.variable[first:last].values
            data[name] = variable.variable.copy(data=values)
    return data.load()


def _group(file: netCDF4.Dataset, group: str | None, only: Collection[str] | None) -> xr.Dataset:
    plain = read_plain(file if group is None else file[group], only)
    if plain is not None:
        return plain
    store = xr.backends.NetCDF4DataStore(file, group=group)
    for variable in (file if group is None else file[group]).variables.values():
        if is_long(variable.size):  # by default much of it is cached until the file is closed
            variable.set_var_chunk_cache(_CACHE)
    data = xr.open_dataset(store, decode_times=False, mask_and_scale=False)
    if only is not None:
        data = data[[name for name in data.data_vars if name in only]]
    data = _loaded(data)
    data.attrs = decoded(data.attrs)
    for name in data.variables:
        data[name].attrs = decoded(data[name].attrs)
        data[name].encoding = {}
    data.encoding = {}
    data.set_close(None)  # the data are in memory; an open file could not go to another process
    return data
