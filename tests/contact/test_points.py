"""Points of curves: speeds form no chains, means of few repeats cover, odd runs show."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import tribolab as tl
from tribolab.friction.points.mean_of_repeats import (
    Pooled,
    mean_of_repeats,
    pooled_between_runs,
    pooled_scatter,
)
from tribolab.friction.points.odd_repeats import odd_repeats
from tribolab.friction.points.speed_groups import speed_groups, sweeps_of


def run(speed, mu, **attrs):
    data = {"sliding_speed": speed, "friction_coefficient": mu}
    data |= {"friction_coefficient_std": 0.01 + 0 * mu, "friction_coefficient_sem": 1e-3 + 0 * mu}
    return xr.Dataset({k: ("segment", np.asarray(v, float)) for k, v in data.items()}, attrs=attrs)


def test_a_finely_stepped_curve_keeps_its_98_speeds():
    speed = np.geomspace(1e-6, 1e-2, 98)
    curve = tl.measured_stribeck_curve([run(speed, 0.5 + 0 * speed)])
    assert curve.sizes["sliding_speed"] == 98 and curve.attrs["speeds_grouped"] == "clear"


def test_repeats_whose_speeds_scatter_by_2_percent_are_one_point():
    rng = np.random.default_rng(1)
    base = np.geomspace(1e-6, 1e-2, 13)
    runs = [run(base * (1 + 0.02 * rng.standard_normal(13)), 0.5 + 0 * base) for _ in range(4)]
    curve = tl.measured_stribeck_curve(runs)
    assert curve.runs.values.tolist() == [4] * 13


def test_a_sweep_never_merges_and_set_speeds_decide():
    speed = np.geomspace(1e-3, 1.02e-3, 6) * np.array([1, 1.01, 1.02, 1.03, 1.04, 1.05])
    assert tl.measured_stribeck_curve([run(speed, 0.5 + 0 * speed)]).sizes["sliding_speed"] == 6
    stated = run(np.array([1e-3, 1.2e-3, 1.1e-3]), np.full(3, 0.5))
    stated["set_speed"] = "segment", np.array([1e-3, 1e-3, 2e-3])
    curve = tl.measured_stribeck_curve([stated])
    assert curve.segments.values.tolist() == [2, 1] and curve.attrs["speeds_grouped"] == "stated"


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1), st.integers(1, 80), st.floats(0.01, 0.5))
def test_no_group_is_wider_than_the_tolerance_and_order_does_not_matter(seed, count, tolerance):
    rng = np.random.default_rng(seed)
    speed = np.exp(rng.uniform(0, rng.choice([0.3, 3.0]), count))
    found = speed_groups(speed, tolerance)
    for group in np.unique(found.group):
        own = speed[found.group == group]
        assert own.max() / own.min() <= (1 + tolerance) * (1 + 1e-6)
    again = speed_groups(speed[::-1], tolerance)
    assert again.group[::-1].tolist() == found.group.tolist() and again.verdict == found.verdict


def test_a_run_that_goes_up_and_down_is_no_sweep():
    speed = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 5.0])
    assert (sweeps_of(np.zeros(7, int), np.arange(7), speed) == -1).all()


@pytest.mark.parametrize("ratio", [1.0, 30.0])
@pytest.mark.parametrize("between", [0.0, 2e-3])
def test_u95_of_three_runs_with_unequal_errors_covers(ratio, between):
    rng = np.random.default_rng(3)
    s = np.geomspace(1.0, ratio, 3) * 1e-3
    inside = 0
    for _ in range(300):
        y = 0.3 + between * rng.standard_normal(3) + s * rng.standard_normal(3)
        found = mean_of_repeats(y, s)
        inside += abs(found.mean - 0.3) <= found.u95
    assert inside >= 0.91 * 300


def test_two_runs_are_known_better_where_other_speeds_tell_how_runs_scatter():
    y, s = np.array([0.300, 0.303]), np.full(2, 1e-4)
    alone, helped = mean_of_repeats(y, s), mean_of_repeats(y, s, Pooled(0.01, 8.0))
    assert alone.u95 == pytest.approx(12.706 * 0.0015, rel=1e-3)
    assert 0.003 < helped.u95 < 0.5 * alone.u95


def test_an_offset_between_runs_is_seen_once_however_many_speeds_repeat_it():
    rng = np.random.default_rng(4)
    noise = 0.01 * rng.standard_normal((2, 20))
    assert pooled_between_runs(noise).dof > 10
    shifted = pooled_between_runs(noise + [[0.0], [0.3]])
    assert shifted.dof < 1.1 and shifted.scatter == pytest.approx(0.3 / np.sqrt(2), rel=0.1)
    assert pooled_scatter([np.array([1.0, 1.1]), np.array([2.0])]).dof == 1


def test_curve_states_what_repeats():
    speed, mu = np.array([1e-3, 1e-2]), np.array([0.3, 0.4])
    for specimens, words in (
        (("a", "b"), "between specimens"),
        (("a", "a"), "between runs on one specimen"),
        (("", ""), "between runs"),
    ):
        runs = [run(speed, mu, specimen=name) for name in specimens]
        assert tl.measured_stribeck_curve(runs).attrs["repeats_are"] == words


def test_u95_is_student_s_t_of_its_standard_error():
    rng = np.random.default_rng(5)
    speed = np.geomspace(1e-6, 1e-2, 9)
    runs = [run(speed, 0.4 * (1 + 0.01 * rng.standard_normal(9))) for _ in range(3)]
    curve = tl.measured_stribeck_curve(runs)
    from scipy import stats

    t = stats.t.ppf(0.975, np.minimum(curve.friction_coefficient_dof.values, 1e9))
    product = t * curve.friction_coefficient_u.values
    assert product == pytest.approx(curve.friction_coefficient_U95.values, rel=1e-5)


def test_one_of_three_repeats_that_is_off_is_named_and_sound_ones_are_not():
    rng = np.random.default_rng(6)
    groups = [0.01 * rng.standard_normal(3) for _ in range(8)]
    assert not [odd for odd in odd_repeats(groups) if odd.odd]
    groups[5][1] += 0.25
    worst = odd_repeats(groups)[0]
    assert (worst.condition, worst.repeat, worst.odd) == (5, 1, True)
    assert worst.deviation == pytest.approx(np.expm1(0.25), abs=0.05)
    assert odd_repeats(groups[5:6]) == []  # two others hardly show their scatter


@pytest.mark.parametrize("repeats", [3, 4, 6])
def test_with_one_condition_an_odd_repeat_is_told_by_the_scatter_of_the_others(repeats):
    rng = np.random.default_rng(7)
    sound = [0.01 * rng.standard_normal(repeats) for _ in range(4000)]
    alarms = sum(bool(odd_repeats([values])) for values in sound)
    assert alarms < 0.015 * len(sound)  # one campaign in a hundred
    four = np.array([0.0, 0.001, -0.001, 0.0005])
    (odd,) = odd_repeats([np.append(four, np.log(1.3))])
    assert (odd.condition, odd.repeat) == (0, 4)
    assert odd.deviation == pytest.approx(0.3, abs=0.01)
