"""Random profiles carry the spectrum they were asked for."""

import numpy as np
import pytest

from tribolab.errors import AnalysisError
from tribolab.surface.self_affine import SelfAffine, psd_1d
from tribolab.surface.synthesis import synthesise_profiles

SPECTRUM = SelfAffine(0.8, rolloff=2e4, plateau=1e-20, low=1e3, high=1e7)
PITCH = 2e-6


@pytest.fixture(scope="module")
def profiles():
    return synthesise_profiles(SPECTRUM, points=16_384, pitch=PITCH, profiles=200, rng=7)


def test_variance_is_that_of_the_band(profiles):
    variances = profiles.height.var("x").values
    sem = variances.std(ddof=1) / np.sqrt(variances.size)
    assert abs(variances.mean() - profiles.attrs["variance_in_band_m2"]) < 3.5 * sem
    assert sem < 0.01 * variances.mean()
    left_out = profiles.attrs["variance_of_spectrum_m2"] - profiles.attrs["variance_in_band_m2"]
    assert 0 < left_out < 0.05 * profiles.attrs["variance_of_spectrum_m2"]


def test_slope_is_that_of_the_band(profiles):
    k = np.linspace(0, np.pi / PITCH, 100_001)[1:]
    expected = 2 * np.trapezoid(k**2 * psd_1d(SPECTRUM, k), k)
    spectrum = np.fft.rfft(profiles.height.values, axis=-1)
    wave = 2 * np.pi * np.fft.rfftfreq(16_384, PITCH)
    slopes = np.fft.irfft(1j * wave * spectrum, axis=-1).var(axis=-1)
    assert slopes.mean() == pytest.approx(expected, rel=0.01)


def test_averaged_periodogram_is_the_input(profiles):
    power = np.abs(np.fft.rfft(profiles.height.values, axis=-1)) ** 2 * PITCH / 16_384
    estimate = power.mean(axis=0)[1:-1] / (2 * np.pi)  # two-sided C_1D over wavenumber
    k = 2 * np.pi * np.fft.rfftfreq(16_384, PITCH)[1:-1]
    ratio = estimate / psd_1d(SPECTRUM, k)
    bins = np.array([part.mean() for part in np.array_split(ratio, 64)])
    assert np.abs(bins - 1).max() < 4.5 / np.sqrt(200 * (ratio.size // 64))
    assert ratio.std() == pytest.approx(1 / np.sqrt(200), rel=0.1)  # chi-square of 2 x 200


def test_heights_are_gaussian_with_zero_mean(profiles):
    z = profiles.height.values / profiles.height.values.std()
    assert np.abs(profiles.height.mean("x")).max() < 1e-18
    assert (z**4).mean() == pytest.approx(3.0, rel=0.02)


def test_seed_decides_the_profile():
    kwargs = {"points": 512, "pitch": 1e-6}
    one, again, other = (synthesise_profiles(SPECTRUM, rng=seed, **kwargs) for seed in (1, 1, 2))
    assert one.equals(again)
    assert not one.equals(other)


def test_too_few_points_are_refused():
    with pytest.raises(AnalysisError, match="at least 4 points"):
        synthesise_profiles(SPECTRUM, points=2, pitch=1e-6)
