"""Friction along a run, and the beginning of its steady state."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs
from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError, Cure
from tribolab.friction.coefficient.coefficient import friction_coefficient, friction_signal
from tribolab.friction.coefficient.cycles import friction_per_cycle
from tribolab.friction.coefficient.segment_samples import belong
from tribolab.friction.decisions.rejected import kept
from tribolab.friction.mean_error import limits as of_means
from tribolab.friction.mean_error.level import levels_of
from tribolab.friction.points import limits as of_points
from tribolab.friction.points.strokes import Observations, grouped_by_speed, observations_of
from tribolab.friction.running_in import limits
from tribolab.friction.running_in.kinds import CYCLES, STRETCHES, STROKES
from tribolab.friction.running_in.settling import Settling, blocks_of, settling_of
from tribolab.friction.segments.find import find_segments
from tribolab.friction.segments.stretches import name_of
from tribolab.friction.time_weights import on_grid
from tribolab.units.stamping import stamp

_READ = (
    "start",
    "stop",
    "trimmed_start",
    "trimmed_stop",
    "friction_coefficient",
    "friction_force_offset",
    "normal_force_offset",
    "friction_coefficient_offset",
)


class Mean(NamedTuple):
    """Mean friction coefficient over a part of a run, its standard error and U95."""

    value: float = np.nan
    sem: float = np.nan
    u95: float = np.nan


class History(NamedTuple):
    """Friction along a run at one speed [m/s], with a value for each cycle or interval.

    `counted` is the kind of interval. `time` [s] and `distance` [m] slid are at its middle. `work`
    [J] is done in each cycle, `wear` [m] is the displacement normal to the contact since the
    beginning; both are empty if unknown.
    """

    speed: float
    counted: str
    time: np.ndarray
    distance: np.ndarray
    friction: np.ndarray
    settling: Settling
    steady: Mean
    overall: Mean
    work: np.ndarray
    wear: np.ndarray

    def places(self, values: np.ndarray) -> tuple[float, float, float]:
        """Return start and end of the steady part, and end of the run, in times or distances."""
        edges = np.concatenate([[0.0], (values[1:] + values[:-1]) / 2, [0.0]])
        edges[0], edges[-1] = 1.5 * values[0] - values[1] / 2, 1.5 * values[-1] - values[-2] / 2
        if not self.settling.is_steady:
            return np.nan, np.nan, float(edges[-1])
        return float(edges[self.settling.start]), float(edges[self.settling.stop]), float(edges[-1])


@of_runs
def running_in(
    run: xr.Dataset, segments: xr.Dataset | None = None, friction: xr.Dataset | None = None
) -> xr.Dataset:
    """Return friction along a run at one speed, the end of running-in, and the steady value.

    Parameters
    ----------
    run
        The run, with ``friction_force`` and ``normal_force``, or ``friction_coefficient``.
    segments, friction
        From `find_segments` and `friction_coefficient` on the same run; computed if not given.

    Returns
    -------
    xarray.Dataset
        On dim ``cycle``, from 1 (pairs of strokes of a reciprocating contact, strokes that do not
        pair, else up to 384 stretches of equal sliding time): ``friction_coefficient``,
        ``time`` [s], ``sliding_distance`` [m], ``work_per_cycle`` [J] and ``wear_depth`` [m] if
        they are known. Without dim:
        ``running_in_distance`` [m] with ``_u`` (standard uncertainty), ``running_in_time`` [s],
        ``steady_friction_coefficient`` with ``_sem`` and ``_U95`` (95 % coverage of the mean over
        the steady part), ``mean_friction_coefficient`` with the same (over the whole run).
        Attributes ``running_in`` ("none", "running-in", "step", "not finished": then there is no
        steady value) and ``counted`` ("cycles", "strokes" or "stretches").

    Raises
    ------
    AnalysisError
        If the run has no friction coefficient, or does not slide long enough at one speed.

    Notes
    -----
    See `tribolab.friction.running_in.settling`.

    Examples
    --------
    >>> rng, time = np.random.default_rng(0), np.arange(0.0, 600.0, 0.2)
    >>> mu = 0.3 + 0.2 * np.exp(-time / 40) + 0.01 * rng.standard_normal(time.size)
    >>> data = {"friction_coefficient": ("time", mu), "set_speed": ("time", 0 * time + 0.1)}
    >>> found = running_in(xr.Dataset(data, {"time": time}))
    >>> found.attrs["running_in"], round(float(found.steady_friction_coefficient), 2)
    ('running-in', 0.3)
    >>> bool(13 < found.running_in_distance < 21)
    True
    """
    segments = find_segments(run) if segments is None else segments
    friction = friction_coefficient(run, segments) if friction is None else friction
    belong(run, friction)
    found = histories_of(run, friction)
    if not found:
        raise AnalysisError(
            f"running-in needs {limits.MIN_VALUES.value:.0f} strokes at one speed, or sliding in "
            "one direction at one speed",
            where=name_of(run),
            cure=Cure(notebook="tl.friction_coefficient(run, segments) gives each segment"),
        )
    return _dataset(max(found, key=lambda each: each.time[-1] - each.time[0]), run)


def histories_of(run: xr.Dataset, friction: xr.Dataset) -> list[History]:
    """Return the friction histories of a run: one for each speed with enough sliding.

    Parameters
    ----------
    run
        The run (time).
    friction
        From `friction_coefficient` (segment); rejected segments are left out.
    """
    friction = kept(friction)
    if "friction_coefficient" not in friction or not friction.sizes["segment"]:
        return []
    seen = observations_of([friction])
    groups = grouped_by_speed(seen, of_points.SPEED_TOLERANCE.value).members
    many = [part for part in groups if part.size >= limits.MIN_VALUES.value]
    if many:
        cycles = _cycles_of(run)
        return [_stroke_history(run, friction, seen.of(part), cycles) for part in many]
    alone = _stretch_history(run, friction)
    return [] if alone is None else [alone]


def _cycles_of(run: xr.Dataset) -> xr.Dataset | None:
    """Return the cycles of a reciprocating run; None for other runs."""
    try:
        return friction_per_cycle(run)
    except AnalysisError:
        return None


def _stroke_history(
    run: xr.Dataset, friction: xr.Dataset, seen: Observations, cycles: xr.Dataset | None
) -> History:
    """Return the history of strokes, or of pairs of strokes, at one speed."""
    start, stop = friction["start"].values, friction["stop"].values
    place = np.arange(start.size)
    time = np.interp(seen.order, place, (start + stop) / 2)
    if cycles is None:
        moments = stop
        gone = np.cumsum(friction["sliding_speed"].values * (stop - start))
    else:
        moments = cycles["time"].values + 0.5 / cycles["frequency"].values
        gone = np.cumsum(2 * cycles["stroke_length"].values)
    distance = np.interp(time, np.append(start[0], moments), np.append(0.0, gone))
    work = np.zeros(0)
    if cycles is not None and "friction_coefficient_energy" in cycles:
        area = cycles["friction_coefficient_energy"] * 2 * cycles["stroke_length"]
        work = np.interp(time, cycles["time"].values, (area * cycles["normal_force"]).values)
    counted = CYCLES if np.median(seen.strokes) == 2 else STROKES
    speed = float(np.exp(np.log(seen.speed).mean()))
    return _history(run, friction, speed, counted, time, distance, seen.mean, work)


def _stretch_history(run: xr.Dataset, friction: xr.Dataset) -> History | None:
    """Return the friction history of a run with one direction and speed; None for other runs."""
    speed, direction = friction["sliding_speed"].values, friction["direction"].values
    start, stop = friction["start"].values, friction["stop"].values
    lasted = stop - start
    if not lasted.sum() > 0:  # the rows are results of the instrument, not samples
        return None
    usual = float(speed[np.argmax(lasted)])
    alike = np.abs(np.log(np.where(speed > 0, speed, np.nan) / usual)) < np.log1p(
        of_points.SPEED_TOLERANCE.value
    )
    share = lasted[alike].sum() / lasted.sum()
    if not share >= limits.MIN_TIME_AT_ONE_SPEED.value or np.unique(direction[alike]).size > 1:
        return None
    parts = [_coefficients(run, friction, int(k)) for k in np.flatnonzero(alike)]
    moment = np.concatenate([time for time, _ in parts])
    values = np.concatenate([mu for _, mu in parts])
    good = np.isfinite(values)
    count = min(int(good.sum()), int(of_means.BLOCKS.value))
    if count < limits.MIN_VALUES.value:
        return None
    # sliding time, without the rests between segments
    clock = np.interp(moment, *_sliding_clock(start[alike], stop[alike]))
    slid = on_grid(clock[good], clock[good], count)
    friction_along = on_grid(clock[good], values[good], count)
    time = np.interp(slid, clock, moment)
    return _history(
        run, friction, usual, STRETCHES, time, usual * slid, friction_along, np.zeros(0)
    )


def _sliding_clock(start: np.ndarray, stop: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return start and stop times of segments, and the sliding time up to each of them [s]."""
    slid = np.cumsum(stop - start)
    before = slid - (stop - start)
    return np.stack([start, stop], axis=1).ravel(), np.stack([before, slid], axis=1).ravel()


