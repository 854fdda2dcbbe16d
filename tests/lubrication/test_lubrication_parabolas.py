"""Integrals and films between the cells are exact to the fourth order of their width."""

import numpy as np
import pytest
from contact_cases import RandomContact
from scipy.integrate import quad

from tribolab.contact.line import line_kernel
from tribolab.lubrication.flow import _film_between
from tribolab.lubrication.mesh import graded_mesh
from tribolab.lubrication.parabolas import (
    _moments,
    between_middles,
    curved_kernel,
    curved_weights,
    lowest,
    value_at,
)


def cells(number: int) -> tuple[np.ndarray, np.ndarray]:
    """Middles and widths that grow from 1 to 3 across [-3, 3]."""
    faces = np.cumsum(np.append(0, np.linspace(1, 3, number)))
    faces = 6 * faces / faces[-1] - 3
    return (faces[1:] + faces[:-1]) / 2, np.diff(faces)


def bump(x):
    return np.exp(-(x**2))


def errors(number: int) -> tuple[float, float]:
    """Of the load of a bump of pressure, and of what it bends, over those of level cells."""
    x, width = cells(number)
    load = curved_weights(x, width) @ bump(x)
    scale = x[-1] - x[0] + width.mean()
    at = number // 3
    pieces = [-3.0, x[at], 3.0]
    bent = -2 / np.pi * sum(
        quad(lambda t: bump(t) * np.log(abs(t - x[at]) / scale), a, b, epsabs=1e-12, limit=200)[0]
        for a, b in zip(pieces[:-1], pieces[1:], strict=True)
    )  # fmt: skip
    exact = quad(bump, -3, 3, epsabs=1e-13)[0]
    plain = line_kernel(x, width, 1.0)[at] @ bump(x)
    curved = curved_kernel(x, width)[at] @ bump(x)
    assert abs(curved - bent) < abs(plain - bent) / 10
    return abs(load - exact), abs(curved - bent)


def test_load_and_bending_converge_with_the_fourth_power_of_a_cells_width():
    few, many = np.array([errors(24), errors(96)])
    assert np.all(few < 3e-4)
    assert np.all(few / many > 4**3.3)


@pytest.mark.parametrize("distance", [0.0, 0.8, 5.9, 6.1, 40.0])
def test_moments_of_a_cell_are_the_integrals_near_and_far(distance):
    """Closed form within six widths, a series from there on."""
    x, scale = np.array([0.0, distance]), distance + 1

    def integral(power: int) -> float:
        pieces = np.unique(np.clip([distance - 0.5, 0.0, distance + 0.5], distance - 0.5, None))
        ends = zip(pieces[:-1], pieces[1:], strict=True)
        return sum(
            quad(lambda t: (t - distance) ** power * np.log(abs(t) / scale), a, b)[0]
            for a, b in ends
        )

    for power, moments in zip((1, 2), _moments(x, np.ones(2)), strict=True):
        wanted = -2 / np.pi * integral(power)
        assert moments[0, 1] == pytest.approx(wanted, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("level", [2.0, 0.1])
def test_thick_films_are_cubics_in_between_and_thin_ones_straight(level):
    x, width = cells(40)
    between = between_middles(x, width)
    film = level + 1e-3 * (x + 3) ** 3
    points = (x[1:] + x[:-1]) / 2 + np.array([[-0.5], [0.5]]) / np.sqrt(3) * np.diff(x)
    u, share = _film_between(between, film, 1.0)
    inner = slice(2, -2)
    exact = level + 1e-3 * (points + 3) ** 3
    straight = np.stack([np.interp(row, x, film) for row in points])
    wanted = exact if level > 1 else straight
    thin = film[1:] < 0.3
    part = np.ones(39, bool) if level > 1 else thin
    np.testing.assert_allclose(u[:, 1:-1][:, part][:, inner], wanted[:, part][:, inner], rtol=1e-12)
    np.testing.assert_allclose(share.sum(axis=1)[:, [0, -1]], 1.0)


def test_the_film_between_has_the_slopes_that_it_says():
    rng = np.random.default_rng(3)
    x, width = cells(40)
    between = between_middles(x, width)
    film = 0.45 + 0.2 * np.sin(2 * x)  # from straight to curved, in units of the roughness
    change = 1e-6 * rng.normal(size=40)
    up, share = _film_between(between, film + change, 1.0)
    down, _ = _film_between(between, film - change, 1.0)
    _, share = _film_between(between, film, 1.0)
    told = (share * change[between.cell]).sum(axis=1)
    np.testing.assert_allclose((up - down) / 2, told, atol=1e-10)


def test_the_lowest_value_lies_between_the_middles():
    x, _ = cells(30)
    assert lowest(x, 1 + (x - 0.123) ** 2 + 0.05 * x**3) == pytest.approx(1.00009, abs=1e-4)
    assert value_at(x, x**3 - x, 0.4) == pytest.approx(0.4**3 - 0.4, rel=1e-12)


@pytest.mark.slow
def test_friction_of_a_thin_film_on_a_soft_body_is_converged():
    """Where contact is a thousandth of the load, by the film in the constriction: it was 0.4 %."""
    contact = RandomContact("Sb-S", 3.7e6, 1e-3, 240.0, 2.1e-8)
    ours, fine = (contact.curve(9, cells).friction_coefficient for cells in (160, 480))
    np.testing.assert_allclose(ours, fine, rtol=1e-3)


def test_a_mesh_is_finest_at_the_ends_of_the_contact():
    mesh = graded_mesh(160, 0.01, 60.0, 5.0)
    ends = [mesh.x[:80][mesh.width[:80].argmin()], mesh.x[80:][mesh.width[80:].argmin()]]
    np.testing.assert_allclose(ends, [-1, 1], atol=0.01)
    assert mesh.weight.sum() == pytest.approx(65.0, rel=1e-2)
