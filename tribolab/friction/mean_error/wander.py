"""Error of the mean of a record due to slow drift, from its lowest cosine terms.

Notes
-----
The cosine coefficients of a record are nearly independent, and the variance of the lowest ones is
that of the mean times a factor that depends on the kind of drift. The record is modelled as calm
(white at low frequencies) or as an Ornstein-Uhlenbeck process plus white noise. Each correlation
time from 1/20 of the record to six records and each share of white noise is weighted by its
likelihood given the cosines, their scale integrated out with Jeffreys' prior [1]_. The standard
error is the weighted median over the models, U95 the half interval that contains 95 % of the
mixture of their Student distributions.

References
----------
.. [1] Gelman et al. (2013), Bayesian Data Analysis, ch. 14. doi:10.1201/b16018
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import special
from scipy.fft import dct

from tribolab.friction.mean_error import limits
from tribolab.friction.mean_error.autoregression import spectra_of

_MEMORY_GRID = np.geomspace(0.05, 6.0, 8)  # correlation times, as shares of the record
# trial ratios of the variance of white noise to that of the drift, at low frequencies
_WHITE_SHARES = np.array([0.0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0])
_MIN_COSINES = 4
_MAX_STEPS = 60  # most steps of Newton's method for U95; about six are needed
_CONVERGED = 1e-11  # relative step at which U95 is found
_WIDEST_BRACKET = np.log(1e12)
_OUTSIDE_COVERAGE = 0.05


class _Shapes(NamedTuple):
    """Variances of the cosines and of the mean under each drift model, and log prior (model)."""

    cosines: np.ndarray
    mean: np.ndarray
    prior: np.ndarray


@lru_cache(maxsize=32)
def _shapes(cosines: int) -> _Shapes:
    f = np.arange(1, cosines + 1) / 2.0
    rows, means = [np.ones(cosines)], [1.0]
    for time in _MEMORY_GRID:
        wander = 2 * time / (1 + (2 * np.pi * f * time) ** 2)
        level = wander[:4].mean()
        mean = 2 * time * (1 - time * (1 - np.exp(-1 / time)))
        rows += [wander / level + white for white in _WHITE_SHARES]
        means += [mean / level + white for white in _WHITE_SHARES]
    calm = limits.CALM.value
    prior = np.full(len(rows), np.log((1 - calm) / (len(rows) - 1)))
    prior[0] = np.log(calm)
    return _Shapes(np.array(rows), np.array(means), prior)


class MeanErrors(NamedTuple):
    """Standard error and U95 of the means of records (record), in the records' unit."""

    sem: np.ndarray
    u95: np.ndarray


def errors_of_means(
    rest: np.ndarray, lines: Sequence[Sequence[float]], courses: Sequence[int]
) -> MeanErrors:
    """Return standard errors and U95 of the means of records.

    Parameters
    ----------
    rest
        Records minus oscillations and trends (record, sample), of at least three samples.
    lines
        Cycles of the oscillations fitted to each record: cosines near them are not used.
    courses
        Number of trends fitted to each record; that many of the lowest cosines are not used.
    """
    count, samples = rest.shape
    most = min(int(limits.COSINES.value), samples - 1)
    kept = _kept_cosines(rest, most, lines, courses)
    squares = dct(rest, norm="ortho", axis=1)[:, 1 : most + 1] ** 2 * kept
    shapes = _shapes(most)
    free = kept.sum(axis=1)
    sums = squares @ (1 / shapes.cosines).T  # (record, model)
    floor = 1e-300
    likely = (
        shapes.prior
        - 0.5 * kept @ np.log(shapes.cosines).T
        - 0.5 * free[:, None] * np.log(np.maximum(sums, floor))
    )
    weight = np.exp(likely - likely.max(axis=1, keepdims=True))
    weight /= weight.sum(axis=1, keepdims=True)
    errors = np.sqrt(np.maximum(sums, 0.0) / free[:, None] * shapes.mean / samples)
    order = np.argsort(errors, axis=1, kind="stable")
    beneath = np.cumsum(np.take_along_axis(weight, order, axis=1), axis=1)
    middle = np.minimum((beneath < 0.5).sum(axis=1), errors.shape[1] - 1)
    rows = np.arange(count)
    sem = errors[rows, order[rows, middle]]
    return MeanErrors(sem, _half_interval(weight, errors, free))


def _kept_cosines(
    rest: np.ndarray, most: int, lines: Sequence[Sequence[float]], courses: Sequence[int]
) -> np.ndarray:
    """Return a mask of the lowest cosines that determine the drift (record, cosine)."""
    count, samples = rest.shape
    highest = np.full(count, most)
    if samples >= 2 * _MIN_COSINES:
        f = np.arange(1, samples) / 2.0
        power = spectra_of(rest, f)
        peak = np.where(f > 2.5, power, 0.0).argmax(axis=1)
        at = f[peak]
        low = f <= np.maximum(at / 4, 1.0)[:, None]
        level = (power * low).sum(axis=1) / low.sum(axis=1)
        hump = (at > 2.5) & (power[np.arange(count), peak] > limits.HUMP.value * level)
        highest = np.where(hump, np.clip(at.astype(int), 5, most), most)
    number = np.arange(1, most + 1)
    kept = number <= highest[:, None]
    for row, (cycles, fitted) in enumerate(zip(lines, courses, strict=True)):
        before = kept[row].copy()
        kept[row] &= number > min(fitted, 2)
        for wave in cycles:
            kept[row] &= (number != np.floor(2 * wave)) & (number != np.ceil(2 * wave))
        if kept[row].sum() < _MIN_COSINES:
            kept[row] = before & (number > min(fitted, 1))
    kept[~kept.any(axis=1), 0] = True
    return kept.astype(float)


def _half_interval(weight: np.ndarray, errors: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return the half width of the 95 % interval of each mixture of t distributions (record).

    Newton's method for the logarithm of the probability beyond it, as a function of the logarithm
    of the half interval; a step that leaves the bracket is replaced by a bisection.
    """
    quantile = special.stdtrit(free, 1 - _OUTSIDE_COVERAGE / 2)
    known = errors.max(axis=1) > 0
    scale = np.where(errors > 0, errors, 1e-300)
    low = np.log(quantile) + np.log(scale.min(axis=1))
    high = np.log(quantile) + np.log(scale.max(axis=1))
    low = np.maximum(low, high - _WIDEST_BRACKET)
    found = np.log(quantile) + np.log((weight * errors).sum(axis=1).clip(1e-300))
    found = np.clip(found, low, high)
    density = np.exp(special.gammaln((free + 1) / 2) - special.gammaln(free / 2))
    density /= np.sqrt(np.pi * free)
    left = np.flatnonzero(known)
    for _ in range(_MAX_STEPS):
        if not left.size:
            break
        dof, x = free[left, None], found[left]
        ratio = np.exp(x)[:, None] / scale[left]
        beyond = (weight[left] * special.stdtr(dof, -ratio)).sum(axis=1)
        fall = ratio * (1 + ratio**2 / dof) ** (-(dof + 1) / 2)
        slope = (weight[left] * fall).sum(axis=1) * density[left]
        out = beyond > _OUTSIDE_COVERAGE / 2
        low[left] = np.where(out, x, low[left])
        high[left] = np.where(out, high[left], x)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.log(beyond / (_OUTSIDE_COVERAGE / 2)) * beyond / slope
        inside = (x + step >= low[left]) & (x + step <= high[left])
        found[left] = np.where(inside, x + step, (low[left] + high[left]) / 2)
        left = left[np.abs(found[left] - x) > _CONVERGED]
    return np.where(known, np.exp(found), 0.0)
