"""All plateaus of a record are found and nothing else, whatever the noise, rate and order."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from made_runs import SPEEDS, matches, reasons, strokes, velocity_run
from real_runs import actuator, paper, rock

from tribolab.core.errors import AnalysisError
from tribolab.friction.segments.find import find_segments


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.05])
@pytest.mark.parametrize("rate", ["constant", "follows", "jitter"])
@pytest.mark.parametrize("seed", [0, 1])
def test_four_decades_both_ways_are_found_at_any_sampling(noise, rate, seed):
    made = strokes(noise=noise, rate=rate, seed=seed)
    found = find_segments(made.run)
    assert matches(found, made, error=0.02)
    assert reasons(found) <= {"at rest", "ramp", "too short"}


@pytest.mark.parametrize(
    "options",
    [
        {"samples": 100, "noise": 0.01},
        {"samples": 3000, "noise": 0.05},
        {"rest": 0.0, "ramp": 0.02},
        {"both_ways": False, "rest": 0.0},
        {"both_ways": False, "rest": 0.0, "ramp": 0.0},
        {"ramp": 0.2, "samples": 1000},
        {"rest": 3.0, "samples": 100, "noise": 0.01},
        {"speeds": [1e-3]},
        {"speeds": [1e-3, 2.15e-3]},
    ],
    ids=str,
)
def test_shape_of_the_program_does_not_matter(options):
    made = strokes(**options)
    assert matches(find_segments(made.run), made, slack=0.08, error=0.04)


@pytest.mark.parametrize(("step", "floor"), [(5e-7, 0.0), (1e-6, 3e-7)])
def test_speeds_of_one_or_two_quanta_are_not_split_by_the_toggling_of_the_last_digit(step, floor):
    made = strokes(step=step, floor=floor)
    found = find_segments(made.run)
    # a reading without noise may be off by half a quantum, which no average mends
    assert matches(found, made, slack=0.08, error=0.5 * step / SPEEDS[0])
    assert found["sliding_speed"].values[8:] == pytest.approx(abs(made.velocity[8:]), rel=0.02)


@pytest.mark.parametrize("speeds", [[1e-3], [1e-3, 2e-3, 5e-3, 1e-2]])
def test_a_commanded_velocity_keeps_its_strokes_beside_long_rests(speeds):
    program = [0.0]
    for speed in speeds:
        program += [speed, 0.0, -speed, 0.0]
    lasts = [3000 if v == 0 else 400 for v in program]
    found = find_segments(velocity_run(np.repeat(program, lasts)))
    assert found["sliding_speed"].values == pytest.approx(np.repeat(speeds, 2))
    assert (found["direction"].values == np.tile([1, -1], len(speeds))).all()


def test_a_ramp_read_in_some_digits_has_no_segment():
    velocity = np.concatenate([np.linspace(0, 1, 3000), np.linspace(1, 0, 3000)])
    for digits in (50, 100):  # fewer are levels that a program might have
        found = find_segments(velocity_run(np.round(velocity * digits) / digits))
        assert found.sizes["segment"] == 0, digits


@pytest.mark.parametrize("seed", range(5))
def test_lowest_speed_in_a_noise_floor_as_large_as_itself_is_found(seed):
    made = strokes(floor=SPEEDS[0], samples=1000, noise=0.02, seed=seed)
    found = find_segments(made.run)
    assert matches(found, made, slack=0.10, error=0.15)
    # three standard errors of the mean of the trimmed samples
    speed = found["sliding_speed"].values[:2]
    assert np.abs(speed - SPEEDS[0]).max() < 3.5 * SPEEDS[0] / np.sqrt(800)


@pytest.mark.parametrize(("height", "noise"), [(0.03, 0.02), (0.05, 0.03), (0.10, 0.05)])
def test_small_step_is_resolved_where_noise_allows(height, noise):
    count = int(2 * (18 * noise / height) ** 2) + 1  # height = 18 noise sqrt(2 / N)
    for seed in range(5):
        rng = np.random.default_rng(seed)
        velocity = np.repeat([1e-3, (1 + height) * 1e-3], count)
        velocity *= 1 + noise * rng.standard_normal(velocity.size)
        found = find_segments(velocity_run(velocity))
        speed = found["sliding_speed"].values
        assert speed == pytest.approx([1e-3, (1 + height) * 1e-3], rel=0.25 * height)


@pytest.mark.parametrize("height", [0.005, 0.01])
def test_change_below_the_resolution_does_not_split(height):
    rng = np.random.default_rng(3)
    velocity = np.repeat([1e-3, (1 + height) * 1e-3], 2000)
    found = find_segments(velocity_run(velocity * (1 + 0.001 * rng.standard_normal(4000))))
    assert found.sizes["segment"] == 1


@pytest.mark.parametrize("seed", range(10))
def test_noise_with_or_without_memory_does_not_split_a_plateau(seed):
    from scipy.signal import lfilter

    rng = np.random.default_rng(seed)
    white = rng.standard_normal(5000)
    slow = lfilter([1], [1, -0.95], rng.standard_normal(5000))
    for noise in (0.05 * white, 0.03 * slow / slow.std()):
        assert find_segments(velocity_run(1e-3 * (1 + noise))).sizes["segment"] == 1


@pytest.mark.parametrize("memory", [1.0, 2.0, 4.0, 8.0])
@pytest.mark.parametrize("seed", [0, 1])
def test_noise_that_a_logger_smooths_over_some_samples_splits_no_stroke(memory, seed):
    from scipy.ndimage import gaussian_filter1d

    rng = np.random.default_rng(seed)
    speeds = np.array([0, 5e-6, 0, -5e-6, 0, 1e-4, 0, -1e-4, 0, 2e-3, 0, -2e-3, 0])
    velocity = gaussian_filter1d(np.repeat(speeds, np.where(speeds == 0, 100, 2000)), 3.0)
    noise = gaussian_filter1d(rng.standard_normal(velocity.size), memory)
    floor = gaussian_filter1d(rng.standard_normal(velocity.size), memory)
    velocity = velocity * (1 + 0.03 * noise / noise.std()) + 1e-8 * floor / floor.std()
    found = find_segments(velocity_run(velocity))
    signed = found["sliding_speed"].values * found["direction"].values
    assert signed == pytest.approx(speeds[speeds != 0], rel=0.01)
    assert (found["samples"].values >= 0.78 * 2000).all()


@pytest.mark.parametrize("blocks", [2, 3, 4, 5, 6])
def test_digits_that_repeat_after_some_blocks_split_no_stroke(blocks):
    speed = (1 + 1 / (8 * blocks)) * 1e-7 / 0.04  # one sample of so many blocks holds two steps
    velocity = speed * np.tile(np.repeat([1.0, 0.0, -1.0, 0.0], [800, 50, 800, 50]), 4)
    position = np.round(np.cumsum(velocity) * 0.04 / 1e-7) * 1e-7
    time = np.arange(position.size) * 0.04
    found = find_segments(xr.Dataset({"position": ("time", position)}, {"time": time}))
    assert found["direction"].values.tolist() == [1, -1] * 4
    assert found["sliding_speed"].values == pytest.approx(speed, rel=0.01)


def test_spikes_and_single_missing_numbers_do_not_split():
    made = strokes(samples=1000)
    velocity = made.run["sliding_velocity"].values.copy()
    rng = np.random.default_rng(1)
    velocity[rng.choice(velocity.size, 100, replace=False)] *= 20
    velocity[rng.random(velocity.size) < 0.05] = np.nan
    run = made.run.assign(sliding_velocity=("time", velocity))
    assert matches(find_segments(run), made)


def test_slow_drift_is_one_plateau_and_a_ramp_is_none():
    rng = np.random.default_rng(0)
    noise = 1 + 0.01 * rng.standard_normal(3000)
    drifting = find_segments(velocity_run(np.linspace(1.0, 1.06, 3000) * 1e-3 * noise))
    assert drifting.sizes["segment"] == 1
    ramp = find_segments(velocity_run(np.linspace(1.0, 3.0, 3000) * 1e-3 * noise))
    assert ramp.sizes["segment"] == 0
    assert "ramp" in reasons(ramp)


def test_reversal_without_rest_separates_the_strokes():
    velocity = np.tile(np.repeat([2e-3, -2e-3], 300), 4)
    found = find_segments(velocity_run(velocity))
    assert found["direction"].values.tolist() == [1, -1] * 4
    assert found["start"].values == pytest.approx(np.arange(8) * 3.0, abs=0.05)


def test_pause_longer_than_the_limit_splits_and_is_named():
    run = velocity_run(np.full(2000, 1e-3))
    short = run.isel(time=np.r_[0:1000, 1050:2000])
    long = run.isel(time=np.r_[0:800, 1200:2000])
    assert find_segments(short).sizes["segment"] == 1
    assert find_segments(short, max_gap="0.2 s").sizes["segment"] == 2
    found = find_segments(long)
    assert found.sizes["segment"] == 2
    assert found["omitted_reason"].values.tolist() == ["gap"]
    assert found["omitted_start"].item() == pytest.approx(7.99)
    assert found["omitted_stop"].item() == pytest.approx(12.0)


def test_missing_numbers_in_a_row_are_a_gap():
    velocity = np.full(2000, 1e-3)
    velocity[800:1200] = np.nan
    found = find_segments(velocity_run(velocity))
    assert found.sizes["segment"] == 2
    assert "gap" in reasons(found)


def test_trim_is_a_share_of_the_time_at_both_ends():
    run = velocity_run(np.full(1001, 1e-3))
    found = find_segments(run, trim=0.2)
    assert found.identical(find_segments(run, trim="20 %"))
    assert found["trimmed_start"].item() == pytest.approx(2.0)
    assert found["trimmed_stop"].item() == pytest.approx(8.0)
    assert found["sliding_distance"].item() == pytest.approx(6e-3)
    assert found["samples"].item() == 601
    assert found.attrs["trim"] == 0.2


def test_segments_and_omitted_stretches_cover_the_record_without_overlap():
    made = strokes(noise=0.03)
    found = find_segments(made.run)
    edges = np.concatenate(
        [np.stack([found[f"{p}start"], found[f"{p}stop"]], axis=1) for p in ("", "omitted_")]
    )
    edges = edges[np.argsort(edges[:, 0])]
    assert edges[1:, 0] == pytest.approx(edges[:-1, 1], abs=1e-9)
    assert edges[0, 0] == 0
    assert edges[-1, 1] == made.run["time"].values[-1]


def test_large_and_small_record_of_one_motion_give_the_same_segments():
    few, many = strokes(samples=1000, noise=0.02), strokes(samples=30_000, noise=0.02)
    a, b = find_segments(few.run), find_segments(many.run)
    assert matches(a, few)
    assert matches(b, many)


def test_short_plateau_in_a_long_record_is_found():
    # 2000 of 4 million samples: less than ten of the blocks that the first look uses
    rng = np.random.default_rng(0)
    velocity = np.concatenate(
        [np.zeros(1_000_000), np.full(2000, 1e-2), np.zeros(1_000_000), np.full(2_000_000, 1e-6)]
    )
    velocity = velocity * (1 + 0.02 * rng.standard_normal(velocity.size))
    velocity += 1e-7 * rng.standard_normal(velocity.size)
    found = find_segments(velocity_run(velocity, 1e-3))
    assert found["sliding_speed"].values == pytest.approx([1e-2, 1e-6], rel=0.01)
    assert found["start"].values[0] == pytest.approx(1000, abs=0.1)  # it lasts 2 s


# real files


@pytest.mark.parametrize(
    ("name", "forward", "backward"),
    [
        ("Circle_1bar", 10.12e-3, 12.26e-3),
        ("Kidney_2bar", 12.72e-3, 15.01e-3),
        ("O-ring257_1bar", 13.48e-3, 15.01e-3),
    ],
)
def test_actuator_strokes_are_found_from_position(shared_data, name, forward, backward):
    found = find_segments(actuator(shared_data, name), position_range=("5 mm", "32 mm"))
    assert found.attrs["velocity_source"] == "position"
    direction, speed = found["direction"].values, found["sliding_speed"].values
    assert np.count_nonzero(direction == 1) == np.count_nonzero(direction == -1) == 10
    assert (direction[1:] == -direction[:-1]).all()
    assert speed[direction == 1].mean() == pytest.approx(forward, rel=0.02)
    assert speed[direction == -1].mean() == pytest.approx(backward, rel=0.02)


def test_rock_velocity_step_is_found_from_noisy_position(shared_data):
    run = rock(shared_data)
    found = find_segments(run)
    assert found["sliding_speed"].values == pytest.approx([3.017e-6, 10.031e-6], rel=0.02)
    step = found["start"].values[1] + run.attrs["time_origin_s"]
    assert step == pytest.approx(11676.75, abs=0.5)  # the sampling is 0.01 s, the record 118 s


def test_set_speed_alone_makes_the_record_one_segment(shared_data):
    run = paper(shared_data, 168, 1100)
    found = find_segments(run, trim=0)
    assert found.attrs["velocity_source"] == "set speed"
    assert found["sliding_speed"].item() == pytest.approx(1100e-6)
    assert found["samples"].item() == run.sizes["time"]


def test_steps_are_segments_where_nothing_tells_the_velocity():
    force = np.repeat([3.0, -3.0, 3.1], 50)
    run = xr.Dataset(
        {"friction_force": ("time", force), "step": ("time", np.repeat([1, 2, 3], 50))},
        {"time": np.arange(150) * 0.02},
    )
    found = find_segments(run)
    assert found.attrs["velocity_source"] == "step"
    assert found["direction"].values.tolist() == [1, -1, 1]
    assert np.isnan(found["sliding_speed"].values).all()
    assert found["step"].values.tolist() == [1, 2, 3]
    known = find_segments(run.assign(set_speed=("time", np.full(150, 2e-3))))
    assert known["sliding_speed"].values.tolist() == [2e-3] * 3


def test_set_speed_labels_the_segments():
    made = strokes([1e-4, 1e-3])
    wanted = np.repeat([1e-4, 1e-3], made.run.sizes["time"] // 2 + 1)[: made.run.sizes["time"]]
    found = find_segments(made.run.assign(set_speed=("time", wanted)))
    assert found["set_speed"].values.tolist() == [1e-4, 1e-4, 1e-3, 1e-3]


# properties


@settings(deadline=None, max_examples=20)
@given(
    st.integers(0, 1000),
    st.floats(1e-3, 1e3),
    st.floats(0.01, 100),
    st.sampled_from([1, -1]),
)
def test_segments_follow_the_scale_of_speed_and_time_and_the_sign(seed, scale, stretch, sign):
    made = strokes([1e-5, 1e-4, 1e-3], samples=200, seed=seed)
    run = made.run
    other = xr.Dataset(
        {"sliding_velocity": ("time", sign * scale * run["sliding_velocity"].values)},
        {"time": run["time"].values * stretch},
    )
    a, b = find_segments(run), find_segments(other)
    assert b["start"].values == pytest.approx(stretch * a["start"].values)
    # rounding may put one sample more or less inside the trimmed part
    assert b["sliding_speed"].values == pytest.approx(scale * a["sliding_speed"].values, rel=1e-3)
    assert (b["direction"].values == sign * a["direction"].values).all()


# bad input


def test_no_samples_is_an_error_that_says_so():
    with pytest.raises(AnalysisError, match="no samples"):
        find_segments(velocity_run([]))


@pytest.mark.parametrize("trim", [0.5, 0.9, -0.1, float("nan"), "60 %", "10 mm", None])
def test_trim_that_is_no_share_below_a_half_is_an_error(trim):
    with pytest.raises(AnalysisError, match="trim: a share .* is wanted, e.g. 0.10"):
        find_segments(velocity_run(np.ones(100)), trim=trim)


def test_run_without_speed_is_an_error_that_names_what_is_needed():
    run = xr.Dataset({"friction_force": ("time", np.ones(5))}, {"time": np.arange(5.0)})
    with pytest.raises(AnalysisError, match="sliding_velocity.*position.*step"):
        find_segments(run)


def test_the_part_of_the_track_that_counts_is_in_the_result():
    time = np.arange(1000) / 100
    run = xr.Dataset({"position": ("time", 1e-3 * time)}, {"time": time})
    found = find_segments(run, position_range=("7 mm", "2 mm"))
    low, high = found.attrs["position_low_m"], found.attrs["position_high_m"]
    assert (low, high) == pytest.approx((2e-3, 7e-3))
    ends = run["position"].sel(time=[found.trimmed_start.item(), found.trimmed_stop.item()])
    assert ends.values == pytest.approx([low, high], abs=2e-5)
    assert not [name for name in find_segments(run).attrs if name.startswith("position")]


def test_position_range_without_position_is_an_error():
    with pytest.raises(AnalysisError, match="position"):
        find_segments(velocity_run(np.ones(100)), position_range=(0, 1))


@pytest.mark.parametrize(
    ("velocity", "reason"),
    [
        ([1e-3], "too short"),
        ([1e-3, 1e-3], "too short"),
        (np.full(100, np.nan), "not a number"),
        (np.zeros(100), "at rest"),
    ],
)
def test_empty_result_says_why(velocity, reason):
    found = find_segments(velocity_run(velocity))
    assert found.sizes["segment"] == 0
    assert reasons(found) == {reason}


def test_numbers_that_are_missing_at_the_ends_are_named():
    velocity = np.full(500, 1e-3)
    velocity[:100] = velocity[400:] = np.nan
    found = find_segments(velocity_run(velocity))
    assert found["omitted_reason"].values.tolist() == ["not a number"] * 2
    assert found["start"].item() == pytest.approx(1.0)


@pytest.mark.parametrize("noise", [0.003, 0.01])
@pytest.mark.parametrize("seed", [0, 1])
def test_the_last_bits_of_times_and_velocities_move_no_end_of_a_segment(noise, seed):
    made = strokes(noise=noise, rate="follows", seed=seed, samples=100).run
    rng = np.random.default_rng(seed)
    log, read = made["time"].values, made["sliding_velocity"].values
    # between the samples of a log, as where two clocks are brought together
    place = np.sort(rng.uniform(0, read.size - 1, read.size))
    time = np.interp(place, np.arange(read.size), log)
    velocity = np.interp(time, log, read)
    bits = 2e-16 * rng.integers(-2, 3, velocity.size)

    def ends(time, velocity):
        run = xr.Dataset({"sliding_velocity": ("time", velocity)}, {"time": time})
        return find_segments(run)[["start", "stop", "omitted_start", "omitted_stop"]]

    told = ends(time, velocity)
    assert told.sizes["segment"] >= 26
    for same in (
        ends(time, np.interp(time + 1e-12, log, read)),
        ends(time, velocity * (1 + 1e-12)),
        ends(time, velocity * (1 + bits)),
        ends(time * (1 + 1e-12), velocity),
    ):
        assert same.sizes == told.sizes
        xr.testing.assert_allclose(told, same, rtol=1e-10)


@pytest.mark.parametrize("rate", [10, 20, 50])
def test_a_position_as_it_was_told_has_no_coarse_last_digit(rate):
    """Each sample goes on by the same step, which is no step of the sensor."""
    speed, stroke = 1e-3, 10.0
    v = np.concatenate(
        [np.r_[np.zeros(rate), np.full(int(stroke * rate), (-1) ** k * speed)] for k in range(6)]
    )
    time = np.round(np.arange(v.size) / rate, 3)
    run = xr.Dataset({"position": ("time", np.cumsum(v) / rate)}, {"time": time})
    found = find_segments(run)
    assert found.direction.values.tolist() == [1, -1] * 3
    np.testing.assert_allclose(found.sliding_speed, speed, rtol=1e-3)
