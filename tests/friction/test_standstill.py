"""A stage that stops although the recorded velocity says that it moves."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import tribolab as tl

SPEED, RATE, MU, LOAD = 1e-3, 20.0, 0.3, 10.0


def reciprocating(
    half_stroke: int, *, stops: bool, noise: float = 0.0, seed: int = 0
) -> xr.Dataset:
    """Return four strokes with a set speed as velocity; the third stops half-way if asked."""
    rng = np.random.default_rng(seed)
    stroke = np.ones(2 * half_stroke)
    rest = np.zeros(40)
    ways = [rest, stroke, rest, -stroke, rest, stroke, rest, -stroke, rest]
    velocity = SPEED * np.concatenate(ways)
    real = velocity.copy()
    if stops:
        first = 3 * rest.size + 5 * half_stroke
        real[first : first + half_stroke] = 0.0
    position = np.concatenate([[0.0], np.cumsum(real[1:] / RATE)])
    position = np.round((position + noise * rng.standard_normal(position.size)) / 1e-7) * 1e-7
    size = velocity.size
    force = np.sign(velocity) * MU * LOAD + 0.02 * rng.standard_normal(size)
    load = LOAD + 0.02 * rng.standard_normal(size)
    data = {
        "sliding_velocity": ("time", velocity, {"units": "m/s"}),
        "position": ("time", position, {"units": "m"}),
        "friction_force": ("time", force, {"units": "N"}),
        "normal_force": ("time", load, {"units": "N"}),
    }
    return xr.Dataset(data, {"time": ("time", np.arange(size) / RATE, {"units": "s"})})


@pytest.mark.parametrize("noise", [0.0, 2e-6, 5e-5])
@pytest.mark.parametrize("half_stroke", [112, 280, 1120])
def test_a_stage_that_stops_for_half_a_stroke_is_found_and_does_not_slide(
    half_stroke: int, noise: float
) -> None:
    run = reciprocating(half_stroke, stops=True, noise=noise)
    found = tl.find_segments(run)
    assert found.attrs["velocity_source"] == "position"
    lasted = (found["stop"] - found["start"]).values
    # the third stroke slides for half of the time of the others
    assert sorted(np.round(lasted / (half_stroke / RATE), 1)) == pytest.approx(
        [1, 2, 2, 2], abs=0.1
    )
    assert found["sliding_speed"].values == pytest.approx(SPEED, rel=0.01)
    results = [r for rule, r in tl.check(run, found).results if rule.name == "velocity_position"]
    assert results[0].status == "suspect"
    assert "the position does not change" in results[0].message


@pytest.mark.parametrize("noise", [0.0, 2e-6, 5e-5])
@pytest.mark.parametrize("half_stroke", [112, 280, 1120])
def test_a_stage_that_moves_as_set_is_taken_from_the_velocity_and_passes(
    half_stroke: int, noise: float
) -> None:
    run = reciprocating(half_stroke, stops=False, noise=noise)
    found = tl.find_segments(run)
    assert found.attrs["velocity_source"] == "recorded"
    results = [r for rule, r in tl.check(run, found).results if rule.name == "velocity_position"]
    assert {r.status for r in results} == {"pass"}


def test_a_position_of_another_quantity_does_not_replace_the_velocity() -> None:
    run = reciprocating(280, stops=False)
    other = run.assign(position=run["position"] * 1e-3)
    assert tl.find_segments(other).attrs["velocity_source"] == "recorded"


def test_a_slow_slide_that_stops_is_no_noise_of_the_encoder() -> None:
    """The misfit of the stopped half must not enter the error that decides what is resolved."""
    run = reciprocating(280, stops=True)
    segments = tl.find_segments(run.drop_vars("position"))
    results = [r for rule, r in tl.check(run, segments).results if rule.name == "velocity_position"]
    assert "suspect" in {r.status for r in results} or "fail" in {r.status for r in results}


def test_steps_of_a_coarse_encoder_are_no_resets() -> None:
    run = reciprocating(280, stops=True)
    stroke = float(run["position"].max())
    coarse = np.round(run["position"] / (0.015 * stroke)) * (0.015 * stroke)
    found = tl.find_segments(run.assign(position=coarse.assign_attrs(units="m")))
    assert found.attrs["velocity_source"] == "position"
    assert found["sliding_speed"].values == pytest.approx(SPEED, rel=0.03)
