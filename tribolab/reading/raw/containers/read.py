"""Selection of the reader for a container format."""

from __future__ import annotations

import importlib
from pathlib import Path

from tribolab.core.errors import ReadError
from tribolab.reading.raw import limits
from tribolab.reading.raw.model import RawFile

# module and function of each reader; their imports are slow
_READERS = {
    "hdf5": ("hdf5", "read_hdf5"),
    "netcdf": ("hdf5", "read_hdf5"),  # netCDF-4 files begin like HDF5
    "mat": ("mat", "read_mat"),
    "tdms": ("tdms", "read_tdms"),
    "npz": ("npz", "read_npz"),
    "parquet": ("arrow", "read_arrow"),
    "feather": ("arrow", "read_arrow"),
    "json": ("json_tables", "read_json"),
    "declared records": ("declared_records", "read_declared_records"),
}
CONTAINERS = frozenset(_READERS)


def read_container(path: Path, form: str) -> RawFile:
    """Read the tables and settings of a container that names its columns.

    Parameters
    ----------
    path
        The file.
    form
        One of `CONTAINERS`.

    Raises
    ------
    ReadError
        If the file is damaged or has too many columns; libraries may raise other errors.
    ImportError
        If the library for it is not installed.
    """
    module, function = _READERS[form]
    reader = importlib.import_module(f"tribolab.reading.raw.containers.{module}")
    file: RawFile = getattr(reader, function)(path)
    count = sum(len(table.columns) for table in file.tables)
    if count > limits.COLUMNS.value:
        raise ReadError(
            f"{count} columns are more than a measurement has ({limits.COLUMNS.value:.0f})",
            where=path,
            cure="save those of the run in a file of their own",
        )
    return file
