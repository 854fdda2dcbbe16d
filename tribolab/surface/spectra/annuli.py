"""Annuli of the wavenumber plane: merging of uncertain annuli, and conversion to nodes."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.surface.limits import MIN_INDEPENDENT_VALUES
from tribolab.surface.moments import bin_integrals
from tribolab.surface.self_affine import SelfAffine, psd_2d
from tribolab.surface.spectra.abel import Annuli, PowerLaws
from tribolab.surface.spectra.smooth_law import FittedLaw, smooth

_CONFIDENCE = 0.95
_LARGEST_ERROR = 0.25  # relative standard error below which an annulus is not merged further
_TAIL_DECADES = 0.5
_PLATEAU = 3.0  # if the ratio of its edges is larger, the first annulus results from a merge


def confidence_band(value: np.ndarray, independent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the 95 % band of a mean power: chi-square with two degrees of freedom per value.

    Below one independent value the quantiles approach zero. There the logarithm of the band widens
    with the standard error, starting at the band of one value.
    """
    # imported late: scipy loads slowly
    from scipy.special import chdtri

    counts = np.maximum(np.asarray(independent, dtype=float), MIN_INDEPENDENT_VALUES.value)
    freedom, widened = 2 * np.maximum(counts, 1.0), 1 / np.sqrt(np.minimum(counts, 1.0))
    outside = 0.5 * (1 - _CONFIDENCE)
    return (
        value * (freedom / chdtri(freedom, outside)) ** widened,
        value * (freedom / chdtri(freedom, 1 - outside)) ** widened,
    )


def bins_of(profile: xr.Dataset, fitted: FittedLaw) -> tuple[PowerLaws, PowerLaws, np.ndarray]:
    """Return the bins of a profile's spectrum as power laws, with their mean square heights.

    Parameters
    ----------
    profile
        Trusted part of the result of `psd_1d`.
    fitted
        Plateau and power law fitted to it by `fitted_law`.

    Returns
    -------
    tuple of PowerLaws, PowerLaws and numpy.ndarray
        The measured bins, with a tail fitted over the last half decade; bins of the smooth spectrum
        (see `smooth`); and the relative standard error of each bin.
    """
    q, c = profile.wavenumber.values, profile.psd_1d.values
    power = profile.mean_square_height.values
    relative = 1 / np.sqrt(profile.independent_values.values)
    near = q >= q[-1] / 10**_TAIL_DECADES
    near[-3:] = True
    weight = np.where(near, relative**-2.0, 0.0)
    x = np.log(q) - np.average(np.log(q), weights=weight)
    tail = weight * x / np.sum(weight * x**2)
    weights = np.asarray(np.gradient(np.eye(q.size), np.log(q), axis=0))
    weights[-1] = tail
    edges = np.append(profile.wavenumber_low.values, profile.wavenumber_high.values[-1])
    offset = float(tail @ np.log(c / power))
    typical = smooth(q, c, relative, fitted.law)
    measured, behind = (
        PowerLaws(edges, p, weights @ np.log(level), weights, tail, offset)
        for p, level in ((power, c), (power * typical / c, typical))
    )
    return measured, behind, relative


