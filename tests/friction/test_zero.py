"""What the zero of the friction force rests on: drift, direction, lost sign, speed, nothing."""

import numpy as np
import pytest
import xarray as xr
from made_runs import strokes, with_friction
from real_runs import actuator, rock
from zero_cases import BOTH, LOAD, MU, SPEED, analysed, doubts, off, programme

from tribolab.core.errors import AnalysisError
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.segments.find import find_segments
from tribolab.friction.zero.middles import middles
from tribolab.friction.zero.offsets import wander
from tribolab.friction.zero.rectified import ForceTrace, Pressed, folded
from tribolab.friction.zero.rests import Zeros
from tribolab.qc.run.checks import check_run
from tribolab.reading.run_files import read

# drift


@pytest.mark.parametrize("total", [-9.0, 3.0])
def test_linear_drift_of_the_zero_over_six_pairs_leaves_nothing(total):
    run = programme(BOTH * 6, zero=lambda u: 1.0 + total * u, loaded_rests=True, noise=1e-6)
    friction = analysed(run)
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 12, abs=2e-5)
    # without following the drift: half of what passes between the strokes of a pair
    middle = (friction["trimmed_start"] + friction["trimmed_stop"]).values / 2
    passed = total * (middle[1] - middle[0]) / run["time"].values[-1]
    raw = friction["friction_force"] + friction["direction"] * friction["friction_force_offset"]
    biased = (raw.values[0] + raw.values[1]) / 2 / LOAD
    assert biased - MU == pytest.approx(-passed / 2 / LOAD, rel=0.02)
    assert friction["half_loop"].values == pytest.approx([MU * LOAD] * 12, abs=1e-3)
    assert (np.abs(friction["trend_change"].values) < 1e-4).all()
    assert (friction["friction_coefficient_sem"].values < 0.002).all()


@pytest.mark.slow
def test_error_covers_the_truth_where_the_zero_walks_or_drifts():
    errors = []
    for seed in range(12):
        walk = np.random.default_rng(seed).standard_normal(4000).cumsum() / np.sqrt(4000)
        run = programme(
            BOTH * 6,
            zero=lambda u, walk=walk: walk[(3999 * u).astype(int)] + 2 * u,
            loaded_rests=True,
            seed=seed,
        )
        errors.append(off(analysed(run)).values[::2])
    errors = np.abs(np.concatenate(errors))
    assert np.mean(errors < 1) >= 0.68
    assert np.mean(errors < 3) >= 0.99


def test_zero_that_jumps_once_is_not_taken_for_a_drift():
    time, sign = np.arange(16.0), np.tile([1, -1], 8)
    force = 9.0 * sign + np.where(time < 8, 0.0, 2.0)
    found = middles(force, np.ones(16), sign, np.arange(16) // 2, time)
    assert found.slope.tolist() == [0.0] * 8


def test_a_jump_between_the_strokes_of_one_pair_is_in_its_error():
    # the sharp loops beside it must not outvote the one that jumped, whose strokes scatter
    value = np.array([0.0, 1e-5, 0.0, -6e-3, -12e-3, -12e-3])
    error = np.array([2e-5, 2e-5, 2e-5, 7e-4, 2e-5, 2e-5])
    moves = wander(value, error, 70.0 * np.arange(6))
    step = np.mean(np.diff(value) ** 2)
    assert 0.5 * step < moves.fast + 70.0 * moves.rate < 6 * step


def test_stroke_without_partner_takes_the_zero_between_its_neighbours():
    run = programme([*BOTH, SPEED, *BOTH], zero=lambda u: 5 + 3 * u, loaded_rests=True, noise=1e-6)
    # the third stroke pairs with none of its speed: its partner is slower
    friction = friction_coefficient(run, find_segments(run).isel(segment=[0, 1, 2, 3, 4]))
    assert friction["pair"].values.tolist() == [0, 0, -1, 1, 1]
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 5, abs=1e-4)
    assert (
        friction["zero_from"].values[2].startswith("no partner: half loops of segments 1-2 and 4-5")
    )


