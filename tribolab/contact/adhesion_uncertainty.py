"""How far the uncertainty of surface energies reaches into the adhesive contact area."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from tribolab.contact.adhesion import Pressure, finite_pressures, pressure_coords
from tribolab.contact.adhesion_balance import balance, parameters, rough_interface
from tribolab.contact.work_of_adhesion import (
    PDMS_PMMA_GLYCEROL,
    SurfaceEnergies,
    sample_work_of_adhesion,
    work_of_adhesion_spread,
)
from tribolab.quantities import stamp


def adhesion_uncertainty(
    pressure: str | Pressure,
    psd: xr.Dataset,
    effective_modulus: str | float,
    energies: SurfaceEnergies = PDMS_PMMA_GLYCEROL,
    *,
    samples: int = 1000,
    seed: int = 0,
    kappa: float = 0.4,
    c_a: float = 1.0,
    nodes: int = 200,
    max_iterations: int = 100,
) -> xr.Dataset:
    """Contact area with the spread that uncertain surface energies and contact angles give it.

    Parameters
    ----------
    pressure, psd, effective_modulus, kappa, c_a, nodes, max_iterations
        As for `adhesion`.
    energies
        Surface energies and contact angles with their bounds.
    samples, seed
        Number of random draws for the standard deviation, and their seed.

    Returns
    -------
    xarray.Dataset
        ``contact_area_ratio`` [1] (medium, dims of pressure) at the chosen values, ``_low`` and
        ``_high`` at the smallest and largest work of adhesion inside the bounds, ``_std`` over the
        random draws; the variables of `work_of_adhesion_spread` (medium).

    Raises
    ------
    AnalysisError
        As for `adhesion`.

    Notes
    -----
    The area grows with the work of adhesion, so the bounds on it are exact. Draws are read off a
    monotonic curve of area over work of adhesion, solved at 15 values or more. A liquid that wets
    (negative work of adhesion) gives the area without adhesion. The spread is that of the inputs;
    that Eqs. (11), (13) and (14) are approximations is not in it.
    """
    surface = rough_interface(psd, effective_modulus, kappa, c_a, nodes)
    over = finite_pressures(pressure)
    flat = over.values.ravel()
    spread = work_of_adhesion_spread(energies, samples=samples, seed=seed)
    names = ("work_of_adhesion", "work_of_adhesion_low", "work_of_adhesion_high")
    works = np.maximum(np.stack([spread[name].values for name in names]), 0.0)
    drawn = np.maximum(sample_work_of_adhesion(energies, samples, seed), 0.0)
    curve = np.union1d(works, np.linspace(works.min(), works.max(), 13))
    pushed = np.maximum(flat, surface.small_pressure)
    solved = balance(
        surface, np.tile(pushed, curve.size), np.repeat(curve, flat.size), max_iterations
    )
    share = np.where(solved.start > 0, 1.0, np.tile(flat / pushed, curve.size))
    area = (solved.area[:, -1] * share).reshape(curve.size, flat.size)
    reads = PchipInterpolator(curve, area, axis=0) if curve.size > 1 else None
    dims = ("medium", *over.dims)

    def at(work: np.ndarray) -> np.ndarray:
        return reads(work) if reads else np.broadcast_to(area, (*work.shape, flat.size))

    for name, work in zip(("", "_low", "_high"), works, strict=True):
        spread[f"contact_area_ratio{name}"] = (dims, at(work).reshape(2, *over.shape))
    spread["contact_area_ratio_std"] = (
        dims,
        at(drawn).std(axis=1, ddof=1).reshape(2, *over.shape),
    )
    return stamp(spread.assign_coords(pressure_coords(over)), **parameters(surface))
