"""Found against true: what is found, missed and extra, and whether the error bars hold."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from campaigns import simulated

from tribolab.app.demo import run_demo
from tribolab.app.truth.friction import compare_run, summary


def true_segments():
    return pd.DataFrame(
        {
            "start_s": [10.0, 30.0, 50.0],
            "stop_s": [20.0, 40.0, 60.0],
            "sliding_speed_m_s": [1e-3, 1e-3, 2e-3],
            "direction": [1, -1, 1],
            "friction_coefficient": [0.5, 0.5, 0.4],
        }
    )


def found_segments(start, stop, direction, mu, sem=0.01):
    data = {
        "start_s": start,
        "stop_s": stop,
        "direction": direction,
        "sliding_speed_m_s": [1e-3] * len(start),
        "friction_coefficient": mu,
        "friction_coefficient_sem": [sem] * len(start),
    }
    return pd.DataFrame(data)


def statuses(found, origin=0.0):
    return compare_run("a", true_segments(), found, origin)["status"].tolist()


def test_perfect_is_perfect():
    found = found_segments([8.0, 28.0, 48.0], [18.0, 38.0, 58.0], [1, -1, 1], [0.5, 0.5, 0.4])
    table = compare_run("a", true_segments(), found, 2.0)
    assert table["status"].tolist() == ["found"] * 3
    result = summary(table)
    assert (result.true, result.found, result.missed, result.extra) == (3, 3, 0, 0)
    assert (result.within_1, result.within_3) == (1.0, 1.0)


def test_missed_extra_and_the_wrong_direction_are_told():
    found = found_segments([10.0, 30.0, 70.0], [20.0, 40.0, 80.0], [1, 1, 1], [0.5, 0.5, 0.5])
    assert statuses(found) == ["found", "missed", "missed", "extra", "extra"]


def test_half_of_a_segment_is_not_the_segment():
    assert statuses(found_segments([10.0], [14.0], [1], [0.5]))[0] == "missed"
    assert statuses(found_segments([10.0], [16.0], [1], [0.5]))[0] == "found"


def test_a_segment_that_swallows_two_is_found_once():
    found = found_segments([10.0], [60.0], [1], [0.45])
    assert statuses(found).count("found") == 1


def test_a_failed_run_misses_everything():
    assert statuses(pd.DataFrame()) == ["missed"] * 3


def test_shares_count_the_segments_that_were_found():
    found = found_segments([10.0, 30.0, 50.0], [20.0, 40.0, 60.0], [1, -1, 1], [0.505, 0.52, 0.5])
    result = summary(compare_run("a", true_segments(), found, 0.0))
    assert result.within_1 == pytest.approx(1 / 3)
    assert result.within_3 == pytest.approx(2 / 3)


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    """What a demo came to, and how it compares with the truth."""
    return run_demo(simulated(tmp_path_factory.mktemp("demo"), repeats=1).parent, jobs=1)


@pytest.mark.slow
def test_the_simulated_campaign_is_found_as_it_is(demo):
    result = demo[1].runs
    assert (result.true, result.missed, result.extra) == (12, 0, 0)
    table = result.table
    speed = table["sliding_speed_m_s"] / table["true_sliding_speed_m_s"]
    np.testing.assert_allclose(speed, 1, atol=0.02)
    np.testing.assert_allclose(table["start_s"], table["true_start_s"], atol=0.5)
    assert result.within_3 > 0.9


@pytest.mark.slow
def test_the_demo_leaves_the_truth_beside_its_results(demo):
    outcome, compared = demo
    tables = Path(outcome.folder) / "tables"
    written = pd.read_csv(compared.folder / "truth.csv").groupby("quantity").true.count()
    assert written["friction_coefficient"] == len(compared.runs.table) == 12
    assert list(written.index) == ["friction_coefficient"]  # no scans and no model
    assert not list(tables.glob("truth*")) and not list(tables.glob("paper*"))
    starts = pd.read_csv(tables / "static_friction.csv")
    first = starts.groupby("run")["segment"].min()
    assert len(first) == 2 and (starts["static_friction_coefficient_sem"] > 0).all()
    clear = starts[starts["peak"] == 1]
    assert len(clear) and (clear["static_excess"] > 0).all()
    assert (starts["waiting_time_s"] > 0).all()
