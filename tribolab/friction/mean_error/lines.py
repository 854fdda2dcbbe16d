"""Oscillations in records: sines far above the noise."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tribolab.friction.mean_error import limits
from tribolab.friction.mean_error.autoregression import spectra_of

_FREQUENCY_STEP = 0.125  # step of the trial frequencies, in cycles per record
_MAX_FREQUENCY = 0.47  # highest trial frequency, in cycles per sample
_GOLDEN = 0.382
_GOLDEN_ROUNDS = 18  # golden-section steps, which find a frequency to 1e-4 of a grid step
# largest ratio of power at the best frequency to that at the best on the grid
_GAIN_OFF_GRID = 1.02


class _Grid(NamedTuple):
    """Trial frequencies [cycles per record], and their waves minus a line (frequency, 2, n)."""

    cycles: np.ndarray
    waves: np.ndarray
    line: np.ndarray


@lru_cache(maxsize=8)
def _grid(count: int) -> _Grid:
    t = (np.arange(count) + 0.5) / count
    cycles = np.arange(limits.MIN_CYCLES.value, _MAX_FREQUENCY * count, _FREQUENCY_STEP)
    line = np.stack([np.ones(count), t - 0.5])
    line /= np.sqrt((line * line).sum(axis=1))[:, None]
    angle = 2 * np.pi * np.outer(cycles, t)
    waves = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    waves -= (waves @ line.T) @ line
    waves[:, 0] /= np.sqrt((waves[:, 0] ** 2).sum(axis=1))[:, None]
    waves[:, 1] -= (waves[:, 0] * waves[:, 1]).sum(axis=1)[:, None] * waves[:, 0]
    waves[:, 1] /= np.sqrt((waves[:, 1] ** 2).sum(axis=1))[:, None]
    return _Grid(cycles, waves, line)


def waves_of(cycles: float, count: int) -> np.ndarray:
    """Return a cosine and a sine with given cycles per record, as columns (sample, 2)."""
    angle = 2 * np.pi * cycles * (np.arange(count) + 0.5) / count
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def lines_of(records: np.ndarray) -> list[list[float]]:
    """Return the frequencies of at most three oscillations of each record [cycles per record].

    Parameters
    ----------
    records
        Records of equal length, in any unit (record, sample).

    Notes
    -----
    A sine is fitted together with a straight line and the earlier sines. It is accepted if its
    power exceeds the residual spectrum at its frequency by `LINE_OVER_NOISE`, and accounts for most
    of the power near it. A sine of few cycles, which long-correlated noise resembles, must explain
    nearly all.
    """
    count = records.shape[1]
    found: list[list[float]] = [[] for _ in records]
    if count < limits.MIN_SAMPLES_OF_LINE.value:
        return found
    grid = _grid(count)
    rest = records - (records @ grid.line.T) @ grid.line
    looked = np.arange(len(records))
    for _ in range(int(limits.MAX_LINES.value)):
        looked = looked[_may_have_line(rest[looked], grid)]
        accepted = []
        for number in looked.tolist():
            left = _fit_next_line(records[number], rest[number], found[number], grid)
            if left is not None:
                rest[number] = left
                accepted.append(number)
        looked = np.array(accepted, int)
        if not looked.size:
            break
    return found


def _strongest(rest: np.ndarray, grid: _Grid) -> tuple[np.ndarray, np.ndarray]:
    """Return the grid index of each record's strongest wave, and its coefficients (record, 2)."""
    size = np.einsum("fcn,rn->rfc", grid.waves, rest, optimize=True)
    place = (size**2).sum(axis=2).argmax(axis=1)
    return place, size[np.arange(len(rest)), place]


def _may_have_line(rest: np.ndarray, grid: _Grid) -> np.ndarray:
    """Return a mask of records whose strongest wave on the grid exceeds half the limit (record)."""
    if not len(rest):
        return np.zeros(0, bool)
    place, size = _strongest(rest, grid)
    left = rest - np.einsum("rc,rcn->rn", size, grid.waves[place])
    at = grid.cycles[place]
    noise = spectra_of(left, at[:, None])[:, 0]
    over = _GAIN_OFF_GRID * (size**2).sum(axis=1) / 2 / np.maximum(noise, 1e-300)
    few = at < limits.FEW_CYCLES.value + _FREQUENCY_STEP
    enough = np.where(few, limits.SLOW_LINE_OVER_NOISE.value, limits.LINE_OVER_NOISE.value)
    # half, because a better fit of the line lowers the estimated noise near it
    return over > 0.5 * enough


def _fit_next_line(
    record: np.ndarray, rest: np.ndarray, known: list[float], grid: _Grid
) -> np.ndarray | None:
    """Fit one more oscillation to a record; return the residuals, None if it is insignificant."""
    count = record.size
    place, _ = _strongest(rest[None], grid)
    base = np.column_stack([grid.line.T, *(waves_of(cycles, count) for cycles in known)])
    base, _ = np.linalg.qr(base)
    before = record - base @ (base.T @ record)
    middle = float(grid.cycles[place[0]])
    cycles = _refine_frequency(before, base, middle)
    own = waves_of(cycles, count)
    own, _ = np.linalg.qr(own - base @ (base.T @ own))
    left = before - own @ (own.T @ before)
    gain = float(before @ before - left @ left)
    noise = float(spectra_of(left[None], np.array([cycles]))[0, 0])
    few = cycles < limits.FEW_CYCLES.value
    enough = limits.SLOW_LINE_OVER_NOISE.value if few else limits.LINE_OVER_NOISE.value
    if cycles <= limits.MIN_CYCLES.value + 1e-3 or gain / 2 < enough * noise:
        return None
    if few and gain < limits.SLOW_LINE_SHARE.value * (before @ before):
        return None
    if not few and _left_in_band(before, left, cycles) > limits.LEFT_IN_BAND.value:
        return None
    known.append(cycles)
    return left


def _refine_frequency(rest: np.ndarray, base: np.ndarray, middle: float) -> float:
    """Return the frequency of the wave with the smallest residuals, by golden-section search."""

    def taken(cycles: float) -> float:
        own = waves_of(cycles, rest.size)
        own -= base @ (base.T @ own)
        a, b, c = own[:, 0] @ own[:, 0], own[:, 0] @ own[:, 1], own[:, 1] @ own[:, 1]
        u, v = own.T @ rest
        return float((c * u * u - 2 * b * u * v + a * v * v) / max(a * c - b * b, 1e-300))

    low, high = max(middle - _FREQUENCY_STEP, limits.MIN_CYCLES.value), middle + _FREQUENCY_STEP
    for _ in range(_GOLDEN_ROUNDS):
        a, b = low + _GOLDEN * (high - low), high - _GOLDEN * (high - low)
        if taken(a) > taken(b):
            high = b
        else:
            low = a
    return (low + high) / 2


def _left_in_band(before: np.ndarray, after: np.ndarray, cycles: float) -> float:
    power = [np.abs(np.fft.rfft(values)) ** 2 for values in (before, after)]
    at = np.arange(power[0].size)
    band = (np.abs(at - cycles) <= max(2.0, 0.15 * cycles)) & (at > 0)
    return float(power[1][band].sum() / max(power[0][band].sum(), 1e-300))
