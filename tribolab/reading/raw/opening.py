"""Isolation of container libraries in a child process with limits.

Libraries for HDF5, workbooks, Parquet etc. trust the sizes and addresses in a file. A damaged or
hostile file can crash the process, exhaust memory or never end. Functions marked `isolated`
therefore run in a child process, which returns numbers and texts; a crash becomes an ordinary
error. The child is a copy of a process with the library already imported, so that a file takes
only about 10 ms.
"""

from __future__ import annotations

import contextlib
import errno
import functools
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from tribolab.core.errors import ReadError, TribolabError
from tribolab.reading.raw import limits
from tribolab.reading.raw.child_results import packed_error, read_result, unpacked_error
from tribolab.reading.raw.scratch import scratch_errors, scratch_place
from tribolab.reading.raw.server import ONLY, Ended, Job
from tribolab.reading.raw.source import check_regular

P = ParamSpec("P")
R = TypeVar("R")

_PACKAGES = {"python_calamine": "python-calamine", "nptdms": "npTDMS"}
_OF_CORE = {"h5py", "netCDF4", "xarray", "pandas", "pyarrow"}  # part of the core installation

# errors that readers handle; any other exception of a library means unexpected content, e.g.
# SciPy's IndexError in a damaged netCDF file
_HANDLED = (
    *(TribolabError, ImportError, OSError, EOFError, ValueError, KeyError, TypeError),
    *(RuntimeError, Warning),
)

NO_ROOM = 6  # exit code of a child process that cannot write its result
inside = False  # whether this process is the child
# refusals and failures with their time [s], by path, size, time, inode and call; without them, a
# dozen readers would each try a bad file for some seconds
_REFUSED: dict[tuple[Path, int, int, int, str], tuple[ReadError, float]] = {}


class MissingLibraryError(ReadError, ImportError):
    """Raised if the library for a file format is not installed."""


class RefusedError(ReadError):
    """Raised if a file refers to external data, or is too large for a measurement."""


class CrashedError(ReadError):
    """Raised if a library crashed on a file or exceeded limits: the file is damaged or hostile."""


def isolated(*libraries: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that runs a reading function in a child process with limits.

    Parameters
    ----------
    *libraries
        Modules that the function imports; they are imported once for all children.

    Returns
    -------
    Callable
        A decorator for module functions whose first argument is the path of the file [Path] and
        whose result consists of numbers, texts, arrays, datasets and tuples. Exceptions of the
        child are raised again; in a child the function is called directly.

    Raises
    ------
    MissingLibraryError
        By the decorated function, if a library is not installed.
    CrashedError
        By the decorated function, if the child died or exceeded its limits.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            if inside:
                return function(*args, **kwargs)
            path = Path(args[0])  # type: ignore[arg-type]
            result: R = _in_child(path, function, libraries, args, kwargs)
            return result

        return call

    return decorate


def largest_unpacked(size: int) -> int:
    """Return the largest number of bytes to which a compressed file may unpack.

    Parameters
    ----------
    size
        Size of the file [bytes].

    Examples
    --------
    >>> largest_unpacked(1000), largest_unpacked(10**7)
    (16000000, 500000000)
    """
    most = os.environ.get("TRIBOLAB_MAX_UNPACKED", "")
    ceiling = int(float(most)) if most.replace(".", "", 1).isdigit() else limits.MAX_UNPACKED.value
    ratio = limits.UNPACKED_PER_BYTE.value * size
    return int(min(max(limits.UNPACKED_FOR_ANY_FILE.value, ratio), ceiling))


def _in_child(
    path: Path,
    function: Callable[..., Any],
    libraries: tuple[str, ...],
    args: tuple[Any, ...],
    kwargs: dict[str, Any],
) -> Any:
    check_regular(path)
    try:
        state = path.stat()
    except OSError as error:
        raise ReadError(f"{path}: the file cannot be read: {error}") from error
    size, asked = state.st_size, (path, state.st_size, state.st_mtime_ns, state.st_ino)
    call = f"{function.__qualname__} {args[1:]} {kwargs}"
    for name in ("", function.__qualname__, call):
        before, when = _REFUSED.get((*asked, name), (None, 0.0))
        if before is not None and time.monotonic() < when + limits.PATIENCE.value:
            raise unpacked_error(packed_error(before))
    with scratch_errors():
        handle, target = tempfile.mkstemp(prefix=f"tribolab-{os.getpid()}-", dir=scratch_place())
    try:
        job = Job(
            function.__module__,
            function.__qualname__,
            libraries,
            args,
            kwargs,
            target,
            _current_folder(),
            limits.CPU_FOR_ANY_FILE.value + size / limits.BYTES_PER_CPU_SECOND.value,
            int(limits.MEMORY_FOR_ANY_FILE.value + limits.MEMORY_PER_BYTE.value * size),
            largest_unpacked(size),
        )
        ended = ONLY.run(job)
        if isinstance(ended, str):
            raise missing(path, ended)
        if ended.code == 0:
            return read_result(handle)
        if ended.code == NO_ROOM:
            with scratch_errors():
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        if ended.code == 3:
            raised = unpacked_error(read_result(handle))
            if isinstance(raised, ReadError):
                scope = "" if isinstance(raised, RefusedError) else call
                _REFUSED[*asked, scope] = raised, time.monotonic()
            if isinstance(raised, _HANDLED):
                raise raised
            with report_damage(path, "file"):
                raise raised
    finally:
        os.close(handle)
        with contextlib.suppress(OSError):
            os.unlink(target)  # noqa: PTH108 - its content stays as long as it is mapped
    crashed = CrashedError(
        f"{path}: the file is damaged or hostile: {_ending(ended)}; copy it again from where it "
        "was written"
    )
    if ended.code is None or ended.code > 0:  # a signal may have a cause other than the file
        _REFUSED[*asked, function.__qualname__] = crashed, time.monotonic()
    raise crashed


def missing(path: Path, library: str) -> MissingLibraryError:
    """Return the error with installation instructions for a missing library."""
    package = _PACKAGES.get(library, library)
    source = package if library.split(".")[0] in _OF_CORE else "'tribolab[formats]'"
    return MissingLibraryError(
        f"{path}: this kind of file needs the package {package}; install it: pip install {source}"
    )


def _current_folder() -> str:
    """Return the current folder; "" if it was removed."""
    try:
        return os.getcwd()  # noqa: PTH109 - a text for another process
    except OSError:
        return ""


def _ending(ended: Ended) -> str:
    if ended.code is None:
        return "the library that reads it did not finish"
    if ended.code == 4:
        return "reading it takes more memory than a sound file of this size"
    if ended.code == 5:
        return "it unpacks to more than a sound file of this size"
    if ended.code < 0:
        return f"the library that reads it crashed (signal {-ended.code})"
    return f"the library that reads it crashed (exit code {ended.code})"


@contextlib.contextmanager
def report_damage(path: Path, what: str) -> Iterator[None]:
    """Convert any exception that a library raises on a damaged file to a `ReadError`.

    Parameters
    ----------
    path
        The file.
    what
        Expected kind of file, e.g. ``"HDF5 file"``.

    Raises
    ------
    ReadError
        Instead of any foreign error, including those not derived from Exception (a panic).
    """
    try:
        yield
    except (TribolabError, ImportError, KeyboardInterrupt, SystemExit, MemoryError):
        raise
    except BaseException as error:
        words = " ".join(f"{type(error).__name__}: {error}".split())[:200]
        raise ReadError(
            f"{path}: this {what} cannot be read: {words}; it is damaged or of another kind. Copy "
            "it again from where it was written"
        ) from error
