"""Annuli of the wavenumber plane: joined where they know too little, and put on nodes."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.errors import AnalysisError
from tribolab.surface.abel import Annuli, PowerLaws
from tribolab.surface.moments import bin_integrals

CONFIDENCE = 0.95
_LARGEST_ERROR = 0.25  # relative standard error that an annulus may have
_TAIL_DECADES = 0.5
_PLATEAU = 3.0  # an annulus wider than this was joined, and is taken as flat


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
    weights = np.gradient(np.eye(q.size), np.log(q), axis=0)
    weights[-1] = tail
    edges = np.append(profile.wavenumber_low.values, profile.wavenumber_high.values[-1])
    offset = float(tail @ np.log(c / power))
    return PowerLaws(edges, power, weights @ np.log(c), weights, tail, offset), relative


def join(found: Annuli, relative: np.ndarray) -> tuple[Annuli, np.ndarray]:
    """Join neighbouring annuli until each is known well enough.

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

    Notes
    -----
    From the lowest one on, an annulus is joined with the fewest neighbours above that bring its
    standard error below 25 %; if none do, as in a short single scan, to within a fifth of the
    least that joining can reach.
    """
    ends, first, number = [0], 0, found.power.size
    while first < number:
        power = np.cumsum(found.power[first:])
        rows = np.cumsum(found.sensitivity[first:], axis=0) * relative
        with np.errstate(divide="ignore"):
            error = np.where(power > 0, np.sqrt((rows**2).sum(1)) / np.abs(power), np.inf)
        if not np.isfinite(error).any():
            break
        first += 1 + int(np.argmax(error <= max(_LARGEST_ERROR, 1.2 * error.min())))
        ends.append(first)
    if len(ends) == 1:
        raise AnalysisError(
            "psd_2d: no isotropic surface has such profiles, the inverse Abel transform of their "
            "spectrum is negative; average more scans, or check that the surface is isotropic"
        )
    ends[-1] = number  # what is left at the end has no power of its own
    starts = ends[:-1]
    joined = Annuli(
        found.edges[ends],
        np.add.reduceat(found.power, starts),
        np.add.reduceat(found.sensitivity, starts, axis=0),
        found.below,
        found.above,
    )
    error = np.sqrt(((joined.sensitivity * relative) ** 2).sum(1)) / np.abs(joined.power)
    return joined, error


def _node_values(annuli: Annuli) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Carry the mean over each annulus to its rms radius, along the local power law.

    The lowest annulus, where it was joined from several, is a plateau with a node at either end.

    Returns
    -------
    tuple of numpy.ndarray
        Wavenumbers [1/m], C [m4] there, and the annulus that each belongs to.
    """
    low, high, mean = annuli.edges[:-1], annuli.edges[1:], annuli.mean
    node, owner = np.sqrt(0.5 * (low**2 + high**2)), np.arange(mean.size)
    if mean.size > 1:
        slope = np.clip(np.gradient(np.log(mean), np.log(node)), -8.0, 1.0)
        left, right = (2 + slope) * np.log(low / node), (2 + slope) * np.log(high / node)
        flat = np.abs(2 + slope) < 1e-6
        area = (np.exp(right) - np.exp(left)) / np.where(flat, 1.0, 2 + slope)
        area = np.where(flat, np.log(high / low), area)
        value = mean * (high**2 - low**2) / (2 * node**2 * area)
    else:
        value = mean
    if high[0] > _PLATEAU * low[0]:
        node, owner = np.append(low[0], node), np.append(0, owner)
        node[1], value = high[0], np.concatenate([mean[:1], mean[:1], value[1:]])
    return node, value, owner


def _held(edges: np.ndarray, q: np.ndarray, c: np.ndarray) -> float:
    """Mean square height [m2] of the power laws between nodes, carried on to the last edge."""
    slope = np.log(c[-1] / c[-2]) / np.log(q[-1] / q[-2])
    grid, value = np.append(q, edges[-1]), np.append(c, c[-1] * (edges[-1] / q[-1]) ** slope)
    if edges[0] < q[0]:
        slope = np.log(c[1] / c[0]) / np.log(q[1] / q[0])
        grid = np.append(edges[0], grid)
        value = np.append(c[0] * (edges[0] / q[0]) ** slope, value)
    return float(2 * np.pi * bin_integrals(grid, value, 1).sum())


def _share(
    edges: np.ndarray, q: np.ndarray, c: np.ndarray, lowest: np.ndarray, whole: float
) -> float:
    """Factor on the lowest annulus with which the power laws hold the whole mean square height."""
    from scipy.optimize import brentq

    def excess(factor: float) -> float:
        return _held(edges, q, np.where(lowest, c * factor, c)) / whole - 1

    if excess(0.2) > 0 or excess(5.0) < 0:
        return 1.0
    return float(brentq(excess, 0.2, 5.0, xtol=1e-12, rtol=1e-12))


def spectrum(annuli: Annuli, error: np.ndarray) -> xr.Dataset:
    """Put the annuli on nodes, with their band.

    What the power laws between the nodes hold more or less than the annuli, at most some per
    cent and mostly beside the roll-off, the lowest annulus takes up: it is the least certain.
    """
    q, c, owner = _node_values(annuli)
    whole = float(annuli.power.sum())
    if q.size > 2:
        c = np.where(owner == 0, c * _share(annuli.edges, q, c, owner == 0, whole), c)
    low, high = confidence_band(c, 1 / error[owner] ** 2)
    result = xr.Dataset(
        {
            "psd_2d": ("wavenumber", c),
            "psd_2d_low": ("wavenumber", low),
            "psd_2d_high": ("wavenumber", high),
            "origin": ("wavenumber", np.zeros(q.size, np.int8)),
        },
        {"wavenumber": q},
    )
    held = _held(annuli.edges, q, c) if q.size > 1 else whole
    return result.assign_attrs(parseval_error_binned=abs(held / whole - 1))
