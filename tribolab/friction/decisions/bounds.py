"""Change of the start or end of a segment, with its values and omitted intervals updated."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, Cure
from tribolab.friction.decisions.decision import Decision
from tribolab.friction.segments.measured import measured
from tribolab.friction.segments.stretches import Stretch

LEFT = "outside the bounds that a person set"
_MIN_SAMPLES = 2  # samples needed for a mean and its scatter


def set_bounds(
    segments: xr.Dataset, place: int, decision: Decision, run: xr.Dataset | None
) -> xr.Dataset:
    """Return the segments of a run, one of them with another start or end.

    Parameters
    ----------
    segments
        From `find_segments`.
    place
        Number of the segment, from 0.
    decision
        Decision with the new bounds.
    run
        The run of the segments.

    Raises
    ------
    AnalysisError
        If the run is missing, or the bounds are outside it, do not overlap the segment, are in
        another segment, or are too close together.
    """
    if run is None:
        cure = Cure(notebook="give it: decide(segments, decisions, run)")
        raise AnalysisError(f"{decision} needs the run, to measure the segment again", cure=cure)
    old = float(segments["start"].values[place]), float(segments["stop"].values[place])
    new = (
        old[0] if decision.new_start is None else decision.new_start,
        old[1] if decision.new_stop is None else decision.new_stop,
    )
    _refuse_bounds(segments, place, decision, run, new)
    speed = float(segments["sliding_speed"].values[place])
    velocity = float(np.copysign(speed, segments["direction"].values[place]))
    low, high = (segments.attrs.get(f"position_{end}_m") for end in ("low", "high"))
    row = measured(
        run,
        [Stretch(new[0], new[1], "constant", velocity)],
        segments.attrs["velocity_source"],
        segments.attrs["trim"],
        None if low is None or high is None else (low, high),
    )
    if row["samples"].item() < _MIN_SAMPLES:
        raise _refused(segments, decision, "leave no samples to the segment")
    result = segments.copy()
    for name in row.data_vars:
        if row[name].dims == ("segment",):
            values = segments[name].values.copy()
            values[place] = row[name].item()
            result[name] = "segment", values, segments[name].attrs
    return _update_omitted(result, old, new)


def _refuse_bounds(
    segments: xr.Dataset, place: int, decision: Decision, run: xr.Dataset, new: tuple[float, float]
) -> None:
    low, high = new
    if not low < high:
        raise _refused(segments, decision, f"end at {high:g} s, not after they begin at {low:g} s")
    time = run["time"].values
    if low < time[0] or high > time[-1]:
        ends = f"from {time[0]:.6g} to {time[-1]:.6g} s"
        raise _refused(segments, decision, f"lie outside the run, which lasts {ends}")
    start, stop = segments["start"].values, segments["stop"].values
    meets = (np.minimum(stop, high) - np.maximum(start, low)) > 0
    if not meets[place]:
        raise _refused(segments, decision, "lie outside the segment that they are for")
    meets[place] = False
    if meets.any():
        other = int(np.flatnonzero(meets)[0])
        ends = f"{start[other]:.6g} to {stop[other]:.6g} s"
        raise _refused(segments, decision, f"reach into segment {other + 1} ({ends})")


def _refused(segments: xr.Dataset, decision: Decision, why: str) -> AnalysisError:
    cure = Cure(
        notebook="correct its new_start and new_stop",
        campaign="correct its new_from and new_to in review.toml",
    )
    what = f"{decision}: the new bounds {why}"
    return AnalysisError(what, where=segments.attrs.get("source", ""), cure=cure)


def _update_omitted(
    segments: xr.Dataset, old: tuple[float, float], new: tuple[float, float]
) -> xr.Dataset:
    """Return segments with omitted intervals adjusted to the new bounds."""
    pieces: list[tuple[float, float, str]] = []
    names = ("omitted_start", "omitted_stop", "omitted_reason")
    for start, stop, reason in zip(*(segments[name].values for name in names), strict=True):
        pieces += [(a, b, reason) for a, b in _outside((start, stop), new)]
    pieces += [(a, b, LEFT) for a, b in _outside(old, new)]
    columns = list(zip(*sorted(pieces), strict=True)) or [(), (), ()]
    result = segments.drop_dims("omitted")
    for name, values, kind in zip(names, columns, (float, float, object), strict=True):
        result[name] = "omitted", np.array(values, dtype=kind), segments[name].attrs
    return result


def _outside(piece: tuple[float, float], taken: tuple[float, float]) -> list[tuple[float, float]]:
    """Return those parts of a time interval that are before and after another interval.

    Examples
    --------
    >>> _outside((0.0, 10.0), (4.0, 6.0)), _outside((0.0, 5.0), (4.0, 6.0))
    ([(0.0, 4.0), (6.0, 10.0)], [(0.0, 4.0)])
    """
    (start, stop), (low, high) = piece, taken
    parts = [(start, min(stop, low)), (max(start, high), stop)]
    return [(a, b) for a, b in parts if a < b]
