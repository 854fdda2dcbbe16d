"""Short groups of data files, kept by each process: what many look at is read but once.

A fit, its figures and what the page shows of it look at the same few thousand numbers. To open a
netCDF file costs as much as to read a hundred of its variables.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.reading.netcdf.netcdf import read_netcdf, read_short

if TYPE_CHECKING:
    import xarray as xr

SHORT = 1 << 16  # values of a group that is kept
_MOST = 1 << 22  # values of all that a process keeps


class KeptReading:
    """Short groups of the files that were asked for last."""

    def __init__(self) -> None:
        self._files: OrderedDict[tuple[str, int, int, int], dict[str | None, xr.Dataset]]
        self._files = OrderedDict()
        self._values = 0
        self._lock = threading.Lock()

    def groups(self, path: Path) -> dict[str | None, xr.Dataset]:
        """Return the short groups of a file as it is now."""
        state = path.stat()
        identity = (str(path.absolute()), state.st_size, state.st_mtime_ns, state.st_ino)
        with self._lock:
            if identity not in self._files:
                self._files[identity] = read_short(path, SHORT)
                self._values += _size(self._files[identity])
            self._files.move_to_end(identity)
            while self._values > _MOST and len(self._files) > 1:
                self._values -= _size(self._files.popitem(last=False)[1])
            return self._files[identity]


def _size(groups: dict[str | None, xr.Dataset]) -> int:
    return sum(array.size for data in groups.values() for array in data.variables.values())


_KEPT = KeptReading()


def read_kept(path: str | Path, group: str | None = None) -> xr.Dataset:
    """Read a dataset as `read_netcdf` does, from what this process keeps if the file is the same.

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
        As `read_netcdf`.
    """
    path = Path(path)
    data = _KEPT.groups(path).get(group) if path.is_file() else None
    return read_netcdf(path, group) if data is None else data.copy(deep=True)
