"""Atomic replacement of a results folder: written to a staging folder, then swapped.

The staging folder ``.<name>.tribolab-<random>`` is next to the output, on the same file system, or
inside it if the output cannot be renamed (a mount point, or a parent folder without write access).
It contains ``new`` (the results being written) and, if two folders cannot be exchanged in one
step, temporarily ``old``. The file of the same name with the suffix ``.lock`` is locked while the
process lives; a free lock marks the folder of a dead process.

Files in the output that are not ours are never removed: they are linked into the new folder.
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

from tribolab.campaign.store.catalogue import CATALOGUE
from tribolab.campaign.store.data_files import CURES
from tribolab.campaign.store.ledger import MARKER, Ledger, other_name
from tribolab.core.errors import ConfigError, OutputError
from tribolab.reading.netcdf.fresh import is_locked, lock_of

_RENAME_EXCHANGE = 2
_AT_FDCWD = -100
_READY = "ready"  # marks a swap inside the output that has begun and must be completed


@contextlib.contextmanager
def staged(output: str | Path) -> Iterator[Path]:
    """Yield a new, empty folder that replaces `output` if the block ends without an error.

    If the block raises, `output` is unchanged and the new folder is removed. If the process is
    killed, `output` contains either the old or the new results; the next call removes remnants.
    Files in `output` that we did not write keep their names; those that somebody changed are kept
    under `other_name`.

    Parameters
    ----------
    output
        The results folder. It may be missing, empty, or contain results of an earlier run.

    Yields
    ------
    Path
        The folder to write to.

    Raises
    ------
    ConfigError
        If `output` is a file, or a folder with anything other than results.
    OutputError
        If the folder cannot be written, or the disk is full.

    Notes
    -----
    The swap is one ``renameat2(RENAME_EXCHANGE)`` on Linux file systems that support it. Elsewhere
    it is two renames; the next call repairs an interruption between them. A folder that cannot be
    renamed is swapped entry by entry, with the same guarantee.

    Examples
    --------
    >>> import tempfile
    >>> place = Path(tempfile.mkdtemp()) / "results"
    >>> with staged(place) as folder:
    ...     _ = (folder / "answer.txt").write_text("42")
    >>> (place / "answer.txt").read_text()
    '42'
    """
    output = resolved(output)
    try:
        recover(output)
        _refuse_foreign(output)
        output.parent.mkdir(parents=True, exist_ok=True)
        lock, room = _lock_staging_folder(output)
    except OSError as error:
        raise OutputError(f"{output}: {_cure(error)}") from error
    try:
        (room / "new").mkdir(parents=True)
        yield room / "new"
        ledger = Ledger.read(output)
        ledger.write(room / "new")
        _keep_foreign_files(ledger, room / "new")
        _swap(room, output)
    except OSError as error:
        if not _concerns_writing(error, room, output):
            raise
        raise OutputError(f"{output}: {_cure(error)}; what was there is untouched") from error
    finally:
        shutil.rmtree(room, ignore_errors=True)
        lock_of(room).unlink(missing_ok=True)
        lock.close()


def resolved(output: str | Path) -> Path:
    """Return the absolute path of a folder, with links resolved.

    Raises
    ------
    ConfigError
        If it cannot be resolved, e.g. a link to itself.
    """
    try:
        return Path(output).resolve()
    except (OSError, RuntimeError, ValueError) as error:  # RuntimeError: a loop, up to Python 3.12
        raise ConfigError(
            f"{output}: cannot be a results folder ({error}); choose another with --output"
        ) from error


def recover(output: str | Path) -> None:
    """Remove remnants of dead processes next to or in `output`, and complete interrupted swaps."""
    output = resolved(output)
    for room in (
        *_rooms(output.parent, _prefix(output)),
        *_rooms(output, _prefix(output)),
    ):
        if room.suffix == ".lock" or is_locked(room):
            continue
        if room.parent == output:
            if (room / _READY).exists():
                _move_in(room, output)
        elif not output.exists() and (room / "old").exists():  # killed between the two renames
            complete = room / "new" if (room / "new").exists() else room / "old"
            complete.rename(output)
        shutil.rmtree(room, ignore_errors=True)
    for lock in (
        *_rooms(output.parent, _prefix(output)),
        *_rooms(output, _prefix(output)),
    ):
        if lock.suffix == ".lock" and not is_locked(lock.with_suffix("")):
            lock.unlink(missing_ok=True)


def _rooms(place: Path, prefix: str) -> list[Path]:
    """Return staging folders and locks in a folder; brackets in names are no wildcards."""
    try:
        return sorted(path for path in place.iterdir() if path.name.startswith(prefix))
    except OSError:
        return []


def _prefix(output: Path) -> str:
    return f".{output.name[:100]}.tribolab-"


def _parent_of_staging(output: Path) -> Path:
    """Return the folder for staging: the parent of the output, or the output if it is fixed."""
    if not output.is_dir():
        return output.parent
    parent = output.parent
    fixed = os.path.ismount(output) or output.stat().st_dev != parent.stat().st_dev
    return output if fixed or not os.access(parent, os.W_OK, effective_ids=True) else parent


def _lock_staging_folder(output: Path) -> tuple[IO[bytes], Path]:
    """Lock a new name; the lock is created first, so that a folder in use is always locked."""
    home = _parent_of_staging(output)
    while True:
        handle, name = tempfile.mkstemp(prefix=_prefix(output), suffix=".lock", dir=home)
        lock = os.fdopen(handle, "wb")
        fcntl.flock(lock, fcntl.LOCK_EX)
        if Path(name).exists():  # else another process removed it before it was locked
            return lock, Path(name).with_suffix("")
        lock.close()


def _refuse_foreign(output: Path) -> None:
    """Raise if a folder is not empty and contains no file that we wrote."""
    if not output.exists():
        return
    if not output.is_dir():
        raise ConfigError(f"{output} is a file; results want a folder: choose it with --output")
    inside = sorted(p.name for p in output.iterdir() if not p.name.startswith(_prefix(output)))
    if not inside:
        return
    ledger = Ledger.read(output)
    if not any(ledger.is_ours(name) for name in ledger.files):
        if (output / CATALOGUE).is_file():
            raise ConfigError(
                f"{output}: the marker {MARKER}, which lists what was written here, is lost; "
                f"'tribolab verify --repair {output}' writes it again"
            )
        raise ConfigError(
            f"{output} holds something else than results ({', '.join(inside[:3])}"
            f"{', ...' if len(inside) > 3 else ''}); choose another folder with --output, or "
            "empty it"
        )


def _keep_foreign_files(ledger: Ledger, new: Path) -> None:
    """Link foreign files into the new folder, and our changed files under other names."""
    intact = ledger.intact()
    names = ledger.foreign(intact)
    if CATALOGUE in ledger.files and CATALOGUE not in intact:
        names += [n for n in intact if n.startswith("data/") and not (new / n).exists()]
    for name in names:
        if not name.startswith(_prefix(ledger.folder)):
            _keep(ledger, name, new)


def _keep(ledger: Ledger, name: str, new: Path) -> None:
    old, target = ledger.folder / name, new / name
    if old.is_dir() and not old.is_symlink():
        target.mkdir(parents=True, exist_ok=True)
        return
    if name in ledger.files or target.exists():
        target = new / other_name(name, old.lstat().st_mtime_ns)
    for above in reversed(target.relative_to(new).parents):
        if (new / above).is_file():  # a foreign folder has the name of one of our files
            target = new / f"{name.replace('/', '_')}"
            break
    if target.exists() or target.is_symlink():
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(old, target, follow_symlinks=False)
    except OSError:  # a file system without hard links
        shutil.copy2(old, target, follow_symlinks=False)


def _swap(room: Path, output: Path) -> None:
    new = room / "new"
    if room.parent == output:
        (room / _READY).touch()
        _move_in(room, output)
        return
    if not output.exists():
        new.rename(output)
        return
    before = Ledger.read(output)
    if exchange(new, output):
        replaced = new
    else:
        replaced = room / "old"
        output.rename(replaced)
        new.rename(output)
    # files that were added while the swap was prepared
    for name in Ledger(replaced, before.files).foreign():
        _keep_late(replaced / name, output / name)


def _keep_late(old: Path, target: Path) -> None:
    if old.is_dir() or target.exists() or target.is_symlink():
        return
    with contextlib.suppress(OSError):
        target.parent.mkdir(parents=True, exist_ok=True)
        old.rename(target)


def _move_in(room: Path, output: Path) -> None:
    """Move the old entries away and the new ones into place; can resume after an interruption."""
    (room / "old").mkdir(exist_ok=True)
    new = room / "new"
    wanted = {path.name for path in new.iterdir()} if new.is_dir() else set()
    if new.is_dir() and not (room / "listed").exists():
        for path in output.iterdir():
            if path.name not in wanted and not path.name.startswith(_prefix(output)):
                path.rename(room / "old" / path.name)
        (room / "listed").touch()
    for name in sorted(wanted, key=lambda name: name == MARKER):  # the marker last
        if os.path.lexists(output / name):
            (output / name).rename(room / "old" / name)
        (new / name).rename(output / name)


def exchange(former: Path, latter: Path) -> bool:
    """Exchange two paths in one step; return False if the system cannot."""
    try:
        renameat2 = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError):
        return False
    failed = renameat2(
        _AT_FDCWD,
        os.fsencode(former),
        _AT_FDCWD,
        os.fsencode(latter),
        ctypes.c_uint(_RENAME_EXCHANGE),
    )
    if not failed:
        return True
    number = ctypes.get_errno()
    if number in (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP):
        return False
    raise OSError(number, os.strerror(number), str(latter))


def _concerns_writing(error: OSError, room: Path, output: Path) -> bool:
    """Whether an error concerns writing here: one of our files, or e.g. a full disk."""
    if error.filename is None:
        return error.errno in CURES
    path = Path(str(error.filename))
    return path.is_relative_to(room) or path.is_relative_to(output)


def _cure(error: OSError) -> str:
    return CURES.get(error.errno or 0, f"cannot write here ({error.strerror or error})")
