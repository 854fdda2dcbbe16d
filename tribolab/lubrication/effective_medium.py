"""Flow and drag averaged over a distribution of gaps, by effective-medium theory."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.contact.gap import gap_distributions
from tribolab.contact.separation import Separation


def medium_averages(
    u: np.ndarray,
    pressure_of: Separation,
    psd: xr.Dataset,
    percolation: float,
    cutoff: float,
    gamma: float,
) -> tuple[np.ndarray, ...]:
    """Return phi_p, phi_fp, phi_fs and phi_f at mean separations u [m], averaged over the gaps."""
    pressure = pressure_of.pressure(u)
    flow, plain = gap_distributions(pressure, psd, 1.0, ("flow", "plain"), gamma, cutoff, points=8)
    gap, weight = flow["gap"].values, flow["gap_weight"].values
    touching = flow["contact_area_ratio"].values
    # normalise by the quadrature's own sums, so that their errors cancel in phi - 1
    total = weight.sum(axis=1) + touching
    weight, touching = weight / total[:, None], touching / total
    mean = weight @ gap
    dimension = 1 / (1 - percolation)
    conductance = _effective_conductance(gap**3, weight, touching, dimension)
    denominator = gap**3 + (dimension - 1) * conductance[:, None]
    entrained = dimension * conductance * (weight * gap / denominator).sum(axis=1)
    # gaps below the cut-off contain no fluid; the conductance D is u^3 below percolation
    fluid = np.where(gap >= cutoff, weight, 0.0)
    moved = gap * (gap - entrained[:, None]) / denominator
    correction = 3 * mean * (fluid * moved).sum(axis=1)
    wide, share = plain["gap"].values, plain["gap_weight"].values
    share = share / (share.sum(axis=1) + plain["contact_area_ratio"].values)[:, None]
    inverse = (share @ wide) * np.where(wide >= cutoff, share / wide, 0.0).sum(axis=1)
    return conductance / mean**3, entrained / mean, correction, inverse


def _effective_conductance(
    local: np.ndarray, weight: np.ndarray, touching: np.ndarray, dimension: float
) -> np.ndarray:
    """Return the effective conductance s_e from 1 = <d s_e/D>; 0 if flow channels are closed."""

    def excess(log_s: np.ndarray) -> np.ndarray:
        s = np.exp(log_s)[:, None]
        part = (weight * dimension * s / (local + (dimension - 1) * s)).sum(axis=1)
        return part + touching * dimension / (dimension - 1) - 1

    low = np.full(touching.shape, np.log(local[0]) - 60.0)
    high = np.full(touching.shape, np.log(local[-1]))
    opens = touching < (dimension - 1) / dimension
    for _ in range(70):
        middle = (low + high) / 2
        above = excess(middle) > 0
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.where(opens, np.exp((low + high) / 2), 0.0)
