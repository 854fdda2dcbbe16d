"""Annuli of the wavenumber plane: joined where they know too little, and put on nodes."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.surface.abel import Annuli, PowerLaws
from tribolab.surface.moments import bin_integrals

CONFIDENCE = 0.95
_LARGEST_ERROR = 0.25  # relative standard error that an annulus may have
_TAIL_DECADES = 0.5
_SWEEPS = 30


def confidence_band(
    value: np.ndarray, independent: np.ndarray, confidence: float = CONFIDENCE
) -> tuple[np.ndarray, np.ndarray]:
    """Band of a mean power: that of a chi-square variable with two degrees of freedom a value."""
    from scipy.special import chdtri

    freedom = 2 * np.asarray(independent)
    outside = 0.5 * (1 - confidence)
    return (
        value * freedom / chdtri(freedom, outside),
        value * freedom / chdtri(freedom, 1 - outside),
    )


def bins_of(profile: xr.Dataset) -> tuple[PowerLaws, np.ndarray]:
    """Bins of a profile's spectrum as power laws that hold each bin's mean square height.

    Parameters
    ----------
    profile
        Trusted part of what `psd_1d` gave.

    Returns
    -------
    tuple of PowerLaws and numpy.ndarray
        The bins, whose tail is fitted over the last half decade, and the relative standard error
        of each.
    """
    q, c = profile.wavenumber.values, profile.psd_1d.values
    power = profile.mean_square_height.values
    relative = 1 / np.sqrt(profile.independent_values.values)
    near = q >= q[-1] / 10**_TAIL_DECADES
    near[-3:] = True
    weight = np.where(near, relative**-2.0, 0.0)
    x = np.log(q) - np.average(np.log(q), weights=weight)
    tail = weight * x / np.sum(weight * x**2)
    slope = np.gradient(np.log(c), np.log(q))
    slope[-1] = tail @ np.log(c)
    edges = np.append(profile.wavenumber_low.values, profile.wavenumber_high.values[-1])
    return PowerLaws(edges, power, slope, tail, float(tail @ np.log(c / power))), relative


def join(found: Annuli, relative: np.ndarray) -> tuple[Annuli, np.ndarray]:
    """Join neighbouring annuli until the standard error of each is below 25 %.

    Parameters
    ----------
    found
        Annuli with their sensitivities to the bins of C_1D.
    relative
        Relative standard error of C_1D in its bins.

    Returns
    -------
    tuple of Annuli and numpy.ndarray
        The annuli that are left (at least one), and their relative standard errors.
    """
    edges, power, sensitivity = [found.edges[0]], [], []
    mass, rows = 0.0, np.zeros(relative.size)
    for upper, more, row in zip(found.edges[1:], found.power, found.sensitivity, strict=True):
        mass, rows = mass + more, rows + row
        if np.sqrt(np.sum((rows * relative) ** 2)) <= _LARGEST_ERROR * mass:
            edges.append(upper)
            power.append(mass)
            sensitivity.append(rows)
            mass, rows = 0.0, np.zeros(relative.size)
    if not power:
        edges, power, sensitivity = [edges[0], found.edges[-1]], [mass], [rows]
    elif edges[-1] < found.edges[-1]:
        edges[-1] = found.edges[-1]
        power[-1] += mass
        sensitivity[-1] = sensitivity[-1] + rows
    joined = Annuli(
        np.array(edges), np.array(power), np.array(sensitivity), found.below, found.above
    )
    error = np.sqrt(((joined.sensitivity * relative) ** 2).sum(1)) / np.abs(joined.power)
    return joined, error


def on_nodes(edges: np.ndarray, mean: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Carry the mean over each annulus to its rms radius, along the local power law.

    Returns
    -------
    tuple of numpy.ndarray
        Wavenumbers [1/m] and C [m4] there.
    """
    low, high = edges[:-1], edges[1:]
    node = np.sqrt(0.5 * (low**2 + high**2))
    if mean.size < 2:
        return node, mean
    slope = np.clip(np.gradient(np.log(mean), np.log(node)), -8.0, 1.0)
    left, right = (2 + slope) * np.log(low / node), (2 + slope) * np.log(high / node)
    with np.errstate(invalid="ignore"):
        area = np.where(
            np.abs(2 + slope) < 1e-6,
            np.log(high / low),
            (np.exp(right) - np.exp(left)) / (2 + slope),
        )
    return node, mean * (high**2 - low**2) / (2 * node**2 * area)


def _conserving(edges: np.ndarray, power: np.ndarray, q: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Nudge C at the nodes until the power laws between them hold the annuli's mean square height.

    Smoothed over three annuli, so that the noise of single ones is not amplified.
    """
    if q.size < 3:
        return c

    def smooth(values: np.ndarray) -> np.ndarray:
        padded = np.concatenate([values[:1], values, values[-1:]])
        return 0.25 * padded[:-2] + 0.5 * padded[1:-1] + 0.25 * padded[2:]

    for _ in range(_SWEEPS):
        grid, value = _with_edges(edges, q, c)
        held = 2 * np.pi * bin_integrals(grid, value, 1)
        held = held[0::2] + held[1::2]
        c = c * smooth(power) / smooth(held)
    return c


def _with_edges(edges: np.ndarray, q: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and edges in turn, the ends carried on along the outermost power laws."""
    grid = np.empty(2 * q.size + 1)
    grid[0::2], grid[1::2] = edges, q
    log_q, log_c = np.log(q), np.log(c)
    value = np.interp(np.log(grid), log_q, log_c)
    slope = (log_c[-1] - log_c[-2]) / (log_q[-1] - log_q[-2])
    value[-1] = log_c[-1] + slope * (np.log(grid[-1]) - log_q[-1])
    return grid, np.exp(value)


def spectrum(annuli: Annuli, error: np.ndarray) -> xr.Dataset:
    """Return the annuli as a spectrum with its band."""
    q, c = on_nodes(annuli.edges, annuli.mean)
    c = _conserving(annuli.edges, annuli.power, q, c)
    low, high = confidence_band(c, 1 / error**2)
    result = xr.Dataset(
        {
            "psd_2d": ("wavenumber", c),
            "psd_2d_low": ("wavenumber", low),
            "psd_2d_high": ("wavenumber", high),
            "mean_square_height": ("wavenumber", annuli.power),
            "origin": ("wavenumber", np.zeros(q.size, np.int8)),
        },
        {
            "wavenumber": q,
            "wavenumber_low": ("wavenumber", annuli.edges[:-1]),
            "wavenumber_high": ("wavenumber", annuli.edges[1:]),
        },
    )
    held = 2 * np.pi * bin_integrals(*_with_edges(annuli.edges, q, c), 1).sum() if q.size > 1 else 0
    return result.assign_attrs(parseval_error_binned=abs(float(held / annuli.power.sum()) - 1))
