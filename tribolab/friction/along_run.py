"""The straight line through the strokes of a run, where friction surely changes along it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

_BLOCKS = 10  # of neighbouring strokes, whose means are as good as independent
FEWEST = 2 * _BLOCKS  # strokes
_SURE = 6.0  # standard errors of the slope, of 8 degrees of freedom: chance 3e-4
_MATTERS = 0.02  # change along the run over the mean


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
