"""Mixed lubrication of a point contact at one speed, on rings and sectors."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.linalg import lapack

from tribolab.contact.polar import PolarMesh
from tribolab.lubrication.factors import FlowFactors
from tribolab.lubrication.line_solver import NotConvergedError, Repulsion
from tribolab.lubrication.thinning import ShearThinning, ThinnedFactors

_STEPS = 25  # largest number of Newton steps
_MAX_CHANGE = 0.6  # largest relative change of the film in one step
_CONVERGED = 1e-8  # largest error relative to the maximum pressure, and to the load
_LEAK = 1e-10  # share of the smooth conductance that is kept below percolation
_UNTOUCHED = 1e-13  # contact stiffness below which the pressure of a cell in the cavity is fixed
FULL_LOAD = 8 / 3  # load of a Hertz contact in units of P a^2


class Faces(NamedTuple):
    """Faces between the cells of a mesh: first between rings, then between sectors."""

    gradient: sparse.csr_matrix  # difference across each face (faces, cells)
    sides: sparse.csr_matrix  # 1 for both cells of a face (faces, cells)
    mean: sparse.csr_matrix  # mean of the two cells (faces, cells)
    across: np.ndarray  # length of the face, divided by the distance between its cells (faces)
    along: np.ndarray  # length of the face projected on y, positive if its normal has n_x > 0


@functools.lru_cache(maxsize=6)
def _faces(faces: bytes, sectors: int) -> Faces:
    rho = np.frombuffer(faces)
    rings = rho.size - 1
    angle, number = np.pi / sectors, np.arange(rings * sectors).reshape(rings, sectors)
    radius, sine = (rho[1:] + rho[:-1]) / 2, np.sin(angle * np.arange(sectors + 1))
    apart = np.append(np.diff(radius), rho[-1] - radius[-1])
    first = np.concatenate([number.ravel(), number[:, :-1].ravel()])
    second = np.concatenate([number[1:].ravel(), np.full(sectors, -1), number[:, 1:].ravel()])
    across = np.concatenate([
        np.repeat(rho[1:] * angle / apart, sectors),
        np.repeat(np.diff(rho) / (radius * angle), sectors - 1),
    ])  # fmt: skip
    along = np.concatenate([
        np.outer(rho[1:], np.diff(sine)).ravel(),
        -np.outer(np.diff(rho), sine[1:-1]).ravel(),
    ])  # fmt: skip
    row, inner = np.arange(first.size), second >= 0
    shape = first.size, number.size

    def matrix(own: np.ndarray, other: float) -> sparse.csr_matrix:
        value = np.concatenate([own, np.full(inner.sum(), other)])
        at = np.concatenate([row, row[inner]]), np.concatenate([first, second[inner]])
        return sparse.csr_matrix((value, at), shape=shape)

    return Faces(
        matrix(np.full(first.size, -1.0), 1.0),
        matrix(np.ones(first.size), 1.0),
        matrix(np.where(inner, 0.5, 1.0), 0.5),
        across,
        along,
    )


class PointProblem(NamedTuple):
    """Properties of a point contact; units: a for lengths, g = a^2/2R for gaps, P for pressures."""

    mesh: PolarMesh
    factors: FlowFactors
    separation: Repulsion | None  # None for smooth surfaces, which never touch
    radius: float  # a [m]
    gap: float  # g [m]
    pressure: float  # P = E* g/a [Pa]
    load: float = FULL_LOAD  # in units of P a^2
    cavity: float = 0.0  # pressure of the cavity, in units of P
    thinning: ShearThinning | None = None
    viscosity: float = 1.0  # of a shear-thinning liquid at rest [Pa s]

    def moving(self, couette: float) -> FlowFactors | ThinnedFactors:
        """Return the flow factors at a speed; they include shear thinning."""
        if self.thinning is None:
            return self.factors
        speed = couette * self.gap**2 * self.pressure / (6 * self.viscosity * self.radius)
        return ThinnedFactors(self.factors, self.thinning, speed * abs(self.factors.slide))

    @property
    def faces(self) -> Faces:
        """Faces between the cells of the mesh."""
        return _faces(self.mesh.faces.tobytes(), self.mesh.sectors)

    def contact(self, film: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact pressure and its derivative with respect to the film thickness."""
        if self.separation is None:
            return np.zeros_like(film), np.zeros_like(film)
        pressure, slope = self.separation.pressure_and_slope(film * self.gap)
        return pressure / self.pressure, slope * self.gap / self.pressure


