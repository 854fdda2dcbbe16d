"""Strokes of a reciprocating slider, for any form of motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.core.errors import AnalysisError, Cure
from tribolab.friction.segments import limits
from tribolab.friction.segments.stretches import finite, name_of
from tribolab.friction.segments.turns import EQUAL, last_side, turns_of


class Strokes(NamedTuple):
    """Whole strokes of a run in temporal order.

    Parameters
    ----------
    first
        Index of the first sample of each stroke, and of the sample after the last (stroke + 1).
    way
        Direction, +1 or -1 (stroke).
    length
        Distance between the turns [m] (stroke).
    place
        Share of the stroke covered at each sample (time); NaN outside of whole strokes.
    usual
        Whether a stroke has the usual length, and is not a small motion at a turn (stroke).
    paused
        Whether a long part of a stroke was not recorded; it may be parts of two (stroke).
    """

    first: np.ndarray
    way: np.ndarray
    length: np.ndarray
    place: np.ndarray
    usual: np.ndarray
    paused: np.ndarray

    @property
    def number(self) -> np.ndarray:
        """Index of the stroke that each sample belongs to (time); -1 for none."""
        size = self.place.size
        index = np.searchsorted(self.first, np.arange(size), side="right") - 1
        return np.where((index >= 0) & (index < self.way.size), index, -1)


def find_strokes(run: xr.Dataset) -> Strokes:
    """Find the strokes of a reciprocating run.

    Parameters
    ----------
    run
        With ``position`` or ``sliding_velocity`` (time).

    Returns
    -------
    Strokes
        Each extends from one turn to the next. A position turns if it returns by a quarter of its
        range; a velocity, if its sign changes at more than a fifth of its usual magnitude.

    Raises
    ------
    AnalysisError
        If the run has neither, or fewer than three whole strokes.
    """
    if "position" in run and np.isfinite(run["position"].values).any():
        first, way, place, length = _by_position(run)
    elif "sliding_velocity" in run and np.isfinite(run["sliding_velocity"].values).any():
        first, way, place, length = _by_velocity(run)
    else:
        raise AnalysisError(
            "strokes are found from the position or the signed velocity, and the run has neither",
            where=name_of(run),
        )
    if way.size < limits.MIN_WHOLE_STROKES.value:
        raise AnalysisError(
            f"the slider does not reverse: {way.size} whole strokes, "
            f"{limits.MIN_WHOLE_STROKES.value} are needed",
            where=name_of(run),
            cure=Cure(
                notebook="for plateaus of constant speed use find_segments without stroke_middle",
                campaign="leave out stroke_middle, or give it to the runs of a crank alone: "
                "segments.stroke_middle = 0.5 in their [[run]]",
            ),
        )
    paused = _paused(run["time"].values, first)
    return Strokes(first, way, length, place, _usual(run, first, length) & ~paused, paused)


def shuttles(run: xr.Dataset) -> bool:
    """Return whether a run consists of equal strokes whose friction reverses with direction.

    Driven by a crank or a shaker, such a run has no plateau of constant speed.

    Parameters
    ----------
    run
        With ``position`` and a friction signal (time).
    """
    names = [name for name in ("friction_force", "friction_coefficient") if name in run]
    if "position" not in run or not names or not np.isfinite(run["position"].values).any():
        return False
    try:
        strokes = find_strokes(run)
    except AnalysisError:
        return False
    usual = strokes.usual
    lasted = np.diff(run["time"].values[strokes.first])[usual]
    if lasted.size < max(
        limits.MIN_EQUAL_STROKES.value, (1 - limits.MAX_UNEQUAL_STROKES.value) * usual.size
    ):
        return False
    unlike = np.abs(np.diff(np.log(lasted))) > limits.MAX_CHANGE_OF_DURATION.value
    if (
        unlike.mean() > limits.MAX_UNEQUAL_STROKES.value
        or median(np.diff(strokes.first)) < limits.MIN_SAMPLES_OF_STROKE.value
    ):
        return False
    return _friction_reverses(strokes, run[names[0]].values)


def _friction_reverses(strokes: Strokes, friction: np.ndarray) -> bool:
    """Return whether friction differs clearly between the two directions."""
    number = strokes.number
    inside = (number >= 0) & (np.abs(strokes.place - 0.5) < 0.25) & np.isfinite(friction)
    count = np.bincount(number[inside], minlength=strokes.way.size)
    total = np.bincount(number[inside], friction[inside], minlength=strokes.way.size)
    known = strokes.usual & (count > 0)
    mean = total[known] / count[known]
    ways = [mean[strokes.way[known] == way] for way in (1, -1)]
    if min(own.size for own in ways) < 2:
        return False
    error = np.sqrt(sum(own.var(ddof=1) / own.size for own in ways))
    return bool(abs(ways[0].mean() - ways[1].mean()) > limits.MIN_ERRORS_BETWEEN_WAYS.value * error)


def _paused(time: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Return a mask of strokes that lack samples for a quarter of their duration (stroke)."""
    pause = np.diff(time[first[0] : first[-1] + 1])
    longest = np.maximum.reduceat(pause, first[:-1] - first[0])
    return longest > np.maximum(
        limits.MIN_INTERVALS_OF_PAUSE.value * median(pause),
        limits.MIN_PAUSE_OF_STROKE.value * np.diff(time[first]),
    )


