"""Writing, reading and linking of data files, and checksums of their content."""

from __future__ import annotations

import errno
import hashlib
import os
import resource
import shutil
import uuid
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.core.errors import OutputError, ReadError, TribolabError, brief

if TYPE_CHECKING:
    import xarray as xr

UNFINISHED = ".part"
_MIN_SIZE = 1 << 20
CURES = {
    errno.ENOSPC: "the disk is full; make room or choose another folder with --output",
    errno.EDQUOT: "the disk quota is used up; make room or choose another folder with --output",
    errno.EACCES: "no permission to write here; choose another folder with --output",
    errno.EPERM: "no permission to write here; choose another folder with --output",
    errno.EROFS: "the file system is read-only; choose another folder with --output",
    errno.EFBIG: "the file is larger than the file system or a limit (ulimit -f) allows; choose "
    "another folder with --output",
    errno.EIO: "the disk reports an error; choose another folder with --output",
    errno.ENODEV: "the disk was removed; connect it again or choose another folder with --output",
    errno.ENXIO: "the disk was removed; connect it again or choose another folder with --output",
    errno.ESTALE: "the file server has lost this folder; mount it again",
    errno.ETIMEDOUT: "the file server does not answer; try again later",
    errno.EHOSTUNREACH: "the file server cannot be reached; try again later",
    errno.EMFILE: "too many files are open (ulimit -n); use fewer processes with --jobs",
    errno.ENFILE: "too many files are open on this machine; try again later",
    errno.ENAMETOOLONG: "a name that is too long; choose a shorter one with --output",
    errno.ELOOP: "a symbolic link that leads to itself; choose another folder with --output",
}


def write_data(groups: Mapping[str | None, xr.Dataset], path: Path) -> None:
    """Write a data file completely or not at all.

    A scheduler may repeat finished work whose worker died. Readers then see the old file until the
    new one, with the same content, is complete.

    Parameters
    ----------
    groups
        Datasets by name of the group; None is the root.
    path
        Path of the file.

    Raises
    ------
    OutputError
        If the disk is full, or the folder is missing.
    """
    from tribolab.reading.netcdf.netcdf import write_groups  # imported late for a quick start

    part = path.with_name(f"{path.stem}.{uuid.uuid4().hex}{UNFINISHED}")
    try:
        write_groups(groups, part)
        part.replace(path)
    except (OSError, RuntimeError, TribolabError) as error:
        number = _number_of(error, groups, path.parent)
        part.unlink(missing_ok=True)
        if number in CURES:
            raise OutputError(f"{path.name}: {CURES[number]}") from error
        if not path.parent.is_dir():
            raise OutputError(f"{path.name}: cannot be written ({brief(error)})") from error
        raise


def _number_of(
    error: Exception, groups: Mapping[str | None, xr.Dataset], folder: Path
) -> int | None:
    """Return the errno of a failed write; the HDF5 library hides it in its "HDF error"."""
    cause = error.__cause__ if isinstance(error, TribolabError) else error
    number = getattr(cause, "errno", None)
    if folder.is_dir() and shutil.disk_usage(folder).free < _MIN_SIZE:
        return errno.ENOSPC
    largest, _ = resource.getrlimit(resource.RLIMIT_FSIZE)
    if largest != resource.RLIM_INFINITY and sum(g.nbytes for g in groups.values()) > largest:
        return number or errno.EFBIG
    return number


def read_data(path: Path, group: str | None = None) -> xr.Dataset:
    """Open a data file of a campaign, or one group of it."""
    from tribolab.reading.netcdf.cache import read_kept  # imported late for a quick start

    return read_kept(path, group)


def optional_data(path: Path, group: str) -> xr.Dataset | None:
    """Open a group that a data file may lack."""
    try:
        return read_data(path, group)
    except ReadError:
        return None


def link(old: Path, new: Path) -> None:
    """Link a data file of earlier results into the new folder; copy it if links are unsupported.

    Raises
    ------
    FileNotFoundError
        If it does not exist.
    """
    new.unlink(missing_ok=True)
    try:
        os.link(old, new)
    except FileNotFoundError:
        raise
    except OSError:  # a file system without hard links
        shutil.copy2(old, new)


def digest(*parts: xr.Dataset | None) -> str:
    """Return the checksum of the names and values of datasets, ignoring attributes."""
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
