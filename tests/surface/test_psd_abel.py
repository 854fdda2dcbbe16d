"""The inverse Abel transform: closed forms, Parseval, and what A/A0 makes of its errors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import erf, gamma

from tribolab.core.errors import AnalysisError
from tribolab.surface import self_affine
from tribolab.surface.spectra.abel import PowerLaws, invert, power_laws_between

NOMINAL, MODULUS = 0.0417e6, 2e6  # Pa


def area_ratio(moment):
    """Eqs. (6) and (7) of the paper, from int q^3 C dq."""
    return erf(0.5 / np.sqrt((MODULUS / NOMINAL) ** 2 * np.pi / 4 * moment))


def exact_moment(spectrum, low, high, order):
    """Integral of q^order C between two wavenumbers, plateau and power law."""
    power = order - 1 - 2 * spectrum.hurst

    def to(q):
        flat = np.minimum(q, spectrum.rolloff) ** (order + 1) / (order + 1)
        ratio = np.maximum(q / spectrum.rolloff, 1.0)
        steep = np.log(ratio) if power == 0 else (ratio**power - 1) / power
        return flat + spectrum.rolloff ** (order + 1) * steep

    return spectrum.plateau * (to(high) - to(low))


@pytest.mark.parametrize("hurst", [0.5, 0.8, 1.1])
@pytest.mark.parametrize("per_decade", [12, 40])
def test_rolled_off_spectra_come_back_within_1_percent_in_contact_area(hurst, per_decade):
    spectrum = self_affine.SelfAffine(hurst, 5e4, 1e-22, 423.0, np.pi / 1e-9)
    q = np.geomspace(423, np.pi / 1e-9 * 0.9999, round(6.9 * per_decade))
    found = invert(power_laws_between(q, self_affine.psd_1d(spectrum, q)))
    low, high = q[:-1], q[1:]
    # the mean over each annulus, in the moment of Eq. (7); the spectrum's own end is cut off
    weight = exact_moment(spectrum, low, high, 3) / exact_moment(spectrum, low, high, 1)
    inside = high < 1e9
    moment = np.sum((found.power / (2 * np.pi) * weight)[inside])
    exact = exact_moment(spectrum, low, high, 3)[inside].sum()
    assert area_ratio(moment) == pytest.approx(area_ratio(exact), rel=0.01)


@pytest.mark.parametrize("hurst", [0.3, 0.5, 0.8, 1.1, 1.3])
def test_a_pure_power_law_is_exact(hurst):
    # C = q^(-2-2H)  <->  C_1D = sqrt(pi) Gamma(H + 1/2) / Gamma(H + 1) k^(-1-2H)
    factor = np.sqrt(np.pi) * gamma(hurst + 0.5) / gamma(hurst + 1)
    k = np.geomspace(1e3, 1e7, 25)
    edges = np.geomspace(2e3, 5e6, 17)
    found = invert(power_laws_between(k, factor * k ** (-1 - 2 * hurst)), edges)
    exact = np.pi / hurst * -np.diff(edges ** (-2 * hurst))
    np.testing.assert_allclose(found.power, exact, rtol=1e-8)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.floats(-3.0, 1.0), min_size=3, max_size=12),
    st.floats(1.5, 4.5),
)
def test_the_variance_is_conserved_whatever_the_spectrum(steps, exponent):
    edges = 1e4 * 1.4 ** np.arange(len(steps) + 1)
    power = np.exp(np.cumsum(steps))
    slope = np.clip(np.gradient(np.log(power)), -4, 2)
    slope[-1] = -exponent
    profile = PowerLaws(edges, power, slope)
    found = invert(profile)
    tail = profile.level[-1] * (edges[-1] / edges[-2]) ** -exponent * edges[-1] / (exponent - 1)
    whole = power.sum() + 2 * profile.level[0] * edges[0] + 2 * tail
    assert found.below + found.power.sum() + found.above == pytest.approx(whole, rel=1e-5)


def test_sensitivities_are_derivatives():
    edges = np.geomspace(1e3, 1e6, 13)
    weights = np.gradient(np.eye(12), np.log(edges[1:]), axis=0)
    tail = weights[-1]

    def profile(log_power):
        return PowerLaws(edges, np.exp(log_power), weights @ log_power - 1, weights, tail, -1.0)

    log_power = -1.5 * np.log(edges[1:]) + 0.2 * np.cos(np.arange(12))
    found, step = invert(profile(log_power)), 1e-5
    for node in range(12):
        shift = step * (np.arange(12) == node)
        up, down = invert(profile(log_power + shift)), invert(profile(log_power - shift))
        slope = (up.power - down.power) / (2 * step)
        np.testing.assert_allclose(found.sensitivity[:, node], slope, atol=1e-5 * found.power.max())


def test_a_tail_that_no_surface_has_is_refused():
    k = np.geomspace(1e3, 1e6, 20)
    with pytest.raises(AnalysisError, match="noise floor"):
        invert(power_laws_between(k, k**-0.8))
