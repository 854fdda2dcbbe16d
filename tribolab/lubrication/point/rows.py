"""Values of a ball's Stribeck curve by the full theory, by strips, or by both."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.contact.area import alternative_area_theory
from tribolab.contact.hertz import hertz_half_width
from tribolab.lubrication.friction import friction_parts
from tribolab.lubrication.parameters import Method
from tribolab.lubrication.point.drag import point_friction
from tribolab.lubrication.point.strips import strip_rows, within_strips
from tribolab.lubrication.point.sweep import SolvedPoint, solve_points
from tribolab.lubrication.speeds import System
from tribolab.lubrication.system import PROOF, real_area

FULL, STRIPS = "rings and sectors", "strips"


def ball_rows(
    system: System, force: float, speeds: np.ndarray
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Return the columns of a ball's Stribeck curve, and a mask of the speeds solved by strips.

    Parameters
    ----------
    system, force, speeds
        Contact system, load [N] and increasing speeds [m/s].
    """
    method: Method = system.solver.method
    strips = np.zeros(speeds.size, dtype=bool)
    if method != "full":
        strips = within_strips(system, force, speeds) | (method == "strips")
    rows: list[dict[str, float]] = [{}] * speeds.size
    for used, make in ((strips, strip_rows), (~strips, _full_rows)):
        if used.any():
            made = make(system, force, speeds[used])
            for i, row in zip(np.flatnonzero(used), made, strict=True):
                rows[i] = row
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}, strips


def _full_rows(system: System, force: float, speeds: np.ndarray) -> list[dict[str, float]]:
    hertz = float(hertz_half_width(force, system.contact))
    return [point_row(system, force, hertz, p) for p in solve_points(system, force, speeds)]


def point_row(system: System, force: float, hertz: float, point: SolvedPoint) -> dict[str, float]:
    """Return the values of a Stribeck curve at one solved speed."""
    _, problem, solution = point
    mesh, film = problem.mesh, solution.film
    solid, whole = dimensional_pressures(problem.pressure, solution.contact, solution.fluid)
    theories = (system.solver.area, alternative_area_theory(system.solver.area))
    unit = 2 * problem.radius**2  # factor 2: the mesh covers half the plane
    real, otherwise = (
        float(real_area(system, solid, whole, theory) @ mesh.area) * unit for theory in theories
    )
    middle = film[: mesh.sectors].mean() * problem.gap
    return {
        **friction_parts(system, *point_friction(problem, solution)),
        "friction_per_shear_stress": real / force,
        "friction_per_shear_stress_other": otherwise / force,
        "contact_area_ratio": real / (np.pi * hertz**2),
        "minimum_separation": float(film.min()) * problem.gap,
        "central_separation": float(middle),
        "solid_load_share": float(2 * solution.contact @ mesh.area / problem.load),
        **{name: getattr(solution, name) for name in PROOF},
    }


def dimensional_pressures(
    pressure: float, contact: np.ndarray, fluid: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the contact pressure and the total pressure [Pa] from dimensionless pressures."""
    return contact * pressure, (contact + fluid) * pressure


def method_used(strips: Sequence[np.ndarray]) -> str:
    """Return the name of the theory by which a ball's curve was computed: full, strips or both."""
    used = np.concatenate([np.ravel(part) for part in strips])
    if used.all():
        return STRIPS
    return f"{STRIPS} up to the limit of their film, {FULL} beyond" if used.any() else FULL
