"""Choice of the executor: local processes, a Dask cluster, or the current process."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import (
    Executor,
    Future,
)
from queue import Empty, SimpleQueue
from typing import Any

from tribolab.arrays.threads import one_thread
from tribolab.campaign.engine.cluster import LOOK, Cluster, ClusterGone, dask_executor, gone
from tribolab.campaign.engine.pool import LastingPool, WorkerDied
from tribolab.core.errors import ConfigError, brief


def default_jobs() -> int:
    """Return the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def completed(
    executor: Executor | None, function: Callable[[Any], Any], tasks: Iterable[Any]
) -> Iterator[tuple[Any, Future[Any]]]:
    """Yield (task, finished future) as tasks end; without executor, run them here in order.

    With an executor the tasks start immediately, before results are requested. If the caller stops
    early, tasks that have not started are cancelled.
    """
    if executor is None:
        return _here(function, tasks)
    lost = executor.lost if isinstance(executor, Cluster) else None
    try:
        futures = {executor.submit(function, task): task for task in tasks}
    except Exception as error:
        if lost is None:
            raise
        raise ClusterGone(gone(f"it takes no work ({brief(error)})", 0, 0)) from error
    return _as_they_end(futures, lost)


def _here(
    function: Callable[[Any], Any], tasks: Iterable[Any]
) -> Iterator[tuple[Any, Future[Any]]]:
    for task in tasks:
        future: Future[Any] = Future()
        try:
            with one_thread():  # as in the workers
                future.set_result(function(task))
        except Exception as error:  # stored in the future and raised when the result is requested
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
            come: list[Future[Any]] = []
            with contextlib.suppress(Empty):
                come.append(ended.get(timeout=None if lost is None else LOOK))
            text = "" if lost is None else lost()
            if lost is not None and any(future.cancelled() for future in come):
                text = text or "its scheduler dropped the work"
            if text:
                raise ClusterGone(gone(text, count - len(futures), count))
            while come:  # release finished results
                yield futures.pop(come[0]), _explain_death(come.pop())
    finally:
        for future in futures:
            future.cancel()


def _explain_death(future: Future[Any]) -> Future[Any]:
    """Return a finished future; if its Dask workers died, one with an explanation."""
    if type(future.exception()).__name__ != "KilledWorker":
        return future
    died: Future[Any] = Future()
    died.set_exception(WorkerDied("its Dask workers died one after the other (out of memory?)"))
    return died


@contextlib.contextmanager
def workers(
    jobs: int | None = None, scheduler: str | None = None, modules: Sequence[str] = ()
) -> Iterator[Executor | None]:
    """Yield an executor: Dask for a scheduler's address, else processes, else None.

    Parameters
    ----------
    jobs
        Number of processes; 1 means this process only. By default one per processor.
    scheduler
        Address of a Dask scheduler, e.g. ``"tcp://10.0.0.5:8786"``. Its workers must have access to
        the raw files and the results folder under the same paths.
    modules
        Names of the modules that the work needs; `LastingPool` imports them only once.

    Raises
    ------
    ConfigError
        If the options exclude each other or the scheduler cannot be reached.
    """
    if scheduler is not None:
        if jobs is not None:
            raise ConfigError("give either jobs (processes here) or scheduler (Dask), not both")
        with dask_executor(scheduler) as executor:
            yield executor
        return
    jobs = default_jobs() if jobs is None else jobs
    if jobs < 1:
        raise ConfigError(f"jobs is {jobs}; it must be a number of processes, 1 or more")
    if jobs == 1:
        yield None
        return
    pool = LastingPool(jobs, modules)
    try:
        yield pool
    except BaseException:
        pool.end()
        raise
    pool.shutdown()
