"""Which periods stick-slip has: few of them, scattered, in trains, of two kinds, in noise."""

import numpy as np
import pytest
from slip_cases import noisy, saw, seen

from tribolab.friction.oscillation.oscillation import gather
from tribolab.friction.oscillation.spectrum.spectra import Spectrum


@pytest.mark.parametrize("periods", [2.5, 2.7, 3.0, 3.2, 3.6, 4.1, 4.2, 4.6, 5.3])
@pytest.mark.parametrize("turned", [1, -1])
def test_few_periods_are_right_or_withheld(periods, turned):
    for seed in range(2):
        turns = np.linspace(0, periods, 2000) + 0.37 * (seed + 1)
        found = seen(noisy(turned * 0.2 * saw(turns), seed))
        if periods < 4:
            assert found["waveform"].item() == "not decided"
            assert np.isnan(found["dominant_wavelength"].item())
            assert "not decided" in found["remark"].item()
        elif found["waveform"].item() != "not decided":
            wanted = 40e-6 / periods
            assert found["dominant_wavelength"].item() == pytest.approx(wanted, rel=0.06)
            assert found["recurrence_distance"].item() == pytest.approx(wanted, rel=0.06)


def test_slow_falls_and_sharp_rises_ask_for_the_sensors_sign():
    found = seen(noisy(-0.2 * saw(np.linspace(0, 25, 4000))))
    assert found["waveform"].item() == "reversed sawtooth"
    assert found["regularity"].item() == "regular"
    assert "sign = -1" in found["remark"].item()
    assert found["drop"].item() == pytest.approx(0.2, rel=0.06)


@pytest.mark.parametrize("scatter", [0.3, 0.45, 0.6])
def test_of_scattered_periods_both_distances_are_stated(scatter):
    for seed in range(3):
        rng = np.random.default_rng(seed)
        periods = rng.gamma(scatter**-2, scatter**2, 60)
        turns = np.interp(np.linspace(0, periods[:50].sum(), 6000), np.cumsum(periods), range(60))
        found = seen(noisy(0.2 * saw(turns), seed))
        assert found["waveform"].item() == "sawtooth stick-slip"
        assert found["regularity"].item() == "irregular"
        mean = 120e-6 / np.interp(periods[:50].sum(), np.cumsum(periods), range(1, 61))
        assert found["recurrence_distance"].item() == pytest.approx(mean, rel=0.06)
        assert "drops are" in found["remark"].item()
        assert "the spectrum tells" in found["remark"].item()


@pytest.mark.parametrize("share", [0.3, 0.6])
def test_of_trains_the_share_of_time_and_the_period_within_them_are_told(share):
    train = np.append(np.linspace(0, 10, 500), np.zeros(int(500 / share - 500)))
    found = seen(noisy(0.2 * saw(np.concatenate([train] * 5))))
    assert found["waveform"].item() == "sawtooth stick-slip"
    assert found["regularity"].item() == "intermittent"
    assert found["oscillating_time_share"].item() == pytest.approx(share, abs=0.06)
    assert found["recurrence_distance"].item() == pytest.approx(1e-6, rel=0.03)


def test_of_two_frequencies_both_are_listed_the_strongest_first():
    t = 0.02 * np.arange(5000)
    for first, second in ((0.41, 0.66), (0.66, 0.41), (0.41, 1.5)):
        wave = 0.1 * np.sin(2 * np.pi * first * t) + 0.05 * np.sin(2 * np.pi * second * t + 1)
        found = seen(noisy(wave))
        lines = found["line_frequency"].dropna("line").values
        assert lines == pytest.approx([first, second], rel=0.02)
        assert found["line_swing"].values[:2] == pytest.approx([0.2, 0.1], rel=0.15)
        assert found["dominant_frequency"].item() == pytest.approx(first, rel=0.02)


def test_strong_saws_are_found_in_red_noise_and_nothing_in_the_noise_alone():
    rng = np.random.default_rng(3)
    decay = np.exp(-0.02 / 5.0)
    for _ in range(4):
        white = 0.03 * rng.standard_normal(6000)
        red = np.zeros(6000)
        for k, push in enumerate(np.sqrt(1 - decay**2) * rng.standard_normal(5999)):
            red[k + 1] = decay * red[k] + push
        noise = white + 0.09 * red
        assert seen(1 + noise)["waveform"].item() == "smooth sliding"
        found = seen(1 + noise + 0.2 * saw(np.linspace(0, 80, 6000)))
        assert found["waveform"].item() == "sawtooth stick-slip"
        assert found["dominant_wavelength"].item() == pytest.approx(1.5e-6, rel=0.05)


@pytest.mark.parametrize("bend", ["line", "run-in", "parabola", "half a wave"])
def test_a_slow_drift_of_the_load_is_no_period(bend):
    place = np.linspace(0, 1, 20_000)
    drift = {
        "line": place,
        "run-in": np.exp(-5 * place),
        "parabola": (place - 0.3) ** 2,
        "half a wave": np.sin(4 * place),
    }[bend]
    assert seen(noisy(0.3 * drift))["waveform"].item() == "smooth sliding"
    quick = 0.1 * saw(60 * place) + 0.3 * drift
    found = seen(noisy(quick))
    assert found["waveform"].item() == "sawtooth stick-slip"
    assert found["periods"].item() == pytest.approx(60, rel=0.02)
    assert found["drop"].item() == pytest.approx(0.1, rel=0.08)


def test_what_the_mean_leaves_in_a_spectrum_is_no_line():
    frequency = np.arange(40.0)
    power = np.where(frequency == 0, 10.0, 0.5)
    fine = Spectrum(frequency, power, np.ones(40), np.full(40, 2.0), "made")
    line, _, powers = gather(fine, np.ones(40), 2)
    assert line == 2.0 and powers.sum() == 0


@pytest.mark.parametrize("ratio", [0.3, 0.45, 1.7, 5.3])
@pytest.mark.parametrize("size", [0.1, 0.2, 0.3])
@pytest.mark.parametrize("noise", [0.02, 0.1, 0.2])
def test_a_sine_on_a_larger_sawtooth_is_neither_a_sine_nor_hides_it(ratio, size, noise):
    for seed in (2, 3, 7, 16):  # of the slow ones few periods, which once hid the sawtooth
        rng = np.random.default_rng([seed, 77])
        turns = rng.uniform(8, 30) * np.arange(3000) / 3000
        wave = size * np.sin(2 * np.pi * (ratio * turns + rng.uniform()))
        found = seen(1 + saw(turns) + wave + noise * rng.standard_normal(3000), 0.01)
        assert found["waveform"].item() in ("sawtooth stick-slip", "not decided")
        if found["waveform"].item() != "not decided":
            known = found["dominant_frequency"].item() * 30
            assert known == pytest.approx(turns[-1], rel=0.05)


@pytest.mark.parametrize("noise", [0.02, 0.2])
def test_three_periods_are_not_decided(noise):
    for seed in range(5):
        rng = np.random.default_rng([seed, 12])
        turns = 3 * np.arange(3000) / 3000 + rng.uniform()
        for wave in (saw(turns), np.sin(2 * np.pi * turns) / 2):
            found = seen(1 + wave + noise * rng.standard_normal(3000), 0.01)
            assert found["waveform"].item() == "not decided"
