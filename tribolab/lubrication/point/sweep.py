"""Solution of a lubricated point contact at given speeds, from rest or from thick films."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.contact.geometry import PointContact
from tribolab.contact.hertz import hertz_half_width
from tribolab.contact.point import solve_rings
from tribolab.contact.polar import polar_mesh
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.line_solver import NotConvergedError
from tribolab.lubrication.parameters import Liquid
from tribolab.lubrication.point.ball_solver import (
    PointProblem,
    PointSolution,
    PointState,
    couette_number,
    solve_point,
)
from tribolab.lubrication.speeds import System

_SHARE = 0.375  # rings per cell of a line contact: 60 for 160
_SECTORS = 24
_FAR_END, _EXTRA_RINGS = 4.0, 0.25  # extent above which rings are added, and their share per decade
_CLASS_RATIO = 10.0  # films whose thicknesses differ by less than this factor share a mesh
_THICK = 5.0  # ratio of film thickness to h_rms above which the solution starts from a thick film
_LIFTED = 0.5  # thickness of that thick film, divided by the gap a^2/2R
_GENTLE = 0.1  # ratio of fluid to contact pressure in the first step from rest
_SUBSTEPS = 60  # largest number of failed steps
_FINEST = 1e-2  # smallest step in ln v
SHORTEST = 1.5  # least radius of the liquid, in contact radii


class SolvedPoint(NamedTuple):
    """Solution at one speed [m/s], with its problem and mesh."""

    speed: float
    problem: PointProblem
    solution: PointSolution


def ball_film(contact: PointContact, viscosity: float, load: float, speed: float) -> float:
    """Return the central film thickness [m] of a smooth ball: the larger of soft and rigid limit.

    Notes
    -----
    ``3.03 R U^0.59 W^-0.121`` and ``142 R (eta u R/F)^2`` with U = eta u/(E' R), W = F/(E' R^2),
    u = v/2 and E' = 2 E*.
    """
    radius, stiff = contact.radius, 2 * contact.effective_modulus
    entrained = viscosity * speed / 2
    reduced = entrained / (stiff * radius), load / (stiff * radius**2)
    soft = 3.03 * reduced[0] ** 0.590 * reduced[1] ** -0.121
    return radius * max(soft, 142 * (entrained * radius / load) ** 2)


def expected_film(contact: PointContact, liquid: Liquid, load: float, speed: float) -> float:
    """Return the central film thickness [m] of a smooth ball, with shear thinning in the film."""
    film = ball_film(contact, liquid.viscosity, load, speed)
    if liquid.thinning is None or not speed:
        return film
    for _ in range(30):
        thin = float(liquid.thinning.pressure_flow(np.array(speed / film)))
        film = ball_film(contact, liquid.viscosity * thin, load, speed)
    return film


def point_problem(system: System, force: float, speed: float) -> PointProblem:
    """Return scales and mesh for a load [N] and a speed [m/s], which may be 0.

    Raises
    ------
    AnalysisError
        If the liquid ends too close to the contact.
    """
    contact, liquid = _ball(system), system.liquid
    a = float(hertz_half_width(force, contact))
    gap = a**2 / (2 * contact.radius)
    extent = contact.radius if liquid.extent is None else liquid.extent
    if not extent > SHORTEST * a:
        raise AnalysisError(
            f"inlet_length: the liquid must reach more than {SHORTEST:g} radii of the contact from "
            f"its middle, {SHORTEST * a:.3g} m here; got {extent:.3g} m"
        )
    film = expected_film(contact, liquid, force, speed) / gap if speed else 0.0
    lowest = _CLASS_RATIO ** np.floor(np.log10(max(film, 1e-30)) / np.log10(_CLASS_RATIO))
    decay = system.separation.decay_length / gap if system.separation else 0.0
    edge = float(f"{np.clip((max(decay, lowest) / 1.9) ** (2 / 3), 1e-3, 0.5):.2g}")
    size = float(np.sqrt(max(lowest, 1.0)))
    wide = max(np.log10(extent / (a * size) / _FAR_END), 0.0)
    rings = round(_SHARE * system.solver.cells * (1 + _EXTRA_RINGS * wide))
    mesh = polar_mesh(rings, _SECTORS, edge, extent / a, size, contact.layer(a))
    pressure = contact.effective_modulus * gap / a
    return PointProblem(
        mesh, system.factors, system.separation, a, gap, pressure, force / (pressure * a**2),
        liquid.lowest_pressure / pressure, liquid.thinning, liquid.viscosity,
    )  # fmt: skip


def solve_points(system: System, force: float, speeds: np.ndarray) -> list[SolvedPoint]:
    """Return the solutions of a point contact at increasing speeds [m/s].

    Raises
    ------
    AnalysisError
        If a speed cannot be solved.
    """
    moving = [float(v) for v in speeds if v > 0]
    rest: list[SolvedPoint] = []
    solved: list[SolvedPoint] = []
    lost: NotConvergedError | None = None
    contact, table = _ball(system), system.separation
    thick = _THICK * system.factors.rms_roughness
    is_lifted = table is None or (
        bool(moving) and expected_film(contact, system.liquid, force, moving[0]) > thick
    )
    if table is not None and (moving[:1] != list(speeds[:1]) or not is_lifted):
        problem, state = _dry_start(system, force)
        try:
            dry = solve_point(problem, 0.0, state)
        except NotConvergedError as error:
            raise AnalysisError(f"the contact at rest: {error}") from error
        if moving[:1] != list(speeds[:1]):
            rest = [SolvedPoint(0.0, problem, dry)]
        if moving and not is_lifted and float(dry.film.min()) * problem.gap > _closing_gap(system):
            first = SolvedPoint(min(_gentle_speed(problem, dry, system), moving[0]), problem, dry)
            solved, lost = _march(system, force, moving, first)
    left = moving[len(solved) :]
    if left:
        above, lost_above = _solve_thick(system, force, left)
        if lost_above is not None:
            raise _lost(left[0], lost or lost_above)
        solved += above
    return rest + solved


def _solve_thick(
    system: System, force: float, speeds: list[float]
) -> tuple[list[SolvedPoint], NotConvergedError | None]:
    """Return solutions at speeds, started from a thick film, and the error if one fails."""
    contact = _ball(system)
    a = float(hertz_half_width(force, contact))
    wanted = max(_LIFTED * a**2 / (2 * contact.radius), _THICK * system.factors.rms_roughness)
    lift = speeds[0]
    for _ in range(60):  # h ~ v^0.6, so a few steps suffice
        lift *= (wanted / expected_film(contact, system.liquid, force, lift)) ** 1.2
    problem = point_problem(system, force, lift)
    pressure = np.exp(-problem.mesh.squared)
    pressure *= problem.load / 2 / (problem.mesh.area @ pressure)
    film = problem.mesh.squared + problem.mesh.kernel @ pressure
    state = PointState(pressure, wanted / problem.gap - float(film.min()))
    number = couette_number(problem, system.viscosity, lift)
    try:
        start = SolvedPoint(lift, problem, solve_point(problem, number, state, first=True))
    except NotConvergedError as error:
        return [], error
    up, lost = _march(system, force, [v for v in speeds if v >= lift], start)
    if lost is None:
        down, lost = _march(system, force, [v for v in speeds if v < lift][::-1], start)
    return ([*down[::-1], *up] if lost is None else []), lost


def _march(
    system: System, force: float, speeds: Sequence[float], start: SolvedPoint
) -> tuple[list[SolvedPoint], NotConvergedError | None]:
    """Return solutions at one speed after another, and the error if one cannot be solved."""
    solved: list[SolvedPoint] = []
    last, known = start, [(np.log(start.speed), start.solution.state)]
    budget, first = _SUBSTEPS, start.solution.couette == 0
    if first:
        known = []
    for speed in speeds:
        problem = point_problem(system, force, speed)
        try:
            if problem.mesh is not last.problem.mesh:
                state = carried_state(problem, last.problem, last.solution)
                if not first:
                    number = couette_number(problem, system.viscosity, last.speed)
                    state = solve_point(problem, number, state).state
                    known = [(np.log(last.speed), state)]
                last = last._replace(problem=problem, solution=last.solution._replace(state=state))
        except NotConvergedError as error:
            return solved, error
        aims = [np.log(speed)]
        if first and start.speed < speed:
            aims.append(np.log(start.speed))
        while aims:
            number = couette_number(problem, system.viscosity, float(np.exp(aims[-1])))
            begin = _predicted(problem, known, last.solution.state, aims[-1])
            try:
                solution = solve_point(problem, number, begin, first=first)
            except NotConvergedError as error:
                budget -= 1
                closer = (aims[-1] + known[-1][0]) / 2 if known else aims[-1] - np.log(10)
                if budget < 0 or (known and abs(aims[-1] - known[-1][0]) < _FINEST):
                    return solved, error
                aims.append(closer)
                continue
            known = [*known[-1:], (aims[-1], solution.state)]
            last, first = SolvedPoint(float(np.exp(aims.pop())), problem, solution), False
        solved.append(last._replace(speed=speed))
    return solved, None


def carried_state(
    problem: PointProblem, before: PointProblem, solution: PointSolution
) -> PointState:
    """Return a state on another mesh, from the interpolated pressure and the smallest film."""
    mesh, old = problem.mesh, before.mesh
    rows = solution.state.pressure.reshape(-1, old.sectors)
    moved = np.stack([np.interp(mesh.radius, old.radius, row) for row in rows.T], axis=1).ravel()
    moved *= problem.load / 2 / (mesh.area @ moved)
    shape = mesh.squared + mesh.kernel @ moved
    return PointState(moved, float(solution.film.min() - shape.min()))


def _predicted(
    problem: PointProblem, known: list[tuple[float, PointState]], state: PointState, aim: float
) -> PointState:
    """Return a starting state extrapolated from two solutions; films change by at most 60 %."""
    if len(known) < 2 or known[-1][0] == known[-2][0]:
        return state
    (before, old), (at, new) = known[-2:]
    part = float(np.clip((aim - at) / (at - before), 0.0, 2.0))
    change = part * (new.pressure - old.pressure), part * (new.constant - old.constant)
    moved = problem.mesh.kernel @ change[0] + change[1]
    largest = float(np.max(np.abs(moved) / new.film(problem.mesh)))
    share = min(1.0, 0.6 / max(largest, 1e-12))
    return PointState(new.pressure + share * change[0], new.constant + share * change[1])


def _dry_start(system: System, force: float) -> tuple[PointProblem, PointState]:
    """Return the solved contact at rest, as the starting state."""
    problem = point_problem(system, force, 0.0)
    assert system.separation is not None
    mesh = problem.mesh
    profile = solve_rings(force, _ball(system), system.separation, mesh, problem.radius)
    ring = profile.pressure / problem.pressure
    constant = profile.separation[0] / problem.gap - mesh.radius[0] ** 2 - mesh.rings[0] @ ring
    return problem, PointState(np.repeat(ring, mesh.sectors), float(constant))


def _gentle_speed(problem: PointProblem, dry: PointSolution, system: System) -> float:
    """Return a speed [m/s] at which the fluid pressure is small next to the contact pressure."""
    thinnest = float(dry.film.min())
    phi = float(problem.moving(0.0).transport(np.array([thinnest * problem.gap]))[0][0])
    number = _GENTLE * thinnest**2 * max(phi, 1e-6)
    return number / couette_number(problem, system.viscosity, 1.0)


def _closing_gap(system: System) -> float:
    return 1.02 * system.factors.percolation_separation


def _ball(system: System) -> PointContact:
    assert isinstance(system.contact, PointContact)
    return system.contact


def _lost(speed: float, error: Exception) -> AnalysisError:
    return AnalysisError(
        f"no solution at {speed:.4g} m/s ({error}); take more cells, add neighbouring speeds, or "
        "leave it out"
    )
