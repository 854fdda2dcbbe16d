"""Extrapolation to the contact's wavenumbers: what was measured stays, what was added says so."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.core.errors import AnalysisError
from tribolab.studies import xu2026
from tribolab.surface import self_affine
from tribolab.surface.extrapolation import extrapolate
from tribolab.surface.moments import band, rms_roughness, rms_slope

Q1 = np.pi / 1e-9


def spectrum(q, c, error=None):
    data = {"psd_2d": ("wavenumber", c)}
    if error is not None:
        data["psd_2d_low"] = ("wavenumber", c * np.exp(-1.96 * error))
        data["psd_2d_high"] = ("wavenumber", c * np.exp(1.96 * error))
    return xr.Dataset(data, {"wavenumber": q})


@settings(max_examples=25, deadline=None)
@given(st.floats(0.3, 1.24), st.floats(5e3, 1.2e5))
def test_a_measured_band_of_a_rolled_off_surface_gives_the_whole(hurst, rolloff):
    whole = self_affine.SelfAffine(hurst, rolloff, 1e-21, 423.0, Q1)
    part = band(self_affine.tabulate(whole), 2e3, 2e6)
    wide = extrapolate(part, q_low=423.0, q_high=Q1)
    assert wide.attrs["hurst_exponent"] == pytest.approx(hurst, abs=1e-6)
    assert wide.attrs["rolloff_wavenumber_1_m"] == pytest.approx(rolloff, rel=1e-4)
    assert wide.attrs["fit_low_1_m"] >= 1.49 * rolloff
    truth = self_affine.tabulate(whole)
    assert rms_roughness(wide) == pytest.approx(rms_roughness(truth), rel=1e-3)
    assert rms_slope(wide) == pytest.approx(rms_slope(truth), rel=1e-3)


def test_every_point_knows_where_it_comes_from():
    part = band(xu2026.psd("Sb-S"), 3e3, 1e6)
    wide = extrapolate(part, q_low="423 1/m", q_high=Q1)
    q, origin = wide.wavenumber.values, wide.origin.values
    assert (q[0], q[-1]) == (423.0, Q1)
    assert set(origin[q < 3e3 * (1 - 1e-9)]) == {1}
    assert set(origin[q > 1e6 * (1 + 1e-9)]) == {2}
    measured = wide.isel(wavenumber=origin == 0)
    np.testing.assert_array_equal(measured.psd_2d, part.psd_2d)
    assert wide.origin.attrs["flag_meanings"].split()[0] == "measured"
    assert (np.diff(q) > 0).all()


def test_the_fitted_decade_is_the_one_that_was_asked_for():
    q = np.geomspace(1e3, 1e7, 81)
    c = np.where(q < 1e5, q**-3.0, 1e5**1.0 * q**-4.0)
    first = extrapolate(spectrum(q, c), fit_decade=("1e3 1/m", "1e4 1/m"))
    second = extrapolate(spectrum(q, c), fit_decade=(1e6, 1e7))
    assert first.attrs["hurst_exponent"] == pytest.approx(0.5)
    assert second.attrs["hurst_exponent"] == pytest.approx(1.0)
    assert (first.attrs["fit_low_1_m"], first.attrs["fit_high_1_m"]) == (1e3, 1e4)


def test_the_band_of_the_power_law_covers_the_truth_and_widens():
    rng, error = np.random.default_rng(5), 0.1
    q = np.geomspace(1e4, 1e6, 25)
    inside = []
    for _ in range(200):
        noisy = 1e-5 * q**-3.6 * np.exp(error * rng.standard_normal(q.size))
        wide = extrapolate(spectrum(q, noisy, np.full(q.size, error)), fit_decade=(1e5, 1e6))
        end = wide.isel(wavenumber=-1)
        truth = 1e-5 * Q1**-3.6
        inside.append(float(end.psd_2d_low) < truth < float(end.psd_2d_high))
    assert 0.90 <= np.mean(inside) <= 0.99
    added = wide.isel(wavenumber=wide.origin.values == 2)
    assert (np.diff(np.log(added.psd_2d_high / added.psd_2d_low)) > 0).all()


def test_cutting_off_inside_the_spectrum():
    part = extrapolate(xu2026.psd("Sb-R"), q_low=1e4, q_high=1e7)
    truth = band(xu2026.psd("Sb-R"), 1e4, 1e7)
    assert rms_slope(part) == pytest.approx(rms_slope(truth), rel=1e-12)
    assert set(part.origin.values) == {0}


def test_a_surface_that_rises_to_the_longest_wave_says_that_the_plateau_is_assumed():
    q = np.geomspace(1e4, 1e6, 41)
    wide = extrapolate(spectrum(q, 1e-5 * q**-3.6), q_low=1e3)
    assert wide.attrs["rolloff"].startswith("not reached")
    np.testing.assert_allclose(wide.psd_2d[wide.origin == 1], 1e-5 * 1e4**-3.6)


def test_an_extrapolated_spectrum_can_be_extrapolated_again():
    once = extrapolate(band(xu2026.psd("Smooth"), 3e3, 1e6), q_high=1e8)
    again = extrapolate(once, q_low=423.0)
    assert rms_slope(again) == pytest.approx(rms_slope(xu2026.psd("Smooth")), rel=1e-6)


def test_a_range_beyond_the_spectrum_is_the_power_law_alone():
    q = np.geomspace(1e4, 1e6, 41)
    wide = extrapolate(spectrum(q, q**-3.6), q_low=1e7, q_high=1e8)
    np.testing.assert_allclose(wide.psd_2d, wide.wavenumber**-3.6, rtol=1e-9)
    ends = wide.wavenumber.values[[0, -1]].tolist()
    assert (ends, set(wide.origin.values)) == ([1e7, 1e8], {2})
    flat = extrapolate(spectrum(q, q**-3.6), q_low=1e2, q_high=1e3)
    assert (flat.wavenumber.values[[0, -1]].tolist(), set(flat.origin.values)) == ([1e2, 1e3], {1})


Q = np.geomspace(1e4, 1e6, 41)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: extrapolate(spectrum(Q, Q**-3.6), q_low=1e9, q_high=1e8), "q_low must lie below"),
        (lambda: extrapolate(spectrum(Q, Q**-3.6), q_low=-1.0), "q_low must lie below"),
        (lambda: extrapolate(spectrum(Q[::-1], Q**-3.6)), "sort by"),
        (lambda: extrapolate(spectrum(Q[[0, 2, 1, 3]], Q[:4] ** -3.6)), "increase strictly"),
        (lambda: extrapolate(spectrum(Q, Q**2.0)), "does not fall"),
        (lambda: extrapolate(spectrum(Q, 0 * Q)), "zero everywhere"),
        (lambda: extrapolate(spectrum(Q, np.full(Q.size, np.nan))), "finite"),
        (lambda: extrapolate(spectrum(Q, -(Q**-3.6))), "not negative"),
        (lambda: extrapolate(spectrum(Q, Q**-3.6), fit_decade=(1e7, 1e8)), "fit_decade"),
        (lambda: extrapolate(spectrum(Q[:1], Q[:1])), "at least two"),
    ],
)
def test_what_cannot_be_extrapolated_says_why(call, words):
    with pytest.raises(AnalysisError, match=words):
        call()


def test_a_bump_in_the_spectrum_is_kept():
    c = Q**-3.6 * (1 + 3 * np.exp(-0.5 * (np.log(Q / 5e4) / 0.1) ** 2))
    wide = extrapolate(spectrum(Q, c), q_low=1e3, fit_decade=(1e5, 1e6))
    np.testing.assert_array_equal(wide.psd_2d[wide.origin == 0], c)


def test_the_measured_waves_alone_need_no_power_law():
    rising = spectrum(Q, Q**2.0)
    alone = extrapolate(rising, q_high=float(Q[-1]))
    np.testing.assert_array_equal(alone.psd_2d, rising.psd_2d)
    assert np.isnan(alone.attrs["hurst_exponent"]) and "not known" in alone.attrs["rolloff"]
    steep = extrapolate(spectrum(Q, Q**-12.0), q_high=float(Q[-1]))
    assert np.isnan(steep.attrs["hurst_exponent"])  # 5 is none of a rough surface


@pytest.mark.parametrize(("hurst", "led"), [(-0.6, 0), (-0.05, 0), (0.1, 1), (1.2, 1), (1.4, 0)])
def test_a_law_that_no_surface_has_is_not_led_on(hurst, led):
    q = np.geomspace(1e4, 1e6, 41)
    measured = spectrum(q, 1e-5 * q ** (-2 * (1 + hurst)), np.full(41, 0.05))
    if led:
        assert extrapolate(measured).attrs["hurst_exponent"] == pytest.approx(hurst)
        return
    with pytest.raises(AnalysisError, match=f"Hurst exponent of {hurst:.2g} ± "):
        extrapolate(measured)
    alone = extrapolate(measured, q_high=1e6)
    assert np.isnan(alone.attrs["hurst_exponent"]) and alone.wavenumber[-1] == 1e6
