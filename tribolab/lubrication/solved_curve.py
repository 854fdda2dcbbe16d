"""Computed Stribeck curve of one surface, with the films from which it follows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.arrays.threads import one_thread
from tribolab.contact.area import alternative_area_theory
from tribolab.contact.geometry import Contact
from tribolab.contact.hertz import hertz_half_width
from tribolab.contact.limits import line_limits
from tribolab.lubrication.friction import fluid_friction, friction_parts
from tribolab.lubrication.parabolas import lowest, value_at
from tribolab.lubrication.parameters import Parameters
from tribolab.lubrication.point.rows import ball_rows, method_used
from tribolab.lubrication.speeds import SolvedSpeed, System, solve_speeds
from tribolab.lubrication.system import (
    PROOF,
    checked_loads,
    checked_speeds,
    real_area,
    system_attributes,
    system_of,
    with_adhesion,
)
from tribolab.units.stamping import stamp


class SolvedCurve(NamedTuple):
    """Stribeck curve with its solutions, from which similar contacts can be started."""

    curve: xr.Dataset
    points: list[list[SolvedSpeed]]  # one list per load


def solve_curve(
    contact: Contact,
    psd: xr.Dataset | None,
    load: str | ArrayLike,
    speed: str | ArrayLike,
    parameters: Parameters,
    near: SolvedCurve | None = None,
) -> SolvedCurve:
    """Return the Stribeck curve of one surface, started from a similar one if given.

    Parameters
    ----------
    contact, psd, load, speed
        As for `stribeck_curve`, with one spectrum.
    parameters
        Liquid, interface and solver.
    near
        Similar curve of a line contact, with the same number of loads, as a start.

    Returns
    -------
    SolvedCurve
        The curve of `stribeck_curve` over (sliding_speed) and (load).

    Raises
    ------
    UnitError, AnalysisError
        As for `stribeck_curve`.
    """
    with one_thread():
        system = system_of(contact, psd, parameters)
    stress, work = parameters.interface.shear_stress, parameters.interface.work_of_adhesion
    loads, speeds = checked_loads(load, contact), checked_speeds(speed, psd)
    system = with_adhesion(system, float(np.max(loads.values)), work)
    forces = [float(force) for force in np.atleast_1d(loads.values)]
    near_points: Sequence[Sequence[SolvedSpeed]] = [()] * len(forces)
    if near is not None and not contact.is_round:
        near_points = near.points
    # two moving bodies entrain as one body at twice the entrainment speed
    times = parameters.interface.entrained
    magnitudes, back = np.unique(times * np.abs(speeds.values), return_inverse=True)
    used: list[np.ndarray] = []
    points: list[list[SolvedSpeed]] = []
    curves = []
    with one_thread():
        for force, known in zip(forces, near_points, strict=True):
            if contact.is_round:
                columns, strips = ball_rows(system, force, magnitudes)
                used.append(strips)
            else:
                points.append(solve_speeds(system, force, magnitudes, known))
                columns = _curve(system, force, points[-1])
            curves.append(columns)
    curves = [{name: part[back] for name, part in curve.items()} for curve in curves]
    stacked = {name: np.stack([curve[name] for curve in curves], axis=1) for name in curves[0]}
    stacked["friction_coefficient"] = stacked["friction_coefficient_couette"]
    if not system.rolls:
        stacked["friction_coefficient"] = (
            stacked["friction_coefficient"] + stacked["friction_coefficient_pressure"]
        )
    solid = stress * stacked["friction_per_shear_stress"]
    for name in ("friction_coefficient", "friction_without_factors"):
        stacked[name] = stacked[name] + solid
    stacked["friction_coefficient_solid"] = solid
    parts = {name: (("sliding_speed", "load"), values) for name, values in stacked.items()}
    data = xr.Dataset(parts, {"sliding_speed": speeds.values, "load": np.atleast_1d(loads.values)})
    if loads.ndim == 0:
        data = data.isel(load=0)
    thinnest = data.minimum_separation.values
    data["load"].attrs["units"] = contact.load_unit
    if system.rolls and parameters.interface.abscissa == "entrainment_speed":
        data = data.rename(sliding_speed="entrainment_speed")
    curve = stamp(
        data,
        **system_attributes(system),
        shear_stress_Pa=stress,
        **line_limits(
            "stribeck_curve",
            contact,
            loads.values,
            psd,
            system.separation,
            speeds.values,
            thinnest,
        ),
        friction_factors="yes" if parameters.solver.friction_factors else "no",
    )
    if contact.is_round:
        curve.attrs["method"] = method_used(used)
    return SolvedCurve(curve, points)


def _curve(system: System, force: float, points: list[SolvedSpeed]) -> dict[str, np.ndarray]:
    # contact areas of all points together, with pressures in Pa
    solid = np.stack([p.solution.fields.contact * p.problem.pressure for p in points])
    whole = solid + np.stack([p.solution.fields.fluid * p.problem.pressure for p in points])
    hertz = hertz_half_width(force, system.contact)
    areas = np.stack(
        [
            real_area(system, solid, whole, theory)
            for theory in (system.solver.area, alternative_area_theory(system.solver.area))
        ],
        axis=1,
    )
    rows = [
        _row(system, point, force, float(hertz), area)
        for point, area in zip(points, areas, strict=True)
    ]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _row(
    system: System, point: SolvedSpeed, force: float, hertz: float, area: np.ndarray
) -> dict[str, float]:
    """Return the values of a curve at one speed, from area ratios in two theories (2, cells)."""
    _, problem, solution = point
    mesh, film, solid = problem.mesh, solution.state.film, solution.fields.contact
    real_length, otherwise = area @ mesh.weight * problem.half_width
    return {
        **friction_parts(system, *fluid_friction(problem, solution)),
        "friction_per_shear_stress": real_length / force,
        "friction_per_shear_stress_other": otherwise / force,
        "contact_area_ratio": real_length / (2 * hertz),
        "minimum_separation": lowest(mesh.x, film) * problem.gap,
        "central_separation": value_at(mesh.x, film, 0.0) * problem.gap,
        "solid_load_share": solid @ mesh.weight / problem.load,
        **{name: getattr(solution, name) for name in PROOF},
    }
