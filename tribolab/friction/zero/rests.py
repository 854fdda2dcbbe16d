"""Zeros of the sensors from unloaded rests, and interpolation between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.core.coverage import NORMAL
from tribolab.friction.mean_error.estimates import estimates_of
from tribolab.friction.zero import limits

_REST_BINS = 100  # bins of an interval that may be unloaded in part


class Zeros(NamedTuple):
    """Readings of an unloaded sensor: times [s], values, and standard errors [N] (rest)."""

    time: np.ndarray
    value: np.ndarray
    error: np.ndarray

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the zero and its standard error at given times [s].

        Parameters
        ----------
        time
            Times [s] (any one dim).

        Notes
        -----
        Linear interpolation between two rests. If the zero changed by d between them, the variance
        at a share u of the interval includes d^2 u (1 - u)/3: for a step at an unknown time it
        would be d^2 u (1 - u), for a steady drift zero, and either is possible. Before the first
        and after the last rest the zero is constant.

        Examples
        --------
        >>> zeros = Zeros(np.array([0.0, 10.0]), np.array([1.0, 2.0]), np.array([0.0, 0.0]))
        >>> value, error = zeros.at(np.array([0.0, 5.0, 20.0]))
        >>> value.tolist(), error.round(3).tolist()
        ([1.0, 1.5, 2.0], [0.0, 0.289, 0.0])
        """
        last = np.searchsorted(self.time, time).clip(1, max(self.time.size - 1, 1))
        last = np.minimum(last, self.time.size - 1)
        first = np.maximum(last - 1, 0)
        apart = self.time[last] - self.time[first]
        u = np.where(apart > 0, (time - self.time[first]) / np.where(apart > 0, apart, 1), 0.0)
        u = u.clip(0, 1)
        value = (1 - u) * self.value[first] + u * self.value[last]
        noise = ((1 - u) * self.error[first]) ** 2 + (u * self.error[last]) ** 2
        moved = (self.value[last] - self.value[first]) ** 2
        moved = np.maximum(moved - self.error[first] ** 2 - self.error[last] ** 2, 0.0)
        return value, np.sqrt(noise + moved * u * (1 - u) / 3)

    def slope(self, time: np.ndarray) -> np.ndarray:
        """Return the drift of the zero at given times [u/s]; 0 before and after all rests."""
        after = np.searchsorted(self.time, time)
        inside = (after > 0) & (after < self.time.size)
        last = after.clip(1, max(self.time.size - 1, 1)) * inside
        first = np.maximum(last - 1, 0)
        apart = np.where(inside, self.time[last] - self.time[first], 1.0)
        return np.where(inside, (self.value[last] - self.value[first]) / apart, 0.0)

    def around(self, time: np.ndarray) -> np.ndarray:
        """Return a mask of the times that lie between two rests."""
        return (time > self.time[0]) & (time < self.time[-1])


class PartialContact(NamedTuple):
    """Number of rests in partial contact, their mean excess load [N], time of the first [s]."""

    rests: int
    level: float
    start: float


class Rests(NamedTuple):
    """Zeros of friction and normal force from unloaded rests, and rests in partial contact."""

    friction: Zeros | None
    normal: Zeros | None
    partial: PartialContact | None = None


def unloaded_rests(run: xr.Dataset, segments: xr.Dataset, load: float) -> Rests:
    """Return zeros of the friction force and of the normal force from unloaded rests.

    Parameters
    ----------
    run, segments
        The run and its segments, whose omitted intervals include the rests.
    load
        Usual normal force of the segments [N].

    Returns
    -------
    Rests
        Zeros of the friction force and of the normal force, in temporal order; None without an
        unloaded rest or unloaded motion. In an unloaded rest the load reading
        is below a tenth of the load, and exceeds that of the lowest rest by no more than noise,
        unless the zero drifts (then the load of the strokes drifts, too). Rests with a higher
        reading may be in partial contact.
    """
    rests = _rest_limits(run, segments, load)
    if rests is None:
        return Rests(None, None)
    time, normal, intervals = rests
    friction = run["friction_force"].values if "friction_force" in run else None
    levels = _unloaded(time, normal, intervals, load)
    if not levels:  # unloaded motion also shows the zero: idling includes the zero of a torque
        levels = _unloaded(time, normal, _limits(segments, "no load"), load)
    if not levels:  # a rest may look like motion if its speed is noise or was recorded without sign
        levels = _unloaded_parts(time, normal, _limits(segments), load)
    levels, partial = _without_partial(time, normal, levels, load, run, segments)
    signals = [normal] if friction is None else [normal, friction]
    estimates = estimates_of((time[level], signal[level]) for signal in signals for level in levels)
    when = [float(time[level].mean()) for level in levels]
    of_normal, of_friction = estimates[: len(levels)], estimates[len(levels) :]
    known = [
        k
        for k, estimate in enumerate(of_friction)
        if estimate.samples >= limits.MIN_SAMPLES_OF_REST.value
    ]
    return Rests(
        _zeros([(when[k], of_friction[k].mean, of_friction[k].u95 / NORMAL) for k in known]),
        _zeros([(at, own.mean, own.u95 / NORMAL) for at, own in zip(when, of_normal, strict=True)]),
        partial,
    )


