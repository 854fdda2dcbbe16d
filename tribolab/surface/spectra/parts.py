"""Spectrum of profiles with long gaps, computed from the measured parts between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.surface.gaps import GapEffect, gap_effect, logarithm
from tribolab.surface.spectra.binning import Bins, window
from tribolab.surface.spectra.fourier import binned_power

_LONG_GAP = 1 / 32  # gaps longer than this share of a profile split it; shorter ones are bridged
# parts below this share of the longest one are left out: they do not resolve long waves
_MIN_PART = 0.25


class Transform(NamedTuple):
    """Settings of the Fourier transform of profiles.

    Bins of lines, length of the transform [points], order of the polynomial that was removed as
    form, flanks of the window (`tribolab.surface.spectra.binning.window`), threads.
    """

    bins: Bins
    length: int
    order: int
    flanks: float
    workers: int = 1

    def power(self, rows: np.ndarray, taper: np.ndarray) -> np.ndarray:
        """Return the power of profiles (scan, x) in each bin, summed over the scans."""
        return binned_power(rows, taper, self.bins, self.length, self.workers).bins

    def first(self, points: int) -> int:
        """Return the index of the first bin whose waves are short compared with `points` points."""
        lowest = (self.order + 2) * self.length / points
        return int(np.searchsorted(self.bins.starts, lowest))


class PartsSpectrum(NamedTuple):
    """Power spectrum of profiles, from the measured parts between their gaps.

    Sum over the scans, scaled to whole profiles (bin,); its relative standard error (bin,); number
    of the first bin whose waves are short compared with the parts.
    """

    power: np.ndarray
    error: np.ndarray
    first: int


def profile_gap_effect(height: np.ndarray, missing: np.ndarray, how: Transform) -> GapEffect:
    """Return the effect of bridged gaps on ln(power) of the profiles.

    Parameters
    ----------
    height
        Bridged heights [m] (scan, x).
    missing
        Mask of missing heights, in the shape of the heights.
    how
        Settings of the transform.

    Returns
    -------
    GapEffect
        Effect in each bin (bin,). For waves that are short compared with the parts between long
        gaps, the spectrum of the parts replaces that of the bridged profiles; only short gaps count
        there.

    Raises
    ------
    AnalysisError
        If more than half of a scan is missing.
    """
    taper = window(height.shape[1], how.flanks)

    def powers(rows: np.ndarray) -> np.ndarray:
        return logarithm(how.power(rows, taper))

    effect = gap_effect(height, missing, powers, is_map=False, joint=True)
    parts = parts_spectrum(height, missing, how)
    if parts is None:
        return effect
    short = missing & ~long_gaps(missing)
    nothing = np.zeros(parts.power.size)
    rest = GapEffect(nothing, nothing, nothing)
    if short.any():
        rest = gap_effect(height, short, powers, is_map=False, joint=True)
    high = np.arange(nothing.size) >= parts.first
    shift = powers(height) - logarithm(parts.power) + rest.shift
    return GapEffect(
        np.where(high, shift, effect.shift),
        np.where(high, np.hypot(parts.error, rest.error), effect.error),
        np.where(high, rest.bridges, effect.bridges),
    )


def long_gaps(missing: np.ndarray) -> np.ndarray:
    """Return a mask (scan, x) of the missing heights in gaps long enough to split the profile.

    >>> row = np.zeros((1, 64), bool)
    >>> row[0, [5, 20, 21, 22]] = True
    >>> np.flatnonzero(long_gaps(row)).tolist()
    [20, 21, 22]
    """
    least, long = max(2, int(_LONG_GAP * missing.shape[-1])), np.zeros(missing.shape, dtype=bool)
    for row, gaps in zip(long, missing, strict=True):
        for start, stop in _stretches(gaps):
            row[start:stop] = stop - start >= least
    return long


def parts_spectrum(height: np.ndarray, missing: np.ndarray, how: Transform) -> PartsSpectrum | None:
    """Return the spectrum from the measured parts between long gaps, each with its own window.

    Parameters
    ----------
    height
        Bridged heights [m] (scan, x).
    missing
        Mask of missing heights, in the shape of the heights.
    how
        Settings of the transform; form is removed from each part separately.

    Returns
    -------
    PartsSpectrum or None
        None if no gap is long, or no wave is short compared with the parts.

    Notes
    -----
    A window that falls to zero at each gap excludes bridges, so that no correction is needed for
    waves that are short compared with the part. As for a whole profile of the part's length, the
    lowest lines are left out. The powers of one line in two windows ``v`` and ``w`` of unit mean
    square have the covariance ``<v^2 w^2>`` in units of a bin of many lines; hence the variance of
    the parts' spectrum about the whole, ``<v^4> + <w^4> - 2 <v^2 w^2>`` over the number of lines
    [1]_. If the parts of a scan differ by more than this theory of Gaussian heights allows, the
    error is larger by that factor. For single profiles with one hole of an eighth, a quarter and a
    half, 1.96 errors included the value of the complete profile in 94, 95 and 96 % of cases
    (`tests/coverage/gap_coverage.py`, sixty profiles).

    References
    ----------
    .. [1] P. D. Welch, The use of fast Fourier transform for the estimation of power spectra,
       IEEE Trans. Audio Electroacoust. 15 (1967) 70, doi:10.1109/TAU.1967.1161901.
    """
    long = long_gaps(missing)
    if not long.any():
        return None
    points = height.shape[1]
    whole = window(points, how.flanks)
    # number of independent Fourier lines in each bin, without zero padding
    lines = how.bins.counts * points / how.length
    power, variance = np.zeros(lines.size), np.zeros(lines.size)
    first, unlike = 0, 1.0
    for row, gaps in zip(height, long, strict=True):
        parts = _parts(gaps)
        tapers = _tapers(parts, points, how.flanks)
        each = [
            how.power(_remove_form(row, part, how.order)[None], taper)
            for part, taper in zip(parts, tapers, strict=True)
        ]
        power += np.sum(each, axis=0)
        squares = np.sum(tapers, axis=0) ** 2
        weight = lines / np.mean(squares**2)
        # the logarithm of few values scatters more and has longer tails
        variance += np.mean((squares - whole**2) ** 2) / lines * (1.0 + 1.5 / weight)
        first = max(first, how.first(min(stop - start for start, stop in parts)))
        unlike = max(unlike, _excess_scatter(np.array(each), np.array(tapers), lines, first))
    if first >= lines.size:
        return None
    return PartsSpectrum(power, unlike * np.sqrt(variance) / len(height), first)


def _stretches(truth: np.ndarray) -> list[tuple[int, int]]:
    """Return the first index and end of each interval where a mask is true."""
    steps = np.diff(np.concatenate([[0], truth.astype(np.int8), [0]]))
    return list(zip(np.flatnonzero(steps > 0), np.flatnonzero(steps < 0), strict=True))


def _parts(gaps: np.ndarray) -> list[tuple[int, int]]:
    """Return the intervals between gaps, without those much shorter than the longest."""
    every = _stretches(~gaps)
    longest = max(stop - start for start, stop in every)
    return [(start, stop) for start, stop in every if stop - start >= _MIN_PART * longest]


def _tapers(parts: list[tuple[int, int]], points: int, flanks: float) -> list[np.ndarray]:
    """Return the window of each part (x); the sum of all has unit mean square over the profile."""
    scale = np.sqrt(points / sum(stop - start for start, stop in parts))
    tapers = []
    for start, stop in parts:
        taper = np.zeros(points)
        taper[start:stop] = scale * window(stop - start, flanks)
        tapers.append(taper)
    return tapers


def _remove_form(row: np.ndarray, part: tuple[int, int], order: int) -> np.ndarray:
    """Return heights without the polynomial form fitted to one part of the profile."""
    x = np.linspace(-1.0, 1.0, part[1] - part[0])
    basis = np.polynomial.legendre.legvander(x, order)
    here = row[slice(*part)]
    left = np.zeros(row.shape)
    left[slice(*part)] = here - basis @ np.linalg.lstsq(basis, here, rcond=None)[0]
    return left


def _excess_scatter(powers: np.ndarray, tapers: np.ndarray, lines: np.ndarray, first: int) -> float:
    """Return how many times more the spectra of parts scatter than those of Gaussian heights."""
    known = np.arange(lines.size) >= first
    if len(powers) < 2 or not known.any():
        return 1.0
    squares = np.mean(tapers**2, axis=1)[:, None]
    weights = lines[known] * squares**2 / np.mean(tapers**4, axis=1)[:, None]
    spectra = logarithm(powers[:, known] / squares)
    mean = np.average(spectra, axis=0, weights=weights)
    chi = weights * (spectra - mean) ** 2
    return float(np.sqrt(max(1.0, chi.sum() / (len(powers) - 1) / known.sum())))
