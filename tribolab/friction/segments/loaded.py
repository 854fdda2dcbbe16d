"""Parts of the intervals of constant speed in which the contact is loaded."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import one_by_one
from tribolab.arrays.medians import median
from tribolab.friction.segments import limits
from tribolab.friction.segments.load_steps import at_levels
from tribolab.friction.segments.pieces import ConstancyLimits
from tribolab.friction.segments.stretches import Stretch
from tribolab.friction.zero.limits import (
    MAX_DRIFT_OF_LOAD_ZERO,
    MIN_SAMPLES_OF_REST,
    UNLOADED_NOISE,
    UNLOADED_SHARE,
)

_NO_LOAD = "no load"
_CONTACT_BINS = 200  # bins of an interval whose load is compared


def loaded(run: xr.Dataset, stretches: list[Stretch], constancy: ConstancyLimits) -> list[Stretch]:
    """Remove unloaded sliding from the intervals of constant speed.

    Parameters
    ----------
    run
        The run; without ``normal_force`` nothing is removed.
    stretches
        All intervals of the run in order.
    constancy
        The `min_samples` of a segment is used.

    Returns
    -------
    list of Stretch
        The intervals, unloaded ones of kind ``"no load"``; an interval is cut where the load is
        removed or applied within it, and at each step of the load.
    """
    if "normal_force" not in run:
        return stretches
    time, force = run["time"].values, np.asarray(run["normal_force"].values, float)
    middles = {k: _median(time, force, stretches, k) for k in ("constant", "at rest")}
    sliding = middles["constant"]
    # only loads in contact count, as most strokes may be unloaded
    pressing = sliding[
        (sliding > 0) & (sliding > MAX_DRIFT_OF_LOAD_ZERO.value * sliding.max(initial=0.0))
    ]
    usual = float(median(pressing)) if pressing.size else 0.0
    if not usual > 0:
        return stretches
    rests = middles["at rest"]
    rests = rests[np.abs(rests) < MAX_DRIFT_OF_LOAD_ZERO.value * usual]
    zero = float(median(rests)) if rests.size else 0.0
    least = limits.MIN_LOAD_OF_CONTACT.value * (usual - zero)
    if (noise := _noise_at_rest(time, force, stretches, zero, usual)) > 0:
        least = min(least, max(UNLOADED_NOISE.value * noise, UNLOADED_SHARE.value * usual))
    result: list[Stretch] = []
    for stretch in one_by_one(stretches):
        if stretch.kind == "constant":
            result += _cut_at_contact(time, force, zero, stretch, least, constancy.min_samples)
        else:
            result.append(stretch)
    cut: list[Stretch] = []
    for stretch in one_by_one(result):
        steps = stretch.kind == "constant"
        parts = at_levels(time, force, stretch, constancy.min_samples) if steps else [stretch]
        cut += parts
    return cut


def _noise_at_rest(
    time: np.ndarray, force: np.ndarray, stretches: list[Stretch], zero: float, usual: float
) -> float:
    """Return the scatter of the load readings in the first unloaded rest [N]; 0 without one."""
    for stretch in one_by_one(stretches):
        if stretch.kind == "at rest":
            part = force[slice(*np.searchsorted(time, [stretch.start, stretch.stop]))]
            part = part[np.abs(part - zero) < MAX_DRIFT_OF_LOAD_ZERO.value * usual]
            if part.size >= MIN_SAMPLES_OF_REST.value:
                return float(median(np.abs(part - median(part))) / 0.6745)
    return 0.0


def _median(time: np.ndarray, force: np.ndarray, stretches: list[Stretch], kind: str) -> np.ndarray:
    levels = []
    for stretch in one_by_one(stretches):
        if stretch.kind == kind:
            first, last = np.searchsorted(time, [stretch.start, stretch.stop])
            part = force[first:last][:: max(1, (last - first) // 4096)]
            part = part[np.isfinite(part)]
            if part.size:
                levels.append(float(median(part)))
    return np.array(levels)


def _cut_at_contact(
    time: np.ndarray,
    force: np.ndarray,
    zero: float,
    stretch: Stretch,
    least: float,
    min_samples: int,
) -> list[Stretch]:
    """Return an interval cut where the load is applied or removed."""
    first, last = np.searchsorted(time, [stretch.start, stretch.stop])
    count = min(_CONTACT_BINS, last - first)
    if count < 1:
        return [stretch]
    at = first + (last - first) * np.arange(count + 1) // count
    part = np.nan_to_num(force[first:last] - zero, copy=False)
    mean = np.add.reduceat(part, at[:-1] - first) / np.diff(at)
    bare = mean < least
    if not bare.mean() > limits.MAX_LOST_CONTACT.value:
        return [stretch]
    if bare.all():
        return [stretch._replace(kind=_NO_LOAD)]
    away = _grow_bins(bare, mean < limits.MIN_LOAD_OF_LOADED.value * float(median(mean[~bare])))
    edges = np.flatnonzero(np.diff(away)) + 1
    if edges.size > 2 * limits.MAX_CONTACT_LOSSES.value:
        return [stretch]
    if away.all():
        return [stretch._replace(kind=_NO_LOAD)]
    marks = np.concatenate([[0], edges, [count]])
    result = []
    for a, b in zip(marks[:-1], marks[1:], strict=True):
        kind = _NO_LOAD if away[a] else "constant"
        if kind == "constant" and at[b] - at[a] < min_samples:
            kind = "too short"
        start = stretch.start if a == 0 else float(time[at[a]])
        stop = stretch.stop if b == count else float(time[at[b]])
        result.append(stretch._replace(start=start, stop=stop, kind=kind))
    return result


def _grow_bins(seed: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """Return a mask of those sequences of `allowed` bins that contain a `seed` bin."""
    allowed = allowed | seed
    number = np.cumsum(np.diff(allowed, prepend=False) & allowed)
    holding = np.unique(number[seed])
    return allowed & np.isin(number, holding)
