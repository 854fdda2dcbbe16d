"""Slow trends of records: a line, or an exponential approach as in running-in."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import special
from scipy.fft import dct

from tribolab.friction.mean_error import limits
from tribolab.friction.mean_error.autoregression import sieve_of

LINE = 0.0  # stands for a line in lists of time constants of exponentials
_COURSE_TIMES = np.concatenate([[LINE], np.geomspace(0.02, 1.0, 12)])  # as shares of the record


def shape_of(time: float, count: int) -> np.ndarray:
    """Return a line or an exponential over a record, minus its mean (sample).

    Parameters
    ----------
    time
        `LINE`, or the time constant of the exponential as a share of the record.
    count
        Number of samples.
    """
    t = (np.arange(count) + 0.5) / count
    shape = t if time == LINE else np.exp(-t / time)
    return shape - shape.mean()


@lru_cache(maxsize=16)
def _shapes(count: int) -> np.ndarray:
    return np.stack([shape_of(time, count) for time in _COURSE_TIMES])


class LineFit(NamedTuple):
    """Straight line through each record: change from start to end, and its p value (record)."""

    change: np.ndarray
    chance: np.ndarray


def line_through(records: np.ndarray) -> LineFit:
    """Fit a line to each record and test it against the correlated residuals.

    Parameters
    ----------
    records
        Records of equal length, in any unit (record, sample).
    """
    count = records.shape[1]
    shape = shape_of(LINE, count)
    centred = records - records.mean(axis=1, keepdims=True)
    slope = centred @ shape / (shape @ shape)
    rest = centred - slope[:, None] * shape
    exact = np.abs(rest).max(axis=1) <= 1e-14 * np.abs(records).max(axis=1)
    error, freedom = _error_of_size(rest, shape[None], fitted=2)
    chance = 2 * special.stdtr(freedom, -np.abs(slope) / np.maximum(error, 1e-300))
    chance = np.where(exact, np.where(slope != 0, 0.0, 1.0), chance)
    return LineFit(slope, chance)


def _error_of_size(
    rest: np.ndarray, shapes: np.ndarray, fitted: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the standard error of a fitted trend, and its degrees of freedom (record)."""
    count = rest.shape[1]
    sieve = sieve_of(rest, fitted)
    cosines = dct(shapes, norm="ortho", axis=1)[:, 1:]
    power = sieve.power(np.arange(1, count) / 2.0, count)
    remembers = sieve.models.order > 0
    low = np.where(remembers, 0.999 * sieve.long_run_variance, 0.0)[:, None]
    power[:, :4] = np.maximum(power[:, :4], low)
    error = np.sqrt((cosines**2 * power).sum(axis=1)) / (shapes**2).sum(axis=1)
    return error, np.maximum(sieve.effective_samples - 2, 2.0)


def courses_of(records: np.ndarray) -> list[list[float]]:
    """Return at most two trends per record: `LINE`, or the time constant of an exponential.

    Parameters
    ----------
    records
        Records without oscillations, of equal length (record, sample).
    """
    number, count = records.shape
    found: list[list[float]] = [[] for _ in range(number)]
    if count < limits.MIN_SAMPLES_OF_COURSE.value:
        return found
    shapes = _shapes(count)
    rest = records - records.mean(axis=1, keepdims=True)
    looked = np.arange(number)
    # candidate trends of each record, made orthogonal to those fitted before
    left = np.broadcast_to(shapes, (number, *shapes.shape))
    dearer = np.where(_COURSE_TIMES == LINE, 1.0, limits.EXPONENTIAL_OVER_LINE.value)
    for fitted in range(int(limits.MAX_COURSES.value)):
        own = left[looked]
        norm = (own**2).sum(axis=2)
        usable = norm > 1e-9 * (shapes**2).sum(axis=1)
        size = np.einsum("rsn,rn->rs", own, rest[looked]) / np.where(usable, norm, 1.0)
        squares = (rest[looked] ** 2).sum(axis=1)[:, None] - size**2 * norm
        best = np.where(usable, squares * dearer, np.inf).argmin(axis=1)
        rows = np.arange(looked.size)
        shape, amount = own[rows, best], size[rows, best]
        after = rest[looked] - amount[:, None] * shape
        error, freedom = _error_of_size(after, shape, fitted=2 + fitted)
        limit = special.stdtrit(freedom, 1 - limits.COURSE_BY_CHANCE.value / 2)
        sure = np.abs(amount) > limit * error
        for row in np.flatnonzero(sure).tolist():
            found[looked[row]].append(float(_COURSE_TIMES[best[row]]))
        kept, shape = looked[sure], shape[sure]
        if not kept.size or fitted + 1 == int(limits.MAX_COURSES.value):
            break
        rest[kept] = after[sure]
        part = np.einsum("rsn,rn->rs", left[kept], shape) / (shape**2).sum(axis=1)[:, None]
        left = np.array(left)
        left[kept] -= part[:, :, None] * shape[:, None, :]
        looked = kept
    return found
