"""The pipeline on a Dask cluster, one of whose workers dies on the way."""

import contextlib
import json
import logging
import os
import signal
import subprocess
import sys
import time

import pytest
from campaigns import simulated

from tribolab.app.run import run_campaign, run_here_if_lost
from tribolab.campaign.engine.cluster import ClusterGone
from tribolab.campaign.engine.executor import workers
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import ConfigError

distributed = pytest.importorskip("distributed")


@pytest.fixture
def cluster(tmp_path):
    """Two worker processes; what the scheduler logs about a dead worker is expected."""
    with distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=True,
        dashboard_address=None,
        local_directory=str(tmp_path),
        silence_logs=logging.CRITICAL,
    ) as cluster:
        yield cluster


@pytest.mark.slow
def test_a_cluster_does_every_run_though_one_worker_is_killed(cluster, tmp_path):
    campaign = load_campaign(simulated(tmp_path))
    killed = []

    def progress(stage, done, total):
        if stage == "runs" and done == 1:
            victim = cluster.workers[0].pid
            os.kill(victim, signal.SIGKILL)
            killed.append(victim)

    with workers(scheduler=cluster.scheduler_address) as executor:
        outcome = process(campaign, tmp_path / "new", executor=executor, progress=progress)
    assert len(killed) == 1
    assert [run.status for run in outcome.runs] == ["done"] * 4
    assert [curve.run_names for curve in outcome.curves if curve.done] == [
        ("sb-r_glycerol_31N_01", "sb-r_glycerol_31N_02"),
        ("sb-r_dry_31N_01", "sb-r_dry_31N_02"),
    ]
    for run in outcome.runs:
        assert (outcome.folder / run.data_file).is_file()


@pytest.mark.slow
def test_a_cluster_that_is_lost_is_one_clear_error_or_the_campaign_is_finished_here(
    tmp_path, monkeypatch
):
    monkeypatch.setattr("tribolab.campaign.engine.cluster.PATIENCE", 0.5)
    campaign = simulated(tmp_path, repeats=1)
    levels = _levels()
    heard: set[str] = set()
    said: list[str] = []
    with _processes(tmp_path) as (address, scheduler, join):

        def losing(victim):
            def progress(stage, done, total):
                if not said:  # still on the cluster
                    heard.update(
                        n for n in _levels() if logging.getLogger(n).isEnabledFor(logging.ERROR)
                    )
                victim.kill()

            return {"scheduler": address, "figures": "none", "progress": progress}

        with pytest.raises(ClusterGone, match=r"Dask cluster is lost.*repeat the command"):
            run_campaign(campaign, **losing(join()))
        left = {path.name for path in campaign.parent.iterdir()}
        assert left == {"campaign.toml", "raw", "truth"}
        join()
        here = {"say": said.append, "jobs": None}
        outcome = run_here_if_lost(campaign, **here, **losing(scheduler))
        again = run_here_if_lost(campaign, **here, scheduler=address, figures="none")
    assert not heard  # Dask's own errors would stand beside ours
    assert {name: _levels()[name] for name in levels} == levels
    assert [run.status for run in outcome.runs] == ["done"] * 2
    assert (outcome.folder / "report.html").is_file()
    assert {path.name for path in campaign.parent.iterdir()} == left | {"results"}
    assert len(said) == 1 and "Dask cluster is lost" in said[0]
    assert all(run.reused for run in again.runs)  # what is unchanged asks no scheduler


@pytest.mark.slow
def test_a_campaign_is_run_here_if_no_scheduler_answers(tmp_path, monkeypatch):
    monkeypatch.setattr("tribolab.campaign.engine.cluster.DASK_TIMEOUT", "1s")
    said: list[str] = []
    campaign = simulated(tmp_path, repeats=1)
    outcome = run_here_if_lost(
        campaign, say=said.append, scheduler="tcp://127.0.0.1:1", figures="none"
    )
    assert [run.status for run in outcome.runs] == ["done"] * 2
    assert len(said) == 1 and "no Dask scheduler answers at tcp://127.0.0.1:1" in said[0]


def _levels():
    names = [n for n in logging.root.manager.loggerDict if n.split(".")[0] == "distributed"]
    return {name: logging.getLogger(name).level for name in names}


@contextlib.contextmanager
def _processes(folder):
    """A scheduler as it is started by hand, and what starts workers, each a process of its own."""
    file = folder / "scheduler.json"
    python = [sys.executable, "-m", "distributed.cli."]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    common = ["--scheduler-file", str(file), "--no-dashboard"]

    def start(kind, *options):
        started.append(
            subprocess.Popen([*python[:2], f"{python[2]}dask_{kind}", *common, *options], **quiet)
        )
        return started[-1]

    started = []
    try:
        scheduler = start("scheduler", "--host", "127.0.0.1", "--port", "0")
        deadline = time.monotonic() + 60
        while not file.is_file() and time.monotonic() < deadline:
            time.sleep(0.1)
        address = json.loads(file.read_text())["address"]

        def join():
            """Start a worker, and wait until it is there."""
            name = f"worker {len(started)}"
            process = start("worker", "--no-nanny", "--nthreads", "1", "--name", name)
            deadline = time.monotonic() + 60
            with distributed.Client(address, set_as_default=False) as client:
                while time.monotonic() < deadline:
                    known = client.scheduler_info()["workers"].values()
                    if name in [worker["name"] for worker in known]:
                        break
                    time.sleep(0.05)
            return process

        yield address, scheduler, join
    finally:
        for process in started:
            process.kill()
            process.wait()


@pytest.mark.slow
def test_a_scheduler_that_does_not_answer_is_one_clear_error(monkeypatch):
    monkeypatch.setattr("tribolab.campaign.engine.cluster.DASK_TIMEOUT", "1s")
    with (
        pytest.raises(ConfigError, match=r"no Dask scheduler answers at tcp://127.0.0.1:1;"),
        workers(scheduler="tcp://127.0.0.1:1"),
    ):
        pass
