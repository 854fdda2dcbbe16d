"""Mains lines in a record."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.spectrum.lines import LONGEST_TRANSFORM, amplitude_spectrum
from tribolab.friction.oscillation.spectrum.spectra import EvenRecord

_PEAK_SHIFT_BINS = 0.25  # largest shift of a peak due to noise, in bins
_FUNDAMENTAL = {f"{base * k:g} Hz": base for base in (50.0, 60.0) for k in (1, 2, 3)}


class Mains(NamedTuple):
    """A line of the mains: frequency [Hz], amplitude (signal's unit), name."""

    frequency: float
    amplitude: float
    name: str


def _peak_frequency(frequency: np.ndarray, amplitude: np.ndarray, at: int) -> float:
    """Return the frequency of a peak, interpolated by a parabola through three bins."""
    if not 0 < at < frequency.size - 1:
        return float(frequency[at])
    left, top, right = np.log(np.maximum(amplitude[at - 1 : at + 2], 1e-300))
    curve = left - 2 * top + right
    shift = 0.5 * (left - right) / curve if curve < 0 else 0.0
    return float(frequency[at] + np.clip(shift, -0.5, 0.5) * frequency[1])


def find_mains(record: EvenRecord) -> tuple[Mains, ...]:
    """Return the mains lines of a record; none if it is sampled too slowly or unevenly.

    Notes
    -----
    The frequency is known, so that a line must be significant only among the bins within the grid's
    tolerance of 0.1 Hz, not among all bins (see `find_lines`).
    """
    n = record.values.size
    rate = 1 / record.spacing
    if (
        not record.even
        or rate < limits.MIN_SAMPLING_RATE.value
        or n < limits.MIN_SAMPLES_OF_SPECTRUM.value
    ):
        return ()
    frequency, amplitude = amplitude_spectrum(
        record.time[:LONGEST_TRANSFORM], record.values[:LONGEST_TRANSFORM]
    )
    harmonics = []
    for true in sorted(base * k for base in (50.0, 60.0) for k in (1, 2, 3)):
        reach = limits.MAX_MAINS_DEVIATION.value * true / 50 + frequency[1]
        near = _bins(frequency, true, reach)
        around = _bins(frequency, true, max(40 * frequency[1], 5 * reach))
        size = near.stop - near.start
        if true > 0.45 * rate or size == 0 or around.stop - around.start < 4 * size:
            continue
        at = near.start + int(np.argmax(amplitude[near]))
        usual = median(amplitude[around] ** 2) / np.log(2)
        off = abs(_peak_frequency(frequency, amplitude, at) - true)
        if off > limits.MAX_MAINS_DEVIATION.value * true / 50 + _PEAK_SHIFT_BINS * frequency[1]:
            continue  # in a short record a bin is wide: 57 Hz is not mains
        if size * np.exp(-(amplitude[at] ** 2) / max(usual, 1e-300)) < limits.MAINS_BY_CHANCE.value:
            harmonics.append(Mains(float(frequency[at]), float(amplitude[at]), f"{true:g} Hz"))
    # noise may resemble a harmonic in one of many segments: require the fundamental, too
    names = {line.name for line in harmonics}
    return tuple(line for line in harmonics if f"{_FUNDAMENTAL[line.name]:g} Hz" in names)


def _bins(frequency: np.ndarray, middle: float, reach: float) -> slice:
    """Return the bins within a distance of a frequency [Hz]."""
    low, high = np.searchsorted(frequency, middle - reach), middle + reach
    return slice(int(low), int(np.searchsorted(frequency, high, side="right")))
