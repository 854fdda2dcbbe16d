"""The entry point for every container: its library runs in a child process with limits.

Libraries for HDF5, workbooks, Parquet and the like trust the sizes and addresses in a file. A
damaged or hostile file can end the process, ask for all memory or never come to an end. Functions
that are marked `isolated` therefore run in a child process; numbers and texts come back, and a
child that dies costs one error. The child is a copy of a process that has imported the library, so
that a file costs some 10 ms.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import io
import mmap
import os
import pickle
import shutil
import subprocess
import sys
import tempfile
import threading
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple, ParamSpec, TypeVar

from tribolab.errors import ReadError, TribolabError
from tribolab.reading.raw import limits
from tribolab.reading.raw.source import check_regular
from tribolab.room import take_in

P = ParamSpec("P")
R = TypeVar("R")

_LENGTH = 8  # bytes of a message's length
_MAPPED = 1 << 20  # bytes of a result from which on it stays in its file
_ALIGNED = 64
_SERVE = ("-P", "-m", "tribolab.reading.raw.child")
# a child has one thread, and loads no filter of HDF5 that is not the library's own
_ENVIRONMENT = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "ARROW_DEFAULT_MEMORY_POOL": "system",  # others reserve addresses that no limit counts
    "HDF5_PLUGIN_PRELOAD": "::",
    "HDF5_USE_FILE_LOCKING": "FALSE",
    "PYTHONSAFEPATH": "1",
    "PYTHONWARNINGS": "ignore",
}
_FUNCTIONS = {  # that rebuild arrays and datasets; everything else that comes back is a class
    ("numpy", "_frombuffer"),
    ("numpy._core.numeric", "_frombuffer"),
    ("numpy.core.numeric", "_frombuffer"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy.core.multiarray", "_reconstruct"),
    ("numpy._core.multiarray", "scalar"),
    ("numpy.core.multiarray", "scalar"),
    ("pandas._libs.internals", "_unpickle_block"),
    ("pandas.core.indexes.base", "_new_Index"),
    ("pyarrow.lib", "_restore_array"),  # texts of pandas
    ("pyarrow.lib", "py_buffer"),
    ("pyarrow.lib", "type_for_alias"),
    ("copyreg", "__newobj__"),
    ("copyreg", "_reconstructor"),
}
_PACKAGES = {"python_calamine": "python-calamine", "nptdms": "npTDMS"}
_OF_CORE = {"h5py", "netCDF4", "xarray", "pandas", "pyarrow"}  # what no extra brings
_ROOMS = ("builtins", "numpy", "pandas", "xarray", "datetime", "collections", "pathlib", "tribolab")

# what readers turn into words themselves; a library that raises anything else met what it does not
# expect, as SciPy does with an IndexError in a damaged netCDF file
_HANDLED = (
    *(TribolabError, ImportError, OSError, EOFError, ValueError, KeyError, TypeError),
    *(RuntimeError, Warning),
)

inside = False  # whether this is the child


class MissingLibraryError(ReadError, ImportError):
    """A library that reads this kind of file is not installed."""


class CrashedError(ReadError):
    """A library crashed on a file, or exceeded its limits: the file is damaged or hostile."""


class Job(NamedTuple):
    """What a child is to do, and its limits [s, bytes]."""

    module: str
    name: str
    libraries: tuple[str, ...]
    arguments: tuple[Any, ...]
    keywords: dict[str, Any]
    target: str
    folder: str
    seconds: float
    memory: int
    output: int


class Failure(NamedTuple):
    """An error as it travels: an exception pickles in ways that other packages change."""

    kind: type[Exception]
    arguments: tuple[Any, ...]
    state: dict[str, Any]


class Ended(NamedTuple):
    """How a child ended: exit code, or minus the signal; None if it was stopped for its time."""

    code: int | None


def isolated(*libraries: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Have a function that reads a file run in a child process with limits.

    Parameters
    ----------
    *libraries
        Modules that the function imports: they are imported once for all children.

    Returns
    -------
    Callable
        A decorator for functions of a module whose first argument is the file's path [Path] and
        whose result holds numbers, texts, arrays, datasets and tuples of them. The function raises
        what it raises in the child; in a child it is called directly.

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
    """Return how many bytes a packed file may unpack to.

    Parameters
    ----------
    size
        Of the file [bytes].

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
        size = path.stat().st_size
    except OSError as error:
        raise ReadError(f"{path}: the file cannot be read: {error}") from error
    handle, target = tempfile.mkstemp(prefix=f"tribolab-{os.getpid()}-", dir=_scratch())
    try:
        job = Job(
            function.__module__,
            function.__qualname__,
            libraries,
            args,
            kwargs,
            target,
            _here(),
            limits.CPU_FOR_ANY_FILE.value + size / limits.BYTES_PER_CPU_SECOND.value,
            int(limits.MEMORY_FOR_ANY_FILE.value + limits.MEMORY_PER_BYTE.value * size),
            largest_unpacked(size),
        )
        ended = _ONLY.run(job)
        if isinstance(ended, str):
            package = _PACKAGES.get(ended, ended)
            source = package if ended.split(".")[0] in _OF_CORE else "'tribolab[formats]'"
            raise MissingLibraryError(
                f"{path}: this kind of file needs the package {package}; "
                f"install it: pip install {source}"
            )
        if ended.code == 0:
            return _result(handle)
        if ended.code == 3:
            raised = _unpacked_error(_result(handle))
            if isinstance(raised, _HANDLED):
                raise raised
            with damage_told(path, "file"):
                raise raised
    finally:
        os.close(handle)
        with contextlib.suppress(OSError):
            os.unlink(target)  # noqa: PTH108 - its content stays as long as it is mapped
    raise CrashedError(f"{path}: the file is damaged or hostile: {_ending(ended)}; copy it again "
                       "from where it was written")  # fmt: skip