def test_drift_of_both_zeros_is_taken_from_the_rests_without_load():
    run = programme(
        [SPEED, None, SPEED, None, SPEED],
        zero=lambda u: 2.0 - 3 * u,
        normal_zero=lambda u: 2.0 + 5 * u,
    )
    friction = analysed(run)
    assert friction.attrs["offset"] == "zero load"
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 3, abs=1e-3)
    assert np.ptp(friction["normal_force_offset"].values) == pytest.approx(5 * 0.6, rel=0.2)
    assert (np.abs(off(friction)) < 3).all()
    assert not doubts(run, friction)


@pytest.mark.parametrize("start", [-5.0, 2.5])
def test_zero_of_the_normal_force_may_drift_far_from_rest_to_rest(start):
    run = programme(
        [*BOTH, None, *BOTH, None, *BOTH], normal_zero=lambda u: start + np.sign(start) * 3 * u
    )
    friction = analysed(run)
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, abs=2e-3)
    assert (np.abs(off(friction)) < 3).all()


def test_zero_between_two_rests_is_a_line_and_beyond_them_the_last():
    zeros = Zeros(np.array([0.0, 10.0, 20.0]), np.array([0.0, 1.0, 1.0]), np.full(3, 0.1))
    value, error = zeros.at(np.array([-5.0, 5.0, 15.0, 25.0]))
    assert value.tolist() == [0.0, 0.5, 1.0, 1.0]
    noise = 0.1 / np.sqrt(2)
    assert error[2] == pytest.approx(noise)
    assert error[1] == pytest.approx(np.hypot(noise, np.sqrt(0.98 / 12)))
    assert zeros.slope(np.array([-5.0, 5.0, 15.0, 25.0])).tolist() == [0.0, 0.1, 0.0, 0.0]


# nothing tells the zero


@pytest.mark.parametrize("offset", [0.0, 4.0])
def test_one_way_without_any_reference_is_suspect_and_says_what_to_state(offset):
    run = programme([SPEED] * 3, zero=lambda u: offset + 0 * u, loaded_rests=True)
    friction = analysed(run)
    (row,) = doubts(run, friction)
    assert "zero_uncertainty" in row["cure"]
    assert set(friction["zero_from"].values) == {"nothing"}


def test_stated_uncertainty_of_the_zero_is_in_the_error_and_settles_it():
    run = programme([SPEED] * 3, zero=lambda u: 0.5 + 0 * u, loaded_rests=True)
    friction = analysed(run, zero_uncertainty="0.5 N")
    assert friction["friction_coefficient_sem"].values == pytest.approx([0.5 / LOAD] * 3, rel=0.01)
    assert (np.abs(off(friction)) < 3).all()
    assert not doubts(run, friction)
    as_read = run.assign_attrs(friction_force_zero_uncertainty_N=0.5)
    xr.testing.assert_allclose(analysed(as_read), friction)


def test_zeros_of_other_runs_are_the_zero_and_their_scatter_is_its_error():
    stops = [SPEED, None, SPEED, None, SPEED]
    run = programme(stops, zero=lambda u: 2.1 + 0 * u, loaded_rests=True)
    friction = analysed(run, other_zeros=(1.9, 2.0, 2.1, 2.2, 1.8))
    assert friction.attrs["offset"] == "other runs"
    assert friction["friction_force_offset"].values == pytest.approx([2.0] * 3)
    assert (np.abs(off(friction)) < 3).all()
    assert (friction["friction_coefficient_sem"].values > 0.15 / LOAD).all()
    assert not doubts(run, friction)


def test_zero_measured_on_one_side_only_is_in_doubt():
    run = programme([SPEED] * 3, zero=lambda u: 2 * u)
    first = find_segments(run)
    last = float(first["stop"].values[-1])
    cut = run.isel(time=slice(0, int(np.searchsorted(run["time"].values, last)) + 3))
    (row,) = doubts(cut, analysed(cut))
    assert "before or after the sliding only" in row["message"]
    assert not doubts(cut, analysed(cut, zero_uncertainty=1.0))


