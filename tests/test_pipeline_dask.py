"""The pipeline on a Dask cluster, one of whose workers dies on the way."""

import logging
import os
import signal

import pytest
from campaigns import simulated

from tribolab.campaign.config import load_campaign
from tribolab.campaign.executor import workers
from tribolab.campaign.pipeline import process
from tribolab.errors import ConfigError

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
def test_a_scheduler_that_does_not_answer_is_one_clear_error(monkeypatch):
    monkeypatch.setattr("tribolab.campaign.executor.DASK_TIMEOUT", "1s")
    with (
        pytest.raises(ConfigError, match=r"no Dask scheduler answers at tcp://127.0.0.1:1;"),
        workers(scheduler="tcp://127.0.0.1:1"),
    ):
        pass
