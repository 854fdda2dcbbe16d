"""Friction signal when there is no friction: before any sliding, and without load."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.friction.zero import limits
from tribolab.friction.zero.parts import Doubt, ZeroReference, doubt
from tribolab.friction.zero.rests import Zeros, level_without_load


class WithoutSliding(NamedTuple):
    """Readings of the friction signal [N], each with its standard error; NaN where unknown.

    `tilt` is the difference between a loaded rest before any sliding and an unloaded one; `drag` is
    half the loop of strokes without load.
    """

    tilt: tuple[float, float]
    drag: tuple[float, float]


def without_sliding(
    run: xr.Dataset, segments: xr.Dataset, rests: Zeros | None, load: float
) -> WithoutSliding:
    """Return the readings of the friction signal before any sliding, and in unloaded strokes.

    Parameters
    ----------
    run, segments
        The run and its segments, whose omitted intervals include rests and unloaded motion.
    rests
        Zeros of the friction force from rests without load.
    load
        Usual normal force of the segments [N].
    """
    nothing = (float("nan"), float("nan"))
    if "omitted" not in segments.dims or "normal_force" not in run or not load > 0:
        return WithoutSliding(nothing, nothing)
    return WithoutSliding(
        nothing if rests is None else _before_sliding(run, segments, rests, load),
        _without_load(run, segments, rests, load),
    )


def stretches_of(run: xr.Dataset, segments: xr.Dataset, reason: str) -> list[slice]:
    """Return the index ranges of the intervals omitted for a given reason."""
    time, chosen = run["time"].values, segments["omitted_reason"].values == reason
    starts, stops = (segments[f"omitted_{end}"].values[chosen] for end in ("start", "stop"))
    first, last = (np.searchsorted(time, ends) for ends in (starts, stops))
    return [slice(int(a), int(b)) for a, b in zip(first, last, strict=True)]


def _before_sliding(
    run: xr.Dataset, segments: xr.Dataset, rests: Zeros, load: float
) -> tuple[float, float]:
    """Return the signal in the loaded rest before any sliding; later rests retain friction."""
    time, force = run["time"].values, run["friction_force"].values
    normal = run["normal_force"].values
    begins = float(segments["start"].values.min(initial=np.inf))
    ramps = segments["omitted_reason"].values != "at rest"
    begins = min(begins, float(segments["omitted_start"].values[ramps].min(initial=np.inf)))
    for part in stretches_of(run, segments, "at rest"):
        inside = np.arange(part.start, part.stop)
        inside = inside[
            (time[inside] < begins) & (normal[inside] > limits.MIN_LOAD_OF_REST.value * load)
        ]
        inside = inside[np.isfinite(force[inside])]
        if inside.size >= limits.MIN_SAMPLES_OF_LOADED_REST.value:
            zero, error = rests.at(time[inside[:1]])
            own = float(np.std(force[inside])) / np.sqrt(inside.size)
            reads = float(np.mean(force[inside])) - float(zero[0])
            return reads, float(np.hypot(own, error[0]))
    return float("nan"), float("nan")


def _without_load(
    run: xr.Dataset, segments: xr.Dataset, rests: Zeros | None, load: float
) -> tuple[float, float]:
    """Return half the loop of unloaded strokes; if one way only, their force minus that at rest."""
    if "sliding_velocity" not in run:
        return float("nan"), float("nan")
    found: list[tuple[float, float, float, float]] = []  # direction, mean, its error, mean time
    time, velocity, force = (run[k].values for k in ("time", "sliding_velocity", "friction_force"))
    for part in stretches_of(run, segments, "no load"):
        # friction also changes while the load is applied or removed
        bare = level_without_load(run["normal_force"].values, part.start, part.stop, load)
        own = force[bare][np.isfinite(force[bare])]
        speed = np.nanmean(velocity[part]) if own.size else 0.0
        if own.size >= limits.MIN_SAMPLES_OF_LOADED_REST.value and speed:
            error = float(np.std(own)) / np.sqrt(own.size)
            found.append((float(np.sign(speed)), float(np.mean(own)), error, time[part].mean()))
    if not found:
        return float("nan"), float("nan")
    way, mean, error, at = np.array(found).T
    ways = np.unique(way)
    if ways.size == 1 and rests is None:
        return float("nan"), float("nan")
    if ways.size == 1 and rests is not None:
        zero, unsure = rests.at(at)
        mean, error = mean - zero, np.hypot(error, unsure)
    half = np.mean([w * mean[way == w].mean() for w in ways])
    own = [float((error[way == w] ** 2).mean()) / np.count_nonzero(way == w) for w in ways]
    return float(half), float(np.sqrt(sum(own)) / ways.size)


class LoadedAndIdle(NamedTuple):
    """Error of friction [N] due to tilt and drag if these are small, else doubts."""

    error: float
    doubts: tuple[Doubt, ...]


def of_loaded_and_idle(
    readings: WithoutSliding, zero: ZeroReference, mean: np.ndarray, load: float
) -> LoadedAndIdle:
    """Return doubts about friction that a loaded rest or unloaded strokes contradict.

    Readings below the limits count as errors of either sign, uniformly distributed.

    Parameters
    ----------
    readings
        From `without_sliding`.
    zero
        Source of the zero; the half loop is free of a tilt, but not of drag.
    mean
        Mean friction force of each segment [N].
    load
        Usual normal force [N].
    """
    known = np.abs(mean - zero.value)[np.isfinite(mean)]
    if not known.size:
        return LoadedAndIdle(0.0, ())
    friction, every = float(median(known)), np.arange(mean.size)
    doubts, carried = [], []
    (tilt, tilt_error), (drag, drag_error) = readings
    seen = (
        zero.method != "half loop" and abs(tilt) > limits.MIN_ERRORS_OF_READINGS.value * tilt_error
    )
    if seen:
        carried.append(tilt)
    if seen and abs(tilt) > limits.LOADED_REST_SHARE.value * friction:
        text = (
            f"the loaded rest before any sliding reads {tilt:+.3g} N ({abs(tilt) / friction:.1%} "
            "of the friction), unloaded rests zero: a tilt of "
            f"{np.degrees(np.arctan2(abs(tilt), load)):.2g} degrees, or cross-talk of the load. "
            f"The friction coefficient is off by up to {abs(tilt) / load:.2g}"
        )
        cure = "Slide both ways, or level the force cell and state `tilt` in [uncertainty]."
        doubts.append(doubt(text, cure, every))
    seen = abs(drag) > limits.MIN_ERRORS_OF_READINGS.value * drag_error
    if seen:
        carried.append(drag)
    if seen and abs(drag) > limits.DRAG_SHARE.value * friction:
        text = (
            f"strokes without load show {abs(drag):.3g} N of drag ({abs(drag) / friction:.1%} of "
            "the friction): the bearing or a seal rubs. It is part of the friction coefficient, "
            f"which is {abs(drag) / load:.2g} smaller without it"
        )
        cure = "Free the bearing, or subtract the drag and state what is left in [uncertainty]."
        doubts.append(doubt(text, cure, every))
    return LoadedAndIdle(float(np.hypot.reduce(carried, initial=0.0)) / np.sqrt(3), tuple(doubts))