def _without_partial(
    time: np.ndarray,
    normal: np.ndarray,
    levels: list[np.ndarray],
    load: float,
    run: xr.Dataset,
    segments: xr.Dataset,
) -> tuple[list[np.ndarray], PartialContact | None]:
    """Return the unloaded rests, and the excess load of other rests unless a drift explains it."""
    if len(levels) < 2:
        return levels, None
    reads = np.array([float(np.mean(normal[level])) for level in levels])
    lowest = int(reads.argmin())
    noise = limits.UNLOADED_NOISE.value * float(np.std(normal[levels[lowest]]))
    near = reads - reads[lowest] <= max(noise, limits.UNLOADED_SHARE.value * load)
    if near.all() or _zero_drifts(time, normal, levels, reads, segments):
        return levels, None
    first = int(np.flatnonzero(~near)[0])
    excess = float(np.mean(reads[~near]) - np.mean(reads[near]))
    partial = PartialContact(int((~near).sum()), excess, float(time[levels[first][0]]))
    return [level for level, kept in zip(levels, near, strict=True) if kept], partial


def _zero_drifts(
    time: np.ndarray,
    normal: np.ndarray,
    levels: list[np.ndarray],
    reads: np.ndarray,
    segments: xr.Dataset,
) -> bool:
    """Return whether the load drifts equally at rest and in strokes, as a drifting zero shows."""
    at = np.array([float(time[level].mean()) for level in levels])
    ends = (segments[f"trimmed_{end}"].values for end in ("start", "stop"))
    first, last = (np.searchsorted(time, end) for end in ends)
    fine = last > first
    if fine.sum() < 2:
        return False
    loads = np.array([np.mean(normal[a:b]) for a, b in zip(first[fine], last[fine], strict=True)])
    middle = (time[first[fine]] + time[last[fine] - 1]) / 2
    if loads.max() > limits.LOADS_DIFFER.value * loads.min():
        return True  # with several loads a drift cannot be excluded
    zero = np.interp(middle, at, reads)
    # scatter of the loads minus the zero at the rests
    return bool(np.std(loads - zero) < limits.DRIFT_IN_STROKES.value * np.std(loads))


class LightRest(NamedTuple):
    """Time [s] of a rest with a small normal force [N], which is the zero or a light load."""

    start: float
    stop: float
    level: float


def light_rest(
    run: xr.Dataset, segments: xr.Dataset, load: float, loads: np.ndarray
) -> LightRest | None:
    """Return the first rest that may be unloaded, if none certainly is.

    Parameters
    ----------
    run, segments, load
        As for `unloaded_rests`, which found none.
    loads
        Normal force of each segment [N]: a rest with the load of one of them is under load
        (segment).
    """
    rests = _rest_limits(run, segments, load)
    if rests is None:
        return None
    time, normal, intervals = rests
    for start, stop in intervals:
        first, last = np.searchsorted(time, [start, stop])
        level = level_without_load(normal, first, last, load)
        if level.size < limits.MIN_SAMPLES_OF_REST.value:
            continue
        reads = float(np.mean(normal[level]))
        if not (np.abs(loads) < limits.MAX_RATIO_TO_REST.value * abs(reads)).any():
            return LightRest(float(time[level[0]]), float(time[level[-1]]), reads)
    return None


