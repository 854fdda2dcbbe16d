"""Segments without the running-in, or without a given distance, time or number of cycles."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.friction.running_in.amount import discard_amount
from tribolab.friction.running_in.history import histories_of
from tribolab.friction.segments.stretches import name_of

DISCARDED, NOT_STEADY = "discarded", "not steady"


def discard_start(segments: xr.Dataset, discard: str) -> xr.Dataset:
    """Return segments without the beginning of the run.

    Parameters
    ----------
    segments
        From `find_segments`.
    discard
        ``"50 m"`` of sliding, ``"60 s"`` from the first segment on, or ``"100 cycles"`` of a
        forward and a backward stroke.

    Raises
    ------
    AnalysisError
        If no segment would remain.
    """
    amount, unit = discard_amount(discard)
    start, stop = segments["start"].values, segments["stop"].values
    if not start.size:
        return segments
    if unit == "s":
        moment = start[0] + amount
    elif unit == "m":
        gone = np.cumsum(segments["sliding_speed"].values * (stop - start))
        before = gone - segments["sliding_speed"].values * (stop - start)
        slid = np.stack([before, gone], axis=1).ravel()
        times = np.stack([start, stop], axis=1).ravel()
        moment = np.interp(amount, slid, times, right=np.inf)
    else:
        if np.unique(segments["direction"].values).size < 2:
            raise AnalysisError(
                "discard: there are no cycles, as the run slides in one direction. State a "
                "distance or a time",
                where=name_of(segments),
            )
        stroke = int(2 * amount)
        moment = start[stroke] if stroke < start.size else np.inf
    return _select_interval(segments, float(moment), np.inf, DISCARDED)


def steady_segments(run: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset) -> xr.Dataset:
    """Return the segments in the steady part of a run; all if it has no running-in.

    Parameters
    ----------
    run, segments, friction
        A run (time), its segments and their friction (segment).

    Returns
    -------
    xarray.Dataset
        All segments if the run does not become steady.
    """
    part = segments
    for history in histories_of(run, friction):
        if not history.settling.is_steady:
            return segments
        start, stop, end = history.places(history.time)
        first = -np.inf if history.settling.start == 0 else start
        last = np.inf if stop >= end else stop
        part = _select_interval(part, first, last, NOT_STEADY)
    return part


def _select_interval(segments: xr.Dataset, first: float, last: float, reason: str) -> xr.Dataset:
    """Return segments between two times [s]; the remainder becomes omitted."""
    begin, end = segments["trimmed_start"].values, segments["trimmed_stop"].values
    new_begin, new_end = np.maximum(begin, first), np.minimum(end, last)
    left = new_end > new_begin
    if not left.any():
        raise AnalysisError(f"{reason}: nothing of the run would be left", where=name_of(segments))
    share = np.where(left, (new_end - new_begin) / np.where(end > begin, end - begin, 1.0), 0.0)
    changed = {
        "trimmed_start": new_begin,
        "trimmed_stop": new_end,
        "start": np.maximum(segments["start"].values, first),
        "stop": np.minimum(segments["stop"].values, last),
        "sliding_distance": segments["sliding_distance"].values * share,
        "samples": np.round(segments["samples"].values * share).astype(int),
    }
    result = segments.drop_dims("omitted") if "omitted" in segments.dims else segments.copy()
    for name, values in changed.items():
        result[name] = "segment", values, segments[name].attrs
    result = result.isel(segment=np.flatnonzero(left))
    result = result.assign_coords(segment=np.arange(result.sizes["segment"]))
    cut = [
        (a, b)
        for a, b in (
            (segments["start"].values[0], min(first, segments["stop"].values[-1])),
            (max(last, segments["start"].values[0]), segments["stop"].values[-1]),
        )
        if b > a
    ]
    for place, name in enumerate(("omitted_start", "omitted_stop")):
        old = segments[name].values if name in segments else np.zeros(0)
        result[name] = "omitted", np.append(old, [ends[place] for ends in cut])
    reasons = segments["omitted_reason"].values.tolist() if "omitted_reason" in segments else []
    result["omitted_reason"] = "omitted", np.array(reasons + [reason] * len(cut), dtype=object)
    return result
