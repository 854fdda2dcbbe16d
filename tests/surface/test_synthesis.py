"""Random profiles and maps carry the spectrum they were asked for."""

import numpy as np
import pytest

from tribolab.core.errors import AnalysisError
from tribolab.surface.self_affine import SelfAffine, psd_1d, psd_2d, rms_slope
from tribolab.surface.synthesis import synthesise_map, synthesise_profiles

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


MAP_SPECTRUM = SelfAffine(0.8, rolloff=6e4, plateau=1e-22, low=1.2e4, high=8e5)


@pytest.fixture(scope="module")
def maps():
    return [synthesise_map(MAP_SPECTRUM, points=n, pitch=1e-6, rng=n) for n in (511, 512)]


def test_map_has_the_variance_and_slope_of_its_spectrum(maps):
    for surface in maps:
        height, wanted = surface.height.values, surface.attrs["variance_in_band_m2"]
        assert wanted == pytest.approx(surface.attrs["variance_of_spectrum_m2"], rel=0.01)
        assert height.var() == pytest.approx(wanted, rel=0.1)  # some 600 waves carry the variance
        k = 2 * np.pi * np.fft.fftfreq(height.shape[0], 1e-6)
        waves = np.fft.fft2(height) * np.hypot(k[:, None], k)
        slope = np.sqrt((np.abs(waves) ** 2).sum()) / height.size
        assert slope == pytest.approx(rms_slope(MAP_SPECTRUM), rel=0.02)
        assert abs(height.mean()) < 1e-20


def test_periodogram_of_a_map_is_the_input_in_every_direction(maps):
    height = maps[1].height.values
    n = height.shape[0]
    power = np.abs(np.fft.fft2(height)) ** 2 * (1e-6 / (2 * np.pi * n)) ** 2
    k = 2 * np.pi * np.fft.fftfreq(n, 1e-6)
    q, angle = np.hypot(k[:, None], k), np.arctan2(k[:, None], k) % np.pi
    c = psd_2d(MAP_SPECTRUM, q)
    assert power[c == 0].max() < 1e-30 * power.max()
    for sector in range(8):
        here = (c > 0) & (angle >= sector * np.pi / 8) & (angle < (sector + 1) * np.pi / 8)
        assert (power[here] / c[here]).mean() == pytest.approx(1, abs=4.5 / np.sqrt(here.sum() / 2))


def test_a_map_of_too_few_points_is_refused():
    with pytest.raises(AnalysisError, match="at least 4 points"):
        synthesise_map(SPECTRUM, points=3, pitch=1e-6)
