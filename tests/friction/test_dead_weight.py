"""The gain of a force channel by a dead weight: from the raw file to the chart."""

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.app.run import run_campaign
from tribolab.comparison.watched import GAIN, observations_of
from tribolab.core.errors import AnalysisError

WEIGHT, TRUE = 19.62, 1.013
CAMPAIGN = """
[campaign]
name = "a weight on the cell"
raw = "raw"

[reference]
files = "weight_*.csv"
dead_weight = "19.62 N"

[[run]]
files = "weight_*.csv"

[model]
compute = false
"""


def loaded(rng, on=((10, 30),), noise=0.02, seconds=40):
    """Time [s] and reading of the normal force [N] while a weight is put on and taken off."""
    time = np.arange(0, seconds, 0.02)
    under = np.any([(time > start) & (time < stop) for start, stop in on], axis=0)
    return time, 0.12 + WEIGHT * TRUE * under + noise * rng.standard_normal(time.size)


def run_of(time, force):
    return xr.Dataset({"normal_force": ("time", force)}, {"time": time})


def test_a_static_record_of_a_dead_weight_tells_the_gain_in_the_history(tmp_path):
    time, force = loaded(np.random.default_rng(3))
    lines = [f"{t:.2f},0.05,{n:.5f},0.0" for t, n in zip(time, force, strict=True)]
    text = "\n".join(["Time [s],Fx [N],Fz [N],Speed [mm/s]", *lines]) + "\n"
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw" / "weight_01.csv").write_text(text, "utf-8")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN, "utf-8")
    outcome = run_campaign(tmp_path / "campaign.toml", jobs=1, figures="none")
    observed, _ = observations_of(outcome.folder)
    (gain,) = (told for told in observed if told.quantity == GAIN)
    assert gain.value == pytest.approx(TRUE, abs=3e-4)
    (run,) = outcome.runs
    assert run.quality != "suspect"


@pytest.mark.parametrize("on", [((10, 30),), ((0, 20),), ((5, 12), (20, 30), (34, 38))])
def test_the_gain_comes_out_within_its_error(on):
    pulls = []
    for seed in range(30):
        told = tl.metrology.dead_weight_gain(
            run_of(*loaded(np.random.default_rng(seed), on)), "19.62 N"
        )
        pulls.append((told.gain - TRUE) / told.error)
        assert told.zero == pytest.approx(0.12, abs=0.01)
    assert 0.5 < np.std(pulls) < 1.5 and abs(np.mean(pulls)) < 0.6


def test_without_a_step_there_is_no_gain():
    time, force = loaded(np.random.default_rng(1), on=((-1, 99),))
    with pytest.raises(AnalysisError, match="without the weight"):
        tl.metrology.dead_weight_gain(run_of(time, force), WEIGHT)
    with pytest.raises(AnalysisError, match="'friction_force'"):
        tl.metrology.dead_weight_gain(run_of(time, force), WEIGHT, "friction_force")
