"""Whether friction surely changes along the strokes of a run: all along it, or as it runs in."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

_BLOCKS = 10  # of neighbouring strokes, whose means are as good as independent
FEWEST = 2 * _BLOCKS  # strokes
_SURE = 6.0  # standard errors of the slope, of 8 degrees of freedom: chance 3e-4
_MATTERS = 0.02  # change along the run over the mean


_SURE_OF_START = 8.0  # standard errors of the first block's distance, of 4 degrees of freedom
_LASTS = 25  # how long a run-in may last, of which the best is taken
_START_MATTERS = 0.05  # of the friction that the run settles at


class Line(NamedTuple):
    """A line over time: its level at a moment, its slope, and the standard error of the slope."""

    time: float
    level: float
    slope: float
    error: float

    def at(self, time: np.ndarray) -> np.ndarray:
        """Return the line at other times."""
        return np.asarray(self.level + self.slope * (time - self.time))


def line_along(time: np.ndarray, values: np.ndarray) -> Line | None:
    """Return the line through a run's strokes; None where none is sure, or it hardly matters.

    Parameters
    ----------
    time
        Moment of each, or its number (stroke), in order.
    values
        Friction of each (stroke).

    Notes
    -----
    Through the means of ten blocks of neighbouring strokes: what neighbours have in common does
    not make it surer than it is.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> n, noise = np.arange(100.0), 0.002 * rng.standard_normal(100)
    >>> round(line_along(n, 0.3 + 3e-4 * n + noise).slope, 5), line_along(n, 0.3 + noise)
    (0.0003, None)
    """
    if values.size < FEWEST:
        return None
    cuts = values.size * np.arange(_BLOCKS) // _BLOCKS
    count = np.diff(np.append(cuts, values.size))
    middle, mean = (np.add.reduceat(each, cuts) / count for each in (time, values))
    apart = middle - middle.mean()
    square = float(apart @ apart)
    if not square > 0:
        return None
    slope, level = float(apart @ mean) / square, float(mean.mean())
    rest = mean - level - slope * apart
    error = float(np.sqrt(rest @ rest / (_BLOCKS - 2) / square))
    change = slope * float(time[-1] - time[0])
    if abs(slope) <= _SURE * error or abs(change) <= _MATTERS * abs(level):
        return None
    return Line(float(middle.mean()), level, slope, error)


class RunIn(NamedTuple):
    """Friction of the first tenth of a run's strokes, and of the half at which it settles.

    `error` is that of their difference, `settled_u95` the expanded uncertainty of the latter.
    """

    first: float
    settled: float
    error: float
    settled_u95: float


def run_in(values: np.ndarray) -> RunIn | None:
    """Return how far friction begins from where it settles; None where that is not sure, or little.

    Parameters
    ----------
    values
        Friction of each stroke, in order (stroke).

    Notes
    -----
    The mean of the first of ten blocks of neighbouring strokes beside those of the last five, whose
    scatter says how sure it is.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> n, noise = np.arange(200.0), 0.002 * rng.standard_normal(200)
    >>> found = run_in(0.3 + 0.1 * np.exp(-n / 10) + noise)
    >>> round(found.first, 2), round(found.settled, 2), run_in(0.3 + noise)
    (0.35, 0.3, None)
    """
    if values.size < FEWEST:
        return None
    blocks = np.array([part.mean() for part in np.array_split(values, _BLOCKS)])
    late = blocks[_BLOCKS // 2 :]
    settled, error = float(late.mean()), float(late.std(ddof=1) * np.sqrt(1 + 1 / late.size))
    off = abs(float(blocks[0]) - settled)
    if off <= _SURE_OF_START * error or off <= _START_MATTERS * abs(settled):
        return None
    own = float(special.stdtrit(late.size - 1, 0.975) * late.std(ddof=1) / np.sqrt(late.size))
    return RunIn(float(blocks[0]), settled, error, own)


def course_along(values: np.ndarray) -> np.ndarray | None:
    """Return the course of friction along a run (stroke): a line, or how it runs in.

    What is left about it tells how well the mean over the run is known. None where friction does
    not surely change.

    Parameters
    ----------
    values
        Friction of each stroke, in order (stroke).

    Notes
    -----
    A run-in is fitted as ``a + b exp(-n / c)`` by least squares, with c from a hundredth of the run
    to all of it.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> n, noise = np.arange(200.0), 0.002 * rng.standard_normal(200)
    >>> course = course_along(0.3 + 0.1 * np.exp(-n / 10) + noise)
    >>> course[[0, 199]].round(1).tolist(), course_along(0.3 + noise)
    ([0.4, 0.3], None)
    """
    number = np.arange(values.size, dtype=float)
    line = line_along(number, values)
    if line is None and run_in(values) is None:
        return None
    fitted = [] if line is None else [line.at(number)]
    for lasts in values.size * np.geomspace(0.01, 1.0, _LASTS):
        design = np.stack([np.ones(number.size), np.exp(-number / lasts)], axis=1)
        told, *_ = np.linalg.lstsq(design, values, rcond=None)
        fitted.append(design @ told)
    return min(fitted, key=lambda course: float(((values - course) ** 2).sum()))
