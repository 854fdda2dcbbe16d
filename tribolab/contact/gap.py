"""Probability distribution of the interfacial gap of a rough contact, and averages over it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.special import erf

from tribolab.arrays.broadcasting import over_dims
from tribolab.contact.persson import (
    ROOT_PI,
    coarse_tail,
    mean_separation,
    pressure_values,
    rough_band,
)
from tribolab.core.errors import AnalysisError, nearest, shown
from tribolab.core.validity import examine
from tribolab.surface.moments import cumulative_at, rms_slope
from tribolab.units.conversion import positive
from tribolab.units.stamping import labelled, stamp

GapVariant = Literal["flow", "plain"]
_PER_DECADE = 20  # number of magnifications per decade
COMPLETE = 1e-2  # ratio of mean separation to cut-off, below which the contact is complete
_FRONT = 0.01  # share of the open area that opens first, where u1 = d(u A)/dA is nearly 0/0
_MAX_HEIGHTS = 8.0  # distance from the mean, in rms heights, beyond which a Gaussian is negligible
_NEGLIGIBLE = 1e-9  # share of the open area that may be neglected
_LUMP = 1e-4  # upper end of the first cell of the gap, relative to the cut-off
_PANELS, _POINTS = 2, 16  # panels per decade of u, Gauss-Legendre points per panel


class _Openings(NamedTuple):
    """Area that opens at each step of magnification, with its mean gap and rms roughness."""

    share: np.ndarray  # share of the nominal area (pressure, bin)
    gap: np.ndarray  # mean gap u1 [m] (pressure, bin)
    height: np.ndarray  # rms height of finer roughness [m] (pressure, bin)


@over_dims(psd=("wavenumber",))
def gap_distribution(
    pressure: str | ArrayLike | xr.DataArray,
    psd: xr.Dataset,
    effective_modulus: str | float,
    variant: GapVariant = "flow",
    gamma: float = 0.45,
    cutoff: str | float = 1e-9,
) -> xr.Dataset:
    """Return the probability distribution P(u) of the gap in the area without contact.

    Parameters
    ----------
    pressure
        Nominal pressure [Pa] (any dims), above zero; text with a unit if scalar. The dim of a
        bare array is called ``pressure``.
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber), or of several surfaces with further dims,
        which become dims of the result.
    effective_modulus
        E* [Pa].
    variant
        ``"flow"`` narrows every Gaussian to ``h_eff^-2 = h_rms^-2 + u1^-2``, for averages in flow;
        ``"plain"`` keeps h_rms, for <1/u>. These choices agree best with boundary-element results.
    gamma
        Elastic-energy reduction factor [1] of the mean separation.
    cutoff
        Gap [m] that is an edge of the grid, so that averages can omit smaller gaps.

    Returns
    -------
    xarray.Dataset
        Over the dims of `pressure` and a common grid ``gap`` [m]: ``gap_density`` P(u) [1/m]
        without its delta at u = 0, ``gap_weight`` [1] for sums over f(u), and over the dims of
        `pressure` ``contact_area_ratio`` (the weight of that delta), ``separation`` [m] and
        ``gap_scale`` [1], the factor that makes <u> equal to the separation. The weights sum to 1 -
        A/A0, and ``gap_weight * gap`` to the separation, within 1e-4.

    Raises
    ------
    AnalysisError
        If a pressure is not above zero and finite, the variant is unknown, the surface has no
        roughness, or the contact is complete.

    Notes
    -----
    ``P(u) = int (-dA/A0) [g(u - u1) + g(u + u1)] + (A/A0) delta(u)`` with g a Gaussian of the
    unresolved roughness, and ``u1 = d(u A)/dA``, u(zeta) being the separation at pressure p
    A0/A(zeta) on that roughness [1]_. At the longest wavelengths almost no area opens although
    u(zeta) already decreases, so that u1 diverges; in the first 1 % of the open area, u1 is
    therefore limited to its value at the end of that 1 %. All u are then multiplied by one factor
    so that <u> is the mean separation. Up to A/A0 = 0.13 the limit changes <u^3> by 1 % and <1/u>
    by 0.1 %; beyond percolation <u^3> is uncertain by a factor of two.

    References
    ----------
    .. [1] A. Almqvist, C. Campana, N. Prodanov, B. N. J. Persson, J. Mech. Phys. Solids 59, 2355
       (2011). doi:10.1016/j.jmps.2011.08.004

    Examples
    --------
    >>> q, c = [1e3, 1e5, 1e8], [1e-22, 1e-22, 1e-34]
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, coords={"wavenumber": q})
    >>> gaps = gap_distribution("0.04 MPa", psd, "2 MPa")
    >>> share = float(gaps.gap_weight.sum() + gaps.contact_area_ratio)
    >>> round(share, 3), bool(gaps.contact_area_ratio < 0.05)
    (1.0, True)
    """
    return gap_distributions(pressure, psd, effective_modulus, (variant,), gamma, cutoff)[0]


def gap_distributions(
    pressure: str | ArrayLike | xr.DataArray,
    psd: xr.Dataset,
    effective_modulus: str | float,
    variants: Sequence[GapVariant] = ("flow", "plain"),
    gamma: float = 0.45,
    cutoff: str | float = 1e-9,
    points: int = _POINTS,
) -> list[xr.Dataset]:
    """Return several variants of `gap_distribution`, with shared intermediate results.

    `points` is the number of gaps per half decade of u; half the default suffices for mean
    separations up to some ten h_rms.
    """
    for variant in variants:
        if variant not in ("flow", "plain"):
            known = nearest(variant, ["flow", "plain"])
            raise AnalysisError(f"variant: '{shown(variant)}' is not one{known}")
    modulus = positive(effective_modulus, "Pa", "effective_modulus")
    over = labelled(pressure, "pressure")
    values = pressure_values(over).ravel()
    if not np.all((values > 0) & (values < np.inf)):
        raise AnalysisError(
            "pressure: the gap has a distribution only at pressures above zero and finite; got "
            f"{np.min(values):g} Pa"
        )
    mean = np.atleast_1d(mean_separation(values, psd, modulus, gamma))
    openings, area = _openings(values / modulus, *rough_band(psd), gamma)
    smallest = positive(cutoff, "m", "cutoff")
    closed = mean < COMPLETE * smallest
    if np.any(closed):
        raise AnalysisError(
            f"pressure: at {values[closed].min():.4g} Pa the contact is complete, its mean "
            f"separation {mean[closed].max():.2g} m; no gap is left: leave such pressures out"
        )
    facts: dict[str, str | float] = {"gamma": gamma, "cutoff_m": smallest}
    facts |= examine("gap_distribution", slope=rms_slope(psd))
    return [
        stamp(
            _distribution(over, mean, openings, area, variant, smallest, points),
            variant=variant,
            **facts,
        )
        for variant in variants
    ]


def _distribution(
    over: xr.DataArray,
    mean: np.ndarray,
    openings: _Openings,
    area: np.ndarray,
    variant: GapVariant,
    cutoff: float,
    points: int,
) -> xr.Dataset:
    """Return the gap density at each pressure on a grid of gaps, for a given mean separation."""
    if variant == "flow":
        height = openings.height * openings.gap / np.hypot(openings.height, openings.gap)
        openings = openings._replace(height=height)
    scale = mean / _folded_mean(openings)
    openings = openings._replace(
        gap=openings.gap * scale[:, None], height=openings.height * scale[:, None]
    )
    gap, step = _grid(openings, cutoff, points)
    density = np.stack(
        [_density(gap, step[0], *(part[i] for part in openings)) for i in range(mean.size)]
    )
    shape, dims = over.shape, over.dims
    return xr.Dataset(
        {
            "gap_density": ((*dims, "gap"), density.reshape(*shape, -1)),
            "gap_weight": ((*dims, "gap"), (density * step).reshape(*shape, -1)),
            "contact_area_ratio": (dims, area.reshape(shape)),
            "separation": (dims, mean.reshape(shape)),
            "gap_scale": (dims, scale.reshape(shape)),
        },
        coords={**over.coords, "gap": ("gap", gap)},
    )


def _openings(
    stiffness: np.ndarray, q: np.ndarray, spectrum: np.ndarray, gamma: float
) -> tuple[_Openings, np.ndarray]:
    """Return the area that opens between successive magnifications, and the area in contact.

    On a panel of wavenumbers 1/q is averaged over the slope, from exact moments, so that a coarse
    grid of magnifications represents a noisy spectrum.
    """
    count = int(np.ceil(np.log10(q[-1] / q[0]) * _PER_DECADE)) + 1
    nodes = np.geomspace(q[0], q[-1], max(count, 20)).clip(q[0], q[-1])
    height2, inverse, slope2 = (cumulative_at(nodes, q, spectrum, n) for n in (1, 2, 3))
    height2 = 2 * np.pi * np.maximum(height2[-1] - height2, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean_inverse = np.nan_to_num(np.diff(inverse) / np.diff(slope2), posinf=0.0)
        area = erf(stiffness[:, None] / (ROOT_PI * np.sqrt(slope2)))
        gap = _nested_separation(stiffness[:, None] / area, slope2, mean_inverse, gamma)
        share = area[:, :-1] - area[:, 1:]
        opened = np.maximum(-np.diff(gap * area), 0) / share
    opened = np.nan_to_num(opened, posinf=0.0)
    middle = np.cumsum(share, axis=1) - share / 2
    for gaps, at, open_area in zip(opened, middle, 1 - area[:, -1], strict=True):
        np.minimum(gaps, np.interp(_FRONT * open_area, at, gaps), out=gaps)
    height = np.broadcast_to(np.sqrt((height2[1:] + height2[:-1]) / 2), share.shape)
    return _Openings(share, opened, height), area[:, -1]


def _nested_separation(
    stiffness: np.ndarray, slope2: np.ndarray, mean_inverse: np.ndarray, gamma: float
) -> np.ndarray:
    """Return the mean separation [m] due to roughness finer than each magnification."""
    size = slope2.size
    row, panel = np.triu_indices(size - 1)
    start, stop = (np.sqrt(np.maximum(slope2[panel + i] - slope2[row], 0)) for i in (0, 1))
    t = np.array([-1, 1]) / np.sqrt(3)  # two Gauss points per panel of the rms slope s
    slope = (start + stop) / 2 + (stop - start) / 2 * t[:, None]
    weight = (stop - start) * mean_inverse[panel]
    first = np.flatnonzero(np.diff(row, prepend=-1))
    result = np.zeros_like(stiffness)
    with np.errstate(divide="ignore"):
        log_slope = np.log(slope)
    for i, log_stiffness in enumerate(np.log(stiffness / ROOT_PI)):
        value = weight * coarse_tail(log_stiffness[row] - log_slope, gamma).sum(axis=0)
        result[i, :-1] = np.add.reduceat(value, first)
    return result


def _folded_mean(openings: _Openings) -> np.ndarray:
    """Return the mean of |u| over all openings, for u normally distributed around its mean u1."""
    share, gap, height = openings
    with np.errstate(divide="ignore", invalid="ignore"):
        z = np.nan_to_num(gap / (np.sqrt(2) * height), posinf=np.inf)
    folded = np.sqrt(2 / np.pi) * height * np.exp(-(np.minimum(z, 27.0) ** 2)) + gap * erf(z)
    return (share * folded).sum(axis=-1)


def _grid(openings: _Openings, cutoff: float, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return gaps and steps: one cell from 0 to `_LUMP` cut-offs, then equal steps in ln u.

    Waves much shorter than the typical gap open by less than an atomic distance. The first cell
    contains their share of the area exactly, so that the grid need not resolve them.
    """
    widest = np.max((openings.gap + 8 * openings.height)[openings.share > 0])
    low = round(np.log10(_LUMP) * _PANELS)
    high = max(int(np.ceil(np.log10(widest / cutoff) * _PANELS)), low + 1)
    edges = cutoff * 10 ** (np.arange(low, high + 1) / _PANELS)
    t, weight = np.polynomial.legendre.leggauss(points)
    half = np.diff(np.log(edges))[:, None] / 2
    gap = np.exp(np.log(edges[:-1, None]) + half * (1 + t))
    return (
        np.insert(gap.ravel(), 0, edges[0] / 2),
        np.insert((half * weight * gap).ravel(), 0, edges[0]),
    )


