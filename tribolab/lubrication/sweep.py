"""Start of the solution of a line contact, and continuation to higher speeds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import hertz_pressure
from tribolab.contact.line import solve_line
from tribolab.contact.separation import Separation
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.domain import thinned_film
from tribolab.lubrication.line_solver import (
    NotConvergedError,
    Problem,
    Solution,
    State,
    couette_number,
    solve_speed,
)
from tribolab.lubrication.mesh import Mesh
from tribolab.lubrication.parameters import Liquid

_SUBSTEPS = 100  # largest number of failed steps
_FINEST = 1e-2  # smallest step in ln v
_THICK = 5.0  # ratio of film thickness to h_rms, from which a film is thick
_GROWTH = np.log(4.0)  # largest change of ln(film) in an extrapolation to the next speed
_START_POINTS = 101  # points of the dry contact that is the start
_DECADES = 12  # decades searched below the first speed for one that can be solved from rest


def dry_state(problem: Problem, contact: LineContact, separation: Separation, load: float) -> State:
    """Return the solved contact at rest, on the mesh of the problem.

    Raises
    ------
    AnalysisError
        If the roughness is pressed flat.
    NotConvergedError
        If Newton's method fails.
    """
    dry = solve_line(load, contact, separation, _START_POINTS)
    x = problem.mesh.x * problem.half_width
    pressure = np.interp(x, dry.x, dry.pressure, left=0.0, right=0.0)
    shape = _gap_shape(problem, pressure / problem.pressure)
    known = np.interp(x, dry.x, dry.separation) / problem.gap
    middle = int(np.argmax(pressure))
    constant = float(known[middle] - shape[middle])
    inside = np.abs(x) <= dry.x[-1]
    film = np.where(inside, known, np.maximum(shape + constant, known))
    return solve_speed(problem, 0.0, _bent_state(problem, film, constant)).state


def carried_state(problem: Problem, before: Problem, state: State) -> State:
    """Return a state interpolated to another mesh of the same contact."""
    mesh, old = problem.mesh, before.mesh
    pressure = np.interp(mesh.x, old.x, state.pressure, left=0.0, right=0.0)
    pressure *= problem.load / (mesh.weight @ pressure)
    shape = _gap_shape(problem, pressure)
    thinnest = int(np.argmin(state.film))
    constant = float(state.film[thinnest] - np.interp(old.x[thinnest], mesh.x, shape))
    return State(np.maximum(shape + constant, state.film[thinnest] / 2), constant, pressure)


def is_thick(
    problem: Problem, contact: LineContact, liquid: Liquid, load: float, speed: float
) -> bool:
    """Return whether the film at a speed is much thicker than the roughness."""
    film = thinned_film(contact, liquid, load, speed)
    return film >= _THICK * problem.factors.rms_roughness


def lifted_state(
    problem: Problem, contact: LineContact, liquid: Liquid, load: float, speed: float
) -> State:
    """Return the state at one speed, reached from a higher one at which the film is thick.

    Raises
    ------
    NotConvergedError
        If no solution is found.
    """
    above = speed
    while not is_thick(problem, contact, liquid, load, above):
        above *= 2
    start = wet_state(problem, contact, liquid, load, above)
    down = np.geomspace(above, speed, 1 + int(np.ceil(4 * np.log10(above / speed))))
    solved, lost = _march(problem, liquid.viscosity, list(down), start)
    if lost is not None:
        raise lost
    return solved[-1].state


def wet_state(
    problem: Problem, contact: LineContact, liquid: Liquid, load: float, speed: float
) -> State:
    """Return the state of a contact that liquid separates, found with an auxiliary repulsion.

    The repulsion ends at a third of the expected film. It acts like asperity contact until the
    fluid carries the load, so that increasing speed separates the bodies. If this fails because
    the film is thin compared with the cells, the solution starts from a higher speed.

    Raises
    ------
    NotConvergedError
        If no solution is found.
    """
    try:
        return _solve_cushioned(problem, contact, liquid, load, speed)
    except NotConvergedError:
        start = _solve_cushioned(problem, contact, liquid, load, 10 * speed)
        solved, lost = _march(problem, liquid.viscosity, [3 * speed, speed], start)
        if lost is not None:
            raise
        return solved[-1].state


def _solve_cushioned(
    problem: Problem, contact: LineContact, liquid: Liquid, load: float, speed: float
) -> State:
    """Return the state solved with the auxiliary repulsion, first at rest and then at the speed."""
    film = thinned_film(contact, liquid, load, speed)
    x = problem.mesh.x * problem.half_width
    pressure = hertz_pressure(x, load, contact) / problem.pressure
    shape = _gap_shape(problem, pressure * problem.load / (problem.mesh.weight @ pressure))
    constant = film / 3 / problem.gap - float(shape.min())
    cushion = problem._replace(separation=_Cushion(float(pressure.max()) * problem.pressure, film))
    rest = solve_speed(cushion, 0.0, _bent_state(problem, shape + constant, constant)).state
    solved, lost = _march(cushion, liquid.viscosity, [speed], rest)
    if lost is not None:
        raise lost
    return solved[-1].state


class _Cushion(NamedTuple):
    """Auxiliary repulsion p = p_max exp(10 - 30 u/film), which separates smooth surfaces."""

    highest: float  # maximum pressure p_max [Pa]
    film: float  # film thickness [m]

    def pressure_and_slope(self, separation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the repulsive pressure [Pa] and its slope [Pa/m] at separations [m]."""
        pressure = self.highest * np.exp(10 - 30 * separation / self.film)
        return pressure, -30 / self.film * pressure


