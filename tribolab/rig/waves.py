"""Waveforms of stick-slip along the sliding distance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

JITTER = 0.07  # relative standard deviation of period and drop
FALL = 0.04  # part of a period that the abrupt drop takes


def sawtooth(
    rng: np.random.Generator, length: float, wavelength: float, drop: float
) -> Callable[[np.ndarray], np.ndarray]:
    """Slow linear rise, abrupt drop; each period and each drop a little different.

    Parameters
    ----------
    rng
        Generator.
    length, wavelength
        Distance that is covered, and mean distance between drops [m].
    drop
        Mean height of a drop, in the unit of the result.

    Returns
    -------
    callable
        The waveform at distances [m].
    """
    starts, periods, sizes = _periods(rng, length, wavelength)
    valleys = -0.5 * drop * sizes[:-1]
    peaks = 0.5 * drop * sizes[1:]
    distance = np.stack([starts, starts + (1 - FALL) * periods], axis=1).ravel()
    values = np.stack([valleys, peaks], axis=1).ravel()
    return lambda s: np.interp(s, distance, values)


def rounded(
    rng: np.random.Generator, length: float, wavelength: float, drop: float
) -> Callable[[np.ndarray], np.ndarray]:
    """Near a sine, leaning a little to the sawtooth's side; parameters as in `sawtooth`."""
    starts, periods, sizes = _periods(rng, length, wavelength)
    edges = np.append(starts, starts[-1] + periods[-1])
    turns = np.arange(edges.size)

    def wave(s: np.ndarray) -> np.ndarray:
        phase = 2 * np.pi * np.interp(s, edges, turns)
        size = 0.5 * drop * np.interp(s, edges, sizes)
        return size * (np.sin(phase) - 0.08 * np.sin(2 * phase))

    return wave


def _periods(
    rng: np.random.Generator, length: float, wavelength: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Draw starts and lengths of enough periods to cover the length, and a size at each edge."""
    count = int(np.ceil(1.5 * length / wavelength)) + 4
    periods = wavelength * np.clip(1 + JITTER * rng.standard_normal(count), 0.5, 1.5)
    first = -wavelength * rng.uniform(1, 2)
    starts = first + np.concatenate([[0.0], np.cumsum(periods)[:-1]])
    sizes = np.clip(1 + JITTER * rng.standard_normal(count + 1), 0.5, 1.5)
    return starts, periods, sizes


WAVES = {"sawtooth": sawtooth, "rounded": rounded}
