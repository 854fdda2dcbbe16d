"""Strongest oscillation of a record: frequency, size, and significance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.spectrum.background import significant_power
from tribolab.friction.oscillation.spectrum.mains import Mains
from tribolab.friction.oscillation.spectrum.spectra import Spectrum
from tribolab.friction.oscillation.spectrum.survey import Survey

_SUMMED_HARMONICS = 6
_BANDS_OF_HUMP = 7  # width of a broad hump in the spectrum, in bands
_MEAN_FREQUENCY_ROUNDS = 15  # iterations in which the mean frequency converges


class Oscillation(NamedTuple):
    """Strongest oscillation in the spectrum of one record.

    Parameters
    ----------
    frequency
        Frequency of the strongest oscillation [Hz]; if none is significant, of the largest hump.
    frequency_error
        Standard error from the width of the peak [Hz].
    mean_frequency, mean_frequency_error
        For a wave without a sharp line, the mean over its spectrum [Hz], see `mean_frequency`.
    false_alarm
        Probability that noise causes such a peak anywhere in the spectrum.
    prominence
        Ratio of the power of the peak to its background.
    swing
        Peak-to-valley size of the oscillation, from its power (with harmonics).
    noise
        Standard deviation of the background below ten times the frequency.
    share
        Share of the oscillation in the variance above half its frequency.
    harmonic_content
        Amplitude of the harmonics 2 to 6 relative to the first.
    bands, power, background, level
        Spectrum in bands [Hz], its background, and the level that noise exceeds once in 1000.
    mains
        Lines of the mains; they are removed first.
    method
        Method of the spectrum.
    """

    frequency: float
    frequency_error: float
    mean_frequency: float
    mean_frequency_error: float
    false_alarm: float
    prominence: float
    swing: float
    noise: float
    share: float
    harmonic_content: float
    bands: np.ndarray
    power: np.ndarray
    background: np.ndarray
    level: np.ndarray
    mains: tuple[Mains, ...]
    method: str


def oscillation(seen: Survey, near: float | None = None) -> Oscillation:
    """Find the strongest oscillation of a record.

    Parameters
    ----------
    seen
        From `tribolab.friction.oscillation.spectrum.survey.survey`.
    near
        Frequency of the drops [Hz]: the oscillation is searched for near it, even if a harmonic is
        stronger.

    Notes
    -----
    The spectrum is averaged over bands a tenth wide, because the periods of stick-slip scatter by
    as much; significance is that of a band over red and white noise, corrected for the number of
    bands. Among the significant bands, the one with the most power above the background is used.
    """
    fine, middle, power, width = seen.fine, seen.middle, seen.power, seen.width
    strong = np.where(
        seen.significant & (seen.cycles >= limits.MIN_CYCLES_IN_RECORD.value), seen.excess, 0.0
    )
    # without a significant band, take the maximum of smoothed frequency times power, above drift
    energy = ndimage.uniform_filter1d(np.log(np.maximum(middle * power, 1e-300)), _BANDS_OF_HUMP)
    energy = np.where(seen.cycles >= 2 * limits.MIN_CYCLES_IN_RECORD.value, energy, -np.inf)
    hump = int(np.argmax(energy))
    top = int(np.argmax(strong)) if strong.any() else hump
    chance = float(max(seen.chance[top], seen.rise[top]))
    prominence = power[top] / seen.background[top]
    at = _summit(fine, seen.first, top) if near is None else _nearest_summit(fine, near)
    level = np.interp(fine.frequency, middle, seen.background)
    frequency, error, powers = gather(fine, level, at)
    start = float(middle[hump]) if near is None else near
    mean, mean_error = mean_frequency(fine, start, float(level[-1]))
    variance = powers.sum()
    above = fine.frequency >= 0.5 * frequency
    total = float((fine.power * fine.width)[above].sum())
    below = middle <= 10 * frequency
    return Oscillation(
        frequency=frequency,
        frequency_error=float(max(error, 0.3 * fine.width[at])),
        mean_frequency=mean,
        mean_frequency_error=mean_error,
        false_alarm=chance,
        prominence=float(prominence),
        swing=float(_swing(powers)),
        noise=float(np.sqrt((seen.background * width)[below].sum())),
        share=float(min(variance / max(total, 1e-300), 1.0)),
        harmonic_content=float(np.sqrt(powers[1:].sum() / max(powers[0], 1e-9 * variance, 1e-300))),
        bands=middle,
        power=power,
        background=seen.background,
        level=significant_power(seen.background, seen.freedom, limits.BAND_BY_CHANCE.value),
        mains=seen.mains,
        method=fine.method,
    )


def _nearest_summit(fine: Spectrum, near: float) -> int:
    """Return the strongest bin near a frequency, except bin 0; if none is near, the nearest bin."""
    part = np.abs(fine.frequency - near) <= max(
        limits.MAX_DISTANCE_FROM_DROPS.value * near, 1.01 * fine.width[0]
    )
    part[:1] = False
    if not part.any():
        return 1 + int(np.argmin(np.abs(fine.frequency[1:] - near)))
    return int(np.argmax(np.where(part, fine.power, -1.0)))


def _summit(fine: Spectrum, starts: np.ndarray, top: int) -> int:
    """Return the index of the strongest spectral bin in the strongest band."""
    stop = starts[top + 1] if top + 1 < starts.size else fine.frequency.size
    return int(starts[top] + np.argmax(fine.power[starts[top] : stop]))


def gather(fine: Spectrum, level: np.ndarray, at: int) -> tuple[float, float, np.ndarray]:
    """Return a line's frequency (centre of its power) with error, and variances of harmonics."""
    f0, error = float(fine.frequency[at]), 0.0
    excess = np.maximum(fine.power - level, 0) * fine.width
    excess[fine.frequency <= 0] = 0.0  # what remains of the mean is not part of a line
    for _ in range(3):
        near = np.abs(fine.frequency - f0) <= max(
            limits.HALF_WIDTH_OF_GATHERED_BAND.value * f0, 2.01 * fine.width[at]
        )
        weight = excess[near]
        if not weight.sum() > 0:
            break
        f0 = float(fine.frequency[near] @ weight / weight.sum())
        spread = float(np.sqrt((fine.frequency[near] - f0) ** 2 @ weight / weight.sum()))
        # the centre of a line of width s, broadened by jitter, scatters by s / sqrt(bins it
        # covers)
        error = spread / np.sqrt(max(spread / fine.width[at], 1.0))
    powers = np.zeros(_SUMMED_HARMONICS)
    for k in range(1, _SUMMED_HARMONICS + 1):
        reach = min(
            max(limits.HALF_WIDTH_OF_GATHERED_BAND.value * k * f0, 2.01 * fine.width[at]), 0.5 * f0
        )
        near = np.abs(fine.frequency - k * f0) <= reach
        powers[k - 1] = excess[near].sum()
    powers[0] = max(powers[0], excess[at])
    return f0, error, powers


