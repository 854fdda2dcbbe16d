"""Differences of friction at one speed between steps of a run, e.g. of temperature."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.wording import many, percent
from tribolab.records.runs.same_speed import segments_by_speed

_MIN_COMMON_SPEEDS = 3  # speeds common to several steps
_DIFFERS = 0.1  # relative difference of friction between steps


def steps_that_differ(friction: xr.Dataset, values: np.ndarray) -> str:
    """Return a warning if friction differs between steps: their mean then mixes conditions.

    Parameters
    ----------
    friction
        From `friction_coefficient`: ``sliding_speed`` and ``step`` (segment).
    values
        Friction coefficient of each segment; NaN if unknown.

    Examples
    --------
    >>> cold = xr.Dataset({"sliding_speed": ("segment", [1.0, 2.0, 4.0] * 2)})
    >>> cold["step"] = "segment", [1, 1, 1, 2, 2, 2]
    >>> steps_that_differ(cold, np.array([0.10, 0.08, 0.06, 0.13, 0.10, 0.08]))[:48]
    'friction at the same speed differs between steps'
    >>> steps_that_differ(cold, np.array([0.10, 0.08, 0.06, 0.10, 0.08, 0.06]))
    ''
    """
    if "step" not in friction:
        return ""
    speed, step = (np.asarray(friction[name], float) for name in ("sliding_speed", "step"))
    apart = []
    for part in segments_by_speed(speed, np.isfinite(values) & np.isfinite(step)):
        means = [values[part][step[part] == each].mean() for each in np.unique(step[part])]
        if len(means) > 1:
            apart.append(float(np.ptp(means)) / abs(float(np.mean(means))))
    if len(apart) < _MIN_COMMON_SPEEDS or np.median(apart) < _DIFFERS:
        return ""
    steps = np.unique(step[np.isfinite(step)]).size
    usual = percent(float(np.median(apart)))
    return (
        "friction at the same speed differs between steps (temperature, surface?), typically by "
        f"{usual}, at "
        f"{many(len(apart), 'speed')} of {many(steps, 'step')}. The curve shows their mean; "
        "tables/friction.csv lists each"
    )
