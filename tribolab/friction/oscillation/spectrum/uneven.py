"""Fourier sums over samples at arbitrary times, by a fast transform."""

from __future__ import annotations

import numpy as np
from scipy import fft

_SPREAD_POINTS = 6  # grid points on each side over which a sample is spread: errors of about 1e-6


def fourier_sums(time: np.ndarray, values: np.ndarray, step: float, count: int) -> np.ndarray:
    """Return the sums of ``values * exp(-2 pi i f time)`` at the frequencies ``0, step, ...``.

    Parameters
    ----------
    time, values
        Samples at arbitrary times [s] (time).
    step
        Spacing of the frequencies [Hz].
    count
        Number of frequencies.

    Returns
    -------
    ndarray
        Complex (frequency).

    Notes
    -----
    Each sample is spread by a Gaussian over twelve points of a grid oversampled by two, the grid is
    transformed, and the result is divided by the transform of the Gaussian [1]_.

    References
    ----------
    .. [1] Greengard and Lee (2004), SIAM Review 46, 443. doi:10.1137/S003614450343200X

    Examples
    --------
    >>> t = np.array([0.1, 0.35, 0.4, 0.82])
    >>> sums = fourier_sums(t, np.ones(4), 0.5, 8)
    >>> bool(abs(sums[3] - np.exp(-2j * np.pi * 1.5 * t).sum()) < 1e-5)
    True
    """
    size = fft.next_fast_len(4 * max(count, 8), real=True)
    place = ((time - time[0]) * step % 1.0) * size  # in grid points, modulo the longest period
    nearest = np.floor(place).astype(np.int64)
    width = 2 * _SPREAD_POINTS / (3 * np.pi)  # variance of the Gaussian for an oversampling of two
    grid = np.zeros(size)
    for shift in range(1 - _SPREAD_POINTS, _SPREAD_POINTS + 1):
        weight = np.exp(-((place - nearest - shift) ** 2) / (2 * width))
        grid += np.bincount((nearest + shift) % size, weight * values, size)
    k = np.arange(count)
    correction = np.exp(0.5 * width * (2 * np.pi * k / size) ** 2) / np.sqrt(2 * np.pi * width)
    return fft.rfft(grid)[:count] * correction * np.exp(-2j * np.pi * k * step * time[0])


def lomb_scargle(
    time: np.ndarray, values: np.ndarray, weights: np.ndarray, step: float, count: int
) -> np.ndarray:
    """Return the squared amplitude of the best-fitting sine at each frequency.

    Parameters
    ----------
    time, values, weights
        Times [s], signal in any unit, and weights: share of the time of a sample times a window.
    step, count
        Frequencies ``0, step ... (count-1) step`` [Hz].

    Returns
    -------
    ndarray
        Amplitude squared (frequency); 0 at zero frequency.

    Notes
    -----
    The normalised periodogram of unevenly sampled data [1]_: with the phase tau that makes sine and
    cosine orthogonal over the samples, each is fitted separately.

    References
    ----------
    .. [1] Press and Rybicki (1989), Astrophys. J. 338, 277. doi:10.1086/167197
    """
    total = weights.sum()
    weights = weights / total
    centred = values - weights @ values
    sums = fourier_sums(time, weights * centred, step, count)
    twice = fourier_sums(time, weights, 2 * step, count)
    size = np.abs(twice)
    turn = np.sqrt(twice / np.maximum(size, 1e-300))  # exp(-i omega tau)
    rotated = sums * np.conj(turn)
    cosine, sine = 0.5 * (1 + size), 0.5 * (1 - size)
    power = (rotated.real / np.maximum(cosine, 1e-9)) ** 2
    power += np.where(sine > 1e-6, (rotated.imag / np.maximum(sine, 1e-6)) ** 2, 0.0)
    power[0] = 0.0
    return power
