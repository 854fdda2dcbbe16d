"""The reference system gives the numbers that the paper prints."""

import numpy as np
import pytest

from tribolab.core.errors import AnalysisError
from tribolab.studies import xu2026
from tribolab.surface import self_affine
from tribolab.surface.self_affine import SelfAffine

NAMES = list(xu2026.surfaces)


@pytest.mark.parametrize("name", NAMES)
def test_roughness_and_slope_are_the_published_ones(name):
    surface = xu2026.surface(name)
    # rounded to the digits that the paper prints
    assert f"{self_affine.rms_roughness(surface.spectrum):.4g}" == str(surface.rms_roughness)
    assert f"{self_affine.rms_slope(surface.spectrum):.3g}" == str(surface.rms_slope)


@pytest.mark.parametrize("name", NAMES)
def test_tabulated_spectrum_integrates_to_the_same_numbers(name):
    surface = xu2026.surface(name)
    psd = xu2026.psd(name)
    q, C = psd.wavenumber.values, psd.psd_2d.values
    for order, published in ((2, surface.rms_roughness), (4, surface.rms_slope)):
        integral = 2 * np.pi * np.trapezoid(q**order * C, np.log(q))  # q^(order-1) C dq
        assert np.sqrt(integral) == pytest.approx(published, rel=2e-4)
    assert psd.psd_2d.attrs["units"] == "m4"
    assert "stand-in" in psd.attrs["origin"]
    assert (q[0], q[-1]) == pytest.approx((423.0, np.pi / 1e-9))


def test_nominal_pressures_are_the_published_ones():
    pressures = [xu2026.system.nominal_pressure(force) / 1e6 for force in xu2026.system.loads]
    assert pressures == pytest.approx([0.0417, 0.0714, 0.092, 0.109], abs=6e-4)
    assert 2 * xu2026.system.half_width(31.0) == pytest.approx(7.43e-3, rel=1e-3)
    assert xu2026.system.effective_modulus == pytest.approx(2e6)


def test_speeds_span_four_decades_in_thirteen_equal_steps():
    speeds = np.array(xu2026.SPEEDS)
    assert speeds.size == 13
    assert (speeds[0], speeds[-1]) == (1e-6, 1e-2)
    np.testing.assert_allclose(np.diff(np.log10(speeds)), 1 / 3, atol=2e-3)


def test_unknown_surface_names_the_nearest():
    with pytest.raises(AnalysisError, match="did you mean 'Sb-R'"):
        xu2026.psd("Sb-RR")


@pytest.mark.parametrize("hurst", [0.5, 1.0, 1.19])
def test_closed_forms_agree_with_quadrature(hurst):
    from scipy.integrate import quad

    spectrum = SelfAffine(hurst, rolloff=2e4, plateau=1e-20, low=500.0, high=1e8)
    for order in (1, 3):
        value, _ = quad(
            lambda s, n=order: np.exp((n + 1) * s) * self_affine.psd_2d(spectrum, np.exp(s)),
            np.log(500.0) + 1e-12,
            np.log(1e8) - 1e-12,
            points=[np.log(2e4)],
        )
        assert self_affine.moment(spectrum, order) == pytest.approx(value, rel=1e-6)


@pytest.mark.parametrize("k", [1.0, 100.0, 499.0, 700.0, 1.9e4, 2.1e4, 1e6, 9e7])
def test_profile_spectrum_is_the_abel_transform(k):
    from scipy.integrate import quad

    spectrum = SelfAffine(0.8, rolloff=2e4, plateau=1e-20, low=500.0, high=1e8)
    # q = sqrt(k^2 + w^2) takes the singularity away: C_1D = 2 int_0^inf C dw
    edges = [np.sqrt(q**2 - k**2) for q in (500.0, 2e4, 1e8) if q > k]
    edges = sorted({0.0, *edges}) if k > 500 else edges
    value = sum(
        quad(
            lambda s: np.exp(s) * self_affine.psd_2d(spectrum, np.hypot(k, np.exp(s))),
            np.log(max(a, 1e-9)),
            np.log(b),
            limit=400,
        )[0]
        for a, b in zip(edges[:-1], edges[1:], strict=True)
    )
    assert self_affine.psd_1d(spectrum, k) == pytest.approx(2 * value, rel=1e-6)


def test_profile_spectrum_keeps_the_variance():
    spectrum = xu2026.surface("Sb-S").spectrum
    k = np.geomspace(1e-3, spectrum.high, 40_001)
    variance = 2 * np.trapezoid(self_affine.psd_1d(spectrum, k) * k, np.log(k))
    assert variance == pytest.approx(self_affine.rms_roughness(spectrum) ** 2, rel=1e-4)


def test_profile_slope_is_the_surface_slope_over_root_two():
    spectrum = xu2026.surface("Sb-R").spectrum
    k = np.geomspace(1.0, spectrum.high, 40_001)
    slope = 2 * np.trapezoid(self_affine.psd_1d(spectrum, k) * k**3, np.log(k))
    assert np.sqrt(2 * slope) == pytest.approx(self_affine.rms_slope(spectrum), rel=1e-4)


def test_spectrum_that_makes_no_sense_is_refused():
    with pytest.raises(AnalysisError, match="low < rolloff < high"):
        SelfAffine(0.8, rolloff=1e2, plateau=1e-20, low=1e3, high=1e8)
