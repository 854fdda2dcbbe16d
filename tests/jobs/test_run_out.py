"""What repeats with each turn cancels over whole turns, and the error of the mean knows it."""

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.friction.mean_error.estimates import estimates_of
from tribolab.friction.run_out import hidden_by_part, in_step, turned

SAMPLES, MU = 600, 0.2
PLACE = np.arange(SAMPLES) / SAMPLES


def told(turns, amplitude, seed, records=200, memory=0.0, known=True):
    """Estimates of records whose friction goes up and down once per turn beside 1 % of noise."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * turns * PLACE
    noise = rng.standard_normal((records, SAMPLES))
    for k in range(1, SAMPLES if memory else 0):
        noise[:, k] = memory * noise[:, k - 1] + np.sqrt(1 - memory**2) * noise[:, k]
    phase = rng.uniform(0, 2 * np.pi, (records, 1))
    values = MU * (1 + amplitude * np.sin(angle + phase) + 0.01 * noise)
    own = (angle,) if known else ()
    return estimates_of([(30 * PLACE, row, *own) for row in values])


def held_and_width(estimates):
    off = np.array([each.mean for each in estimates]) - MU
    sem = np.array([each.sem for each in estimates])
    wide = np.array([each.u95 for each in estimates])
    return np.mean(np.abs(off) < wide), sem.mean() / np.sqrt(np.mean(off**2))


@pytest.mark.slow
@pytest.mark.parametrize("turns", [1.2, 3.3, 10.7])
@pytest.mark.parametrize("memory", [0.0, 0.8])
def test_the_error_holds_the_truth_and_is_no_wider_than_the_unfinished_turn(turns, memory):
    held, width = held_and_width(told(turns, 0.03, [41, int(10 * turns)], memory=memory))
    _, bare = held_and_width(told(turns, 0.0, [42, int(10 * turns)], memory=memory))
    assert held >= 0.93
    assert width < max(1.5, 1.15 * bare)  # what the memory of the noise costs, the wave does not


@pytest.mark.parametrize("turns", [24.0, 48.0, 96.6])
def test_many_turns_do_not_hide_slow_noise(turns):
    """Whole turns in few stretches each look like a line, beside which an error was too small."""
    held, width = held_and_width(told(turns, 0.04, [45, int(turns)], memory=0.9))
    _, bare = held_and_width(told(turns, 0.0, [45, int(turns)], memory=0.9))
    assert held >= 0.93
    assert width < 1.15 * bare


def test_a_speed_that_is_recorded_a_little_wrong_is_mended():
    angle = 2 * np.pi * 48 * PLACE
    assert in_step(np.sin(1.004 * angle), angle)[-1] == pytest.approx(1.004 * angle[-1], rel=2e-3)


@pytest.mark.parametrize("amplitude", [0.01, 0.05])
def test_half_a_turn_makes_the_error_wide(amplitude):
    assert held_and_width(told(0.5, amplitude, 43))[0] >= 0.93


def test_slow_wander_is_not_taken_for_what_the_turns_do():
    """As many records of a wander hold the truth whether a rotation was recorded or not."""
    slow = np.exp(-1 / 60)
    alone = held_and_width(told(1.2, 0.0, 44, memory=slow, known=False))[0]
    turning = held_and_width(told(1.2, 0.0, 44, memory=slow))[0]
    assert turning > alone - 0.03


def test_the_scatter_of_part_of_a_turn_against_samples_of_it():
    at = np.cos(2 * np.pi * 0.6 * np.linspace(-0.5, 0.5, 100_001))
    assert hidden_by_part(0.6) == pytest.approx(at.mean() / at.std() / 1.96, rel=1e-3)


def test_an_angle_with_a_speed_that_is_missing_is_not_known():
    assert np.isnan(turned(np.arange(3.0), np.array([1.0, np.nan, 1.0]))).all()


@pytest.mark.parametrize(("turns", "said"), [(2.4, False), (0.5, True)])
def test_a_coefficient_says_where_less_than_a_turn_was_seen(turns, said):
    rng = np.random.default_rng(5)
    time = 30 * PLACE
    speed = np.full(SAMPLES, 2 * np.pi * turns / 30)
    force = 10 * MU * (1 + 0.03 * np.sin(2 * np.pi * turns * PLACE))
    force += 0.01 * rng.standard_normal(SAMPLES)
    signals = {"friction_force": force, "normal_force": np.full(SAMPLES, 10.0)}
    signals |= {"rotation_speed": speed, "sliding_velocity": 0.02 * speed}
    run = xr.Dataset({name: ("time", v) for name, v in signals.items()}, {"time": time})
    friction = tl.friction_coefficient(run, tl.find_segments(run))
    remark = str(friction["remark"].values[0])
    assert ("of a turn: what repeats with each turn is not averaged out" in remark) == said
    assert (float(friction["friction_coefficient_sem"][0]) < 0.002) == (not said)
