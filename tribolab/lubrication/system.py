"""Checked inputs of Stribeck curves and film profiles, and the attributes of results."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.contact.adhesive_growth import adhesive_growth
from tribolab.contact.area import AreaTheory
from tribolab.contact.geometry import Contact
from tribolab.contact.hertz import hertz_max_pressure
from tribolab.contact.persson import contact_area_ratio
from tribolab.contact.separation import separation_table
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.factors import check_rough_body, flow_factors, smooth_factors
from tribolab.lubrication.parameters import Parameters
from tribolab.lubrication.speeds import System
from tribolab.units.stamping import labelled

PROOF = ("residual", "load_balance", "flux_variation", "iterations")  # convergence of each point
_REFERENCE = (
    "R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, Adhesion-controlled sliding and the "
    "Stribeck curve in hydrophobic soft contacts (2026), Eqs. (3)-(10)"
)


def system_of(contact: Contact, psd: xr.Dataset | None, parameters: Parameters) -> System:
    """Return a contact system for solvers: all parameters except load and speed."""
    liquid, interface, solver = parameters
    factors, body = interface.factors, interface.rough_body
    if factors is None:
        body = body or "stationary"
        gamma = solver.gamma
        factors = smooth_factors(body) if psd is None else flow_factors(psd, body, gamma=gamma)
    elif body is not None:
        check_rough_body(body)
        factors = replace(factors, rough_body=body)
    slide = 1.0 if interface.slide_roll is None else interface.slide_roll / 2
    balance = interface.roughness_balance
    if slide != 1 or balance is not None:
        factors = replace(factors, slide=slide, roughness_balance=balance)
    table = interface.separation
    if psd is not None and table is None:
        table = separation_table(psd, contact.effective_modulus, solver.gamma)
    return System(
        contact, psd, table, factors, liquid, solver, rolls=interface.slide_roll is not None
    )


def checked_loads(load: str | ArrayLike, contact: Contact) -> xr.DataArray:
    """Return loads [N/m] ([N] for a ball) over ``load``; an AnalysisError unless positive."""
    if contact.is_round:
        loads = labelled(load, "normal_force").rename("load")
        if "normal_force" in loads.dims:
            loads = loads.rename(normal_force="load")
    else:
        loads = labelled(load, "load")
    if loads.ndim > 1 or not np.all((loads.values > 0) & np.isfinite(loads.values)):
        raise AnalysisError(
            f"load: positive, finite values in N/m (of a ball N) are wanted; got {loads.values}"
        )
    return loads


def checked_speeds(speed: str | ArrayLike, psd: xr.Dataset | None) -> xr.DataArray:
    """Return sliding speeds [m/s]; an AnalysisError for smooth surfaces at rest."""
    speeds = labelled(speed, "sliding_speed")
    if speeds.ndim == 0:
        speeds = speeds.expand_dims("sliding_speed")
    if speeds.ndim > 1 or speeds.size == 0 or not np.all(np.isfinite(speeds.values)):
        raise AnalysisError("speed: a list of finite sliding speeds in m/s is wanted")
    if psd is None and np.any(speeds.values == 0):
        raise AnalysisError("speed: at 0 no film is left between smooth surfaces; leave it out")
    return speeds


def system_attributes(system: System) -> dict[str, str | float | int]:
    """Return the attributes of a result: parameters of contact, liquid and solution."""
    return {
        "viscosity_Pa_s": system.viscosity,
        "youngs_modulus_Pa": system.contact.youngs_modulus,
        "poisson_ratio": system.contact.poisson_ratio,
        "radius_m": system.contact.radius,
        "rough_body": system.factors.rough_body,
        "factors": system.factors.model,
        "cells": system.solver.cells,
        "domain": float(system.solver.domain),
        "inlet_length_m": np.inf if system.liquid.extent is None else system.liquid.extent,
        "area": system.solver.area,
        "work_of_adhesion_J_m2": system.growth.work_of_adhesion if system.growth else 0.0,
        "references": _REFERENCE,
        **_special_attributes(system),
    }


def _special_attributes(system: System) -> dict[str, str | float | int]:
    """Return attributes for settings that differ from the default, e.g. an elastic layer."""
    contact, liquid, factors = system.contact, system.liquid, system.factors
    balance = factors.roughness_balance
    settings = {
        "thickness_m": (contact.thickness, np.inf),
        "counter_modulus_Pa": (contact.counter_modulus, np.inf),
        "outlet": (liquid.outlet, "vented"),
        "cavity_pressure_Pa": (liquid.lowest_pressure, 0.0),
        "shear_thinning": (liquid.thinning.model if liquid.thinning else "", ""),
        "slide_roll_ratio": (2 * factors.slide, 2.0),
        "roughness_balance": (np.nan if balance is None else balance, np.nan),
    }
    return {name: value for name, (value, usual) in settings.items() if str(value) != str(usual)}


def with_adhesion(
    system: System, highest_load: float, work_of_adhesion: str | float | None
) -> System:
    """Return the system with the increase of contact area by adhesion, up to a load [N/m]."""
    if work_of_adhesion is None or system.psd is None:
        return system
    modulus = _stiffness(system)
    # margin: with a liquid film the peak pressure slightly exceeds the Hertz pressure
    highest = 1.5 * float(hertz_max_pressure(highest_load, system.contact))
    return system._replace(growth=adhesive_growth(system.psd, modulus, work_of_adhesion, highest))


def real_area(
    system: System, solid: np.ndarray, whole: np.ndarray, theory: AreaTheory
) -> np.ndarray:
    """Return the relative contact area at given contact and total pressures [Pa]."""
    if system.psd is None:
        return np.zeros_like(solid)
    area = contact_area_ratio(solid, system.psd, _stiffness(system), theory)
    return area if system.growth is None else system.growth(solid, whole, area)


def _stiffness(system: System) -> float:
    """Return E* of the rough contact [Pa], which differs from that of a strip of a ball."""
    return system.separation.effective_modulus if system.separation else np.nan
