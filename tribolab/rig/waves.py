"""Waveforms of stick-slip: friction as a function of sliding distance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

JITTER = 0.07  # relative standard deviation of the period and of the drop
_FALL = 0.04  # share of a period during which friction drops


def sawtooth(
    rng: np.random.Generator, length: float, wavelength: float, drop: float, jitter: float = JITTER
) -> Callable[[np.ndarray], np.ndarray]:
    """Return a sawtooth wave (linear rise, sudden drop) with randomly scattered periods and drops.

    Parameters
    ----------
    rng
        Generator.
    length, wavelength
        Total distance, and mean distance between drops [m].
    drop
        Mean height of a drop, in the unit of the result.
    jitter
        Relative standard deviation of periods and drops.

    Returns
    -------
    callable
        The waveform at distances [m].
    """
    starts, periods, sizes = _periods(rng, length, wavelength, jitter)
    valleys = -0.5 * drop * sizes[:-1]
    peaks = 0.5 * drop * sizes[1:]
    distance = np.stack([starts, starts + (1 - _FALL) * periods], axis=1).ravel()
    values = np.stack([valleys, peaks], axis=1).ravel()
    return lambda s: np.interp(s, distance, values)


def rounded(
    rng: np.random.Generator, length: float, wavelength: float, drop: float, jitter: float = JITTER
) -> Callable[[np.ndarray], np.ndarray]:
    """Return a rounded sawtooth wave, almost a sine; parameters as for `sawtooth`."""
    starts, periods, sizes = _periods(rng, length, wavelength, jitter)
    edges = np.append(starts, starts[-1] + periods[-1])
    turns = np.arange(edges.size)

    def wave(s: np.ndarray) -> np.ndarray:
        phase = 2 * np.pi * np.interp(s, edges, turns)
        size = 0.5 * drop * np.interp(s, edges, sizes)
        return size * (np.sin(phase) - 0.08 * np.sin(2 * phase))

    return wave


def _periods(
    rng: np.random.Generator, length: float, wavelength: float, jitter: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return random starts and lengths of periods [m], and relative amplitudes at their ends."""
    count = int(np.ceil(1.5 * length / wavelength)) + 4
    periods = wavelength * np.clip(1 + jitter * rng.standard_normal(count), 0.5, 1.5)
    first = -wavelength * rng.uniform(1, 2)
    starts = first + np.concatenate([[0.0], np.cumsum(periods)[:-1]])
    sizes = np.clip(1 + jitter * rng.standard_normal(count + 1), 0.5, 1.5)
    return starts, periods, sizes


def irregular(
    rng: np.random.Generator, length: float, wavelength: float, drop: float, jitter: float = JITTER
) -> Callable[[np.ndarray], np.ndarray]:
    """Return a stick-slip wave without a period: both the peaks and the valleys are random.

    Parameters as for `sawtooth`; `jitter` is ignored. Peaks and valleys scatter by a third of a
    drop. Loading has constant slope, so that periods follow from the thresholds; a drop takes a
    tenth to a third of its period.
    """
    count = int(np.ceil(3 * length / wavelength)) + 8
    valleys = drop * (-0.5 + 0.33 * rng.standard_normal(count + 1).clip(-2, 2))
    peaks = drop * (0.5 + 0.33 * rng.standard_normal(count).clip(-2, 2))
    peaks = np.maximum(peaks, np.maximum(valleys[:-1], valleys[1:]) + 0.15 * drop)
    periods = (peaks - valleys[:-1]) * rng.uniform(0.8, 1.2, count)
    periods *= wavelength / periods.mean()
    starts = np.concatenate([[0.0], np.cumsum(periods)[:-1]]) - 2 * wavelength
    share = rng.uniform(0.1, 0.33, count)
    distance = np.stack([starts, starts + (1 - share) * periods], axis=1).ravel()
    values = np.stack([valleys[:-1], peaks], axis=1).ravel()
    return lambda s: np.interp(s, distance, values)


WAVES = {"sawtooth": sawtooth, "rounded": rounded, "irregular": irregular}
