"""Segments from the intervals of a run: trimmed, with speed, distance and labels."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import one_by_one
from tribolab.arrays.medians import median
from tribolab.core.errors import AnalysisError
from tribolab.friction.segments.slopes import line
from tribolab.friction.segments.stretches import Stretch, finite, name_of, track
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp

_STROKE_DEGREE = 5  # degree of the polynomial through the positions of a stroke
_LABELS = ("set_speed", "set_normal_force", "step", "cycle", "rolling_speed", "slide_roll_ratio")


def measured(
    run: xr.Dataset,
    stretches: list[Stretch],
    source: str,
    trim: float,
    position_range: tuple[str | float, str | float] | None,
    trimmed: tuple[np.ndarray, np.ndarray] | None = None,
) -> xr.Dataset:
    """Return the result of `find_segments` from a run's intervals: trimmed, with speed, distance.

    Parameters
    ----------
    run
        The run.
    stretches
        Intervals of kind "constant" become segments, the others are omitted.
    source
        Source of the speed, as in the attribute ``velocity_source``.
    trim, position_range
        As for `find_segments`.
    trimmed
        First and last time of the used part of each segment, instead of `trim`.
    """
    kept = [s for s in stretches if s.kind == "constant"]
    left = [s for s in stretches if s.kind != "constant"]
    time = run["time"].values
    start, stop = (np.array([getattr(s, k) for s in kept], float) for k in ("start", "stop"))
    velocity = np.array([s.velocity for s in kept], float)
    trimmed_start = start + trim * (stop - start)
    trimmed_stop = stop - trim * (stop - start)
    if trimmed is not None:
        trimmed_start, trimmed_stop = trimmed
    settings = {"trim": trim, "velocity_source": source}
    if position_range is not None:
        low, high = sorted(to_si(x, "m", name="position_range") for x in position_range)
        trimmed_start, trimmed_stop = _narrow(run, trimmed_start, trimmed_stop, low, high)
        settings |= {"position_low_m": low, "position_high_m": high}
    first = np.searchsorted(time, trimmed_start, side="left")
    last = np.searchsorted(time, trimmed_stop, side="right")
    if source == "recorded":
        velocity = _mean_velocity(run, first, last, velocity)
    elif source == "position":
        degree = 1 if trimmed is None else _STROKE_DEGREE
        velocity = _mean_slope(run, trimmed_start, trimmed_stop, velocity, degree)
    direction = np.where(np.isnan(velocity) & (source == "recorded"), 0, np.sign(velocity))
    if source in ("step", "set speed"):
        direction = np.where(np.signbit(velocity), -1, 1)
    speed = np.abs(velocity)
    data = {
        "start": start,
        "stop": stop,
        "trimmed_start": trimmed_start,
        "trimmed_stop": trimmed_stop,
        "sliding_speed": speed,
        "direction": direction.astype(np.int8),
        "sliding_distance": speed * (trimmed_stop - trimmed_start),
        "samples": last - first,
    }
    for label in _LABELS:
        if label in run:
            data[label] = _label(np.asarray(run[label].values, float), first, last)
    omitted = {
        "omitted_start": np.array([s.start for s in left], float),
        "omitted_stop": np.array([s.stop for s in left], float),
        "omitted_reason": np.array([s.kind for s in left], dtype=object),
    }
    result = xr.Dataset(
        {name: ("segment", values) for name, values in data.items()}
        | {name: ("omitted", values) for name, values in omitted.items()},
        coords={"segment": np.arange(len(kept))},
    )
    return stamp(result, **(run.attrs | settings))


def _narrow(
    run: xr.Dataset, start: np.ndarray, stop: np.ndarray, low: float, high: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return start and end times of each segment's part between two positions."""
    if "position" not in run:
        raise AnalysisError(
            f"{name_of(run)}: position_range is given, but the run has no 'position'"
        )
    time, position = finite(run, "position")
    start, stop = start.copy(), stop.copy()
    for i in one_by_one(range(start.size)):
        first, last = np.searchsorted(time, [start[i], stop[i]])
        part = position[first:last]
        inside = first + np.flatnonzero((part >= low) & (part <= high))
        if inside.size == 0:
            stop[i] = start[i]
            continue
        start[i], stop[i] = time[inside[0]], time[inside[-1]]
    return start, stop


def _mean_velocity(
    run: xr.Dataset, first: np.ndarray, last: np.ndarray, guess: np.ndarray
) -> np.ndarray:
    """Return the mean recorded velocity over each trimmed segment, without outliers."""
    velocity = run["sliding_velocity"].values
    result = guess.copy()
    for i in one_by_one(range(first.size)):
        part = velocity[first[i] : last[i]]
        size = max(1, part.size // 4096)
        part = part[: part.size // size * size].reshape(-1, size).mean(axis=1)
        part = part[np.isfinite(part)]
        if part.size == 0:
            continue
        rest = np.abs(part - median(part))
        # the median deviation of quantised readings may be zero: use their mean deviation
        keep = rest <= 6 * max(median(rest) / 0.6745, np.mean(rest))
        result[i] = part[keep].mean()
    return result


def _mean_slope(
    run: xr.Dataset, start: np.ndarray, stop: np.ndarray, guess: np.ndarray, degree: int
) -> np.ndarray:
    """Return the mean velocity over each trimmed segment, from a polynomial fit of the position.

    A line is insufficient for a stroke whose speed is not constant: over a whole stroke of a sine
    it is 22 % steeper than distance over time.
    """
    time, position = track(run)
    first, last = np.searchsorted(time, start, "left"), np.searchsorted(time, stop, "right")
    result = guess.copy()
    for i in one_by_one(range(first.size)):
        part = time[first[i] : last[i]]
        if part.size < 3:
            continue
        if degree == 1 or part.size < 3 * degree:
            result[i] = line(part, position[first[i] : last[i]])[1]
            continue
        span = part[-1] - part[0]
        place = 2 * (part - part[0]) / span - 1
        terms = np.polynomial.legendre.legfit(place, position[first[i] : last[i]], degree)
        result[i] = 2 * terms[1::2].sum() / span  # the even terms are equal at both ends and cancel
    return result


def _label(values: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return the median of a label, e.g. the set load, over each segment; NaN if unknown."""
    result = np.full(first.size, np.nan)
    for i in one_by_one(range(first.size)):
        part = values[first[i] : last[i]]
        part = part[np.isfinite(part)]
        if part.size:
            result[i] = median(part)
    return result