def sweep(
    problem: Problem,
    viscosity: float,
    speeds: Iterable[float],
    start: State | None,
    lifted: Callable[[], State] | None = None,
) -> list[Solution]:
    """Return the solutions at increasing speeds, each started from the previous ones.

    Parameters
    ----------
    problem
        Problem of the contact.
    viscosity
        [Pa s].
    speeds
        [m/s], increasing, above zero.
    start
        Starting state: the dry contact, or the state at the first speed; None: use `lifted`.
    lifted
        Function that returns a state at the last speed. If closed flow channels make increasing
        speed lift the contact suddenly, the other speeds are solved from the last one downwards.

    Raises
    ------
    AnalysisError
        If a speed cannot be reached; the message says what to change.

    Notes
    -----
    ln u is extrapolated in ln v by the parabola through the last three speeds, or the secant
    through two. If Newton's method fails, the step in ln v is halved.
    """
    speeds = list(speeds)
    solved, lost = _march(problem, viscosity, speeds, start) if start else ([], None)
    if len(solved) < len(speeds) and lifted is not None:
        rest = speeds[len(solved) :][::-1]
        try:
            above, lost = _march(problem, viscosity, rest, lifted())
        except NotConvergedError as error:
            raise _lost(problem, viscosity, rest[0], lost or error) from error
        solved = solved + above[::-1] if lost is None else solved
    if lost is not None:
        raise _lost(problem, viscosity, speeds[len(solved)], lost) from lost
    return solved


def sweep_from_similar(
    problem: Problem, viscosity: float, speeds: list[float], near: Sequence[State]
) -> list[Solution] | None:
    """Return solutions started from those of a similar contact; None if this fails.

    Parameters
    ----------
    problem, viscosity, speeds
        As for `sweep`.
    near
        States of a similar contact at these speeds, on the same mesh.

    Notes
    -----
    The difference ln u - ln u_near is extrapolated in ln v, as ln u in `sweep`. It is small and
    smooth, which saves one or two Newton steps at every speed.
    """
    solved: list[Solution] = []
    for speed, state in zip(speeds, near, strict=True):
        last = slice(max(len(solved) - 3, 0), len(solved))
        pairs = [(a.state, b) for a, b in zip(solved[last], near[last], strict=True)]
        weights = _extrapolation(list(np.log(speeds[last])), np.log(speed)) if pairs else []
        start = _shift_state(problem.mesh, state, pairs[len(pairs) - len(weights) :], weights)
        try:
            solved.append(solve_speed(problem, couette_number(problem, viscosity, speed), start))
        except NotConvergedError:  # the caller then solves the contact without the similar one
            return None
    return solved


