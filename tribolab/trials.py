"""Files for native libraries: opened in another process first, where they may crash it.

The HDF5 library, and that of old workbooks, trust the sizes and addresses in a file; a damaged one
can end the program, ask for all memory or keep it busy for ever. A trial costs half a second.
"""

from __future__ import annotations

import contextlib
import functools
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Literal

from tribolab.errors import ReadError, brief


class CrashedError(ReadError):
    """A library crashed on a file, or came to no end: it is damaged, or not one of its own."""


_SECONDS = 1.0  # of computing, for a small file; what waits for other programs does not count
_BYTES_PER_SECOND = 30e6
_NO_CRASH = 3  # exit code of a trial that ended in an error of its own
_MEMORY = 2 << 30  # bytes of address space, for a small file
_PATIENCE = 60.0  # s on the clock, if the computing cannot be limited
_TRIAL = """
import os, sys
path, seconds = sys.argv[1], float(sys.argv[2])
def limited():
    try:
        import resource, signal
        signal.setitimer(signal.ITIMER_PROF, seconds)  # its signal ends the process
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[3]), int(sys.argv[3])))
    except (ImportError, AttributeError, ValueError, OSError):
        pass
try:
    {opening}
except BaseException as error:
    sys.stderr.write(f"{{type(error).__name__}}: {{error}}")
    sys.exit(3)
"""
_NETCDF = """
    import netCDF4
    limited()
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
"""
_HDF5 = """
    import h5py
    limited()
    def visit(name, item):
        dict(item.attrs)
        if isinstance(item, h5py.Dataset):
            item[()]
    with h5py.File(path, "r") as file:
        dict(file.attrs)
        file.visititems(visit)
"""
_WORKBOOK = """
    from python_calamine import CalamineWorkbook
    limited()
    book = CalamineWorkbook.from_path(path)
    for name in book.sheet_names:
        book.get_sheet_by_name(name).to_python(nrows=1)
"""
_OPENINGS = {"netCDF": _NETCDF, "HDF5": _HDF5, "spreadsheet": _WORKBOOK}
_OLD_WORKBOOK = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"  # .xls: a file system of its own


def try_out(path: Path, library: Literal["netCDF", "HDF5", "spreadsheet"] = "netCDF") -> None:
    """Open a file in another process, to see whether it can be opened here.

    Parameters
    ----------
    path
        The file.
    library
        The one that will open it.

    Raises
    ------
    ReadError
        If the file cannot be read there, the process crashed, or did not come to an end.
    """
    there = path.stat()
    _tried(path, library, there.st_size, there.st_mtime_ns)


@functools.lru_cache(maxsize=256)
def _tried(path: Path, library: str, size: int, written: int) -> None:
    """Try a file out once, as long as it is not `written` anew."""
    trial = _TRIAL.format(opening=_OPENINGS[library].strip())
    seconds = _SECONDS + size / _BYTES_PER_SECOND
    try:
        done = subprocess.run(
            [sys.executable, "-c", trial, str(path), str(seconds), str(_MEMORY + 4 * size)],
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
            which = "an" if library == "HDF5" else "a"
            raise ReadError(
                f"{path}: this is not {which} {library} file, for it cannot be read as one: {told}"
            )
        ended = f"ended with code {done.returncode}"
        if done.returncode < 0:
            ended = f"was ended by signal {-done.returncode}"
    raise CrashedError(
        f"{path}: the file is damaged: a trial of the {library} library on it {ended}; copy the "
        "file again from where it was written"
    )


@contextlib.contextmanager
def workbook_tried(path: Path) -> Iterator[None]:
    """Have a spreadsheet opened within: an old one is tried out first, and a panic is an error.

    Parameters
    ----------
    path
        The workbook.

    Raises
    ------
    ReadError
        If its library came to no end, asked for all memory, crashed or panicked.
    """
    with path.open("rb") as file:
        old = file.read(len(_OLD_WORKBOOK)) == _OLD_WORKBOOK
    if old:
        try_out(path, "spreadsheet")
    try:
        yield
    except BaseException as error:  # the library's panic is no Exception
        if type(error).__name__ != "PanicException":
            raise
        raise ReadError(
            f"{path}: the workbook is damaged: {brief(Exception(str(error)))}; copy it again from "
            "where it was written"
        ) from error
