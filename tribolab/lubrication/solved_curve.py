"""A Stribeck curve of one surface: its films solved, and the friction that is in them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.contact.area import AreaTheory, other_area
from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import hertz_half_width
from tribolab.contact.limits import line_limits
from tribolab.errors import AnalysisError
from tribolab.lubrication.factors import FlowFactors, RoughBody
from tribolab.lubrication.friction import fluid_friction
from tribolab.lubrication.parabolas import lowest, value_at
from tribolab.lubrication.speeds import SolvedSpeed, System, solve_speeds
from tribolab.lubrication.system import (
    CELLS,
    PROOF,
    checked_loads,
    checked_speeds,
    real_area,
    system_attributes,
    system_of,
    with_adhesion,
)
from tribolab.several import as_stated
from tribolab.stamping import stamp
from tribolab.threads import one_thread
from tribolab.units import to_si


class SolvedCurve(NamedTuple):
    """A curve, and what it was made from: curves of like contacts may start there."""

    curve: xr.Dataset
    points: list[list[SolvedSpeed]]  # of each load


def solve_curve(
    contact: LineContact,
    psd: xr.Dataset | None,
    viscosity: str | float | xr.DataArray,
    load: str | ArrayLike,
    shear_stress: str | float | xr.DataArray,
    speed: str | ArrayLike,
    friction_factors: bool = True,
    rough_body: RoughBody | None = None,
    factors: FlowFactors | None = None,
    gamma: float = 0.45,
    cells: int = CELLS,
    domain: float = 1.0,
    inlet_length: str | float = np.inf,
    area: AreaTheory = "persson",
    work_of_adhesion: str | float | None = None,
    near: SolvedCurve | None = None,
) -> SolvedCurve:
    """Compute a Stribeck curve of one surface, if need be beside another one.

    Parameters
    ----------
    contact, psd, viscosity, load, shear_stress, speed, friction_factors, rough_body, factors
        As for `stribeck_curve`, with one spectrum, viscosity [Pa s] and shear stress [Pa].
    gamma, cells, domain, inlet_length, area, work_of_adhesion
        As there.
    near
        A curve of a contact that differs little, at as many loads, to start from.

    Returns
    -------
    SolvedCurve
        The curve of `stribeck_curve` over (sliding_speed) and (load).

    Raises
    ------
    UnitError, AnalysisError
        As there.
    """
    with one_thread():
        system = system_of(
            contact,
            psd,
            as_stated(viscosity),
            rough_body,
            factors,
            gamma,
            cells,
            domain,
            inlet_length,
            area,
        )
    stress = to_si(as_stated(shear_stress), "Pa", name="shear_stress")
    if not 0 <= stress < np.inf:
        raise AnalysisError(f"shear_stress: it must be finite and not negative; got {stress:g} Pa")
    loads, speeds = checked_loads(load), checked_speeds(speed, psd)
    system = with_adhesion(system, float(np.max(loads.values)), work_of_adhesion)
    forces = [float(force) for force in np.atleast_1d(loads.values)]
    beside: Sequence[Sequence[SolvedSpeed]] = [()] * len(forces) if near is None else near.points
    magnitudes, back = np.unique(np.abs(speeds.values), return_inverse=True)
    with one_thread():
        points = [
            solve_speeds(system, force, magnitudes, known)
            for force, known in zip(forces, beside, strict=True)
        ]
        curves = [
            _curve(system, force, some, friction_factors)
            for force, some in zip(forces, points, strict=True)
        ]
    curves = [{name: part[back] for name, part in curve.items()} for curve in curves]
    stacked = {name: np.stack([curve[name] for curve in curves], axis=1) for name in curves[0]}
    stacked["friction_coefficient"] = (
        stacked["friction_coefficient_couette"] + stacked["friction_coefficient_pressure"]
    )
    solid = stress * stacked["friction_per_shear_stress"]
    for name in ("friction_coefficient", "friction_without_factors"):
        stacked[name] = stacked[name] + solid
    stacked["friction_coefficient_solid"] = solid
    parts = {name: (("sliding_speed", "load"), values) for name, values in stacked.items()}
    data = xr.Dataset(parts, {"sliding_speed": speeds.values, "load": np.atleast_1d(loads.values)})
    if loads.ndim == 0:
        data = data.isel(load=0)
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
            data.minimum_separation.values,
        ),
        friction_factors="yes" if friction_factors else "no",
    )
    return SolvedCurve(curve, points)


def _curve(
    system: System, force: float, points: list[SolvedSpeed], friction_factors: bool
) -> dict[str, np.ndarray]:
    # all in one: the pressures of all meshes have one unit
    solid = np.stack([p.solution.fields.contact * p.problem.pressure for p in points])
    whole = solid + np.stack([p.solution.fields.fluid * p.problem.pressure for p in points])
    hertz = hertz_half_width(force, system.contact)
    areas = np.stack(
        [
            real_area(system, solid, whole, theory)
            for theory in (system.area, other_area(system.area))
        ],
        axis=1,
    )
    rows = [
        _row(point, force, float(hertz), area, friction_factors)
        for point, area in zip(points, areas, strict=True)
    ]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _row(
    point: SolvedSpeed, force: float, hertz: float, area: np.ndarray, friction_factors: bool
) -> dict[str, float]:
    """All that a curve has of one speed, the relative contact area in its cells being known.

    That is of the theory asked for, and of the other one (2, cells).
    """
    _, problem, solution = point
    mesh, film, solid = problem.mesh, solution.state.film, solution.fields.contact
    real_length, otherwise = area @ mesh.weight * problem.half_width
    rough, plain = fluid_friction(problem, solution)
    couette, pressure = rough if friction_factors else plain
    return {
        "friction_coefficient_couette": couette,
        "friction_coefficient_pressure": pressure,
        "friction_without_factors": sum(plain),
        "friction_per_shear_stress": real_length / force,
        "friction_per_shear_stress_other": otherwise / force,
        "contact_area_ratio": real_length / (2 * hertz),
        "minimum_separation": lowest(mesh.x, film) * problem.gap,
        "central_separation": value_at(mesh.x, film, 0.0) * problem.gap,
        "solid_load_share": solid @ mesh.weight / problem.load,
        **{name: getattr(solution, name) for name in PROOF},
    }