class PointState(NamedTuple):
    """Pressure p in the cells, and the constant c of the film u = c + r^2 + K p."""

    pressure: np.ndarray
    constant: float

    def film(self, mesh: PolarMesh) -> np.ndarray:
        """Return the film thickness in units of the gap scale g."""
        return np.asarray(self.constant + mesh.squared + mesh.kernel @ self.pressure)


class PointSolution(NamedTuple):
    """Converged solution at one speed, with its residuals."""

    couette: float
    state: PointState
    film: np.ndarray
    contact: np.ndarray  # pressure carried by the solid contact
    fluid: np.ndarray
    dry: np.ndarray  # mask of the cells in the cavity
    flux: np.ndarray  # flux through the faces
    residual: float  # largest imbalance of a cell as a pressure, relative to the maximum pressure
    load_balance: float
    flux_variation: float  # largest net outflow of a cell in the full film / largest flux
    iterations: int


class _Balance(NamedTuple):
    film: np.ndarray
    contact: np.ndarray
    yielding: np.ndarray
    fluid: np.ndarray
    flux: np.ndarray
    conductance: np.ndarray
    flux_slope: np.ndarray
    stiff: np.ndarray  # diagonal of the pressure's matrix
    dry: np.ndarray
    residual: np.ndarray


def couette_number(problem: PointProblem, viscosity: float, speed: float) -> float:
    """Return the dimensionless speed 6 eta v a/(g^2 P); v is twice the entrainment speed."""
    return 6 * viscosity * speed * problem.radius / (problem.gap**2 * problem.pressure)


def solve_point(
    problem: PointProblem, couette: float, start: PointState, first: bool = False
) -> PointSolution:
    """Return the solution of a point contact at one speed, by Newton's method.

    Parameters
    ----------
    problem
        Mesh, factors, contact law and load.
    couette
        `couette_number` of the speed.
    start
        State to start from.
    first
        Whether the start has no cavity. In the first step only cells behind the middle may then
        become cavity, so that the inlet stays full.

    Raises
    ------
    NotConvergedError
        If `_STEPS` steps are not enough.

    Notes
    -----
    J = couette (u + h phi_s) e_x - u^3 phi_p grad p_f, in finite volumes; p_f >= p_cav and div J >=
    0, complementary, by a primal-dual active set.
    """
    mesh, state, errors = problem.mesh, start, [np.inf]
    film = state.film(mesh)
    for step in range(_STEPS + 1):
        now = _balance(problem, couette, state, film, first and step == 0)
        highest = float(np.max(now.contact + now.fluid))
        lack = float(mesh.area @ state.pressure - problem.load / 2)
        error = max(float(np.max(np.abs(now.residual))) / highest, abs(2 * lack / problem.load))
        if error < _CONVERGED:
            return _solution(problem, couette, state, now, error, step)
        errors.append(error)
        if step == _STEPS or not np.isfinite(error):
            break
        change, constant = _newton_step(problem, now, lack)
        moved = mesh.kernel @ change + constant
        part = min(1.0, _MAX_CHANGE / float(np.max(np.abs(moved) / film)))
        state = PointState(state.pressure + part * change, state.constant + part * constant)
        film = film + part * moved if step % 8 else state.film(mesh)
    raise NotConvergedError(f"the residual is {errors[-1]:.1e} after {step} steps")


