"""Friction of the fluid against exact solutions of Reynolds' equation over transverse roughness."""

import numpy as np
import pytest

from tribolab.lubrication.factor_table import FactorTable
from tribolab.lubrication.factors import FlowFactors
from tribolab.lubrication.flow import flow_between
from tribolab.lubrication.friction import fluid_friction
from tribolab.lubrication.line_solver import Fields, Problem, Solution, State
from tribolab.lubrication.mesh import Mesh
from tribolab.lubrication.parabolas import between_middles

HEIGHT, WAVES, LENGTH = 0.6, 400, 1.0
RATE = 6.0  # 6 eta v


def nominal(x):
    """A wedge that closes towards +x."""
    return 2.0 - x / LENGTH


def exact(body: str) -> tuple[float, float]:
    """Load and drag on the moving body, the mean over the phases of the waves; eta v = 1.

    The lower body moves to +x with v, the upper one stands. h^3/(12 eta) dp/dx = q - J where the
    flux J is constant at each moment, q = v h/2 if the upper body has the waves; waves r of the
    lower one move along, so that dh/dt = -v dr/dx and q = v (H - r)/2. The drag is shear and the
    pressure on the slopes of what moves, by parts: int eta v/h + h/2 dp/dx, or, if the waves
    move, int eta v/h + (H - r)/2 dp/dx.
    """
    faces = np.linspace(0, LENGTH, 40 * WAVES + 1)
    x, cell = (faces[1:] + faces[:-1]) / 2, faces[1]
    found = []
    for phase in np.linspace(0, 2 * np.pi, 8, endpoint=False):
        wave = HEIGHT * np.sin(2 * np.pi * WAVES * x / LENGTH - phase)
        h = nominal(x) + wave
        carried = h if body == "stationary" else nominal(x) - wave
        flux = np.sum(carried / h**3) / np.sum(1 / h**3)  # p = 0 at both ends
        slope = RATE * (carried - flux) / h**3
        pressure = np.cumsum(slope) * cell
        found.append([pressure.sum() * cell, (1 / h + carried / 2 * slope).sum() * cell])
    return tuple(np.mean(found, axis=0))


def transverse(body: str) -> FlowFactors:
    """The exact factors of sinusoidal transverse roughness, by <h^-1>, <h^-2> and <h^-3>."""
    u, r = np.geomspace(1.01 * HEIGHT, 50, 3000), HEIGHT
    one, two = (u**2 - r**2) ** -0.5, u * (u**2 - r**2) ** -1.5
    three = (u**2 + r**2 / 2) * (u**2 - r**2) ** -2.5
    flow = np.stack([1 / (u**3 * three), two / (u * three)])
    friction = np.stack([u * one, 3 * u * (one - two**2 / three)])
    ends = np.zeros(2), np.ones(2)
    return FlowFactors(
        r / np.sqrt(2),
        0.0,
        body,
        "transverse",
        FactorTable(u, flow, 0.0, *ends),
        FactorTable(u, friction, 0.0, ends[0], np.array([1.0, 0.0])),
    )


def averaged(body: str) -> tuple[float, float]:
    """The same by the averaged equations: flux of Eq. (3), friction of Eq. (4)."""
    factors = transverse(body)
    faces = np.linspace(0, LENGTH, 4001)
    x, cell = (faces[1:] + faces[:-1]) / 2, faces[1]
    film, width = nominal(x), np.full(x.size, cell)
    between = between_middles(x, width)
    flow = flow_between(between, factors, 1.0, RATE, film)
    flux = np.sum(flow.drive / flow.conductance) / np.sum(1 / flow.conductance)
    pressure = np.cumsum((flow.drive - flux) / flow.conductance)[:-1]
    n = film.size
    mesh = Mesh(x, width, width, between, None, None, None)
    problem = Problem(mesh, factors, None, 1.0, 1.0, 1.0, 1.0, inlet_length=0.0)
    fields = Fields(np.zeros(n), pressure, np.full(n + 1, flux), n, n)
    solution = Solution(RATE, State(film, 0.0, pressure), fields, flow, 0.0, 0.0, 0.0, 0)
    return pressure.sum() * cell, sum(fluid_friction(problem, solution)[0])


@pytest.mark.parametrize("body", ["stationary", "moving"])
def test_load_and_drag_are_those_of_transverse_waves_on_either_body(body):
    """On a body that moves the pressure gradient drags with 2 - phi_fp, as it entrains."""
    np.testing.assert_allclose(averaged(body), exact(body), rtol=2e-3)


def test_a_body_drags_with_the_factor_that_it_entrains_with():
    """Onsager on either body, and the two of them together carry u dp/dx."""
    u = np.array([0.7, 1.0, 2.0, 70.0])
    for body in ("moving", "stationary"):
        factors = transverse(body)
        np.testing.assert_allclose(u * factors.at(u).phi_fp, factors.transport(u)[2], rtol=1e-12)
    both = transverse("moving").at(u).phi_fp + transverse("stationary").at(u).phi_fp
    np.testing.assert_allclose(both, 2, rtol=1e-12)
