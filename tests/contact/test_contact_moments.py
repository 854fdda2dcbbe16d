"""Moments of spectra: closed forms, additivity, and what is no spectrum."""

import numpy as np
import pytest
import xarray as xr
from contact_cases import properties, reference_psd, target
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import (
    band,
    bin_integrals,
    cumulative_at,
    refine_nodes,
    rms_roughness,
    rms_slope,
    spectral_moment,
    spectrum_at,
)


def spectrum(q, c):
    return xr.Dataset(
        {"psd_2d": ("wavenumber", np.asarray(c, float))},
        coords={"wavenumber": np.asarray(q, float)},
    )


@properties
@given(
    slope=st.floats(-6, 2),
    order=st.floats(-1, 6),
    nodes=st.integers(2, 40),
    decades=st.floats(0.1, 7),
)
def test_a_power_law_is_exact_on_any_number_of_nodes(slope, order, nodes, decades):
    q = np.geomspace(1e3, 1e3 * 10**decades, nodes)
    a = slope + order + 1
    length = np.log(q[-1] / q[0])
    exact = length if abs(a * length) < 1e-13 else np.expm1(a * length) / a
    found = spectral_moment(spectrum(q, (q / q[0]) ** slope), order) / q[0] ** (order + 1)
    assert found == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("shift", [0.0, 1e-14, 1e-9, -1e-7, 1e-6, -1e-4])
def test_exponent_minus_one_is_no_special_case(shift):
    q = np.array([2.0, 7.0])
    length, a = np.log(3.5), shift
    exact = length + a * length**2 / 2 + a * a * length**3 / 6
    assert spectral_moment(spectrum(q, q ** (-2 + shift)), 1) == pytest.approx(
        2.0**shift * exact, rel=1e-12
    )


def test_bins_with_a_zero_are_linear_and_not_skipped():
    q, c = np.array([1.0, 2.0, 3.0, 5.0, 6.0]), np.array([1.0, 0.0, 0.0, 2.0, 0.0])
    for order in (-1, 0, 1, 3, 2.5):
        exact = [
            quad(lambda t, n=order: t**n * np.interp(t, q, c), a, b, epsabs=0, epsrel=1e-11)[0]
            for a, b in zip(q[:-1], q[1:], strict=True)
            if np.interp((a + b) / 2, q, c) > 0
        ]
        assert spectral_moment(spectrum(q, c), order) == pytest.approx(sum(exact), rel=1e-10)
        assert bin_integrals(q, c, order)[1] == 0


def test_an_all_zero_spectrum_has_no_roughness():
    flat = spectrum([1.0, 2.0, 3.0], np.zeros(3))
    assert rms_roughness(flat) == 0
    assert rms_slope(flat) == 0


@properties
@given(seed=st.integers(0, 1000), per_decade=st.floats(1, 60))
def test_refining_changes_no_moment(seed, per_decade):
    rng = np.random.default_rng(seed)
    q = np.geomspace(1e3, 1e9, 9) * rng.uniform(0.8, 1.2, 9)
    c = rng.lognormal(size=9, sigma=3) * (rng.random(9) > 0.2)
    fine, fine_c = refine_nodes(q, c, per_decade)
    assert np.isin(q, fine).all()
    wide = np.diff(np.log10(fine)) > 1 / per_decade * (1 + 1e-9)
    assert not (wide & (fine_c[1:] > 0) & (fine_c[:-1] > 0)).any()
    np.testing.assert_allclose(fine_c[np.searchsorted(fine, q)], c, rtol=1e-12)
    for order in (0, 1, 3):
        np.testing.assert_allclose(
            bin_integrals(fine, fine_c, order).sum(), bin_integrals(q, c, order).sum(), rtol=1e-9
        )


def test_the_cumulative_moment_between_nodes_is_that_of_the_band():
    q, c = np.array([1e2, 1e3, 2e3, 5e3, 1e6]), np.array([1e-3, 2e-3, 0.0, 1e-3, 1e-9])
    where = np.array([1e2, 3e2, 1e3, 1.5e3, 2e3, 4e3, 2e5, 1e6])
    for order in (0, 1, 3):
        found = cumulative_at(where, q, c, order)
        for stop, value in zip(where[1:-1], found[1:-1], strict=True):
            edges = np.append(q[q < stop], stop)
            exact = sum(
                quad(lambda t, n=order: t**n * spectrum_at(t, q, c), a, b, epsrel=1e-11)[0]
                for a, b in zip(edges[:-1], edges[1:], strict=True)
            )
            assert value == pytest.approx(exact, rel=1e-9)
        assert found[0] == 0
        assert found[-1] == pytest.approx(bin_integrals(q, c, order).sum(), rel=1e-14)


def test_two_bands_make_the_whole():
    q = np.array([1e2, 1e4, 1e8])
    psd = spectrum(q, [1e-15, 1e-16, 1e-30])
    for cut in (3e2, 1e4, 7e6):
        parts = [band(psd, 1e2, cut), band(psd, cut, 1e8)]
        for order in (1, 3):
            whole = spectral_moment(psd, order)
            assert sum(spectral_moment(p, order) for p in parts) == pytest.approx(whole, rel=1e-12)
    assert spectrum_at(1e3, q, psd.psd_2d.values) == pytest.approx(10**-15.5, rel=1e-12)


def test_rms_values_of_the_published_surfaces(shared):
    for name in ("Smooth", "Sb-S", "Sb-R"):
        psd = reference_psd(name)
        assert rms_roughness(psd) * 1e6 == pytest.approx(
            target(shared, "rms_roughness", name), rel=1e-3
        )
        assert rms_slope(psd) == pytest.approx(target(shared, "rms_slope", name), rel=1e-3)


@pytest.mark.parametrize(
    ("q", "c", "words"),
    [
        ([1e3, 1e4, 1e4, 1e5], np.ones(4), "number 2"),
        ([1e3, 1e5, 1e4, 1e6], np.ones(4), "sort by 'wavenumber'"),
        ([1e6, 1e3], np.ones(2), "q0 must be smaller than q1"),
        ([0.0, 1e3], np.ones(2), "leave q = 0 out"),
        ([1e3], np.ones(1), "at least two"),
        ([1e3, 1e4], [1.0, -1.0], "10000"),
        ([1e3, 1e4], [np.nan, 1.0], "1000"),
    ],
)
def test_what_is_no_spectrum_is_refused_with_the_place(q, c, words):
    with pytest.raises(AnalysisError, match="psd: ") as caught:
        spectral_moment(spectrum(q, c), 1)
    assert words in str(caught.value)


def test_a_dataset_without_the_2d_spectrum_is_refused():
    with pytest.raises(AnalysisError, match="psd_2d"):
        spectral_moment(spectrum([1.0, 2.0], [1.0, 1.0]).rename(psd_2d="psd_1d"), 1)


def test_a_band_with_its_limits_exchanged_or_outside_is_refused():
    psd = spectrum([1e2, 1e6], [1.0, 1.0])
    with pytest.raises(AnalysisError, match="q_low = 1e\\+05 1/m must lie below"):
        band(psd, 1e5, 1e4)
    with pytest.raises(AnalysisError, match="extrapolate"):
        band(psd, 1e2, 1e7)
