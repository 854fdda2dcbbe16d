"""What repeats with each turn of a rig is its run-out, and stick-slip beside it stays."""

import re

import numpy as np
import pytest
import xarray as xr
from scipy.signal import lfilter

import tribolab as tl
from tribolab.friction.oscillation.rig_waves import rig_wave
from tribolab.friction.oscillation.slip_curve import stick_slip_curve
from tribolab.regime.model import NO_STICK_SLIP, UNEXPLAINED
from tribolab.regime.verdict import sliding_mode

RADIUS, RATE, SPEEDS = 0.018, 200.0, (0.04, 0.08, 0.16)


def disc(ripple, *, turning=1.0, seed=0, noise=0.01, known=True):
    """Friction on a disc, twelve turns at each speed; `ripple` of distance (m) and turns."""
    rng = np.random.default_rng(seed)
    lasts = [12 * 2 * np.pi * RADIUS / v for v in SPEEDS]
    speed = np.concatenate([np.full(int(RATE * t), v) for t, v in zip(lasts, SPEEDS, strict=True)])
    time = np.arange(speed.size) / RATE
    distance = np.cumsum(speed) / RATE
    mu = 0.15 + ripple(distance, distance / (2 * np.pi * RADIUS))
    mu += noise * rng.standard_normal(speed.size)
    signals = {
        "friction_coefficient": mu,
        "sliding_velocity": speed,
        "rotation_speed": turning * speed / RADIUS + 0.01 * rng.standard_normal(speed.size),
    }
    if not known:
        del signals["rotation_speed"]
    return xr.Dataset({name: ("time", v) for name, v in signals.items()}, {"time": time})


def slip_of(run):
    return tl.stick_slip(run, tl.find_segments(run))


def run_out(distance, turns):
    return 0.008 * np.sin(2 * np.pi * turns + 0.5) + 0.004 * np.sin(4 * np.pi * turns)


@pytest.mark.parametrize("turning", [1.0, 0.99])  # and a speed that is a per cent off
def test_run_out_is_no_stick_slip(turning):
    slip = slip_of(disc(run_out, turning=turning))
    assert (slip["waveform"] == "smooth sliding").all()
    assert (slip["instrument"] == "run-out: repeats once and twice a turn").all()
    turns = np.linspace(0, 1, 1000)
    np.testing.assert_allclose(slip["rig_swing"], np.ptp(run_out(0, turns)), rtol=0.1)


def test_a_scratch_is_taken_out_with_its_harmonics():
    slip = slip_of(disc(lambda _, turns: 0.03 * np.exp(-(((turns % 1) - 0.5) ** 2) / 2 / 0.05**2)))
    assert not np.isin(slip["waveform"], ["sawtooth stick-slip", "reversed sawtooth"]).any()
    assert all("run-out: repeats once" in text for text in slip["instrument"].values)


def test_stick_slip_on_a_disc_that_runs_out_stays():
    def both(distance, turns):
        return run_out(distance, turns) + 0.04 * (distance / 17e-3 % 1)

    with_wave, alone = (
        slip_of(disc(wave, noise=0.003)) for wave in (both, lambda d, _: 0.04 * (d / 17e-3 % 1))
    )
    for slip in (with_wave, alone):
        assert (slip["waveform"] == "sawtooth stick-slip").all()
        np.testing.assert_allclose(slip["dominant_wavelength"], 17e-3, rtol=0.02)
    assert all("run-out" in text for text in with_wave["instrument"].values)
    assert (alone["instrument"] == "").all()


def test_noise_slow_or_fast_seldom_passes_for_run_out():
    claims = 0
    for seed in range(150):
        rng = np.random.default_rng(seed)
        turns = rng.uniform(3, 40)
        noise = lfilter([1], [1, -np.exp(-turns / 600)], rng.standard_normal(2000))
        claims += rig_wave(noise, np.linspace(0, 2 * np.pi * turns, 2000)) is not None
    assert claims <= 6  # three orders, each at a chance of 0.001 beside the sides of red noise


def test_strokes_that_are_not_told_apart_are_no_stick_slip():
    run = disc(lambda d, t: 0.0 * d).isel(time=slice(0, 6400))
    wave = 0.03 * abs(np.sin(2 * np.pi * 0.8 * run["time"]))  # what a rectified force shows
    run["friction_coefficient"] = run["friction_coefficient"] + wave
    run = run.drop_vars("rotation_speed")
    assert (slip_of(run)["waveform"] != "smooth sliding").all()
    run.attrs["stroke_frequency_Hz"] = 0.8
    slip = slip_of(run)
    assert (slip["waveform"] == "smooth sliding").all()
    assert all("the strokes: repeats twice" in text for text in slip["instrument"].values)


def mode_of(run):
    segments = tl.find_segments(run)
    curve = tl.measured_stribeck_curve([tl.friction_coefficient(run, segments)])
    return sliding_mode(curve, None, stick_slip_curve([tl.stick_slip(run, segments)]))


def test_the_mode_says_run_out_or_what_to_compare():
    mode = mode_of(disc(run_out))
    assert mode.verdict == NO_STICK_SLIP
    assert "run-out of the disc: friction repeats once and twice a turn at 3 of 3" in mode.text
    blind = mode_of(disc(lambda _, turns: 0.008 * np.sin(2 * np.pi * turns), known=False))
    assert blind.verdict == UNEXPLAINED
    assert re.search("compare the wavelength, 11[2-4] mm at every speed", blind.decide[0])
    assert "circumference of the track" in blind.decide[0]


@pytest.mark.parametrize("turning", [1.0, 1.0005])  # and a speed that is a little off
@pytest.mark.parametrize("hertz", [4.0, 8.0, 5.7])
def test_run_out_that_the_record_is_too_slow_for_is_no_stick_slip(hertz, turning):
    """What turns eight times a second shows twice a second in a record of five samples."""
    time = np.arange(0, 150, 0.2)
    wave = 0.012 * np.sin(2 * np.pi * hertz * time + 0.4)
    noise = 0.003 * np.random.default_rng(3).standard_normal(time.size)
    run = xr.Dataset(
        {
            "friction_coefficient": ("time", 0.46 + wave + noise),
            "sliding_velocity": ("time", np.full(time.size, 2 * np.pi * RADIUS * hertz)),
            "rotation_speed": ("time", np.full(time.size, turning * 2 * np.pi * hertz)),
        },
        {"time": time},
    )
    slip = slip_of(run)
    assert slip["waveform"].values.tolist() == ["smooth sliding"]
    (said,) = slip["instrument"].values
    assert said.startswith("run-out: repeats once a turn; faster than half the record's rate")
    assert float(slip["rig_swing"][0]) == pytest.approx(0.024, rel=0.1)
    mode = mode_of(run)
    assert mode.verdict == NO_STICK_SLIP and "repeats once a turn at 1 of 1" in mode.text


def test_noise_and_other_lines_in_slow_records_seldom_pass_for_run_out():
    claims = 0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        size = int(rng.integers(200, 1200))
        angle = 2 * np.pi * rng.uniform(0.6, 3.0) * np.arange(size)
        line = np.sin(2 * np.pi * rng.uniform(0.05, 0.45) * np.arange(size)) * (seed % 2)
        red = lfilter([1], [1, -rng.uniform(0, 0.9)], rng.standard_normal(size))
        claims += rig_wave(red + 2 * line, angle) is not None
    assert claims <= 6
