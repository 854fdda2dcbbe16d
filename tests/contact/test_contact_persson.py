"""Contact area and mean separation against the published numbers, quadrature and limits."""

import numpy as np
import pytest
import xarray as xr
from contact_cases import (
    CONTACT,
    E_STAR,
    SURFACES,
    properties,
    reference_psd,
    self_affine,
    target,
)
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import erf

from tribolab.contact.hertz import hertz_mean_pressure
from tribolab.contact.persson import (
    apparent_contact_area_ratio,
    contact_area_ratio,
    mean_separation,
)
from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import band

NOMINAL = hertz_mean_pressure(310.0, CONTACT)


@pytest.mark.parametrize("name", SURFACES)
def test_areas_of_the_paper_at_the_exact_hertz_pressure(shared, name):
    published = target(shared, "contact_area_ratio", name, "0.042 MPa; no adhesion")
    found = contact_area_ratio(NOMINAL, reference_psd(name), E_STAR)
    assert found == pytest.approx(published, rel=0.01)


@pytest.mark.parametrize("name", ["Sb-S", "Sb-R"])
def test_areas_of_the_paper_at_a_tenth_of_a_megapascal(shared, name):
    published = target(shared, "contact_area_ratio", name, "0.1 MPa; no adhesion")
    found = contact_area_ratio("0.1 MPa", reference_psd(name), "2 MPa")
    assert found == pytest.approx(published, rel=0.01)


def test_area_does_not_depend_on_how_finely_the_spectrum_is_tabulated():
    coarse = contact_area_ratio(NOMINAL, reference_psd("Sb-S"), E_STAR)
    for points in (20, 200, 1201):
        fine = contact_area_ratio(NOMINAL, reference_psd("Sb-S", points), E_STAR)
        assert fine == pytest.approx(coarse, rel=1e-12)


def test_apparent_area_is_that_of_the_spectrum_cut_at_each_wavenumber():
    psd = reference_psd("Smooth", 40)
    pressures = xr.DataArray([1e3, 4e4, 3e5], dims="load")
    area = apparent_contact_area_ratio(pressures, psd, E_STAR)
    assert area.dims == ("load", "wavenumber")
    assert (area.isel(wavenumber=0) == 1).all()
    for stop in (1, 17, 40):
        q = psd.wavenumber.values
        cut = contact_area_ratio(pressures, band(psd, q[0], q[stop]), E_STAR)
        np.testing.assert_allclose(area.isel(wavenumber=stop), cut, rtol=1e-12)
    assert (area.diff("wavenumber") <= 0).all()


@properties
@given(
    hurst=st.floats(0.3, 1.2),
    slope=st.floats(0.01, 3),
    pressures=st.lists(st.floats(1e-3, 1e9), min_size=2, max_size=8, unique=True),
)
def test_area_grows_and_separation_falls_with_pressure(hurst, slope, pressures):
    psd = self_affine(hurst, slope)
    p = np.sort(pressures)
    area, u = contact_area_ratio(p, psd, E_STAR), mean_separation(p, psd, E_STAR)
    assert np.all((area >= 0) & (area <= 1))
    assert np.all(np.diff(area) >= 0)
    assert np.all(np.diff(u) <= 0)
    assert np.all(np.diff(u)[u[1:] > 0] < 0)


def test_area_at_small_pressure_is_the_known_multiple_of_pressure_over_slope():
    p = np.array([1e-3, 1.0, 1e3])
    found = contact_area_ratio(p, self_affine(0.8, 0.7), E_STAR)
    np.testing.assert_allclose(found, np.sqrt(8 / np.pi) * p / (0.7 * E_STAR), rtol=1e-6)


def by_double_quadrature(pressure, name, gamma):
    """Yang and Persson's integral over wavenumber and pressure, as they print it."""
    psd = reference_psd(name)
    q_nodes, c_nodes = psd.wavenumber.values, psd.psd_2d.values
    steep = np.log(c_nodes[2] / c_nodes[1]) / np.log(q_nodes[2] / q_nodes[1])
    q0, qr, q1 = q_nodes

    def spectrum(q):
        return c_nodes[0] * max(q / qr, 1.0) ** steep

    def slope2(q):
        flat = c_nodes[0] * (min(q, qr) ** 4 - q0**4) / 4
        return flat + c_nodes[0] * qr**4 * ((max(q, qr) / qr) ** (4 + steep) - 1) / (4 + steep)

    def outer(log_q):
        q = np.exp(log_q)
        w = 1 / np.sqrt(np.pi * slope2(q)) / E_STAR

        def inner(log_p):
            x = w * np.exp(log_p)
            return (gamma + 3 * (1 - gamma) * erf(x) ** 2) * np.exp(-x * x)

        edges = np.log(pressure), np.log(1 / w), np.log(7 / w)
        if edges[0] > edges[2]:
            return 0.0
        parts = [e for e in edges if e >= edges[0]]
        value = sum(
            quad(inner, a, b, epsrel=1e-9, epsabs=1e-12, limit=200)[0]
            for a, b in zip(parts[:-1], parts[1:], strict=True)
        )
        return np.sqrt(np.pi) * q**3 * spectrum(q) * w * E_STAR * value

    start = np.log(q0) + np.log1p(1e-9)
    edges = [start, np.log(1.01 * q0), np.log(10 * q0), np.log(qr), np.log(q1)]
    return sum(
        quad(outer, a, b, epsrel=1e-7, epsabs=1e-14, limit=200)[0]
        for a, b in zip(edges[:-1], edges[1:], strict=True)
    )


