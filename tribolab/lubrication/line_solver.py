"""Mixed lubrication of a line contact at one speed: film thickness, contact and fluid pressure."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from scipy.linalg import lapack

from tribolab.lubrication.factors import FlowFactors
from tribolab.lubrication.flow import Flow, flow_between, flux_slopes
from tribolab.lubrication.mesh import Mesh
from tribolab.lubrication.thinning import ShearThinning, ThinnedFactors

_STEPS = 30  # largest number of Newton steps
_MAX_CHANGE = 0.6  # largest relative change of the film in one step
_CONVERGED = 1e-9  # largest error relative to the maximum pressure, and to the load
_REUSE = 1e-5  # residual below which the last step's matrix is used again
_ROUNDING = 1e-8  # residual accepted if a further step no longer improves it


class Repulsion(Protocol):
    """Type of a contact pressure against separation: that of a rough contact, or a substitute."""

    def pressure_and_slope(self, separation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact pressure [Pa] and its slope [Pa/m] at separations [m]."""


class Problem(NamedTuple):
    """Scales and properties independent of speed; units: b along x, g for gaps, p for pressures."""

    mesh: Mesh
    factors: FlowFactors
    separation: Repulsion | None  # None for smooth surfaces, which never touch
    load: float  # F_N/L in units of p b
    half_width: float  # b [m]
    gap: float  # g = b^2/(2R) [m]
    pressure: float  # p = E* g/b [Pa]
    inlet_length: float = np.inf  # distance from the start of the liquid to the middle
    cavity: float = 0.0  # pressure of the cavity; negative if the outlet is flooded
    thinning: ShearThinning | None = None
    viscosity: float = 1.0  # of a shear-thinning liquid at rest [Pa s]

    def moving(self, couette: float) -> FlowFactors | ThinnedFactors:
        """Return the flow factors at a speed; they include shear thinning."""
        if self.thinning is None:
            return self.factors
        speed = couette * self.gap**2 * self.pressure / (6 * self.viscosity * self.half_width)
        return ThinnedFactors(self.factors, self.thinning, speed * abs(self.factors.slide))


class State(NamedTuple):
    """Film u, constant c of Eq. (9) and pressure p = K^-1 (u - c - x^2), in the problem's units.

    The pressure is updated with the changes of the film: computed from a film much thicker than the
    elastic displacement, it would be a difference of large numbers.
    """

    film: np.ndarray
    constant: float
    pressure: np.ndarray

    def moved(self, mesh: Mesh, film: np.ndarray, constant: float) -> State:
        """Return the state after changes of the film and the constant."""
        bent = mesh.elastic @ np.append(film, constant)
        return State(self.film + film, self.constant + constant, self.pressure + bent)


class Fields(NamedTuple):
    """Pressures, flux and cavity that follow from a state, in the problem's units."""

    contact: np.ndarray  # pressure carried by the solid (n)
    fluid: np.ndarray  # pressure of the fluid (n)
    flux: np.ndarray  # flux between the cells (n + 1)
    front: int  # first cell of the cavity
    rear: int  # first cell behind the cavity


class Solution(NamedTuple):
    """Converged solution at one speed, with its residuals."""

    couette: float
    state: State
    fields: Fields
    flow: Flow
    residual: float  # largest error of p = p_contact + p_fluid, in units of the maximum pressure
    load_balance: float
    flux_variation: float  # in the full film, divided by the larger of flux and entrainment
    iterations: int


class NotConvergedError(Exception):
    """Raised if Newton's method does not converge; the speed sweep then takes a smaller step."""


class _Film(NamedTuple):
    """Terms and residuals of the equations for one state."""

    fields: Fields
    flow: Flow
    total: np.ndarray  # total pressure, from elasticity (n)
    yielding: np.ndarray  # d(contact pressure)/d(film) (n)
    flux_slope: np.ndarray  # derivatives by the films of the four surrounding cells (4, n + 1)
    scale: np.ndarray  # converts a flux imbalance of a cell to a pressure (n)
    residual: np.ndarray  # (n)
    error: float
    lacking: float  # relative error of the load


