"""Checks that raw files are regular files and do not change while they are read."""

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
    """Size, times [ns] and inode of a file, at least one of which changes if the file does."""

    size: int
    written: int
    changed: int
    inode: int


def identity_of(path: Path) -> Identity | None:
    """Return the identity of a file; None if it may still be written, or does not exist."""
    found = _identity_and_age(path)
    return found[0] if found is not None and found[1] > limits.SURELY_OLD.value else None


def _identity_and_age(path: Path) -> tuple[Identity, float] | None:
    """Return the identity of a regular file, and its age [s]; None for anything else."""
    with contextlib.suppress(OSError, ValueError):
        now = path.stat()
        if stat.S_ISREG(now.st_mode):
            identity = Identity(now.st_size, now.st_mtime_ns, now.st_ctime_ns, now.st_ino)
            return identity, time.time() - max(now.st_mtime, now.st_ctime)
    return None


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
    how = "it was replaced"
    if first and last:
        sizes = first[0].size, last[0].size
        alike = sizes[0] == sizes[1]
        how = (
            f"{sizes[1]} bytes long before and after"
            if alike
            else "from {} to {} bytes".format(*sizes)
        )
    raise ReadError(
        f"the file changes while it is read ({how}), so no checksum describes what is analysed",
        where=path,
        cure="wait until the instrument or the copy is done with it, and read it again",
    )


def _state(path: Path) -> tuple[Identity, str] | None:
    """Return the identity of a file and its checksum; None if it does not exist.

    The checksum is needed because file systems and networks update times late and coarsely. For a
    file that has not changed for long the times suffice.
    """
    with contextlib.suppress(OSError, ValueError):
        if (found := _identity_and_age(path)) is not None:
            identity, age = found
            return identity, sha256_of_file(path) if age < limits.AT_REST.value else ""
    return None
