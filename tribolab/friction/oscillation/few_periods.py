"""Slow waves with so few periods that they can hardly be distinguished from drift."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.spectrum.spectra import EvenRecord, block_means

_GRID_POINTS = 192  # number of block means to which the record is reduced
_TRIED_CYCLES = np.arange(2.0, 5.21, 0.1)  # trial numbers of periods in the record
_WAVE_HARMONICS = 2
_DRIFT_DEGREE = 4  # degree of the polynomial, for drifts of any kind, that must fit worse
_MIN_SAMPLES = 32
_SINE_COLUMNS = 4  # first columns of a wave's basis: straight line, cosine, sine


class SlowWave(NamedTuple):
    """A slow wave: periods in the record, share of the variance about a line, and swing."""

    periods: float
    explained: float
    swing: float


@cache
def _bases() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return orthonormal bases of polynomials (point, term) and of waves (cycles, point, term)."""
    x = (np.arange(_GRID_POINTS) + 0.5) / _GRID_POINTS
    powers = np.polynomial.legendre.legvander(2 * x - 1, _DRIFT_DEGREE)
    turn = 2 * np.pi * _TRIED_CYCLES[:, None] * x
    terms = [f(k * turn) for k in range(1, _WAVE_HARMONICS + 1) for f in (np.cos, np.sin)]
    line = np.broadcast_to(powers[:, :2], (_TRIED_CYCLES.size, _GRID_POINTS, 2))
    waves = np.concatenate([line, np.stack(terms, axis=2)], axis=2)
    return np.linalg.qr(powers[:, :2])[0], np.linalg.qr(powers)[0], np.linalg.qr(waves)[0]


def slow_wave(record: EvenRecord) -> SlowWave | None:
    """Return the slow wave that explains nearly all of the fluctuation; None without one.

    Parameters
    ----------
    record
        From `tribolab.friction.oscillation.spectrum.spectra.make_record`.

    Notes
    -----
    A straight line plus a sine and its second harmonic, with two to five periods in the record, is
    fitted to means over blocks. Red noise drifts at all scales: a single wave explains three
    quarters of it in fewer than 1 % of records. A wave is not reported if a polynomial of fourth
    degree, such as a drift, fits as well.

    Examples
    --------
    >>> t = np.arange(600.0)
    >>> wave = slow_wave(EvenRecord(t, np.sin(2 * np.pi * 3 * t / 600), 1.0, True))
    >>> round(wave.periods, 1), slow_wave(EvenRecord(t, np.exp(-t / 100), 1.0, True))
    (3.0, None)
    """
    if record.values.size < _MIN_SAMPLES:
        return None
    values, _ = _averaged(record)
    line, polynomial, waves = _bases()
    rest = values - line @ (line.T @ values)
    total = float(rest @ rest)
    if not total > 0:
        return None
    drift = values - polynomial @ (polynomial.T @ values)
    parts = np.einsum("kpt,p->kt", waves, rest)
    explained = (parts**2).sum(axis=1) / total
    # a fit mostly by the second harmonic is no wave of this frequency
    own = (parts[:, 2:4] ** 2).sum(axis=1)
    explained = np.where(own > 0.5 * (parts**2).sum(axis=1), explained, 0.0)
    left = 1 - float(explained.max())
    best = int(np.flatnonzero(1 - explained <= limits.MISFIT_OF_SLOW_WAVE.value * left)[-1])
    left = 1 - float(explained[best])
    if best in (0, _TRIED_CYCLES.size - 1) or left > min(
        1 - limits.MIN_VARIANCE_OF_SLOW_WAVE.value,
        limits.MAX_MISFIT_OVER_DRIFT.value * float(drift @ drift) / total,
    ):
        return None
    fitted = waves[best] @ parts[best]
    return SlowWave(float(_TRIED_CYCLES[best]), 1 - left, float(np.ptp(fitted)))


def without_slow_wave(record: EvenRecord) -> tuple[EvenRecord, float] | None:
    """Return a record without its dominant slow sine, and the sine's swing; None if it is small.

    Next to a slow oscillation the spectrum cannot distinguish a faster one from slow drift.

    Parameters
    ----------
    record
        From `tribolab.friction.oscillation.spectrum.spectra.make_record`.

    Examples
    --------
    >>> t = np.arange(600.0)
    >>> fast = np.sin(2 * np.pi * 20 * t / 600)
    >>> both = EvenRecord(t, fast + np.sin(2 * np.pi * 3 * t / 600), 1.0, True)
    >>> rest, swing = without_slow_wave(both)
    >>> round(swing), bool(np.std(rest.values - fast) < 0.25)  # 0.71 before
    (2, True)
    """
    if record.values.size < _MIN_SAMPLES:
        return None
    values, at = _averaged(record)
    line, _, waves = _bases()
    rest = values - line @ (line.T @ values)
    parts = np.einsum("kpt,p->kt", waves[:, :, :_SINE_COLUMNS], rest)
    explained = (parts**2).sum(axis=1)
    best = int(np.argmax(explained))
    if not explained[best] > limits.MIN_VARIANCE_OF_SLOW_SINE.value * float(rest @ rest):
        return None
    x = (record.time - record.time[0]) / np.ptp(record.time)
    wave = np.interp(x, at, waves[best, :, :_SINE_COLUMNS] @ parts[best])
    swing = float(np.ptp(waves[best, :, 2:_SINE_COLUMNS] @ parts[best, 2:]))
    return record._replace(values=record.values - wave), swing


def _averaged(record: EvenRecord) -> tuple[np.ndarray, np.ndarray]:
    """Return means over parts of the record, and their positions in it (0 to 1)."""
    if record.even:
        means = block_means(record.values, max(record.values.size // (4 * _GRID_POINTS), 1))
        x = (np.arange(means.size) + 0.5) / means.size
    else:
        means, x = record.values, (record.time - record.time[0]) / np.ptp(record.time)
    at = (np.arange(_GRID_POINTS) + 0.5) / _GRID_POINTS
    if means.size > 2 * _GRID_POINTS:
        place = np.minimum((x * _GRID_POINTS).astype(int), _GRID_POINTS - 1)
        count = np.bincount(place, minlength=_GRID_POINTS)
        known = count > 0
        sums = np.bincount(place, means, _GRID_POINTS)
        return np.interp(at, at[known], sums[known] / count[known]), at
    return np.interp(at, x, means), at
