"""Uncertainty of the load reading: retained load, cross-talk from friction, creep."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import pieces
from tribolab.arrays.medians import median
from tribolab.core.attributes import RunAttributes
from tribolab.friction.zero import limits
from tribolab.friction.zero.parts import Doubt, ZeroReference
from tribolab.friction.zero.without_sliding import stretches_of
from tribolab.friction.zero.words import of_leak, of_retained_load

# half width of a uniform distribution divided by its standard deviation
WIDTH_OVER_SIGMA = np.sqrt(3)
_NEAREST_RESTS = 4  # nearest rests that are compared with a segment
# number of blocks of readings; slow waves and ramps also contribute to the scatter of their means
_READING_BLOCKS = 5


class LoadReading(NamedTuple):
    """Standard uncertainty of each segment's load [N] (segment), and doubts about the load."""

    error: np.ndarray
    doubts: tuple[Doubt, ...]


def load_reading(
    run: xr.Dataset,
    segments: xr.Dataset,
    parts: list[slice],
    pressed: np.ndarray,
    offset: np.ndarray,
    friction: np.ndarray,
    zero: ZeroReference,
) -> LoadReading:
    """Return the uncertainty of each segment's load reading, as far as the run shows it.

    Parameters
    ----------
    run, segments, parts
        The run, its segments, and the samples of each.
    pressed, offset
        Load minus the zero of the load cell, and that zero [N] (segment).
    friction
        Mean of the friction signal [N] (segment).
    zero
        Zero of the friction signal.

    Notes
    -----
    Each difference d between two readings of one load may be an error of the reading or real. It
    counts as uniform within +-d, with the standard uncertainty d/sqrt(3). A positive zero of the
    cell at rests may be a retained load. Cross-talk of a share k of friction changes the load
    reading by k F when sliding starts; the half loop is free of it. Creep of the reading counts
    from the farther end of the run.
    """
    nothing = LoadReading(np.zeros(pressed.size), ())
    known = pressed[np.isfinite(pressed) & (pressed > 0)]
    if not known.size:
        return nothing
    stated = "normal_zero" in RunAttributes.from_attrs(run.attrs).uncertainty
    retained = nothing if stated else _retained(offset, float(median(known)))
    found = [retained, LoadReading(_creep(run, segments, parts, pressed), ())]
    if zero.method != "half loop":
        found.append(_leak(run, segments, parts, pressed, offset, friction, zero))
    error = np.sqrt(sum(one.error**2 for one in found))
    return LoadReading(error, tuple(doubt for one in found for doubt in one.doubts))


def _retained(offset: np.ndarray, load: float) -> LoadReading:
    """Return the error of the load's zero, as some load may have remained at the rests."""
    level = np.where(offset > limits.UNLOADED_SHARE.value * load, offset, 0.0)
    usual = float(np.mean(level))
    doubts: tuple[Doubt, ...] = ()
    if usual > limits.DOUBTFUL_REST.value * load:
        doubts = (of_retained_load(usual, load, offset.size),)
    return LoadReading(level / WIDTH_OVER_SIGMA, doubts)


def _leak(
    run: xr.Dataset,
    segments: xr.Dataset,
    parts: list[slice],
    pressed: np.ndarray,
    offset: np.ndarray,
    friction: np.ndarray,
    zero: ZeroReference,
) -> LoadReading:
    """Return the error of the load by cross-talk, which makes sliding differ from loaded rests."""
    rests = stretches_of(run, segments, "at rest") if "omitted" in segments.dims else []
    starts, reads = segments["trimmed_start"].values, pressed + offset
    normal = run["normal_force"].values
    leak = np.zeros(pressed.size)
    time = run["time"].values
    middles = np.array([time[part].mean() for part in rests])
    for i in range(pressed.size):
        force = friction[i] - zero.value[i]
        if not (
            pressed[i] > 0 and abs(force) > 0 and parts[i].stop - parts[i].start > _READING_BLOCKS
        ):
            continue
        # a load that drifts while sliding also drifts between rest and sliding
        wanders = _mean_of_blocks(normal[parts[i]])[1] * np.sqrt(_READING_BLOCKS)
        useful = []
        for k in np.argsort(np.abs(middles - starts[i]), kind="stable")[:_NEAREST_RESTS]:
            rest = _loaded_rest(run, rests[k], bool(middles[k] < starts[i]), float(reads[i]))
            let_go = 0.0 if rest is None else 1 - (rest.force - zero.value[i]) / force
            if rest is not None and let_go > limits.FRICTION_RELEASED.value:
                found = (reads[i] - rest.normal) / let_go
                error = float(np.hypot(rest.error, wanders)) / let_go
                useful.append((abs(rest.time - starts[i]), found, error))
        if useful:
            _, found, error = min(useful)
            leak[i] = found if abs(found) > limits.MIN_ERRORS_OF_READINGS.value * error else 0.0
    share = np.abs(leak) / np.where(pressed > 0, pressed, np.inf)
    which = np.flatnonzero(share > limits.LOAD_AT_REST.value)
    doubts: tuple[Doubt, ...] = ()
    if which.size:
        worst = int(share.argmax())
        doubts = (of_leak(float(leak[worst]), float(pressed[worst]), which),)
    return LoadReading(np.abs(leak) / WIDTH_OVER_SIGMA, doubts)


