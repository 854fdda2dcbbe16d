"""Named arrays in files of NumPy (npz, npy), MATLAB, HDF5 and netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError, brief
from tribolab.core.untyped import Json
from tribolab.reading.raw.containers.groups import plain
from tribolab.reading.raw.containers.mat import read_variables
from tribolab.reading.raw.opening import isolated
from tribolab.reading.raw.unpacked import ZIP, ZIP_DAMAGE, has_arrays

NPY = b"\x93NUMPY"
_HDF5 = b"\x89HDF\r\n\x1a\n"
_NETCDF = (b"CDF\x01", b"CDF\x02")
_MATLAB = (b"MATLAB 5.0", b"MATLAB 7.3")
_MAX_ARRAYS = 200  # most arrays of a file


class NamedArray(NamedTuple):
    """Array of numbers with its attributes in the file."""

    name: str
    values: np.ndarray
    attrs: Json


def is_of_arrays(path: Path, head: bytes) -> bool:
    """Whether a file has a format with named arrays."""
    marks = (NPY, _HDF5, *_NETCDF, *_MATLAB)
    return head.startswith(marks) or (head.startswith(ZIP) and has_arrays(path))


def read_arrays(path: Path) -> list[NamedArray]:
    """Read all arrays of numbers in a file, with their attributes.

    Raises
    ------
    ReadError
        If the file is damaged.
    """
    with path.open("rb") as file:
        head = file.read(16)
    if head.startswith(b"MATLAB 5.0"):
        return _of_mat(path)
    reader = _of_numpy
    if head.startswith(_NETCDF):
        reader = _of_netcdf
    elif head.startswith((_HDF5, b"MATLAB 7.3")):
        reader = _of_hdf5
    try:
        return reader(path)
    except (KeyError, TypeError, MemoryError, *ZIP_DAMAGE) as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(f"{path}: the file is damaged: {brief(error)}; save it again") from error


@isolated()
def _of_numpy(path: Path) -> list[NamedArray]:
    with path.open("rb") as file:
        alone = file.read(len(NPY)) == NPY
    stored: list[NamedArray] = []
    loaded = np.load(path, allow_pickle=False)
    if alone:
        _take(stored, path.stem, loaded, {})
        return stored
    with loaded as archive:
        for name in archive.files[:_MAX_ARRAYS]:
            try:
                _take(stored, name, archive[name], {})
            except ValueError:  # Python objects, which contain no measurement
                continue
    return stored


def _of_mat(path: Path) -> list[NamedArray]:
    stored: list[NamedArray] = []
    for variable in read_variables(path):
        if (numbers := variable.numbers) is not None:
            _take(stored, variable.name, numbers.ravel() if 1 in numbers.shape else numbers, {})
    return stored


@isolated("scipy.io")
def _of_netcdf(path: Path) -> list[NamedArray]:
    # imported late: SciPy loads slowly
    from scipy.io import netcdf_file

    stored: list[NamedArray] = []
    with netcdf_file(path, "r", mmap=False, maskandscale=False) as file:
        _take(stored, "", np.empty(0), _plain_attributes(file))
        for name, variable in file.variables.items():
            _take(stored, name, np.array(variable.data), _plain_attributes(variable))
    return stored


def _plain_attributes(owner: object) -> Json:
    return {key: plain(value) for key, value in vars(owner)["_attributes"].items()}


@isolated("h5py")
def _of_hdf5(path: Path) -> list[NamedArray]:
    # imported late: h5py loads slowly
    import h5py

    stored: list[NamedArray] = []

    def visit(name: str, item: object) -> None:
        attrs = {str(k): plain(v) for k, v in getattr(item, "attrs", {}).items()}
        if not isinstance(item, h5py.Dataset):
            _take(stored, name, np.empty(0), attrs)
            return
        if item.shape is None or len(stored) >= _MAX_ARRAYS or item.dtype.kind not in "fiub":
            return
        if attrs.get("MATLAB_class") != "char":
            values = np.asarray(item[()])
            if "MATLAB_class" in attrs:  # columns in MATLAB are rows in HDF5
                values = values.T
                values = values.ravel() if values.ndim == 2 and 1 in values.shape else values
            _take(stored, name, values, attrs)

    with h5py.File(path, "r") as file:
        visit("", file)
        file.visititems(visit)
    return stored


def _take(stored: list[NamedArray], name: str, values: np.ndarray, attrs: Json) -> None:
    """Append an array of numbers to `stored`, or each numeric attribute of a group."""
    if values.dtype.kind in "fiub" and values.size:
        own = np.squeeze(values) if values.ndim > 2 or values.size == 1 else values
        stored.append(NamedArray(name, own, attrs))
    elif not values.size:
        for key, value in attrs.items():
            if isinstance(value, int | float):
                full = f"{name}/{key}" if name else key
                stored.append(NamedArray(full, np.asarray(value, dtype=float), {}))
