"""Friction of contacts that slide to and fro, cycle by cycle, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.core.errors import AnalysisError
from tribolab.friction.segments.turns import turns_of

MU, LOAD, HALF, FREQUENCY = 0.3, 10.0, 5e-3, 1.3


def crank(
    *, mu=MU, stiffness=np.inf, offset=1.1, noise=0.05, wear=0.0, seconds=40.0, rate=500.0, seed=0
):
    """A sinusoidal stroke; the contact's elastic part turns over with a stiffness [N/m]."""
    rng = np.random.default_rng(seed)
    time = np.arange(0, seconds, 1 / rate)
    phase = 2 * np.pi * FREQUENCY * time + 0.3
    position, velocity = HALF * np.sin(phase), 2 * np.pi * FREQUENCY * HALF * np.cos(phase)
    load = LOAD + 0.5 * np.sin(phase)
    way = np.sign(velocity)
    limit = mu * (1 + wear * time / seconds) * LOAD
    force = limit * way
    if np.isfinite(stiffness):  # from one limit to the other over 2 limit / stiffness
        turn = np.where(way > 0, -HALF, HALF)
        force = way * np.minimum(limit, -limit + stiffness * np.abs(position - turn))
    friction = force * load / LOAD + offset + noise * rng.standard_normal(time.size)
    data = {
        "position": position + 1e-5 * rng.standard_normal(time.size),
        "sliding_velocity": velocity + 1e-3 * rng.standard_normal(time.size),
        "friction_force": friction,
        "normal_force": load,
    }
    return xr.Dataset({k: ("time", x) for k, x in data.items()}, {"time": time})


@pytest.mark.parametrize("known", ["position", "sliding_velocity"])
def test_each_cycle_has_its_coefficient_whatever_the_zero(known):
    run = crank().drop_vars({"position", "sliding_velocity"} - {known})
    cycles = tl.friction.friction_per_cycle(run, "40 %")
    assert cycles.sizes["cycle"] in (50, 51, 52)
    assert cycles["friction_coefficient"].values == pytest.approx(MU, abs=0.005)
    error = float(cycles["mean_friction_coefficient"] - MU)
    assert abs(error) < 3.5 * float(cycles["mean_friction_coefficient_sem"]) < 0.002
    assert cycles["friction_force_offset"].values == pytest.approx(1.1, abs=0.05)
    assert cycles["stroke_length"].values == pytest.approx(2 * HALF, rel=0.02)
    assert cycles["frequency"].values == pytest.approx(FREQUENCY, rel=0.03)
    # the middle 40 % of a sinusoidal stroke last 2 asin(0.4)/(2 pi f)
    speed = 0.8 * HALF * np.pi * FREQUENCY / np.arcsin(0.4)
    assert cycles["sliding_speed"].values.mean() == pytest.approx(speed, rel=0.02)
    assert float(cycles["trend_p_value"]) > 0.001


def test_the_loops_energy_is_that_of_the_closed_form():
    stiff = tl.friction.friction_per_cycle(crank(noise=0.0, rate=2000.0))
    assert stiff["friction_coefficient_energy"].values == pytest.approx(MU, rel=0.01)
    # a parallelogram: area 4 F (A - F/k) for limits +-F, half stroke A, stiffness k
    stiffness = 5e3
    soft = tl.friction.friction_per_cycle(crank(stiffness=stiffness, noise=0.0, rate=2000.0))
    force = MU * LOAD
    energy = MU * (1 - force / stiffness / HALF)
    assert soft["friction_coefficient_energy"].values == pytest.approx(energy, rel=0.02)
    assert soft["friction_coefficient"].values == pytest.approx(MU, rel=0.01)


def test_wear_is_a_trend_over_the_cycles():
    cycles = tl.friction.friction_per_cycle(crank(wear=0.2))
    assert float(cycles["trend_change"]) == pytest.approx(0.2 * MU, rel=0.1)
    assert float(cycles["trend_p_value"]) < 1e-6
    assert float(cycles["mean_friction_coefficient"]) == pytest.approx(1.1 * MU, rel=0.01)
    assert float(cycles["mean_friction_coefficient_sem"]) < 0.002


