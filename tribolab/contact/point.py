"""Dry contact of a rough ball at rest on a flat: pressure and separation by radius."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import over_dims
from tribolab.contact.area import AreaTheory
from tribolab.contact.geometry import PointContact
from tribolab.contact.hertz import hertz_half_width, hertz_pressure
from tribolab.contact.limits import line_limits
from tribolab.contact.line import contact_width, solve_dry
from tribolab.contact.persson import contact_area_ratio
from tribolab.contact.polar import PolarMesh, polar_mesh
from tribolab.contact.separation import Separation, separation_table
from tribolab.units.conversion import positive
from tribolab.units.stamping import stamp

_SECTORS = 12  # number of sectors of the mesh for a pressure that depends on the radius only


def across_the_middle(profile: xr.Dataset) -> xr.Dataset:
    """Return a radial profile as a profile over x [m] along a diameter.

    ``contact_width`` [m] is the diameter at which pressure is 1e-3 of its maximum.
    """
    radius = profile["radial_distance"].values
    x = np.concatenate([-radius[::-1], radius])
    both = [profile.isel(radial_distance=slice(None, None, -1)), profile]
    joined = xr.concat(
        both, "radial_distance", data_vars="minimal", coords="minimal", compat="override"
    )
    joined = (
        joined.rename(radial_distance="x").assign_coords(x=x).drop_vars("friction_per_shear_stress")
    )
    joined["contact_width"] = contact_width(x, joined["pressure"].values)
    return stamp(joined.assign_attrs(profile.attrs))


class RoundProfile(NamedTuple):
    """Pressure and mean separation in the rings of a dry point contact, with convergence data."""

    radius: np.ndarray  # centres of the rings [m] (n)
    area: np.ndarray  # area of each ring [m2] (n)
    pressure: np.ndarray  # [Pa] (n)
    separation: np.ndarray  # [m] (n)
    steps: int
    residual: float  # largest error of p = p(u), in units of the maximum pressure


@over_dims(psd=("wavenumber",))
def rough_point_contact(
    load: str | float,
    contact: PointContact,
    psd: xr.Dataset,
    gamma: float = 0.45,
    rings: int = 120,
    area: AreaTheory = "persson",
) -> xr.Dataset:
    """Return pressure and mean separation, by radius, of a dry, rough point contact at rest.

    Parameters
    ----------
    load
        F_N [N], above zero.
    contact, psd, gamma, area
        As for `rough_line_contact`.
    rings
        Cells from the middle outwards.

    Returns
    -------
    xarray.Dataset
        Over ``radial_distance`` [m]: ``pressure`` [Pa], ``separation`` [m],
        ``contact_area_ratio`` [1]; scalars ``max_pressure`` [Pa], ``central_separation`` [m] and
        ``friction_per_shear_stress`` [1/Pa], real area over the load. Attributes: ``residual``,
        ``load_balance`` and ``steps``, as for `rough_line_contact`.

    Notes
    -----
    ``u = c + r^2/(2R) + (1/pi E*) int p dA/|r - r'|`` with p = p_cont(u), solved by the same convex
    Newton's method as in `rough_line_contact`.

    Examples
    --------
    >>> from tribolab.studies import xu2026
    >>> ball = PointContact("9.5 mm", "1 MPa", 0.5)
    >>> rough = rough_point_contact("3 N", ball, xu2026.psd("Sb-S", points=301))
    >>> f"{rough.max_pressure / 1e3:.0f} kPa"
    '225 kPa'
    """
    force = positive(load, "N", "load")
    table = separation_table(psd, contact.effective_modulus, gamma)
    a = float(hertz_half_width(force, contact))
    edge = (table.decay_length * contact.radius / (1.9 * a**2 / 2)) ** (2 / 3)
    # outside the Hertz contact, the pressure falls as exp(-u/u0), as in a line contact
    end = np.sqrt(1 + 2 * contact.radius * table.decay_length * np.log(1e12) / a**2)
    layer = contact.layer(a)
    mesh = polar_mesh(rings, _SECTORS, min(float(edge), 0.5), 1.1 * float(end), 1.0, layer)
    profile = solve_rings(force, contact, table, mesh, a)
    stiff = contact.effective_modulus
    ratio = contact_area_ratio(profile.pressure, psd, stiff, area)
    data = xr.Dataset(
        {
            "pressure": ("radial_distance", profile.pressure),
            "separation": ("radial_distance", profile.separation),
            "contact_area_ratio": ("radial_distance", ratio),
            "max_pressure": profile.pressure.max(),
            "central_separation": profile.separation[0],
            "friction_per_shear_stress": ratio @ profile.area / force,
        },
        coords={"radial_distance": profile.radius, "load": force},
    )
    data["load"].attrs["units"] = contact.load_unit
    return stamp(
        data,
        **line_limits("rough_point_contact", contact, force, psd, table),
        residual=profile.residual,
        load_balance=float(profile.pressure @ profile.area / force - 1),
        steps=profile.steps,
        area=area,
    )


def solve_rings(
    force: float, contact: PointContact, table: Separation, mesh: PolarMesh, length: float
) -> RoundProfile:
    """Return pressure and separation of a dry point contact on a mesh in units of `length` [m]."""
    radius = mesh.radius * length
    area = np.pi * np.diff(mesh.faces**2) * length**2
    kernel = mesh.rings * (length / contact.effective_modulus)
    hertz = hertz_pressure(radius, force, contact)
    gap = radius**2 / (2 * contact.radius)
    return RoundProfile(radius, area, *solve_dry(gap, area, hertz, force, table, kernel))
