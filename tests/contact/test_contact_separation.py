"""The table of p(u): against the theory it holds, its own inverse, and its asymptotes."""

import dataclasses

import numpy as np
import pytest
import xarray as xr
from contact_cases import E_STAR, SURFACES, properties, reference_psd, self_affine, target
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from tribolab.contact.persson import mean_separation
from tribolab.contact.separation import separation_table
from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import cumulative_at, spectrum_arrays, spectrum_at

TABLES = {name: separation_table(reference_psd(name), E_STAR) for name in SURFACES}


def decay_length_by_quadrature(name: str, gamma: float = 0.45) -> float:
    """u0 = 2 gamma int ds/q by parts: s_1/q_1 + int s/q^2 dq, which has no singularity."""
    q, c = spectrum_arrays(reference_psd(name))

    def integrand(log_q):
        return np.sqrt(cumulative_at(np.exp(log_q), q, c, 3)) / np.exp(log_q)

    edges = np.log([q[0], 1.1 * q[0], 10 * q[0], q[1], 100 * q[1], q[2]])
    inside = sum(
        quad(integrand, a, b, epsrel=1e-10, limit=200)[0]
        for a, b in zip(edges[:-1], edges[1:], strict=True)
    )
    return 2 * gamma * (np.sqrt(cumulative_at(q[-1], q, c, 3)) / q[-1] + inside)


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("gamma", [0.45, 0.5])
def test_the_table_is_the_theory(name, gamma):
    psd = reference_psd(name)
    table = separation_table(psd, E_STAR, gamma)
    p = np.geomspace(1e-9, table.table_pressure[-1], 1500)
    u = mean_separation(p, psd, E_STAR, gamma)
    near = u > 1e-7 * table.rms_roughness
    np.testing.assert_allclose(table.separation(p)[near], u[near], rtol=5e-5)
    np.testing.assert_allclose(table.pressure(u)[near], p[near], rtol=1e-4)


@pytest.mark.parametrize("name", SURFACES)
def test_pressure_at_large_separation_decays_with_u0(name):
    table, u0 = TABLES[name], decay_length_by_quadrature(name)
    assert table.decay_length == pytest.approx(u0, rel=1e-7)
    for u in (9, 12, 25):
        u = u * table.rms_roughness
        ratio = table.pressure(u) / table.pressure(u + u0)
        assert ratio == pytest.approx(np.e, rel=1e-5)


@pytest.mark.parametrize("name", SURFACES)
def test_the_printed_alpha_of_one_half_is_its_inverse(shared, name):
    printed = target(shared, "separation_decay_alpha", "all")
    u0 = decay_length_by_quadrature(name) / TABLES[name].rms_roughness
    assert u0 == pytest.approx(printed, abs=0.05)
    assert 1 / u0 == pytest.approx(1.8, abs=0.1)
    at = np.array([4.0, 5.0]) * TABLES[name].rms_roughness
    alpha = -np.diff(np.log(TABLES[name].pressure(at)))[0]
    assert alpha == pytest.approx(1 / u0, rel=0.01)
    assert alpha > 3 * printed


@properties
@given(u=st.floats(1e-9, 60), name=st.sampled_from(SURFACES))
def test_separation_is_the_inverse_of_pressure(u, name):
    table = TABLES[name]
    u = u * table.rms_roughness
    assert table.separation(table.pressure(u)) == pytest.approx(u, rel=1e-10)


@properties
@given(hurst=st.floats(0.3, 1.2), slope=st.floats(0.001, 10), gamma=st.floats(0.3, 1))
def test_pressure_falls_steadily_for_any_surface(hurst, slope, gamma):
    table = separation_table(self_affine(hurst, slope), E_STAR, gamma)
    u = np.geomspace(1e-12, 40, 500) * table.rms_roughness
    pressure, rate = table.pressure_and_slope(u)
    assert np.all(np.diff(pressure) < 0)
    assert np.all(rate < 0)
    np.testing.assert_allclose(table.separation(pressure), u, rtol=1e-9)


def test_the_slope_is_the_derivative_also_beyond_the_table():
    table = TABLES["Sb-S"]
    ends = table.table_separation[[0, -1]]
    u = np.concatenate([np.geomspace(1e-3 * ends[1], 10 * ends[0], 700), ends])
    slope = table.pressure_and_slope(u)[1]
    step = 1e-6 * u
    numeric = (table.pressure(u + step) - table.pressure(u - step)) / (2 * step)
    np.testing.assert_allclose(slope, numeric, rtol=1e-6)


def test_closed_and_open_ends_are_defined():
    table = TABLES["Sb-R"]
    assert table.pressure(0.0) == np.inf
    assert table.separation(np.inf) == 0
    assert table.separation(0.0) == np.inf
    assert table.pressure(np.inf) == 0
    assert np.isnan(table.pressure(np.nan))
    with pytest.raises(AnalysisError, match="separation: it cannot be negative"):
        table.pressure(np.array([1e-6, -1e-9]))
    with pytest.raises(AnalysisError, match="pressure"):
        table.separation(-1.0)


def test_a_table_cannot_be_changed():
    table = TABLES["Smooth"]
    with pytest.raises(dataclasses.FrozenInstanceError):
        table.gamma = 0.5
    with pytest.raises(ValueError, match="read-only"):
        table.table_pressure[0] = 1.0


def test_arrays_keep_their_dims_and_text_its_unit():
    table = TABLES["Smooth"]
    u = xr.DataArray([[1e-6, 2e-6]], dims=("load", "x"))
    p = table.pressure(u)
    assert p.dims == u.dims
    assert p.attrs["units"] == "Pa"
    assert table.separation(p).attrs["units"] == "m"
    assert table.pressure("1 um") == pytest.approx(float(p[0, 0]), rel=1e-14)


def test_noise_on_a_measured_spectrum_does_not_spoil_the_table():
    rng = np.random.default_rng(7)
    psd = reference_psd("Sb-R", 150)
    noisy = psd * xr.DataArray(
        rng.lognormal(sigma=1.0, size=psd.sizes["wavenumber"]), dims="wavenumber"
    )
    noisy["psd_2d"] = noisy.psd_2d.where(rng.random(psd.sizes["wavenumber"]) > 0.05, 0.0)
    table = separation_table(noisy, E_STAR)
    p = np.geomspace(1, 1e6, 60)
    np.testing.assert_allclose(table.separation(p), mean_separation(p, noisy, E_STAR), rtol=1e-4)
    q, c = spectrum_arrays(noisy)
    assert spectrum_at(q, q, c).min() == 0


def test_separations_of_what_is_not_a_number_are_none_and_of_lists_of_text_are_values():
    table = separation_table(reference_psd("Sb-S"), "2 MPa")
    found = table.separation(np.array([np.nan, 42e3]))
    assert np.isnan(found[0]) and np.isfinite(found[1])
    assert table.separation(["42 kPa"])[0] == found[1]
    assert table.pressure(["1 um"])[0] == table.pressure(1e-6)
