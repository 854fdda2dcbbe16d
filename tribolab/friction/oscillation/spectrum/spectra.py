"""Power spectrum of an evenly or unevenly sampled record; averaged if the record is long."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import fft

from tribolab.arrays.medians import median
from tribolab.friction.oscillation import limits

# most samples of a single transform of the record; longer records are averaged
_WHOLE_TRANSFORM = 1 << 16
_MIN_WINDOW = 1 << 13  # fewest samples of the intervals whose spectra are averaged
# most intervals that are averaged, evenly spaced: the spectrum is accurate to 5 %
_MAX_WINDOWS = 384
_BATCH_SAMPLES = 1 << 18  # samples processed at a time: they fit into the cache
_HANN_WIDTH = 1.5  # number of bins that a line covers


class Spectrum(NamedTuple):
    """Frequencies [Hz], power density (unit^2/Hz), width of a bin [Hz], degrees of freedom."""

    frequency: np.ndarray
    power: np.ndarray
    width: np.ndarray
    freedom: np.ndarray
    method: str


class EvenRecord(NamedTuple):
    """Record for the analysis: times [s], values, and whether sampling is even."""

    time: np.ndarray
    values: np.ndarray
    spacing: float
    even: bool


def make_record(time: np.ndarray, values: np.ndarray) -> EvenRecord:
    """Return a record without NaN, and whether its sampling is even.

    Examples
    --------
    >>> make_record(np.arange(4.0), np.array([1.0, np.nan, 2.0, 3.0])).time.tolist()
    [0.0, 2.0, 3.0]
    """
    if not np.isfinite(values.sum()):  # the sum is NaN if any value is missing
        good = np.isfinite(values)
        time, values = time[good], values[good]
    n = values.size
    if n < 3:
        return EvenRecord(time, values, np.nan, True)
    spacing = float(time[-1] - time[0]) / (n - 1)
    # in a long record a subset is sufficient: a gap or another rate shifts all later samples
    some = max(1, n // _BATCH_SAMPLES)
    off = time[::some] - (time[0] + spacing * np.arange(0, n, some))
    even = bool(np.sqrt(np.mean(off * off)) < limits.MAX_UNEVEN_SPACING.value * spacing)
    if not even:  # if the clock runs slightly fast, sampling is even, too: compare the steps
        largest = max(
            float(np.abs(np.diff(time[i : i + _BATCH_SAMPLES + 1]) - spacing).max())
            for i in range(0, n - 1, _BATCH_SAMPLES)
        )
        even = largest < limits.MAX_UNEVEN_SPACING.value * spacing
    return EvenRecord(time, values, spacing, even)


def block_means(values: np.ndarray, size: int) -> np.ndarray:
    """Return means over blocks of `size` samples; an incomplete block at the end is dropped."""
    if size <= 1:
        return values
    count = values.size // size
    return np.add.reduceat(values[: count * size], np.arange(0, count * size, size)) / size


def coarsened(record: EvenRecord, size: int) -> EvenRecord:
    """Return the record averaged over blocks of `size` samples."""
    if size <= 1:
        return record
    values = block_means(record.values, size)
    if record.even:
        first = record.time[0] + 0.5 * (size - 1) * record.spacing
        time = first + size * record.spacing * np.arange(values.size)
    else:
        time = block_means(record.time, size)
    return EvenRecord(time, values, size * record.spacing, record.even)


def spectrum(record: EvenRecord) -> Spectrum:
    """Return the one-sided power spectrum of a record minus its least-squares line.

    Parameters
    ----------
    record
        From `make_record`, at least 8 samples.

    Returns
    -------
    Spectrum
        Up to 65 536 samples: one transform, Hann window. More: Welch's average [1]_ over intervals
        at high frequencies, and one transform of the record averaged over blocks at low ones, so
        that slow waves are also resolved. If the sampling is uneven each transform is a fit of
        sines (`tribolab.friction.oscillation.spectrum.uneven.lomb_scargle`).

    References
    ----------
    .. [1] Welch (1967), IEEE Trans. Audio Electroacoust. 15, 70. doi:10.1109/TAU.1967.1161901
    """
    method = "periodogram" if record.even else "Lomb-Scargle"
    size = int(np.ceil(record.values.size / _WHOLE_TRANSFORM))
    low = _transform(coarsened(record, size))
    if size == 1:
        return Spectrum(*low, method)
    window = max(_MIN_WINDOW, 1 << int(np.ceil(np.log2(64 * size))))
    high = _averaged(record, window)
    border = 0.25 / (size * record.spacing)
    below, above = low[0] < border, high[0] >= border
    frequency, power, width, freedom = (
        np.concatenate([a[below], b[above]]) for a, b in zip(low, high, strict=True)
    )
    # compensates the attenuation by block means
    block = np.sinc(frequency[: below.sum()] * size * record.spacing) ** 2
    power[: below.sum()] /= block
    return Spectrum(frequency, power, width, freedom, method + ", Welch")


def _transform(record: EvenRecord) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the spectrum by one transform of the whole record."""
    n = record.values.size
    count = n // 2 + 1
    duration = n * record.spacing
    place = (record.time - record.time[0]) / duration + 0.5 / n
    values = record.values - line_through(place, record.values)
    window = 0.5 - 0.5 * np.cos(2 * np.pi * place)
    frequency = np.arange(count) / duration
    if record.even:
        power = np.abs(fft.rfft(values * window)) ** 2
        power *= 2 * record.spacing / (window @ window)
    else:
        steps = np.diff(record.time)
        share = np.minimum(np.append(steps, steps[-1]), np.append(steps[0], steps))
        weights = window * np.minimum(share, 4 * median(steps))
        # imported late for a fast start
        from tribolab.friction.oscillation.spectrum.uneven import lomb_scargle

        # a sine of amplitude a has the variance a^2/2, spread over one and a half bins by the
        # window
        squares = lomb_scargle(record.time, values, weights, frequency[1], count)
        power = squares / 2 * duration / _HANN_WIDTH
    width = np.full(count, 1 / duration)
    return frequency, power, width, np.full(count, 2.0)


