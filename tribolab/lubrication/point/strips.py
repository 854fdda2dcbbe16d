"""Strip approximation of a ball: line contacts along the sliding direction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tribolab.contact.area import alternative_area_theory
from tribolab.contact.geometry import LineContact, PointContact
from tribolab.contact.hertz import hertz_half_width
from tribolab.core.limit import Limit
from tribolab.lubrication.friction import fluid_friction, friction_parts
from tribolab.lubrication.parabolas import lowest, value_at
from tribolab.lubrication.point.sweep import expected_film
from tribolab.lubrication.speeds import System, solve_speeds
from tribolab.lubrication.system import PROOF, real_area

FILM = Limit(
    0.025,
    "1",
    "film in the middle over a^2/R up to which strips are within 8 % of the full theory",
    "rings and sectors at 3 N and 0.3 N; beyond, the liquid leaks sideways",
)
_STRIPS, _CELLS = 6, 100
_LEAK, _OBLIQUE = 0.88, 5 / 3  # entrainment speed of a strip, v' = 0.88 v cos^(5/3) t


def within_strips(system: System, force: float, speed: np.ndarray) -> np.ndarray:
    """Return a mask of the speeds [m/s] at which strips are valid: thin Newtonian films."""
    contact = system.contact
    if system.contact.thickness < np.inf or system.liquid.thinning or not contact.is_round:
        return np.zeros(np.shape(speed), dtype=bool)
    assert isinstance(contact, PointContact)
    limit = FILM.value * float(hertz_half_width(force, contact)) ** 2 / contact.radius
    films = [expected_film(contact, system.liquid, force, float(v)) for v in np.atleast_1d(speed)]
    return np.array(films) < limit


def strip_rows(system: System, force: float, speeds: np.ndarray) -> list[dict[str, float]]:
    """Return the values of a ball's Stribeck curve at increasing speeds [m/s], from six strips.

    Notes
    -----
    At y = a sin t a strip carries (E* a^2/R) cos^2 t per length and has the modulus 4 E*/pi, while
    contact pressure and area are those of E*. Because liquid enters obliquely, the entrainment
    speed is v' = 0.88 v cos^(5/3) t:
    ``mu = (1/F) int dy F' [mu_fluid(F', v') v/v' + sigma_f kappa]``.
    """
    contact, solver = system.contact, system.solver
    a, stiff = float(hertz_half_width(force, contact)), contact.effective_modulus
    node, weight = np.polynomial.legendre.leggauss(_STRIPS)
    cosine = np.cos(np.pi / 4 * (1 + node))
    share = weight * cosine**3
    share /= share.sum()
    line = LineContact(contact.radius, 1.0, 4 / np.pi * stiff, 0.0)
    extent = contact.radius if system.liquid.extent is None else system.liquid.extent
    strip = system._replace(
        contact=line,
        liquid=replace(system.liquid, extent=extent),
        solver=replace(solver, cells=min(solver.cells, _CELLS)),
    )
    rows: list[dict[str, float]] = [{} for _ in speeds]
    for part, cos_t in zip(share, cosine, strict=True):
        load, slower = stiff * a**2 / contact.radius * cos_t**2, _LEAK * cos_t**_OBLIQUE
        for row, point in zip(rows, solve_speeds(strip, load, slower * speeds), strict=True):
            problem, solution = point.problem, point.solution
            mesh, film = problem.mesh, solution.state.film
            solid = solution.fields.contact
            fluid = friction_parts(system, *fluid_friction(problem, solution))
            areas = [
                real_area(
                    strip,
                    solid * problem.pressure,
                    (solid + solution.fields.fluid) * problem.pressure,
                    theory,
                )
                @ mesh.weight
                * problem.half_width
                / load
                for theory in (solver.area, alternative_area_theory(solver.area))
            ]
            values = {
                **{name: value / slower for name, value in fluid.items()},
                "friction_per_shear_stress": areas[0],
                "friction_per_shear_stress_other": areas[1],
                "solid_load_share": solid @ mesh.weight / problem.load,
            }
            for name, value in values.items():
                row[name] = row.get(name, 0.0) + part * float(value)
            thinnest = lowest(mesh.x, film) * problem.gap
            row["minimum_separation"] = min(row.get("minimum_separation", np.inf), thinnest)
            if cos_t == cosine.max():
                row["central_separation"] = value_at(mesh.x, film, 0.0) * problem.gap
            for name in PROOF:
                row[name] = max(row.get(name, 0.0), abs(getattr(solution, name)))
    for row in rows:
        row["contact_area_ratio"] = row["friction_per_shear_stress"] * force / (np.pi * a**2)
    return rows
