"""Long arrays in scratch files, for records that exceed the memory.

An array of `LONG` samples or more is stored in an unnamed file, which is deleted with the last
array that uses it, even if the process is killed. The system loads its pages when they are read;
`let_go` releases them for now without losing their content.

Notes
-----
The files are in ``TMPDIR`` or else in ``/var/tmp``, which unlike ``/tmp`` is always on a disk.
Without disk space, or on systems without memory mapping, arrays are in memory.
"""

from __future__ import annotations

import gc
import mmap
import os
import tempfile
import weakref
from pathlib import Path

import numpy as np

LONG = 1 << 24  # samples of a long array; shorter ones take at most 128 MB
_mapped: weakref.WeakSet[mmap.mmap] = weakref.WeakSet()


def room(
    count: int, kind: type[np.generic] | np.dtype = np.float64, of: int | None = None
) -> np.ndarray:
    """Return an empty array, in memory or, if it is long, in a scratch file.

    Parameters
    ----------
    count
        Samples.
    kind
        Type of each sample.
    of
        Samples of the whole record, if the array is a part of it.

    Examples
    --------
    >>> room(3, np.int8).shape
    (3,)
    """
    if count and is_long(max(count, of or 0)):
        mapped = _scratch(count * np.dtype(kind).itemsize)
        if mapped is not None:
            return np.frombuffer(mapped, kind, count)
    return np.empty(count, kind)


def is_long(count: int) -> bool:
    """Return whether an array with so many samples is stored in a scratch file."""
    return count >= LONG


def filled(count: int, value: float, kind: type[np.generic] = np.float64) -> np.ndarray:
    """Return an array filled with one value, stored as by `room`.

    Examples
    --------
    >>> filled(3, 2, np.int8)
    array([2, 2, 2], dtype=int8)
    """
    result = room(count, kind)
    for first in range(0, count, LONG):
        result[first : first + LONG] = value
        let_go()
    return result


def take_in(mapped: mmap.mmap) -> None:
    """Register a shared mapping of an unnamed file as a scratch file."""
    _mapped.add(mapped)


def let_go() -> None:
    """Free the memory of long arrays; their files are read again when needed."""
    if not _mapped:  # called after every piece of every run, mostly without any scratch file
        return
    for mapped in list(_mapped):
        mapped.madvise(mmap.MADV_DONTNEED)


def tidy_up() -> None:
    """Delete scratch files of unused arrays, including arrays that only refer to each other."""
    if _mapped:
        gc.collect()
        let_go()


def _scratch(size: int) -> mmap.mmap | None:
    if not hasattr(os, "posix_fallocate") or not hasattr(mmap, "MADV_DONTNEED"):
        return None
    try:
        with tempfile.TemporaryFile(dir=_folder()) as file:
            # allocate now, so that a full disk is an error here and not a crash in a calculation
            os.posix_fallocate(file.fileno(), 0, size)
            mapped = mmap.mmap(file.fileno(), size)
    except OSError:
        return None
    _mapped.add(mapped)
    return mapped


def _folder() -> str | None:
    lasting = Path("/var/tmp")
    own = "TMPDIR" in os.environ or not os.access(lasting, os.W_OK)
    return None if own else str(lasting)
