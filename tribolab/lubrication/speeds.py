"""Solution of a lubricated line contact at given speeds, with a suitable mesh for each."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.contact.adhesive_growth import AdhesiveGrowth
from tribolab.contact.geometry import Contact, LineContact
from tribolab.contact.separation import Separation
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.domain import lubrication_problem, thinned_film
from tribolab.lubrication.factors import FlowFactors
from tribolab.lubrication.line_solver import (
    NotConvergedError,
    Problem,
    Solution,
    State,
    solve_speed,
)
from tribolab.lubrication.parameters import Liquid, Solver
from tribolab.lubrication.sweep import (
    carried_state,
    dry_state,
    is_thick,
    lifted_state,
    sweep,
    sweep_from_similar,
    wet_state,
)

_THICK_FILM_RATIO = 10.0  # ratio of successive speeds above which thick films are solved afresh


class System(NamedTuple):
    """Parameters of a lubricated contact except load and speed, in SI."""

    contact: Contact
    psd: xr.Dataset | None
    separation: Separation | None
    factors: FlowFactors
    liquid: Liquid
    solver: Solver
    growth: AdhesiveGrowth | None = None  # increase of the contact area by adhesion
    rolls: bool = False  # whether both bodies move

    @property
    def line(self) -> LineContact:
        """The contact, for code that is valid for line contacts only."""
        assert isinstance(self.contact, LineContact)
        return self.contact

    @property
    def viscosity(self) -> float:
        """Zero-shear viscosity [Pa s] of the liquid."""
        return self.liquid.viscosity

    def film(self, force: float, speed: float) -> float:
        """Return the estimated film thickness [m] at a load [N/m] and speed [m/s]."""
        if not speed:
            return 0.0
        return thinned_film(self.line, self.liquid, force, speed * abs(self.factors.slide))

    def problem(self, force: float, speed: float) -> Problem:
        """Return scales and mesh for a load [N/m] and a speed [m/s], which may be 0."""
        return lubrication_problem(
            self.line,
            self.separation,
            self.factors,
            force,
            self.film(force, speed),
            self.solver.cells,
            self.solver.domain,
            self.liquid,
        )


class SolvedSpeed(NamedTuple):
    """Solution at one speed [m/s], with its problem and mesh."""

    speed: float
    problem: Problem
    solution: Solution


def solve_speeds(
    system: System, force: float, speeds: np.ndarray, near: Sequence[SolvedSpeed] = ()
) -> list[SolvedSpeed]:
    """Return the solutions of a line contact at increasing speeds [m/s].

    Speeds with similar films share a mesh, which depends only on the speed, as does the solution.
    The last state is interpolated from one mesh to the next.

    Parameters
    ----------
    system, force, speeds
        Contact system, load [N/m] and speeds [m/s].
    near
        Solutions of a similar system, used as starting states at equal speed and mesh: they save
        steps without changing the solution.

    Raises
    ------
    AnalysisError
        If a speed cannot be solved; the message says what to change.
    """
    points: list[SolvedSpeed] = []
    like = {(point.speed, id(point.problem.mesh)): point.solution.state for point in near}
    posed = ((float(v), system.problem(force, float(v))) for v in speeds)
    for _, group in groupby(posed, key=lambda pair: id(pair[1].mesh)):
        some = list(group)
        problem, wanted = some[0][1], [v for v, _ in some]
        states = [like.get((v, id(problem.mesh))) for v in wanted]
        solved_states = [state for state in states if state is not None]
        solutions = None
        if wanted[0] > 0 and len(solved_states) == len(wanted):
            solutions = sweep_from_similar(problem, system.viscosity, wanted, solved_states)
        if solutions is None and points:
            solutions = _continue(system, force, problem, wanted, points[-1])
        if solutions is None:
            solutions = _restart(system, force, problem, np.array(wanted))
        points += [SolvedSpeed(v, problem, s) for v, s in zip(wanted, solutions, strict=True)]
    return points


def _continue(
    system: System, force: float, problem: Problem, speeds: list[float], last: SolvedSpeed
) -> list[Solution] | None:
    """Return solutions on another mesh, continued from the last speed; None if this fails."""
    around = problem, system.line, system.liquid, force
    soon = system.psd is None or is_thick(*around, speeds[0])  # a direct start is possible
    if not last.speed or (soon and speeds[0] > _THICK_FILM_RATIO * last.speed):
        return None
    start = carried_state(problem, last.problem, last.solution.state)
    try:
        return sweep(problem, system.viscosity, [last.speed, *speeds], start)[1:]
    except AnalysisError:  # the caller then starts from rest, where an error states the cause
        return None


def _restart(system: System, force: float, problem: Problem, speeds: np.ndarray) -> list[Solution]:
    """Return solutions started from the dry contact, from thick films, or from smooth surfaces.

    The solution is independent of the start. The dry contact is the most reliable start, but slow
    if its flow channels are closed, or if the first speed separates the surfaces.
    """
    moving = speeds[speeds > 0]
    around = problem, system.line, system.liquid, force
    at_rest = moving.size < speeds.size

    def from_start(start: State | None) -> list[Solution]:
        return sweep(
            problem,
            system.viscosity,
            moving,
            start,
            lambda: lifted_state(*around, float(moving[-1])),
        )

    if not at_rest and system.psd is not None and is_thick(*around, float(moving[0])):
        with contextlib.suppress(AnalysisError):
            return from_start(None)
    rest, start, no_start = [], None, None
    try:
        if system.separation is None:
            start = wet_state(*around, float(moving[0]))
        else:
            start = dry_state(problem, system.line, system.separation, force)
        if at_rest:
            rest = [solve_speed(problem, 0.0, start)]
    except (AnalysisError, NotConvergedError) as error:
        no_start = error
    if no_start and (system.psd is None or at_rest):
        raise AnalysisError(f"the contact at {speeds[0]:g} m/s: {no_start}") from no_start
    if not moving.size:
        return rest
    if system.psd is not None and start is not None and _is_sealed(problem, start):
        with contextlib.suppress(AnalysisError):
            return rest + from_start(None)
    try:
        return rest + from_start(start)
    except AnalysisError as error:
        if no_start:
            raise AnalysisError(f"{error}; at rest: {no_start}") from error
        raise


def _is_sealed(problem: Problem, rest: State) -> bool:
    """Return whether all flow channels are closed somewhere in the dry contact."""
    return bool(rest.film.min() * problem.gap < problem.factors.percolation_separation)
