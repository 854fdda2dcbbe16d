"""Server process for reading container files, which forks a child for each file."""

from __future__ import annotations

import contextlib
import errno
import importlib
import os
import pickle
import select
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

from tribolab.core.errors import TribolabError
from tribolab.reading.raw import limits, opening
from tribolab.reading.raw.child_results import LENGTH, packed_error, write_result
from tribolab.reading.raw.hdf5_safety import refuse_outside
from tribolab.reading.raw.opening import report_damage
from tribolab.reading.raw.scratch import remove_scratch
from tribolab.reading.raw.server import Ended, Job
from tribolab.reading.raw.unpacked import ZIP, refuse_bomb

_DONE, _ERROR, _NO_MEMORY, _TOO_LARGE = 0, 3, 4, 5
_TEXT_PER_NUMBER = 4  # limit of a result file divided by that of its arrays: text is longer
_PIPE = 1 << 15  # most bytes of module names that a child sends
_POLL = 0.01  # s between checks whether a child has ended, if the system cannot wait for it


def serve() -> None:
    """Run the jobs that arrive on standard input, until it is closed."""
    source = os.fdopen(os.dup(0), "rb")
    answers = os.fdopen(os.dup(1), "wb")
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):  # discard the output of libraries
        os.dup2(null, stream)
    opening.inside = True
    while len(size := source.read(LENGTH)) == LENGTH:
        job: Job = pickle.loads(source.read(int.from_bytes(size, "little")))
        _send(answers, _done(job))


def _send(answers: BinaryIO, answer: Ended | str) -> None:
    message = pickle.dumps(answer)
    answers.write(len(message).to_bytes(LENGTH, "little") + message)
    answers.flush()


def _done(job: Job) -> Ended | str:
    for library in job.libraries:
        try:
            importlib.import_module(library)
        except ImportError as error:
            return error.name or library
    importlib.import_module(job.module)
    if not hasattr(os, "fork"):  # the server reads the file itself; if it dies, it is replaced
        return Ended(_work(job))
    here, there = os.pipe()
    pid = os.fork()
    if pid == 0:
        code = 1
        try:
            before = set(sys.modules)
            _limit(job)
            code = _work(job)
            needed = " ".join(sorted(set(sys.modules) - before))
            os.write(there, needed.encode()[:_PIPE])
        finally:
            remove_scratch()
            os._exit(code)
    os.close(there)
    ended = _wait(pid, job.seconds + limits.PATIENCE.value)
    _import_for_later_children(os.read(here, _PIPE).decode("utf-8", "replace").split())
    os.close(here)
    return Ended(ended)


def _import_for_later_children(modules: list[str]) -> None:
    """Import the modules that a child imported, for all later children."""
    for name in modules:
        with contextlib.suppress(Exception):
            importlib.import_module(name)


def _limit(job: Job) -> None:
    """Limit time, memory and output of this process."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        # imported late: exists on POSIX only
        import resource

        def bound(what: int, most: int, grace: int = 0) -> None:
            with contextlib.suppress(ValueError, OSError):
                resource.setrlimit(what, (most, most + grace))

        bound(resource.RLIMIT_CORE, 0)
        bound(resource.RLIMIT_CPU, int(job.seconds) + 1, 2)  # first a signal that states the reason
        bound(resource.RLIMIT_FSIZE, _TEXT_PER_NUMBER * job.output)
        bound(resource.RLIMIT_AS, _address_space() + job.memory)
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # raise a write error instead


def _address_space() -> int:
    """Return the address space in use in bytes, mostly of libraries."""
    with contextlib.suppress(OSError, ValueError), open("/proc/self/statm", "rb") as file:  # noqa: PTH123
        return int(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    return 2 << 30


def _work(job: Job) -> int:
    function = getattr(importlib.import_module(job.module), job.name)
    code, result = _DONE, None
    if job.folder:
        os.chdir(job.folder)
    try:
        result = _call_checked(function, job)
    except MemoryError:
        return _NO_MEMORY
    except TribolabError as error:
        code, result = _ERROR, error
    except BaseException as error:
        if type(error).__name__ == "PanicException":
            code, result = _ERROR, TribolabError(f"{job.arguments[0]}: {error}")
        elif isinstance(error, Exception) and type(error).__module__ == "builtins":
            code, result = _ERROR, error
        else:
            words = " ".join(f"{type(error).__name__}: {error}".split())[:300]
            code, result = _ERROR, ValueError(words)
    if code == _ERROR:
        result = packed_error(result)
    try:
        with open(job.target, "wb") as file:  # noqa: PTH123
            if not write_result(result, file, job.output):
                return _TOO_LARGE
    except MemoryError:
        return _NO_MEMORY
    except OSError as error:
        return _TOO_LARGE if error.errno == errno.EFBIG else opening.NO_ROOM
    return code


def _call_checked(function: Callable[..., Any], job: Job) -> Any:
    """Call a reading function on a file after safety checks."""
    path, is_zip = Path(job.arguments[0]), False
    with report_damage(path, "file"), path.open("rb") as file:
        is_zip = file.read(len(ZIP)) == ZIP
    if is_zip:
        with report_damage(path, "zip archive"):
            refuse_bomb(path)
    with report_damage(path, "HDF5 or netCDF file"):  # a zip archive can also be HDF5
        refuse_outside(path)
    return function(*job.arguments, **job.keywords)


def _wait(pid: int, seconds: float) -> int | None:
    """Wait for a child; kill it after its time limit."""
    if hasattr(os, "pidfd_open"):
        handle = os.pidfd_open(pid)
        try:
            over = bool(select.select([handle], [], [], seconds)[0])
        finally:
            os.close(handle)
    else:
        end = time.monotonic() + seconds
        over = False
        while not over and time.monotonic() < end:
            over = os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
            if not over:
                time.sleep(_POLL)
    if not over:
        os.kill(pid, signal.SIGKILL)
    _, status = os.waitpid(pid, 0)
    code = os.waitstatus_to_exitcode(status)
    if not over or code in (-signal.SIGXCPU,):
        return None
    return code


if __name__ == "__main__":
    serve()
