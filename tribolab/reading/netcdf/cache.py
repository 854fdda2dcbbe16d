"""Cache of short groups of data files in each process.

A fit, its figures and the page use the same few thousand numbers, and opening a netCDF file takes
as long as reading a hundred of its variables.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.reading.netcdf.netcdf import read_groups, read_netcdf

if TYPE_CHECKING:
    import xarray as xr

SHORT = 1 << 16  # most values of a cached group
_MAX_CACHED = 1 << 22  # most values cached by a process


class KeptReading:
    """Cache of the short groups of recently read files."""

    def __init__(self) -> None:
        self._files: OrderedDict[tuple[str, int, int, int], dict[str | None, xr.Dataset]]
        self._files = OrderedDict()
        self._values = 0
        self._lock = threading.Lock()

    def groups(self, path: Path) -> dict[str | None, xr.Dataset]:
        """Return the short groups of a file in its present state."""
        state = path.stat()
        identity = (str(path.absolute()), state.st_size, state.st_mtime_ns, state.st_ino)
        with self._lock:
            if identity not in self._files:
                self._files[identity] = read_groups(path, most=SHORT)
                self._values += _size(self._files[identity])
            self._files.move_to_end(identity)
            while self._values > _MAX_CACHED and len(self._files) > 1:
                self._values -= _size(self._files.popitem(last=False)[1])
            return self._files[identity]


def _size(groups: dict[str | None, xr.Dataset]) -> int:
    return sum(array.size for data in groups.values() for array in data.variables.values())


_KEPT = KeptReading()


def read_kept(path: str | Path, group: str | None = None) -> xr.Dataset:
    """Read a dataset like `read_netcdf`, from the cache if the file is unchanged.

    Parameters
    ----------
    path
        The file.
    group
        Group in the file.

    Returns
    -------
    xarray.Dataset
        A copy that may be changed.

    Raises
    ------
    ReadError
        As for `read_netcdf`.
    """
    path = Path(path)
    data = _KEPT.groups(path).get(group) if path.is_file() else None
    return read_netcdf(path, group) if data is None else data.copy(deep=True)
