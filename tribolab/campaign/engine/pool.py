"""Process pool that survives crashes and can be stopped at any moment."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, as_completed
from functools import partial
from typing import Any

from tribolab.campaign.engine.processes import MASKS, Fresh, begin_worker
from tribolab.core.errors import AnalysisError

if sys.platform == "linux":  # macOS can copy a process, but some of its libraries fail afterwards
    from tribolab.campaign.engine.nursery import Copied, Nursery

# signals that end a program, if the system has them; blocked in threads where possible
_ENDING = tuple(getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n))


_STOPPED = "stopped before it was done"
_NONE_BEGAN = "no worker process could be started"


_DIED = (
    "its worker process ended without an answer, twice (out of memory? a crash in a compiled "
    "library? in a script: no 'if __name__ == \"__main__\":'?)"
)


class WorkerDied(AnalysisError):
    """Raised if a worker process ended without an answer, twice."""


class LastingPool(Executor):
    """Process pool in which a crash loses only the work that crashed.

    A `ProcessPoolExecutor` breaks when one of its processes dies. Here the interrupted calls are
    repeated once, each alone in a fresh process; a call that kills its process again fails with
    `WorkerDied`, and all others are completed.

    Parameters
    ----------
    jobs
        Number of processes.
    modules
        Names of the modules that the work needs; if the system allows it, they are imported once,
        in a process that is copied for the workers.

    Examples
    --------
    >>> with LastingPool(2) as pool:  # doctest: +SKIP
    ...     pool.submit(pow, 2, 10).result()
    1024
    """

    def __init__(self, jobs: int, modules: Sequence[str] = ()) -> None:
        self._lock = threading.RLock()
        self._nursery = Nursery(modules) if sys.platform == "linux" else None
        self._main = _Lane(jobs, self._context)
        self._alone = _Lane(1, self._context)
        self._closed = False

    def prepare(self) -> None:
        """Start importing the modules of the work in parallel with the caller."""
        with _defer_signals(), self._lock:
            if self._nursery is not None and not self._closed:
                self._nursery.ensure_running()

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call and return its future."""
        with _defer_signals(), self._lock:
            if self._closed:
                raise RuntimeError("the pool is closed")
            future: Future[Any] = Future()
            self._main.waiting.append((future, partial(function, *args, **kwargs)))
            self._feed(self._main)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Accept no more work; with `wait`, return when all submitted work has ended."""
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
            self._close_nursery()

    def end(self) -> None:
        """Drop all work and end the processes immediately."""
        self.shutdown(wait=False, cancel_futures=True)
        for lane in (self._main, self._alone):
            lane.kill()
        self._close_nursery()

    def _context(self) -> Fresh:
        return Fresh() if self._nursery is None else Copied(self._nursery)

    def _close_nursery(self) -> None:
        if self._nursery is not None:
            self._nursery.close()

    def _feed(self, lane: _Lane) -> None:
        while lane.waiting and len(lane.under_way) < lane.jobs:
            future, call = lane.waiting.popleft()
            if not future.running() and not future.set_running_or_notify_cancel():
                continue
            pool = lane.pool()
            try:
                inner = pool.submit(call)
            except (BrokenExecutor, OSError, EOFError):  # died while idle: nothing was lost
                lane.forget(pool)
                pool = lane.pool()
                try:
                    inner = pool.submit(call)
                except (BrokenExecutor, OSError, EOFError) as error:  # nobody would wait for it
                    lane.forget(pool)
                    future.set_exception(WorkerDied(f"{_NONE_BEGAN}: {error}"))
                    continue
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
    """Process pool with its waiting and running work."""

    def __init__(self, jobs: int, context: Callable[[], Fresh]) -> None:
        self.jobs = jobs
        self.waiting: deque[tuple[Future[Any], Callable[[], Any]]] = deque()
        self.under_way: dict[Future[Any], Callable[[], Any]] = {}
        self.killed = False
        self._pool: ProcessPoolExecutor | None = None
        self._new_context = context
        self._context = context()

    def pool(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._context = self._new_context()
            self._pool = ProcessPoolExecutor(
                self.jobs,
                mp_context=self._context,
                initializer=begin_worker,
                initargs=(dict(os.environ),),
            )
        return self._pool

    def forget(self, pool: ProcessPoolExecutor) -> None:
        """Abandon a broken pool; the next call gets a fresh one."""
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
        self._context.kill()
        if self._context.results is not None:
            # a worker that died while it returned a result leaves the reader waiting for the rest:
            # when the last writing end, ours, is closed, the reader sees that nothing more comes
            self._context.results.close_writer()
        self.close()


@contextlib.contextmanager
def _defer_signals() -> Iterator[None]:
    """Defer signals until processes and threads are started, so that none dies with a traceback."""
    if threading.current_thread() is not threading.main_thread():  # signals go to the main one
        yield
        return
    came: list[int] = []
    handlers = {number: signal.getsignal(number) for number in _ENDING}
    mine = {number: handler for number, handler in handlers.items() if callable(handler)}
    for number in mine:
        signal.signal(number, lambda number, _: came.append(number))
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if MASKS else None
    try:
        yield
    finally:
        for number, handler in mine.items():
            signal.signal(number, handler)
        if blocked is not None:
            signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
        for number in came[:1]:
            signal.raise_signal(number)