def mean_frequency(fine: Spectrum, start: float, floor: float) -> tuple[float, float]:
    """Return the mean frequency of a wave without a sharp line, and its standard error.

    Parameters
    ----------
    fine
        The spectrum.
    start
        Frequency around which the wave's power is [Hz].
    floor
        Power density of the white noise.

    Returns
    -------
    tuple
        Mean frequency and its standard error [Hz].

    Notes
    -----
    It is m1/m0, as for irregular sea waves [1]_, with the moments of the spectrum in a lognormal
    window around the mean itself, which excludes slow drift and noise. Unlike the
    count of drops it needs no threshold, and noise shifts it half as much.

    References
    ----------
    .. [1] Longuet-Higgins (1975), J. Geophys. Res. 80, 2688. doi:10.1029/JC080i018p02688
    """
    mean = start
    frequency, power = fine.frequency[2:], ((fine.power - floor) * fine.width)[2:]
    logs = np.log(frequency)
    for _ in range(_MEAN_FREQUENCY_ROUNDS):
        weight = power * np.exp(
            -0.5 * ((logs - np.log(mean)) / limits.BREADTH_OF_IRREGULAR_WAVE.value) ** 2
        )
        total, moment = float(weight.sum()), float(frequency @ weight)
        if not min(total, moment) > 0:  # nothing but white noise
            return mean, np.nan
        mean = moment / total
    # a Hann window correlates neighbouring bins: two thirds of them are independent
    scatter = 3 / fine.freedom[2:] * (weight * (frequency - mean)) ** 2
    return mean, float(np.sqrt(scatter.sum()) / total)


def _swing(powers: np.ndarray) -> float:
    """Return the peak-to-valley swing: between that of sine and sawtooth, by share of harmonics."""
    variance = powers.sum()
    share = min(powers[1:].sum() / max(variance, 1e-300) / 0.39, 1.0)  # 0.39: an ideal sawtooth
    factor = np.sqrt(8.0) * (1 - share) + np.sqrt(12.0) * share
    return factor * np.sqrt(variance)
