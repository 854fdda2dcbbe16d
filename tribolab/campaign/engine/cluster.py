"""Dask cluster as an executor, with detection of its loss."""

from __future__ import annotations

import contextlib
import logging
import pickle
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future
from typing import Any

from tribolab.arrays.threads import one_thread
from tribolab.core.errors import ConfigError, OutputError

DASK_TIMEOUT = "20s"
LOOK = 1.0  # s between two checks whether the cluster is lost
ANSWER = 5.0  # s; a scheduler answers within some ms
PATIENCE = 20.0  # s without any worker, or without the scheduler, after which the cluster is lost
SILENCE = 40.0  # s without a heartbeat; up to 200 workers send one every 2 s
_LOG = logging.getLogger("tribolab")


class ClusterGone(OutputError):
    """Raised if the scheduler or all of its workers are lost."""


class ClusterAbsent(ConfigError):
    """Raised if no scheduler answers at the address, or it has no workers."""


def gone(why: str, done: int, of: int) -> str:
    """Return the error message for a lost cluster, with the reason and the progress."""
    progress = f"; {done} of {of} pieces of work were done" if of else ""
    return (
        f"the Dask cluster is lost: {why}{progress}. Nothing was written; earlier results are "
        "unchanged. Restart scheduler and workers and repeat the command, or omit --scheduler, or "
        "add --local-if-lost"
    )


@contextlib.contextmanager
def dask_executor(scheduler: str) -> Iterator[Executor]:
    """Yield an executor on the Dask scheduler at an address.

    Raises
    ------
    ConfigError
        If Dask is not installed.
    ClusterAbsent
        If no scheduler answers there, or it has no workers.
    """
    try:
        # imported late: distributed loads slowly
        from distributed import Client
        from distributed.comm.addressing import get_address_host_port
    except ImportError as error:
        raise ConfigError(
            "a scheduler requires Dask, which is not installed: pip install 'tribolab[cluster]'"
        ) from error

    # a client that never connected waits long in its __del__, and forever if a web server answers
    client_class: Any = type("OpenClient", (Client,), {"__del__": lambda self: None})
    opened: Future[Any] = Future()

    def open_client() -> None:
        try:
            opened.set_result(client_class(scheduler, timeout=DASK_TIMEOUT, set_as_default=False))
        except Exception as error:
            opened.set_exception(error)

    try:
        get_address_host_port(scheduler)
        threading.Thread(target=open_client, daemon=True).start()
        client = opened.result(float(DASK_TIMEOUT.removesuffix("s")) + ANSWER)
    except Exception as error:  # any server may answer, e.g. that of the dashboard
        raise ClusterAbsent(
            f"no Dask scheduler answers at {scheduler}; start one with 'dask scheduler' and give "
            "its address, e.g. tcp://localhost:8786"
        ) from error
    try:
        with _silent("distributed"):  # lost workers are reported by us instead of Dask
            if not client.scheduler_info()["workers"]:
                raise ClusterAbsent(f"the Dask scheduler at {scheduler} has no workers")
            yield Cluster(client)
    finally:
        with contextlib.suppress(Exception), _silent("distributed"):
            client.close(timeout=2)  # a lost scheduler cannot be closed


@contextlib.contextmanager
def _silent(package: str) -> Iterator[None]:
    """Suppress all but critical messages of a package, also from loggers with their own level."""
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


class Cluster(Executor):
    """Workers of a Dask scheduler, with detection of their loss."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self._inner = client.get_executor(pure=False)
        self._missed: float | None = None
        self._looked = 0.0
        self._heard: dict[str, tuple[float, float]] = {}  # last heartbeat, and when seen

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call on the cluster and return its future."""
        return self._inner.submit(_call, pickle.dumps((function, args, kwargs)))

    def lost(self) -> str:
        """Return the reason why the cluster counts as lost; "" if it works."""
        now = time.monotonic()
        if now < self._looked + LOOK:
            return ""
        why, final = self._missing(now)
        self._looked = time.monotonic()
        if not why:
            self._missed = None
            return ""
        self._missed = self._missed or now
        return why if final or time.monotonic() - self._missed > PATIENCE else ""

    def _missing(self, now: float) -> tuple[str, bool]:
        """Return the reason why no work is possible, and whether it is final."""
        try:
            if self._client.status != "running":
                raise OSError
            scheduler = self._client.scheduler
            workers = self._client.sync(scheduler.identity, callback_timeout=ANSWER)["workers"]
        except (OSError, TimeoutError, AttributeError):
            return "its scheduler does not answer any more", False
        silent = self._silent(workers, now)
        alive = [worker for address, worker in workers.items() if address not in silent]
        if not workers:
            return "all of its workers are gone", False
        if not alive:
            return f"no worker has answered for {SILENCE:.0f} s", True
        if silent:
            self._remove(silent)
        if all(map(_is_out_of_memory, alive)):
            return "its workers have no memory left and take no work", False
        return "", False

    def _silent(self, workers: Mapping[str, Any], now: float) -> list[str]:
        """Return the addresses of workers without a recent heartbeat."""
        if now > self._looked + PATIENCE:  # after a pause without checks, silence counts from now
            self._heard = {}
        seen = {address: worker["last_seen"] for address, worker in workers.items()}
        before = self._heard
        self._heard = {
            address: before[address] if before.get(address, (None,))[0] == last else (last, now)
            for address, last in seen.items()
        }
        return [name for name, (_, since) in self._heard.items() if now - since > SILENCE]

    def _remove(self, silent: Sequence[str]) -> None:
        """Reassign the work of silent workers to the others."""

        # a nested function is sent as code, so the scheduler need not have tribolab
        async def remove(dask_scheduler: Any) -> None:
            for address in silent:
                await dask_scheduler.remove_worker(address, stimulus_id="tribolab")

        self._client.run_on_scheduler(remove)
        names = ", ".join(silent)
        _LOG.warning(
            "Dask worker %s has not answered for %.0f s: the others do its work", names, SILENCE
        )


def _call(packed: bytes) -> Any:
    """Unpack and call a function in a thread of a Dask worker.

    Dask would unpack arguments, with their imports, in the heartbeat thread. Linear algebra uses as
    many threads as in local processes, so that the last digits of sums agree.
    """
    function, args, kwargs = pickle.loads(packed)
    with one_thread():
        return function(*args, **kwargs)


def _is_out_of_memory(worker: Mapping[str, Any]) -> bool:
    """Whether a worker is paused for lack of memory and has no running work that could free it."""
    doing = worker["metrics"].get("task_counts", {}).get("executing", 0)
    return worker["status"] == "paused" and not doing