def _rest_limits(
    run: xr.Dataset, segments: xr.Dataset, load: float
) -> tuple[np.ndarray, np.ndarray, list[tuple[float, float]]] | None:
    """Return time, normal force, and start and end of rests [s]; None without a load signal."""
    if "normal_force" not in run or not load > 0 or "omitted" not in segments.dims:
        return None
    return run["time"].values, run["normal_force"].values, _limits(segments, "at rest")


def _limits(segments: xr.Dataset, reason: str = "") -> list[tuple[float, float]]:
    """Return start and end times of the intervals omitted for a reason; of all without a reason."""
    reasons = segments["omitted_reason"].values
    chosen = reasons == reason if reason else np.ones(reasons.size, bool)
    starts, stops = (segments[name].values[chosen] for name in ("omitted_start", "omitted_stop"))
    return list(zip(starts.tolist(), stops.tolist(), strict=True))


def _unloaded(
    time: np.ndarray, normal: np.ndarray, intervals: list[tuple[float, float]], load: float
) -> list[np.ndarray]:
    """Return the indices of the unloaded samples of each interval."""
    before, levels = 0.0, []
    for start, stop in intervals:
        first, last = np.searchsorted(time, [start, stop])
        level = level_without_load(normal, first, last, load)
        # a higher reading than before may be a light load; a lower one is not: surfaces hardly
        # attract
        if (
            level.size < limits.MIN_SAMPLES_OF_REST.value
            or np.mean(normal[level]) - before > limits.MAX_DRIFT_OF_LOAD_ZERO.value * load
        ):
            continue
        before = float(np.mean(normal[level]))
        levels.append(level)
    return levels


def _unloaded_parts(
    time: np.ndarray, normal: np.ndarray, intervals: list[tuple[float, float]], load: float
) -> list[np.ndarray]:
    """Return the longest part of each interval at a constant load near zero, moving or not."""
    levels = []
    for level in _unloaded(time, normal, intervals, load):
        first, last = int(level[0]), int(level[-1]) + 1
        bins = min(_REST_BINS, (last - first) // limits.MIN_SAMPLES_OF_REST.value)
        if bins < 1:
            continue
        at = first + (last - first) * np.arange(bins + 1) // bins
        part = np.nan_to_num(normal[first:last], nan=np.inf)
        mean = np.add.reduceat(part, at[:-1] - first) / np.diff(at)
        near = np.abs(mean - median(normal[level])) < limits.MAX_SCATTER_OF_BARE_REST.value * load
        edges = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]])))
        if not edges.size:
            continue
        longest = int(np.argmax(edges[1::2] - edges[::2]))
        begin, end = at[edges[2 * longest]], at[edges[2 * longest + 1]]
        if (
            np.abs(np.mean(normal[begin:end])) < limits.MAX_DRIFT_OF_LOAD_ZERO.value * load
            and end - begin >= 2 * limits.MIN_SAMPLES_OF_REST.value
        ):
            levels.append(np.arange(begin, end))
    return levels


def level_without_load(normal: np.ndarray, first: int, last: int, load: float) -> np.ndarray:
    """Return the samples of a rest at one level far below the load, if any.

    A reading far below zero is an offset, because nothing pulls at rest.
    """
    light = first + np.flatnonzero(normal[first:last] < limits.MAX_LOAD_OF_BARE_REST.value * load)
    if light.size < limits.MIN_SAMPLES_OF_REST.value:
        return light
    # a load ramp may take up most of the rest: the level is where readings are densest, and
    # distant readings are omitted
    ordered = np.sort(normal[light])
    part = light.size // 4
    width = ordered[part:] - ordered[: light.size - part]
    densest = int(np.argmin(width))
    level = median(ordered[densest : densest + part + 1])
    # for normal noise the densest quarter is 0.637 standard deviations wide
    apart = np.abs(normal[light] - level)
    light = light[apart <= 5 * max(float(width[densest]) / 0.637, 1e-4 * load)]
    rest = np.abs(normal[light] - median(normal[light]))
    return light[rest <= 5 * max(median(rest) / 0.6745, 1e-4 * load)]


def _zeros(rests: list[tuple[float, float, float]]) -> Zeros | None:
    return Zeros(*np.array(rests).T) if rests else None
