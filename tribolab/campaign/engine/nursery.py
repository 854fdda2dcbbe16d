"""Processes that are copies of one, the nursery, which has imported what they need.

To import all that a worker needs takes as long as the work on several runs. Where the system can
copy a process safely, one without threads imports it once, while its parent goes on with its own.
"""

from __future__ import annotations

import contextlib
import io
import os
import signal
import sys
from collections.abc import Sequence
from multiprocessing import popen_forkserver, reduction, spawn, util
from multiprocessing.context import ForkServerProcess, set_spawning_popen
from multiprocessing.forkserver import ForkServer, read_signed
from multiprocessing.process import BaseProcess
from typing import Any

from tribolab.campaign.engine.processes import ONE_THREAD, Fresh, with_environment

# Arrow's allocator has a thread of its own, beside which a process should not be copied.
_NO_THREAD = {"JE_ARROW_MALLOC_CONF": "background_thread:false"}


_FIRST = "tribolab.campaign.engine.imports"


class Nursery(ForkServer):
    """The process that the workers of a pool are copies of; it ends with the pool.

    The standard library has one for all that a program does, with the environment and the imports
    of whoever was first, and waits for it nowhere: what its copies cost would not be counted.

    Parameters
    ----------
    modules
        What it imports, by name. What is not there is left to the work that needs it.
    """

    def __init__(self, modules: Sequence[str] = ()) -> None:
        super().__init__()
        # refuses to begin in a worker that still imports a script without its guard: at once, as
        # what such a worker leaves half begun nobody tidies up
        spawn.get_preparation_data("nursery")
        self.set_forkserver_preload([_FIRST, *modules])

    def ensure_running(self) -> None:
        """Start it, unless it runs, with our own search path, and BLAS on one thread."""
        paths = {"PYTHONPATH": os.pathsep.join(sys.path), "PYTHONSAFEPATH": "1"}
        with with_environment(ONE_THREAD | _NO_THREAD | paths):
            super().ensure_running()

    def connect_to_new_process(self, fds: Sequence[int]) -> tuple[int, int]:
        """Copy it; if it was killed meanwhile, another one."""
        try:
            return super().connect_to_new_process(fds)
        except ConnectionError:
            pid = self._forkserver_pid  # type: ignore[attr-defined]
            if pid is not None:  # it may be about to end still: then nobody would start another
                with contextlib.suppress(OSError):
                    os.kill(pid, signal.SIGKILL)
                    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
            return super().connect_to_new_process(fds)

    def close(self) -> None:
        """End it, when its copies have ended."""
        pid = self._forkserver_pid  # type: ignore[attr-defined]
        if pid is not None:  # it would wait for all who hold its pipe, whoever has inherited that
            os.kill(pid, signal.SIGKILL)
        self._stop()  # type: ignore[attr-defined]


class Copied(Fresh):
    """Copies of a nursery, with BLAS on one thread, that can be ended."""

    def __init__(self, nursery: Nursery) -> None:
        super().__init__()
        self._nursery = nursery

    def made(self, *args: Any, **kwargs: Any) -> BaseProcess:
        """Return a process that is not yet started."""
        return _CopiedProcess(self._nursery, *args, **kwargs)


class _CopiedProcess(ForkServerProcess):
    def __init__(self, nursery: Nursery, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._nursery = nursery

    def __getstate__(self) -> dict[str, object]:  # what travels to the worker
        return {name: value for name, value in vars(self).items() if name != "_nursery"}

    def _Popen(  # type: ignore[override]  # noqa: N802
        self, process: BaseProcess
    ) -> popen_forkserver.Popen:
        return _CopiedPopen(process, self._nursery)


class _CopiedPopen(popen_forkserver.Popen):
    def __init__(self, process: BaseProcess, nursery: Nursery) -> None:
        self._nursery = nursery
        super().__init__(process)

    def _launch(self, process: BaseProcess) -> None:
        """Do what the standard library does, in a nursery of our own."""
        data = io.BytesIO()
        set_spawning_popen(self)
        try:
            reduction.dump(spawn.get_preparation_data(process.name), data)
            reduction.dump(process, data)
        finally:
            set_spawning_popen(None)
        passed = self._fds  # type: ignore[attr-defined]
        self.sentinel, ours = self._nursery.connect_to_new_process(passed)
        # as long as it is open, the worker sees that its parent lives
        held = os.dup(ours)
        self.finalizer = util.Finalize(
            self,
            util.close_fds,  # type: ignore[attr-defined]
            (held, self.sentinel),
        )
        with open(ours, "wb") as file:  # noqa: PTH123 - a pipe
            file.write(data.getbuffer())
        self.pid = read_signed(self.sentinel)
