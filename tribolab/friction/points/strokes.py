"""Strokes of runs as observations, and the mean of a run at each speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.attributes import SegmentAttributes
from tribolab.core.coverage import NORMAL
from tribolab.friction.mean_error.estimates import error_of_series
from tribolab.friction.mean_error.freedom import coverage_of
from tribolab.friction.points import limits
from tribolab.friction.points.mean_of_repeats import Mean, mean_of_repeats, pooled_scatter
from tribolab.friction.points.speed_groups import speed_groups, sweeps_of
from tribolab.friction.zero.of_run import PAIRED


class Observations(NamedTuple):
    """Independent observations of friction: pairs of strokes, and strokes without a partner.

    `sem` and `u95` are of the mean as an estimate beyond the stroke; `shared` is the part of `sem`
    that all strokes of the run have in common; `order` is the position in the run; `variance` is
    the mean square of the scatter within the strokes.
    """

    run: np.ndarray
    order: np.ndarray
    speed: np.ndarray
    set_speed: np.ndarray
    mean: np.ndarray
    sem: np.ndarray
    u95: np.ndarray
    shared: np.ndarray
    variance: np.ndarray
    strokes: np.ndarray

    def of(self, members: np.ndarray) -> Observations:
        """Return the selected observations."""
        return Observations(*(column[members] for column in self))


def observations_of(frictions: Sequence[xr.Dataset]) -> Observations:
    """Return the independent observations of runs: pairs of strokes, and single strokes.

    Parameters
    ----------
    frictions
        Results of `tribolab.friction_coefficient`, without rejected segments.
    """
    parts = [_observe_run(friction, number) for number, friction in enumerate(frictions)]
    if not parts:
        return Observations(*(np.zeros(0) for _ in Observations._fields))
    return Observations(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _observe_run(friction: xr.Dataset, run: int) -> Observations:
    speed = friction["sliding_speed"].values.astype(float)
    value = friction["friction_coefficient"].values.astype(float)
    blank = np.full(value.size, np.nan)

    def column(*names: str) -> np.ndarray:
        found = (friction[name].values.astype(float) for name in names if name in friction)
        return next(found, blank)

    name = "friction_coefficient"
    sem = column(f"{name}_beyond_sem", f"{name}_sem")
    wide = column(f"{name}_beyond_U95", f"{name}_U95")
    wanted = np.abs(column("set_speed"))
    known = np.isfinite(value) & (speed > 0)
    shared = column(f"{name}_shared_sem")
    return grouped_strokes(
        run, speed, wanted, value, sem, wide, shared, column(f"{name}_std") ** 2,
        pairs_of(friction), known,
    )  # fmt: skip


def pairs_of(friction: xr.Dataset) -> np.ndarray:
    """Return the pair number of each segment; -1 without a partner (segment)."""
    if "pair" not in friction or SegmentAttributes.from_attrs(friction.attrs).offset not in PAIRED:
        return np.full(friction.sizes["segment"], -1.0)
    return friction["pair"].values.astype(float)


def wider_error(column: Callable[[str], np.ndarray], name: str, ending: str) -> np.ndarray:
    """Return the larger of each segment's errors: of the mean over its path, or beyond the path.

    Parameters
    ----------
    column
        Function that returns a column of the friction result by name, NaN if it is missing.
    name, ending
        The quantity; "sem" or "U95".
    """
    return np.fmax(column(f"{name}_{ending}"), column(f"{name}_beyond_{ending}"))


def grouped_strokes(
    run: int,
    speed: np.ndarray,
    set_speed: np.ndarray,
    value: np.ndarray,
    sem: np.ndarray,
    u95: np.ndarray,
    shared: np.ndarray,
    variance: np.ndarray,
    pairs: np.ndarray,
    known: np.ndarray,
) -> Observations:
    """Return observations from strokes (stroke): the two strokes of a pair make one observation.

    Parameters
    ----------
    run
        Number of the run.
    speed, set_speed, value, sem, u95, shared, variance
        Columns of the strokes, speeds in m/s. An unknown `u95` is computed from `sem` for a normal
        distribution.
    pairs
        The same number for the strokes of a pair, below 0 for a stroke without a partner.
    known
        Mask of the strokes used.
    """
    u95 = np.where(np.isfinite(u95), u95, NORMAL * sem)
    alone = -1.0 - np.arange(value.size)
    place = np.flatnonzero(known)
    key = np.where(pairs >= 0, pairs, alone)[place]
    _, which = np.unique(key, return_inverse=True)
    count = np.bincount(which)

    def mean(column: np.ndarray) -> np.ndarray:
        return np.bincount(which, column[place], count.size) / count

    result = Observations(
        np.full(count.size, run),
        mean(np.arange(value.size, dtype=float)),
        mean(speed),
        mean(set_speed),
        mean(value),
        mean(sem),
        mean(u95),
        np.nan_to_num(mean(shared)),
        mean(variance),
        count,
    )
    return result.of(np.argsort(result.order, kind="stable"))


class Grouping(NamedTuple):
    """Observations of each point, from the lowest speed on, and how clearly points differ."""

    members: list[np.ndarray]
    verdict: str


def grouped_by_speed(seen: Observations, tolerance: float) -> Grouping:
    """Group observations by speed, using set speeds if all are known.

    Parameters
    ----------
    seen
        Observations of one or several runs.
    tolerance
        As for `tribolab.friction.points.speed_groups.speed_groups`.
    """
    if not seen.speed.size:
        return Grouping([], "clear")
    if np.isfinite(seen.set_speed).all() and (seen.set_speed > 0).all():
        group = speed_groups(seen.set_speed, 1e-3).group
        verdict = "stated"
    else:
        sweeps = sweeps_of(seen.run, seen.order, seen.speed)
        group, verdict = speed_groups(seen.speed, tolerance, sweeps)
    order = np.argsort(group, kind="stable")
    cuts = np.flatnonzero(np.diff(group[order])) + 1
    members = [np.sort(part) for part in np.split(order, cuts)]
    middle = [float(np.log(seen.speed[part]).mean()) for part in members]
    return Grouping([members[k] for k in np.argsort(middle, kind="stable")], verdict)


def means_of_run(seen: Observations, members: Sequence[np.ndarray]) -> list[Mean]:
    """Return the mean of one run at each of its speeds.

    Parameters
    ----------
    seen
        Observations of the run.
    members
        Indices of the observations at each speed, in their order along the run.

    Notes
    -----
    The scatter of a few strokes is known better from the strokes at all other speeds. Many
    successive strokes at one speed need not be independent: their mean has the error of a series.
    An error that all strokes share does not decrease in their mean.
    """
    values = [seen.mean[part] for part in members]
    means = []
    for number, part in enumerate(members):
        own = values[number]
        if own.size == 1:
            means.append(Mean(float(own[0]), float(seen.sem[part[0]]), float(seen.u95[part[0]])))
            continue
        shared = float(np.sqrt(np.mean(seen.shared[part] ** 2)))
        errors = np.sqrt(np.maximum(seen.sem[part] ** 2 - seen.shared[part] ** 2, 0.0))
        if own.size < limits.MIN_STROKES_OF_MEMORY.value:
            others = pooled_scatter(values[:number] + values[number + 1 :])
            mean = mean_of_repeats(own, errors, others)
        else:
            mean = _series_mean(own, errors)
        sem, u95 = np.hypot((mean.sem, mean.u95), (shared, NORMAL * shared))
        means.append(Mean(mean.mean, float(sem), float(u95)))
    return means


def _series_mean(values: np.ndarray, errors: np.ndarray) -> Mean:
    series = error_of_series(values[None])
    sem, dof = float(series.sem[0]), float(series.dof[0])
    wide = sem * coverage_of(dof)
    known = errors[np.isfinite(errors)]
    own = float(np.sqrt((known**2).sum()) / max(known.size, 1))
    if NORMAL * own > wide:  # strokes that agree better than their own errors do so by chance
        return Mean(float(values.mean()), own, NORMAL * own)
    return Mean(float(values.mean()), sem, wide)


def shared_error(friction: xr.Dataset) -> np.ndarray | None:
    """Return the error that all segments of a run share (segment), if it is known."""
    name = "friction_coefficient_shared_sem"
    return friction[name].values.astype(float) if name in friction else None


class RunMean(NamedTuple):
    """Mean of a run at one of its speeds [m/s], its U95, and its strokes."""

    speed: float
    mean: float
    sem: float
    u95: float
    strokes: np.ndarray


def run_means(
    speed: np.ndarray,
    value: np.ndarray,
    sem: np.ndarray,
    u95: np.ndarray,
    pairs: np.ndarray,
    tolerance: float = limits.SPEED_TOLERANCE.value,
    shared: np.ndarray | None = None,
) -> list[RunMean]:
    """Return the mean of a run at each of its speeds, as in the points of a curve.

    Parameters
    ----------
    speed, value, sem, u95
        Columns of the strokes in temporal order; the value in any unit, the speed in m/s (stroke).
    pairs
        The same number for the two strokes of a pair, below 0 for a stroke without a partner
        (stroke).
    tolerance
        Largest relative difference of the speeds of one point.
    shared
        Part of `sem` that all strokes have in common (stroke); none if not given.

    Examples
    --------
    >>> speed, value = np.array([1.0, 1.0, 2.0, 2.0]), np.array([0.3, 0.32, 0.5, 0.5])
    >>> found = run_means(speed, value, np.full(4, 0.01), np.full(4, 0.02), np.array([0, 0, 1, 1]))
    >>> [(mean.speed, round(mean.mean, 2), mean.u95, mean.strokes.tolist()) for mean in found]
    [(1.0, 0.31, 0.02, [0, 1]), (2.0, 0.5, 0.02, [2, 3])]
    """
    known = np.isfinite(value) & (speed > 0)
    blank = np.full(value.size, np.nan)
    common = blank if shared is None else shared
    seen = grouped_strokes(0, speed, blank, value, sem, u95, common, blank, pairs, known)
    members = grouped_by_speed(seen, tolerance).members
    place = np.flatnonzero(known)
    key = np.where(pairs >= 0, pairs, -1.0 - np.arange(value.size))[place]
    _, which = np.unique(key, return_inverse=True)
    order = np.bincount(which, place.astype(float)) / np.bincount(which)
    rank = np.empty(order.size, int)
    rank[np.argsort(order, kind="stable")] = np.arange(order.size)
    of_observation = rank[which]
    return [
        RunMean(
            float(np.exp(np.log(seen.speed[part]).mean())),
            *mean,
            strokes=place[np.isin(of_observation, part)],
        )
        for part, mean in zip(members, means_of_run(seen, members), strict=True)
    ]
