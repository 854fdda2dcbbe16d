"""The shift between two clocks is found from the signals, with an uncertainty that holds."""

from __future__ import annotations

import datetime as dt

import numpy as np
import pytest

import tribolab as tl
from tribolab import rig
from tribolab.reading.clocks.shift import estimate_clock_shift
from tribolab.rig.files import force_file as force_file_of
from tribolab.rig.files import motion_file as motion_file_of

STROKES = tuple((way * speed, 2.0) for speed in (1e-3, 1e-2) for way in (1, -1)) * 2


def logs(
    shift=1.234,
    *,
    strokes=STROKES,
    rest=2.0,
    lead=5.0,
    rate=100.0,
    motion_rate=None,
    build_up=0.0,
    noise=0.02,
    sign=1.0,
    clock_rate=0.0,
    seed=0,
):
    """Two logs of strokes (velocity, duration): friction turns over within `build_up` and stays."""
    rng = np.random.default_rng(seed)
    parts = [(0.0, lead), *(part for stroke in strokes for part in (stroke, (0.0, rest)))]
    parts = [part for part in [*parts, (0.0, lead)] if part[1] > 0]
    ends = np.cumsum([duration for _, duration in parts])
    ramp = 0.05
    knots = np.ravel(
        [[end - duration + ramp, end] for (_, duration), end in zip(parts, ends, strict=True)]
    )
    velocities = np.repeat([velocity for velocity, _ in parts], 2)

    fine = np.arange(0.0, ends[-1], 1e-3)
    velocity = np.interp(fine, knots, velocities)
    way = np.sign(velocity)
    begins = np.flatnonzero((way != 0) & (np.diff(way, prepend=0.0) != 0))
    path = np.cumsum(np.abs(velocity)) * 1e-3
    friction, before = np.zeros(len(fine)), 0.0
    for first, last in zip(begins, [*begins[1:], len(fine)], strict=True):
        slid = path[first:last] - path[first]
        left = np.exp(-slid / build_up) if build_up else np.zeros(last - first)
        friction[first:last] = way[first] + (before - way[first]) * left
        before = friction[last - 1]
    time = np.arange(0.0, ends[-1], 1.0 / rate)
    force = sign * np.interp(time, fine, friction) + noise * rng.standard_normal(len(time))
    moved = np.arange(1.0, ends[-1] - 1.0, 1.0 / (motion_rate or rate))
    middle = 0.5 * (moved[0] + moved[-1])
    shown = middle - shift + (moved - middle) / (1.0 + clock_rate)
    return time, force, shown, np.interp(moved, knots, velocities)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shift", "sign", "rate"),
    [(-1.7, 1.0, 100.0), (0.0, -1.0, 100.0), (1.234, -1.0, 1000.0)],
)
def test_without_build_up_the_error_is_below_two_samples(shift, sign, rate):
    estimate = estimate_clock_shift(*logs(shift, sign=sign, rate=rate))
    assert abs(estimate.shift - shift) < 2.0 / rate


@pytest.mark.slow
@pytest.mark.parametrize(("build_up", "seed"), [(3e-6, 0), (3e-5, 2)])
def test_friction_that_builds_up_over_a_distance_does_not_delay_the_shift(build_up, seed):
    estimate = estimate_clock_shift(*logs(build_up=build_up, seed=seed))
    assert abs(estimate.shift - 1.234) < 0.02
    assert abs(estimate.shift - 1.234) < 3 * estimate.uncertainty


@pytest.mark.slow
def test_reversals_without_rest_tell_the_shift():
    strokes = tuple((way * 1e-3, 3.0) for way in (1, -1) * 4)
    estimate = estimate_clock_shift(*logs(strokes=strokes, rest=0.0, build_up=1e-5))
    assert abs(estimate.shift - 1.234) < 0.02


def test_logs_of_different_rates_are_matched():
    estimate = estimate_clock_shift(*logs(rate=500.0, motion_rate=50.0, build_up=1e-5))
    assert abs(estimate.shift - 1.234) < 0.02


@pytest.mark.slow
def test_a_long_run_tells_which_clock_is_faster():
    # two slow ones, as in a sweep: where all are alike, other shifts are tried and take longest
    strokes = ((1e-5, 10.0), (-1e-5, 10.0), *((way * 1e-2, 10.0) for way in (1, -1) * 50))
    quiet = estimate_clock_shift(*logs(strokes=strokes, rate=200.0, clock_rate=20e-6))
    assert quiet.rate == pytest.approx(20e-6, abs=3 * quiet.rate_uncertainty)
    assert quiet.rate_uncertainty < 3e-6


def test_a_single_start_is_enough_and_its_uncertainty_says_how_far():
    clear = estimate_clock_shift(*logs(strokes=((1e-3, 20.0),), lead=10.0, build_up=1e-5))
    noisy = estimate_clock_shift(
        *logs(strokes=((1e-3, 20.0),), lead=10.0, build_up=1e-5, noise=0.3)
    )
    # slack of the drive cannot be told from one start: 2 % of the stroke's 20 s
    assert abs(clear.shift - 1.234) < 3 * clear.uncertainty < 0.4
    assert abs(noisy.shift - 1.234) < 3 * noisy.uncertainty
    assert noisy.ways["starts"].uncertainty > 2 * clear.ways["starts"].uncertainty


