"""A mean over rows is a mean over time, whatever the sampling rate does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.friction.mean_error.estimates import estimate_of
from tribolab.friction.time_weights import on_grid, sample_weights
from tribolab.qc.run.timing import rate_change


def slow_in_the_middle(interval: float, signal: str = "sliding_velocity") -> xr.Dataset:
    """Return 20 s at 100 Hz, 22 s with a row each `interval` s (mu 0.5 in place of 0.31), 20 s."""
    fast = np.arange(0, 20, 0.01)
    time = np.concatenate([fast, 20 + np.arange(0, 22, interval), 42 + fast])
    noise = np.random.default_rng(0).standard_normal((4, time.size))
    mu = np.where((time >= 20) & (time < 42), 0.5, 0.31)
    signals = {
        "friction_force": 10 * mu + 0.02 * noise[0],
        "normal_force": 10 + 0.02 * noise[1],
        "sliding_velocity": 1e-3 * (1 + 1e-3 * noise[2]),
        "position": 1e-3 * time + 1e-7 * noise[3],
    }
    names = ("friction_force", "normal_force", signal)
    return xr.Dataset({name: ("time", signals[name]) for name in names}, {"time": time})


@pytest.mark.parametrize("signal", ["sliding_velocity", "position"])
@pytest.mark.parametrize("interval", [0.013, 0.02, 0.1, 0.5, 2.0, 4.0])
def test_slow_rows_count_by_their_time_and_the_change_is_reported(
    interval: float, signal: str
) -> None:
    run = slow_in_the_middle(interval, signal)
    segments = tl.find_segments(run)
    assert segments.sizes["segment"] == 1
    start, stop = segments["trimmed_start"].item(), segments["trimmed_stop"].item()
    right = 0.31 + 0.19 * 22 / (stop - start)
    mu = tl.friction_coefficient(run, segments)["friction_coefficient"].item()
    # each end of the slow part is known to half of an interval
    assert mu == pytest.approx(right, abs=0.001 + 0.19 * interval / (stop - start))
    if interval > 0.015:
        results = [r for c, r in tl.check(run, segments).results if c.name == "rate_changes"]
        assert [r.status for r in results] == ["suspect"]


def test_a_rate_that_falls_fifty_times_within_a_segment_is_reported(shared_data: Path) -> None:
    run = tl.read(shared_data / "cases" / "rate_falls_fifty_times.csv")
    segments = tl.find_segments(run)
    results = [r for c, r in tl.check(run, segments).results if c.name == "rate_changes"]
    assert results[0].status == "suspect"
    mu = tl.friction_coefficient(run, segments)["friction_coefficient"].values
    assert mu == pytest.approx([0.324, 0.180], abs=0.002)


def test_a_gap_counts_as_one_interval_and_does_not_weigh_its_neighbours() -> None:
    time = np.concatenate([np.arange(0, 10, 0.1), 1000 + np.arange(0, 10, 0.1)])
    values = np.where(time < 500, 1.0, 3.0)
    assert sample_weights(time) is None
    assert estimate_of(time, values).mean == pytest.approx(2.0)
    segments = tl.find_segments(
        xr.Dataset({"sliding_velocity": ("time", np.full(time.size, 1e-3))}, {"time": time})
    )
    assert "gap" in segments["omitted_reason"].values


@pytest.mark.parametrize("burst", [2, 4, 16])
def test_buffered_rows_are_one_rate(burst: int) -> None:
    time = (np.arange(4096) // burst) * burst * 0.01 + (np.arange(4096) % burst) * 1e-4
    assert sample_weights(time) is None
    assert rate_change(time) is None


def test_jittered_rows_are_one_rate() -> None:
    rng = np.random.default_rng(3)
    for _ in range(50):
        time = np.arange(2000) * 0.01 + 0.003 * rng.random(2000)
        assert sample_weights(time) is None
        assert rate_change(time) is None


def test_stretches_of_the_grid_are_means_over_time() -> None:
    time = np.concatenate([np.arange(0, 10, 0.01), np.arange(10, 30, 1.0)])
    values = np.where(time < 10, 0.0, 1.0)
    assert on_grid(time, values, 3) == pytest.approx([0.0, 1.0, 1.0], abs=0.06)
    assert on_grid(time, values, 1) == pytest.approx([2 / 3], abs=0.02)