def _march(
    problem: Problem, viscosity: float, speeds: list[float], start: State
) -> tuple[list[Solution], NotConvergedError | None]:
    """Return solutions at one speed after another, and the error if one cannot be solved."""
    solved: list[Solution] = []
    known: list[tuple[float, State]] = []  # ln v and state of the last three solutions
    budget = _SUBSTEPS
    for speed in speeds:
        aims = [np.log(speed)]
        while aims:
            aim = aims[-1]
            number = couette_number(problem, viscosity, float(np.exp(aim)))
            try:
                solution = solve_speed(problem, number, _predicted(problem.mesh, known, start, aim))
            except NotConvergedError as error:
                budget -= 1
                closer = (aim + known[-1][0]) / 2 if known else aim - np.log(10)
                gain = abs(aim - known[-1][0]) > _FINEST if known else len(aims) < _DECADES
                if budget < 0 or not gain:
                    return solved, error
                aims.append(closer)
                continue
            known = [*known[-2:], (aim, solution.state)]
            aims.pop()
        solved.append(solution)
    return solved, None


def _bent_state(problem: Problem, film: np.ndarray, constant: float) -> State:
    mesh = problem.mesh
    return State(film, constant, mesh.elastic[:, :-1] @ (film - constant - mesh.x**2))


def _predicted(mesh: Mesh, known: list[tuple[float, State]], start: State, aim: float) -> State:
    if not known:
        return start
    last = known[-1][1]
    weights = _extrapolation([at for at, _ in known], aim)
    used = [(state, last) for _, state in known[len(known) - len(weights) :]]
    return _shift_state(mesh, last, used, weights)


def _shift_state(
    mesh: Mesh, state: State, pairs: Sequence[tuple[State, State]], weights: Sequence[float]
) -> State:
    """Return a state shifted by weighted differences between pairs of other states."""
    if not pairs:
        return state
    weighted = list(zip(weights, pairs, strict=True))
    log_growth = sum(w * np.log(to.film / by.film) for w, (to, by) in weighted)
    constant = sum(w * (to.constant - by.constant) for w, (to, by) in weighted)
    growth = np.exp(np.clip(log_growth, -_GROWTH, _GROWTH))
    return state.moved(mesh, state.film * (growth - 1), constant)


def _extrapolation(at: list[float], aim: float) -> list[float]:
    """Return the weights that extrapolate the last solutions to ln v = `aim`."""
    if len(at) < 2 or at[-1] == at[-2]:
        return [1.0]
    step, ahead = at[-1] - at[-2], aim - at[-1]
    if len(at) > 2 and ahead / step < 1.5 and 1 / 3 < (at[-2] - at[-3]) / step < 3:
        a, b, c = at[-3:]
        return [
            (aim - b) * (aim - c) / ((a - b) * (a - c)),
            (aim - a) * (aim - c) / ((b - a) * (b - c)),
            (aim - a) * (aim - b) / ((c - a) * (c - b)),
        ]
    part = min(ahead / step, 3.0)
    return [-part, 1 + part]


def _gap_shape(problem: Problem, pressure: np.ndarray) -> np.ndarray:
    mesh = problem.mesh
    return mesh.x**2 + mesh.kernel @ pressure


def _lost(problem: Problem, viscosity: float, speed: float, error: Exception) -> AnalysisError:
    radius = problem.half_width**2 / (2 * problem.gap)
    load = problem.load * problem.pressure * problem.half_width
    rigid = 2.45 * viscosity * speed * radius / load
    if rigid > radius / 10:
        cure = f"its film of about {rigid:.2g} m is not thin compared with the radius: leave it out"
    else:
        cure = "take more cells, add neighbouring speeds, or leave it out"
    cells = problem.mesh.x.size
    return AnalysisError(f"no solution at {speed:.4g} m/s on {cells} cells ({error}); {cure}")
