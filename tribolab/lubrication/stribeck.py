"""Computed Stribeck curves: friction over speed and load, and profiles across the contact."""

from __future__ import annotations

import functools
from contextlib import AbstractContextManager
from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from threadpoolctl import ThreadpoolController

from tribolab.contact.adhesive_growth import adhesive_growth
from tribolab.contact.area import AreaTheory, check_area, other_area
from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import hertz_half_width, hertz_max_pressure
from tribolab.contact.limits import line_limits
from tribolab.contact.persson import contact_area_ratio
from tribolab.contact.separation import separation_table
from tribolab.errors import AnalysisError
from tribolab.lubrication.factors import (
    FlowFactors,
    RoughBody,
    check_rough_body,
    flow_factors,
    smooth_factors,
)
from tribolab.lubrication.friction import fluid_friction
from tribolab.lubrication.speeds import Point, System, solve_speeds
from tribolab.several import one, over_dims
from tribolab.stamping import labelled, stamp
from tribolab.units import positive, to_si
from tribolab.validity import together

CELLS = 280
PROOF = ("residual", "load_balance", "flux_variation", "iterations")  # of every point
REFERENCE = (
    "R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, Adhesion-controlled sliding and the "
    "Stribeck curve in hydrophobic soft contacts (2026), Eqs. (3)-(10)"
)


