"""Data files of the results: written whole or not at all, read, and told by their content."""

from __future__ import annotations

import errno
import hashlib
import os
import shutil
import uuid
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.errors import OutputError, ReadError, TribolabError, brief

if TYPE_CHECKING:
    import xarray as xr

UNFINISHED = ".part"
_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO)
_LITTLE = 1 << 20


def write_data(groups: Mapping[str | None, xr.Dataset], path: Path) -> None:
    """Write a data file, whole or not at all.

    A scheduler may repeat work whose worker died after it was done: readers of the file then go
    on with the old one until the new one, of the same content, is complete.

    Parameters
    ----------
    groups
        By the names of their groups; None is the root.
    path
        The file.

    Raises
    ------
    OutputError
        If there is no room, or the folder is gone.
    """
    # late: starting stays quick
    from tribolab.io.netcdf import write_groups

    part = path.with_name(f"{path.stem}.{uuid.uuid4().hex}{UNFINISHED}")
    try:
        write_groups(groups, part)
        part.replace(path)
    except (OSError, RuntimeError, TribolabError) as error:
        # a full disk reaches Python as ENOSPC, or as the HDF5 library's "HDF error"
        full = shutil.disk_usage(path.parent).free < _LITTLE if path.parent.is_dir() else False
        cause = error.__cause__ if isinstance(error, TribolabError) else error
        number = errno.ENOSPC if full else getattr(cause, "errno", None)
        part.unlink(missing_ok=True)
        if number == errno.ENOSPC:
            raise OutputError(
                f"{path.name}: the disk is full; make room or choose another folder with --output"
            ) from error
        if number in _NO_ROOM or not path.parent.is_dir():
            raise OutputError(f"{path.name}: cannot be written ({brief(error)})") from error
        raise


def read_data(path: Path, group: str | None = None) -> xr.Dataset:
    """Open a data file of a campaign, or one group of it."""
    # late: starting stays quick
    from tribolab.io.kept import read_kept

    return read_kept(path, group)


def optional_data(path: Path, group: str) -> xr.Dataset | None:
    """Open a group that a data file may lack."""
    try:
        return read_data(path, group)
    except ReadError:
        return None


def link(old: Path, new: Path) -> None:
    """Have a data file of earlier results in the new folder, too.

    Raises
    ------
    FileNotFoundError
        If it is not there (any more).
    """
    new.unlink(missing_ok=True)
    try:
        os.link(old, new)
    except FileNotFoundError:
        raise
    except OSError:  # a file system without hard links
        shutil.copy2(old, new)


def digest(*parts: xr.Dataset | None) -> str:
    """Return the checksum of datasets' names and values; when they were made does not matter."""
    checksum = hashlib.sha256()
    for data in parts:
        if data is None:
            checksum.update(b"none")
            continue
        checksum.update(b"data")
        for name in sorted(map(str, data.variables)):
            checksum.update(name.encode())
            values = np.asarray(data[name])
            text = values.dtype.kind in "OUS"
            checksum.update(str(values.tolist()).encode() if text else values.tobytes())
    return checksum.hexdigest()
