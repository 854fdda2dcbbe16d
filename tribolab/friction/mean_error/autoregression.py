"""Autoregressive models by Burg's method, for many records of equal length at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.friction.mean_error import limits

_MIN_VARIANCE = 1e-300


class Models(NamedTuple):
    """Model of each record: coefficients (from 1 on), variance of its innovations, and order."""

    coefficients: np.ndarray
    variance: np.ndarray
    order: np.ndarray


def burg(records: np.ndarray, highest: int) -> tuple[np.ndarray, np.ndarray]:
    """Fit autoregressive models of every order up to the highest, by Burg's method.

    Parameters
    ----------
    records
        One record in each row, its mean removed (record, sample).
    highest
        Highest order.

    Returns
    -------
    tuple
        Coefficients (order, record, highest + 1), beginning with 1, and the mean squares of the
        innovations (order, record).

    References
    ----------
    .. [1] Burg (1975), Maximum Entropy Spectral Analysis, Stanford University.
    """
    count, _ = records.shape
    forward = backward = records
    models = np.zeros((highest + 1, count, highest + 1))
    models[:, :, 0] = 1.0
    variances = np.empty((highest + 1, count))
    variances[0] = np.mean(records**2, axis=1)
    for p in range(1, highest + 1):
        f, b = forward[:, 1:], backward[:, :-1]
        power = np.maximum((f * f).sum(axis=1) + (b * b).sum(axis=1), _MIN_VARIANCE)
        k = -2 * (f * b).sum(axis=1) / power
        forward, backward = f + k[:, None] * b, b + k[:, None] * f
        models[p] = models[p - 1]
        models[p, :, 1 : p + 1] += k[:, None] * models[p - 1, :, p - 1 :: -1]
        variances[p] = variances[p - 1] * (1 - k * k)
    return models, variances


def _criterion(variances: np.ndarray, samples: int) -> np.ndarray:
    """Return Akaike's criterion, corrected for few samples (order, record)."""
    p = np.arange(variances.shape[0])[:, None]
    penalty = 2 * (p + 1) * samples / np.maximum(samples - p - 2, 1)
    return samples * np.log(np.maximum(variances, _MIN_VARIANCE)) + penalty


def spectra_of(records: np.ndarray, frequencies: np.ndarray, highest: int = 20) -> np.ndarray:
    """Return spectra of records, from models whose order Akaike's criterion selects.

    Parameters
    ----------
    records
        Records (record, sample); their means are removed here.
    frequencies
        Frequencies in cycles per record (frequency), or (record, frequency) if records differ.
    highest
        Highest order.

    Returns
    -------
    numpy.ndarray
        (record, frequency), in squares of the records' unit: 1 for white noise of variance 1.
    """
    samples = records.shape[1]
    centred = records - records.mean(axis=1, keepdims=True)
    models, variances = burg(centred, min(highest, max(2, samples // 5)))
    best = _criterion(variances, samples).argmin(axis=0)
    rows = np.arange(len(records))
    return _power(models[best, rows], variances[best, rows], frequencies, samples)


def _power(
    coefficients: np.ndarray, variance: np.ndarray, frequencies: np.ndarray, samples: int
) -> np.ndarray:
    angle = 2 * np.pi * frequencies[..., None] / samples * np.arange(coefficients.shape[1])
    phases = np.exp(-1j * angle)
    if frequencies.ndim == 1:
        response = coefficients @ phases.T
    else:
        response = np.einsum("rfp,rp->rf", phases, coefficients)
    return variance[:, None] / np.maximum(np.abs(response) ** 2, _MIN_VARIANCE)


class Sieve(NamedTuple):
    """Models of the residuals of a fit, corrected for the number of fitted parameters."""

    models: Models
    long_run_variance: np.ndarray
    effective_samples: np.ndarray

    def power(self, frequencies: np.ndarray, samples: int) -> np.ndarray:
        """Return model spectra at frequencies in cycles per record (record, frequency)."""
        return _power(self.models.coefficients, self.models.variance, frequencies, samples)


def sieve_of(records: np.ndarray, fitted: int, highest: int = 8) -> Sieve:
    """Return models of a fit's residuals, corrected for the correlation that the fit removed.

    Parameters
    ----------
    records
        Residuals of a fit, their mean removed (record, sample).
    fitted
        Number of fitted parameters of each, including the mean.
    highest
        Highest order; the lowest is 1, because order 0 hides a short correlation.

    References
    ----------
    .. [1] Kendall (1954), Biometrika 41, 403-404. doi:10.1093/biomet/41.3-4.403
    """
    count, samples = records.shape
    highest = min(highest, samples // 5)
    models, variances = burg(records, highest)
    if highest:
        best = 1 + _criterion(variances, samples)[1:].argmin(axis=0)
    else:
        best = np.zeros(count, int)
    rows = np.arange(count)
    own = models[best, rows]
    innovations = variances[best, rows] * samples / np.maximum(samples - fitted - best, 1)
    memory = -own[:, 1:].sum(axis=1)
    added = (fitted + (2 + fitted) * np.maximum(memory, 0.0)) / samples
    longer = np.maximum(memory, np.minimum(memory + added, limits.MAX_MEMORY.value))
    sum_at_zero = np.where(best > 0, np.maximum(1 - longer, 1e-6), 1 - memory)
    long_run = innovations / sum_at_zero**2
    variance = (records**2).sum(axis=1) / max(samples - fitted, 1)
    effective = np.clip(variance * samples / np.maximum(long_run, _MIN_VARIANCE), 1, samples)
    return Sieve(Models(own, innovations, best), long_run, effective)
