"""Flow and friction factors: expansions, reciprocity, percolation, tables, the paper."""

import functools

import numpy as np
import pytest
from contact_cases import SURFACES, properties, reference_psd, self_affine, target
from hypothesis import given, settings
from hypothesis import strategies as st
from patir_cheng import patir_cheng
from scipy.optimize import brentq
from scipy.special import erfinv

from tribolab.contact.gap import gap_distribution
from tribolab.contact.persson import mean_separation
from tribolab.contact.separation import separation_table
from tribolab.core.errors import AnalysisError, UnitError
from tribolab.fit.theory_error import factors_of_numerics, pressure_of_numerics
from tribolab.lubrication.factors import FACTORS, FlowFactors, flow_factors, smooth_factors
from tribolab.surface.moments import rms_roughness, rms_slope


@functools.cache
def factors_of(name: str) -> FlowFactors:
    return flow_factors(reference_psd(name))


@pytest.mark.parametrize("percolation", [0.42, 0.5])
@pytest.mark.parametrize("name", SURFACES)
def test_far_apart_all_five_follow_the_expansion_in_roughness_over_separation(name, percolation):
    factors = flow_factors(reference_psd(name), percolation=percolation)
    h = factors.rms_roughness
    d = 1 / (1 - percolation)
    for ratio in (100.0, 1000.0):
        far = factors.at(np.array([ratio * h]))
        small = ratio**-2
        assert 1 - far.phi_p[0] == pytest.approx((9 / d - 3) * small, rel=0.02)
        assert 1 - far.phi_fp[0] == pytest.approx(3 / d * small, rel=0.02)
        assert far.phi_s[0] == pytest.approx(-3 / d / ratio, rel=0.02)
        assert far.phi_fs[0] == pytest.approx(3 / d * small, rel=0.02)
        assert far.phi_f[0] - 1 == pytest.approx(small, rel=0.02)


def test_a_percolation_of_one_half_gives_the_perturbation_theory_of_isotropic_roughness():
    """Tripp: phi_p = 1 - 1.5 (h/u)^2 and phi_s = -1.5 h/u."""
    factors = flow_factors(reference_psd("Sb-S"), percolation=0.5)
    far = factors.at(np.array([300 * factors.rms_roughness]))
    assert (1 - far.phi_p[0]) * 300**2 == pytest.approx(1.5, rel=0.01)
    assert far.phi_s[0] * 300 == pytest.approx(-1.5, rel=0.01)


@pytest.mark.parametrize("name", SURFACES)
def test_what_shear_entrains_is_what_pressure_drags(name):
    """Onsager: the mean flux under shear and the mean shear under a gradient are one average.

    The flux is <u - s (u - u_e)/D>, the drag d s_e <u/D>: two different sums over P(u).
    """
    factors, d = factors_of(name), 1 / 0.58
    h = factors.rms_roughness
    gaps = gap_distribution(np.geomspace(1e-4, 0.03, 5), reference_psd(name), 1.0)
    gap = gaps.gap.values
    for weight, touching in zip(
        gaps.gap_weight.values, gaps.contact_area_ratio.values, strict=True
    ):
        mean = weight @ gap

        def excess(s, weight=weight, touching=touching):
            return d * s * (weight @ (1 / (gap**3 + (d - 1) * s))) + touching * d / (d - 1) - 1

        effective = brentq(excess, 1e-30 * h**3, 1e3 * h**3, xtol=1e-40, rtol=1e-14)
        denominator = gap**3 + (d - 1) * effective
        entrained = d * effective * (weight @ (gap / denominator))
        flux = mean - weight @ (gap**3 * (gap - entrained) / denominator)
        assert flux / mean == pytest.approx(entrained / mean, abs=1e-6)
        at = factors.at(np.array([mean]))
        assert 1 + h * at.phi_s[0] / mean == pytest.approx(at.phi_fp[0], abs=1e-12)
        assert at.phi_fp[0] == pytest.approx(entrained / mean, rel=1e-3)  # between the nodes
        assert at.phi_p[0] == pytest.approx(effective / mean**3, rel=2e-3)


