"""Uncertainty of the adhesive contact area due to uncertain surface energies."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from tribolab.arrays.broadcasting import over_dims
from tribolab.contact.adhesion_balance import balance, parameters, rough_interface
from tribolab.contact.adhesive_contact import AnyPressure, finite_pressures, pressure_coords
from tribolab.contact.work_of_adhesion import (
    PDMS_PMMA_GLYCEROL,
    SurfaceEnergies,
    sample_work_of_adhesion,
    work_of_adhesion_spread,
)
from tribolab.core.validity import TINY, examine
from tribolab.surface.moments import rms_slope
from tribolab.units.stamping import stamp


@over_dims(psd=("wavenumber",))
def adhesion_uncertainty(
    pressure: str | AnyPressure,
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
    """Return the contact area with its spread due to uncertain surface energies and contact angles.

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
        random draws; ``macroscopic_work_of_adhesion`` [J/m2] (medium) at vanishing load, with
        ``_low`` and ``_high`` (if only ``_low`` is zero, the surface energies do not determine
        whether there is a pull-off force); and the variables of `work_of_adhesion_spread` (medium).

    Raises
    ------
    AnalysisError
        As for `adhesion`.

    Notes ----- The area increases with the work of adhesion, so its bounds are exact. The area of
    each draw is interpolated on a monotonic curve of area over work of adhesion, solved at 15
    values or more. A wetting liquid (negative work of adhesion) gives the area without adhesion.
    The spread is due to the inputs only; it does not include the approximations of Eqs. (11), (13)
    and (14).

    Examples
    --------
    >>> from tribolab.studies import xu2026
    >>> psd = xu2026.psd("Sb-S", points=301)
    >>> spread = adhesion_uncertainty("0.04 MPa", psd, "2 MPa", samples=20, nodes=60)
    >>> names = ["contact_area_ratio_low", "contact_area_ratio", "contact_area_ratio_high"]
    >>> [round(float(spread[name].sel(medium="wet")), 2) for name in names]
    [0.1, 0.12, 0.12]
    """
    surface = rough_interface(psd, effective_modulus, kappa, c_a, nodes)
    over: xr.DataArray = finite_pressures(pressure)
    flat = over.values.ravel()
    spread = work_of_adhesion_spread(energies, samples=samples, seed=seed)
    endings = ("", "_low", "_high")
    works = np.stack([spread[f"work_of_adhesion{ending}"].values for ending in endings]).clip(0)
    drawn = sample_work_of_adhesion(energies, samples, seed).clip(0)
    curve = np.union1d(works, np.linspace(works.min(), works.max(), 13))

    # the limit p -> 0 is solved together with the given pressures
    pushed = np.append(np.maximum(flat, surface.small_pressure), surface.small_pressure)
    solved = balance(
        surface, np.tile(pushed, curve.size), np.repeat(curve, pushed.size), max_iterations
    )
    table = (curve.size, pushed.size)
    sticks = solved.start.reshape(table)[:, :-1] > 0
    area = solved.area[:, -1].reshape(table)[:, :-1] * np.where(sticks, 1.0, flat / pushed[:-1])
    macroscopic = solved.binding[:, 0].reshape(table)[:, -1]

    def read(values: np.ndarray, at: np.ndarray) -> np.ndarray:
        if curve.size == 1:
            return np.broadcast_to(values[0], (*at.shape, *values.shape[1:]))
        return PchipInterpolator(curve, values, axis=0)(at)

    dims = ("medium", *over.dims)
    for ending, work in zip(endings, works, strict=True):
        areas = read(area, work).reshape(2, *over.shape)
        spread[f"contact_area_ratio{ending}"] = (dims, areas)
        at_rest = macroscopic[np.searchsorted(curve, work)]
        spread[f"macroscopic_work_of_adhesion{ending}"] = ("medium", at_rest)
    deviation = read(area, drawn).std(axis=1, ddof=1).reshape(2, *over.shape)
    spread["contact_area_ratio_std"] = (dims, deviation)
    binding = macroscopic / np.maximum(curve, TINY)
    valid = examine("adhesion_uncertainty", slope=rms_slope(psd), binding=binding)
    return stamp(spread.assign_coords(pressure_coords(over)), **valid, **parameters(surface))