@pytest.mark.parametrize(("reads", "larger"), [(0.0, ""), (5.0, "16%"), (9.0, "29%")])
def test_a_rest_that_may_be_the_zero_of_the_load_is_told(reads, larger):
    run = programme([SPEED] * 3, normal_zero=lambda u: reads + 0 * u)
    said = [row for row in doubts(run, analysed(run)) if "light load" in row["message"]]
    assert [f"{larger} larger" in row["message"] for row in said] == [True] * bool(larger)
    assert all('`zero = "0 s to' in row["cure"] for row in said)


def test_a_rest_under_the_load_of_a_segment_is_no_zero():
    run = programme([SPEED] * 4, normal_zero=lambda u: 6 + 0 * u)
    lighter = run["normal_force"].where(run["time"] < 7, run["normal_force"] - LOAD * 0.95)
    run = run.assign(normal_force=lighter.where(lighter > 0, 6.0))
    assert not any("light load" in row["message"] for row in doubts(run, analysed(run)))


# direction


def two_ways(v):
    return np.where(np.asarray(v) > 0, 0.36, 0.24)


def test_friction_that_depends_on_direction_keeps_both_values_where_rests_tell_the_zero():
    run = programme(BOTH * 3, mu=two_ways, zero=lambda u: 4 + 0 * u)
    friction = analysed(run)
    assert friction["friction_coefficient"].values == pytest.approx([0.36, 0.24] * 3, abs=1e-3)
    (row,) = doubts(run, friction)
    assert "0.36 forward and 0.24 backward" in row["message"]
    assert 'offset = "zero load"' in row["cure"] and 'offset = "half loop"' in row["cure"]
    stated = analysed(run, offset="zero load")
    assert not doubts(run, stated)
    xr.testing.assert_allclose(stated.friction_coefficient, friction.friction_coefficient)


def test_without_another_zero_the_asymmetry_that_an_offset_may_be_is_told_and_no_objection():
    run = programme(BOTH * 3, mu=two_ways, loaded_rests=True)
    friction = analysed(run)
    assert friction["friction_coefficient"].values == pytest.approx([0.30] * 6, abs=1e-3)
    assert not doubts(run, friction)
    rows = check_run(run, find_segments(run), friction).rows
    (row,) = [row for row in rows if row["check"] == "zero_reference"]
    assert row["status"] == "pass" and row["noted"] and "20.0% more friction" in row["message"]


@pytest.mark.parametrize("seed", range(3))
def test_sound_loops_with_rests_are_not_objected_to(seed):
    run = programme(BOTH * 3, zero=lambda u: 1 + 0.2 * np.sin(3 * u), seed=seed)
    friction = analysed(run)
    assert friction.attrs["offset"] == "half loop"
    assert not doubts(run, friction) and not doubts(run, friction, "rectified")
    assert (np.abs(off(friction)) < 3).all()


# sign


@pytest.mark.slow
@pytest.mark.parametrize("loaded_rests", [False, True])
@pytest.mark.parametrize("offset", [0.0, -2.0])
def test_force_without_sign_gives_the_mean_of_both_directions(offset, loaded_rests):
    run = programme(BOTH * 3, zero=lambda u: offset + 0 * u, loaded_rests=loaded_rests)
    lost = run.assign(friction_force=np.abs(run["friction_force"]))
    friction = analysed(lost)
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, abs=1e-3)
    assert "without sign" in friction.attrs["offset"]
    assert doubts(lost, friction, "rectified")
    stated = analysed(lost, rectified=True)
    assert stated["friction_coefficient"].values == pytest.approx([MU] * 6, abs=1e-3)
    assert not doubts(lost, stated, "rectified")


def test_a_sign_that_is_lost_in_a_part_of_the_run_is_in_doubt_there():
    """Half the difference of two levels without sign is nothing, and was taken for the friction."""
    run = programme(BOTH * 3, loaded_rests=True)
    force = run["friction_force"].values
    half = force.size // 2
    lost = run.assign(friction_force=("time", np.r_[force[:half], np.abs(force[half:])]))
    [told] = doubts(lost, analysed(lost), "rectified")
    assert "in segments 3-4, 5-6" in told["message"] and "1-2" not in told["message"]
    assert not doubts(run, analysed(run), "rectified")


