"""A pool of processes that outlives a crash, and can be stopped at any moment."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import warnings
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, as_completed
from functools import partial
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any

from tribolab.errors import AnalysisError

# Two BLAS threads in each of many workers are slower than one, by up to fifty times.
_ONE_THREAD = {
    name: "1"
    for name in (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
        "NUMEXPR_NUM_THREADS",
    )
}


# what ends a program, so far as the system knows it; blocked in a thread, where it can be
_ENDING = tuple(getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n))


_MASKS = hasattr(signal, "pthread_sigmask")


_STOPPED = "stopped before it was done"


_DIED = (
    "its worker process ended without an answer, twice (out of memory? a crash in a compiled "
    "library? in a script: no 'if __name__ == \"__main__\":'?)"
)


class WorkerDied(AnalysisError):
    """A worker process ended without an answer, twice."""


class LastingPool(Executor):
    """A pool of processes in which a crash costs the work that crashed, and no other.

    A `ProcessPoolExecutor` is lost as a whole when one of its processes dies. Here what was
    under way is tried once more, each piece alone in a fresh process; what then kills its process
    again fails with `WorkerDied`, and all the rest is done.

    Parameters
    ----------
    jobs
        Number of processes.

    Examples
    --------
    >>> with LastingPool(2) as pool:  # doctest: +SKIP
    ...     pool.submit(pow, 2, 10).result()
    1024
    """

    def __init__(self, jobs: int) -> None:
        self._lock = threading.RLock()
        self._main = _Lane(jobs)
        self._alone = _Lane(1)
        self._closed = False

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call and return its future."""
        with _undisturbed(), self._lock:
            if self._closed:
                raise RuntimeError("the pool is closed")
            future: Future[Any] = Future()
            self._main.waiting.append((future, partial(function, *args, **kwargs)))
            self._feed(self._main)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Take no more work; with `wait`, return when all that was submitted has ended."""
        with self._lock:
            self._closed = True
            lanes = (self._main, self._alone)
            if cancel_futures:
                for lane in lanes:
                    lane.cancel_waiting()
            left = [f for lane in lanes for f in lane.futures()]
        if wait:
            for _ in as_completed(left):
                pass
            for lane in lanes:
                lane.close()

    def end(self) -> None:
        """Drop all work and end the processes at once."""
        self.shutdown(wait=False, cancel_futures=True)
        for lane in (self._main, self._alone):
            lane.kill()

    def _feed(self, lane: _Lane) -> None:
        while lane.waiting and len(lane.under_way) < lane.jobs:
            future, call = lane.waiting.popleft()
            if not future.running() and not future.set_running_or_notify_cancel():
                continue
            pool = lane.pool()
            try:
                inner = pool.submit(call)
            except BrokenExecutor:  # died while idle: nothing was lost
                lane.forget(pool)
                pool = lane.pool()
                inner = pool.submit(call)
            lane.under_way[future] = call
            inner.add_done_callback(partial(self._ended, lane, pool, future))

    def _ended(
        self, lane: _Lane, pool: ProcessPoolExecutor, future: Future[Any], inner: Future[Any]
    ) -> None:
        with self._lock:
            call = lane.under_way.pop(future)
            error = None if inner.cancelled() else inner.exception()
            if isinstance(error, BrokenExecutor):
                lane.forget(pool)
                if lane is self._main and not lane.killed:
                    self._alone.waiting.append((future, call))
                    self._feed(self._alone)
                    self._feed(self._main)
                    return
                error = WorkerDied(_STOPPED if lane.killed else _DIED)
            if not lane.killed:
                self._feed(lane)
        if inner.cancelled():
            future.set_exception(WorkerDied(_STOPPED))
        elif error is not None:
            future.set_exception(error)
        else:
            future.set_result(inner.result())


class _Lane:
    """A process pool, what waits for it and what is under way in it."""

    def __init__(self, jobs: int) -> None:
        self.jobs = jobs
        self.waiting: deque[tuple[Future[Any], Callable[[], Any]]] = deque()
        self.under_way: dict[Future[Any], Callable[[], Any]] = {}
        self.killed = False
        self._pool: ProcessPoolExecutor | None = None
        self._context = _Context()

    def pool(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._context = _Context()
            self._pool = ProcessPoolExecutor(
                self.jobs, mp_context=self._context, initializer=_begin_worker
            )
        return self._pool

    def forget(self, pool: ProcessPoolExecutor) -> None:
        """Leave a broken pool; the next call gets a fresh one."""
        if self._pool is pool:
            self._pool = None

    def futures(self) -> list[Future[Any]]:
        return [*self.under_way, *(future for future, _ in self.waiting)]

    def cancel_waiting(self) -> None:
        for future, _ in self.waiting:
            future.cancel()
        self.waiting.clear()

    def close(self) -> None:
        if self._pool is not None:
            self._pool.shutdown()

    def kill(self) -> None:
        self.killed = True
        for process in self._context.started:
            if process.pid is not None:  # else it was interrupted while starting
                process.kill()
        self.close()


class _Context(SpawnContext):
    """Fresh interpreters (safe beside threads), with BLAS on one thread, that can be ended."""

    def __init__(self) -> None:
        self.started: list[SpawnProcess] = []

    # multiprocessing's name, and there a class; whoever calls it wants a process and no more
    def Process(  # type: ignore[override]  # noqa: N802
        self, *args: Any, **kwargs: Any
    ) -> SpawnProcess:
        process = _OneThreadProcess(*args, **kwargs)
        self.started.append(process)
        return process


class _OneThreadProcess(SpawnProcess):
    def start(self) -> None:
        """Start with the environment in which BLAS, loaded there anew, takes one thread."""
        before = {name: os.environ.get(name) for name in _ONE_THREAD}
        os.environ.update(_ONE_THREAD)
        try:
            super().start()
        finally:
            for name, value in before.items():
                if value is None:
                    del os.environ[name]
                else:
                    os.environ[name] = value


@contextlib.contextmanager
def _undisturbed() -> Iterator[None]:
    """Let signals wait until processes and threads are started, and Ctrl-C until it is ignored.

    What is interrupted while it starts a process leaves one that dies with a traceback.
    """
    if threading.current_thread() is not threading.main_thread():  # signals go to the main one
        yield
        return
    came: list[int] = []
    handlers = {number: signal.getsignal(number) for number in _ENDING}
    mine = {number: handler for number, handler in handlers.items() if callable(handler)}
    for number in mine:
        signal.signal(number, lambda number, _: came.append(number))
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if _MASKS else None
    try:
        yield
    finally:
        for number, handler in mine.items():
            signal.signal(number, handler)
        if blocked is not None:
            signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
        for number in came[:1]:
            signal.raise_signal(number)


def _begin_worker() -> None:
    """Leave Ctrl-C to the parent, and end when the parent is gone, however it went."""
    import multiprocessing

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if _MASKS:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    # what arithmetic does with damaged numbers is found by checks, and told in words
    warnings.filterwarnings("ignore", category=RuntimeWarning)
    parent = multiprocessing.parent_process()

    def follow() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    threading.Thread(target=follow, daemon=True).start()
