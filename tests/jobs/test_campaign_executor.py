"""Work in processes: a crash costs the work that crashed, and no other."""

import importlib.util
import os
import signal
import struct
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from tribolab.app import needed
from tribolab.campaign.engine.executor import completed, workers
from tribolab.campaign.engine.pool import LastingPool, WorkerDied
from tribolab.core.errors import ConfigError


def square(number):
    return number * number


def square_or_die(number):
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number * number


def die_the_first_time(marker):
    if not os.path.exists(marker):  # noqa: PTH110 - runs in a bare worker
        open(marker, "w").close()  # noqa: PTH123
        os._exit(1)
    return "answer"


def blas_threads(_):
    return os.environ["OPENBLAS_NUM_THREADS"]


def imported_and_parent(name):
    return name in sys.modules, os.getppid()


def variable(name):
    return os.environ.get(name)


def end_its_parent(marker):
    if not os.path.exists(marker):  # noqa: PTH110 - runs in a bare worker
        open(marker, "w").close()  # noqa: PTH123
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(300)
    return "answer"


def value_error(_):
    raise ValueError("no")


def test_a_dying_worker_costs_only_the_work_that_killed_it():
    with LastingPool(2) as pool:
        futures = {number: pool.submit(square_or_die, number) for number in range(12)}
        with pytest.raises(WorkerDied, match="ended without an answer, twice"):
            futures[3].result(timeout=60)
        others = {n: f.result(timeout=60) for n, f in futures.items() if n != 3}
    assert others == {n: n * n for n in range(12) if n != 3}


def test_work_whose_worker_died_once_is_done_in_a_fresh_process(tmp_path):
    with LastingPool(2) as pool:
        assert pool.submit(die_the_first_time, str(tmp_path / "m")).result(timeout=60) == "answer"


def test_workers_take_one_blas_thread_and_leave_the_parent_as_it_was():
    before = dict(os.environ)
    with workers(2) as pool:
        assert pool.submit(blas_threads, 0).result(timeout=60) == "1"
    assert dict(os.environ) == before


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere every worker is started anew")
def test_workers_are_copies_of_a_process_that_has_imported_their_work_and_ends_with_them():
    assert "colorsys" not in sys.modules or sys.modules.pop("colorsys")
    with LastingPool(2, ["colorsys", "there_is_no_such_module"]) as pool:
        futures = [pool.submit(imported_and_parent, "colorsys") for _ in range(4)]
        came = {future.result(timeout=60) for future in futures}
        [(imported, nursery)] = came
        assert imported and nursery != os.getpid() and _lives(nursery)
    assert not _lives(nursery)


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere every worker is started anew")
def test_a_pool_that_is_prepared_begins_before_there_is_work_and_ends_without_any():
    with LastingPool(2, ["colorsys"]) as pool:
        pool.prepare()
        nursery = pool._nursery._forkserver_pid
        assert _lives(nursery)
        assert pool.submit(imported_and_parent, "colorsys").result(timeout=60) == (True, nursery)
    assert not _lives(nursery)
    with LastingPool(2) as pool:
        pool.prepare()
        nursery = pool._nursery._forkserver_pid
    assert not _lives(nursery)
    pool.prepare()  # closed: nothing begins any more
    assert pool._nursery._forkserver_pid is None


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere every worker is started anew")
def test_what_workers_are_copied_of_has_no_threads():
    modules = needed.SIMULATION + needed.ANALYSIS + needed.FILES
    with LastingPool(1, modules) as pool:
        imported, nursery = pool.submit(imported_and_parent, modules[-1]).result(timeout=120)
        assert imported
        assert len(os.listdir(f"/proc/{nursery}/task")) == 1  # noqa: PTH208 - a process table


def test_a_worker_that_is_stopped_within_its_answer_keeps_nobody_waiting():
    pool = LastingPool(1)
    assert pool.submit(pow, 2, 3).result(timeout=60) == 8
    # the beginning of an answer of a thousand bytes, of which no more comes
    os.write(pool._main._context.results.writer.fileno(), struct.pack("!i", 1000) + b"half")
    ending = threading.Thread(target=pool.end, daemon=True)
    ending.start()
    ending.join(30)
    assert not ending.is_alive()


def test_workers_know_the_environment_of_now(monkeypatch):
    monkeypatch.setenv("OF_BEFORE", "1")
    with LastingPool(1) as pool:
        assert pool.submit(variable, "OF_BEFORE").result(timeout=60) == "1"
        monkeypatch.delenv("OF_BEFORE")
        monkeypatch.setenv("OF_NOW", "2")
        with pytest.raises(WorkerDied):  # what is begun next is begun now
            pool.submit(os._exit, 1).result(timeout=60)
        assert pool.submit(variable, "OF_BEFORE").result(timeout=60) is None
        assert pool.submit(variable, "OF_NOW").result(timeout=60) == "2"


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere every worker is started anew")
def test_work_is_done_though_the_process_that_workers_are_copied_of_is_killed(tmp_path):
    with LastingPool(2) as pool:
        assert pool.submit(end_its_parent, str(tmp_path / "m")).result(timeout=60) == "answer"
        assert pool.submit(square, 3).result(timeout=60) == 9


@pytest.mark.parametrize("modules", [needed.ANALYSIS, needed.SIMULATION, needed.FILES])
def test_what_workers_are_said_to_import_is_there(modules):
    assert all(importlib.util.find_spec(name) for name in modules)


def test_an_interrupt_ends_the_processes_at_once():
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt), workers(2) as pool:
        pool.submit(time.sleep, 300)
        raise KeyboardInterrupt
    assert time.monotonic() - began < 60


def test_workers_end_when_their_parent_is_killed():
    code = (
        "import os, time\n"
        "from tribolab.campaign.engine.pool import LastingPool\n"
        "if __name__ == '__main__':\n"
        "    pool = LastingPool(1)\n"
        "    print(pool.submit(os.getpid).result(), flush=True)\n"
        "    pool.submit(time.sleep, 300)\n"
        "    time.sleep(300)\n"
    )
    parent = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    with parent:
        worker = int(parent.stdout.readline())
        parent.kill()
    deadline = time.monotonic() + 30
    while _lives(worker) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not _lives(worker)


def _lives(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:  # noqa: PTH123 - a process table, not a file
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_any_executor_yields_every_task_with_its_result_or_error():
    with ThreadPoolExecutor(2) as threads:
        for executor in (None, threads):
            done = {task: future.result() for task, future in completed(executor, square, [1, 2])}
            assert done == {1: 1, 2: 4}
            [(_, future)] = completed(executor, value_error, [1])
            assert isinstance(future.exception(), ValueError)


def test_one_job_means_no_processes_and_none_is_refused():
    with workers(1) as executor:
        assert executor is None
    with pytest.raises(ConfigError, match="jobs is 0"), workers(0):
        pass
    with pytest.raises(ConfigError, match="either jobs"), workers(2, "tcp://localhost:1"):
        pass
