"""The dry rough line contact: published numbers, balance, symmetry, limits, convergence."""

import functools

import numpy as np
import pytest
import xarray as xr
from contact_cases import CONTACT, E_STAR, SURFACES, properties, reference_psd, target
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from tribolab.contact.hertz import hertz_half_width, hertz_max_pressure, hertz_pressure
from tribolab.contact.line import contact_width, line_kernel, rough_line_contact
from tribolab.contact.separation import separation_table
from tribolab.core.errors import AnalysisError, UnitError


@functools.cache
def solved(name: str) -> xr.Dataset:
    return rough_line_contact(310.0, CONTACT, reference_psd(name))


def shrunk(name: str, factor: float) -> xr.Dataset:
    """The same surface photographed smaller: roughness falls, slope and contact area stay."""
    psd = reference_psd(name)
    return xr.Dataset(
        {"psd_2d": ("wavenumber", psd.psd_2d.values * factor**4)},
        coords={"wavenumber": psd.wavenumber.values / factor},
    )


@pytest.mark.parametrize("name", ["Sb-S", "Sb-R"])
def test_pressure_and_width_of_the_papers_appendix(shared, name):
    pressure = target(shared, "contact_max_pressure", name)
    width = target(shared, "contact_width", name)
    assert float(solved(name).max_pressure) / 1e6 == pytest.approx(pressure, rel=0.015)
    assert float(solved(name).contact_width) * 1e3 == pytest.approx(width, rel=0.025)


@pytest.mark.parametrize("name", ["Smooth", "Sb-R"])
def test_vanishing_roughness_gives_hertz(shared, name):
    smooth = rough_line_contact(310.0, CONTACT, shrunk(name, 1e-3), points=1001)
    pressure = target(shared, "hertz_max_pressure", "smooth limit")
    width = target(shared, "hertz_contact_width", "smooth limit")
    assert float(smooth.max_pressure) == pytest.approx(hertz_max_pressure(310.0, CONTACT), rel=1e-4)
    assert float(smooth.max_pressure) / 1e6 == pytest.approx(pressure, abs=5e-5)
    # the width at 1e-3 of the maximum still holds the last of the roughness outside 2a
    assert float(smooth.contact_width) * 1e3 == pytest.approx(width, rel=0.005)
    exact = hertz_pressure(smooth.x.values, 310.0, CONTACT)
    assert np.abs(smooth.pressure.values - exact).max() < 0.02 * exact.max()


@pytest.mark.parametrize("name", SURFACES)
def test_the_load_is_carried_and_the_balance_recorded(name):
    found = solved(name)
    step = float(found.x[1] - found.x[0])
    assert float(found.pressure.sum()) * step == pytest.approx(310.0, rel=1e-10)
    assert abs(found.attrs["load_balance"]) < 1e-10
    assert found.attrs["residual"] < 1e-10
    assert found.attrs["steps"] <= 10
    assert "inferred" in found.attrs["contact_width_definition"]


@pytest.mark.parametrize("name", SURFACES)
def test_pressure_and_separation_obey_both_of_their_equations(name):
    found = solved(name)
    table = separation_table(reference_psd(name), E_STAR)
    x, p, u = (found[key].values for key in ("x", "pressure", "separation"))
    np.testing.assert_allclose(table.pressure(u), p, rtol=1e-9)
    # Eq. (9) with its own kernel, ln|(x - x')/x'|, by the midpoint rule off the singular cells
    i, cell = x.size // 2, x[1] - x[0]
    edges = np.append(x - cell / 2, x[-1] + cell / 2)

    def primitive(t):
        return t * np.log(np.abs(t)) - t

    for at in (i + 20, i + 90):
        kernel = np.diff(primitive(edges - x[at])) - np.diff(primitive(edges))
        eq9 = u[i] + x[at] ** 2 / (2 * CONTACT.radius) - 2 / (np.pi * E_STAR) * (kernel @ p)
        assert u[at] == pytest.approx(eq9, rel=1e-6)


@pytest.mark.parametrize("name", SURFACES)
def test_the_solution_is_symmetric_and_falls_outwards(name):
    p, u = solved(name).pressure.values, solved(name).separation.values
    np.testing.assert_allclose(p, p[::-1], atol=1e-11 * p.max())
    np.testing.assert_allclose(u, u[::-1], rtol=1e-9)
    half = p.size // 2
    assert np.all(np.diff(p[half:]) < 0)
    assert np.all(np.diff(u[half:]) > 0)
    assert p[-1] < 1e-4 * p.max()