def couette_number(problem: Problem, viscosity: float, speed: float) -> float:
    """Return 6 eta v b/(g^2 p), the ratio of Couette to Poiseuille flux and dimensionless speed."""
    return 6 * viscosity * speed * problem.half_width / (problem.gap**2 * problem.pressure)


def solve_speed(problem: Problem, couette: float, start: State) -> Solution:
    """Return film, pressures and flux of a line contact at one speed, by Newton's method.

    Parameters
    ----------
    problem
        Mesh, factors, contact law and load.
    couette
        `couette_number` of the speed; 0 is the dry contact.
    start
        State to start from.

    Raises
    ------
    NotConvergedError
        If `_STEPS` steps are not enough, or the matrix is singular.

    Notes
    -----
    Eqs. (3), (5), (9) and (10) of Xu et al. (2026), with cavitation. Unknowns are the film u in the
    cells and the constant c of Eq. (9); the pressure is ``p = K^-1 (u - c - x^2)``, that of the
    fluid p - p_cont(u). In each cell div J = 0 up to the rupture of the film, and p_fluid = 0
    behind it. If the film thickens towards the outlet, this is also the solution of
    ``p_fluid >= 0``, ``div J >= 0``, ``p_fluid div J = 0``. The point of rupture follows exactly
    from each film (`_rupture`), so that it can move over many cells in one step.
    """
    state, before, solver = start, np.inf, None
    for step in range(_STEPS + 1):
        film = _film(problem, couette, state)
        error = max(film.error, film.lacking)
        if error < _CONVERGED or (error < _ROUNDING and error > before / 2):
            return _checked_solution(problem, couette, state, film, step)
        if step == _STEPS or not np.isfinite(error):
            break
        if solver is None or error > min(_REUSE, before / 10):
            solver = _factored(problem, film)
        before = error
        # pass the transpose to LAPACK, which reads it without a copy
        change, _ = lapack.dgetrs(*solver, _deficit(problem, film), trans=1, overwrite_b=True)
        if not np.all(np.isfinite(change)):
            raise NotConvergedError("the linearised equations are singular")
        largest = np.max(np.abs(change[:-1]) / state.film)
        part = min(1.0, _MAX_CHANGE / largest)
        state = state.moved(problem.mesh, part * change[:-1], part * change[-1])
    raise NotConvergedError(f"the residual is {error:.1e} after {step} steps")


def _film(problem: Problem, couette: float, state: State) -> _Film:
    mesh, u = problem.mesh, state.film
    contact, yielding = _contact(problem, u)
    total = state.pressure
    fluid = total - contact
    # flux between cells = entrainment - conductance x pressure rise; p = 0 outside the domain
    flow = flow_between(mesh.between, problem.moving(couette), problem.gap, couette, u)
    conductance, entrained = flow.conductance, flow.drive
    rise = np.empty_like(conductance)
    rise[0], rise[-1] = fluid[0], -fluid[-1]
    np.subtract(fluid[1:], fluid[:-1], out=rise[1:-1])
    flux = entrained - conductance * rise
    scale = 1 / (conductance[1:] + conductance[:-1])
    front, rear, through = 0, u.size, 0.0
    if couette > 0:
        find = _rupture if problem.cavity == 0 else _cavity
        front, rear, through = find(entrained, conductance, problem.cavity)
    lowest = problem.cavity if couette > 0 else 0.0
    residual = scale * (flux[1:] - flux[:-1])
    residual[front:rear] = fluid[front:rear] - lowest
    # fluid pressure recomputed from the flux: exact to rounding even at small pressures
    exact = np.full_like(u, lowest)
    exact[:front] = np.cumsum((entrained[:front] - through) / conductance[:front])
    passing = np.full_like(entrained, through)
    passing[front + 1 : rear + 1] = entrained[front + 1 : rear + 1]
    if rear < u.size:  # behind the cavity the flux is the same as in front of it
        behind = (entrained[rear + 1 :] - through) / conductance[rear + 1 :]
        exact[rear:] = -np.cumsum(behind[::-1])[::-1]
        if front < rear:
            residual[rear] = scale[rear] * (flux[rear + 1] - flux[front])
            passing[rear] = through
    return _Film(
        fields=Fields(contact, exact, passing, front, rear),
        flow=flow,
        total=total,
        yielding=yielding,
        flux_slope=flux_slopes(mesh.between, flow, flux),
        scale=scale,
        residual=residual,
        error=float(np.max(np.abs(fluid - exact)) / total.max()),
        lacking=abs(float(mesh.weight @ total / problem.load - 1)),
    )


