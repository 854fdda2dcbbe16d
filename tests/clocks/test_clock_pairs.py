"""Clocks of a force log and a motion log are matched within the stated error, or not at all."""

from __future__ import annotations

import numpy as np
import pytest
from clock_pairs import KINDS, make_pair, play, write_pair
from typer.testing import CliRunner

import tribolab as tl
from tribolab.cli import app
from tribolab.core.errors import ReadError
from tribolab.qc.run.checks import check_run
from tribolab.reading.clocks.basis import Play
from tribolab.reading.clocks.merge import merge
from tribolab.reading.clocks.motion import clean_motion
from tribolab.reading.signals import signals_of

# short logs of every kind and protocol; tests/coverage/clock_shift_coverage.py takes hundreds
PAIRS = {
    "clean": (502, "sweep"),
    "inertia": (503, "strokes"),
    "stick of the stage": (502, "steps"),
    "stick of the sample": (506, "sine"),
    "slack": (504, "sweep"),
    "hysteresis": (506, "sweep"),
    "noise and drift": (505, "sweep"),
    "rates": (504, "sweep"),
    "clock rate": (506, "sweep"),
    "everything": (504, "steps"),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_shift_that_is_told_lies_within_three_standard_errors(kind):
    seed, protocol = PAIRS[kind]
    pair = make_pair(seed, kind)
    assert pair.protocol == protocol
    attrs = merge(signals_of(pair.force), signals_of(pair.motion)).attrs
    assert attrs["clock_shift_source"] == "estimated"
    error = abs(attrs["clock_shift_s"] - pair.shift)
    assert error < 3.0 * attrs["clock_shift_uncertainty_s"] < 0.3 * pair.shortest
    assert "classes" in attrs["clock_shift_ways"] and len(attrs["clock_shift_ways"]) > 1


def test_slack_follows_its_closed_form():
    x = np.concatenate([np.arange(0.0, 5.0, 0.125), np.arange(5.0, -5.0, -0.125)])
    for follow in (play, lambda at, half: Play(at).followed(half)):
        driven = follow(x, 1.0)
        back = driven[40:]  # 2 m of slack, then as far behind as before on the other side
        np.testing.assert_allclose(driven[8:40], x[8:40] - 1.0)
        np.testing.assert_allclose(back[2:], np.minimum(driven[39:41].max(), x[42:] + 1.0))


@pytest.mark.parametrize("noise", [0.0, 1e-4, 1e-3])
def test_rest_is_rest_though_the_velocity_is_noisy(noise):
    rng = np.random.default_rng(1)
    t = np.arange(0.0, 20.0, 0.01)
    true = np.where((t > 5) & (t < 10), 0.1, 0.0) - np.where((t > 12) & (t < 17), 0.05, 0.0)
    motion = clean_motion(t, true + noise * rng.standard_normal(len(t)))
    wrong = motion.way != np.sign(true)
    assert wrong.sum() <= 8
    assert np.all(motion.velocity[motion.way == 0] == 0)


def counted(way, at, every):
    """Velocity of an encoder that counts once in so many samples while the table moves one way."""
    path = np.cumsum(
        np.where((at > 2) & (at < 8), way / every, 0.0) + 3.0 * ((at > 10) & (at < 12))
    )
    return np.gradient(np.floor(path + 0.5), at)


@pytest.mark.parametrize("every", [7, 16, 50])
def test_a_stroke_so_slow_that_counts_come_now_and_then_is_a_stroke(every):
    at = 1e-3 * np.arange(14_000)
    for way in (1, -1):
        motion = clean_motion(at, counted(way, at, every))
        slow = (at > 2.1) & (at < 7.9)
        assert np.all(motion.way[slow] == way)
        np.testing.assert_allclose(motion.velocity[slow].mean(), way * 1e3 / every, rtol=0.01)
        assert not motion.way[(at < 1.9) | ((at > 8.1) & (at < 9.9)) | (at > 12.1)].any()


def test_an_encoder_that_trembles_between_two_counts_rests():
    at = 1e-3 * np.arange(14_000)
    trembling = np.where((at > 2) & (at < 8), (at * 50 % 1 < 0.5), 0)
    velocity = np.gradient(trembling + np.cumsum(3.0 * ((at > 10) & (at < 12))), at)
    assert not clean_motion(at, velocity).way[at < 9].any()


@pytest.mark.slow
def test_strokes_lost_in_slack_leave_the_shift_open():
    """Three slow strokes only take up slack: the starts that are seen are not the first ones."""
    pair = make_pair(569, "slack")
    attrs = merge(signals_of(pair.force), signals_of(pair.motion)).attrs
    assert attrs["clock_shift_source"] == "none"
    assert "do not tell whether they are seen" in attrs["clock_shift_refused"]
    assert np.isnan(attrs["clock_shift_uncertainty_s"])


def repeated(dated: bool):
    """Strokes of one speed without an end: both logs begin and end within the motion."""
    pair = make_pair(0, "clean", "strokes")
    rng = np.random.default_rng(3)
    time = np.arange(0.0, 40.0, 0.005)
    way = np.where(time % 4.0 < 2.0, 1.0, -1.0)
    date = {"recorded_at": "2026-03-02T09:12:31"} if dated else {}
    force = pair.force.isel(time=slice(0, 1)).drop_vars("friction_force").drop_dims("time")
    force = force.assign(
        friction_force=("time", 5 * way + 0.05 * rng.standard_normal(len(time)))
    ).assign_coords(time=time)
    motion = force.drop_vars("friction_force").assign(sliding_velocity=("time", 1e-2 * way))
    motion = motion.isel(time=slice(600, -600))
    motion = motion.assign_coords(time=motion["time"].values - 3.0)
    force.attrs = pair.force.attrs | date | {"time_origin_s": 0.0}
    motion.attrs = pair.motion.attrs | {"time_origin_s": 0.0}
    if dated:
        motion.attrs["recorded_at"] = "2026-03-02T09:12:34"
    return force, motion


def test_motion_that_repeats_without_end_tells_no_shift():
    attrs = merge(*map(signals_of, repeated(dated=False))).attrs
    assert attrs["clock_shift_source"] == "none"
    assert "the motion repeats" in attrs["clock_shift_refused"]


def files(folder, motion_date, force_date="2026-03-02T09:12:31"):
    pair = make_pair(3, "clean", "sweep")
    pair.force.attrs["recorded_at"] = force_date
    pair.motion.attrs["recorded_at"] = motion_date
    return pair, write_pair(pair, folder)


def test_info_says_that_the_companion_was_found_and_how_its_clock_was_matched(tmp_path):
    pair, file = files(tmp_path, "2026-03-02T09:12:31")
    text = CliRunner().invoke(app, ["info", str(file)]).output
    assert "companion log: found (linear_slider_motion)" in text
    assert "from the starts of motion: " in text
    assert "from classes of velocity: " in text
    stated = text.split("clock shift: ")[1].split()
    assert abs(float(stated[0]) - pair.shift) < 3 * float(stated[4])
    file.with_name(file.name.replace("_force", "_motion")).unlink()
    text = CliRunner().invoke(app, ["info", str(file)]).output
    assert "companion log: a_31N_01_motion.csv does not exist" in text


def test_a_companion_of_another_day_is_refused_until_the_shift_is_stated(tmp_path):
    pair, file = files(tmp_path, "2026-03-05T09:12:31")
    with pytest.raises(ReadError, match="another run's log.*give clock_shift="):
        tl.read(file)
    assert "companion log: refused" in CliRunner().invoke(app, ["info", str(file)]).output
    assert tl.read(file, clock_shift=pair.shift).attrs["clock_shift_source"] == "given"
    assert "sliding_velocity" not in tl.read(file, pair=False)


@pytest.mark.slow
def test_a_companion_of_the_run_before_fails_and_asks_for_the_shift(tmp_path):
    _, file = files(tmp_path, "2026-03-02T09:32:31")
    run = tl.read(file)
    assert run.attrs["clock_shift_source"] == "none"
    [found] = [row for row in check_run(run).rows if row["check"] == "clock_shift"]
    assert found["status"] == "fail"
    assert "by their dates" in found["message"] and "state clock_shift" in found["message"]
    assert "state clock_shift" in CliRunner().invoke(app, ["info", str(file)]).output
