"""Mains lines in a record."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.spectrum.lines import LONGEST_TRANSFORM, amplitude_spectrum
from tribolab.friction.oscillation.spectrum.spectra import EvenRecord

_PEAK_SHIFT_BINS = 0.25  # of a bin, by which noise moves a peak
_FUNDAMENTAL = {f"{base * k:g} Hz": base for base in (50.0, 60.0) for k in (1, 2, 3)}


class Mains(NamedTuple):
    """A line of the mains: frequency [Hz], amplitude (signal's unit), name."""

    frequency: float
    amplitude: float
    name: str


def _refined(frequency: np.ndarray, amplitude: np.ndarray, at: int) -> float:
    """Return the frequency of a peak between its bins, by a parabola through three of them."""
    if not 0 < at < frequency.size - 1:
        return float(frequency[at])
    left, top, right = np.log(np.maximum(amplitude[at - 1 : at + 2], 1e-300))
    curve = left - 2 * top + right
    shift = 0.5 * (left - right) / curve if curve < 0 else 0.0
    return float(frequency[at] + np.clip(shift, -0.5, 0.5) * frequency[1])


def find_mains(record: EvenRecord) -> tuple[Mains, ...]:
    """Lines of the mains in a record that is sampled fast and evenly enough.

    Notes
    -----
    Where to look is known, so that a line needs not stand out among all bins, as one of unknown
    frequency must (see `find_lines`), but among those within the
    grid's own 0.1 Hz only.
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
        near = np.flatnonzero(np.abs(frequency - true) <= reach)
        around = np.abs(frequency - true) <= max(40 * frequency[1], 5 * reach)
        if true > 0.45 * rate or near.size == 0 or around.sum() < 4 * near.size:
            continue
        at = near[np.argmax(amplitude[near])]
        usual = median(amplitude[around] ** 2) / np.log(2)
        off = abs(_refined(frequency, amplitude, at) - true)
        if off > limits.MAX_MAINS_DEVIATION.value * true / 50 + _PEAK_SHIFT_BINS * frequency[1]:
            continue  # of a short record a bin is wide: 57 Hz is no mains
        if (
            near.size * np.exp(-(amplitude[at] ** 2) / max(usual, 1e-300))
            < limits.MAINS_BY_CHANCE.value
        ):
            harmonics.append(Mains(float(frequency[at]), float(amplitude[at]), f"{true:g} Hz"))
    # among hundreds of segments noise passes for one or the other: a harmonic needs its fundamental
    names = {line.name for line in harmonics}
    return tuple(line for line in harmonics if f"{_FUNDAMENTAL[line.name]:g} Hz" in names)
