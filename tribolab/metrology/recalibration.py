"""Date of an instrument's next calibration, from its interval or its drift."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

_MIN_POINTS = 4  # fewest points for a straight line with a standard error
_FARTHEST = 3653  # days ahead, up to which a date is predicted


@dataclass(frozen=True)
class Due:
    """Date of the next calibration, with the reason.

    Parameters
    ----------
    date
        The end of the interval or the date predicted from drift, whichever is earlier; None if
        neither is known.
    reason
        What determines the date, in words.
    drift
        Drift of the monitored quantity per day; NaN if unknown.
    """

    date: dt.date | None
    reason: str
    drift: float = float("nan")


def recalibration_due(
    calibrated: dt.date,
    interval_days: float | None,
    days: ArrayLike = (),
    values: ArrayLike = (),
    limit: float | None = None,
) -> Due:
    """Return the date of the next calibration, from the calibration interval and observed drift.

    Parameters
    ----------
    calibrated
        Date of the last calibration.
    interval_days
        Longest interval between calibrations.
    days, values
        Days since the calibration, and the monitored quantity, e.g. the gain relative to that of
        the calibration (point).
    limit
        Largest tolerated deviation of either sign.

    Notes
    -----
    A line is fitted to the points; the calibration is due when the one-sided 95 % prediction bound
    of a further point reaches the limit, if that is before the end of the interval.

    Examples
    --------
    >>> import datetime as dt
    >>> due = recalibration_due(dt.date(2026, 1, 1), 365, [0, 30, 60, 90], [0, 1, 2, 3.1], 5)
    >>> due.date.isoformat(), due.reason
    ('2026-05-22', 'drift')
    """
    by_interval = None if interval_days is None else calibrated + dt.timedelta(days=interval_days)
    t, y = np.asarray(days, dtype=float), np.asarray(values, dtype=float)
    if limit is None or t.size < _MIN_POINTS or np.ptp(t) == 0:
        return Due(by_interval, "interval" if by_interval else "no interval is stated")
    slope, intercept = np.polyfit(t, y, 1)
    residual = y - intercept - slope * t
    scatter = float(np.sqrt((residual**2).sum() / (t.size - 2)))
    ahead = np.arange(0.0, _FARTHEST + 1)
    spread = scatter * np.sqrt(
        1 + 1 / t.size + (ahead - t.mean()) ** 2 / ((t - t.mean()) ** 2).sum()
    )
    bound = np.abs(intercept + slope * ahead) + special.stdtrit(t.size - 2, 0.95) * spread
    beyond = np.flatnonzero((bound >= limit) & (ahead >= t.max()))
    drift = float(slope)
    if beyond.size:
        by_drift = calibrated + dt.timedelta(days=float(ahead[beyond[0]]))
        if by_interval is None or by_drift < by_interval:
            return Due(by_drift, "drift", drift)
    return Due(by_interval, "interval" if by_interval else "no interval is stated", drift)