@pytest.mark.parametrize("name", SURFACES)
def test_the_other_end_of_the_theory_is_numerics_near_and_gaussian_gaps_far(name):
    ours, d = factors_of(name), 1 / 0.58
    other, h = factors_of_numerics(ours), ours.rms_roughness
    near = h * np.geomspace(0.3, 2.2, 30)
    np.testing.assert_allclose(other.at(near).phi_f, ours.at(near).phi_f / 1.24, rtol=2e-3)
    np.testing.assert_allclose(other.at(near).phi_p, ours.at(near).phi_p, rtol=2e-3)
    ratio = np.geomspace(9, 40, 30)
    far = other.at(ratio * h)
    np.testing.assert_allclose(far.phi_fs * ratio**2, 3 / d, rtol=2e-3)
    np.testing.assert_allclose((1 - far.phi_p) * ratio**2, 9 / d - 3, rtol=2e-3)
    at_7 = [float(one.at(np.array(7 * h)).phi_fs) * 49 * d / 3 for one in (ours, other)]
    assert at_7[0] > 1.1 and at_7[1] == pytest.approx(1, abs=0.015)
    assert np.all(other.at(h * np.geomspace(0.3, 100, 300)).phi_f > 1)


@pytest.mark.parametrize("name", SURFACES)
def test_the_contact_pressure_of_numerics_is_higher_when_close_only(name):
    table = separation_table(reference_psd(name), 2e6)
    other, h = pressure_of_numerics(table), table.rms_roughness
    u = h * np.geomspace(1e-8, 10, 3000)
    pressure, slope = other.pressure_and_slope(u)
    ratio = pressure / table.pressure(u)
    assert np.all(np.diff(pressure) < 0) and np.all(slope < 0)
    assert ratio[u >= 0.3 * h] == pytest.approx(1, rel=1e-6)
    assert ratio[(u <= 0.13 * h) & (u > table.table_separation[-1])] == pytest.approx(
        1.17, rel=1e-3
    )
    np.testing.assert_allclose(other.separation(pressure), u, rtol=1e-8)


@pytest.mark.parametrize("name", SURFACES)
def test_flow_stops_where_the_contact_percolates(name):
    factors, psd = factors_of(name), reference_psd(name)
    pressure = np.sqrt(np.pi * rms_slope(psd) ** 2 / (2 * np.pi)) * erfinv(0.42)
    closing = mean_separation(float(pressure), psd, 1.0)
    assert factors.percolation_separation == pytest.approx(closing, rel=1e-5)
    closed = factors.at(closing * np.array([0.3, 0.9, 0.9999]))
    assert np.all(closed.phi_p == 0)
    assert np.all(closed.phi_fp == 0)
    np.testing.assert_allclose(
        closed.phi_s, -closing * np.array([0.3, 0.9, 0.9999]) / rms_roughness(psd)
    )
    assert factors.at(np.array([1.01 * closing])).phi_p[0] > 0


@pytest.mark.parametrize("name", SURFACES)
def test_pressure_flow_is_gone_at_the_papers_separation(shared, name):
    published = target(shared, "percolation_separation", "all")
    factors = factors_of(name)
    h = factors.rms_roughness
    assert factors.at(np.array([published * h])).phi_p[0] < 1e-4
    assert factors.at(np.array([0.25 * h])).phi_p[0] < 1e-3
    assert factors.at(np.array([0.5 * h])).phi_p[0] > 0.05


