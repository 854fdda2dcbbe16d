"""Start of the processes of a pool: fresh, with BLAS on one thread, ending with their parent."""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import signal
import threading
import warnings
from collections.abc import Iterator, Mapping
from multiprocessing.context import BaseContext, SpawnContext, SpawnProcess
from multiprocessing.process import BaseProcess
from multiprocessing.reduction import ForkingPickler
from typing import Any

# Two BLAS threads in each of many workers are slower than one, by up to fifty times.
ONE_THREAD = {
    name: "1"
    for name in (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
        "NUMEXPR_NUM_THREADS",
    )
}


MASKS = hasattr(signal, "pthread_sigmask")


class ResultPipe:
    """The pipe by which the workers of a pool return results, with a writing end we can close.

    Has the methods of `multiprocessing.SimpleQueue` that `ProcessPoolExecutor` uses.
    """

    def __init__(self, context: BaseContext) -> None:
        self._reader, self.writer = context.Pipe(duplex=False)
        self._write_lock = context.Lock()

    def put(self, result: object) -> None:
        """Send a result; workers take turns."""
        data = ForkingPickler.dumps(result)
        with self._write_lock:
            self.writer.send_bytes(data)

    def close(self) -> None:
        """Close both ends in this process."""
        self._reader.close()
        self.close_writer()

    def close_writer(self) -> None:
        """Close the writing end in this process: a reader of an unfinished result sees its end."""
        self.writer.close()


class Fresh(SpawnContext):
    """Multiprocessing context of fresh interpreters (safe with threads); BLAS uses one thread."""

    def __init__(self) -> None:
        self.started: list[BaseProcess] = []
        self.results: ResultPipe | None = None

    # multiprocessing's name: the pool asks its context for the queue of its results
    def SimpleQueue(self) -> ResultPipe:  # type: ignore[override]  # noqa: N802
        """Return the pipe of the pool's results, and remember it."""
        self.results = ResultPipe(self)
        return self.results

    # multiprocessing's name of a class; its callers only need a process
    def Process(  # type: ignore[override]  # noqa: N802
        self, *args: Any, **kwargs: Any
    ) -> BaseProcess:
        """Return a process that is not yet started, and remember it."""
        process = self.made(*args, **kwargs)
        self.started.append(process)
        return process

    def made(self, *args: Any, **kwargs: Any) -> BaseProcess:
        """Return a process that is not yet started."""
        return _FreshProcess(*args, **kwargs)

    def kill(self) -> None:
        """Kill all processes."""
        for process in self.started:
            if process.pid is not None:  # else it was interrupted while starting
                process.kill()


class _FreshProcess(SpawnProcess):
    def start(self) -> None:
        """Start with an environment in which BLAS, loaded there, uses one thread."""
        with change_environment(ONE_THREAD):
            super().start()


@contextlib.contextmanager
def change_environment(changed: Mapping[str, str]) -> Iterator[None]:
    """Change environment variables temporarily, for processes started meanwhile."""
    before = {name: os.environ.get(name) for name in changed}
    os.environ.update(changed)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def begin_worker(variables: Mapping[str, str]) -> None:
    """Leave Ctrl-C to the parent, and end when the parent has ended.

    Parameters
    ----------
    variables
        The environment of the parent; that of a copied process is as old as its original.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if MASKS:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    _set_environment({**variables, **ONE_THREAD})
    # checks report damaged numbers in words
    warnings.filterwarnings("ignore", category=RuntimeWarning)
    gc.freeze()  # imported objects remain, so the collector need not scan them
    gc.enable()  # a nursery looks for none
    parent = multiprocessing.parent_process()

    def follow() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


def _set_environment(variables: Mapping[str, str]) -> None:
    for name in os.environ.keys() - variables.keys():
        del os.environ[name]
    os.environ.update(variables)
