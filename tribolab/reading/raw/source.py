"""Sources are regular files, and their checksum describes the bytes that were analysed."""

from __future__ import annotations

import contextlib
import stat
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple, TypeVar

from tribolab.core.errors import ReadError
from tribolab.core.provenance import sha256_of_file
from tribolab.reading.raw import limits

R = TypeVar("R")


def check_regular(path: Path) -> None:
    """Refuse what is not a file with content: a folder, a pipe, a socket, a device.

    Opening a pipe waits for whoever writes into it, and a device such as ``/dev/zero`` never ends.

    Raises
    ------
    ReadError
        If it is none, or there is no such file.
    """
    try:
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError) as error:
        raise ReadError(f"{path}: there is no such file") from error
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        raise ReadError(f"{path}: the file cannot be opened: {error}") from error
    if stat.S_ISDIR(mode):
        raise ReadError(f"{path}: this is a folder, not a file; name the file itself")
    if not stat.S_ISREG(mode):
        raise ReadError(
            f"{path}: this is not a regular file (a pipe, socket or device); write its content to "
            "a file, and name that"
        )


class Identity(NamedTuple):
    """What tells one state of a file at rest from another: its size, times [ns] and place."""

    size: int
    written: int
    changed: int
    inode: int


def identity_of(path: Path) -> Identity | None:
    """Return the identity of a file; None if it may be written to, or is none."""
    with contextlib.suppress(OSError, ValueError):
        now = path.stat()
        age = time.time() - max(now.st_mtime, now.st_ctime)
        if stat.S_ISREG(now.st_mode) and age > limits.SURELY_OLD.value:
            return Identity(now.st_size, now.st_mtime_ns, now.st_ctime_ns, now.st_ino)
    return None


class _State(NamedTuple):
    """What shows that a file was written to: its size, times [ns], place and checksum."""

    size: int
    written: int
    changed: int
    inode: int
    sha256: str


def read_unchanged(paths: Iterable[Path], read: Callable[[], R]) -> R:
    """Return what a function reads from files, if they stay as they are while it reads.

    A run that is still measured, or a file that is still copied, gives numbers of one state and the
    checksum of another. Such files are read again, and refused if they do not come to rest.

    Parameters
    ----------
    paths
        All files that are read.
    read
        Reads them.

    Raises
    ------
    ReadError
        If a file changes each time that it is read; what `read` raises, of files at rest.
    """
    paths = list(paths)
    for _ in range(int(limits.READINGS.value)):
        before = [_state(path) for path in paths]
        result, failure = None, None
        try:
            result = read()
        except Exception as error:  # raised below, unless it comes of the change
            failure = error
        after = [_state(path) for path in paths]
        if failure is not None and (before == after or None in after):
            raise failure
        if before == after:
            return result  # type: ignore[return-value]
    path, first, last = next(
        each for each in zip(paths, before, after, strict=True) if each[1] != each[2]
    )
    how = f"from {first.size} to {last.size} bytes" if first and last else "it was replaced"
    if first and last and first.size == last.size:
        how = f"{last.size} bytes long before and after"
    raise ReadError(
        f"the file changes while it is read ({how}), so no checksum describes what is analysed",
        where=path,
        cure="wait until the instrument or the copy is done with it, and read it again",
    )


def _state(path: Path) -> _State | None:
    """Return the state of a file; None if there is none.

    The checksum tells what the times cannot: file systems and networks note them late and coarsely.
    Of a file that has long been at rest they are enough.
    """
    with contextlib.suppress(OSError, ValueError):
        now = path.stat()
        if not stat.S_ISREG(now.st_mode):
            return None
        age = time.time() - max(now.st_mtime, now.st_ctime)
        sha256 = sha256_of_file(path) if age < limits.AT_REST.value else ""
        return _State(now.st_size, now.st_mtime_ns, now.st_ctime_ns, now.st_ino, sha256)
    return None
