"""Profiles of separation and pressure across a lubricated contact."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.arrays.broadcasting import over_dims
from tribolab.arrays.threads import one_thread
from tribolab.contact.geometry import Contact
from tribolab.contact.limits import line_limits
from tribolab.core.validity import together
from tribolab.lubrication.parameters import (
    Interface,
    Liquid,
    Solver,
    parameters_of,
    renamed,
    warn_of_old,
)
from tribolab.lubrication.point.sweep import SolvedPoint, solve_points
from tribolab.lubrication.speeds import SolvedSpeed, System, solve_speeds
from tribolab.lubrication.system import (
    PROOF,
    checked_speeds,
    real_area,
    system_attributes,
    system_of,
    with_adhesion,
)
from tribolab.units.conversion import positive
from tribolab.units.stamping import stamp


@renamed(viscosity="liquid")
@over_dims(psd=("wavenumber",))
def film_profile(
    contact: Contact,
    psd: xr.Dataset | None,
    liquid: Liquid | str | float,
    load: str | float,
    speed: str | ArrayLike,
    interface: Interface | str | None = None,
    solver: Solver | None = None,
    **options: Any,
) -> xr.Dataset:
    """Return the separation and pressures across the contact, at one or several speeds.

    Parameters
    ----------
    contact, psd, liquid, load, speed, interface, solver, **options
        As for `stribeck_curve`, with one load.

    Returns
    -------
    xarray.Dataset
        Over ``x`` [m] (for a ball on the centre line), the flat sliding to +x (for a negative speed
        to -x); for several speeds over (sliding_speed, point), with ``x`` as a variable:
        ``separation`` [m], ``contact_pressure``, ``fluid_pressure`` (exactly 0 in the cavity) and
        their sum ``pressure`` [Pa], ``contact_area_ratio`` [1]; scalars ``sliding_speed`` and
        ``load``, the ``flux`` [m2/s] of a line contact and ``cavity_start`` [m], and the
        convergence data ``residual``, ``load_balance``, ``flux_variation``, ``iterations``.
        Attributes: grid and system.

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> film = film_profile(contact, None, "1.4 Pa s", "310 N/m", "1 mm/s")
    >>> f"{1e6 * film.separation.min():.2f} um, {1e-3 * film.pressure.max():.1f} kPa"
    '5.89 um, 52.3 kPa'
    """
    if isinstance(interface, str):  # argument `rough_body` of the last release
        options, interface = {"rough_body": interface, **options}, None
    warn_of_old("film_profile", options)
    parameters = parameters_of(liquid, interface or 0.0, solver, **options)
    force = positive(load, contact.load_unit, "load")
    speeds = checked_speeds(speed, psd).values
    magnitudes, back = np.unique(np.abs(speeds), return_inverse=True)
    with one_thread():
        system = system_of(contact, psd, parameters)
        system = with_adhesion(system, force, parameters.interface.work_of_adhesion)
        solve = solve_points if contact.is_round else solve_speeds
        points = solve(system, force, parameters.interface.entrained * magnitudes)
    films = [
        _profile(system, force, float(v), points[i]) for v, i in zip(speeds, back, strict=True)
    ]
    return _combine(films) if np.ndim(speed) else films[0]


def _profile(
    system: System, force: float, v: float, point: SolvedSpeed | SolvedPoint
) -> xr.Dataset:
    """Return the profile at one speed from its solution."""
    side = -1 if v < 0 else 1
    x, film, solid, fluid, cavity = _centre_line(point)
    whole = solid + fluid
    values = {
        "separation": film,
        "contact_pressure": solid,
        "fluid_pressure": fluid,
        "pressure": whole,
        "contact_area_ratio": real_area(system, solid, whole, system.solver.area),
    }
    x = side * x
    # stored as variables, because combining speeds drops attributes that differ
    scalars = {
        "cavity_start": float(x[min(cavity, x.size - 1)]),
        **{name: getattr(point.solution, name) for name in PROOF},
    }
    if isinstance(point, SolvedSpeed):
        scalars["flux"] = side * _flux(system, point)
    data = xr.Dataset(
        {name: ("x", value[::side]) for name, value in values.items()} | scalars,
        coords={"x": x[::side], "sliding_speed": v, "load": force},
    )
    data["load"].attrs["units"] = system.contact.load_unit
    thinnest = [film.min()]
    around = system.contact, force, system.psd, system.separation
    limits = line_limits("film_profile", *around, [v], thinnest)
    return stamp(data, **system_attributes(system), **limits)


def _centre_line(
    point: SolvedSpeed | SolvedPoint,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, int]:
    """Return x [m], film [m], contact and fluid pressure [Pa] and the first index in the cavity."""
    parts: tuple[np.ndarray, ...]
    if isinstance(point, SolvedSpeed):
        line, fields = point.problem, point.solution.fields
        length, gap, pressure = line.half_width, line.gap, line.pressure
        parts = line.mesh.x, point.solution.state.film, fields.contact, fields.fluid
        cavity = fields.front
    else:
        ball, found, mesh = point.problem, point.solution, point.problem.mesh
        length, gap, pressure = ball.radius, ball.gap, ball.pressure
        ring = np.arange(mesh.radius.size) * mesh.sectors
        at = np.concatenate([ring[::-1] + mesh.sectors - 1, ring])
        across = np.concatenate([-mesh.radius[::-1], mesh.radius])
        parts = across, found.film[at], found.contact[at], found.fluid[at]
        dry = np.flatnonzero(found.dry[at] & (across > 0))
        cavity = int(dry[0]) if dry.size else across.size
    x, film, solid, fluid = parts
    return x * length, film * gap, solid * pressure, fluid * pressure, cavity


def _flux(system: System, point: SolvedSpeed) -> float:
    """Return the flux of liquid [m2/s] through a line contact."""
    problem = point.problem
    unit = problem.gap**3 * problem.pressure / (12 * system.viscosity * problem.half_width)
    return float(point.solution.fields.flux[0] * unit)


def _combine(films: list[xr.Dataset]) -> xr.Dataset:
    """Return profiles at several speeds over (sliding_speed, point), each on its own grid."""
    rows = [f.reset_index("x").reset_coords("x").rename_dims(x="point") for f in films]
    joined = xr.concat(
        rows, "sliding_speed", data_vars="all", coords="different", compat="equals", join="outer",
        combine_attrs="drop_conflicts",
    )  # fmt: skip
    return joined.assign_attrs(together(film.attrs for film in films))
