"""Friction that changes from stroke to stroke, and noise that does not."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from scipy.signal import lfilter

import tribolab as tl
from tribolab.app.result_tables import running_in_table
from tribolab.campaign.runs.running_in import running_in_of
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.mean_error.level import levels_of
from tribolab.friction.running_in.settling import blocks_of, settling_of
from tribolab.friction.running_in.steady_part import discard_start, steady_segments
from tribolab.friction.segments.find import find_segments
from tribolab.records.runs.notices import notices_of

RATE, STROKES = 250.0, 120


def crank(rise, seed, speed=1.0):
    """A crank at 1 Hz under 15 N; friction rises by `rise` over the run."""
    time = np.arange(int(STROKES / 2 / speed * RATE)) / RATE
    rng = np.random.default_rng(seed)
    noise = lfilter([1], [1, -0.8], 0.0036 * rng.standard_normal(time.size))
    mu = 0.31 * (1 + rise * time / time[-1]) + noise
    phase = 2 * np.pi * speed * time + 0.7
    run = xr.Dataset(
        {
            "friction_force": ("time", 15.0 * mu * np.sign(np.cos(phase))),
            "normal_force": ("time", np.full(time.size, 15.0)),
            "sliding_velocity": ("time", 0.01 * np.pi * speed * np.cos(phase)),
        },
        {"time": time},
        {"stroke_m": 0.01},
    )
    segments = find_segments(run)
    return run, segments, friction_coefficient(run, segments)


def told_of(run, segments, friction):
    found, _ = running_in_of(run, friction)
    notices = notices_of("pin", run, segments, friction, running_in=found)
    return found, [notice.message for notice in notices]


@pytest.mark.parametrize("rise", [0.08, -0.05])
def test_a_rise_or_fall_along_the_run_is_reported_as_not_finished(rise):
    run, segments, friction = crank(rise, seed=3)
    (found,), told = told_of(run, segments, friction)
    change = found.last_friction_coefficient - found.first_friction_coefficient
    assert change == pytest.approx(0.95 * 0.31 * rise, rel=0.15)
    assert found.steady_friction_coefficient is None and found.is_unsteady
    word = "rises" if rise > 0 else "falls"
    assert sum(f"friction {word} along the run, from" in message for message in told) == 1
    assert any("outside the middle 50 % of the length" in message for message in told)


def test_noise_is_no_trend_along_the_run_nor_within_a_stroke():
    for seed in range(4):
        (found,), told = told_of(*crank(0.0, seed))
        assert found.verdict == "none" and not found.text
        assert not any("with a significant trend" in message for message in told)
        off = abs(found.steady_friction_coefficient - 0.31)
        assert off < 2 * found.steady_friction_coefficient_U95


@pytest.mark.parametrize(
    "course",
    [
        0.3 * (1 + 0.077 * np.linspace(-0.5, 0.5, 200)),
        0.12 + 0.03 * np.exp(-np.arange(200) / 25),
        0.25 - 0.05 * np.exp(-np.arange(200) / 60),
    ],
)
def test_how_friction_changes_along_a_run_is_no_error_of_its_mean(course):
    """The mean is one over the run: its error is that about the course, as repeats show it."""
    rng = np.random.default_rng(11)
    curves = []
    for _ in range(25):
        mu = course + 0.006 * rng.standard_normal(200)
        friction = {"friction_coefficient": mu, "friction_coefficient_std": np.full(200, 0.01)}
        friction |= {"friction_coefficient_sem": np.full(200, 0.004)}
        friction |= {"sliding_speed": np.full(200, 0.01)}
        run = xr.Dataset({name: ("segment", values) for name, values in friction.items()})
        curves.append(tl.measured_stribeck_curve([run]))
    means = [float(curve.friction_coefficient[0]) for curve in curves]
    errors = [float(curve.friction_coefficient_sem[0]) for curve in curves]
    wide = [float(curve.friction_coefficient_U95[0]) for curve in curves]
    assert 0.7 * np.std(means) < np.median(errors) < 1.6 * np.std(means)
    off = np.abs(np.array(means) - course.mean())
    assert np.mean(off < wide) >= 0.9


# values, noise's standard deviation 1, level 30 as of friction strokes (0.3 +- 0.01)
T = np.arange(400) / 400
COURSES = {
    "none": 0 * T,
    "running-in": 5 * np.exp(-T / 0.1),
    "step": -3.0 * (T > 0.3),
    "not finished": 5 * np.exp(-T / 0.6),
}


@pytest.mark.parametrize("kind", COURSES)
def test_running_in_is_found_where_it_is_and_the_steady_mean_is_covered(kind):
    """At least 18 of 20 right, and 17 of 20 intervals hold the mean (95 % of 20: 16 or more)."""
    rng = np.random.default_rng(8)
    found, inside = [], []
    for _ in range(20):
        values = 30 + COURSES[kind] + rng.standard_normal(T.size)
        found.append(settling_of(values))
        part = slice(found[-1].start, found[-1].stop)
        if found[-1].is_steady:
            level = levels_of(blocks_of(values[part], 384)[None])
            off = abs(values[part].mean() - 30 - COURSES[kind][part].mean())
            inside.append(off < level.u95[0])
    assert sum(each.kind == kind for each in found) >= 18
    assert not inside or np.mean(inside) >= 0.85
    start = np.median([each.start / T.size for each in found if each.is_steady] or [np.nan])
    true = {"none": 0.0, "running-in": 0.1 * np.log(5 / 0.3), "step": 0.3}
    assert kind not in true or start == pytest.approx(true[kind], abs=0.02)


def test_a_change_at_the_end_of_a_run_is_not_steady():
    rng = np.random.default_rng(9)
    late = 5 * (T > 0.85) * (1 - np.exp(-(T - 0.85) / 0.05))
    found = settling_of(30 + 5 * np.exp(-T / 0.05) + late + rng.standard_normal(T.size))
    assert found.start / T.size == pytest.approx(0.14, abs=0.05)
    assert found.stop / T.size == pytest.approx(0.86, abs=0.03)


def pin_on_disc(settles=45.0):
    """A pin at 0.1 m/s under 10 N over 540 m; its wear depth grows with the distance."""
    rng = np.random.default_rng(5)
    time = np.arange(0.0, 5400.0, 2.0)
    mu = 0.31 + 0.3 * np.exp(-0.1 * time / settles) + 0.01 * rng.standard_normal(time.size)
    data = {"friction_force": 10 * mu, "normal_force": np.full(time.size, 10.0)}
    data |= {"set_speed": np.full(time.size, 0.1), "height_displacement": 1e-8 * time}
    return xr.Dataset({name: ("time", values) for name, values in data.items()}, {"time": time})


def test_friction_that_first_rises_runs_in_after_its_peak():
    rng = np.random.default_rng(11)
    t = np.arange(2000) / 2000
    course = 0.55 + 0.25 * np.exp(-t / 0.13) - 0.3 * np.exp(-t / 0.027)
    found = settling_of(course + 0.003 * rng.standard_normal(t.size))
    assert found.kind == "running-in" and found.stop == t.size
    assert abs(course[found.start] / 0.55 - 1) < 0.012  # one per cent from the steady value
    assert 0.3 < found.start / t.size < 0.55


def test_a_pin_on_disc_runs_in_over_a_distance():
    run = pin_on_disc()
    found = tl.running_in(run)
    true = 45 * np.log(0.3 / 0.0031)
    assert found.running_in == "running-in" and found.counted == "stretches"
    off = abs(float(found.running_in_distance) - true)
    assert off < 3 * float(found.running_in_distance_u) and off < 20
    error = float(found.steady_friction_coefficient_U95)
    assert error < 0.003  # what is left of the running-in, 1 % of 0.31, counts as a wander
    assert abs(float(found.steady_friction_coefficient) - 0.31) < error
    assert float(found.wear_depth[-1]) == pytest.approx(5.4e-5, rel=0.01)
    with pytest.raises(tl.TribolabError, match="at least|at one speed"):
        tl.running_in(run.isel(time=slice(0, 15)))


@pytest.mark.parametrize(("discard", "start"), [("50 m", 500.0), ("10 min", 600.0)])
def test_the_beginning_of_a_run_is_discarded(discard, start):
    run = pin_on_disc()
    segments = discard_start(find_segments(run, trim=0), discard)
    assert segments.trimmed_start.item() == pytest.approx(start)
    assert segments.omitted_reason.values.tolist()[-1] == "discarded"
    own = run.sel(time=slice(start, None))
    mu = friction_coefficient(run, segments).friction_coefficient.item()
    assert mu == pytest.approx(float(own.friction_force.mean()) / 10, rel=1e-6)


def test_cycles_are_discarded_and_the_steady_part_is_taken():
    run, segments, friction = crank(0.0, seed=1)
    left = discard_start(segments, "10 cycles")
    assert left.sizes["segment"] == segments.sizes["segment"] - 20
    assert steady_segments(run, segments, friction).sizes["segment"] == segments.sizes["segment"]
    pin = pin_on_disc()
    whole = find_segments(pin)
    part = steady_segments(pin, whole, friction_coefficient(pin, whole))
    mu = friction_coefficient(pin, part).friction_coefficient.item()
    assert part.trimmed_start.item() > 1500 and abs(mu - 0.31) < 0.001


def test_the_terminal_shows_where_runs_settle_their_steady_and_their_mean_friction():
    run = pin_on_disc()
    records, _ = running_in_of(run, friction_coefficient(run, find_segments(run)))
    entry = SimpleNamespace(record=SimpleNamespace(facts=SimpleNamespace(running_in=records)))
    outcome = SimpleNamespace(
        runs=[SimpleNamespace(name="pin")], store=SimpleNamespace(get=lambda *_: entry)
    )
    table = running_in_table(outcome)
    name, over, steady, mean = (next(iter(column.cells)) for column in table.columns)
    assert name == "pin" and over.endswith(" of 540 m")
    settled, whole = (float(text.split(" ±")[0]) for text in (steady, mean))
    assert settled == pytest.approx(0.31, abs=0.002)
    assert whole == pytest.approx(0.31 + 0.3 * 45 / 540, abs=0.002)
    assert running_in_table(replace_runs(outcome, 13)) is None


def replace_runs(outcome, count):
    """The same, of so many runs."""
    return SimpleNamespace(runs=outcome.runs * count, store=outcome.store)
