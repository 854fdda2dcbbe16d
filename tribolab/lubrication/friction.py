"""Fluid friction in the solved film of a line contact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.lubrication.domain import outside_drag
from tribolab.lubrication.line_solver import Problem, Solution
from tribolab.lubrication.speeds import System


class FluidFriction(NamedTuple):
    """Shear and pressure parts of the fluid friction coefficient, Eq. (4)."""

    couette: float
    pressure: float


def friction_parts(system: System, rough: FluidFriction, plain: FluidFriction) -> dict[str, float]:
    """Return the fluid friction of a Stribeck curve, with or without friction factors.

    Notes
    -----
    If both bodies move, shear friction is half the difference between the drags at positive and
    negative slide-roll ratio; the drag by pressure is rolling friction and not included.
    """
    couette, pressure = rough if system.solver.friction_factors else plain
    slide, rolls = abs(system.factors.slide), system.rolls
    return {
        "friction_coefficient_couette": slide * couette,
        "friction_coefficient_pressure": pressure,
        "friction_without_factors": slide * plain.couette + (0.0 if rolls else plain.pressure),
    }


def fluid_friction(problem: Problem, solution: Solution) -> tuple[FluidFriction, FluidFriction]:
    """Return the fluid friction with friction factors, and with phi_f = phi_fp = 1, phi_fs = 0.

    Notes
    -----
    The gradient of the fluid pressure has the sign of the drag on the flat that slides to +x. In
    the cavity it is zero, and the fluid covers the share of the flat for which entrainment equals
    the flux, J = share (v/2)(u + h_rms phi_s): 1 at the rupture of the film, u*/u far behind. The
    drag of the liquid outside the domain is added in closed form (`outside_drag`).
    """
    u, fields, mesh = solution.state.film, solution.fields, problem.mesh
    if solution.couette == 0:
        return FluidFriction(0.0, 0.0), FluidFriction(0.0, 0.0)
    flow = solution.flow
    moving = problem.moving(solution.couette)
    factors = moving.at(np.concatenate([u, *flow.film]) * problem.gap)
    shear = mesh.weight / u
    # the flux through the cavity equals that of the full film
    cavity, flux = slice(fields.front, fields.rear), fields.flux[fields.front] / solution.couette
    carried = u[cavity] + problem.factors.rms_roughness / problem.gap * factors.phi_s[cavity]
    shear[cavity] *= np.where(carried > flux, flux / np.maximum(carried, flux), 1.0)
    # drag by the pressure, from the inlet end, where it is 0, to the rupture of the film
    rise = mesh.between.weight * flow.resistance * (flow.entrained - fields.flux[0])
    if fields.front < fields.rear < u.size:  # the full film re-forms between two centres
        whole = rise[:, fields.rear].sum()
        rise[:, fields.rear] *= (fields.fluid[fields.rear] - problem.cavity) / whole
        rise[:, fields.front + 1 : fields.rear] = 0.0
    else:
        rise[:, fields.front + 1 : fields.rear + 1] = 0.0
    drag = (flow.film / 2 * rise).ravel()
    beyond = outside_drag(problem, solution)
    # unit of stress g p/b: eta v/u = (couette/6) (g p/b) (g/u)
    unit = problem.gap / (problem.half_width * problem.load)

    def parts(sheared: float, dragged: float) -> FluidFriction:
        return FluidFriction(
            float((solution.couette / 6 * sheared + beyond[0]) * unit),
            float((dragged + beyond[1]) * unit),
        )

    n = u.size
    rough = parts((factors.phi_f + factors.phi_fs)[:n] @ shear, factors.phi_fp[n:] @ drag)
    plain = moving.relative_viscosity(u * problem.gap) @ shear
    return rough, parts(plain, drag.sum())