@pytest.mark.parametrize("offset", [12.0, 40.0, -40.0])
def test_offset_larger_than_friction_is_no_lost_sign(offset):
    run = programme(BOTH * 3, zero=lambda u: offset + 0 * u, loaded_rests=True, turn=20)
    friction = analysed(run)
    assert (np.sign(run["friction_force"]) == np.sign(offset)).all()
    assert friction.attrs["offset"] == "half loop"
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, abs=1e-3)
    assert not doubts(run, friction, "rectified")


def test_levels_that_swap_between_two_samples_are_in_doubt_either_way():
    run = programme(BOTH * 3, loaded_rests=True, turn=1, noise=0.05)
    force = np.abs(run["friction_force"].values)
    lost = run.assign(friction_force=("time", np.where(force < 0.8 * MU * LOAD, MU * LOAD, force)))
    friction = analysed(lost)
    assert doubts(lost, friction, "rectified")
    assert friction["friction_coefficient"].values == pytest.approx([MU] * 6, rel=0.01)


def test_force_and_speed_without_sign_are_told_by_the_stops():
    run = programme(BOTH * 3, loaded_rests=True)
    lost = run.assign({k: np.abs(run[k]) for k in ("friction_force", "sliding_velocity")})
    friction = analysed(lost)
    assert doubts(lost, friction, "rectified") and doubts(lost, friction)


@pytest.mark.parametrize("name", ["Circle_1bar", "Kidney_2bar", "O-ring257_1bar"])
def test_actuator_under_pressure_has_its_sign(shared_data, name):
    run = actuator(shared_data, name)
    segments = find_segments(run, position_range=("5 mm", "32 mm"))
    friction = friction_coefficient(run, segments)
    assert friction.attrs["offset"] == "half loop"
    assert not [d for d in friction.attrs["zero_doubts"] if d["status"] == "suspect"]


def test_recorded_coefficient_of_one_direction_has_no_zero(shared_data):
    run = rock(shared_data)
    assert doubts(run, analysed(run))
    assert not doubts(run, analysed(run, zero_uncertainty=0.005))


# speeds


def slower_backwards(v):
    return MU * (1 + 0.1 * np.log(np.abs(v) / SPEED))


def test_strokes_of_unequal_speed_are_a_loop_in_doubt_until_it_is_stated():
    unequal = [6.7e-3, -14e-3] * 4
    run = programme(unequal, mu=slower_backwards, zero=lambda u: 200 + 0 * u, loaded_rests=True)
    truth = slower_backwards(np.array(unequal))
    friction = analysed(run)
    assert friction["pair"].values.tolist() == [0, 0, 1, 1, 2, 2, 3, 3]
    assert (np.abs(off(friction, truth)) < 3).all()
    (row,) = doubts(run, friction)
    assert "pair_tolerance = 0.8" in row["cure"]
    assert "2.09 of its speed" in friction["zero_from"].values[0]
    stated = analysed(run, pair_tolerance=0.8)
    assert not doubts(run, stated)
    assert (np.abs(off(stated, truth)) < 3).all()
    assert (stated["friction_coefficient_sem"].values > 0.03 * MU).all()


def test_loops_of_one_speed_say_what_unequal_speeds_may_change():
    speeds = [5e-3, -5e-3, 7e-3, -14e-3, 20e-3, -20e-3]
    run = programme(speeds, mu=slower_backwards, zero=lambda u: 50 + 0 * u, loaded_rests=True)
    friction = analysed(run, pair_tolerance=0.8)
    truth = slower_backwards(np.array(speeds))
    assert (np.abs(off(friction, truth)) < 3).all()
    sem = friction["friction_coefficient_sem"].values
    # half of 0.1 mu ln 2, the run's own slope, and what its loop's middle is beside the others
    assert 1.0 < sem[2] / (0.5 * 0.1 * MU * np.log(2)) < 1.6
    assert not doubts(run, analysed(run))