class _Rest(NamedTuple):
    """Mean time [s] of a loaded rest, its load and friction, and the load's standard error [N]."""

    time: float
    normal: float
    force: float
    error: float


def _loaded_rest(run: xr.Dataset, part: slice, before: bool, load: float) -> _Rest | None:
    """Return the readings in the half of a rest next to a segment, if it has the segment's load."""
    half = (part.stop - part.start) // 2
    near = slice(part.start + half, part.stop) if before else slice(part.start, part.start + half)
    time, normal, force = (run[k].values[near] for k in ("time", "normal_force", "friction_force"))
    alike = limits.SAME_LOAD.value
    good = np.isfinite(force) & (normal > load / alike) & (normal < load * alike)
    if good.sum() < limits.MIN_SAMPLES_OF_LOADED_REST.value:
        return None
    mean, error = _mean_of_blocks(normal[good])
    return _Rest(float(time[good].mean()), mean, float(median(force[good])), error)


def _creep(
    run: xr.Dataset, segments: xr.Dataset, parts: list[slice], pressed: np.ndarray
) -> np.ndarray:
    """Return the uncertainty of each segment due to creep of the load reading [N] (segment)."""
    full = np.array([part.stop - part.start >= 10 * _READING_BLOCKS for part in parts], bool)
    full &= np.isfinite(pressed) & (pressed > 0)
    if not full.any():
        return np.zeros(pressed.size)
    if pressed[full].max() > limits.LOADS_DIFFER.value * pressed[full].min():
        return np.zeros(pressed.size)
    way = segments["direction"].values
    first = int(np.flatnonzero(full)[0])
    last = int(np.flatnonzero(full & (way == way[first]))[-1])
    normal, time = run["normal_force"].values, run["time"].values
    begins = _tenth(normal[parts[first]], slice(None, None))
    ends = _tenth(normal[parts[last]], slice(None, None, -1))
    change = ends[0] - begins[0]
    if not abs(change) > limits.MIN_ERRORS_OF_READINGS.value * np.hypot(begins[1], ends[1]):
        return np.zeros(pressed.size)
    lasted = _middle_of_tenth(time[parts[last]], -1) - _middle_of_tenth(time[parts[first]], 1)
    begin, end = _loaded_range(normal, 0.5 * float(np.nanmean(normal[parts[first]])))
    middle = (segments["trimmed_start"].values + segments["trimmed_stop"].values) / 2
    away = np.maximum(middle - time[begin], time[end] - middle)
    return abs(change / lasted) * away / WIDTH_OVER_SIGMA


def _loaded_range(normal: np.ndarray, least: float) -> tuple[int, int]:
    """Return the indices of the first and the last sample under load."""
    found: list[int] = []
    for a, b in pieces(0, normal.size):
        own = np.flatnonzero(normal[a:b] > least)
        found += [a + int(i) for i in own[[0, -1]]] if own.size else []
    return found[0], found[-1]


def _middle_of_tenth(time: np.ndarray, way: int) -> float:
    return float(np.mean(time[::way][: time.size // 10]))


def _tenth(values: np.ndarray, order: slice) -> tuple[float, float]:
    """Return the mean of the first tenth of values in a given order, and its standard error."""
    return _mean_of_blocks(values[order][: values.size // 10])


def _mean_of_blocks(values: np.ndarray) -> tuple[float, float]:
    """Return the mean of readings and its standard error, which includes slow waves and ramps."""
    means = [float(np.nanmean(block)) for block in np.array_split(values, _READING_BLOCKS)]
    return float(np.mean(means)), float(np.std(means, ddof=1)) / np.sqrt(_READING_BLOCKS)
