"""Smooth spectrum fitted to a measured one, from which scatter is judged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tribolab.surface.self_affine import SelfAffine, psd_1d

_STIFFNESS = 1e3  # weight of smoothness against fit: averages over some ten bins
_STARTS = (0.25, 0.5, 0.75)  # start values of the roll-off, as shares of the logarithmic range


class FittedLaw(NamedTuple):
    """Fitted plateau and power law, with the covariance of ln(roll-off) and the Hurst exponent."""

    law: SelfAffine
    covariance: np.ndarray

    def spread(self, quantity: Callable[[SelfAffine], np.ndarray]) -> np.ndarray:
        """Return the standard error of a quantity that is computed from the fitted law."""
        steps = []
        for name, scale in (("rolloff", self.law.rolloff), ("hurst", 1.0)):
            at = getattr(self.law, name)
            ends = [replace(self.law, **{name: at + h * scale}) for h in (1e-3, -1e-3)]
            steps.append((quantity(ends[0]) - quantity(ends[1])) / 2e-3)
        by = np.stack(steps)
        return np.sqrt(np.maximum(np.einsum("i...,ij,j...->...", by, self.covariance, by), 0.0))


def fitted_law(wavenumber: np.ndarray, measured: np.ndarray, relative: np.ndarray) -> FittedLaw:
    """Return the plateau and power law whose profile spectrum best fits a measured C_1D.

    Parameters
    ----------
    wavenumber, measured
        Bins of C_1D [1/m], [m3].
    relative
        Relative standard error of each.

    Notes
    -----
    Least squares of the logarithms. The logarithm of a mean of m values is too low by about 1/(2m)
    on average, which is corrected.

    Examples
    --------
    >>> q = np.geomspace(1e3, 1e6, 31)
    >>> exact = psd_1d(SelfAffine(0.8, 3e4, 1e-21, 1.0, 1e12), q)
    >>> law, _ = fitted_law(q, exact, np.full(31, 1e-3))
    >>> round(law.hurst, 3), float(f"{law.rolloff:.3g}")
    (0.8, 30000.0)
    """
    # imported late: scipy loads slowly
    from scipy.optimize import least_squares

    level, weights = _level(measured, relative), relative**-2.0
    ends = np.log(wavenumber[[0, -1]])

    def law(rolloff: float, hurst: float, plateau: float = 1.0) -> SelfAffine:
        edges = 1e-3 * float(wavenumber[0]), 1e9 * float(wavenumber[-1])
        return SelfAffine(float(hurst), float(np.exp(rolloff)), plateau, *edges)

    def misfit(given: np.ndarray) -> np.ndarray:
        return level - np.log(psd_1d(law(*given), wavenumber))

    def residual(given: np.ndarray) -> np.ndarray:
        miss = misfit(given)
        return (miss - np.average(miss, weights=weights)) / relative

    bounds = ([ends[0] - 2.0, 0.02], [ends[1], 4.0])
    tried = [
        least_squares(residual, (start, 0.8), bounds=bounds, x_scale=(1.0, 0.3))
        for start in ends[0] + np.array(_STARTS) * np.diff(ends)
    ]
    best = min(tried, key=lambda fit: fit.cost)
    plateau = float(np.exp(np.average(misfit(best.x), weights=weights)))
    # larger errors if the surface does not follow the fitted law
    growth = max(1.0, 2 * best.cost / max(level.size - 3, 1))
    rolloff, hurst = best.x
    jacobian = np.asarray(best.jac)
    # prior: parameters are uniformly distributed between their bounds
    known = np.diag(12 / np.diff(bounds, axis=0)[0] ** 2)
    covariance = np.linalg.inv(jacobian.T @ jacobian / growth + known)
    return FittedLaw(law(rolloff, hurst, plateau), covariance)


def smooth(
    wavenumber: np.ndarray, measured: np.ndarray, relative: np.ndarray, law: SelfAffine
) -> np.ndarray:
    """Return a smooth spectrum fitted to a measured C_1D.

    Parameters
    ----------
    wavenumber, measured, relative
        As for `fitted_law`.
    law
        Result of `fitted_law`.

    Notes
    -----
    The result is the spectrum of the law times the measured deviation from it, smoothed over some
    ten bins by Whittaker's smoother [1]_. C_1D of an isotropic surface does not increase with k,
    and neither does the result.

    References
    ----------
    .. [1] P. H. C. Eilers, A perfect smoother, Anal. Chem. 75 (2003) 3631,
       doi:10.1021/ac034173t.

    Examples
    --------
    >>> q, law = np.geomspace(1e3, 1e6, 31), SelfAffine(0.8, 3e4, 1e-21, 1.0, 1e12)
    >>> twice = smooth(q, 2 * psd_1d(law, q), np.full(31, 0.001), law)
    >>> bool(np.allclose(twice, 2 * psd_1d(law, q), rtol=1e-3))
    True
    """
    model = np.log(psd_1d(law, wavenumber))
    if model.size > 3:
        bend, weights = np.diff(np.eye(model.size), 2, axis=0), relative**-2.0
        stiff = np.diag(weights) + _STIFFNESS * np.median(weights) * bend.T @ bend
        model = model + np.linalg.solve(stiff, weights * (_level(measured, relative) - model))
    return np.exp(np.minimum.accumulate(model))


def _level(measured: np.ndarray, relative: np.ndarray) -> np.ndarray:
    return np.log(measured) + 0.5 * relative**2
