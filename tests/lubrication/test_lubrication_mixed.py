"""The solver: every equation checked on the solution, its limits, its convergence."""

import functools

import numpy as np
import pytest
import xarray as xr
from contact_cases import CONTACT, E_STAR, SURFACES, properties, reference_psd
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import simpson
from scipy.interpolate import CubicSpline

from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import hertz_half_width
from tribolab.contact.line import rough_line_contact
from tribolab.contact.separation import separation_table
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.domain import lubrication_problem
from tribolab.lubrication.factors import flow_factors
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.line_solver import _film, _jacobian, _rupture, couette_number
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.lubrication.sweep import dry_state

SPEEDS = np.geomspace(1e-9, 1e-1, 33)
CASES = [("Smooth", 1e-6), ("Sb-S", 1e-4), ("Sb-R", 1e-3), ("Sb-R", 1e-1)]


@functools.lru_cache
def profile(name: str, speed: float, **numerics):
    return film_profile(CONTACT, reference_psd(name), 1.4, 310.0, speed, **numerics)


@pytest.mark.parametrize(("name", "speed"), CASES)
def test_the_load_is_carried_and_shared_as_eq_5_says(name, speed):
    found = profile(name, speed)
    cells = np.gradient(found.x.values)  # not the solver's own widths
    carried = (found.pressure.values * cells).sum()
    assert carried == pytest.approx(310.0, rel=2e-3)
    assert abs(float(found.load_balance)) < 1e-8
    np.testing.assert_array_equal(
        found.pressure.values, found.contact_pressure.values + found.fluid_pressure.values
    )
    table = separation_table(reference_psd(name), E_STAR)
    np.testing.assert_allclose(
        found.contact_pressure, table.pressure(found.separation.values), rtol=1e-12, atol=1e-200
    )
    assert float(found.residual) < 1e-9


@pytest.mark.parametrize(("name", "speed"), CASES)
def test_the_flux_of_eq_3_is_constant_over_the_full_film(name, speed):
    """Eq. (3) integrated from point to point of the printed profile, with the printed factors.

    Between the points the film is a spline, which is not what the solver puts there.
    """
    found = profile(name, speed)
    factors = flow_factors(reference_psd(name))
    full = np.flatnonzero(found.x.values < float(found.cavity_start))
    x, u, p = (found[key].values[full] for key in ("x", "separation", "fluid_pressure"))
    fine = np.linspace(x[:-1], x[1:], 9)
    middle = CubicSpline(x, u)(fine)
    at = factors.at(middle)
    resistance = 12 * 1.4 / (middle**3 * at.phi_p)
    entrained = speed / 2 * (middle + factors.rms_roughness * at.phi_s)
    driven = simpson(resistance * entrained, x=fine, axis=0)
    flux = (driven - np.diff(p)) / simpson(resistance, x=fine, axis=0)
    size = np.maximum(np.abs(float(found.flux)), speed / 2 * (u[1:] + u[:-1]) / 2)
    assert np.max(np.abs(flux - float(found.flux)) / size) < 5e-4
    assert float(found.flux_variation) < 1e-6


@pytest.mark.parametrize(("name", "speed"), CASES)
def test_no_fluid_pulls_and_the_cavity_opens_towards_the_outlet(name, speed):
    found = profile(name, speed)
    p, u = found.fluid_pressure.values, found.separation.values
    cavity = found.x.values >= float(found.cavity_start)
    assert np.all(p >= 0)
    assert np.all(p[cavity] == 0)
    assert np.all(p[~cavity] > 0)
    factors = flow_factors(reference_psd(name))
    entrained = speed / 2 * (u + factors.rms_roughness * factors.at(u).phi_s)
    assert np.all(np.diff(entrained[cavity]) > 0)
    # the film ruptures where as much is entrained as flows, between the cells beside the first
    first = int(np.argmax(cavity))
    assert entrained[first - 1] <= float(found.flux) <= entrained[first + 1]


