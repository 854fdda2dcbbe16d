"""Checks that sources are regular files, unchanged while they are read."""

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
    """Raise for a folder, pipe, socket or device.

    Opening a pipe waits for a writer, and a device such as ``/dev/zero`` never ends.

    Raises
    ------
    ReadError
        If it is not a regular file, or does not exist.
    """
    try:
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError) as error:
        raise ReadError(f"{path}: there is no such file") from error
    except (OSError, ValueError) as error:  # ValueError: NUL in the path
        raise ReadError(f"{path}: the file cannot be opened: {error}") from error
    if stat.S_ISDIR(mode):
        raise ReadError(f"{path}: this is a folder, not a file; name the file itself")
    if not stat.S_ISREG(mode):
        raise ReadError(
            f"{path}: this is not a regular file (a pipe, socket or device); write its content to "
            "a file, and name that"
        )


class Identity(NamedTuple):
    """State of a file at rest: size, times [ns] and inode."""

    size: int
    written: int
    changed: int
    inode: int


def identity_of(path: Path) -> Identity | None:
    """Return the identity of a file; None if it may still be written, or does not exist."""
    with contextlib.suppress(OSError, ValueError):
        now = path.stat()
        age = time.time() - max(now.st_mtime, now.st_ctime)
        if stat.S_ISREG(now.st_mode) and age > limits.SURELY_OLD.value:
            return Identity(now.st_size, now.st_mtime_ns, now.st_ctime_ns, now.st_ino)
    return None


class _State(NamedTuple):
    """State of a file that reveals writing: size, times [ns], inode and checksum."""

    size: int
    written: int
    changed: int
    inode: int
    sha256: str


def read_unchanged(paths: Iterable[Path], read: Callable[[], R]) -> R:
    """Return the result of a function that reads files, if they do not change meanwhile.

    A file that is still being written could give numbers of one state and the checksum of another.
    Such files are read again, and refused if they keep changing.

    Parameters
    ----------
    paths
        All files that are read.
    read
        Function that reads them.

    Raises
    ------
    ReadError
        If a file changes during every attempt; also any error of `read` on unchanged files.
    """
    paths = list(paths)
    for _ in range(int(limits.READINGS.value)):
        before = [_state(path) for path in paths]
        result, failure = None, None
        try:
            result = read()
        except Exception as error:  # raised below, unless caused by the change
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
    """Return the state of a file; None if it does not exist.

    The checksum is needed because file systems and networks update times late and coarsely. For a
    file that is long at rest the times suffice.
    """
    with contextlib.suppress(OSError, ValueError):
        now = path.stat()
        if not stat.S_ISREG(now.st_mode):
            return None
        age = time.time() - max(now.st_mtime, now.st_ctime)
        sha256 = sha256_of_file(path) if age < limits.AT_REST.value else ""
        return _State(now.st_size, now.st_mtime_ns, now.st_ctime_ns, now.st_ino, sha256)
    return None
