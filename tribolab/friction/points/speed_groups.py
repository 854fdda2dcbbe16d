"""Grouping of measured speeds that had the same set-point."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from tribolab.friction.points import limits

Verdict = Literal["clear", "fair", "unclear"]


class SpeedGroups(NamedTuple):
    """Group number of each speed, from the slowest on, and how clearly the groups differ."""

    group: np.ndarray
    verdict: Verdict


def speed_groups(
    speed: np.ndarray,
    tolerance: float = limits.SPEED_TOLERANCE.value,
    apart: np.ndarray | None = None,
) -> SpeedGroups:
    """Group speeds with the same set-point.

    Parameters
    ----------
    speed
        Positive speeds [m/s] in any order (observation).
    tolerance
        Largest relative difference within a group [1].
    apart
        Number of the sweep that each speed belongs to, -1 for none: speeds of one sweep are never
        combined (observation).

    Notes
    -----
    Gaps between neighbouring logarithms of speed are small within groups and large between them.
    The gaps are sorted, and the threshold is put at the widest relative jump between two of them,
    unless a group would be wider than the tolerance, or gaps between groups narrower than half a
    group. If no jump is wide enough, groups are formed by complete linkage up to the tolerance, and
    the verdict is "unclear".

    Examples
    --------
    >>> speed_groups(np.array([1.0, 2.0, 1.02, 2.01])).group.tolist()
    [0, 1, 0, 1]
    >>> len(set(speed_groups(np.geomspace(1e-6, 1e-2, 98)).group.tolist()))
    98
    """
    if speed.size == 0:
        return SpeedGroups(np.zeros(0, int), "clear")
    order = np.argsort(speed, kind="stable")
    x = np.log(speed[order])
    most = float(np.log1p(tolerance))
    labels, verdict = _group_by_jump(x, most)
    if apart is not None and (apart >= 0).any():
        labels = _separate_sweeps(labels, apart[order])
    group = np.empty(speed.size, int)
    group[order] = labels
    return SpeedGroups(group, verdict)


def _group_by_jump(x: np.ndarray, most: float) -> tuple[np.ndarray, Verdict]:
    """Return the group number of each sorted ln(speed), and how clearly the groups differ."""
    n, floor = x.size, limits.SPEED_FLOOR.value
    if n == 1:
        return np.zeros(1, int), "clear"
    gaps = np.maximum(np.diff(x), floor)
    steps = np.unique(gaps)
    # each gap up to the tolerance is a trial threshold; its jump is the ratio to the next wider gap
    within = steps[steps <= most]
    wider = np.append(steps[1:], np.nan)[: within.size]
    jumps = np.where(np.isnan(wider), 1.2 * most / np.maximum(within, 1e-300), wider / within)
    thresholds = [(0.0, steps[0] / floor if steps[0] > floor else 0.0)]
    thresholds += zip(within.tolist(), jumps.tolist(), strict=True)
    best, labels = -1.0, np.arange(n)
    for threshold, jump in thresholds:
        if jump <= best:
            continue
        own = np.arange(n)
        if threshold > 0:
            own = np.concatenate([[0], np.cumsum(gaps > threshold * (1 + 1e-9))])
        if _is_sound(x, own, most):
            best, labels = jump, own
    if best < limits.FAIR_JUMP.value:
        return _link_speeds(x, most), "unclear"
    return labels, "clear" if best >= limits.CLEAR_JUMP.value else "fair"


def _is_sound(x: np.ndarray, labels: np.ndarray, most: float) -> bool:
    first = np.searchsorted(labels, np.arange(labels[-1] + 1))
    last = np.append(first[1:], x.size) - 1
    width = x[last] - x[first]
    if width.max() > most * (1 + 1e-9):
        return False
    gap = x[first[1:]] - x[last[:-1]]
    wider = np.maximum(width[1:], width[:-1])
    narrow = gap < limits.NARROW_GAP.value * wider
    return not gap.size or bool(narrow.mean() <= limits.NARROW_GAPS.value)


def _link_speeds(x: np.ndarray, most: float) -> np.ndarray:
    """Return group numbers by complete linkage, after speeds closer than the floor are combined."""
    cells, which = np.unique(np.floor(x / limits.SPEED_FLOOR.value), return_inverse=True)
    middle = np.bincount(which, x) / np.bincount(which)
    if cells.size < 2:
        return np.zeros(x.size, int)
    # imported late: scipy.cluster loads slowly, and clear groups need none of it
    from scipy.cluster.hierarchy import fcluster, linkage

    reach = max(most - limits.SPEED_FLOOR.value, 0.0)  # minus the width of a cell
    found = fcluster(linkage(middle[:, None], "complete"), reach, "distance")[which]
    return np.concatenate([[0], np.cumsum(np.diff(found) != 0)])


def _separate_sweeps(labels: np.ndarray, sweep: np.ndarray) -> np.ndarray:
    """Return labels with a new group wherever two speeds of a sweep would share one."""
    result, seen, number = np.empty(labels.size, int), set[int](), -1
    last = -1
    for place, (label, own) in enumerate(zip(labels.tolist(), sweep.tolist(), strict=True)):
        if label != last or own in seen:
            number, seen, last = number + 1, set(), label
        if own >= 0:
            seen.add(own)
        result[place] = number
    return result


def sweeps_of(run: np.ndarray, order: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Return the run of each observation if that run's speed only rises or only falls.

    Parameters
    ----------
    run, order
        Number of the run, and position in it (observation).
    speed
        Speeds [m/s] (observation).

    Returns
    -------
    numpy.ndarray
        The run's number, -1 for runs whose speeds repeat or are fewer than six (observation).

    Examples
    --------
    >>> run, speed = np.zeros(6, int), np.array([1.0, 1.05, 1.1, 1.15, 1.2, 1.25])
    >>> sweeps_of(run, np.arange(6), speed).tolist()
    [0, 0, 0, 0, 0, 0]
    >>> sweeps_of(run, np.arange(6), speed[[0, 1, 0, 1, 0, 1]]).tolist()
    [-1, -1, -1, -1, -1, -1]
    """
    result = np.full(run.size, -1)
    for number in np.unique(run).tolist():
        own = np.flatnonzero(run == number)
        own = own[np.argsort(order[own], kind="stable")]
        steps = np.diff(np.log(speed[own]))
        one_way = bool((steps > 0).all() or (steps < 0).all())
        far = bool((np.abs(steps) > limits.SPEED_FLOOR.value).all())
        if steps.size >= limits.SWEEP_STEPS.value and one_way and far:
            result[own] = number
    return result