@pytest.mark.parametrize("name", SURFACES)
def test_the_table_is_monotone_and_its_slopes_are_its_own(name):
    factors = factors_of(name)
    h, closing = factors.rms_roughness, factors.percolation_separation
    u = closing + h * np.geomspace(1e-7, 300, 4000)
    phi_p, slope, entrained, rate = factors.transport(u)
    assert np.all(np.diff(phi_p) > 0)
    assert np.all(np.diff(entrained) > 0)
    assert np.all((phi_p >= 0) & (phi_p < 1))
    apart = np.minimum(1e-6 * u, 1e-3 * (u - closing))  # near percolation phi_p bends sharply
    above, below = factors.transport(u + apart), factors.transport(u - apart)
    np.testing.assert_allclose((above[0] - below[0]) / (2 * apart), slope, rtol=1e-3, atol=1e-9 / h)
    np.testing.assert_allclose((above[2] - below[2]) / (2 * apart), rate, rtol=1e-3, atol=1e-9)


def test_shear_flow_changes_sign_with_the_body_that_is_rough():
    rest = factors_of("Sb-S")
    moving = flow_factors(reference_psd("Sb-S"), rough_body="moving")
    u = rest.rms_roughness * np.array([0.1, 0.5, 1.0, 5.0, 50.0])
    np.testing.assert_array_equal(moving.at(u).phi_s, -rest.at(u).phi_s)
    np.testing.assert_array_equal(moving.at(u).phi_p, rest.at(u).phi_p)
    # what a body at rest holds back and what a moving one carries along add up to 2 u
    np.testing.assert_allclose(rest.transport(u)[2] + moving.transport(u)[2], 2 * u)


@pytest.mark.slow
@settings(properties, max_examples=6)
@given(scale=st.floats(0.05, 20), hurst=st.floats(0.5, 1.2))
def test_factors_depend_on_separation_over_roughness_not_on_the_slope(scale, hurst):
    """Stretching heights stretches gaps: phi(u/h) stays, but for the fixed cut-off of <1/u>."""
    one, other = self_affine(hurst, 0.1), self_affine(hurst, 0.1 * scale)
    a, b = flow_factors(one), flow_factors(other, cutoff=1e-9 * scale)
    ratio = np.array([0.3, 1.0, 3.0])
    for x, y in zip(a.at(ratio * a.rms_roughness), b.at(ratio * b.rms_roughness), strict=True):
        np.testing.assert_allclose(x, y, rtol=1e-2)


def test_smooth_surfaces_change_nothing():
    smooth = smooth_factors()
    u = np.geomspace(1e-9, 1e-3, 5)
    for part, value in zip(smooth.at(u), (1, 0, 1, 0, 1), strict=True):
        np.testing.assert_array_equal(part, value)
    np.testing.assert_array_equal(smooth.transport(u)[2], u)


def test_patir_and_cheng_as_printed():
    factors = patir_cheng(1.0)
    # at H = 3 and 6 the mean of the open gaps is H to 4e-4: values of their formulas
    at = factors.at(np.array([3.0004, 6.0]))
    np.testing.assert_allclose(at.phi_p, 1 - 0.9 * np.exp(-0.56 * np.array([3.0, 6.0])), rtol=1e-3)
    expected = [1.899 * 3**0.98 * np.exp(-2.76 + 0.45), 1.126 * np.exp(-1.5)]
    np.testing.assert_allclose(-at.phi_s, expected, rtol=2e-3)
    np.testing.assert_allclose(at.phi_fp, 1 - 1.4 * np.exp(-0.66 * np.array([3, 6])), rtol=1e-3)
    assert at.phi_fs[0] == pytest.approx(11.1 * 3**2.31 * np.exp(-7.14 + 0.99), rel=2e-3)
    assert factors.at(np.array([100.0])).phi_f[0] == pytest.approx(1.0001, abs=2e-5)
    assert np.all(np.isfinite(factors.at(np.array([1e-3, 0.1, 0.39, 0.4, 0.41]))))