@pytest.mark.parametrize(
    ("name", "pressure", "gamma"),
    [("Smooth", 4e4, 0.45), ("Sb-S", 1e3, 0.5), ("Sb-R", 4e4, 0.45), ("Sb-R", 1e6, 0.45)],
)
def test_separation_agrees_with_the_printed_double_integral(name, pressure, gamma):
    found = mean_separation(pressure, reference_psd(name), E_STAR, gamma)
    assert found == pytest.approx(by_double_quadrature(pressure, name, gamma), rel=2e-5)


def test_separation_does_not_depend_on_how_finely_the_spectrum_is_tabulated():
    p = np.geomspace(1e-3, 1e6, 25)
    coarse = mean_separation(p, reference_psd("Sb-R"), E_STAR)
    fine = mean_separation(p, reference_psd("Sb-R", 1201), E_STAR)
    np.testing.assert_allclose(fine, coarse, rtol=2e-6)


def test_a_stronger_reduction_of_elastic_energy_lets_the_surfaces_come_closer():
    psd = reference_psd("Sb-S")
    u = [mean_separation(1e3, psd, E_STAR, gamma) for gamma in (0.45, 0.5, 1.0)]
    assert u[0] < u[1] < u[2]


def test_zero_pressure_is_no_contact_and_complete_contact_has_no_gap():
    psd = reference_psd("Smooth")
    assert contact_area_ratio(0.0, psd, E_STAR) == 0
    assert mean_separation(0.0, psd, E_STAR) == np.inf
    assert contact_area_ratio(1e12, psd, E_STAR) == 1
    assert mean_separation(1e12, psd, E_STAR) == 0
    assert apparent_contact_area_ratio(0.0, psd, E_STAR).max() == 0


def test_a_surface_without_roughness_touches_everywhere_and_has_no_separation():
    flat = reference_psd("Smooth") * 0
    assert contact_area_ratio(1.0, flat, E_STAR) == 1
    with pytest.raises(AnalysisError, match="no separation: use the Hertz contact"):
        mean_separation(1.0, flat, E_STAR)


def test_a_spectrum_that_begins_with_zeros_is_that_without_them():
    psd = reference_psd("Sb-S", 60)
    padded = xr.Dataset(
        {"psd_2d": ("wavenumber", np.concatenate([[0, 0], psd.psd_2d.values]))},
        coords={"wavenumber": np.concatenate([[100.0, 422.999999], psd.wavenumber.values])},
    )
    for function in (contact_area_ratio, mean_separation):
        found = function(4e4, padded, E_STAR)
        assert found == pytest.approx(function(4e4, psd, E_STAR), rel=1e-5)


@pytest.mark.parametrize("function", [contact_area_ratio, mean_separation])
def test_negative_pressure_and_senseless_moduli_are_refused(function):
    psd = reference_psd("Smooth")
    with pytest.raises(AnalysisError, match="negative; the lowest is -3"):
        function(np.array([1.0, -3.0]), psd, E_STAR)
    with pytest.raises(AnalysisError, match="effective_modulus"):
        function(1.0, psd, 0.0)
    with pytest.raises(AnalysisError, match="q0 must be smaller than q1"):
        function(1.0, psd.isel(wavenumber=slice(None, None, -1)), E_STAR)


def test_gamma_outside_its_range_is_refused():
    with pytest.raises(AnalysisError, match="gamma"):
        mean_separation(1.0, reference_psd("Smooth"), E_STAR, gamma=0.0)


@pytest.mark.parametrize("function", [contact_area_ratio, mean_separation])
def test_results_come_back_the_way_pressures_went_in(function):
    psd = reference_psd("Smooth")
    one = function("40 kPa", psd, E_STAR)
    assert isinstance(one, float)
    grid = xr.DataArray(
        [[4e4, np.nan], [1e3, 4e4]], dims=("load", "x"), coords={"x": [0.0, 1.0]}, name="pressure"
    )
    found = function(grid, psd, E_STAR)
    assert found.dims == ("load", "x")
    assert found.attrs["units"] == {"contact_area_ratio": "1", "separation": "m"}[found.name]
    np.testing.assert_allclose(found.values[[0, 1], [0, 1]], one, rtol=1e-14)
    assert np.isnan(found[0, 1])
    assert function(grid.values, psd, E_STAR).shape == (2, 2)
