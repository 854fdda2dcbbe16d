"""The process that reads containers: a server without threads, and its copies, one a file."""

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
from tribolab.reading.raw.opening import damage_told
from tribolab.reading.raw.scratch import remove_scratch
from tribolab.reading.raw.server import Ended, Job
from tribolab.reading.raw.unpacked import ZIP
from tribolab.reading.raw.zip_safety import refuse_bomb

_DONE, _ERROR, _NO_MEMORY, _TOO_LARGE = 0, 3, 4, 5
_TEXT_PER_NUMBER = 4  # a cell as text is longer than a number
_PIPE = 1 << 15  # bytes of names of modules
_POLL = 0.01  # s between looks at a child, where the system cannot wait for one


def serve() -> None:
    """Do jobs from standard input until it ends."""
    source = os.fdopen(os.dup(0), "rb")
    answers = os.fdopen(os.dup(1), "wb")
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):  # what a library prints goes nowhere
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
    if not hasattr(os, "fork"):  # the server itself does it, and is replaced if it dies
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
    ended = _waited(pid, job.seconds + limits.PATIENCE.value)
    _import_for_the_next(os.read(here, _PIPE).decode("utf-8", "replace").split())
    os.close(here)
    return Ended(ended)


def _import_for_the_next(modules: list[str]) -> None:
    """Import what a child imported, once for all that follow."""
    for name in modules:
        with contextlib.suppress(Exception):
            importlib.import_module(name)


def _limit(job: Job) -> None:
    """Bound time, memory and output of this process."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        # imported late: exists on POSIX only
        import resource

        def bound(what: int, most: int, grace: int = 0) -> None:
            with contextlib.suppress(ValueError, OSError):
                resource.setrlimit(what, (most, most + grace))

        bound(resource.RLIMIT_CORE, 0)
        bound(resource.RLIMIT_CPU, int(job.seconds) + 1, 2)  # a signal first that says why
        bound(resource.RLIMIT_FSIZE, _TEXT_PER_NUMBER * job.output)
        bound(resource.RLIMIT_AS, _address_space() + job.memory)
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # an error of writing instead


def _address_space() -> int:
    """Return the bytes of addresses in use, most of them of libraries."""
    with contextlib.suppress(OSError, ValueError), open("/proc/self/statm", "rb") as file:  # noqa: PTH123
        return int(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    return 2 << 30


def _work(job: Job) -> int:
    function = getattr(importlib.import_module(job.module), job.name)
    code, result = _DONE, None
    if job.folder:
        os.chdir(job.folder)
    try:
        result = _called(function, job)
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


def _called(function: Callable[..., Any], job: Job) -> Any:
    """Call a function that reads, on a file that is checked: one that cannot be is not read."""
    path, is_zip = Path(job.arguments[0]), False
    with damage_told(path, "file"), path.open("rb") as file:
        is_zip = file.read(len(ZIP)) == ZIP
    if is_zip:
        with damage_told(path, "zip archive"):
            refuse_bomb(path)
    with damage_told(path, "HDF5 or netCDF file"):  # a zip archive can be one, too
        refuse_outside(path)
    return function(*job.arguments, **job.keywords)


def _waited(pid: int, seconds: float) -> int | None:
    """Wait for a child; end it when its time is over."""
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
