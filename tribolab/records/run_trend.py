"""Whether friction rises or falls along a run, from segment to segment of one speed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.friction.along_run import line_along, run_in
from tribolab.records.same_speed import of_one_speed
from tribolab.records.wording import with_error
from tribolab.words import duration, many, number, percent, speed_text


class RunTrend(NamedTuple):
    """Change of friction from the first to the last of the segments of one speed.

    Parameters
    ----------
    speed
        [m/s].
    first, last
        Mean friction of the first and of the last tenth of the segments.
    error
        Standard error of the change: on the line through the segments, or by the last half.
    segments, lasted
        How many there are, and the time from the first to the last [s].
    settles
        Whether it is that of the run-in, and `last` the mean of the last half.
    settled_u95
        Expanded uncertainty (95 % coverage) of that mean.
    """

    speed: float
    first: float
    last: float
    error: float
    segments: int
    lasted: float
    settles: bool = False
    settled_u95: float | None = None

    @property
    def text(self) -> str:
        """The trend in words."""
        verb = "rises" if abs(self.last) > abs(self.first) else "falls"
        share = percent(abs(self.last - self.first) / abs(self.first))
        if self.settles:
            settled = with_error(self.last, self.settled_u95)
            return (
                f"friction {verb} along the run as it begins, from {number(self.first)} in its "
                f"first tenth to {settled} in its last half, by {share}, over "
                f"{many(self.segments, 'segment')} at {speed_text(self.speed)}: the mean holds "
                "the run-in"
            )
        return (
            f"friction {verb} along the run from {number(self.first)} in its first tenth to "
            f"{number(self.last)} in its last, by {share}, over {many(self.segments, 'segment')} "
            f"at {speed_text(self.speed)} in {duration(self.lasted)}: the mean is one over the run"
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
    See `tribolab.friction.along_run.line_along`.
    """
    speed = segments["sliding_speed"].values
    middle = (segments["trimmed_start"].values + segments["trimmed_stop"].values) / 2
    known = np.isfinite(values) & np.isfinite(speed)
    found = (_trend(speed, middle, values, part) for part in of_one_speed(speed, known))
    return [trend for trend in found if trend is not None]


def _trend(
    speed: np.ndarray, middle: np.ndarray, values: np.ndarray, part: np.ndarray
) -> RunTrend | None:
    line = line_along(middle[part], values[part])
    lasted = float(middle[part[-1]] - middle[part[0]])
    if line is None:
        early = run_in(values[part])
        if early is None:
            return None
        usual, own = float(np.median(speed[part])), early.settled_u95
        told = usual, early.first, early.settled, early.error, part.size, lasted
        return RunTrend(*told, settles=True, settled_u95=own)
    tenth = max(part.size // 10, 1)  # what ends of a line would exceed where the change levels off
    first, last = (float(values[end].mean()) for end in (part[:tenth], part[-tenth:]))
    return RunTrend(
        float(np.median(speed[part])), first, last, line.error * lasted, part.size, lasted
    )
