"""Inverse Abel transform: from the spectrum of profiles to that of the isotropic surface."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import bin_integrals

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True)
class PowerLaws:
    """Two-sided profile spectrum C_1D, as a power law in each bin; it may jump between bins.

    Parameters
    ----------
    edges
        Edges of the bins [1/m], increasing (bin + 1).
    power
        Mean square height [m2] in each bin, negative wavenumbers included (bin).
    slope
        ``d ln C_1D / d ln k`` in each bin (bin).
    slope_weights
        Derivative of `slope` by the logarithms of the bins' powers (bin, bin); without it the
        slopes are exact.
    tail
        Weights from which the slope of the tail is computed: ``sum(weights * ln power)`` plus
        `tail_offset`. By default the tail has the slope of the last bin.
    tail_offset
        See `tail`.
    """

    edges: np.ndarray
    power: np.ndarray
    slope: np.ndarray
    slope_weights: np.ndarray | None = None
    tail: np.ndarray | None = None
    tail_offset: float = 0.0

    @property
    def level(self) -> np.ndarray:
        """C_1D at the left edge of each bin [m3]."""
        left, right = self.edges[:-1], self.edges[1:]
        z = (1 + self.slope) * np.log(right / left)
        small = np.abs(z) < 1e-9
        growth = np.where(small, 1.0, np.expm1(z) / np.where(small, 1.0, z))
        return 0.5 * self.power / (left * np.log(right / left) * growth)

    @property
    def last(self) -> float:
        """C_1D at the right edge of the last bin [m3], where the extrapolated tail starts."""
        return float(self.level[-1] * (self.edges[-1] / self.edges[-2]) ** self.slope[-1])

    @property
    def exponent(self) -> float:
        """Exponent s of the extrapolated tail, ``C_1D ~ k^-s``."""
        if self.tail is None:
            return -float(self.slope[-1])
        return -float(self.tail @ np.log(self.power)) - self.tail_offset


@dataclass(frozen=True)
class Annuli:
    """Mean square heights of annuli (rings) in the plane of wavenumbers.

    Parameters
    ----------
    edges
        Edges q_e of the annuli [1/m].
    power
        Mean square height [m2] of each annulus, ``2 pi int q C dq``.
    sensitivity
        Derivative of `power` by the logarithm of the power of each bin of C_1D (annulus, bin).
    below, above
        Mean square height [m2] below the first edge and above the last one.
    """

    edges: np.ndarray
    power: np.ndarray
    sensitivity: np.ndarray
    below: float
    above: float

    @property
    def mean(self) -> np.ndarray:
        """Mean of C in each annulus [m4]."""
        return self.power / (np.pi * np.diff(self.edges**2))


def power_laws_between(wavenumber: ArrayLike, psd_1d: ArrayLike) -> PowerLaws:
    """Return a two-sided C_1D [m3], given at nodes, as power laws between them."""
    k, c = np.asarray(wavenumber, dtype=float), np.asarray(psd_1d, dtype=float)
    slope = np.diff(np.log(c)) / np.diff(np.log(k))
    return PowerLaws(k, 2 * bin_integrals(k, c, 0), slope)


def invert(profile: PowerLaws, edges: ArrayLike | None = None) -> Annuli:
    """Return the 2D spectrum averaged over annuli, from the two-sided spectrum of profiles.

    Parameters
    ----------
    profile
        C_1D in bins.
    edges
        Edges [1/m] of the annuli, increasing; by default those of the bins.

    Returns
    -------
    Annuli
        Mean square heights of the annuli, with their sensitivities.

    Raises
    ------
    AnalysisError
        If the tail does not fall faster than 1/k, so that no isotropic surface has it.

    Notes
    -----
    With ``<h^2> = int_{-inf}^{inf} C_1D dk`` the inverse Abel transform ``C(q) = -(1/pi) int_q^inf
    (dC_1D/dk) / sqrt(k^2 - q^2) dk``, multiplied by ``2 pi q`` and integrated from q to infinity,
    is ``M(q) = 2 int_q^inf C_1D(k) k / sqrt(k^2 - q^2) dk``: the mean square height above q. It
    contains no derivative, only positive terms, and M(0) is the total variance, so differences of M
    fulfil Parseval's relation for any bins. C_1D is constant below the first bin and a power law
    above the last. The substitution ``k = q cosh(t)`` removes the singularity; each bin is
    integrated by 20 Gauss points, the tail is an incomplete beta function.

    Examples
    --------
    A power law comes back as a power law: ``C_1D = k^-3`` belongs to ``C = 2/pi q^-4``.

    >>> k = np.geomspace(1e3, 1e6, 61)
    >>> edges = np.array([1e4, 1.1e4])
    >>> power = invert(power_laws_between(k, k**-3.0), edges).power
    >>> expected = 2 * (edges[0]**-2.0 - edges[1]**-2.0)
    >>> bool(abs(power[0] / expected - 1) < 1e-9)
    True
    """
    exponent = profile.exponent
    if not exponent > 1:
        raise AnalysisError(
            f"inverse Abel transform: C_1D falls as k^-{exponent:.2f} at its end, and no isotropic "
            "surface falls slower than 1/k; end the spectrum below the noise floor"
        )
    at = np.concatenate([[0.0], profile.edges if edges is None else np.asarray(edges, float)])
    sensitivity = _pieces(profile, at)
    tail_power, by_exponent = _tail(profile.edges[-1], profile.last, exponent, at)
    sensitivity[:, -1] += tail_power
    above = sensitivity.sum(1)
    if profile.slope_weights is not None:
        step = 1e-4
        down, up = (replace(profile, slope=profile.slope + shift) for shift in (-step, step))
        by_slope = (_pieces(up, at) - _pieces(down, at)) / (2 * step)
        by_slope[:, -1] += tail_power * np.log(up.last / down.last) / (2 * step)
        sensitivity += by_slope @ profile.slope_weights
    if profile.tail is not None:
        sensitivity -= by_exponent[:, None] * profile.tail
    return Annuli(
        edges=at[1:],
        power=above[1:-1] - above[2:],
        sensitivity=sensitivity[1:-1] - sensitivity[2:],
        below=float(above[0] - above[1]),
        above=float(above[-1]),
    )


def _pieces(profile: PowerLaws, at: np.ndarray) -> np.ndarray:
    """Return each bin's share of the variance M(q); the first includes the plateau's (at, bin)."""
    left = np.concatenate([[0.0], profile.edges[:-1]])
    right, level = profile.edges, np.append(profile.level[:1], profile.level)
    slope = np.append(0.0, profile.slope)
    zero = at == 0  # q = 0 needs no substitution k = q cosh t: integrate C_1D itself
    start = np.where(zero, right[0], at)[:, None]
    starts = np.arccosh(np.maximum(left / start, 1.0))
    stops = np.arccosh(np.maximum(right / start, 1.0))
    half = 0.5 * (stops - starts)
    t = (0.5 * (stops + starts))[..., None] + half[..., None] * _POINTS
    k = start[..., None] * np.cosh(t)
    measure = half[..., None] * _WEIGHTS * k
    middle, width = 0.5 * (right + left), 0.5 * (right - left)
    k[zero] = middle[:, None] + width[:, None] * _POINTS
    measure[zero] = width[:, None] * _WEIGHTS
    reference = np.append(right[:1], left[1:])[:, None]
    parts = 2 * (level[:, None] * (k / reference) ** slope[:, None] * measure).sum(-1)
    parts[:, 1] += parts[:, 0]
    return parts[:, 1:]


def _tail(
    end: float, level: float, exponent: float, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the tail's share of M(q), and the share's derivative with respect to the exponent."""

    def mean_square(s: float) -> np.ndarray:
        # imported late: scipy loads slowly
        from scipy.special import beta, betainc

        # at smaller ratios M is constant to 1e-8
        a, ratio = 0.5 * (s - 1), np.maximum(at / end, 1e-4)
        scale = level * end * ratio ** (1 - s) * beta(a, 0.5)
        return scale * betainc(a, 0.5, np.minimum(ratio, 1.0) ** 2)

    step = 1e-4 * (exponent - 1)
    slope = (mean_square(exponent + step) - mean_square(exponent - step)) / (2 * step)
    return mean_square(exponent), slope