@pytest.mark.parametrize("friction_factors", [True, False])
@pytest.mark.parametrize(("name", "speed"), CASES[1:])
def test_friction_is_eq_4_integrated_over_the_printed_profile(name, speed, friction_factors):
    """In SI, from the profile and the printed factors alone.

    In the cavity liquid covers what it takes to carry the flux, at u + h_rms phi_s a width.

    Before the profile's beginning at -X the gap is x^2/2R, to leading order: the integral of
    eta v/u is 2 eta v R/X there, and that of u/2 dp/dx three times as much.
    """
    found = profile(name, speed)
    x, u, p = (found[key].values for key in ("x", "separation", "fluid_pressure"))
    cells = np.gradient(x)
    phi = flow_factors(reference_psd(name)).dataset(found.separation)
    one = xr.ones_like(found.separation)
    shear = phi.shear_stress_factor + phi.shear_stress_correction if friction_factors else one
    dragged = phi.pressure_stress_factor if friction_factors else one
    cavity = x >= float(found.cavity_start)
    rough = flow_factors(reference_psd(name)).rms_roughness
    entrained = u + rough * phi.shear_flow_factor.values
    covered = np.where(cavity, 2 * float(found.flux) / speed / entrained, 1)
    assert covered.max() < 1.05  # as much as there is, where the film ruptures
    couette = (shear.values * 1.4 * speed / u * covered * cells).sum() / 310
    # the flat slides to +x: where the fluid's pressure rises along x it is held back
    pressure = np.trapezoid(dragged.values * u / 2, p) / 310
    before = 2 * 1.4 * speed * CONTACT.radius / -(x[0] - cells[0] / 2) / 310
    couette, pressure = couette + before, pressure + 3 * before
    solid = 0.84e6 * (found.contact_area_ratio.values * cells).sum() / 310
    curve = stribeck_curve(
        CONTACT, reference_psd(name), 1.4, 310.0, 0.84e6, speed, friction_factors=friction_factors
    )
    parts = {"couette": couette, "pressure": pressure, "solid": solid}
    for part, value in parts.items():
        mu = float(curve[f"friction_coefficient_{part}"][0])
        assert value == pytest.approx(mu, rel=5e-3, abs=1e-3 * sum(parts.values())), part


@pytest.mark.parametrize(("name", "speed"), [*CASES, ("Sb-S", 1e-7)])
def test_film_and_pressure_obey_eq_9(name, speed):
    """Displacement by the midpoint rule with the paper's kernel, off the singular cells.

    The rule wants more cells than the solver.
    """
    found = profile(name, speed, cells=400)
    x, u, p = (found[key].values for key in ("x", "separation", "pressure"))
    edges = np.concatenate([[x[0]], (x[1:] + x[:-1]) / 2, [x[-1]]])

    def primitive(t):
        return t * np.log(np.abs(t) + 1e-300) - t

    origin = int(np.argmin(np.abs(x)))
    at = np.searchsorted(x, [-4e-3, -1e-3, 2e-3, 5e-3])
    base = np.diff(primitive(edges - x[origin])) @ p
    for i in at:
        moved = np.diff(primitive(edges - x[i])) @ p - base
        bent = u[i] - u[origin] - (x[i] ** 2 - x[origin] ** 2) / (2 * CONTACT.radius)
        assert bent == pytest.approx(-2 / (np.pi * E_STAR) * moved, rel=2e-3, abs=2e-9)


def test_the_jacobian_is_the_derivative_of_the_equations():
    psd = reference_psd("Sb-S")
    separation = separation_table(psd, E_STAR)
    problem = lubrication_problem(CONTACT, separation, flow_factors(psd), 310.0, 1e-6, 60, 1.0)
    couette = couette_number(problem, 1.4, 3e-5)
    state = dry_state(problem, CONTACT, separation_table(psd, E_STAR), 310.0)
    film = _film(problem, couette, state)
    matrix = _jacobian(problem, film)
    weight = film.total.max() / problem.load  # of the load's row
    rng = np.random.default_rng(1)
    for _ in range(3):
        change = rng.normal(size=60) * state.film * 1e-6
        constant = 1e-6 * rng.normal()
        sides = []
        for sign in (1, -1):
            moved = _film(
                problem, couette, state.moved(problem.mesh, sign * change, sign * constant)
            )
            assert moved.fields.front == film.fields.front
            # a row is a balance times its scale at the state; the scale's own change is left out
            residual = moved.residual.copy()
            full = slice(0, film.fields.front)
            residual[full] *= (film.scale / moved.scale)[full]
            load = weight * (problem.mesh.weight @ moved.total)
            sides.append(np.append(residual, load))
        numeric = (sides[0] - sides[1]) / 2
        analytic = matrix @ np.append(change, constant)
        np.testing.assert_allclose(numeric, analytic, atol=2e-6 * np.abs(analytic).max())


