"""Fluid friction in the solved film of a point contact."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

from tribolab.lubrication.friction import FluidFriction
from tribolab.lubrication.point.ball_solver import PointProblem, PointSolution


def point_friction(
    problem: PointProblem, solution: PointSolution
) -> tuple[FluidFriction, FluidFriction]:
    """Return the fluid friction with friction factors, and with phi_f = phi_fp = 1, phi_fs = 0.

    Notes
    -----
    The drag is ``sum (phi_f + phi_fs) s eta v/u dA + sum_faces phi_fp (u/2)(p_R - p_L) int n_x``, s
    being the share of the flat covered by streamers in the cavity (`streamer_share`). Only the
    liquid inside the mesh is included: the drag of an unbounded liquid diverges as ln r.
    """
    if solution.couette == 0:
        return FluidFriction(0.0, 0.0), FluidFriction(0.0, 0.0)
    mesh, faces, film = problem.mesh, problem.faces, solution.film
    between = faces.mean @ film
    shear = streamer_share(problem, solution) * mesh.area / film
    drag = between / 2 * (faces.gradient @ solution.fluid) * faces.along
    moving = problem.moving(solution.couette)
    cell, face = (moving.at(u * problem.gap) for u in (film, between))
    unit = (
        2 * problem.gap / (problem.radius * problem.load)
    )  # factor 2: the mesh covers half the plane

    def parts(sheared: float, dragged: float) -> FluidFriction:
        return FluidFriction(float(solution.couette / 6 * sheared * unit), float(dragged * unit))

    rough = parts((cell.phi_f + cell.phi_fs) @ shear, face.phi_fp @ drag)
    return rough, parts(moving.relative_viscosity(film * problem.gap) @ shear, drag.sum())


def streamer_share(problem: PointProblem, solution: PointSolution) -> np.ndarray:
    """Return the share of each cell that liquid covers: 1 in the full film, less in the cavity.

    In the cavity the liquid is advected, div(s (v/2)(u + h phi_s)) = 0, solved upwind from the
    rupture of the film.
    """
    faces, dry = problem.faces, solution.dry
    cavity = np.flatnonzero(dry)
    share = np.ones(dry.size)
    if not cavity.size:
        return share
    between = faces.mean @ solution.film
    moved = faces.along * problem.factors.transport(between * problem.gap)[2]
    moved *= solution.couette / problem.gap
    # cell upstream of each face: the first one if the flow is towards the second
    first, second = (sparse.csr_matrix((faces.gradient * sign).maximum(0)) for sign in (-1, 1))
    upstream = sparse.diags_array((moved > 0).astype(float)) @ first
    upstream = upstream + sparse.diags_array((moved <= 0).astype(float)) @ second
    out = -faces.gradient.T.tocsr()
    wet = upstream @ (~dry).astype(float) > 0
    inner = out @ sparse.diags_array(np.where(wet, 0.0, moved)) @ upstream
    gain = -(out @ np.where(wet, solution.flux, 0.0))[cavity]
    share[cavity] = np.clip(spsolve(inner.tocsc()[cavity][:, cavity], gain), 0.0, 1.0)
    return share
