"""Skewness and kurtosis of profiles with a gap longer than half a sampling length.

A bridge over such a hole is a straight line, which makes the other heights of that sampling length
outliers. Both parameters then use measured heights only, from lengths with enough of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

_MIN_MEASURED = 0.5  # share of a sampling length that must have been measured
# order of the moment, and factor of its variance for Gaussian heights
_POWERS = {"Rsk": (3, 6.0), "Rku": (4, 24.0)}


class Tails(NamedTuple):
    """Rsk or Rku of each profile (row), and its standard error due to gaps (row)."""

    value: np.ndarray
    error: np.ndarray


def long_holes(missing: np.ndarray) -> np.ndarray:
    """Return a mask of profiles that lack more than half of any sampling length.

    Parameters
    ----------
    missing
        Mask of missing heights (row, length, x).

    Examples
    --------
    >>> gap = np.zeros((2, 2, 8), dtype=bool)
    >>> gap[1, 0, :5] = True
    >>> long_holes(gap).tolist()
    [False, True]
    """
    return np.asarray((~missing).mean(axis=-1).min(axis=-1) < _MIN_MEASURED)


def tails(deviation: np.ndarray, missing: np.ndarray) -> dict[str, Tails]:
    """Return Rsk and Rku from the measured heights, with the error due to the missing ones.

    Parameters
    ----------
    deviation
        Deviation from the mean line [m] (row, length, x).
    missing
        Mask of missing heights (row, length, x).

    Returns
    -------
    dict
        ``Rsk`` and ``Rku``; NaN if less than half of every sampling length is measured.

    Notes
    -----
    The mean of a moment over n of N sampling lengths differs from that over all by the variance
    ``s**2 (1/n - 1/N)``. s is the larger of the
    scatter between the lengths and that of a normal process,
    ``6 sum(rho**3)/L`` and ``24 sum(rho**4)/L`` with its autocorrelation rho over a length of L
    points [1]_. The magnitude of rho is used, since part of a profile determines its negative lobes
    poorly.

    References
    ----------
    .. [1] I. N. Lobato, C. Velasco, "A simple test of normality for time series", Econometric
       Theory 20 (2004) 671-689, doi:10.1017/S0266466604204030.
    """
    there = ~missing
    share = there.mean(axis=-1)
    weight = np.where(share >= _MIN_MEASURED, share, 0.0)
    points = np.maximum(there.sum(axis=-1), 1)
    height = np.where(there, deviation, 0.0)
    square = (height**2).sum(axis=-1) / points
    number = weight.sum(axis=-1)
    lacking = 1.0 / np.where(number > 0, number, np.nan) - 1.0 / missing.shape[-2]
    rho = _autocorrelation(height, there)
    result = {}
    for name, (order, factor) in _POWERS.items():
        moment = (height**order).sum(axis=-1) / points
        each = np.divide(
            moment, square ** (order / 2), where=square > 0, out=np.zeros(square.shape)
        )
        with np.errstate(invalid="ignore"):  # profiles without any measured height give NaN
            value = (weight * each).sum(axis=-1) / np.where(number > 0, number, np.nan)
            spread = (weight * (each - value[:, None]) ** 2).sum(axis=-1)
            spread /= np.where(number > 1.0, number - 1.0, np.nan)
        normal = factor * (np.abs(rho) ** order).sum(axis=-1) / missing.shape[-1]
        variance = np.fmax(spread, normal)
        result[name] = Tails(value, np.sqrt(variance * np.maximum(lacking, 0.0)))
    return result


def _autocorrelation(height: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Return the autocorrelation of profiles at positive and negative lags (row, lag)."""
    size = height.shape[-1]
    rows = height.reshape(len(height), -1)
    every = there.reshape(len(there), -1).astype(float)

    def lag_products(values: np.ndarray) -> np.ndarray:
        power = np.abs(np.fft.rfft(values, 2 * values.shape[-1])) ** 2
        return np.asarray(np.fft.irfft(power)[:, :size])

    together = np.maximum(np.rint(lag_products(every)), 1.0)
    covariance = lag_products(rows) / together
    rho = np.clip(covariance / np.maximum(covariance[:, :1], np.finfo(float).tiny), -1.0, 1.0)
    return np.concatenate([rho[:, :0:-1], rho], axis=-1)
