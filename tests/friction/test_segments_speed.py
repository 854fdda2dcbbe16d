"""What never keeps one speed has no segment; a plateau or a hold beside it is found."""

from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from made_runs import velocity_run

from tribolab.friction.segments.find import find_segments
from tribolab.friction.segments.no_segment import why_no_segment


def position_run(velocity, dt=0.01, noise=0.0, seed=0):
    position = np.concatenate([[0.0], np.cumsum((velocity[1:] + velocity[:-1]) / 2 * dt)])
    position = position + noise * np.random.default_rng(seed).standard_normal(position.size)
    return xr.Dataset({"position": ("time", position)}, {"time": np.arange(position.size) * dt})


PLACE = np.linspace(0, 1, 4000)
MOTIONS = {
    "triangle": 0.65 * (1 - np.abs(2 * PLACE - 1)),
    "triangles": 0.65 * (1 - np.abs(2 * (4 * PLACE % 1) - 1)),
    "crank": 0.2 * np.sin(2 * np.pi * 3 * PLACE),
    "half sine": 0.2 * np.sin(np.pi * PLACE),
    "approach": 0.2 * (1 - np.exp(-2 * PLACE)),
    "S ramp": 0.02 * (0.2 + 0.8 * PLACE**2 * (3 - 2 * PLACE)),
    "slow ramp": 1e-6 * (1 + 2 * PLACE),
    "decades": 1e-6 * 10 ** (3 * PLACE),
}


@pytest.mark.parametrize("noise", [0.0, 0.01])
@pytest.mark.parametrize("name", MOTIONS)
def test_a_speed_that_always_changes_is_never_constant(name, noise):
    motion = MOTIONS[name]
    rng = np.random.default_rng(5)
    found = find_segments(velocity_run(motion * (1 + noise * rng.standard_normal(motion.size))))
    assert found.sizes["segment"] == 0
    assert "never slides at constant speed" in why_no_segment(found)
    way = np.abs(motion).sum() * 0.01
    assert find_segments(position_run(motion, noise=1e-5 * noise * way)).sizes["segment"] == 0


@pytest.mark.parametrize("wave", [0.7, 3.0, 40.0])
def test_a_plateau_survives_its_start_and_a_ripple_of_one_percent(wave):
    place = np.linspace(0, 1, 3000)
    stroke = (1 - np.exp(-place / 0.02)) * (1 + 0.01 * np.sin(2 * np.pi * wave * place))
    velocity = np.concatenate([1e-3 * stroke, -3e-3 * stroke, 1e-2 * stroke])
    for run in (velocity_run(velocity), position_run(velocity)):
        found = find_segments(run)
        assert found["direction"].values.tolist() == [1, -1, 1]
        assert found["sliding_speed"].values == pytest.approx([1e-3, 3e-3, 1e-2], rel=0.01)
        assert found["stop"].values == pytest.approx([30, 60, 90], abs=0.5)


def cycles(name, count, place):
    """Return one of the motions over many cycles; `place` from 0 to 1."""
    turn = count * place
    return {
        "triangles": 1 - np.abs(2 * (turn % 1) - 1),
        "both ways": 4 * np.abs((turn + 0.25) % 1 - 0.5) - 1,
        "sines": np.sin(2 * np.pi * turn),
        "half sines": np.abs(np.sin(np.pi * turn)),
        "saws": turn % 1,
    }[name]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", ["triangles", "both ways", "sines", "half sines", "saws"])
def test_many_cycles_leave_no_speck_of_constant_speed(name, seed):
    rng = np.random.default_rng([seed, 4])
    count, each = int(rng.integers(2, 18)), int(rng.choice([60, 200, 500]))
    motion = cycles(name, count, np.arange(count * each) / (count * each))
    motion = np.concatenate([np.zeros(each), motion, np.zeros(each)])
    noise = rng.choice([0, 1e-3, 1e-2]) * rng.standard_normal(motion.size)
    reading = motion * (1 + noise) + 1e-4 * rng.standard_normal(motion.size)
    assert find_segments(velocity_run(reading)).sizes["segment"] == 0
    run = position_run(motion)
    way = float(np.ptp(run["position"].values))
    scatter = rng.choice([0, 1e-4, 8e-4]) * rng.standard_normal(motion.size)
    digit = way * 10 ** rng.uniform(-5, -3)
    position = np.round((run["position"] + way * scatter) / digit) * digit
    assert find_segments(run.assign(position=position)).sizes["segment"] == 0


@pytest.mark.parametrize("of_position", [False, True])
def test_plateaus_between_ramps_as_long_as_themselves_prove_themselves(of_position):
    rng = np.random.default_rng(8)
    levels = [0.0, 4e-3, 1e-2, -5e-3, 2e-3, 0.0]
    parts = [np.zeros(300)]
    for before, after in pairwise(levels):
        parts += [np.linspace(before, after, 300), np.full(300, after)]
    velocity = np.concatenate(parts)
    reading = velocity * (1 + 0.01 * rng.standard_normal(velocity.size))
    run = position_run(velocity, noise=1e-6) if of_position else velocity_run(reading)
    found = find_segments(run, trim=0)
    signed = found["sliding_speed"].values * found["direction"].values
    assert signed == pytest.approx([4e-3, 1e-2, -5e-3, 2e-3], rel=0.02)
    assert (found["stop"] - found["start"]).values == pytest.approx([3.0] * 4, abs=0.6)