def _factored(problem: Problem, film: _Film) -> tuple[np.ndarray, np.ndarray]:
    """Return the LU factors of the transposed Jacobian, and the pivots."""
    factor, pivots, singular = lapack.dgetrf(_jacobian(problem, film).T, overwrite_a=True)
    if singular:
        raise NotConvergedError("the linearised equations are singular")
    return factor, pivots


def _deficit(problem: Problem, film: _Film) -> np.ndarray:
    """Return the negative residuals of the cells, followed by that of the load balance."""
    lack = problem.mesh.weight @ film.total - problem.load
    return -np.append(film.residual, film.total.max() / problem.load * lack)


def _jacobian(problem: Problem, film: _Film) -> np.ndarray:
    """Return the derivatives of residuals and load with respect to each cell's film and c."""
    mesh, n = problem.mesh, film.residual.size
    front, rear = film.fields.front, film.fields.rear
    full = film.scale.copy()
    full[front:rear] = 0.0
    before, after = -full * film.flow.conductance[:-1], -full * film.flow.conductance[1:]
    elastic = mesh.elastic
    matrix = np.empty((n + 1, n + 1))
    matrix[:n] = elastic
    for start, stop in ((0, front), (rear, n)):  # full film, except its end cells
        first, last = max(start, 1), min(stop, n - 1)
        if first < stop:
            matrix[first:stop] += before[first:stop, None] * elastic[first - 1 : stop - 1]
        if start < last:
            matrix[start:last] += after[start:last, None] * elastic[start + 1 : last + 1]
    left, right = full * film.flux_slope[:, :-1], full * film.flux_slope[:, 1:]
    bands = {-2: -left[0], 2: right[3]}
    bands |= {k: right[k + 1] - left[k + 2] for k in (-1, 0, 1)}
    bands[0] -= film.yielding
    bands[-1][1:] -= before[1:] * film.yielding[:-1]
    bands[1][:-1] -= after[:-1] * film.yielding[1:]
    flat = matrix.ravel()
    for k, band in bands.items():  # diagonal k: row i, column i + k
        first, last = max(-k, 0), n - max(k, 0)
        flat[first * (n + 1) + first + k :: n + 2][: last - first] += band[first:last]
    if front < rear < n:
        matrix[rear] = film.scale[rear] * (
            _flux_row(problem, film, rear + 1) - _flux_row(problem, film, front)
        )
    matrix[n] = film.total.max() / problem.load * mesh.push
    return matrix


def _flux_row(problem: Problem, film: _Film, face: int) -> np.ndarray:
    """Return the derivatives of the flux at a face with respect to all films and c (n + 1)."""
    mesh, n = problem.mesh, film.residual.size
    row = np.zeros(n + 1)
    for cell, sign in ((face, -1), (face - 1, 1)):
        if 0 <= cell < n:
            row += sign * film.flow.conductance[face] * mesh.elastic[cell]
            row[cell] -= sign * film.flow.conductance[face] * film.yielding[cell]
    np.add.at(row, mesh.between.cell[:, face], film.flux_slope[:, face])
    return row


