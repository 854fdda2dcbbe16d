"""Narrow lines in the spectrum of a signal: mains hum and resonances."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from tribolab.friction.oscillation import limits

_BACKGROUND_BINS = 61  # bins around a line that determine its background
LONGEST_TRANSFORM = 1 << 18  # samples of one transform; more are not needed for a clear line


class Line(NamedTuple):
    """Spectral line: frequency [Hz], amplitude, and ratio of its power to the background.

    If found in a segment, also the segment's number and sliding speed [m/s], and whether it is
    mains hum.
    """

    frequency: float
    amplitude: float
    prominence: float
    segment: int = -1
    speed: float = float("nan")
    mains: bool = False


def segment_lines(
    time: np.ndarray, values: np.ndarray, segment: int, speed: float
) -> list[Line] | None:
    """Return the spectral lines of a segment; None if it is too short or sampled too slowly.

    Parameters
    ----------
    time, values
        Times [s], and the signal in any unit (time).
    segment, speed
        Number and sliding speed [m/s], for the record.
    """
    if values.size < limits.MIN_SAMPLES_OF_SPECTRUM.value:
        return None
    rate = (values.size - 1) / (time[-1] - time[0])
    if rate < limits.MIN_SAMPLING_RATE.value:
        return None
    resolution = 2 * rate / min(values.size, LONGEST_TRANSFORM)
    return [
        line._replace(
            segment=segment,
            speed=speed,
            mains=bool(mains_harmonic(line.frequency, resolution, rate)),
        )
        for line in find_lines(time, values, lowest=limits.MIN_FREQUENCY_OF_RIG_LINE.value)
    ]


@functools.lru_cache(maxsize=4)  # the segments of a run are often equally long
def _hann(size: int) -> np.ndarray:
    window = np.hanning(size)
    window.flags.writeable = False
    return window


def amplitude_spectrum(time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies [Hz] and amplitudes of the sines in evenly sampled data (Hann window).

    Parameters
    ----------
    time
        Times [s], evenly spaced except for jitter (time).
    values
        The signal, without missing values (time).
    """
    n = min(values.size, LONGEST_TRANSFORM)
    interval = (time[n - 1] - time[0]) / (n - 1)
    place = np.arange(n) / (n - 1) - 0.5
    part = values[:n] - values[:n].mean()
    part -= 12 * place * (place @ part) / n  # remove the trend, which is no line
    window = _hann(n)
    amplitude = 2 * np.abs(np.fft.rfft(part * window)) / window.sum()
    return np.fft.rfftfreq(n, interval), amplitude


def find_lines(time: np.ndarray, values: np.ndarray, lowest: float = 0.0) -> list[Line]:
    """Return the spectral lines of an interval of a signal, except those that may be noise.

    Parameters
    ----------
    time, values
        Times [s], evenly spaced, and the signal in any unit (time).
    lowest
        Only lines above this frequency [Hz].

    Returns
    -------
    list of Line
        The strongest first.

    Notes
    -----
    The background is a running median of the power over some 60 bins. In noise the relative power
    of a bin is exponentially distributed, so that a peak above -ln(1e-6 / bins) occurs by chance in
    one of a million spectra.
    """
    if values.size < 128 or not np.isfinite(values).all() or np.ptp(values) == 0:
        return []
    # imported late: scipy takes long to load, and is not needed before there is a spectrum
    from scipy import ndimage

    frequency, amplitude = amplitude_spectrum(time, values)
    power = amplitude**2
    background = ndimage.median_filter(power, size=_BACKGROUND_BINS, mode="reflect") / np.log(2)
    background = np.maximum(background, 1e-30 * power.max() + np.finfo(float).tiny)
    prominence = power / background
    peak = np.flatnonzero(
        (prominence[1:-1] > -np.log(limits.RIG_LINE_BY_CHANCE.value / power.size))
        & (power[1:-1] >= power[:-2])
        & (power[1:-1] > power[2:])
    )
    peak += 1
    peak = peak[frequency[peak] > max(lowest, 3 * frequency[1])]
    peak = peak[np.argsort(-amplitude[peak])]
    return [Line(float(frequency[i]), float(amplitude[i]), float(prominence[i])) for i in peak]


def mains_harmonic(frequency: float, resolution: float, sampling_rate: float) -> str:
    """Return the name of the mains harmonic at a frequency, including aliases; else "".

    Parameters
    ----------
    frequency
        Frequency [Hz].
    resolution
        Width of a line in the spectrum [Hz].
    sampling_rate
        Sampling rate [Hz]; harmonics above half of it fold back.

    Examples
    --------
    >>> mains_harmonic(50.02, 0.1, 2000.0), mains_harmonic(47.0, 0.1, 2000.0)
    ('50 Hz', '')
    """
    tolerance = 0.15 + resolution  # Hz; power grids keep within 0.15 Hz of their frequency
    for base in (50.0, 60.0):
        for harmonic in (1, 2, 3):
            true = base * harmonic
            folded = abs(true - sampling_rate * round(true / sampling_rate))
            if true < sampling_rate / 2 and abs(frequency - true) < tolerance * harmonic:
                return f"{true:g} Hz"
            near = abs(frequency - folded) < tolerance * harmonic
            if true >= sampling_rate / 2 and near and harmonic == 1:
                return f"{true:g} Hz, folded"
    return ""
