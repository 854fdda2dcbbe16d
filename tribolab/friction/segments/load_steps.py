"""Steps of the load within an interval of constant speed."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.segments import limits
from tribolab.friction.segments.stretches import Stretch

_LOAD_BINS = 600  # most bins of an interval whose load is compared
_SAMPLES_PER_BIN = 10  # fewest samples in a bin
_CHANGES = "load changes"


def at_levels(
    time: np.ndarray, force: np.ndarray, stretch: Stretch, min_samples: int
) -> list[Stretch]:
    """Return an interval cut at steps of its load; transitions are not segments.

    Parameters
    ----------
    time, force
        Times [s] and normal force [N] of the run (time).
    stretch
        Interval at constant speed, in contact.
    min_samples
        Fewest samples of a segment.

    Returns
    -------
    list of Stretch
        The unchanged interval alone if the load drifts or rises throughout, without levels.
    """
    first, last = np.searchsorted(time, [stretch.start, stretch.stop])
    bins = min(_LOAD_BINS, (last - first) // _SAMPLES_PER_BIN)
    if bins < 2 * limits.MIN_BINS_OF_LEVEL.value:
        return [stretch]
    at = first + (last - first) * np.arange(bins + 1) // bins
    part = force[first:last]
    if not np.isfinite(part).all():
        part = np.where(np.isfinite(part), part, median(part[np.isfinite(part)]))
    mean = np.add.reduceat(part, at[:-1] - first) / np.diff(at)
    levels = _levels(mean, 0, bins)
    kept = [_trim_level(mean, a, b) for a, b in levels]
    if len(levels) < 2 or any(b - a < limits.MIN_BINS_OF_LEVEL.value for a, b in kept):
        return [stretch]
    loads = np.sort([abs(float(median(mean[a:b]))) for a, b in kept])
    if (
        1 + np.count_nonzero(loads[1:] > (1 + limits.MAX_SCATTER_OF_LEVEL.value) * loads[:-1])
        > limits.MAX_LOAD_LEVELS.value
    ):
        return [stretch]
    if sum(b - a for a, b in kept) < limits.MIN_TIME_AT_LEVELS.value * bins:
        return [stretch]
    result: list[Stretch] = []
    place = 0
    for a, b in [*kept, (bins, bins)]:
        for begin, end, kind in ((place, a, _CHANGES), (a, b, stretch.kind)):
            if end > begin:
                few = kind != _CHANGES and at[end] - at[begin] < min_samples
                start = stretch.start if begin == 0 else float(time[at[begin]])
                stop = stretch.stop if end == bins else float(time[at[end]])
                kind = "too short" if few else kind
                result.append(stretch._replace(start=start, stop=stop, kind=kind))
        place = b
    return result


def _levels(mean: np.ndarray, first: int, last: int) -> list[tuple[int, int]]:
    """Return ranges of bins at one load each: a range is split where the load steps most."""
    part = mean[first:last]
    if part.size < 2 * limits.MIN_BINS_OF_LEVEL.value:
        return [(first, last)]
    total, squares = np.cumsum(part), np.cumsum(part**2)
    n = np.arange(1, part.size)
    before = squares[:-1] - total[:-1] ** 2 / n
    after = (squares[-1] - squares[:-1]) - (total[-1] - total[:-1]) ** 2 / (part.size - n)
    cost = (before + after)[
        limits.MIN_BINS_OF_LEVEL.value - 1 : part.size - limits.MIN_BINS_OF_LEVEL.value
    ]
    cut = int(np.argmin(cost)) + limits.MIN_BINS_OF_LEVEL.value
    ends = [abs(float(median(side))) for side in (part[:cut], part[cut:])]
    near = [float(median(side)) for side in (part[max(0, cut - 20) : cut], part[cut : cut + 20])]
    if max(abs(near[1] - near[0]), abs(ends[1] - ends[0])) < limits.MIN_LOAD_STEP.value * max(ends):
        return [(first, last)]
    return [*_levels(mean, first, first + cut), *_levels(mean, first + cut, last)]


def _trim_level(mean: np.ndarray, first: int, last: int) -> tuple[int, int]:
    """Return the range of bins of a load level without the transitions at its ends."""
    level = float(median(mean[first:last]))
    near = np.flatnonzero(
        np.abs(mean[first:last] - level) <= limits.MAX_SCATTER_OF_LEVEL.value * abs(level)
    )
    if near.size < 0.7 * (last - first):  # the load is not at one level
        return first, first
    return first + int(near[0]), first + int(near[-1]) + 1
