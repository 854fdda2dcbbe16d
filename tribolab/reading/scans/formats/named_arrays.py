"""Named arrays in files of NumPy (npz, npy), MATLAB, HDF5 and netCDF."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError, brief
from tribolab.core.untyped import Json
from tribolab.reading.raw.containers.mat import read_variables
from tribolab.reading.raw.containers.settings import plain
from tribolab.reading.raw.opening import isolated
from tribolab.reading.raw.zip_safety import ZIP_DAMAGE

NPY = b"\x93NUMPY"
_HDF5 = b"\x89HDF\r\n\x1a\n"
_NETCDF = (b"CDF\x01", b"CDF\x02")
_MATLAB = (b"MATLAB 5.0", b"MATLAB 7.3")
_MAX_TEXT = 500  # most characters of a text
_MAX_ARRAYS = 200  # most arrays of a file


class NamedArray(NamedTuple):
    """Array of numbers with its attributes in the file."""

    name: str
    values: np.ndarray
    attrs: Json


class NamedArrays(NamedTuple):
    """Arrays, and texts by name."""

    arrays: list[NamedArray]
    texts: dict[str, str]


def is_npz(path: Path) -> bool:
    """Whether a zip archive is a NumPy archive."""
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except ZIP_DAMAGE:
        return False
    return bool(names) and all(name.endswith(".npy") for name in names)


def has_arrays(path: Path, head: bytes) -> bool:
    """Whether a file has a format with named arrays."""
    marks = (NPY, _HDF5, *_NETCDF, *_MATLAB)
    return head.startswith(marks) or (head.startswith(b"PK\x03\x04") and is_npz(path))


def read_arrays(path: Path) -> NamedArrays:
    """Read all arrays of numbers of a file, and its texts.

    Raises
    ------
    ReadError
        If it is damaged.
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
def _of_numpy(path: Path) -> NamedArrays:
    with path.open("rb") as file:
        alone = file.read(len(NPY)) == NPY
    stored = NamedArrays([], {})
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


def _of_mat(path: Path) -> NamedArrays:
    variables = read_variables(path)
    stored = NamedArrays([], {v.name: v.texts[0][:_MAX_TEXT] for v in variables if v.texts})
    for variable in variables:
        if variable.numbers is not None:
            numbers = variable.numbers
            _take(stored, variable.name, numbers.ravel() if 1 in numbers.shape else numbers, {})
    return stored


@isolated("scipy.io")
def _of_netcdf(path: Path) -> NamedArrays:
    # imported late: SciPy loads slowly
    from scipy.io import netcdf_file

    stored = NamedArrays([], {})
    with netcdf_file(path, "r", mmap=False, maskandscale=False) as file:
        _add_attributes(stored, "", {k: plain(v) for k, v in vars(file)["_attributes"].items()})
        for name, variable in file.variables.items():
            attrs = {k: plain(v) for k, v in vars(variable)["_attributes"].items()}
            _take(stored, name, np.array(variable.data), attrs)
    return stored


@isolated("h5py")
def _of_hdf5(path: Path) -> NamedArrays:
    # imported late: h5py loads slowly
    import h5py

    stored = NamedArrays([], {})

    def visit(name: str, item: object) -> None:
        attrs = {str(k): plain(v) for k, v in getattr(item, "attrs", {}).items()}
        if not isinstance(item, h5py.Dataset):
            _add_attributes(stored, name, attrs)
            return
        if item.shape is None or len(stored.arrays) >= _MAX_ARRAYS or item.dtype.names:
            return
        if attrs.get("MATLAB_class") == "char":
            stored.texts[name] = "".join(map(chr, np.ravel(item[()])[:_MAX_TEXT].tolist()))
        elif item.dtype.kind in "OSU":
            if item.size == 1:
                stored.texts[name] = str(plain(item[()]))[:_MAX_TEXT]
        else:
            values = np.asarray(item[()])
            if "MATLAB_class" in attrs:  # columns in MATLAB are rows in HDF5
                values = values.T
                values = values.ravel() if values.ndim == 2 and 1 in values.shape else values
            _take(stored, name, values, attrs)

    with h5py.File(path, "r") as file:
        visit("", file)
        file.visititems(visit)
    return stored


def _take(stored: NamedArrays, name: str, values: np.ndarray, attrs: Json) -> None:
    if values.dtype.kind in "SU" and values.size == 1:
        stored.texts[name] = str(plain(values))[:_MAX_TEXT]
    elif values.dtype.kind in "fiub" and values.size:
        own = np.squeeze(values) if values.ndim > 2 or values.size == 1 else values
        stored.arrays.append(NamedArray(name, own, attrs))
    for key, value in attrs.items():
        if isinstance(value, str):
            stored.texts[f"{name}.{key}"] = value


def _add_attributes(stored: NamedArrays, name: str, attrs: Json) -> None:
    """Store the attributes of a group like its members."""
    for key, value in attrs.items():
        full = f"{name}/{key}" if name else key
        if isinstance(value, str):
            stored.texts[full] = value[:_MAX_TEXT]
        elif isinstance(value, int | float):
            stored.arrays.append(NamedArray(full, np.asarray(value, dtype=float), {}))