@pytest.mark.parametrize("name", SURFACES)
def test_slow_sliding_is_the_dry_contact(name):
    psd = reference_psd(name)
    dry = rough_line_contact(310.0, CONTACT, psd, points=1201)
    cell = float(dry.x[1] - dry.x[0])
    boundary = float((dry.contact_area_ratio * cell).sum()) / 310.0  # int (A/A0) dx / (F/L)
    curve = stribeck_curve(CONTACT, psd, 1.4, 310.0, "1 MPa", [0.0, 1e-12])
    np.testing.assert_allclose(curve.friction_coefficient, 1e6 * boundary, rtol=1e-3)
    assert curve.friction_coefficient_couette[0] == 0
    rest = film_profile(CONTACT, psd, 1.4, 310.0, 0.0)
    assert np.all(rest.fluid_pressure.values == 0)
    between = CubicSpline(rest.x, rest.pressure)(dry.x)
    assert float(between.max()) == pytest.approx(float(dry.max_pressure), rel=1e-4)


@pytest.mark.parametrize("load", [310.0, 2110.0])
def test_the_smooth_film_is_that_of_soft_elastohydrodynamics(load):
    """h/R = C (eta U/(E' R))^0.6 (W/(E' R))^-0.2; Hooke has C = 3.10."""
    speeds = np.geomspace(1e-7, 1e-4, 13)
    curve = stribeck_curve(CONTACT, None, 1.4, load, 0.0, speeds)
    size = 2 * E_STAR * CONTACT.radius
    theory = CONTACT.radius * (1.4 * speeds / 2 / size) ** 0.6 * (load / size) ** -0.2
    constant = curve.minimum_separation.values / theory
    assert constant.min() > 2.95
    assert constant.max() < 3.15


def test_the_rigid_smooth_film_is_that_of_martin():
    """h = 4.9 eta U R L/F between a hard cylinder and a plane."""
    stiff = LineContact(0.07, 0.1, "100 GPa", 0.5)
    curve = stribeck_curve(stiff, None, 1.4, 310.0, 0.0, [1e-1], domain=2.0, cells=600)
    assert float(curve.minimum_separation[0]) == pytest.approx(
        4.9 * 1.4 * 0.05 * 0.07 / 310, rel=0.02
    )


def test_vanishing_roughness_is_smooth():
    psd = reference_psd("Smooth")
    small = psd.assign_coords(wavenumber=psd.wavenumber * 100) * 1e-8
    speeds = [1e-3, 1e-2]
    rough = stribeck_curve(CONTACT, small, 1.4, 310.0, 0.5e6, speeds)
    smooth = stribeck_curve(CONTACT, None, 1.4, 310.0, 0.0, speeds)
    np.testing.assert_allclose(rough.minimum_separation, smooth.minimum_separation, rtol=1e-3)
    np.testing.assert_allclose(rough.friction_coefficient, smooth.friction_coefficient, rtol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "speed", "finest"), [("Smooth", 1e-5, 5e-4), ("Sb-S", 1e-5, 5e-5), (None, 1e-4, 1e-3)]
)
def test_finer_meshes_converge_at_least_linearly(name, speed, finest):
    """Between first and second order: the front of the cavity sits on a cell.

    Where in the cell shifts the film to and fro, by 2e-5 of it already on 100 cells: the order is
    that of friction over two doublings.
    """
    psd = reference_psd(name) if name else None
    films, frictions = [], []
    for cells in (50, 200, 400):
        curve = stribeck_curve(CONTACT, psd, 1.4, 310.0, 0.5e6, [speed], cells=cells)
        films.append(float(curve.minimum_separation[0]))
        frictions.append(float(curve.friction_coefficient[0]))
    assert abs(films[2] / films[1] - 1) < finest
    assert abs(frictions[2] / frictions[1] - 1) < 1e-3
    order = np.log2(abs(frictions[0] - frictions[2]) / abs(frictions[1] - frictions[2])) / 2
    assert order > 1.0