def _balance(
    problem: PointProblem, couette: float, state: PointState, film: np.ndarray, first: bool
) -> _Balance:
    mesh, faces = problem.mesh, problem.faces
    contact, yielding = problem.contact(film)
    fluid = state.pressure - contact
    between = faces.mean @ film
    phi, phi_slope, entrained, entrained_slope = problem.moving(couette).transport(
        between * problem.gap
    )
    phi = phi + _LEAK
    conductance = between**3 * phi * faces.across
    drive = couette * faces.along
    rise = faces.gradient @ fluid
    flux = drive * entrained / problem.gap - conductance * rise
    steep = conductance * (3 / between + phi_slope * problem.gap / phi)
    stiff = faces.sides.T @ conductance
    out = -(faces.gradient.T @ flux)
    above = fluid - (problem.cavity if couette else 0.0)
    dry = above - out / stiff <= 0
    if first:
        dry &= mesh.x > 0
    if couette == 0:
        dry[:] = True
    return _Balance(
        film, contact, yielding, fluid, flux, conductance,
        drive * entrained_slope - steep * rise, stiff, dry, np.where(dry, above, out / stiff),
    )  # fmt: skip


def _newton_step(problem: PointProblem, now: _Balance, lack: float) -> tuple[np.ndarray, float]:
    """Return the Newton step of pressures and constant; pressures in the cavity are fixed."""
    mesh, faces = problem.mesh, problem.faces
    n = now.film.size
    full = (~now.dry / now.stiff)[:, None]
    diagonal = sparse.diags_array
    out = faces.gradient.T.tocsr()
    by_fluid = (out @ diagonal(now.conductance) @ faces.gradient).multiply(full).tocsr()
    by_film = (-(out @ diagonal(now.flux_slope) @ faces.mean)).multiply(full).tocsr()
    by_fluid = by_fluid + diagonal(now.dry.astype(float))
    by_film = (by_film - by_fluid @ diagonal(now.yielding)).tocsr()
    known = now.dry & (np.abs(now.yielding) < _UNTOUCHED)
    change = np.where(known, -now.residual, 0.0)
    free = np.flatnonzero(~known)
    some = by_film[free]
    matrix = some @ (mesh.kernel if free.size == n else mesh.kernel[:, free])
    own = by_fluid[free][:, free].tocoo()
    matrix[own.row, own.col] += own.data
    given = by_fluid[free] @ change + some @ (mesh.kernel @ change)
    lacking = -now.residual[free] - given
    level = np.asarray(some.sum(axis=1)).ravel()
    right = np.asfortranarray(np.stack([lacking, level], axis=1))
    factor, pivots, singular = lapack.dgetrf(matrix.T, overwrite_a=True)
    if singular:
        raise NotConvergedError("the linearised equations are singular")
    both, _ = lapack.dgetrs(factor, pivots, right, trans=1, overwrite_b=True)
    weight = mesh.area[free]
    constant = (lack + mesh.area @ change + weight @ both[:, 0]) / (weight @ both[:, 1])
    change[free] = both[:, 0] - constant * both[:, 1]
    if not np.all(np.isfinite(change)):
        raise NotConvergedError("the linearised equations are singular")
    return change, float(constant)


def _solution(
    problem: PointProblem,
    couette: float,
    state: PointState,
    now: _Balance,
    error: float,
    step: int,
) -> PointSolution:
    lowest = problem.cavity if couette else 0.0
    out = -(problem.faces.gradient.T @ now.flux)
    size = max(float(np.abs(now.flux).max()), np.finfo(float).tiny)
    wet = out[~now.dry]
    return PointSolution(
        couette, state, now.film, now.contact, np.where(now.dry, lowest, now.fluid),
        now.dry, now.flux, error, float(2 * problem.mesh.area @ state.pressure / problem.load - 1),
        float(np.abs(wet).max() / size) if wet.size else 0.0, step,
    )  # fmt: skip