@pytest.mark.parametrize(
    ("turned", "offset", "one_way", "cure"),
    [
        (True, 0.0, False, "Set `sign = -1`"),
        (True, 40.0, False, "is not centred on zero"),
        (False, -12.0, True, "cannot distinguish a wrong sign"),
    ],
)
def test_another_sign_is_proposed_only_where_the_loop_is_centred(turned, offset, one_way, cure):
    speeds = [SPEED] * 3 if one_way else BOTH * 3
    run = programme(speeds, zero=lambda u: offset + 0 * u, loaded_rests=True, turn=20)
    if turned:
        run = run.assign(sliding_velocity=-run["sliding_velocity"])
    rows = check_run(run, find_segments(run), analysed(run)).rows
    (row,) = [row for row in rows if row["check"] == "friction_sign"]
    assert row["status"] == "fail" and cure in row["cure"]


def test_strokes_of_hardly_any_friction_do_not_speak_against_a_turned_sign():
    def mu(speed):
        return np.where(np.abs(speed) > 1.5 * SPEED, 0.001, MU)

    speeds = [*(BOTH * 2), 2 * SPEED, -2 * SPEED]
    run = programme(speeds, mu=mu, zero=lambda u: 0 * u, loaded_rests=True)
    run = run.assign(sliding_velocity=-run["sliding_velocity"])
    rows = check_run(run, find_segments(run), analysed(run)).rows
    (row,) = [row for row in rows if row["check"] == "friction_sign"]
    assert "in 2 more, friction is too small to decide" in row["message"]
    assert row["cure"].startswith("Set `sign = -1`")


# segments that are taken out


def test_a_partner_that_changes_is_named():
    made = strokes([SPEED] * 3, samples=300)
    run = with_friction(made, offset=2.0)
    segments = find_segments(run)
    whole = friction_coefficient(run, segments)
    assert whole["zero_from"].values[1].startswith("half loop with segment 1")
    left = friction_coefficient(run, segments.drop_isel(segment=[0]))
    assert left["zero_from"].values[0].startswith("half loop with segment 3")
    apart = friction_coefficient(run, segments.drop_isel(segment=[1, 2]))
    assert "segments 2-3 between them left out" in apart["zero_from"].values[0]


def test_wanted_zero_that_is_not_there_is_an_error_that_names_the_cure():
    run = programme([SPEED] * 2, loaded_rests=True)
    with pytest.raises(AnalysisError, match="offset='auto'"):
        analysed(run, offset="zero load")


# lost signs


@pytest.mark.parametrize(("lost", "kind"), [(True, "undecided"), (False, "signed")])
def test_turns_within_a_sample_do_not_prove_a_sign(lost, kind):
    rng = np.random.default_rng(3)
    sign = np.tile([1.0, -1.0], 4)
    levels = 2.0 * sign + 0.5 if lost else 0.25 * sign + 2.0
    # one reading on the way from level to level, at any place of it
    ways = zip(levels[:-1], levels[1:], [0.1, 0.92, 0.95, 0.93, 0.08, 0.07, 0.06], strict=True)
    turns = [start + share * (stop - start) for start, stop, share in ways]
    force = np.repeat(levels, 101)
    force[100:-1:101] = turns
    force = force + 0.01 * rng.standard_normal(force.size)
    if lost:
        force = np.abs(force)
    parts = [slice(101 * i + 5, 101 * i + 95) for i in range(8)]
    mean = np.array([force[part].mean() for part in parts])
    trace = ForceTrace(
        force, Pressed(None, parts, 0.5), parts, mean, np.full(8, 1e-3), sign, np.nan
    )
    assert folded(trace).kind.startswith(kind)