@pytest.mark.slow
@settings(properties, max_examples=5)
@given(
    modulus=st.floats(5, 9),
    viscosity=st.floats(-3, 2),
    load=st.floats(-1.47, 1.47),
    roughness=st.floats(-8, -4.3),
    name=st.sampled_from(SURFACES),
    similar=st.booleans(),
)
@example(6.2, 0.1, 0.0, -8.0, "Sb-S", False)  # heights near the cut-off of gaps
@example(5.0, 0.1, 0.0, -8.0, "Sb-S", True)
def test_anything_converges_or_says_why(modulus, viscosity, load, roughness, name, similar):
    psd, contact = reference_psd(name), LineContact(0.07, 0.1, 10**modulus, 0.5)
    factor = 10**roughness / flow_factors(psd).rms_roughness
    if similar:
        psd = psd.assign_coords(wavenumber=psd.wavenumber / factor) * factor**4
    else:  # the same waves, of another height
        psd = psd * factor**2
    try:
        curve = stribeck_curve(
            contact,
            psd,
            10**viscosity,
            310 * 10**load,
            1e6,
            np.geomspace(1e-9, 1e-1, 17),
            cells=120,
        )
    except AnalysisError as error:
        reasons = "not thin beside the radius", "pressed flat", "far above"
        assert any(reason in str(error) for reason in reasons)
        return
    assert float(curve.residual.max()) < 1e-8
    assert float(np.abs(curve.load_balance).max()) < 1e-8
    film = curve.minimum_separation.values
    # where the film is thick beside what the flow lifts, it grows by less than its last digit
    assert np.all(np.diff(film) >= 0) and film[-1] > film[0]
    assert np.all(np.diff(curve.friction_per_shear_stress.values) <= 1e-12)


def test_scales_do_not_enter():
    """Units of the problem: same numbers, same film over roughness."""
    psd = reference_psd("Sb-S")
    one = stribeck_curve(CONTACT, psd, 1.4, 310.0, 1e6, [1e-5, 1e-3])
    # ten times the size of everything: load/length x 10, speeds keep eta v/(E* R) when x 10
    big = LineContact(0.7, 1.0, 1.5e6, 0.5)
    wide = psd.assign_coords(wavenumber=psd.wavenumber / 10) * 10**4
    other = stribeck_curve(big, wide, 1.4, 3100.0, 1e6, [1e-4, 1e-2], friction_factors=False)
    again = stribeck_curve(CONTACT, psd, 1.4, 310.0, 1e6, [1e-5, 1e-3], friction_factors=False)
    np.testing.assert_allclose(other.friction_coefficient, again.friction_coefficient, rtol=1e-6)
    np.testing.assert_allclose(other.minimum_separation, 10 * one.minimum_separation, rtol=1e-6)


def test_the_film_ruptures_where_its_flux_lies_between_two_faces():
    film = np.array([3.0, 2.0, 1.5, 1.0, 1.4, 2.0, 3.0])  # what each face entrains
    front, rear, flux = _rupture(film, np.ones(7), 0.0)
    assert rear == film.size - 1
    pressure = np.cumsum(film[:front] - flux)
    assert np.all(pressure > 0)
    assert film[front] <= flux <= film[front + 1]


def test_the_contact_lies_where_hertz_says():
    a = hertz_half_width(310.0, CONTACT)
    found = profile("Sb-S", 1e-5)
    above = found.x.values[found.pressure.values > 0.05 * float(found.pressure.max())]
    assert above[0] == pytest.approx(-a, rel=0.1)
    assert above[-1] == pytest.approx(a, rel=0.1)
