"""What Stribeck curves and film profiles share: checked inputs, and what results say of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.contact.adhesive_growth import adhesive_growth
from tribolab.contact.area import AreaTheory, check_area
from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import hertz_max_pressure
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
from tribolab.lubrication.speeds import System
from tribolab.stamping import labelled
from tribolab.units import positive, to_si

CELLS = 160
PROOF = ("residual", "load_balance", "flux_variation", "iterations")  # of every point
_REFERENCE = (
    "R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, Adhesion-controlled sliding and the "
    "Stribeck curve in hydrophobic soft contacts (2026), Eqs. (3)-(10)"
)


def system_of(
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
    """Collect what all speeds and loads share; the arguments are those of `stribeck_curve`.

    Raises
    ------
    AnalysisError
        If a number of cells, a domain, a theory or a body is not one of those allowed.
    """
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


def checked_loads(load: str | ArrayLike) -> xr.DataArray:
    """Return loads per length [N/m] (load); AnalysisError if one is not above zero."""
    loads = labelled(load, "load")
    if loads.ndim > 1 or not np.all((loads.values > 0) & np.isfinite(loads.values)):
        raise AnalysisError(f"load: positive, finite values in N/m are wanted; got {loads.values}")
    return loads


def checked_speeds(speed: str | ArrayLike, psd: xr.Dataset | None) -> xr.DataArray:
    """Return sliding speeds [m/s] (sliding_speed); AnalysisError if one has no film."""
    speeds = labelled(speed, "sliding_speed")
    if speeds.ndim == 0:
        speeds = speeds.expand_dims("sliding_speed")
    if speeds.ndim > 1 or speeds.size == 0 or not np.all(np.isfinite(speeds.values)):
        raise AnalysisError("speed: a list of finite sliding speeds in m/s is wanted")
    if psd is None and np.any(speeds.values == 0):
        raise AnalysisError("speed: at 0 no film is left between smooth surfaces; leave it out")
    return speeds


def system_attributes(system: System) -> dict[str, str | float | int]:
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
        "references": _REFERENCE,
    }


def with_adhesion(
    system: System, highest_load: float, work_of_adhesion: str | float | None
) -> System:
    """Return the system with what adhesion adds to its contact area up to a load [N/m]."""
    if work_of_adhesion is None or system.psd is None:
        return system
    modulus = system.contact.effective_modulus
    # a film's pressure peaks a little above that of Hertz
    highest = 1.5 * float(hertz_max_pressure(highest_load, system.contact))
    return system._replace(growth=adhesive_growth(system.psd, modulus, work_of_adhesion, highest))


def real_area(
    system: System, solid: np.ndarray, whole: np.ndarray, theory: AreaTheory
) -> np.ndarray:
    """Relative contact area at the solid's pressure and the whole one [Pa]."""
    if system.psd is None:
        return np.zeros_like(solid)
    area = contact_area_ratio(solid, system.psd, system.contact.effective_modulus, theory)
    return area if system.growth is None else system.growth(solid, whole, area)