def _bell(z: np.ndarray) -> np.ndarray:
    """Return exp(-z^2/2), computed in place."""
    np.multiply(z, z, out=z)
    np.multiply(z, -0.5, out=z)
    return np.exp(z, out=z)


def _density(
    at: np.ndarray, first: float, share: np.ndarray, gap: np.ndarray, height: np.ndarray
) -> np.ndarray:
    """Return the probability density at gaps: folded Gaussians, averaged over the first cell."""
    some = share > _NEGLIGIBLE * share.sum()
    share, gap, height = share[some], gap[some], np.maximum(height[some], 1e-3 * first)
    narrow, b = 1 / height, gap / height
    factor = share * narrow / np.sqrt(2 * np.pi)
    density = np.zeros_like(at)
    ends = (first + gap) * narrow / np.sqrt(2), (first - gap) * narrow / np.sqrt(2)
    density[0] = share @ (erf(ends[0]) + erf(ends[1])) / (2 * first)
    # single precision is twice as fast, and accurate to 1e-6
    last = int(np.searchsorted(at, np.max(gap + _MAX_HEIGHTS * height)))
    unit = factor.max()
    factor, b = (factor / unit).astype(np.float32), b.astype(np.float32)
    a = np.multiply.outer(at[1:last].astype(np.float32), narrow.astype(np.float32))
    near = np.flatnonzero(b < _MAX_HEIGHTS)  # Gaussians that extend to u < 0 are folded back
    back = _bell(a[:, near] + b[near]) @ factor[near]
    a -= b
    density[1:last] = unit * (_bell(a) @ factor + back)
    return density