def _crank_steps(run: xr.Dataset) -> np.ndarray | None:
    """Return each sample's step number if the crank's stroke differs between steps; else None."""
    if "stroke_m_of_steps" not in run.attrs or "step" not in run:
        return None
    return np.asarray(run["step"].values)


def _usual(run: xr.Dataset, first: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Return a mask of strokes within one step and not much shorter than its median (stroke)."""
    step = _crank_steps(run)
    if step is None:
        return length > limits.MIN_LENGTH_OF_STROKE.value * median(length)
    own = step[first[:-1]]
    usual = np.zeros(length.size, dtype=bool)
    for each in np.unique(own):
        usual[own == each] = length[own == each] > limits.MIN_LENGTH_OF_STROKE.value * median(
            length[own == each]
        )
    return usual & (own == step[first[1:] - 1])


_Parts = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def _fill_gaps(run: xr.Dataset, name: str) -> np.ndarray:
    """Return a signal with its gaps bridged by straight lines."""
    time, values = finite(run, name)
    if time.size == run.sizes["time"]:
        return values
    return np.interp(run["time"].values, time, values)


def _by_position(run: xr.Dataset) -> _Parts:
    position = _fill_gaps(run, "position")
    turn, way = turns_of(position)
    if not way.size:
        return _nothing(position.size)
    length = np.abs(np.diff(position[turn]))
    place = np.full(position.size, np.nan)
    samples = np.arange(turn[0], turn[-1])
    number = np.repeat(np.arange(way.size), np.diff(turn))
    gone = (position[samples] - position[turn[number]]) * way[number]
    place[samples] = gone / length[number]
    return turn, way, place, length


def _by_velocity(run: xr.Dataset) -> _Parts:
    time, velocity = run["time"].values, _fill_gaps(run, "sliding_velocity")
    limit = _limit(run, velocity)
    state = last_side(velocity, -limit, limit)
    change = np.flatnonzero(np.diff(state)) + 1
    change = change[state[change - 1] != 0]
    if change.size < 2:
        return _nothing(velocity.size)
    # the turn is where the velocity last had its previous sign
    sign = np.where(np.abs(velocity) > EQUAL * limit, np.sign(velocity), 0.0)
    same = np.flatnonzero(sign[:-1] * sign[1:] <= 0) + 1
    turn = np.unique(same[np.clip(np.searchsorted(same, change, side="right") - 1, 0, None)])
    way = np.sign(state[np.minimum(turn[1:] - 1, state.size - 1)]).astype(int)
    steps = np.diff(time) * (velocity[1:] + velocity[:-1]) / 2
    path = np.concatenate([[0.0], np.cumsum(steps)])
    length = np.abs(np.diff(path[turn]))
    place = np.full(velocity.size, np.nan)
    samples = np.arange(turn[0], turn[-1])
    number = np.repeat(np.arange(way.size), np.diff(turn))
    gone = np.abs(path[samples] - path[turn[number]])
    place[samples] = gone / np.where(length[number] > 0, length[number], np.inf)
    return turn, way, place, length


def _limit(run: xr.Dataset, velocity: np.ndarray) -> float | np.ndarray:
    """Return the speed below which a sample's direction counts as unknown [m/s]."""
    step = _crank_steps(run)
    if step is None:
        return limits.MIN_SPEED_OF_STROKE.value * float(np.percentile(np.abs(velocity), 90))
    limit = np.zeros(velocity.size)
    for each in np.unique(step):
        limit[step == each] = limits.MIN_SPEED_OF_STROKE.value * np.percentile(
            np.abs(velocity[step == each]), 90
        )
    return limit


def _nothing(size: int) -> _Parts:
    none = np.empty(0, dtype=int)
    return none, none, np.full(size, np.nan), np.empty(0)


def middle_parts(
    run: xr.Dataset, share: float
) -> tuple[Strokes, np.ndarray, np.ndarray, np.ndarray]:
    """Return the strokes of a run, and start and end times of the middle part of each.

    Parameters
    ----------
    run
        As for `find_strokes`.
    share
        Share of the length of each stroke, around its middle.

    Returns
    -------
    tuple
        The strokes; time of the first and of the last sample of each middle part [s] (stroke), NaN
        without samples; and the number of its samples (stroke).
    """
    strokes = find_strokes(run)
    inside = np.flatnonzero(np.abs(strokes.place - 0.5) <= share / 2)
    number = strokes.number[inside]
    each = np.arange(strokes.way.size)
    first = np.searchsorted(number, each, side="left")
    last = np.searchsorted(number, each, side="right") - 1
    count = last - first + 1
    time = run["time"].values
    ends = [
        np.where(count > 0, time[inside[place.clip(0, max(inside.size - 1, 0))]], np.nan)
        for place in (first, last)
    ]
    return strokes, ends[0], ends[1], count