def test_speed_changes_after_one_start_do_not_mislead():
    strokes = ((1e-3, 5.0), (2e-3, 7.0), (1e-3, 4.0), (3e-3, 9.0))
    estimate = estimate_clock_shift(*logs(strokes=strokes, rest=0.0, lead=10.0, build_up=1e-5))
    assert abs(estimate.shift - 1.234) < 3 * estimate.uncertainty


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "seed"),
    [("noise", 0), ("noise", 1), ("random walk", 0), ("random walk", 1), ("drift", 0)]
    + [("constant", 0)],
)
def test_a_force_that_does_not_follow_the_motion_tells_nothing(kind, seed):
    time, _, shown, velocity = logs()
    noise = np.random.default_rng(seed).standard_normal(len(time))
    forces = {
        "noise": noise,
        "random walk": np.cumsum(noise),
        "drift": time + 0.1 * noise,
        "constant": np.full(len(time), 2.0),
    }
    assert estimate_clock_shift(time, forces[kind], shown, velocity) is None


def test_one_slide_that_is_longer_than_the_motion_log_tells_nothing():
    """Speeds change, but the table neither starts nor stops nor turns within the log."""
    time = np.arange(0.0, 60.0, 0.01)
    speed = np.where(time < 30, 1e-3, 5e-3)
    force = 3 + np.log10(speed) + 0.01 * np.random.default_rng(0).standard_normal(len(time))
    inner = slice(300, -300)
    assert estimate_clock_shift(time, force, time[inner] - 3.0, speed[inner]) is None


def test_a_table_that_does_not_move_tells_nothing():
    time, force, shown, velocity = logs()
    assert estimate_clock_shift(time, force, shown, np.zeros_like(velocity)) is None


@pytest.mark.slow
@pytest.mark.parametrize(
    ("surface", "medium", "load"),
    [("Smooth", "glycerol", 31.0), ("Sb-R", "glycerol", 151.0)]
    + [("Smooth", "dry", 31.0), ("Sb-S", "dry", 31.0)],
)
def test_runs_of_the_rig_are_matched_to_what_the_fast_strokes_need(surface, medium, load):
    run = rig.simulate_run(surface, medium, load, seed=5)
    time = run.motion_log["time"].to_numpy()
    force = run.force_log["friction_force"].to_numpy()
    velocity = run.motion_log["sliding_velocity"].to_numpy()
    estimate = estimate_clock_shift(run.force_log["time"].to_numpy(), force, time, velocity)
    error = estimate.shift - run.facts["clock_shift_at_middle_s"]
    assert abs(error) < 0.015
    assert abs(error) < 2 * estimate.uncertainty < 0.03
    middle = 0.5 * (time[0] + time[-1])
    error_at_fastest = error + (estimate.rate - run.facts["clock_rate"]) * (time[-1] - middle)
    assert abs(error_at_fastest) < 0.006  # segments there last 0.9 s and are trimmed by 0.09 s
    assert "motion" not in estimate.ways  # the starts agree, and the slow joint fit is not needed


@pytest.mark.parametrize("seed", [6, 45, 76])
def test_a_fit_by_the_motion_that_two_ways_contradict_does_not_count(seed, tmp_path):
    """On the smooth surface in glycerol it lay 0.6 to 1.4 s off, and the run failed."""
    few = rig.Rig(rig.Protocol(speeds=(4.64e-6, 1e-4, 2.15e-3)))
    run = rig.simulate_run("Smooth", "glycerol", 31.0, seed=seed, rig=few)
    date = dt.datetime(2026, 3, 2)  # noqa: DTZ001 - instruments know no time zone
    files = [tmp_path / f"{run.name}_{log}.csv" for log in ("force", "motion")]
    files[0].write_bytes(force_file_of(run.force_log, date))
    files[1].write_bytes(motion_file_of(run.motion_log, date))
    attrs = tl.read(files, instrument="linear_slider").attrs
    assert attrs["clock_shift_source"] == "estimated"
    error = abs(attrs["clock_shift_s"] - run.facts["clock_shift_at_middle_s"])
    assert error < 3 * attrs["clock_shift_uncertainty_s"] < 0.06


@pytest.fixture(scope="module")
def force_file(tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaign") / "small"
    rig.simulate_campaign(folder, seed=3, small=True)
    return sorted(folder.glob("raw/friction/*_force.csv"))[0]


def test_a_merged_run_says_what_was_estimated(force_file):
    run = tl.read(force_file)
    truth = rig.read_truth(force_file.parents[2]).facts["runs"]
    name = force_file.name.removesuffix("_force.csv")
    error = run.attrs["clock_shift_s"] - truth[name]["clock_shift_at_middle_s"]
    assert run.attrs["clock_shift_source"] == "estimated"
    assert abs(error) < 2 * run.attrs["clock_shift_uncertainty_s"] < 0.05
    assert abs(run.attrs["clock_rate"]) < 1e-4


def test_a_given_shift_is_taken_as_it_is(force_file):
    run = tl.read(force_file, clock_shift="0.25 s")
    assert run.attrs["clock_shift_s"] == 0.25
    assert run.attrs["clock_shift_source"] == "given"
    assert run.attrs["clock_rate"] == 0.0
