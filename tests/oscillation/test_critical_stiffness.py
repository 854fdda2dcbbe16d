"""The critical stiffness that a cycle of stick-slip allows holds the one it was simulated with."""

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

from tribolab.friction.oscillation.critical_stiffness import critical_stiffness
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.friction.segments.find import find_segments
from tribolab.records.runs.notices import distance_to_critical
from tribolab.units.stamping import stamp

A, MEMORY, SPEED, LOAD, DAMPING = 0.01, 1e-6, 1e-5, 10.0, 100.0


def slider(ratio, b, cycles=20):
    """Friction coefficient of a slider with the ageing law, of a rig of k = ratio k_c."""
    stiffness = ratio * (b - A) * LOAD / MEMORY

    def velocity(force, state):
        level = force / LOAD - 0.6 - b * np.log(max(state, 1e-300) * SPEED / MEMORY)
        v = SPEED * np.exp(min(level / A, 60.0))
        for _ in range(25):
            off = A * np.log(v / SPEED) + DAMPING * v / LOAD - level
            v = max(v * np.exp(-off / (A + DAMPING * v / LOAD)), 1e-30)
        return v

    def rates(_, y):
        v = velocity(*y)
        return [stiffness * (SPEED - v), 1.0 - v * y[1] / MEMORY]

    # a cycle is some 10 memory lengths times k_c / k long
    whole = (10.0 / ratio * cycles + 60.0) * MEMORY / SPEED
    y0 = [0.601 * LOAD, MEMORY / SPEED]
    done = solve_ivp(rates, (0, whole), y0, method="LSODA", rtol=1e-6, atol=1e-12)
    time = np.linspace(0.3 * whole, whole, 6000)
    return time - time[0], np.interp(time, done.t, done.y[0]) / LOAD, stiffness / ratio


def forces(time, mu):
    """A run of one speed with both forces."""
    full = np.full(mu.size, 1.0)
    data = {
        "friction_force": LOAD * mu,
        "normal_force": LOAD * full,
        "sliding_velocity": SPEED * full,
    }
    return stamp(xr.Dataset({name: ("time", v) for name, v in data.items()}, {"time": time}))


@pytest.mark.parametrize("b_over_a", [1.6, 2.0, 2.9])
@pytest.mark.parametrize("ratio", [0.3, 0.6, 0.9])
def test_the_true_critical_stiffness_lies_between_the_bounds_also_with_noise(ratio, b_over_a):
    time, mu, true = slider(ratio, b_over_a * A)
    for seed, noise in ((0, 0.0), (1, 0.03), (2, 0.1)):
        rng = np.random.default_rng(seed)
        noisy = mu + noise * np.ptp(mu) * rng.standard_normal(mu.size)
        run = forces(time, noisy)
        found = stick_slip(run, find_segments(run))
        assert found["waveform"].item() == "sawtooth stick-slip"
        low, high = (found[f"critical_stiffness_{end}"].item() for end in ("low", "high"))
        assert low <= true <= high, (noise, low / true, high / true)
        assert low >= found["loading_stiffness"].item()  # softer than critical: it oscillates


def test_a_rig_far_too_soft_has_no_upper_bound_and_few_cycles_have_none():
    low, high = critical_stiffness(np.array([0.1]), np.array([1e-4]), 1e4, 10.0, 20)
    assert 1e4 < low[0] < 1e5 and np.isinf(high[0])
    assert np.isnan(critical_stiffness(np.array([0.1]), np.array([1e-4]), 1e4, 10.0, 4)).all()


@pytest.mark.parametrize("ratio", [0.3, 0.7])
def test_the_distance_of_a_stated_rig_to_the_critical_stiffness_is_stated(ratio):
    time, mu, true = slider(ratio, 2 * A)
    run = forces(time, mu)
    assert distance_to_critical(stick_slip(run, find_segments(run))) == ""
    for factor in (1.0, 0.5):  # half of the true one contradicts the rise of the force
        run.attrs = {"stiffness_N_m": factor * ratio * true, "moving_mass_kg": 0.1}
        found = stick_slip(run, find_segments(run))
        said = distance_to_critical(found)
        if factor < 1:
            assert "which is impossible with such a soft rig" in said
            continue
        low, _, high, _ = said.split(": ")[1].split(maxsplit=3)
        assert float(low) <= ratio <= float(high) < 1.05
        length = 1e-6 * float(said.split()[-2])
        lowest = found["critical_stiffness_low"].item()
        assert 2 * 0.1 * (SPEED / length) ** 2 == pytest.approx(
            0.05 * lowest, rel=0.1
        )  # two digits


def test_a_rig_on_which_friction_is_steady_is_stiffer_than_critical():
    run = forces(np.arange(0, 100, 0.05), 0.4 + 1e-3 * np.random.default_rng(0).normal(size=2000))
    run.attrs = {"stiffness_N_m": 1.2e4}
    assert "above the critical stiffness" in distance_to_critical(
        stick_slip(run, find_segments(run))
    )