def _here() -> str:
    """Return the folder that relative paths start from; "" if it was removed."""
    try:
        return os.getcwd()  # noqa: PTH109 - a text for another process
    except OSError:
        return ""


def _ending(ended: Ended) -> str:
    if ended.code is None:
        return "the library that reads it did not come to an end"
    if ended.code == 4:
        return "reading it takes more memory than a sound file of this size"
    if ended.code == 5:
        return "it unpacks to more than a sound file of this size"
    if ended.code < 0:
        return f"the library that reads it crashed (signal {-ended.code})"
    return f"the library that reads it crashed (exit code {ended.code})"


def _scratch() -> str:
    """Return the folder for results; what a killed process left there before is removed once."""
    folder = os.environ.get("TMPDIR") or ("/var/tmp" if Path("/var/tmp").is_dir() else "")
    _sweep(folder or tempfile.gettempdir())
    return folder or tempfile.gettempdir()


def scratch_folder() -> Path:
    """Return a new folder that is removed when this process ends, or by a later one if it cannot.

    Returns
    -------
    Path
        Where ``TMPDIR`` says, else in ``/var/tmp``, which is on a disk everywhere.
    """
    folder = Path(tempfile.mkdtemp(prefix=f"tribolab-{os.getpid()}-", dir=_scratch()))
    _FOLDERS.append(folder)
    return folder


def remove_scratch() -> None:
    """Remove the scratch folders of this process."""
    while _FOLDERS:
        shutil.rmtree(_FOLDERS.pop(), ignore_errors=True)


_FOLDERS: list[Path] = []
atexit.register(remove_scratch)


@functools.lru_cache(maxsize=4)
def _sweep(folder: str) -> None:
    """Remove scratch files and folders of processes that are gone."""
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


class _Server:
    """The process that children are copies of."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._owner = 0

    def run(self, job: Job) -> Ended | str:
        """Have a job done; again by a new server if this one was killed."""
        message = pickle.dumps(job)
        with self.lock:
            for attempt in range(2):
                process = self._started()
                try:
                    assert process.stdin is not None and process.stdout is not None
                    process.stdin.write(len(message).to_bytes(_LENGTH, "little") + message)
                    process.stdin.flush()
                    size = process.stdout.read(_LENGTH)
                    if len(size) == _LENGTH:
                        answer = process.stdout.read(int.from_bytes(size, "little"))
                        ended: Ended | str = pickle.loads(answer)  # a library that is missing
                        return ended
                except OSError:
                    pass
                self.stop()
                if attempt:
                    break
        return Ended(-9)

    def _started(self) -> subprocess.Popen[bytes]:
        mine = self._owner == os.getpid()  # a copied process has no server of its own yet
        if self._process is None or not mine or self._process.poll() is not None:
            self._process = subprocess.Popen(
                [sys.executable, *_SERVE],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env={**os.environ, **_ENVIRONMENT, "PYTHONPATH": os.pathsep.join(sys.path)},
                start_new_session=True,  # Ctrl-C is ours to answer
            )
            self._owner = os.getpid()
            weakref.finalize(self, _stop, self._process, self._owner)
        return self._process

    def stop(self) -> None:
        """End the server and what it is doing."""
        if self._process is not None:
            _stop(self._process, self._owner)
        self._process = None


def _stop(process: subprocess.Popen[bytes], owner: int) -> None:
    if owner != os.getpid():
        return
    with contextlib.suppress(OSError):
        process.kill()
        process.wait()
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with contextlib.suppress(OSError):
                pipe.close()


_ONLY = _Server()


def stop_reading() -> None:
    """End the process that reads files; the next file starts another, with today's search path."""
    with _ONLY.lock:
        _ONLY.stop()


