"""Data files that the running command wrote itself, which need no isolation when read back.

Results are written to ``new/data`` in a staging folder, while the command locks the file
``<folder>.lock``. Files of earlier results are linked into it, and so have two names; if links are
unsupported, they are copied, and are older than the lock.
"""

from __future__ import annotations

import contextlib
import fcntl
from pathlib import Path


def lock_of(room: Path) -> Path:
    """Return the lock file of a staging folder."""
    return room.with_name(f"{room.name}.lock")


def is_locked(room: Path) -> bool:
    """Whether the command that writes to a staging folder is running."""
    try:
        with lock_of(room).open("rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


def is_fresh(path: Path) -> bool:
    """Whether a file was written by a command that is still running."""
    with contextlib.suppress(OSError, IndexError, ValueError):
        state, room = path.stat(), path.absolute().parents[2]
        alone = state.st_nlink == 1 and not path.is_symlink()
        return alone and state.st_mtime_ns >= lock_of(room).stat().st_mtime_ns and is_locked(room)
    return False
