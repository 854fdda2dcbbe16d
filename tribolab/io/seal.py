"""Files for native libraries: told sound before they are opened in this program.

The HDF5 library trusts the sizes and addresses in a file; a damaged one can end the program or
keep it busy for ever. Two ways to know beforehand, stated once:

- a seal: `seal` puts the SHA-256 of a file behind its last byte, where HDF5 does not look;
  `is_sealed` finds it whole. What tribolab writes is sealed, and opened as fast as ever.
- a trial: `try_out` opens a file without a seal in another process first. It costs half a second.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

from tribolab.errors import ReadError

_MARK = b"\ntribolab sha256 "
_LENGTH = len(_MARK) + 64
_SECONDS = 1.0  # of computing, for a small file; what waits for other programs does not count
_BYTES_PER_SECOND = 30e6
_NO_CRASH = 3  # exit code of a trial that ended in an error of its own
_MEMORY = 2 << 30  # bytes of address space, for a small file
_PATIENCE = 60.0  # s on the clock, if the computing cannot be limited
_TRIAL = """
import os, sys
path, seconds = sys.argv[1], float(sys.argv[2])
try:
    import netCDF4
    try:
        import resource, signal
        signal.setitimer(signal.ITIMER_PROF, seconds)  # its signal ends the process
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[3]), int(sys.argv[3])))
    except (ImportError, AttributeError, ValueError, OSError):
        pass
    def visit(group):
        group.ncattrs() and group.__dict__
        for variable in group.variables.values():
            variable.__dict__
            variable[...]
        for inner in group.groups.values():
            visit(inner)
    name = os.fsencode(path).decode("latin-1")
    with netCDF4.Dataset(name, encoding="latin-1") as file:
        visit(file)
except BaseException as error:
    sys.stderr.write(f"{type(error).__name__}: {error}")
    sys.exit(3)
"""


def seal(path: Path) -> None:
    """Put a file's SHA-256 behind its end."""
    with path.open("r+b") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        file.seek(0, os.SEEK_END)
        file.write(_MARK + digest.encode())


def unseal(path: Path) -> None:
    """Take the seal off, before the file is changed."""
    with path.open("r+b") as file:
        size = file.seek(0, os.SEEK_END)
        if size > _LENGTH:
            file.seek(size - _LENGTH)
            if file.read(len(_MARK)) == _MARK:
                file.truncate(size - _LENGTH)


def is_sealed(path: Path) -> bool:
    """Whether a file carries a seal, and is what it was when it was sealed."""
    with path.open("rb") as file:
        left = file.seek(0, os.SEEK_END) - _LENGTH
        if left < 0:
            return False
        file.seek(left)
        magic = file.read()
        if not magic.startswith(_MARK):
            return False
        file.seek(0)
        digest = hashlib.sha256()
        while left > 0:
            block = file.read(min(left, 1 << 20))
            if not block:
                return False
            digest.update(block)
            left -= len(block)
    return magic == _MARK + digest.hexdigest().encode()


def try_out(path: Path) -> None:
    """Open a netCDF or HDF5 file in another process, to see whether it can be opened here.

    Raises
    ------
    ReadError
        If the file cannot be read there, the process crashed, or did not come to an end.
    """
    size = path.stat().st_size
    seconds = _SECONDS + size / _BYTES_PER_SECOND
    try:
        done = subprocess.run(
            [sys.executable, "-c", _TRIAL, str(path), str(seconds), str(_MEMORY + 4 * size)],
            capture_output=True,
            check=False,
            timeout=_PATIENCE + seconds,
        )
    except subprocess.TimeoutExpired:
        ended = "was still busy after a minute"
    else:
        if done.returncode == 0:
            return
        if done.returncode == _NO_CRASH:
            told = " ".join(done.stderr.decode(errors="replace").split())[:300]
            raise ReadError(f"{path}: this is not a netCDF file that can be read: {told}")
        ended = f"ended with code {done.returncode}"
        if done.returncode < 0:
            ended = f"was ended by signal {-done.returncode}"
    raise ReadError(
        f"{path}: the file is damaged: a trial of the netCDF library on it {ended}; copy the file "
        "again from where it was written"
    )
