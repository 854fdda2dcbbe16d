"""Scratch files and folders, and removal of those of killed processes."""

from __future__ import annotations

import atexit
import contextlib
import functools
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from tribolab.core.errors import OutputError, brief


def scratch_place() -> str:
    """Return the scratch folder, after removing the remnants of killed processes."""
    folder = os.environ.get("TMPDIR") or ("/var/tmp" if Path("/var/tmp").is_dir() else "")
    _sweep(folder or tempfile.gettempdir())
    return folder or tempfile.gettempdir()


def scratch_folder() -> Path:
    """Return a new folder that is removed when this process ends, or later if it is killed.

    The folder is in ``TMPDIR``, else in ``/var/tmp``, which is always on a disk.
    """
    with scratch_errors():
        folder = Path(tempfile.mkdtemp(prefix=f"tribolab-{os.getpid()}-", dir=scratch_place()))
    _FOLDERS.append(folder)
    return folder


def scratch_copy(path: Path, content: bytes) -> Path:
    """Write `content` to a scratch file with the name of `path`, and return its path."""
    copy = scratch_folder() / path.name
    with scratch_errors():
        copy.write_bytes(content)
    return copy


@contextlib.contextmanager
def scratch_errors() -> Iterator[None]:
    """Report write errors of scratch files, which are unrelated to the file being read.

    Raises
    ------
    OutputError
        Instead of an `OSError`.
    """
    try:
        yield
    except OSError as error:
        raise OutputError(
            f"scratch files cannot be written in {scratch_place()} ({brief(error)}); make room "
            "there, or set TMPDIR to another folder"
        ) from error


def remove_scratch() -> None:
    """Remove the scratch folders of this process."""
    while _FOLDERS:
        shutil.rmtree(_FOLDERS.pop(), ignore_errors=True)


_FOLDERS: list[Path] = []
atexit.register(remove_scratch)


@functools.lru_cache(maxsize=4)
def _sweep(folder: str) -> None:
    """Remove scratch files and folders of processes that ended."""
    for path in Path(folder).glob("tribolab-[0-9]*-*"):
        number = path.name.split("-")[1]
        if not number.isdigit() or _is_alive(int(number)):
            continue
        with contextlib.suppress(OSError):
            if path.stat(follow_symlinks=False).st_uid != getattr(os, "getuid", int)():
                continue
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink()


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True