def merge_annuli(
    measured: Annuli, behind: Annuli, relative: np.ndarray
) -> tuple[Annuli, np.ndarray]:
    """Return annuli merged until each is accurate enough, and their relative standard errors.

    Parameters
    ----------
    measured
        Annuli with their sensitivities to the bins of C_1D.
    behind
        Annuli of the smooth spectrum of `smooth`, over the same edges.
    relative
        Relative standard error of C_1D in its bins.

    Returns
    -------
    tuple of Annuli and numpy.ndarray
        The remaining annuli (at least one), and their relative standard errors.

    Notes
    -----
    Starting with the lowest, an annulus is merged with the fewest neighbours above that bring its
    standard error below 25 %; if that is impossible, as in a short single scan, to within a fifth
    of the smallest possible error. The error is computed from the smooth spectrum: with the
    annulus's own power, merging would stop where that happens to be high, which biased the lowest
    annulus by 20 % and made its error too small.
    """
    ends, first, number = [0], 0, measured.power.size
    while first < number:
        typical, power = np.cumsum(behind.power[first:]), np.cumsum(measured.power[first:])
        rows = np.cumsum(behind.sensitivity[first:], axis=0) * relative
        known = (typical > 0) & (power > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            error = np.where(known, np.sqrt((rows**2).sum(1)) / np.abs(typical), np.inf)
        if not np.isfinite(error).any():
            break
        first += 1 + int(np.argmax(error <= max(_LARGEST_ERROR, 1.2 * error.min())))
        ends.append(first)
    if len(ends) == 1:
        raise AnalysisError(
            "no isotropic surface has such profiles, the inverse Abel transform of their "
            "spectrum is negative; average more scans, or check that the surface is isotropic",
            function="psd_2d",
        )
    ends[-1] = number  # the last annulus absorbs the remainder, which has no power of its own
    joined, smoothed = _merged_annuli(measured, ends), _merged_annuli(behind, ends)
    error = np.sqrt(((smoothed.sensitivity * relative) ** 2).sum(1)) / np.abs(smoothed.power)
    return joined, error


def _merged_annuli(annuli: Annuli, ends: list[int]) -> Annuli:
    """Return the annuli between those edges whose indices are in `ends`."""
    starts = ends[:-1]
    return Annuli(
        annuli.edges[ends],
        np.add.reduceat(annuli.power, starts),
        np.add.reduceat(annuli.sensitivity, starts, axis=0),
        annuli.below,
        annuli.above,
    )


def _node_values(
    annuli: Annuli, error: np.ndarray, fitted: FittedLaw
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return wavenumbers [1/m] (rms radii of the annuli), C [m4] there, and its relative error."""
    low, high, mean = annuli.edges[:-1], annuli.edges[1:], annuli.mean
    node = np.sqrt(0.5 * (low**2 + high**2))
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
        first = np.unique(np.clip([low[0], fitted.law.rolloff, high[0]], low[0], high[0]))
        grid = np.geomspace(low[0], high[0], 200)

        def shape(law: SelfAffine) -> np.ndarray:
            area = np.trapezoid(psd_2d(law, grid) * grid**2, np.log(grid))
            return np.log(psd_2d(law, first) * (high[0] ** 2 - low[0] ** 2) / (2 * area))

        node = np.concatenate([first, node[1:]])
        value = np.concatenate([mean[0] * np.exp(shape(fitted.law)), value[1:]])
        error = np.concatenate([np.hypot(error[0], fitted.spread(shape)), error[1:]])
    return node, value, error


def _mean_square(edges: np.ndarray, q: np.ndarray, c: np.ndarray) -> float:
    """Return the mean square height [m2] of power laws between nodes, up to the outermost edge."""
    slope = np.log(c[-1] / c[-2]) / np.log(q[-1] / q[-2])
    grid, value = np.append(q, edges[-1]), np.append(c, c[-1] * (edges[-1] / q[-1]) ** slope)
    if edges[0] < q[0]:
        slope = np.log(c[1] / c[0]) / np.log(q[1] / q[0])
        grid = np.append(edges[0], grid)
        value = np.append(c[0] * (edges[0] / q[0]) ** slope, value)
    return float(2 * np.pi * bin_integrals(grid, value, 1).sum())


def _balance_power(
    edges: np.ndarray, q: np.ndarray, c: np.ndarray, error: np.ndarray, whole: float
) -> np.ndarray:
    """Return C at the nodes, changed within its errors to conserve the mean square height [m2].

    With factors ``exp(s error^2)``: the smallest change in units of the standard errors.
    """
    # imported late: scipy loads slowly
    from scipy.optimize import brentq

    def excess(s: float) -> float:
        return _mean_square(edges, q, c * np.exp(s * error**2)) / whole - 1

    most = 1.6 / float(error.max() ** 2)  # so that C changes by a factor of five at most
    if excess(-most) > 0 or excess(most) < 0:
        return c
    return c * np.exp(brentq(excess, -most, most, xtol=1e-12 * most, rtol=1e-12) * error**2)


def annular_spectrum(annuli: Annuli, error: np.ndarray, fitted: FittedLaw) -> xr.Dataset:
    """Return the spectrum with one node for each annulus, and its confidence band.

    The mean square height of the power laws between nodes differs from that of the annuli by a few
    per cent, mostly near the roll-off. The difference is distributed over all nodes, mostly to the
    least certain ones.
    """
    q, c, error = _node_values(annuli, error, fitted)
    whole = float(annuli.power.sum())
    if q.size > 2:
        c = _balance_power(annuli.edges, q, c, error, whole)
    low, high = confidence_band(c, 1 / error**2)
    result = xr.Dataset(
        {
            "psd_2d": ("wavenumber", c),
            "psd_2d_low": ("wavenumber", low),
            "psd_2d_high": ("wavenumber", high),
            "origin": ("wavenumber", np.zeros(q.size, np.int8)),
        },
        {"wavenumber": q},
    )
    binned = _mean_square(annuli.edges, q, c) if q.size > 1 else whole
    return result.assign_attrs(parseval_error_binned=abs(binned / whole - 1))