@pytest.mark.parametrize("nominal", [0.25, 0.5, 1.0, 1.5, 3.0])
def test_patir_and_cheng_conduct_what_their_nominal_film_conducts(nominal):
    """Theirs stand beside the distance of the mean planes, the solver's beside the mean gap.

    Unconverted the conductance is 1.06 (H = 1.5) to 9.9 times (0.25) too large.
    """
    heights, cell = np.linspace(-10, 10, 200_001, retstep=True)
    bell = np.exp(-(heights**2) / 2) / np.sqrt(2 * np.pi)
    mean = float((np.maximum(nominal + heights, 0) * bell).sum() * cell)
    at = patir_cheng(2e-6).at(np.array([2e-6 * mean]))
    printed = 1 - 0.9 * np.exp(-0.56 * nominal)
    assert at.phi_p[0] * mean**3 == pytest.approx(printed * nominal**3, rel=1e-4)
    assert (mean / nominal) ** 3 > 1.05 or nominal == 3.0
    # stresses: phi_fp h/2 dp/dx, (phi_f + phi_fs) eta v/h
    assert at.phi_fp[0] * mean == pytest.approx(
        max(1 - 1.4 * np.exp(-0.66 * nominal), 1e-3 * mean / nominal) * nominal, rel=1e-3
    )
    printed = 11.1 * nominal**2.31 * np.exp(-2.38 * nominal + 0.11 * nominal**2)
    assert at.phi_fs[0] / mean == pytest.approx(printed / nominal, rel=1e-3)
    # the Couette flow (u + h_rms phi_s) v/2 has the mean gap with them too
    printed = 1.899 * nominal**0.98 * np.exp(-0.92 * nominal + 0.05 * nominal**2)
    assert -at.phi_s[0] == pytest.approx(printed, rel=2e-3)


@pytest.mark.parametrize("name", SURFACES)
def test_patir_and_cheng_have_the_same_general_shape(name):
    """The paper: 'similar to those obtained by Patir and Cheng'."""
    ours = factors_of(name)
    h = ours.rms_roughness
    u = h * np.geomspace(1.0, 10, 20)
    theirs = patir_cheng(h).at(u)
    assert np.max(np.abs(ours.at(u).phi_p - theirs.phi_p)) < 0.12
    assert np.max(np.abs(ours.at(u).phi_s - theirs.phi_s)) < 0.25


def test_the_table_by_name_carries_units_and_what_it_was_made_with():
    table = factors_of("Sb-S").dataset([1e-6, 5e-6])
    assert list(table.data_vars) == list(FACTORS)
    assert table.separation.attrs["units"] == "m"
    assert {table[name].attrs["units"] for name in FACTORS} == {"1"}
    assert "0.42" in table.attrs["model"]
    assert table.attrs["rough_body"] == "stationary"


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (
            lambda: flow_factors(reference_psd("Sb-S") * 0),
            AnalysisError,
            "percolates; use psd=None",
        ),
        (lambda: flow_factors(reference_psd("Sb-S"), "rolling"), AnalysisError, "rough_body"),
        (
            lambda: flow_factors(reference_psd("Sb-S"), percolation=1.2),
            AnalysisError,
            "percolation",
        ),
        (lambda: flow_factors(reference_psd("Sb-S"), cutoff="1 N"), UnitError, "cutoff"),
        (lambda: patir_cheng("1 Pa"), UnitError, "rms_roughness"),
        (lambda: factors_of("Sb-S").dataset([0.0, 1e-6]), AnalysisError, "above zero"),
    ],
)
def test_what_has_no_factors_is_refused(call, error, words):
    with pytest.raises(error, match=words):
        call()


def test_a_roughness_below_what_the_cut_off_resolves_is_refused_with_a_cure():
    psd = reference_psd("Sb-S")
    with pytest.raises(AnalysisError, match="cut-off of 1e-09 m cannot resolve.*psd=None"):
        flow_factors(psd * (1e-10 / rms_roughness(psd)) ** 2)
    with pytest.raises(AnalysisError, match="cannot resolve"):
        flow_factors(psd, cutoff="1 mm")
