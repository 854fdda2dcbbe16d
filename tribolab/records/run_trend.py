"""Whether friction rises or falls along a run, from segment to segment of one speed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.words import duration, many, number, percent, speed_text

_BLOCKS = 10  # of neighbouring segments, whose means are as good as independent
_FEWEST = 2 * _BLOCKS  # segments
_SURE = 6.0  # standard errors of the slope, of 8 degrees of freedom: chance 3e-4
_MATTERS = 0.02  # change along the run over the mean
_SAME_SPEED = 0.05  # relative difference of the speeds of alike segments


class RunTrend(NamedTuple):
    """Change of friction from the first to the last of the segments of one speed.

    Parameters
    ----------
    speed
        [m/s].
    first, last
        Friction at both ends, on the line through the segments.
    error
        Standard error of the change between them.
    segments, lasted
        How many there are, and the time from the first to the last [s].
    """

    speed: float
    first: float
    last: float
    error: float
    segments: int
    lasted: float

    @property
    def text(self) -> str:
        """The trend in words."""
        verb = "rises" if abs(self.last) > abs(self.first) else "falls"
        share = percent(abs(self.last - self.first) / abs(self.first))
        return (
            f"friction {verb} along the run from {number(self.first)} to {number(self.last)}, by "
            f"{share}, over {many(self.segments, 'segment')} at {speed_text(self.speed)} in "
            f"{duration(self.lasted)}: the mean is one over the run"
        )


def trends_along(segments: xr.Dataset, values: np.ndarray) -> list[RunTrend]:
    """Return the trends from segment to segment that are sure and matter, one for each speed.

    Parameters
    ----------
    segments
        From `find_segments`, with ``sliding_speed`` and the trimmed ends (segment).
    values
        Friction coefficient of each (segment); NaN where it is not known.

    Notes
    -----
    A straight line through the means of ten blocks of neighbouring segments: what neighbours have
    in common does not make it surer than it is.
    """
    speed = segments["sliding_speed"].values
    middle = (segments["trimmed_start"].values + segments["trimmed_stop"].values) / 2
    known = np.isfinite(values) & np.isfinite(speed) & (speed > 0)
    order = np.flatnonzero(known)[np.argsort(speed[known], kind="stable")]
    if order.size < _FEWEST:
        return []
    cuts = np.flatnonzero(np.diff(np.log(speed[order])) > _SAME_SPEED) + 1
    found = (_trend(speed, middle, values, np.sort(part)) for part in np.split(order, cuts))
    return [trend for trend in found if trend is not None]


def _trend(
    speed: np.ndarray, middle: np.ndarray, values: np.ndarray, part: np.ndarray
) -> RunTrend | None:
    if part.size < _FEWEST:
        return None
    blocks = np.array_split(part, _BLOCKS)
    time, mean = (np.array([of[block].mean() for block in blocks]) for of in (middle, values))
    apart = time - time.mean()
    square = float(apart @ apart)
    if not square > 0:
        return None
    slope = float(apart @ mean) / square
    rest = mean - mean.mean() - slope * apart
    error = float(np.sqrt(rest @ rest / (_BLOCKS - 2) / square))
    lasted = float(middle[part[-1]] - middle[part[0]])
    change, level = slope * lasted, float(mean.mean())
    if abs(slope) <= _SURE * error or abs(change) <= _MATTERS * abs(level):
        return None
    ends = (level + slope * (middle[end] - time.mean()) for end in (part[0], part[-1]))
    first, last = map(float, ends)
    return RunTrend(float(np.median(speed[part])), first, last, error * lasted, part.size, lasted)
