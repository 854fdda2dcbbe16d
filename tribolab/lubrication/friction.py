"""Friction of the fluid in a solved film."""

from __future__ import annotations

import numpy as np

from tribolab.lubrication.domain import outside_drag
from tribolab.lubrication.factors import Factors
from tribolab.lubrication.mixed import Problem, Solution


def fluid_friction(
    problem: Problem, solution: Solution, friction_factors: bool
) -> tuple[float, float]:
    """Couette and pressure part of the friction coefficient, Eq. (4) without the solid's.

    Notes
    -----
    The gradient is the fluid's, and counts with the sign that it has in the drag on the flat that
    slides to +x. In the cavity the fluid covers the part u*/u of the flat, u* = 2 J/v being the
    film that the flux would fill, and has no pressure gradient. What the liquid outside the domain
    adds is known in closed form (`outside_drag`).
    """
    u, fields, mesh = solution.state.film, solution.fields, problem.mesh
    if solution.couette == 0:
        return 0.0, 0.0
    # the pressure's drag from the end of the domain, where it is 0, over the cells' faces
    between = np.concatenate([u[:1], (u[1:] + u[:-1]) / 2])
    both = np.stack([u, between])
    factors = problem.factors.at(both * problem.gap) if friction_factors else _plain(both)
    covered = np.ones_like(u)
    # a cavity holds no more than what flows out of the full film, u* = 2 J/v
    covered[fields.front :] = np.minimum(
        1, fields.flux[fields.front] / solution.couette / u[fields.front :]
    )
    shear = (factors.phi_f + factors.phi_fs)[0] / u * covered
    drag = factors.phi_fp[1] * between / 2 @ np.diff(fields.fluid, prepend=0.0)
    # stress g p/b; eta v/u = (couette/6) (g p/b) (g/u)
    unit = problem.gap / (problem.half_width * problem.load)
    beyond = outside_drag(problem, solution)
    return (
        float((solution.couette / 6 * (mesh.width @ shear) + beyond[0]) * unit),
        float((drag + beyond[1]) * unit),
    )


def _plain(u: np.ndarray) -> Factors:
    ones, zero = np.ones_like(u), np.zeros_like(u)
    return Factors(ones, zero, ones, zero, ones)