def line_through(place: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the values of the least-squares straight line at given positions."""
    x = place - place.mean()
    mean = values.mean()
    return mean + x * ((x @ (values - mean)) / max(float(x @ x), 1e-300))


def _averaged(
    record: EvenRecord, window: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the spectrum averaged over intervals of `window` samples that do not overlap."""
    count = record.values.size // window
    frequency = np.arange(window // 2 + 1) / (window * record.spacing)
    shape = 0.5 - 0.5 * np.cos(2 * np.pi * (np.arange(window) + 0.5) / window)
    power = np.zeros(frequency.size)
    if record.even:
        rows = max(1, _BATCH_SAMPLES // window)
        level, scale = _level_and_scale(record.values)
        # single precision: rounding adds white noise at -140 dB
        shape32 = (shape / scale).astype(np.float32)
        every = -(-count // _MAX_WINDOWS)
        stretches = record.values[: count * window].reshape(-1, window)[::every]
        count = len(stretches)
        for first in range(0, count, rows):
            part = stretches[first : first + rows]
            part = (part - level).astype(np.float32)
            part *= shape32
            sums = fft.rfft(part, axis=1, overwrite_x=True)
            power += np.einsum("ij,ij->j", sums.real, sums.real)
            power += np.einsum("ij,ij->j", sums.imag, sums.imag)
        power *= scale**2 * 2 * record.spacing / (shape @ shape) / count
    else:
        for first in range(0, count * window, window):
            own = slice(first, first + window)
            stretch = EvenRecord(record.time[own], record.values[own], record.spacing, False)
            f, p, _, _ = _transform(stretch._replace(spacing=_own_spacing(stretch)))
            power += np.interp(frequency, f, p) / count
    width = np.full(frequency.size, frequency[1])
    return frequency, power, width, np.full(frequency.size, 2.0 * count)


def _level_and_scale(values: np.ndarray) -> tuple[float, float]:
    """Return mean and standard deviation of a long record, from a sample of it."""
    some = values[:: max(1, values.size // _BATCH_SAMPLES)]
    spread = float(some.std())
    return float(some.mean()), spread if spread > 0 else 1.0


def _own_spacing(record: EvenRecord) -> float:
    return float(record.time[-1] - record.time[0]) / (record.time.size - 1)


def bands(spectrum: Spectrum, per_decade: int, first: int = 2) -> tuple[np.ndarray, ...]:
    """Return a spectrum averaged over bands of equal relative width (at least one bin wide).

    Parameters
    ----------
    spectrum
        Spectrum.
    per_decade
        Bands in a decade of frequency.
    first
        First bin used: lower ones contain the leakage of the trend.

    Returns
    -------
    tuple
        Frequency [Hz], power density, width [Hz] and degrees of freedom of each band, and the
        first bin of each.
    """
    f = spectrum.frequency
    if f.size <= first + 1:
        return (np.zeros(0),) * 4 + (np.zeros(0, int),)
    decades = np.log10(f[-1] / f[first])
    edges = f[first] * 10 ** (np.arange(int(np.ceil(decades * per_decade)) + 1) / per_decade)
    starts = np.unique(np.searchsorted(f, edges * (1 - 1e-9)))
    starts = starts[(starts >= first) & (starts < f.size)]
    count = np.diff(np.append(starts, f.size))
    width = np.add.reduceat(spectrum.width, starts)
    power = np.add.reduceat(spectrum.power * spectrum.width, starts) / width
    middle = np.add.reduceat(f, starts) / count
    # a Hann window correlates neighbouring bins: two thirds of them are independent
    freedom = np.add.reduceat(spectrum.freedom, starts) / np.where(count > 1, 1.5, 1.0)
    return middle, power, width, freedom, starts
