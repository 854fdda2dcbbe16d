"""Computed Stribeck curves: friction coefficient as a function of speed and load."""

from __future__ import annotations

from typing import Any

import xarray as xr
from numpy.typing import ArrayLike

from tribolab.arrays.broadcasting import over_dims
from tribolab.contact.geometry import Contact
from tribolab.lubrication.parameters import (
    Interface,
    Liquid,
    Solver,
    as_stated,
    parameters_of,
    renamed,
    warn_of_old,
)
from tribolab.lubrication.solved_curve import solve_curve
from tribolab.units.stamping import stamp


@renamed(viscosity="liquid", shear_stress="interface")
@over_dims(psd=("wavenumber",), liquid=(), interface=())
def stribeck_curve(
    contact: Contact,
    psd: xr.Dataset | None,
    liquid: Liquid | str | float | xr.DataArray,
    load: str | ArrayLike,
    interface: Interface | str | float | xr.DataArray,
    speed: str | ArrayLike,
    solver: Solver | None = None,
    **options: Any,
) -> xr.Dataset:
    """Return the friction coefficient of a lubricated rough contact at given speeds and loads.

    Parameters
    ----------
    contact
        `LineContact` or `PointContact`.
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber), or of several surfaces with further dims,
        which become dims of the result; None for smooth surfaces.
    liquid
        `Liquid`, or only its viscosity eta [Pa s]; a DataArray of viscosities over (medium) or
        other dims, which become dims of the result.
    load
        F_N/L [N/m], for a ball F_N [N], above zero; several loads become a dim.
    interface
        `Interface`, or only the shear stress sigma_f [Pa] in the real contact area; a DataArray of
        shear stresses as for `liquid`.
    speed
        Sliding speeds v [m/s] (sliding_speed) of one body, the other being at rest; with a
        slide-roll ratio entrainment speeds U = (u1 + u2)/2 (entrainment_speed). 0 is the dry
        contact; a negative speed is the mirror image of the positive one.
    solver
        `Solver`; None: the default.
    **options
        Single fields of `Liquid`, `Interface` and `Solver`: arguments of the last release.

    Returns
    -------
    xarray.Dataset
        Over ``sliding_speed`` (and ``load``): ``friction_coefficient`` and its parts ``_couette``,
        ``_pressure`` and ``_solid``; ``friction_without_factors``, the coefficient for
        `friction_factors` False; ``friction_per_shear_stress`` [1/Pa], which times sigma_f is the
        solid part, and ``friction_per_shear_stress_other``, the same with the corrected contact
        area if `area` is Persson's, else with Persson's; ``minimum_separation``,
        ``central_separation`` [m]; ``contact_area_ratio`` [1], real area over that of the Hertz
        contact, 2 a L; ``solid_load_share`` [1]; and convergence data: ``residual``,
        ``load_balance``, ``flux_variation``, ``iterations``. With a slide-roll ratio, the
        coefficient is half the difference between the frictions at positive and negative ratio, as
        mini traction machines measure it: Couette and solid part. ``_pressure`` is then rolling
        friction and not included. For a ball the attribute ``method`` is the theory used.

    Raises
    ------
    UnitError, AnalysisError
        If an argument has a wrong unit or value, or a point cannot be solved. Unsolved points are
        never returned.

    Notes
    -----
    Eqs. (3)-(5), (9), (10) of [1]_ with cavitation (p_fluid >= 0); friction by Eq. (4), whose
    pressure gradient is the fluid's. In the cavity the fluid covers the share of the flat for which
    the entrained (v/2)(u + h_rms phi_s) equals the flux.

    With a work of adhesion the area is A(p_cont) A_adh(p)/A_0(p), A_adh being that of `adhesion` at
    the total pressure, inside the nominal contact. This mean-field theory neglects that attraction
    also pulls the bodies together (p(u), the contact width and the load carried by the liquid are
    unchanged), that adhesion is hysteretic, that the liquid must be squeezed out before the bodies
    adhere, and that sliding may occur by waves of detachment (Sec. 8 of [1]_). It predicts the
    friction of the boundary regime, but not the speed at which that ends.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).
    .. [2] B. N. J. Persson, M. Scaraggi, Eur. Phys. J. E 34, 113 (2011).
       doi:10.1140/epje/i2011-11113-9

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> curve = stribeck_curve(contact, None, "1.4 Pa s", "310 N/m", 0.0, speed=[1e-4, 1e-3])
    >>> curve.minimum_separation.values.round(8)
    array([1.44e-06, 5.89e-06])
    """
    warn_of_old("stribeck_curve", options)
    parameters = parameters_of(as_stated(liquid), as_stated(interface), solver, **options)
    return solve_curve(contact, psd, load, speed, parameters).curve


def with_shear_stress(curve: xr.Dataset, shear_stress: float | xr.DataArray) -> xr.Dataset:
    """Return a computed curve for another shear stress, without solving the contact again.

    Parameters
    ----------
    curve
        From `stribeck_curve` with the shear stress ``"0 Pa"``.
    shear_stress
        sigma_f [Pa]; for several curves one for each, e.g. over (surface).

    Returns
    -------
    xarray.Dataset
        The curve with its solid part; for several curves also ``shear_stress`` [Pa].

    Examples
    --------
    >>> import numpy as np
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> q = np.array([423.0, 9.05e4, 3.14e9])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", 1e-22 * q**0)}, {"wavenumber": q})
    >>> psd["psd_2d"][2] = 1e-41
    >>> bare = stribeck_curve(contact, psd, "1.4 Pa s", "310 N/m", "0 Pa", "1 um/s")
    >>> curve = with_shear_stress(bare, 1e6)
    >>> bool(curve.friction_coefficient > 100 * bare.friction_coefficient)
    True
    """
    solid = shear_stress * curve["friction_per_shear_stress"]
    added = {
        name: curve[name] + solid for name in ("friction_coefficient", "friction_without_factors")
    }
    curve = curve.assign({"friction_coefficient_solid": solid, **added})
    if isinstance(shear_stress, xr.DataArray) and shear_stress.dims:
        return stamp(curve.assign(shear_stress=shear_stress))
    return stamp(curve, shear_stress_Pa=float(shear_stress))
