"""Friction coefficients: offsets removed, errors that cover the truth, nothing silent."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from made_runs import strokes, with_friction
from real_runs import actuator, paper, reciprocating, rock

from tribolab.core.errors import AnalysisError
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.coefficient.steadiness import IS_NOT_STEADY, IS_STEADY, NOT_DECIDED, judged
from tribolab.friction.segments.find import find_segments
from tribolab.friction.zero.offsets import wander

MU = 0.3


def analysed(run, **options):
    return friction_coefficient(run, find_segments(run), **options)


def small(seed=0, **options):
    """Three speeds both ways, 300 samples each, with forces."""
    return with_friction(strokes([1e-5, 1e-4, 1e-3], samples=300, seed=seed), seed=seed, **options)


def loaded_later(run, load=31.0, zero_force=0.0, zero_load=0.0, seed=0):
    """Put an unloaded rest of 200 samples before the run, and zero errors on both sensors."""
    rng = np.random.default_rng(seed)
    n, count = run.sizes["time"], 200
    dt = 0.01
    time = np.concatenate([np.arange(count) * dt, count * dt + run["time"].values])

    def joined(name, before, zero):
        values = np.concatenate([before, run[name].values]) + zero
        return "time", values

    return xr.Dataset(
        {
            "sliding_velocity": joined("sliding_velocity", 1e-7 * rng.standard_normal(count), 0.0),
            "friction_force": joined(
                "friction_force", 0.05 * rng.standard_normal(count), zero_force
            ),
            "normal_force": joined("normal_force", 0.05 * rng.standard_normal(count), zero_load),
        },
        {"time": time},
        attrs={"source": "made.csv", "n": n},
    )


# real files


@pytest.mark.parametrize(
    ("name", "half_loop"),
    [("Circle_1bar", 5.631), ("Kidney_2bar", 12.541), ("O-ring257_1bar", 7.002)],
)
def test_actuator_half_loop_is_the_independent_one(shared_data, name, half_loop):
    run = actuator(shared_data, name)
    friction = friction_coefficient(run, find_segments(run, position_range=("5 mm", "32 mm")))
    assert friction.attrs["offset"] == "half loop"
    assert friction["pair"].values.max() == 9
    assert friction["half_loop"].values.mean() == pytest.approx(half_loop, rel=0.01)
    assert "friction_coefficient" not in friction  # no normal force was recorded


def test_rock_coefficients_before_and_after_the_step(shared_data):
    friction = analysed(rock(shared_data))
    assert friction["friction_coefficient"].values == pytest.approx([0.60758, 0.60796], rel=0.002)
    assert friction["friction_coefficient_std"].values == pytest.approx([0.00071, 0.00091], rel=0.1)
    assert (friction["friction_coefficient_sem"] < friction["friction_coefficient_std"]).all()


@pytest.mark.parametrize(
    ("stiffness", "speed", "mean", "std"),
    [
        (168, 1100, 0.33409, 0.03671),
        (168, 4300, 0.5039, 0.04133),
        (1002, 4300, 0.2918, 0.05044),
        (2254, 1100, 0.33516, 0.04292),
    ],
)
def test_paper_on_paper_means_and_deviations(shared_data, stiffness, speed, mean, std):
    run = paper(shared_data, stiffness, speed)
    friction = friction_coefficient(run, find_segments(run, trim=0))
    assert friction["friction_coefficient"].item() == pytest.approx(mean, rel=0.002)
    assert friction["friction_coefficient_std"].item() == pytest.approx(std, rel=0.002)


def test_reciprocating_steps_pair_though_no_speed_was_recorded(shared_data):
    friction = analysed(reciprocating(shared_data))
    assert friction.attrs["velocity_source"] == "step"
    assert friction["direction"].values.tolist() == [-1, 1]
    assert friction["pair"].values.tolist() == [0, 0]
    assert (friction["friction_coefficient"].values > 0.5).all()


# closed forms


def test_coefficient_is_the_mean_of_the_pointwise_ratio_and_std_its_sample_deviation():
    run = small(scatter=0.01)
    segments = find_segments(run)
    friction = friction_coefficient(run, segments, offset="none")
    first = segments.isel(segment=0)
    time = run["time"].values
    inside = (time >= first["trimmed_start"].item()) & (time <= first["trimmed_stop"].item())
    ratio = (run["friction_force"].values / run["normal_force"].values)[inside]
    assert friction["friction_coefficient"].values[0] == pytest.approx(ratio.mean(), rel=1e-12)
    assert friction["friction_coefficient_std"].values[0] == pytest.approx(ratio.std(ddof=1))
    assert friction["samples"].values[0] == ratio.size


def test_both_directions_come_out_positive():
    friction = analysed(small())
    assert friction["direction"].values.tolist() == [1, -1] * 3
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, abs=0.002)


def test_half_loop_and_offset_of_a_pair_are_half_difference_and_half_sum():
    run = small(offset=4.0, scatter=0.0)
    friction = analysed(run)
    assert friction.attrs["offset"] == "half loop"
    assert friction["friction_force_offset"].values == pytest.approx([4.0] * 6, abs=0.02)
    assert friction["half_loop"].values == pytest.approx([MU * 31] * 6, rel=0.002)
    assert friction["pair"].values.tolist() == [0, 0, 1, 1, 2, 2]
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, rel=0.002)
    assert friction["sliding_speed"].values[::2] == pytest.approx([1e-5, 1e-4, 1e-3], rel=0.01)


@pytest.mark.parametrize("offset", ["auto", "half loop"])
def test_strokes_of_a_pair_share_one_error(offset):
    friction = analysed(small(scatter=0.02, seed=3), offset=offset)
    sem = friction["friction_coefficient_sem"].values
    assert sem[::2] == pytest.approx(sem[1::2], rel=0.01)


def test_zero_of_the_normal_force_is_taken_from_the_rest_without_load():
    run = loaded_later(small(scatter=0.0), zero_load=3.0)
    friction = analysed(run)
    assert friction["normal_force_offset"].values == pytest.approx([3.0] * 6, abs=0.02)
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, rel=0.003)
    raw = analysed(run, offset="none")["friction_coefficient"].values
    assert raw == pytest.approx([MU * 31 / 34] * 6, rel=0.003)


def test_zero_load_removes_the_offset_of_strokes_one_way():
    one_way = strokes([1e-5, 1e-4, 1e-3], both_ways=False, samples=300)
    run = loaded_later(with_friction(one_way, scatter=0.0), zero_force=2.0)
    friction = analysed(run)
    assert friction.attrs["offset"] == "zero load"
    assert friction["friction_force_offset"].values == pytest.approx([2.0] * 3, abs=0.02)
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 3, rel=0.003)
    # the error of the zero is part of the error: 0.05 N / sqrt(200) over 31 N
    assert (friction["friction_coefficient_sem"].values > 0.8 * 0.05 / np.sqrt(200) / 31).all()


def test_load_ramp_within_the_first_rest_does_not_shift_the_zero():
    run = loaded_later(small(scatter=0.0), zero_load=1.0)
    normal = run["normal_force"].values.copy()
    normal[150:200] = 1.0 + np.linspace(0, 31, 50)
    friction = analysed(run.assign(normal_force=("time", normal)))
    assert friction["normal_force_offset"].values == pytest.approx([1.0] * 6, abs=0.05)


def test_no_offset_to_be_had_is_said():
    friction = analysed(with_friction(strokes([1e-4, 1e-3], both_ways=False)))
    assert friction.attrs["offset"].startswith("none: no pair")


@pytest.mark.slow
def test_error_of_the_half_loop_covers_the_truth():
    # offset, white noise on the force; the mean of each stroke wanders by itself
    errors = []
    for seed in range(16):
        friction = analysed(small(seed=seed, offset=5.0, scatter=0.02))
        error = friction["friction_coefficient"].values - MU
        errors.append((error / friction["friction_coefficient_sem"].values)[::2])
    errors = np.abs(np.concatenate(errors))
    assert 0.60 <= np.mean(errors < 1) <= 0.90
    assert np.mean(errors < 3) >= 0.99


def test_movement_of_the_zero_from_pair_to_pair_is_told_from_its_own_errors():
    rng = np.random.default_rng(0)
    time, error = 10.0 * np.arange(60), np.full(60, 0.1)
    quiet, fast, walk = [], [], []
    for _ in range(40):
        noise = 0.1 * rng.standard_normal(60)
        quiet.append(wander(noise, error, time))
        fast.append(wander(noise + 0.5 * rng.standard_normal(60), error, time))
        walk.append(wander(noise + np.cumsum(0.5 * rng.standard_normal(60)), error, time))
    # <d^2> beyond the errors: 2 x 0.5^2 for a zero that is new each time, 0.5^2 for one that walks
    beyond = [np.mean([w.fast + 10 * w.rate for w in found]) for found in (quiet, fast, walk)]
    assert beyond[0] < 0.04
    assert beyond[1] == pytest.approx(0.5, rel=0.5)
    assert beyond[2] == pytest.approx(0.25, rel=0.5)
    assert wander(np.array([1.0]), np.array([0.1]), np.array([0.0])) == (0, 0)


def test_load_that_differs_between_the_strokes_does_not_pass_for_an_offset():
    run = small(offset=2.0, scatter=0.0)
    backward = run["friction_force"].values < 0
    heavier = {k: np.where(backward, 1.2, 1.0) * run[k].values for k in ("normal_force",)}
    force = np.where(backward, 1.2, 1.0) * (run["friction_force"].values - 2.0) + 2.0
    run = run.assign(normal_force=("time", heavier["normal_force"]), friction_force=("time", force))
    friction = analysed(run)
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, rel=0.003)
    assert friction["friction_force_offset"].values == pytest.approx([2.0] * 6, abs=0.05)


def test_trend_within_a_segment_is_reported_and_not_steady():
    run = small()
    time = run["time"].values
    rising = run["friction_force"].values * (1 + 0.2 * time / time[-1])
    friction = analysed(run.assign(friction_force=("time", rising)))
    assert (friction["trend"].values > 0).all()
    assert friction["steady"].values.tolist() == [0] * 6
    steady = analysed(run)["trend_p_value"].values
    assert np.count_nonzero(steady < 0.01) == 0


@pytest.mark.parametrize(
    ("change", "chance", "samples", "verdict"),
    [
        (0.001, 0.4, 300, IS_STEADY),
        (0.2, 1e-4, 300, IS_NOT_STEADY),
        (-0.2, 0.36, 2.8, NOT_DECIDED),
        (-6.2, 0.36, 2.8, NOT_DECIDED),
        (-6.2, 0.03, 300, NOT_DECIDED),
        (0.2, np.nan, 300, NOT_DECIDED),
    ],
)
def test_what_cannot_be_decided_is_not_called_steady(change, chance, samples, verdict):
    columns = {"trend_change": change, "trend_p_value": chance, "effective_samples": samples}
    made = xr.Dataset({k: ("segment", [v]) for k, v in columns.items()})
    steady = judged(made.assign(friction_coefficient=("segment", [1.0])))["steady"]
    assert steady.values.tolist() == [verdict]
    words = steady.attrs["flag_meanings"].split()
    assert words[steady.attrs["flag_values"].tolist().index(NOT_DECIDED)] == "undecided"


# what is missing


@pytest.mark.parametrize(
    ("normal", "remark"),
    [(0.0, "no contact"), (-5.0, "no contact"), (np.nan, "normal force is not a number")],
)
def test_segment_without_contact_is_missing_and_says_why(normal, remark):
    run = small()
    segments = find_segments(run)
    lost = segments.isel(segment=2)
    time = run["time"].values
    inside = (time >= lost["start"].item()) & (time <= lost["stop"].item())
    values = np.where(inside, normal, run["normal_force"].values)
    friction = friction_coefficient(run.assign(normal_force=("time", values)), segments)
    mu = friction["friction_coefficient"].values
    assert np.isnan(mu[2])
    assert friction["remark"].values[2].startswith(remark)
    assert np.isfinite(np.delete(mu, 2)).all()
    assert friction["steady"].values[2] == NOT_DECIDED


def test_normal_force_of_zero_everywhere_gives_no_number_anywhere():
    run = small()
    zero = run.assign(normal_force=("time", np.zeros(run.sizes["time"])))
    friction = analysed(zero)
    assert np.isnan(friction["friction_coefficient"].values).all()
    assert all(remark.startswith("no contact") for remark in friction["remark"].values)
    assert np.isfinite(friction["friction_force"].values).all()


def test_few_samples_without_contact_are_left_out_and_counted():
    run = small()
    normal = run["normal_force"].values.copy()
    first = int(np.searchsorted(run["time"].values, find_segments(run)["start"].values[0])) + 100
    normal[first : first + 3] = -1.0
    friction = analysed(run.assign(normal_force=("time", normal)))
    assert friction["remark"].values[0] == "3 samples without contact left out"
    assert friction["friction_coefficient"].values[0] == pytest.approx(MU, abs=0.003)


def test_run_without_segments_gives_an_empty_table():
    run = small()
    still = run.assign(sliding_velocity=("time", np.zeros(run.sizes["time"])))
    friction = analysed(still)
    assert friction.sizes["segment"] == 0


def test_rectified_coefficient_keeps_its_sign_in_both_directions():
    made = strokes([1e-4, 1e-3])
    run = made.run.assign(friction_coefficient=("time", np.full(made.run.sizes["time"], 0.4)))
    friction = analysed(run)
    assert friction["friction_coefficient"].values == pytest.approx([0.4] * 4)
    assert "without sign" in friction.attrs["offset"]


def test_signed_coefficient_pairs_like_forces_do():
    made = strokes([1e-4, 1e-3], samples=300)
    forces = with_friction(made, scatter=0.0)
    ratio = forces["friction_force"].values / forces["normal_force"].values + 0.05
    friction = analysed(made.run.assign(friction_coefficient=("time", ratio)))
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 4, abs=1e-9)
    assert friction["friction_coefficient_offset"].values == pytest.approx([0.05] * 4)


# errors


def test_segments_of_another_run_are_an_error():
    run = small()
    segments = find_segments(strokes(samples=2000).run)
    with pytest.raises(AnalysisError, match="outside this run"):
        friction_coefficient(run, segments)
    own = find_segments(run)
    with pytest.raises(AnalysisError, match="another file"):
        friction_coefficient(
            run.assign_attrs(source_sha256="a"), own.assign_attrs(source_sha256="b")
        )


def test_run_without_friction_is_an_error():
    run = strokes([1e-3]).run
    with pytest.raises(AnalysisError, match="no friction force or coefficient"):
        analysed(run)


def test_unknown_offset_names_the_nearest():
    with pytest.raises(AnalysisError, match="did you mean 'half loop'"):
        analysed(small(), offset="half_loop")


def test_offset_that_cannot_be_had_is_an_error():
    run = with_friction(strokes([1e-4, 1e-3], both_ways=False))
    with pytest.raises(AnalysisError, match="half loop"):
        analysed(run, offset="half loop")
    with pytest.raises(AnalysisError, match="zero load"):
        analysed(run, offset="zero load")


# properties

runs = st.integers(0, 10_000).map(lambda seed: small(seed=seed, scatter=0.01))


@pytest.mark.slow
@settings(deadline=None, max_examples=4)
@given(runs)
def test_reversing_velocity_and_force_changes_nothing(run):
    reverse = run.assign({k: -run[k] for k in ("sliding_velocity", "friction_force")})
    a, b = analysed(run), analysed(reverse)
    for name in ("friction_coefficient", "friction_coefficient_std", "friction_coefficient_sem"):
        assert b[name].values == pytest.approx(a[name].values, rel=1e-9)


@pytest.mark.slow
@settings(deadline=None, max_examples=4)
@given(runs, st.floats(1e-3, 1e3))
def test_scaling_both_forces_changes_nothing(run, scale):
    scaled = run.assign({k: scale * run[k] for k in ("normal_force", "friction_force")})
    a, b = analysed(run), analysed(scaled)
    assert b["friction_coefficient"].values == pytest.approx(a["friction_coefficient"].values)
    assert b["half_loop"].values == pytest.approx(scale * a["half_loop"].values)


@pytest.mark.slow
@settings(deadline=None, max_examples=4)
@given(runs, st.floats(-50, 50))
def test_constant_offset_leaves_paired_forces_unchanged(run, offset):
    shifted = run.assign(friction_force=run["friction_force"] + offset)
    a, b = analysed(run), analysed(shifted)
    assert b["half_loop"].values == pytest.approx(a["half_loop"].values)
    assert b["friction_force"].values == pytest.approx(a["friction_force"].values)
    # the ratio is pointwise: what the offset does to it is taken out before the division
    assert b["friction_coefficient"].values == pytest.approx(a["friction_coefficient"].values)


@pytest.mark.slow
@settings(deadline=None, max_examples=4)
@given(runs, st.floats(0, 1e4))
def test_shifting_time_leaves_all_unchanged(run, shift):
    later = run.assign_coords(time=run["time"].values + shift)
    a, b = analysed(run), analysed(later)
    for name in ("friction_coefficient", "friction_coefficient_std"):
        assert b[name].values == pytest.approx(a[name].values, rel=2e-2, abs=2e-5)


@pytest.mark.slow
@settings(deadline=None, max_examples=4)
@given(st.integers(0, 10_000))
def test_taking_every_other_sample_leaves_the_coefficient_within_its_error(seed):
    run = small(seed=seed, scatter=0.01)
    a, b = analysed(run), analysed(run.isel(time=slice(None, None, 2)))
    apart = np.abs(a["friction_coefficient"].values - b["friction_coefficient"].values)
    assert (apart < 5 * b["friction_coefficient_sem"].values).all()