@pytest.mark.parametrize("name", ["Sb-S", "Sb-R"])
def test_the_answer_converges_with_finer_cells_at_second_order(name):
    results = [
        rough_line_contact(310.0, CONTACT, reference_psd(name), points=n) for n in (101, 301, 901)
    ]
    peak = np.array([float(r.max_pressure) for r in results])
    width = np.array([float(r.contact_width) for r in results])
    # cells three times smaller: an error of second order falls to a ninth
    assert abs(peak[2] - peak[1]) < abs(peak[1] - peak[0]) / 6
    assert abs(peak[2] / peak[1] - 1) < 1e-5
    assert abs(width[2] / width[1] - 1) < 2e-4


def test_roughness_lowers_the_peak_and_widens_the_contact():
    peaks = [float(solved(n).max_pressure) for n in SURFACES]
    widths = [float(solved(n).contact_width) for n in SURFACES]
    assert hertz_max_pressure(310.0, CONTACT) > peaks[0] > peaks[1] > peaks[2]
    assert 2 * hertz_half_width(310.0, CONTACT) < widths[0] < widths[1] < widths[2]


@settings(properties, max_examples=25)
@given(load=st.floats(1e-3, 2e4), name=st.sampled_from(SURFACES), factor=st.floats(0.05, 5))
def test_any_load_on_any_roughness_converges(load, name, factor):
    psd = shrunk(name, factor)
    found = rough_line_contact(load, CONTACT, psd, points=101)
    assert abs(found.attrs["load_balance"]) < 1e-6
    assert found.attrs["residual"] < 1e-5
    assert float(found.max_pressure) < 1.001 * hertz_max_pressure(load, CONTACT)
    assert float(found.contact_width) > 2 * hertz_half_width(load, CONTACT) * 0.98


def test_the_kernel_is_the_integral_of_the_logarithm():
    x = np.array([-0.2, 0.0, 0.1, 0.5])
    width = np.array([0.3, 0.1, 0.1, 0.7])
    kernel = line_kernel(x, width, E_STAR)
    scale = x[-1] - x[0] + width.mean()
    for i in range(4):
        for j in range(4):
            left, right = x[j] - width[j] / 2, x[j] + width[j] / 2
            points = [x[i]] if left < x[i] < right else None
            exact = quad(lambda t, i=i: np.log(abs(x[i] - t) / scale), left, right, points=points)
            assert kernel[i, j] == pytest.approx(-2 / (np.pi * E_STAR) * exact[0], rel=1e-7)


def test_hertz_pressure_pushes_the_flat_into_the_parabola():
    a = hertz_half_width(310.0, CONTACT)
    x = np.linspace(-1.2 * a, 1.2 * a, 1201)
    kernel = line_kernel(x, np.full(x.size, x[1] - x[0]), E_STAR)
    gap = x**2 / (2 * CONTACT.radius) + kernel @ hertz_pressure(x, 310.0, CONTACT)
    inside = np.abs(x) < 0.98 * a
    assert np.ptp(gap[inside]) < 1e-3 * a**2 / (2 * CONTACT.radius)
    assert gap[0] > gap[inside].max()


def test_width_is_measured_where_the_logarithm_crosses():
    x = np.linspace(-5, 5, 101)
    bell = np.exp(-(x**2))
    assert contact_width(x, bell) == pytest.approx(2 * np.sqrt(np.log(1000)), rel=1e-3)
    with pytest.raises(AnalysisError, match="edge of the domain"):
        contact_width(x, np.ones_like(x))


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"load": 0.0}, AnalysisError, "load: a positive"),
        ({"load": -310.0}, AnalysisError, "load: a positive"),
        ({"load": "310 N"}, UnitError, "load"),
        ({"points": 400}, AnalysisError, "odd"),
        ({"psd": reference_psd("Smooth") * 0}, AnalysisError, "use the Hertz contact"),
        ({"psd": reference_psd("Smooth") * 1e-4}, AnalysisError, "pressed flat.*hertz_pressure"),
    ],
)
def test_what_has_no_rough_contact_is_refused_with_the_way_out(change, error, words):
    arguments = {"load": 310.0, "contact": CONTACT, "psd": reference_psd("Smooth")} | change
    with pytest.raises(error, match=words):
        rough_line_contact(**arguments)


def test_results_carry_their_units():
    found = solved("Sb-S")
    units = {name: found[name].attrs["units"] for name in (*found.data_vars, *found.coords)}
    assert units == {
        "pressure": "Pa",
        "separation": "m",
        "contact_area_ratio": "1",
        "max_pressure": "Pa",
        "central_separation": "m",
        "contact_width": "m",
        "x": "m",
        "load": "N/m",
    }