def _coefficients(
    run: xr.Dataset, friction: xr.Dataset, number: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return times and pointwise friction coefficients of a segment, with its mean coefficient."""
    own = {str(name): float(friction[name].values[number]) for name in _READ if name in friction}
    time = run["time"].values
    first = int(np.searchsorted(time, own["start"], "left"))
    last = int(np.searchsorted(time, own["stop"], "right"))
    signal = friction_signal(run)
    values = np.array(run[signal].values[first:last], float)
    values -= np.nan_to_num(own.get(f"{signal}_offset", 0.0))
    if signal == "friction_force":
        load = run["normal_force"].values[first:last] - np.nan_to_num(
            own.get("normal_force_offset", 0.0)
        )
        pressed = load > limits.MIN_LOAD.value * np.nanmedian(load)
        values = np.where(pressed, values / np.where(pressed, load, 1.0), np.nan)
    time = time[first:last]
    inside = (time >= own["trimmed_start"]) & (time <= own["trimmed_stop"])
    mean = float(np.nanmean(values[inside])) if np.isfinite(values[inside]).any() else np.nan
    sign = -1.0 if mean * own["friction_coefficient"] < 0 else 1.0
    return time, sign * values + own["friction_coefficient"] - sign * mean


def _history(
    run: xr.Dataset,
    friction: xr.Dataset,
    speed: float,
    counted: str,
    time: np.ndarray,
    distance: np.ndarray,
    values: np.ndarray,
    work: np.ndarray,
) -> History:
    settling = settling_of(values)
    common = _common_error(friction)
    steady = _mean(values[settling.start : settling.stop], common)
    overall = _mean(values, common)
    wear = _wear(run, time)
    return History(speed, counted, time, distance, values, settling, steady, overall, work, wear)


def _common_error(friction: xr.Dataset) -> float:
    """Return the standard error common to all values: the zero and the stated calibration."""

    def middle(name: str) -> float:
        known = friction[name].values.astype(float) if name in friction else np.zeros(0)
        known = known[np.isfinite(known)]
        return float(np.sqrt(np.median(known**2))) if known.size else 0.0

    name = "friction_coefficient"
    combined, alone = middle(f"{name}_u"), middle(f"{name}_sem")
    stated = np.sqrt(max(combined**2 - alone**2, 0.0))
    return float(np.hypot(middle(f"{name}_shared_sem"), stated))


def _mean(values: np.ndarray, common: float) -> Mean:
    if values.size < 3:
        return Mean()
    level = levels_of(blocks_of(values, int(of_means.BLOCKS.value))[None])
    sem = float(np.hypot(level.sem[0], common))
    return Mean(float(values.mean()), sem, float(np.hypot(level.u95[0], NORMAL * common)))


def _wear(run: xr.Dataset, time: np.ndarray) -> np.ndarray:
    """Return the mean normal displacement around each time, relative to the first."""
    if "height_displacement" not in run:
        return np.zeros(0)
    edges = np.concatenate([[-np.inf], (time[1:] + time[:-1]) / 2, [np.inf]])
    place = np.searchsorted(edges, run["time"].values, "right") - 1
    height = np.asarray(run["height_displacement"].values, float)
    good = np.isfinite(height)
    total = np.bincount(place[good], height[good], time.size)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = total / np.bincount(place[good], minlength=time.size)
    return mean - mean[0]


def _dataset(history: History, run: xr.Dataset) -> xr.Dataset:
    data = {
        "friction_coefficient": history.friction,
        "time": history.time,
        "sliding_distance": history.distance,
        "work_per_cycle": history.work,
        "wear_depth": history.wear,
    }
    values = {name: ("cycle", of) for name, of in data.items() if of.size}
    start, _, end = history.places(history.distance)
    per_value = (end - history.distance[0]) / max(history.friction.size - 0.5, 1.0)
    alone = {
        "sliding_speed": history.speed,
        "running_in_distance": start,
        "running_in_distance_u": per_value * history.settling.start_u,
        "running_in_time": history.places(history.time)[0] - history.time[0],
    }
    for name, mean in (("steady", history.steady), ("mean", history.overall)):
        ends = zip(("", "_sem", "_U95"), mean, strict=True)
        alone |= {f"{name}_friction_coefficient{end}": value for end, value in ends}
    made = xr.Dataset(values | alone, {"cycle": np.arange(1, history.friction.size + 1)})
    about = {"running_in": history.settling.kind, "counted": history.counted}
    return stamp(made, **(run.attrs | about))