@pytest.mark.parametrize("steps", [0.126, 0.51, 0.875, 1.13])
def test_digits_that_make_a_regular_pattern_split_no_stroke(steps):
    """Readings that move on by 7/8 of a digit differ by a whole one seven times out of eight."""
    velocity = np.tile(np.repeat([0.0, 1.0, 0.0, -1.0], [50, 1200, 50, 1200]), 3) * steps * 100
    run = position_run(velocity)
    found = find_segments(run.assign(position=np.round(run["position"]) * 1e-6), trim=0)
    assert found["direction"].values.tolist() == [1, -1] * 3
    assert found["sliding_speed"].values == pytest.approx(np.full(6, steps * 1e-4), rel=2e-3)


def test_a_triangle_beside_a_plateau_takes_nothing_from_it():
    velocity = np.concatenate([MOTIONS["triangle"], np.zeros(500), np.full(2000, 5e-3)])
    found = find_segments(velocity_run(velocity))
    assert found["sliding_speed"].values == pytest.approx([5e-3])
    assert found["start"].values == pytest.approx([45], abs=0.1)


# resets, unloading, long holds


def hold_between_strokes(dt=0.02):
    """Strokes of 3 s at 2 cm/s, a hold of 20 min at 2.3 um/s, strokes."""
    rest, stroke = np.zeros(150), np.full(150, 2e-2)
    strokes = np.concatenate([rest, stroke, rest, -stroke])
    velocity = np.concatenate([strokes, rest, np.full(60_000, 2.3e-6), strokes, rest])
    return position_run(velocity, dt, noise=2e-7)


def assert_hold_and_strokes(found):
    signed = found["sliding_speed"].values * found["direction"].values
    assert signed == pytest.approx([2e-2, -2e-2, 2.3e-6, 2e-2, -2e-2], rel=0.02)
    slack = np.array([0.5, 0.5, 2.0, 0.5, 0.5])  # the hold: its ends are as sharp as its blocks
    assert (np.abs(found["start"].values - [3, 9, 15, 1218, 1224]) < slack).all()
    assert (np.abs(found["stop"].values - [6, 12, 1215, 1221, 1227]) < slack).all()


def test_a_hold_of_twenty_minutes_beside_fast_strokes_is_found():
    assert_hold_and_strokes(find_segments(hold_between_strokes()))


@pytest.mark.parametrize("at", [[5.0], [400.0], [225.0, 1000.0, 1219.0]])
def test_a_position_that_is_set_to_zero_in_mid_run_shifts_nothing(at):
    run = hold_between_strokes()
    position = run["position"].values.copy()
    for moment in at:
        first = np.searchsorted(run["time"].values, moment)
        position[first:] -= position[first] - 0.011
    assert_hold_and_strokes(find_segments(run.assign(position=("time", position))))


def test_sliding_without_load_is_left_out_with_its_reason():
    velocity = np.tile(np.repeat([0.0, 2e-3, 0.0, -2e-3], 300), 3)
    load = np.full(velocity.size, 20.0)
    load[1200:2400] = 0.0  # the second pair
    load[2800:] = 0.0  # and a third of the way into the next stroke
    found = find_segments(velocity_run(velocity).assign(normal_force=("time", load)))
    assert found["start"].values == pytest.approx([3, 9, 27], abs=0.1)
    assert found["stop"].values == pytest.approx([6, 12, 28], abs=0.1)
    unloaded = found["omitted_reason"].values == "no load"
    assert found["omitted_start"].values[unloaded] == pytest.approx([15, 21, 28, 33], abs=0.1)


@pytest.mark.parametrize("crank", [False, True])
def test_strokes_too_short_for_blocks_are_told_at_their_turns(crank):
    """Ten, then a hundred times as fast between the same turns, by an encoder."""
    noise = np.random.default_rng(5)
    parts, ahead = [], 0.0
    for speed, seconds in ((1e-5, 100.0), (1e-4, 60.0), (1e-3, 20.0)):
        way = speed * np.arange(0, seconds, 0.02)
        parts.append(ahead + way)
        ahead = parts[-1][-1] + 0.02 * speed
    gone = np.concatenate(parts) / 5e-4
    shape = (1 - np.cos(np.pi * gone)) / 2 if crank else np.abs((gone + 1) % 2 - 1)
    position = 5e-4 * shape + 5e-8 * noise.standard_normal(gone.size)
    run = xr.Dataset({"position": ("time", position)}, {"time": 0.02 * np.arange(gone.size)})
    found = find_segments(run)
    speeds = found.sliding_speed.values
    fast = np.abs(speeds / 1e-3 - 1) < 0.02
    if crank:
        assert not fast.any()
        return
    assert (
        fast.sum() >= 38 and (found.direction.values[fast][1:] != found.direction[fast][:-1]).all()
    )


def test_a_short_plateau_beside_a_long_pause_of_the_record_is_none_of_a_ramp():
    """A sled comes back while nothing is recorded, for longer than its fast ways out take."""
    rng = np.random.default_rng(4)
    speeds = np.array([0.5e-3, 1e-3, 5e-3, 20e-3, 50e-3])
    times, velocities, begin = [], [], 0.0
    for speed in speeds:
        time = begin + np.arange(0, 0.1 / speed, 0.02)
        times.append(time)
        velocities.append(speed * (1 + 0.004 * rng.standard_normal(time.size)))
        begin = time[-1] + 11.33
    run = xr.Dataset(
        {"sliding_velocity": ("time", np.concatenate(velocities))},
        {"time": np.concatenate(times)},
    )
    found = find_segments(run)
    np.testing.assert_allclose(found.sliding_speed, speeds, rtol=2e-3)
    assert not (found.stop - found.start > 0.1 / speeds).any()
    lasted = found.omitted_stop - found.omitted_start
    assert float(lasted.where(found.omitted_reason == "ramp", 0.0).sum()) < 1
