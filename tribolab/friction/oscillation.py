"""The strongest oscillation of a record: its frequency, its size, and whether noise explains it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import ndimage, stats

from tribolab.friction.background import false_alarm, red_noise, significant_power
from tribolab.friction.lines import LONGEST, amplitude_spectrum
from tribolab.friction.spectra import Record, Spectrum, bands, spectrum

PER_DECADE = 24  # bands of the spectrum: a tenth wide, as stick-slip lines are
HARMONICS = 6
_REACH = 0.15  # a line's power is gathered over this part of its frequency to either side
_SAMPLED = 130.0  # Hz; a record that is to show 50 and 60 Hz has to be sampled faster
_GRID = 0.10  # Hz; mains keeps this close to 50 Hz nearly always
_FUNDAMENTAL = {f"{base * k:g} Hz": base for base in (50.0, 60.0) for k in (1, 2, 3)}
_MAINS_CHANCE = 3e-3  # that noise passes for a line of the mains
CYCLES = 4.0  # in a record: slower oscillations cannot be told from a wander
_HUMP = 7  # bands that a hump in the spectrum covers
_RISE = 1e-2  # chance of a spectrum without a peak to stand so far above its slower part
_TALLER = 1.5  # a peak is so many times its background: the model of that is no better
_BREADTH = 0.6  # of an irregular wave's spectrum, in the natural log of frequency
_ROUNDS = 15  # in which its mean settles
_CHANCE = 1e-3  # of the significance level that comes with a spectrum


class Mains(NamedTuple):
    """A line of the mains: frequency [Hz], amplitude (signal's unit), name."""

    frequency: float
    amplitude: float
    name: str


class Oscillation(NamedTuple):
    """What the spectrum of one record says.

    Parameters
    ----------
    frequency
        Of the strongest oscillation [Hz]; where none is significant, of the largest hump.
    frequency_error
        Standard error from the width of the peak [Hz].
    mean_frequency, mean_frequency_error
        Of a wave without a sharp line, the mean over its spectrum [Hz], see `mean_frequency`.
    false_alarm
        Probability that noise shows such a peak anywhere in the spectrum.
    prominence
        Power of the peak over its background.
    swing
        From valley to peak of the oscillation as its power (with harmonics) gives it.
    noise
        Standard deviation of the background below ten times the frequency.
    share
        Part of the variance from half the frequency on that is the oscillation.
    harmonic_content
        Amplitude of the harmonics 2 to 6 over that of the first.
    bands, power, background, level
        Spectrum in bands [Hz] and its background; level that noise exceeds with 1 in 1000.
    mains
        Lines of the mains; they are taken out first.
    method
        How the spectrum was had.
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


def find_mains(record: Record) -> tuple[Mains, ...]:
    """Lines of the mains in a record that is sampled fast and evenly enough.

    Notes
    -----
    Where to look is known, so that a line needs not stand out among all bins, as one of unknown
    frequency must (`tribolab.friction.lines.find_lines`), but among those within the grid's own
    0.1 Hz only.
    """
    n = record.values.size
    rate = 1 / record.spacing
    if not record.even or rate < _SAMPLED or n < 256:
        return ()
    frequency, amplitude = amplitude_spectrum(record.time[:LONGEST], record.values[:LONGEST])
    found = []
    for true in sorted(base * k for base in (50.0, 60.0) for k in (1, 2, 3)):
        reach = _GRID * true / 50 + frequency[1]
        near = np.flatnonzero(np.abs(frequency - true) <= reach)
        around = np.abs(frequency - true) <= max(40 * frequency[1], 5 * reach)
        if true > 0.45 * rate or near.size == 0 or around.sum() < 4 * near.size:
            continue
        at = near[np.argmax(amplitude[near])]
        usual = np.median(amplitude[around] ** 2) / np.log(2)
        if near.size * np.exp(-(amplitude[at] ** 2) / max(usual, 1e-300)) < _MAINS_CHANCE:
            found.append(Mains(float(frequency[at]), float(amplitude[at]), f"{true:g} Hz"))
    # among hundreds of segments noise passes for one or the other: a harmonic needs its fundamental
    names = {line.name for line in found}
    return tuple(line for line in found if f"{_FUNDAMENTAL[line.name]:g} Hz" in names)


def above_lower(
    fine: Spectrum, middle: np.ndarray, power: np.ndarray, freedom: np.ndarray
) -> np.ndarray:
    """Probability that a spectrum that does not rise anywhere shows so high a band.

    Parameters
    ----------
    fine
        The spectrum in its own bins.
    middle, power, freedom
        The same in bands.

    Returns
    -------
    ndarray
        Tail of the F distribution of each band's power over the mean of that from a quarter to two
        thirds of its frequency (band). However red a noise is, its spectrum falls: what stands
        above everything slower is no slow wander.
    """
    sums = np.concatenate([[0.0], np.cumsum(fine.power * fine.freedom)])
    count = np.concatenate([[0.0], np.cumsum(fine.freedom)])
    first = np.maximum(np.searchsorted(fine.frequency, middle / 4), 2)
    last = np.searchsorted(fine.frequency, middle / 1.5)
    below = count[np.maximum(last, first)] - count[first]
    usual = (sums[np.maximum(last, first)] - sums[first]) / np.maximum(below, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        chance = stats.f.sf(power / usual, freedom, below / 1.5)
    return np.where((below > 0) & (usual > 0), np.nan_to_num(chance, nan=1.0), 1.0)


def _without(found: Spectrum, mains: tuple[Mains, ...]) -> Spectrum:
    """Put the median of the surroundings where a line of the mains stands."""
    power = found.power.copy()
    for line in mains:
        at = int(np.argmin(np.abs(found.frequency - line.frequency)))
        near = power[max(at - 30, 0) : at + 31]
        power[max(at - 3, 0) : at + 4] = np.median(near) / np.log(2)
    return found._replace(power=power)


def oscillation(record: Record) -> Oscillation | None:
    """Find the strongest oscillation of a record; None if it is too short to show one.

    Parameters
    ----------
    record
        From `tribolab.friction.spectra.make_record`.

    Notes
    -----
    The spectrum is averaged over bands a tenth wide, because the periods of stick-slip scatter by
    as much; significance is that of a band over red and white noise, corrected for the number of
    bands. Of the significant bands that with the most power above the background counts.
    """
    if record.values.size < 16:
        return None
    mains = find_mains(record)
    fine = _without(spectrum(record), mains)
    middle, power, width, freedom, starts = bands(fine, PER_DECADE)
    if middle.size < 4 or not power.max() > 0:
        return None
    background = red_noise(middle, power, freedom)
    chances = false_alarm(power, background, freedom)
    excess = np.maximum(power - background, 0) * width
    cycles = middle * record.values.size * record.spacing
    rise = above_lower(fine, middle, power, freedom)
    # where many bins are averaged, less than the background's own shape is significant
    above = (chances < _CHANCE) & (rise < _RISE) & (power > _TALLER * background)
    strong = np.where(above & (cycles >= CYCLES), excess, 0.0)
    # without a significant band: where most of the power above the slow wander lies
    energy = ndimage.uniform_filter1d(np.log(np.maximum(middle * power, 1e-300)), _HUMP)
    energy = np.where(cycles >= 2 * CYCLES, energy, -np.inf)
    hump = int(np.argmax(energy))
    top = int(np.argmax(strong)) if strong.any() else hump
    at = _summit(fine, starts, top)
    level = np.interp(fine.frequency, middle, background)
    frequency, error, powers = _gather(fine, level, at)
    mean, mean_error = mean_frequency(fine, float(middle[hump]), float(level[-1]))
    variance = powers.sum()
    above = fine.frequency >= 0.5 * frequency
    total = float((fine.power * fine.width)[above].sum())
    below = middle <= 10 * frequency
    return Oscillation(
        frequency=frequency,
        frequency_error=float(max(error, 0.3 * fine.width[at])),
        mean_frequency=mean,
        mean_frequency_error=mean_error,
        false_alarm=float(max(chances[top], rise[top])),
        prominence=float(power[top] / background[top]),
        swing=float(_swing(powers)),
        noise=float(np.sqrt((background * width)[below].sum())),
        share=float(min(variance / max(total, 1e-300), 1.0)),
        harmonic_content=float(np.sqrt(powers[1:].sum() / max(powers[0], 1e-9 * variance, 1e-300))),
        bands=middle,
        power=power,
        background=background,
        level=significant_power(background, freedom, _CHANCE),
        mains=mains,
        method=fine.method,
    )


def _summit(fine: Spectrum, starts: np.ndarray, top: int) -> int:
    """Strongest bin of the strongest band."""
    stop = starts[top + 1] if top + 1 < starts.size else fine.frequency.size
    return int(starts[top] + np.argmax(fine.power[starts[top] : stop]))


def _gather(fine: Spectrum, level: np.ndarray, at: int) -> tuple[float, float, np.ndarray]:
    """Frequency of a line as the centre of its power, its error, the variance of the harmonics."""
    f0, error = float(fine.frequency[at]), 0.0
    excess = np.maximum(fine.power - level, 0) * fine.width
    for _ in range(3):
        near = np.abs(fine.frequency - f0) <= max(_REACH * f0, 2.01 * fine.width[at])
        weight = excess[near]
        if not weight.sum() > 0:
            break
        f0 = float(fine.frequency[near] @ weight / weight.sum())
        spread = float(np.sqrt((fine.frequency[near] - f0) ** 2 @ weight / weight.sum()))
        # a jittering line of width s over a record of n bins wanders by s / sqrt(bins it covers)
        error = spread / np.sqrt(max(spread / fine.width[at], 1.0))
    powers = np.zeros(HARMONICS)
    for k in range(1, HARMONICS + 1):
        reach = min(max(_REACH * k * f0, 2.01 * fine.width[at]), 0.5 * f0)
        near = np.abs(fine.frequency - k * f0) <= reach
        powers[k - 1] = excess[near].sum()
    powers[0] = max(powers[0], excess[at])
    return f0, error, powers


def mean_frequency(fine: Spectrum, start: float, floor: float) -> tuple[float, float]:
    """Mean frequency of a wave without a sharp line, and its standard error.

    Parameters
    ----------
    fine
        The spectrum.
    start
        Frequency about which the wave's power lies [Hz].
    floor
        Power density of the white noise.

    Returns
    -------
    tuple
        Both [Hz].

    Notes
    -----
    m1/m0, the mean frequency of irregular sea waves [1]_, with the moments of the spectrum under a
    lognormal window about the mean itself, so that neither wander nor hiss counts. It asks for no
    threshold, unlike the count of drops, and noise moves it half as much.

    References
    ----------
    .. [1] Longuet-Higgins (1975), J. Geophys. Res. 80, 2688. doi:10.1029/JC080i018p02688
    """
    mean = start
    frequency, power = fine.frequency[2:], ((fine.power - floor) * fine.width)[2:]
    logs = np.log(frequency)
    for _ in range(_ROUNDS):
        weight = power * np.exp(-0.5 * ((logs - np.log(mean)) / _BREADTH) ** 2)
        total, moment = float(weight.sum()), float(frequency @ weight)
        if not min(total, moment) > 0:  # nothing but white noise
            return mean, np.nan
        mean = moment / total
    # a Hann window ties neighbouring bins together: two thirds of them are independent
    scatter = 3 / fine.freedom[2:] * (weight * (frequency - mean)) ** 2
    return mean, float(np.sqrt(scatter.sum()) / total)


def _swing(powers: np.ndarray) -> float:
    """From valley to peak: between a sine's and a saw's, by the share of the harmonics."""
    variance = powers.sum()
    share = min(powers[1:].sum() / max(variance, 1e-300) / 0.39, 1.0)  # 0.39: an ideal saw's
    factor = np.sqrt(8.0) * (1 - share) + np.sqrt(12.0) * share
    return factor * np.sqrt(variance)