def _rupture(
    entrained: np.ndarray, conductance: np.ndarray, lowest: float
) -> tuple[int, int, float]:
    """Return the cavity's first cell, the first cell behind it, and the flux, if vented.

    With full cells 0 ... k - 1 and p = 0 at both ends, the flux J_k is the mean entrained flux,
    weighted with the resistance of the faces 0 ... k. The film ruptures at the first k beyond which
    entrainment always exceeds J_k: there div J >= 0, and p >= 0 before it.
    """
    resistance = 1 / conductance
    flux = np.cumsum(entrained * resistance) / np.cumsum(resistance)
    behind = np.flatnonzero(flux[:-1] > entrained[1:])
    front = int(behind[-1]) + 1 if behind.size else 0
    return front, entrained.size - 1, float(flux[front])


def _cavity(
    entrained: np.ndarray, conductance: np.ndarray, lowest: float
) -> tuple[int, int, float]:
    """Return the cavity's first cell, the first cell behind it, and the flux, if flooded.

    Without a cavity the flux is the mean over all faces. If the pressure would fall below
    `lowest`, the film ruptures as in `_rupture`, but at that pressure. It re-forms in the first
    cell where the pressure, integrated from the outlet at the same flux, reaches `lowest`.
    """
    n, resistance = entrained.size - 1, 1 / conductance
    driven, resisted = np.cumsum(entrained * resistance), np.cumsum(resistance)
    through = driven[-1] / resisted[-1]
    if np.min(driven[:-1] - through * resisted[:-1]) >= lowest:
        return n, n, float(through)
    flux = (driven - lowest) / resisted
    behind = np.flatnonzero(flux[:-1] > entrained[1:])
    front = int(behind[-1]) + 1 if behind.size else 0
    if front >= n:
        return n, n, float(through)
    through = flux[front]
    after = -((driven[-1] - driven[:-1]) - through * (resisted[-1] - resisted[:-1]))
    again = np.flatnonzero(after[front:] >= lowest)
    return front, front + int(again[0]) if again.size else n, float(through)


def _contact(problem: Problem, film: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the contact pressure and its derivative with respect to the film thickness."""
    if problem.separation is None:
        return np.zeros_like(film), np.zeros_like(film)
    pressure, slope = problem.separation.pressure_and_slope(film * problem.gap)
    return pressure / problem.pressure, slope * problem.gap / problem.pressure


def _checked_solution(
    problem: Problem, couette: float, state: State, film: _Film, step: int
) -> Solution:
    """Return the solution; an error if the fluid bears tension or the film re-forms."""
    fields = film.fields
    carried = fields.contact + fields.fluid
    highest = carried.max()
    if np.any(fields.fluid < problem.cavity - _ROUNDING * highest):
        raise NotConvergedError("the film ruptures in more than one place")
    drive = fields.flux[1:] - fields.flux[:-1]
    last = fields.rear - (fields.rear < drive.size)  # the flux falls where the full film re-forms
    if couette > 0 and np.any(drive[fields.front : last] < -_ROUNDING * fields.flux.max()):
        raise NotConvergedError("the film forms again behind the cavity")
    return Solution(
        couette=couette,
        state=state,
        fields=fields,
        flow=film.flow,
        residual=float(np.max(np.abs(film.total - carried)) / highest),
        load_balance=float(problem.mesh.weight @ carried / problem.load - 1),
        flux_variation=_flux_variation(fields, film.flow),
        iterations=step,
    )


def _flux_variation(fields: Fields, flow: Flow) -> float:
    """Return the largest relative error of the flux in the full film, from film and pressure."""
    if fields.front < 2:
        return 0.0
    flux = (flow.drive[1:-1] - flow.conductance[1:-1] * np.diff(fields.fluid))[: fields.front]
    size = np.maximum(np.abs(fields.flux[0]), flow.drive[1:-1][: fields.front])
    return float(np.max(np.abs(flux - fields.flux[0]) / size))
