"""Room for long arrays: of a record that is too long for the memory, they lie in a scratch file.

An array of `LONG` samples or more is the content of a file without a name, which vanishes with the
last array on it, however the process ends. The system brings its pages into the memory as they are
looked at; `let_go` says that they are not needed just now. What is in them stays.

Notes
-----
The files lie where ``TMPDIR`` says, else in ``/var/tmp``, which unlike ``/tmp`` is on a disk
everywhere. Where there is no room for them, or no such system call, arrays are in memory as ever.
"""

from __future__ import annotations

import gc
import mmap
import os
import tempfile
import weakref
from pathlib import Path

import numpy as np

LONG = 1 << 24  # samples; a signal of fewer takes 128 MB at most
_mapped: weakref.WeakSet[mmap.mmap] = weakref.WeakSet()


def room(
    count: int, kind: type[np.generic] | np.dtype = np.float64, of: int | None = None
) -> np.ndarray:
    """Return an array to be filled: in memory, or, if it is long, in a scratch file.

    Parameters
    ----------
    count
        Samples.
    kind
        Of each.
    of
        Samples of the record, if the array is a part of it.

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
    """Whether an array of so many samples is to lie in a scratch file."""
    return count >= LONG


def filled(count: int, value: float, kind: type[np.generic] = np.float64) -> np.ndarray:
    """Return an array with one value, as `room`.

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
    """Have a shared mapping of a nameless file treated as the scratch files of this module."""
    _mapped.add(mapped)


def let_go() -> None:
    """Give back the memory that looking at long arrays took; they are read again when needed."""
    if not _mapped:  # said behind every piece of every run: mostly there is nothing
        return
    for mapped in list(_mapped):
        mapped.madvise(mmap.MADV_DONTNEED)


def tidy_up() -> None:
    """Free the scratch files of arrays that nobody needs any more, circles of references or not."""
    if _mapped:
        gc.collect()
        let_go()


def _scratch(size: int) -> mmap.mmap | None:
    if not hasattr(os, "posix_fallocate") or not hasattr(mmap, "MADV_DONTNEED"):
        return None
    try:
        with tempfile.TemporaryFile(dir=_folder()) as file:
            # a disk that is full says so now, and not by a signal in the midst of a loop
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
