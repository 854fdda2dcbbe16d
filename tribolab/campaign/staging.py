"""Results appear whole or not at all: written beside their place, then swapped in.

The staging room ``.<name>.tribolab-<random>`` lies beside the output, on the same file system.
It holds ``new`` (what is being written) and, where two folders cannot be exchanged in one step,
for a moment ``old``. The file of the same name that ends in ``.lock`` is locked for as long as
the process lives, whatever ends it: a room whose lock is free is a dead process's.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from tribolab.errors import ConfigError, OutputError

MARKER = ".tribolab-results"
_MARKER_TEXT = "Written by tribolab. The next run replaces this folder as a whole.\n"
_RENAME_EXCHANGE = 2
_AT_FDCWD = -100

_CURES = {
    errno.ENOSPC: "the disk is full; make room or choose another folder with --output",
    errno.EDQUOT: "the disk quota is used up; make room or choose another folder with --output",
    errno.EACCES: "no permission to write here; choose another folder with --output",
    errno.EPERM: "no permission to write here; choose another folder with --output",
    errno.EROFS: "the file system is read-only; choose another folder with --output",
    errno.EIO: "the disk reports an error; choose another folder with --output",
}


@contextlib.contextmanager
def staged(output: str | Path) -> Iterator[Path]:
    """Yield a new, empty folder that takes the place of `output` when the block ends well.

    If the block raises, `output` stays as it was and the new folder is removed. If the process
    is killed, `output` holds either the old or the new results; the next call removes what was
    left behind.

    Parameters
    ----------
    output
        The results folder. It may be absent, empty, or hold results of an earlier run.

    Yields
    ------
    Path
        The folder to write to.

    Raises
    ------
    ConfigError
        If `output` is a file, or a folder with something else than results in it.
    OutputError
        If the folder cannot be written, or the disk is full.

    Notes
    -----
    The swap is one ``renameat2(RENAME_EXCHANGE)`` on Linux file systems that know it. Elsewhere
    it is two renames; a kill between them is mended by the next call.

    Examples
    --------
    >>> import tempfile
    >>> place = Path(tempfile.mkdtemp()) / "results"
    >>> with staged(place) as folder:
    ...     _ = (folder / "answer.txt").write_text("42")
    >>> (place / "answer.txt").read_text()
    '42'
    """
    output = Path(output).resolve()
    recover(output)
    _refuse_foreign(output)
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        lock, room = _locked_room(output)
    except OSError as error:
        raise OutputError(f"{output}: {_cure(error)}") from error
    try:
        (room / "new").mkdir(parents=True)
        yield room / "new"
        (room / "new" / MARKER).write_text(_MARKER_TEXT, encoding="utf-8")
        _swap(room, output)
    except OSError as error:
        if not _is_about(error, room, output):
            raise
        raise OutputError(f"{output}: {_cure(error)}; what was there is untouched") from error
    finally:
        shutil.rmtree(room, ignore_errors=True)
        _lock_of(room).unlink(missing_ok=True)
        lock.close()


def recover(output: str | Path) -> None:
    """Remove what dead processes left beside `output`, and complete a swap that was cut short."""
    output = Path(output).resolve()
    if not output.parent.is_dir():
        return
    for room in sorted(output.parent.glob(f"{_prefix(output)}*")):
        if room.suffix == ".lock" or _alive(room):
            continue
        if not output.exists() and (room / "old").exists():  # killed between the two renames
            complete = room / "new" if (room / "new").exists() else room / "old"
            complete.rename(output)
        shutil.rmtree(room, ignore_errors=True)
    for lock in output.parent.glob(f"{_prefix(output)}*.lock"):
        if not _alive(lock.with_suffix("")):
            lock.unlink(missing_ok=True)


def is_results(folder: Path) -> bool:
    """Whether a folder holds results that this package wrote."""
    return (folder / MARKER).is_file()


def _prefix(output: Path) -> str:
    return f".{output.name}.tribolab-"


def _lock_of(room: Path) -> Path:
    return room.with_name(f"{room.name}.lock")


def _locked_room(output: Path) -> tuple[IO[bytes], Path]:
    """Lock a new name; the lock is made before its room, so that no living room is without."""
    while True:
        handle, name = tempfile.mkstemp(prefix=_prefix(output), suffix=".lock", dir=output.parent)
        lock = os.fdopen(handle, "wb")
        fcntl.flock(lock, fcntl.LOCK_EX)
        if Path(name).exists():  # else somebody tidied it away before it was locked
            return lock, Path(name).with_suffix("")
        lock.close()


def _alive(room: Path) -> bool:
    try:
        with _lock_of(room).open("rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


def _refuse_foreign(output: Path) -> None:
    if not output.exists():
        return
    if not output.is_dir():
        raise ConfigError(f"{output} is a file; results want a folder: choose it with --output")
    inside = sorted(path.name for path in output.iterdir())
    if inside and not is_results(output):
        raise ConfigError(
            f"{output} holds something else than results ({', '.join(inside[:3])}"
            f"{', ...' if len(inside) > 3 else ''}) and would be replaced as a whole; choose "
            "another folder with --output, or empty it"
        )


def _swap(room: Path, output: Path) -> None:
    new = room / "new"
    if not output.exists():
        new.rename(output)
    elif not exchange(new, output):
        output.rename(room / "old")
        new.rename(output)


def exchange(one: Path, other: Path) -> bool:
    """Exchange two paths in one step; False where the system cannot."""
    try:
        renameat2 = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError):
        return False
    failed = renameat2(
        _AT_FDCWD, os.fsencode(one), _AT_FDCWD, os.fsencode(other), ctypes.c_uint(_RENAME_EXCHANGE)
    )
    if not failed:
        return True
    number = ctypes.get_errno()
    if number in (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP):
        return False
    raise OSError(number, os.strerror(number), str(other))


def _is_about(error: OSError, room: Path, output: Path) -> bool:
    """Whether an error is about writing here: about no file at all, or about one of ours."""
    if error.errno not in _CURES:
        return False
    path = None if error.filename is None else Path(str(error.filename))
    return path is None or path.is_relative_to(room) or path.is_relative_to(output)


def _cure(error: OSError) -> str:
    return _CURES.get(error.errno or 0, f"cannot write here ({error.strerror or error})")