def packed_error(error: object) -> Any:
    """Return an error, and errors in its parts, as `Failure`; anything else as it is."""
    if not isinstance(error, Exception):
        return error
    state = {key: packed_error(value) for key, value in vars(error).items() if key[0] != "_"}
    return Failure(type(error), tuple(map(packed_error, error.args)), state)


def _unpacked_error(failure: Any) -> Any:
    if not isinstance(failure, Failure):
        return failure
    error = failure.kind.__new__(failure.kind, *map(_unpacked_error, failure.arguments))
    error.args = tuple(map(_unpacked_error, failure.arguments))
    for key, value in failure.state.items():
        setattr(error, key, _unpacked_error(value))
    return error


def write_result(value: object, file: io.BufferedIOBase, most: int) -> bool:
    """Write a result so that long arrays need not be copied when they are read.

    Parameters
    ----------
    value
        Anything that can be pickled.
    file
        Open for writing, at its start.
    most
        Bytes that its arrays may have together.

    Returns
    -------
    bool
        Whether it is written: its arrays are no larger.
    """
    buffers: list[pickle.PickleBuffer] = []
    data = pickle.dumps(value, protocol=5, buffer_callback=buffers.append)
    raw = [buffer.raw() for buffer in buffers]
    if sum(part.nbytes for part in raw) > most:
        return False
    head = pickle.dumps((len(data), [part.nbytes for part in raw]))
    file.write(len(head).to_bytes(_LENGTH, "little") + head + data)
    for part in raw:
        file.write(b"\0" * (-file.tell() % _ALIGNED))
        file.write(part)
    return True


def _result(handle: int) -> Any:
    """Read what `write_result` wrote."""
    with open(handle, "r+b", closefd=False) as file:  # noqa: PTH123 - a descriptor
        if os.fstat(handle).st_size > _MAPPED:
            content: Any = mmap.mmap(handle, 0)
            take_in(content)
        else:
            content = bytearray(file.read())
    view = memoryview(content)
    first = _LENGTH + int.from_bytes(view[:_LENGTH], "little")
    size, lengths = pickle.loads(view[_LENGTH:first])
    place = first + size
    buffers = []
    for length in lengths:
        place += -place % _ALIGNED
        buffers.append(view[place : place + length])
        place += length
    return _Careful(io.BytesIO(view[first : first + size]), buffers=buffers).load()


class _Careful(pickle.Unpickler):
    """Takes numbers, texts, arrays and records from a child, and no functions but those known."""

    def find_class(self, module: str, name: str) -> Any:
        found = None
        if (module, name) in _FUNCTIONS or module.split(".")[0] in _ROOMS:
            found = super().find_class(module, name)
        if (module, name) in _FUNCTIONS or isinstance(found, type):
            return found
        raise pickle.UnpicklingError(f"{module}.{name} is no result of reading a file")


@contextlib.contextmanager
def damage_told(path: Path, what: str) -> Iterator[None]:
    """Turn what a library raises on a damaged file into one error.

    Parameters
    ----------
    path
        The file.
    what
        What it should be, e.g. ``"HDF5 file"``.

    Raises
    ------
    ReadError
        Instead of any error that is not ours; what is not an Exception (a panic) included.
    """
    try:
        yield
    except (TribolabError, ImportError, KeyboardInterrupt, SystemExit):
        raise
    except MemoryError:
        raise
    except BaseException as error:
        words = " ".join(f"{type(error).__name__}: {error}".split())[:200]
        raise ReadError(
            f"{path}: this {what} cannot be read: {words}; it is damaged or of another kind. Copy "
            "it again from where it was written"
        ) from error