@over_dims(psd=("wavenumber",), viscosity=(), shear_stress=())
def stribeck_curve(
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
) -> xr.Dataset:
    """Friction coefficient of a lubricated rough line contact over sliding speed (and load).

    Parameters
    ----------
    contact
        Geometry and elasticity.
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber), or of several surfaces with further dims,
        which the result has, too; None for smooth surfaces.
    viscosity
        eta [Pa s], above zero; a DataArray over (medium), or any dims that the result will have.
    load
        F_N/L [N/m], above zero; several make a dim.
    shear_stress
        sigma_f [Pa] in the real contact area, not negative; a DataArray as for `viscosity`.
    speed
        Sliding speeds v [m/s] (sliding_speed). 0 is the dry contact; a negative speed is the
        mirror image of the positive one.
    friction_factors
        False takes phi_f = phi_fp = 1 and phi_fs = 0 in Eq. (4); flow keeps its factors.
    rough_body
        ``"stationary"`` or ``"moving"``: sets the sign of phi_s, see `flow_factors`, also that of
        given `factors`. None is that of `factors`, or ``"stationary"`` without any.
    factors
        Factors to use instead of the effective-medium ones.
    gamma
        Elastic-energy reduction factor [1] of the mean separation.
    cells
        Cells across the contact.
    domain
        Length of the domain over the default: a check of the numerics, as the drag of the liquid
        beyond its ends is added in closed form.
    inlet_length
        Where the liquid begins [m], before the contact's middle; by default it is everywhere.
    area
        Theory of the contact area, see `contact_area_ratio`. Films do not hang on it.
    work_of_adhesion
        Of the bodies under the liquid [J/m2]: adhesion then adds to the contact area, see Notes.

    Returns
    -------
    xarray.Dataset
        Over ``sliding_speed`` (and ``load``): ``friction_coefficient`` and its parts
        ``_couette``, ``_pressure`` and ``_solid``; ``friction_without_factors``, the coefficient
        that `friction_factors` False gives; ``friction_per_shear_stress`` [1/Pa], which
        times sigma_f is the solid part, and ``friction_per_shear_stress_other``, the same with the
        corrected contact area where `area` is Persson's, else with his; ``minimum_separation``,
        ``central_separation`` [m];
        ``contact_area_ratio`` [1], real area over that of the Hertz contact, 2 a L;
        ``solid_load_share`` [1]; and the proof of every point: ``residual``, ``load_balance``,
        ``flux_variation``, ``iterations``.

    Raises
    ------
    UnitError, AnalysisError
        If an argument has a wrong unit or value, or a point cannot be solved. No point is ever
        returned unsolved.

    Notes
    -----
    Eqs. (3)-(5), (9), (10) of [1]_ with cavitation (p_fluid >= 0); friction by Eq. (4), whose
    pressure gradient is the fluid's. In the cavity the fluid covers the part u*/u of the flat.

    With a work of adhesion the area is A(p_cont) A_adh(p)/A_0(p), A_adh being that of `adhesion` at
    the whole pressure, inside the nominal contact. This mean field leaves out that attraction also
    pulls the bodies together (p(u), the width of the contact and the load that the liquid carries
    stay as they are), that contact once made is harder to open than to make, that the liquid has to
    be squeezed out before the bodies bind, and that the sliding itself may be by waves of
    detachment (Sec. 8 of [1]_): it tells the friction of the boundary regime, and not at which
    speed it ends.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).
    .. [2] B. N. J. Persson, M. Scaraggi, Eur. Phys. J. E 34, 113 (2011).
       doi:10.1140/epje/i2011-11113-9

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> curve = stribeck_curve(contact, None, "1.4 Pa s", "310 N/m", 0.0, speed=[1e-4, 1e-3])
    >>> curve.minimum_separation.values.round(8)
    array([1.44e-06, 5.89e-06])
    """
    with _one_thread():
        system = _system(
            contact,
            psd,
            one(viscosity),
            rough_body,
            factors,
            gamma,
            cells,
            domain,
            inlet_length,
            area,
        )
    stress = to_si(one(shear_stress), "Pa", name="shear_stress")
    if not 0 <= stress < np.inf:
        raise AnalysisError(f"shear_stress: it must be finite and not negative; got {stress:g} Pa")
    loads, speeds = _loads(load), _speeds(speed, psd)
    system = _binding(system, float(np.max(loads.values)), work_of_adhesion)
    curves = []
    with _one_thread():
        for force in np.atleast_1d(loads.values):
            curves.append(_curve(system, float(force), speeds.values, friction_factors))
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
    return stamp(
        data,
        **_facts(system),
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


def _facts(system: System) -> dict[str, str | float | int]:
    """Attributes that say what was computed, and on which grid."""
    return {
        "viscosity_Pa_s": system.viscosity,
        "youngs_modulus_Pa": system.contact.youngs_modulus,
        "poisson_ratio": system.contact.poisson_ratio,
        "radius_m": system.contact.radius,
        "rough_body": system.factors.rough_body,
        "factors": system.factors.model,
        "cells": system.cells,
        "domain": float(system.domain),
        "inlet_length_m": system.inlet_length,
        "area": system.area,
        "work_of_adhesion_J_m2": system.growth.work_of_adhesion if system.growth else 0.0,
        "references": REFERENCE,
    }


def with_shear_stress(curve: xr.Dataset, shear_stress: float | xr.DataArray) -> xr.Dataset:
    """Add a shear stress to a computed curve that has none, without computing it again.

    Parameters
    ----------
    curve
        From `stribeck_curve` with the shear stress ``"0 Pa"``.
    shear_stress
        sigma_f [Pa]; of several curves one for each, e.g. over (surface).

    Returns
    -------
    xarray.Dataset
        The curve with its solid part; of several curves with ``shear_stress`` [Pa], too.

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> q = np.array([423.0, 9.05e4, 3.14e9])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", 1e-22 * q**0)}, {"wavenumber": q})
    >>> psd["psd_2d"][2] = 1e-41
    >>> bare = stribeck_curve(contact, psd, "1.4 Pa s", "310 N/m", "0 Pa", "1 um/s", cells=60)
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
    if np.ndim(speed):
        numerics = (
            rough_body, factors, gamma, cells, domain, inlet_length, area, work_of_adhesion
        )  # fmt: skip
        films = [
            film_profile(contact, psd, viscosity, load, float(v), *numerics)
            for v in _speeds(speed, psd).values
        ]
        return _put_together(films)
    v = float(_speeds(speed, psd).values[0])
    with _one_thread():
        system = _system(
            contact, psd, viscosity, rough_body, factors, gamma, cells, domain, inlet_length, area
        )
        system = _binding(system, force, work_of_adhesion)
        ((_, problem, solution),) = solve_speeds(system, force, np.array([abs(v)]))
    fields = solution.fields
    side = -1 if v < 0 else 1
    solid = fields.contact * problem.pressure
    whole = solid + fields.fluid * problem.pressure
    values = {
        "separation": solution.state.film * problem.gap,
        "contact_pressure": solid,
        "fluid_pressure": fields.fluid * problem.pressure,
        "pressure": whole,
        "contact_area_ratio": _area(system, solid, whole, area),
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
    thinnest = values["separation"].min()
    limits = line_limits("film_profile", contact, force, psd, system.separation, [v], [thinnest])
    return stamp(data, **_facts(system), **limits)


def _put_together(films: list[xr.Dataset]) -> xr.Dataset:
    """Profiles at several speeds over (sliding_speed, point): each is on a grid of its own."""
    rows = [f.reset_index("x").reset_coords("x").rename_dims(x="point") for f in films]
    joined = xr.concat(
        rows, "sliding_speed", data_vars="all", coords="different", compat="equals", join="outer",
        combine_attrs="drop_conflicts",
    )  # fmt: skip
    return joined.assign_attrs(together(film.attrs for film in films))


def _system(
    contact: LineContact,
    psd: xr.Dataset | None,
    viscosity: str | float,
    rough_body: RoughBody | None,
    factors: FlowFactors | None,
    gamma: float,
    cells: int,
    domain: float,
    inlet_length: str | float,
    area: AreaTheory,
) -> System:
    eta = positive(viscosity, "Pa s", "viscosity")
    check_area(area)
    if cells < 50:
        raise AnalysisError(f"cells: at least 50 are wanted; got {cells}")
    if not 0.2 <= domain <= 5:
        raise AnalysisError(f"domain: a length between 0.2 and 5 is wanted; got {domain:g}")
    if factors is None:
        body = rough_body or "stationary"
        factors = smooth_factors(body) if psd is None else flow_factors(psd, body, gamma=gamma)
    elif rough_body is not None:
        check_rough_body(rough_body)
        factors = replace(factors, rough_body=rough_body)
    separation = None if psd is None else separation_table(psd, contact.effective_modulus, gamma)
    begins = to_si(inlet_length, "m", name="inlet_length")  # `solve_speeds` has its lower limit
    return System(contact, psd, separation, factors, eta, cells, domain, begins, area)


@functools.cache
def _libraries() -> ThreadpoolController:
    """Find what computes on threads, once: it takes as long as some speeds of a curve."""
    return ThreadpoolController()


def _one_thread() -> AbstractContextManager[object]:
    """BLAS on one thread: two are slower on matrices as small as these."""
    limited: AbstractContextManager[object] = _libraries().limit(limits=1, user_api="blas")
    return limited


def _loads(load: str | ArrayLike) -> xr.DataArray:
    loads = labelled(load, "load")
    if loads.ndim > 1 or not np.all((loads.values > 0) & np.isfinite(loads.values)):
        raise AnalysisError(f"load: positive, finite values in N/m are wanted; got {loads.values}")
    return loads


def _speeds(speed: str | ArrayLike, psd: xr.Dataset | None) -> xr.DataArray:
    speeds = labelled(speed, "sliding_speed")
    if speeds.ndim == 0:
        speeds = speeds.expand_dims("sliding_speed")
    if speeds.ndim > 1 or speeds.size == 0 or not np.all(np.isfinite(speeds.values)):
        raise AnalysisError("speed: a list of finite sliding speeds in m/s is wanted")
    if psd is None and np.any(speeds.values == 0):
        raise AnalysisError("speed: at 0 no film is left between smooth surfaces; leave it out")
    return speeds


def _curve(
    system: System, force: float, speeds: np.ndarray, friction_factors: bool
) -> dict[str, np.ndarray]:
    magnitudes, back = np.unique(np.abs(speeds), return_inverse=True)
    points = solve_speeds(system, force, magnitudes)
    # all in one: the pressures of all meshes have one unit
    solid = np.stack([p.solution.fields.contact * p.problem.pressure for p in points])
    whole = solid + np.stack([p.solution.fields.fluid * p.problem.pressure for p in points])
    hertz = hertz_half_width(force, system.contact)
    areas = np.stack(
        [_area(system, solid, whole, theory) for theory in (system.area, other_area(system.area))],
        axis=1,
    )
    rows = [
        _row(point, force, float(hertz), area, friction_factors)
        for point, area in zip(points, areas, strict=True)
    ]
    return {name: np.array([row[name] for row in rows])[back] for name in rows[0]}


def _row(
    point: Point, force: float, hertz: float, area: np.ndarray, friction_factors: bool
) -> dict[str, float]:
    """All that a curve has of one speed, the relative contact area in its cells being known.

    That is of the theory asked for, and of the other one (2, cells).
    """
    _, problem, solution = point
    mesh, film, solid = problem.mesh, solution.state.film, solution.fields.contact
    real_length, otherwise = area @ mesh.width * problem.half_width
    rough, plain = fluid_friction(problem, solution)
    couette, pressure = rough if friction_factors else plain
    return {
        "friction_coefficient_couette": couette,
        "friction_coefficient_pressure": pressure,
        "friction_without_factors": sum(plain),
        "friction_per_shear_stress": real_length / force,
        "friction_per_shear_stress_other": otherwise / force,
        "contact_area_ratio": real_length / (2 * hertz),
        "minimum_separation": film.min() * problem.gap,
        "central_separation": np.interp(0.0, mesh.x, film) * problem.gap,
        "solid_load_share": solid @ mesh.width / problem.load,
        **{name: getattr(solution, name) for name in PROOF},
    }


def _binding(system: System, highest_load: float, work_of_adhesion: str | float | None) -> System:
    """Return the system with what adhesion adds to its contact area up to a load [N/m]."""
    if work_of_adhesion is None or system.psd is None:
        return system
    modulus = system.contact.effective_modulus
    # a film's pressure peaks a little above that of Hertz
    highest = 1.5 * float(hertz_max_pressure(highest_load, system.contact))
    return system._replace(growth=adhesive_growth(system.psd, modulus, work_of_adhesion, highest))


def _area(system: System, solid: np.ndarray, whole: np.ndarray, theory: AreaTheory) -> np.ndarray:
    """Relative contact area at the solid's pressure and the whole one [Pa]."""
    if system.psd is None:
        return np.zeros_like(solid)
    area = contact_area_ratio(solid, system.psd, system.contact.effective_modulus, theory)
    return area if system.growth is None else system.growth(solid, whole, area)
