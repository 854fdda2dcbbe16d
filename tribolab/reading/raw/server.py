"""Start and use of the server process whose children read files."""

from __future__ import annotations

import contextlib
import os
import pickle
import subprocess
import sys
import threading
import weakref
from typing import Any, NamedTuple

from tribolab.reading.raw.child_results import LENGTH

_SERVE = ("-P", "-m", "tribolab.reading.raw.child")
# children have one thread, and load no foreign HDF5 filters
_ENVIRONMENT = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "ARROW_DEFAULT_MEMORY_POOL": "system",  # other pools reserve much address space
    "HDF5_PLUGIN_PRELOAD": "::",
    "HDF5_USE_FILE_LOCKING": "FALSE",
    "PYTHONSAFEPATH": "1",
    "PYTHONWARNINGS": "ignore",
}


class Job(NamedTuple):
    """Function to call in a child process, and limits on its time [s] and memory [bytes]."""

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


class Ended(NamedTuple):
    """End of a child: exit code, or minus the signal; None after a timeout."""

    code: int | None


class Server:
    """Server process that forks a child for each file."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._owner = 0

    def run(self, job: Job) -> Ended | str:
        """Do a job; repeat it in a new server if this one was killed."""
        message = pickle.dumps(job)
        with self.lock:
            for attempt in range(2):
                process = self._started()
                try:
                    assert process.stdin is not None and process.stdout is not None
                    process.stdin.write(len(message).to_bytes(LENGTH, "little") + message)
                    process.stdin.flush()
                    size = process.stdout.read(LENGTH)
                    if len(size) == LENGTH:
                        answer = process.stdout.read(int.from_bytes(size, "little"))
                        ended: Ended | str = pickle.loads(answer)  # text names a missing library
                        return ended
                except OSError:
                    pass
                self.stop()
                if attempt:
                    break
        return Ended(-9)

    def _started(self) -> subprocess.Popen[bytes]:
        mine = self._owner == os.getpid()  # after a fork, this process has no server yet
        if self._process is None or not mine or self._process.poll() is not None:
            self._process = subprocess.Popen(
                [sys.executable, *_SERVE],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env={**os.environ, **_ENVIRONMENT, "PYTHONPATH": os.pathsep.join(sys.path)},
                start_new_session=True,  # Ctrl-C is handled by this process
            )
            self._owner = os.getpid()
            weakref.finalize(self, _stop, self._process, self._owner)
        return self._process

    def stop(self) -> None:
        """Stop the server and its current job."""
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


ONLY = Server()


def stop_reading() -> None:
    """Stop the server; the next file starts another one with the current search path."""
    with ONLY.lock:
        ONLY.stop()
