"""Spectrum of a record by an autoregressive model, and the variance of sums that it makes.

Notes
-----
The models are Burg's, each of the order p that makes N ln(residual variance) + 3 p smallest. Two
corrections near zero frequency were calibrated on simulated records: a dip is not believed where
no strong line explains it, and below a strong line only part of its fitted tail is counted. What
errors of means they make: :mod:`tribolab.friction.statistics`.
"""

from __future__ import annotations

import numpy as np

ORDER = 20  # highest order: as long as one of five teeth of a saw
_PENALTY = 3.0  # for each coefficient
GRID = 2048  # frequencies of the spectrum's quadrature
_LINE = 150.0  # a peak so much above the spectrum at zero is a line
_TAIL = 0.3  # share of the line's tail that is counted


def autoregression(records: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Fit autoregressive models to records by Burg's method, each of its best order.

    Parameters
    ----------
    records
        One record in each row, its mean removed.
    order
        Highest order.

    Returns
    -------
    tuple
        Coefficients (records, order + 1) beginning with 1, variance of the innovations, order.
    """
    count, n = records.shape
    forward, backward = records, records
    models = np.zeros((order + 1, count, order + 1))
    models[:, :, 0] = 1
    variances = np.empty((order + 1, count))
    variances[0] = np.mean(records**2, axis=1)
    for p in range(1, order + 1):
        f, b = forward[:, 1:], backward[:, :-1]
        power = np.maximum((f * f + b * b).sum(axis=1), 1e-300)
        k = -2 * (f * b).sum(axis=1) / power
        forward, backward = f + k[:, None] * b, b + k[:, None] * f
        models[p] = models[p - 1]
        models[p, :, 1 : p + 1] += k[:, None] * models[p - 1, :, p - 1 :: -1]
        variances[p] = variances[p - 1] * (1 - k * k)
    price = _PENALTY * np.arange(order + 1)[:, None]
    best = np.argmin(n * np.log(np.maximum(variances, 1e-300)) + price, axis=0)
    rows = np.arange(count)
    sigma = variances[best, rows] * n / np.maximum(n - best - 1, 1)
    return models[best, rows], sigma, best


def model_spectra(records: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Model spectra of records on `GRID` / 2 + 1 frequencies, corrected near zero.

    Returns
    -------
    tuple
        Power per frequency (records, frequency), and the power between the lines where the
        spectrum has lines, else 0 (records).
    """
    n = records.shape[1]
    a, sigma, _ = autoregression(records, min(ORDER, n // 4))
    power = sigma[:, None] / np.maximum(np.abs(np.fft.rfft(a, GRID, axis=1)) ** 2, 1e-300)
    cycles = np.arange(GRID // 2 + 1) * n / GRID  # in the record
    peak = power.argmax(axis=1)
    height = power[np.arange(power.shape[0]), peak]
    line = (cycles[peak] > 2.5) & (height > _LINE * power[:, 0])
    near = np.flatnonzero(cycles <= 6)
    filled = np.maximum.accumulate(power[:, near][:, ::-1], axis=1)[:, ::-1]
    power[:, near] = np.where(line[:, None], power[:, near], filled)
    below = cycles[None, :] < cycles[peak][:, None] / 2
    floor = power.min(axis=1, keepdims=True)
    damped = floor + _TAIL * (power - floor)
    return np.where(line[:, None] & below, damped, power), np.where(line, floor[:, 0], 0.0)


def variance_of_sum(power: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Variance of a weighted sum of the samples of a process, from its spectrum."""
    window = np.abs(np.fft.rfft(weights, GRID)) ** 2 / GRID
    window[1:-1] *= 2
    return power @ window