def test_lost_signs_are_asked_for_and_then_used():
    run = crank(offset=0.0)
    lost = run.assign(friction_force=np.abs(run["friction_force"]))
    with pytest.raises(AnalysisError, match="one sign in both directions"):
        tl.friction.friction_per_cycle(lost)
    told = tl.friction.friction_per_cycle(lost.assign_attrs(friction_force_rectified=True))
    assert told["friction_coefficient"].values == pytest.approx(MU, abs=0.01)
    assert np.isnan(told["friction_coefficient_energy"].values).all()


@pytest.mark.parametrize("known", ["position", "sliding_velocity"])
@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_the_speed_of_a_strokes_middle_is_its_way_over_its_time(known, share):
    run = crank().drop_vars({"position", "sliding_velocity"} - {known})
    segments = tl.find_segments(run, stroke_middle=share)
    speed = 2 * share * HALF * np.pi * FREQUENCY / np.arcsin(share)
    assert float(segments["sliding_speed"].mean()) == pytest.approx(speed, rel=0.01)


def test_middles_of_strokes_are_segments_with_half_loops():
    run = crank()
    segments = tl.find_segments(run, stroke_middle="40 %")
    assert segments.sizes["segment"] > 95 and segments.attrs["stroke_middle"] == 0.4
    assert (np.diff(segments["direction"].values.astype(int)) != 0).all()
    friction = tl.friction_coefficient(run, segments)
    off = (friction["friction_coefficient"] - MU) / friction["friction_coefficient_sem"]
    assert np.mean(np.abs(off.values) < 3) > 0.95
    # without it a crank has no segment of constant speed
    assert tl.find_segments(run.drop_vars("position")).sizes["segment"] == 0


@pytest.mark.parametrize("known", ["position", "sliding_velocity"])
def test_no_stroke_goes_across_a_pause_of_the_logger(known):
    run = crank().drop_vars({"position", "sliding_velocity"} - {known})
    time = run["time"].values
    period = 1 / FREQUENCY
    bursts = time % (10 * period) < 4.6 * period  # each ends within a stroke
    cut = run.isel(time=bursts)
    cut = cut.assign_coords(time=cut["time"].values + 600 * (cut["time"].values // (10 * period)))
    whole, parts = (tl.find_segments(one, stroke_middle=0.5) for one in (run, cut))
    usual = float(whole["sliding_speed"].mean())
    np.testing.assert_allclose(parts["sliding_speed"].values, usual, rtol=0.05)
    assert 0.38 < parts.sizes["segment"] / whole.sizes["segment"] < bursts.mean()
    assert "gap" in parts["omitted_reason"].values
    [told] = [row["status"] for row in tl.check(cut).rows if row["check"] == "time_gaps"]
    assert told == "suspect"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda run: run.isel(time=slice(0, 300)), "does not reverse"),
        (lambda run: run.drop_vars(["position", "sliding_velocity"]), "has neither"),
        (lambda run: run.drop_vars("friction_force"), "neither a friction force"),
        (lambda run: run.isel(time=slice(None, None, 150)), "does not move|too fast|fewer"),
    ],
)
def test_what_is_no_reciprocating_run_is_told(change, said):
    with pytest.raises(AnalysisError, match=said):
        tl.friction.friction_per_cycle(change(crank()))


def test_the_first_and_the_last_turn_of_a_record_are_turns():
    time = np.arange(0, 10, 0.002)
    position = 5e-3 * np.sin(2 * np.pi * time)  # begins and ends in the middle of its way
    turn, way = turns_of(position)
    np.testing.assert_allclose(time[turn], np.arange(0.25, 10, 0.5), atol=0.005)
    assert way.tolist() == [-1, 1] * 9 + [-1]
    begun = turns_of(position[200:-200])[0] + 200  # now beyond a turn, as if it had begun there
    np.testing.assert_allclose(time[begun], np.arange(0.75, 9.5, 0.5), atol=0.005)
