"""Where work is done: processes that outlive a crash, a Dask cluster, or this process."""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import threading
import time
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    as_completed,
)
from functools import partial
from multiprocessing.context import SpawnContext, SpawnProcess
from queue import Empty, SimpleQueue
from typing import Any

from threadpoolctl import threadpool_limits

from tribolab.errors import AnalysisError, ConfigError, OutputError, brief

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
DASK_TIMEOUT = "20s"
_LOOK = 1.0  # s between two looks at a cluster that does not answer
_PATIENCE = 20.0  # s without any worker, or without the scheduler, after which it counts as gone
_STOPPED = "stopped before it was done"
_DIED = (
    "its worker process ended without an answer, twice (out of memory? a crash in a compiled "
    "library? in a script: no 'if __name__ == \"__main__\":'?)"
)


class WorkerDied(AnalysisError):
    """A worker process ended without an answer, twice."""


class ClusterGone(OutputError):
    """The scheduler or all of its workers are gone, and nothing more can be done there."""


def default_jobs() -> int:
    """Return the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def completed(
    executor: Executor | None, function: Callable[[Any], Any], tasks: Iterable[Any]
) -> Iterator[tuple[Any, Future[Any]]]:
    """Give (task, its finished future) as the tasks end; without executor, here and in order.

    With an executor the tasks begin at once, whenever the caller asks for what they came to. If
    it stops asking early, what has not begun is cancelled.
    """
    if executor is None:
        return _here(function, tasks)
    lost = executor.lost if isinstance(executor, _Cluster) else None
    try:
        futures = {executor.submit(function, task): task for task in tasks}
    except Exception as error:
        if lost is None:
            raise
        raise ClusterGone(_gone(f"it takes no work ({brief(error)})", 0, 0)) from error
    return _as_they_end(futures, lost)


def _here(
    function: Callable[[Any], Any], tasks: Iterable[Any]
) -> Iterator[tuple[Any, Future[Any]]]:
    for task in tasks:
        future: Future[Any] = Future()
        try:
            with threadpool_limits(1, user_api="blas"):  # as in the workers
                future.set_result(function(task))
        except Exception as error:  # handed on: whoever asks for the result gets it
            future.set_exception(error)
        yield task, future


def _as_they_end(
    futures: dict[Future[Any], Any], lost: Callable[[], str] | None
) -> Iterator[tuple[Any, Future[Any]]]:
    count = len(futures)
    ended: SimpleQueue[Future[Any]] = SimpleQueue()
    for future in futures:
        future.add_done_callback(ended.put)
    try:
        while futures:
            try:
                future = ended.get(timeout=None if lost is None else _LOOK)
            except Empty:
                if lost is not None and (text := lost()):
                    raise ClusterGone(_gone(text, count - len(futures), count)) from None
                continue
            if lost is not None and future.cancelled():
                text = lost() or "its scheduler dropped the work"
                raise ClusterGone(_gone(text, count - len(futures), count))
            yield futures.pop(future), future  # what was answered is held no longer
            del future
    finally:
        for future in futures:
            future.cancel()


def _gone(why: str, done: int, of: int) -> str:
    said = f"; {done} of {of} pieces of work were done" if of else ""
    return (
        f"the Dask cluster is lost: {why}{said}. Nothing was written, results of before are as "
        "they were; start scheduler and workers again and repeat the command, or leave "
        "--scheduler out"
    )


@contextlib.contextmanager
def workers(jobs: int | None = None, scheduler: str | None = None) -> Iterator[Executor | None]:
    """Yield an executor: Dask's for a scheduler's address, else processes, else none.

    Parameters
    ----------
    jobs
        Number of processes; 1 means none (all is done here). By default one per processor.
    scheduler
        Address of a Dask scheduler, e.g. ``"tcp://10.0.0.5:8786"``. Its workers have to see the
        raw files and the results folder under the same paths.

    Raises
    ------
    ConfigError
        If the options exclude each other or the scheduler cannot be reached.
    """
    if scheduler is not None:
        if jobs is not None:
            raise ConfigError("give either jobs (processes here) or scheduler (Dask), not both")
        with _dask(scheduler) as executor:
            yield executor
        return
    jobs = default_jobs() if jobs is None else jobs
    if jobs < 1:
        raise ConfigError(f"jobs is {jobs}; it wants a number of processes, 1 or more")
    if jobs == 1:
        yield None
        return
    pool = LastingPool(jobs)
    try:
        yield pool
    except BaseException:
        pool.end()
        raise
    pool.shutdown()


@contextlib.contextmanager
def _dask(scheduler: str) -> Iterator[Executor]:
    try:
        from distributed import Client
    except ImportError as error:
        raise ConfigError(
            "a scheduler wants Dask, which is not installed: pip install 'tribolab[cluster]'"
        ) from error
    try:
        client = Client(scheduler, timeout=DASK_TIMEOUT, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise ConfigError(
            f"no Dask scheduler answers at {scheduler}; start one with 'dask scheduler' and give "
            "its address, e.g. tcp://localhost:8786"
        ) from error
    try:
        with _silent("distributed"):  # what it would say of a lost worker is said by us
            if not client.scheduler_info()["workers"]:
                raise ConfigError(f"the Dask scheduler at {scheduler} has no workers")
            yield _Cluster(client)
    finally:
        with contextlib.suppress(Exception), _silent("distributed"):
            client.close(timeout=2)  # a scheduler that is gone cannot be told goodbye


@contextlib.contextmanager
def _silent(package: str) -> Iterator[None]:
    """Hear only what is critical of a package's loggers, those with a level of their own too."""
    names = [package, *(n for n in logging.root.manager.loggerDict if n.startswith(f"{package}."))]
    levels = {name: logging.getLogger(name).level for name in names}
    try:
        for name, level in levels.items():
            if name == package or level != logging.NOTSET:
                logging.getLogger(name).setLevel(logging.CRITICAL)
        yield
    finally:
        for name, level in levels.items():
            logging.getLogger(name).setLevel(level)


class _Cluster(Executor):
    """The workers of a Dask scheduler, and whether they are still there."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self._inner = client.get_executor(pure=False)
        self._missed: float | None = None

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call on the cluster and return its future."""
        return self._inner.submit(function, *args, **kwargs)

    def lost(self) -> str:
        """Return why no answer will come any more; "" as long as one may."""
        why = ""
        if self._client.status != "running":
            why = "its scheduler does not answer any more"
        elif not self._client.scheduler_info()["workers"]:
            why = "all of its workers are gone"
        if not why:
            self._missed = None
            return ""
        self._missed = self._missed or time.monotonic()
        return why if time.monotonic() - self._missed > _PATIENCE else ""


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
