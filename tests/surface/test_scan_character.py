"""Surfaces that no self-affine law carries on: gauges, grooves, a lay; and random ones."""

import numpy as np
import pytest
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.qc.scan.checks import check_scans
from tribolab.qc.scan.profiles import steps
from tribolab.surface.character import dominant_wave, self_affinity_objection, slope_ratio
from tribolab.surface.extrapolation import extrapolate
from tribolab.surface.self_affine import SelfAffine
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.synthesis import synthesise_map, synthesise_profiles

ROUGH = SelfAffine(hurst=0.9, rolloff=2e4, plateau=2e-23, low=1e3, high=4e6)
X = 0.25e-6 * np.arange(20_000)


def profile(height):
    return xr.Dataset({"height": ("x", height)}, {"x": X})


def random_map(seed, stretched=1):
    area = synthesise_map(
        SelfAffine(hurst=0.8, rolloff=2e5, plateau=1e-25, low=1e4, high=1e8),
        points=128,
        pitch=1e-6,
        rng=seed,
    )
    height = np.repeat(area.height.values, stretched, axis=0)[:128]
    return area.assign(height=(("y", "x"), height))


def test_a_sine_has_no_hurst_exponent_and_the_error_says_why():
    spectrum = psd_2d(psd_1d(profile(5e-7 * np.sin(2 * np.pi * X / 1e-4))))
    with pytest.raises(AnalysisError, match=r"Hurst exponent of 3\.4.*one wave of 100 um"):
        extrapolate(spectrum)
    measured = extrapolate(spectrum, q_high=float(spectrum.wavenumber[-1]))
    assert (measured.origin == 0).all()


@pytest.mark.parametrize("shape", ["sine", "square", "sawtooth"])
def test_gauges_are_suspect_and_the_wave_is_named(shape):
    phase = X / 8e-5
    wave = {
        "sine": np.sin(2 * np.pi * phase),
        "square": np.sign(np.sin(2 * np.pi * phase)),
        "sawtooth": phase % 1.0,
    }[shape]
    noise = np.random.default_rng(1).normal(0, 0.02, X.size)
    [row] = check_scans(profile(1e-6 * (wave + noise))).table.query("check == 'self_affine'").iloc
    assert row.status == "suspect" and "one wave of 80 um" in row.message


@pytest.mark.parametrize("turn", [False, True])
def test_a_ground_map_is_suspect_for_its_lay(turn):
    ground = random_map(2, stretched=8)
    if turn:
        ground = ground.assign(height=(("y", "x"), ground.height.values.T))
    spectrum = psd_2d(ground)
    assert "has a lay" in spectrum.attrs["not_self_affine"]
    assert "has a lay" in extrapolate(spectrum, q_high=1e8).attrs["not_self_affine"]
    [row] = check_scans(ground).table.query("check == 'self_affine'").iloc
    assert row.status == "suspect" and "has a lay" in row.message


def test_random_surfaces_are_not_accused():
    for seed in range(5):
        assert self_affinity_objection(random_map(seed)) == ""
        line = synthesise_profiles(ROUGH, points=X.size, pitch=0.25e-6, rng=seed)
        found = check_scans(profile(line.height.values.ravel())).table
        assert found.query("check == 'self_affine'").status.item() == "pass"


def test_waves_and_slopes_against_closed_forms():
    rows = (np.sin(2 * np.pi * X / 1e-4) + 2 * np.sin(2 * np.pi * X / 5e-5))[None]
    share, length = dominant_wave(rows, 0.25e-6)
    assert share == pytest.approx(0.8, abs=0.01) and length == pytest.approx(5e-5, rel=0.01)
    y, x = np.mgrid[:400, :400] * 1e-6
    turned = 1e-6 * np.sin(3e4 * (x + y)) + 3e-7 * np.sin(3e4 * (x - y))
    assert slope_ratio(turned, 1e-6, 1e-6) == pytest.approx(0.3, rel=0.01)


@pytest.mark.parametrize("hold", [1, 5, 10])
def test_the_digit_of_a_gauge_that_stands_still_is_no_jump(hold):
    digit = 12.893e-9
    for seed in range(2):
        line = synthesise_profiles(
            SelfAffine(hurst=0.7, rolloff=2e4, plateau=4e-22, low=1e3, high=4e6),
            points=X.size,
            pitch=0.25e-6,
            rng=seed,
        )
        height = digit * np.round(line.height.values.ravel() / digit)
        height = height[hold * (np.arange(X.size) // hold)]
        if hold == 5:
            assert np.mean(np.diff(height) == 0) > 0.79
        assert not (steps(height) == 3).any()
        height[12_000:] += 2e-5  # a jump that is one
        assert np.flatnonzero(steps(height) == 3).tolist() == [12_000]


def rough(seed, wave=0.0, length=55e-6):
    """A self-affine profile of rms height 0.4 um, and a wave of an amplitude [m] on it."""
    rng, k, x = np.random.default_rng(seed), np.arange(1, 4801), 5e-7 * np.arange(9600)
    parts = rng.normal(size=k.size) + 1j * rng.normal(size=k.size)
    height = np.fft.irfft(np.append(0, parts * np.where(k < 9, 9.0, k) ** -1.3))
    height = 4e-7 * height / height.std() + wave * np.sin(2 * np.pi * x / length)
    return xr.Dataset({"height": (("scan", "x"), height[None])}, {"x": x})


def told_of_waves(scans):
    (row,) = (row for row in check_scans(scans).rows if row["check"] == "self_affine")
    return row["status"], row["message"]


def test_a_wave_that_repeats_in_a_rough_profile_is_told_and_no_other():
    status, message = told_of_waves(rough(0, wave=8e-8))
    assert status == "pass" and "a wave of 55" in message and "with 1.9 % of the mean" in message
    plain = [told_of_waves(rough(seed))[1] for seed in range(12)]
    assert set(plain) == {"no periodic wave or lay is visible"}
