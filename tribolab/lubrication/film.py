"""Separation and pressures across a lubricated contact."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.contact.area import AreaTheory
from tribolab.contact.geometry import LineContact
from tribolab.contact.limits import line_limits
from tribolab.lubrication.factors import FlowFactors, RoughBody
from tribolab.lubrication.speeds import SolvedSpeed, System, solve_speeds
from tribolab.lubrication.system import (
    CELLS,
    PROOF,
    checked_speeds,
    real_area,
    system_attributes,
    system_of,
    with_adhesion,
)
from tribolab.several import over_dims
from tribolab.stamping import stamp
from tribolab.threads import one_thread
from tribolab.units import positive
from tribolab.validity import together


@over_dims(psd=("wavenumber",))
def film_profile(
    contact: LineContact,
    psd: xr.Dataset | None,
    viscosity: str | float,
    load: str | float,
    speed: str | ArrayLike,
    rough_body: RoughBody | None = None,
    factors: FlowFactors | None = None,
    gamma: float = 0.45,
    cells: int = CELLS,
    domain: float = 1.0,
    inlet_length: str | float = np.inf,
    area: AreaTheory = "persson",
    work_of_adhesion: str | float | None = None,
) -> xr.Dataset:
    """Separation and pressures across the contact at one speed, or at each of several.

    Parameters
    ----------
    contact, psd, viscosity, load, speed, rough_body, factors, gamma, cells, domain, inlet_length
        As for `stribeck_curve`, with one load.
    area, work_of_adhesion
        Theory of the contact area, and what adhesion adds to it, as there.

    Returns
    -------
    xarray.Dataset
        Over ``x`` [m], the flat sliding to +x (at a negative speed to -x); of several speeds over
        (sliding_speed, point), with ``x`` as a variable: ``separation`` [m],
        ``contact_pressure``, ``fluid_pressure`` (exactly 0 in the cavity) and their sum
        ``pressure`` [Pa], ``contact_area_ratio`` [1]; scalars ``sliding_speed`` and ``load``, the
        ``flux`` [m2/s] and ``cavity_start`` [m], and the proof of the point: ``residual``,
        ``load_balance``, ``flux_variation``, ``iterations``. Grid and system are attributes.

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> film = film_profile(contact, None, "1.4 Pa s", "310 N/m", "1 mm/s")
    >>> f"{1e6 * film.separation.min():.2f} um, {1e-3 * film.pressure.max():.1f} kPa"
    '5.89 um, 52.3 kPa'
    """
    force = positive(load, "N/m", "load")
    speeds = checked_speeds(speed, psd).values
    magnitudes, back = np.unique(np.abs(speeds), return_inverse=True)
    with one_thread():
        system = system_of(
            contact, psd, viscosity, rough_body, factors, gamma, cells, domain, inlet_length, area
        )
        system = with_adhesion(system, force, work_of_adhesion)
        points = solve_speeds(system, force, magnitudes)
    films = [
        _profile(system, force, float(v), points[i]) for v, i in zip(speeds, back, strict=True)
    ]
    return _put_together(films) if np.ndim(speed) else films[0]


def _profile(system: System, force: float, v: float, point: SolvedSpeed) -> xr.Dataset:
    """Say what was solved at one speed."""
    _, problem, solution = point
    fields = solution.fields
    side = -1 if v < 0 else 1
    solid = fields.contact * problem.pressure
    whole = solid + fields.fluid * problem.pressure
    values = {
        "separation": solution.state.film * problem.gap,
        "contact_pressure": solid,
        "fluid_pressure": fields.fluid * problem.pressure,
        "pressure": whole,
        "contact_area_ratio": real_area(system, solid, whole, system.area),
    }
    x = side * problem.mesh.x * problem.half_width
    unit = problem.gap**3 * problem.pressure / (12 * system.viscosity * problem.half_width)
    # variables, since several speeds that are put together lose attributes that differ
    scalars = {
        "flux": float(side * fields.flux[0] * unit),
        "cavity_start": float(x[min(fields.front, x.size - 1)]),
        **{name: getattr(solution, name) for name in PROOF},
    }
    data = xr.Dataset(
        {name: ("x", value[::side]) for name, value in values.items()} | scalars,
        coords={"x": x[::side], "sliding_speed": v, "load": force},
    )
    thinnest = [values["separation"].min()]
    around = system.contact, force, system.psd, system.separation
    limits = line_limits("film_profile", *around, [v], thinnest)
    return stamp(data, **system_attributes(system), **limits)


def _put_together(films: list[xr.Dataset]) -> xr.Dataset:
    """Profiles at several speeds over (sliding_speed, point): each is on a grid of its own."""
    rows = [f.reset_index("x").reset_coords("x").rename_dims(x="point") for f in films]
    joined = xr.concat(
        rows, "sliding_speed", data_vars="all", coords="different", compat="equals", join="outer",
        combine_attrs="drop_conflicts",
    )  # fmt: skip
    return joined.assign_attrs(together(film.attrs for film in films))
