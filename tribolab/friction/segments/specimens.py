"""Successive specimens in one record, each pulled from the same starting position."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.friction.segments import slopes
from tribolab.friction.segments.stretches import Stretch, finite


def begins_of_specimens(run: xr.Dataset) -> np.ndarray:
    """Return the start of each specimen except the first [s] (specimen - 1).

    Parameters
    ----------
    run
        With ``position`` and ``step`` (time). A specimen begins where the step changes and the
        position jumps; a stage that stops and continues, or a counter that wraps within a step,
        does not begin a specimen.
    """
    if "position" not in run or "step" not in run:
        return np.zeros(0)
    time, position = finite(run, "position")
    step = np.asarray(run["step"].values)[np.isfinite(run["position"].values)]
    jump = slopes.without_resets(time, position)[1]
    return time[jump[step[jump] != step[jump - 1]]]


def apart(run: xr.Dataset, stretches: list[Stretch]) -> list[Stretch]:
    """Return the intervals of a run, cut where another specimen starts.

    Parameters
    ----------
    run
        The run.
    stretches
        Intervals in temporal order.
    """
    begins = begins_of_specimens(run)
    if not begins.size:
        return stretches
    time = run["time"].values
    before = time[np.searchsorted(time, begins) - 1]
    result = []
    for stretch in stretches:
        inside = (begins > stretch.start) & (begins < stretch.stop)
        starts = [stretch.start, *begins[inside].tolist()]
        stops = [*before[inside].tolist(), stretch.stop]
        result += [
            stretch._replace(start=a, stop=b) for a, b in zip(starts, stops, strict=True) if b > a
        ]
    return result
