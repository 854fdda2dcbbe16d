"""Nursery: process that has imported all modules, and is forked for each worker.

Importing the modules of a worker takes as long as analysing several runs. If the system can copy a
process safely, one process without threads imports them once, in parallel with its parent.
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

from tribolab.campaign.engine.processes import ONE_THREAD, Fresh, change_environment

# Arrow's allocator has a thread, with which a process should not be copied.
_NO_THREAD = {"JE_ARROW_MALLOC_CONF": "background_thread:false"}


_FIRST = "tribolab.campaign.engine.imports"


class Nursery(ForkServer):
    """Process that is copied for the workers of a pool; it ends with the pool.

    The standard library has one such process per program, with the environment and imports of its
    first user, and never waits for it, so that the time of its copies would not be counted.

    Parameters
    ----------
    modules
        Names of the modules to import. Missing ones are left to the work that needs them.
    """

    def __init__(self, modules: Sequence[str] = ()) -> None:
        super().__init__()
        # fails immediately in a worker that imports a script without main guard, because
        # nobody would clean up what such a worker starts
        spawn.get_preparation_data("nursery")
        self.set_forkserver_preload([_FIRST, *modules])

    def ensure_running(self) -> None:
        """Start the nursery if needed, with our search path and BLAS on one thread."""
        paths = {"PYTHONPATH": os.pathsep.join(sys.path), "PYTHONSAFEPATH": "1"}
        with change_environment(ONE_THREAD | _NO_THREAD | paths):
            super().ensure_running()

    def connect_to_new_process(self, fds: Sequence[int]) -> tuple[int, int]:
        """Copy the nursery; if it was killed, start another one first."""
        try:
            return super().connect_to_new_process(fds)
        except ConnectionError:
            pid = self._forkserver_pid  # type: ignore[attr-defined]
            if pid is not None:  # a nursery that is still ending would not be replaced
                with contextlib.suppress(OSError):
                    os.kill(pid, signal.SIGKILL)
                    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
            return super().connect_to_new_process(fds)

    def close(self) -> None:
        """End the nursery after its copies."""
        pid = self._forkserver_pid  # type: ignore[attr-defined]
        if pid is not None:  # avoids waiting for all processes that inherited its pipe
            os.kill(pid, signal.SIGKILL)
        self._stop()  # type: ignore[attr-defined]


class Copied(Fresh):
    """Multiprocessing context of copies of a nursery, with BLAS on one thread."""

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

    def __getstate__(self) -> dict[str, object]:  # data sent to the worker
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
        """Launch a process as the standard library does, from our own nursery."""
        data = io.BytesIO()
        set_spawning_popen(self)
        try:
            reduction.dump(spawn.get_preparation_data(process.name), data)
            reduction.dump(process, data)
        finally:
            set_spawning_popen(None)
        passed = self._fds  # type: ignore[attr-defined]
        self.sentinel, ours = self._nursery.connect_to_new_process(passed)
        # the worker ends when this pipe closes, i.e. when its parent ends
        duplicate = os.dup(ours)
        self.finalizer = util.Finalize(
            self,
            util.close_fds,  # type: ignore[attr-defined]
            (duplicate, self.sentinel),
        )
        with open(ours, "wb") as file:  # noqa: PTH123 - a pipe
            file.write(data.getbuffer())
        self.pid = read_signed(self.sentinel)
