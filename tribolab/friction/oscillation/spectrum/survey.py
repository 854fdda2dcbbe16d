"""Spectrum of a record in bands, with its noise background."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.arrays.medians import median
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.spectrum.background import false_alarm, red_noise
from tribolab.friction.oscillation.spectrum.mains import Mains, find_mains
from tribolab.friction.oscillation.spectrum.spectra import EvenRecord, Spectrum, bands, spectrum


class Survey(NamedTuple):
    """Spectrum of a record in bins and bands, with the fitted noise.

    Parameters
    ----------
    fine
        The spectrum in its own bins, without the mains.
    middle, power, width, freedom, first
        Bands: frequency [Hz], power density, width [Hz], degrees of freedom, first bin.
    background
        Power density of red and white noise (band).
    chance, rise
        Probability that noise reaches the power of a band, and that it exceeds slower bands as far.
    duration
        Duration of the record [s].
    mains
        Lines of the mains.
    """

    fine: Spectrum
    middle: np.ndarray
    power: np.ndarray
    width: np.ndarray
    freedom: np.ndarray
    first: np.ndarray
    background: np.ndarray
    chance: np.ndarray
    rise: np.ndarray
    duration: float
    mains: tuple[Mains, ...]

    @property
    def cycles(self) -> np.ndarray:
        """Number of periods of each band's frequency in the record (band)."""
        return self.middle * self.duration

    @property
    def excess(self) -> np.ndarray:
        """Variance above the background (band)."""
        return np.maximum(self.power - self.background, 0) * self.width

    @property
    def significant(self) -> np.ndarray:
        """Mask of the bands that noise does not explain.

        A minimum ratio excludes misfits of the background, significant with many averaged bins.
        """
        tall = self.power > limits.MIN_PEAK_OVER_BACKGROUND.value * self.background
        return (
            (self.chance < limits.BAND_BY_CHANCE.value)
            & (self.rise < limits.RISE_BY_CHANCE.value)
            & tall
        )

    def without(self, part: np.ndarray) -> Survey:
        """Return the survey with masked bins replaced by the background (bin)."""
        level = np.interp(self.fine.frequency, self.middle, self.background)
        fine = self.fine._replace(power=np.where(part, level, self.fine.power))
        return _survey(fine, self.duration, self.mains, self.background)


def survey(record: EvenRecord) -> Survey | None:
    """Compute the spectrum of a record and fit its noise; None if it is too short.

    Parameters
    ----------
    record
        From `tribolab.friction.oscillation.spectrum.spectra.make_record`.
    """
    if record.values.size < 16:
        return None
    mains = find_mains(record)
    fine = _remove_mains(spectrum(record), mains)
    middle, power = bands(fine, limits.BANDS_PER_DECADE.value)[:2]
    if middle.size < 4 or not power.max() > 0:
        return None
    return _survey(fine, record.values.size * record.spacing, mains)


def _survey(
    fine: Spectrum, duration: float, mains: tuple[Mains, ...], background: np.ndarray | None = None
) -> Survey:
    middle, power, width, freedom, first = bands(fine, limits.BANDS_PER_DECADE.value)
    if background is None:
        background = red_noise(middle, power, freedom)
    chance = false_alarm(power, background, freedom)
    rise = above_lower(fine, middle, power, freedom)
    return Survey(
        fine, middle, power, width, freedom, first, background, chance, rise, duration, mains
    )


def above_lower(
    fine: Spectrum, middle: np.ndarray, power: np.ndarray, freedom: np.ndarray
) -> np.ndarray:
    """Return the probability that chance lifts a band so far above bands of lower frequency (band).

    Parameters
    ----------
    fine
        The spectrum in its own bins.
    middle, power, freedom
        The spectrum in bands.

    Returns
    -------
    ndarray
        Tail of the F distribution of each band's power relative to the mean power between a quarter
        and two thirds of its frequency (band). The spectrum of red noise falls: a band above all
        slower ones is not slow drift.
    """
    sums = np.concatenate([[0.0], np.cumsum(fine.power * fine.freedom)])
    count = np.concatenate([[0.0], np.cumsum(fine.freedom)])
    first = np.maximum(np.searchsorted(fine.frequency, middle / 4), 2)
    last = np.searchsorted(fine.frequency, middle / 1.5)
    below = count[np.maximum(last, first)] - count[first]
    usual = (sums[np.maximum(last, first)] - sums[first]) / np.maximum(below, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        chance = special.fdtrc(freedom, below / 1.5, power / usual)
    return np.where((below > 0) & (usual > 0), np.nan_to_num(chance, nan=1.0), 1.0)


def _remove_mains(spectrum: Spectrum, mains: tuple[Mains, ...]) -> Spectrum:
    """Return the spectrum with mains lines replaced by the median of their surroundings."""
    power = spectrum.power.copy()
    for line in mains:
        at = int(np.argmin(np.abs(spectrum.frequency - line.frequency)))
        near = power[max(at - 30, 0) : at + 31]
        power[max(at - 3, 0) : at + 4] = median(near) / np.log(2)
    return spectrum._replace(power=power)
