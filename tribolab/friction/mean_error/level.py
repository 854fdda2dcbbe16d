"""Mean level of a record without oscillations, and its error by trends and slow drift.

Notes
-----
An oscillation biases the mean over an incomplete period; the level is the mean without it. A trend
(drift, running-in) belongs to the path: the mean over the path includes it. A mean that represents
the surface beyond the path treats the trend as slow drift that may continue. So each record has two
errors: of the mean over its path, and beyond it.

Coverage of the 95 % interval over 500 records of 1920 samples each and the median standard error
over the true scatter (``tests/coverage/mean_coverage.py``) are given in `docs/metrology.md`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.friction.mean_error import limits
from tribolab.friction.mean_error.course import courses_of, shape_of
from tribolab.friction.mean_error.lines import lines_of, waves_of
from tribolab.friction.mean_error.wander import errors_of_means


class Levels(NamedTuple):
    """Levels of records with errors (record), in the unit of the records."""

    level: np.ndarray  # mean without oscillations
    sem: np.ndarray
    u95: np.ndarray
    sem_beyond: np.ndarray
    u95_beyond: np.ndarray
    lines: list[list[float]]
    courses: list[list[float]]


def levels_of(records: np.ndarray) -> Levels:
    """Return the levels of records and their errors.

    Parameters
    ----------
    records
        Means over equal time intervals, at least three, as many in each record (record, stretch),
        in any unit.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> calm = rng.standard_normal(384)
    >>> found = levels_of(np.stack([calm, calm + np.linspace(-9, 9, 384)]))
    >>> (found.sem / calm.std() * 384**0.5).round(1).tolist(), (found.sem_beyond > 1)[1].item()
    ([0.9, 0.9], True)
    """
    count, samples = records.shape
    mean = records.mean(axis=1, keepdims=True)
    size = records.std(axis=1, keepdims=True)
    moved = size[:, 0] > 1e-12 * np.abs(mean[:, 0])
    scaled = (records - mean) / np.where(moved[:, None], size, 1.0)
    # arbitrary values, because the error of a constant record is zero
    scaled[~moved] = np.where(np.arange(samples) % 2, 1.0, -1.0)
    lines = lines_of(scaled)
    calm = without_lines(scaled, lines)
    courses = courses_of(_coarse(calm))
    fits = [_fit(scaled[k], lines[k], courses[k]) for k in range(count) if lines[k] or courses[k]]
    fitted = iter(fits)
    level, lever = np.zeros((2, count)), np.ones((2, count))
    rest = np.repeat(scaled[None], 2, axis=0)
    for k in range(count):
        if lines[k] or courses[k]:
            level[:, k], lever[:, k], rest[:, k] = next(fitted)
    number = [len(own) for own in courses]
    path = errors_of_means(rest[0], lines, number)
    beyond = path
    if any(number):
        beyond = errors_of_means(rest[1], lines, [0] * count)
    scale = np.where(moved, size[:, 0], 0.0)
    at, past = (scale * np.sqrt(own) for own in lever)
    any_course = np.array(number) > 0
    return Levels(
        mean[:, 0] + level[0] * scale,
        path.sem * at,
        path.u95 * at,
        np.where(any_course, beyond.sem * past, path.sem * at),
        np.where(any_course, beyond.u95 * past, path.u95 * at),
        lines,
        courses,
    )


def without_lines(records: np.ndarray, lines: list[list[float]]) -> np.ndarray:
    """Return records minus fitted oscillations, given as cycles per record (record, sample)."""
    calm = records.copy()
    samples = records.shape[1]
    for k, cycles in enumerate(lines):
        if cycles:
            waves = np.column_stack([waves_of(each, samples) for each in cycles])
            columns = np.column_stack([np.ones(samples), shape_of(0.0, samples), waves])
            size, *_ = np.linalg.lstsq(columns, records[k], rcond=None)
            calm[k] -= waves @ size[2:]
    return calm


def _coarse(records: np.ndarray) -> np.ndarray:
    """Return means over at most 96 equal stretches (record, stretch)."""
    samples, most = records.shape[1], int(limits.COARSE_BLOCKS.value)
    if samples <= most:
        return records
    edges = np.linspace(0, samples, most + 1).astype(int)
    return np.add.reduceat(records, edges[:-1], axis=1) / np.diff(edges)


def _fit(
    record: np.ndarray, lines: list[float], courses: list[float]
) -> tuple[list[float], list[float], np.ndarray]:
    """Return level, sensitivity and residuals of a fit with trends, and of one without."""
    samples = record.size
    ones = np.ones((samples, 1))
    waves = [waves_of(cycles, samples) for cycles in lines]
    slow = [shape_of(time, samples)[:, None] for time in courses]
    levels, levers, rests = [], [], []
    for columns in ([ones, *slow, *waves], [ones, *waves]):
        design = np.column_stack(columns)
        size, *_ = np.linalg.lstsq(design, record, rcond=None)
        left = record - design @ size
        levels.append(float(size[0]))
        lever = float(np.linalg.pinv(design.T @ design)[0, 0] * samples)
        levers.append(max(lever, 1.0))
        rests.append(left - left.mean())
    return levels, levers, np.stack(rests)