@pytest.mark.parametrize(("speeds", "kind"), [("equal", "rectified"), ("steps", "signed")])
def test_steps_of_speed_that_start_from_rest_have_lost_no_sign(speeds, kind):
    """Torque is zero before each step of a disc that turns one way."""
    rng = np.random.default_rng(5)
    stroke = np.concatenate([np.linspace(0, 2, 11)[:-1], np.full(90, 2.0), np.linspace(2, 0, 11)])
    force = np.tile(stroke, 6) + 0.01 * rng.random(6 * stroke.size)
    parts = [slice(stroke.size * i + 15, stroke.size * i + 95) for i in range(6)]
    mean = np.array([force[part].mean() for part in parts])
    speed = np.full(6, 1e-3) if speeds == "equal" else 1e-3 * 2.0 ** np.arange(6)
    pressed = Pressed(None, parts, 0.5)
    trace = ForceTrace(
        force, pressed, parts, mean, np.full(6, 1e-3), np.ones(6), np.nan, speed=speed
    )
    assert folded(trace).kind == kind


def test_an_uncertainty_of_the_zero_may_be_a_torque_where_one_was_measured():
    run = programme([SPEED] * 3, zero=lambda u: 0.5 + 0 * u, loaded_rests=True)
    stated = analysed(run, zero_uncertainty="0.5 N")
    for attrs in (
        {"derived": {"friction_force": "torque / disc_radius"}, "disc_radius_m": 0.02},
        {"derived": {"friction_force": "torque / '20 mm'"}},
    ):
        turned = analysed(run.assign_attrs(attrs), zero_uncertainty="10 N mm")
        xr.testing.assert_allclose(turned["friction_coefficient"], stated["friction_coefficient"])
        xr.testing.assert_allclose(
            turned["friction_coefficient_sem"], stated["friction_coefficient_sem"]
        )
    with pytest.raises(AnalysisError, match="is a torque, and"):
        analysed(run, zero_uncertainty="10 N mm")


def test_what_idles_without_load_shows_the_zero_where_no_rest_does():
    """A torque of bearings and a drifting sensor, before the load comes on and after it goes."""
    rng = np.random.default_rng(8)
    time = 0.1 * np.arange(3000)
    pressed = (time > 20) & (time < 280)
    speed = np.where(time < 150, 0.1, 0.3)
    idle = 1.5 + 1.0 * time / 300
    force = np.where(pressed, 0.1 * 300, 0.0) + idle + 0.05 * rng.standard_normal(time.size)
    normal = np.where(pressed, 300.0, 0.0) + 0.2 * rng.standard_normal(time.size)
    signals = {"sliding_velocity": speed, "friction_force": force, "normal_force": normal}
    run = xr.Dataset({k: ("time", v) for k, v in signals.items()}, {"time": time})
    friction = friction_coefficient(run, find_segments(run))
    value, error = friction["friction_coefficient"], friction["friction_coefficient_sem"]
    assert friction.attrs["offset"] == "zero load" and value.size == 2
    assert (np.abs(value - 0.1) < 3 * error).all() and (error < 0.002).all()
    assert not friction.attrs["zero_doubts"]


def test_a_stretch_without_load_tells_the_zero_though_its_speed_is_noise_without_sign(tmp_path):
    rng = np.random.default_rng(3)
    t = np.arange(0, 160, 0.1)
    load = 20 * np.clip((t - 30) / 5, 0, 1)
    speed = np.abs(rng.normal(0, 0.5, t.size)) + np.clip((t - 32) / 2, 0, 1) * (
        100 + 150 * np.clip((t - 95) / 0.5, 0, 1)
    )
    force = 0.9 + 0.5 * load * (t > 32) + rng.normal(0, 0.05, t.size)
    rows = np.column_stack([t, speed, load + rng.normal(0, 0.02, t.size), force])
    head = "time [s],speed [mm/s],normal force [N],friction force [N]"
    np.savetxt(tmp_path / "a.csv", rows, "%.4f", ",", header=head, comments="")
    run = read(tmp_path / "a.csv")
    mu = friction_coefficient(run, find_segments(run))
    np.testing.assert_allclose(mu.friction_coefficient, 0.5, rtol=3e-3)
