"""Friction that changes from stroke to stroke, and noise that does not."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.signal import lfilter

import tribolab as tl
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.segments.find import find_segments
from tribolab.records.notices import notices_of
from tribolab.records.run_trend import trends_along
from tribolab.report.page.in_short import in_short

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


@pytest.mark.parametrize("rise", [0.08, -0.05])
def test_a_rise_or_fall_along_the_run_is_told_with_both_ends(rise):
    run, segments, friction = crank(rise, seed=3)
    (trend,) = trends_along(friction, friction["friction_coefficient"].values)
    off = trend.last - trend.first - 0.9 * 0.31 * rise  # between the middles of both tenths
    assert abs(off) < 4 * trend.error and trend.error < 0.1 * 0.31 * abs(rise)
    told = [notice.message for notice in notices_of("pin", run, segments, friction)]
    word = "rises" if rise > 0 else "falls"
    assert sum(f"friction {word} along the run from" in message for message in told) == 1
    assert any(message.startswith("what lies outside the middle 50 %") for message in told)


def test_noise_is_no_trend_along_the_run_nor_within_a_stroke():
    for seed in range(10):
        run, segments, friction = crank(0.0, seed)
        assert trends_along(friction, friction["friction_coefficient"].values) == []
        told = [notice.message for notice in notices_of("pin", run, segments, friction)]
        assert not any("with a significant trend" in message for message in told)


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
    for _ in range(40):
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


def strokes(mu):
    values = {"friction_coefficient": mu, "sliding_speed": np.full(mu.size, 0.01)}
    values |= {f"trimmed_{end}": n + np.arange(mu.size) for n, end in enumerate(("start", "stop"))}
    values |= {"start": np.arange(mu.size), "stop": 1.0 + np.arange(mu.size)}
    return xr.Dataset({name: ("segment", of) for name, of in values.items()})


@pytest.mark.parametrize("depth", [0.08, -0.05])
def test_a_run_in_is_told_by_where_it_begins_and_settles(depth):
    n, rng = np.arange(200), np.random.default_rng(4)
    mu = 0.2 + depth * np.exp(-n / 12) + 0.002 * rng.standard_normal(n.size)
    (found,) = trends_along(strokes(mu), mu)
    assert found.settles and abs(found.last - 0.2) < 4 * found.error
    first = float((0.2 + depth * np.exp(-n[:20] / 12)).mean())
    assert found.first == pytest.approx(first, abs=0.003)
    assert found.text.endswith("the mean holds the run-in")


def test_noise_settles_nowhere():
    rng = np.random.default_rng(9)
    for _ in range(30):
        mu = 0.2 + 0.002 * rng.standard_normal(200)
        assert trends_along(strokes(mu), mu) == []


def test_what_changes_along_a_run_stands_above_the_cards():
    def finding(run, message):
        return {"run": run, "message": message}

    told = [finding("pin", "friction falls along the run from 0.2 to 0.1"), finding("pin", "else")]
    assert in_short({"curves": [], "findings": told}) == [
        "pin: friction falls along the run from 0.2 to 0.1."
    ]
    many = [finding(f"pin {n}", "friction rises along the run") for n in range(7)]
    assert in_short({"curves": [], "findings": many}) == ["Friction changes along 7 runs."]
