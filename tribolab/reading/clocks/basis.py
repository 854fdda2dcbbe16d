"""Basis functions of the friction force, computed from a motion log, for a linear fit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from tribolab.arrays.medians import median
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.motion import Motion, integral

Ways = Array | NDArray[np.int64]  # -1 backward, 0 at rest, 1 forward

_STOP_LENGTHS = 9  # number of stop lengths
_SHORTEST_STOP = 1e-4  # shortest stop length, as share of the longest stroke
_MAX_STOP = 0.3
_SPEED_FUNCTIONS = 6  # most hat functions of the speed in one model
_RELAXATION_TIMES = (0.1, 0.5, 3.0)  # relaxation times of the force, as multiples of the usual rest
_RECOVERY_LENGTHS = (1e-4, 3e-3)  # recovery lengths after a rest, as share of the longest stroke
_ROUNDING_OF_SPEED = 1e-6  # largest rounding error of zero speed, as share of the fastest speed
_MAX_ROWS = 300_000  # most rows used of a motion log
SLACK_LENGTHS = (0.003, 0.01, 0.03)  # slack, as shares of the longest stroke


class Basis:
    """Basis functions of the force, on the motion log's clock."""

    def __init__(self, time: Array, motion: Motion):
        self.time, self.averaged, self._motion = time, motion.averaged, motion
        way = motion.way
        change = np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way) - 1]])
        self._path = integral(time, motion.velocity)
        strokes = np.abs(np.diff(self._path[change]))
        self.longest = float(strokes.max())
        self.shortest = float(strokes[strokes > 0.01 * self.longest].min())
        # slow strokes are ignored: their start is imprecise and their friction different
        speed = np.abs(motion.velocity)
        fastest = np.maximum.reduceat(speed, change[:-1])
        fast = fastest > limits.MIN_SPEED_OF_STROKE.value * np.percentile(speed, 99.5)
        moving = fast & (way[change[:-1]] != 0)
        lasted = np.diff(time[change])[moving]
        self.stroke = float(
            lasted[lasted > limits.MIN_DURATION_OF_STROKE.value * lasted.max()].min()
        )
        seen = fast[1:] | fast[:-1]
        self.events = change[1:-1][seen]
        self.begins = self.events[way[self.events] != 0]
        halfway = 0.5 * (time[change[1:]] + time[change[:-1]])
        self.around = np.stack([halfway[:-1], halfway[1:]], axis=1)[seen]
        self._kept = _kept(len(time), self.events)
        self.rows = time[self._kept]

    @cached_property
    def models(self) -> list[tuple[str, Array]]:
        """Name and basis functions (function, row) of each model: with slack, or leading force."""
        table, models = Play(self._path), []
        for slack in (0.0, *SLACK_LENGTHS):
            driven = table.followed(0.5 * min(slack * self.longest, limits.MAX_SLACK.value))
            velocity = np.gradient(driven, self.time) if slack else self._motion.velocity
            models.append((f"slack {slack:g}", self._following_functions(velocity, driven)))
        models.append(("before", self._leading_functions(*self._motion[:2], self._path)))
        return models

    def _following_functions(self, velocity: Array, path: Array) -> Array:
        """Return the basis functions of a force that follows the motion."""
        lengths = self.longest * np.geomspace(_SHORTEST_STOP, _MAX_STOP, _STOP_LENGTHS)
        moved = Play(path)
        stops = ((path - moved.followed(r)) / r for r in lengths)
        way = np.where(
            np.abs(velocity) > _ROUNDING_OF_SPEED * np.abs(velocity).max(), np.sign(velocity), 0.0
        )
        last = way[np.maximum.accumulate(np.where(way != 0, np.arange(len(way)), 0))]
        return self._table(chain([last], stops, self._speed_rest_and_inertia(velocity, way, last)))

    def _leading_functions(self, velocity: Array, way: NDArray[np.int64], path: Array) -> Array:
        """Return the basis functions of a force that rises before the log shows motion."""
        last = way[np.maximum.accumulate(np.where(way != 0, np.arange(len(way)), 0))]
        lengths = self.longest * np.geomspace(_SHORTEST_STOP, _MAX_STOP, _STOP_LENGTHS)
        ramps = (self._ramps(velocity, way, last, r) for r in lengths)
        stop = (path - Play(path).followed(lengths[-3])) / lengths[-3]
        return self._table(chain(ramps, [stop], self._speed_rest_and_inertia(velocity, way, last)))

    def _table(self, columns: Iterable[Array | Ways]) -> Array:
        """Stack columns, each scaled to a maximum of 1."""
        kept = (np.asarray(column[self._kept], float) for column in columns)
        return np.stack([k / max(k.max(), -k.min(), 1e-300) for k in kept])

    def _speed_rest_and_inertia(self, velocity: Array, way: Ways, last: Ways) -> Iterator[Array]:
        """Yield the functions of speed, relaxation at rest, and inertia."""
        yield from _speeds(velocity, last)
        yield from self._relaxed(velocity, way, last)
        yield np.gradient(velocity, self.time)

    def _relaxed(self, velocity: Array, way: Ways, last: Ways) -> Iterator[Array]:
        """Yield functions for the relaxation of the force at rest and its recovery by sliding."""
        stops = np.flatnonzero((way == 0) & (np.roll(way, 1) != 0))
        stops = stops[stops > 0]
        if not len(stops):
            return
        moved = integral(self.time, np.abs(velocity))
        ends = np.append(stops[1:], len(way))
        rested, slid = np.zeros(len(way)), np.full(len(way), np.inf)
        last_position = np.zeros(len(way))
        for first, end in zip(stops, ends, strict=True):
            part = slice(first, end)
            begun = np.flatnonzero(way[part])
            start = first + int(begun[0]) if len(begun) else end - 1
            rested[part] = np.minimum(self.time[part], self.time[start]) - self.time[first]
            slid[part] = moved[part] - moved[start - 1]
            slid[first:start] = 0.0
            last_position[part] = last[first]
        usual = float(median(rested[np.minimum(ends, len(way)) - 1]))
        if usual <= 0.0:  # no relaxation in rests of one sample
            return
        for tau in _RELAXATION_TIMES:
            for length in _RECOVERY_LENGTHS:
                back = np.exp(-slid / (self.longest * length))
                yield last_position * -np.expm1(-rested / (usual * tau)) * back

    def _ramps(
        self, velocity: Array, way: NDArray[np.int64], last: NDArray[np.int64], length: float
    ) -> Array:
        """Return the last direction of motion, which changes in a ramp before each start."""
        out = last.astype(float)
        starts = [k for k in self.events if way[k] != 0]
        for k, after in zip(starts, [*starts, len(way) - 1][1:], strict=True):
            turn = way[k] - (last[k - 1] if k else 0)
            speed = np.abs(velocity[k : min(k + 9, after + 1)]).max(initial=0.0)
            begin = self.time[k] - length / max(speed, 1e-300)
            before = slice(min(int(np.searchsorted(self.time, begin)), k), k)
            out[before] += turn * (1.0 + (self.time[before] - self.time[k]) * speed / length)
        return out


def _kept(count: int, events: NDArray[np.int64]) -> NDArray[np.int64] | slice:
    """Return the rows of a motion log to use: all near events, and a selection of the others."""
    if count <= _MAX_ROWS:
        return slice(None)
    near = _MAX_ROWS // (4 * max(len(events), 1))
    kept = np.zeros(count, dtype=bool)
    kept[:: -(-2 * count // _MAX_ROWS)] = True
    kept[-1] = True
    for event in events:
        kept[max(event - near, 0) : event + near] = True
    return np.flatnonzero(kept)


def _speeds(velocity: Array, last: Ways) -> Iterator[Array]:
    """Yield hat functions of log |v| times the direction; at rest the last value is held."""
    speed = np.abs(velocity)
    moving = speed > 0
    level = np.log10(speed[moving])
    high = float(np.percentile(level, 99))
    low = max(float(np.percentile(level, 5)), high - 4.0)
    if high - low < 0.1:
        return
    knots = np.linspace(low, high, min(_SPEED_FUNCTIONS, 2 + int(2 * (high - low))))
    index = np.maximum.accumulate(np.where(moving, np.arange(len(speed)), 0))
    log_speed = np.log10(np.maximum(speed, 10.0 ** (low - 1)))[index]
    for hat in np.eye(len(knots))[1:]:
        yield last * np.interp(log_speed, knots, hat)


class Play:
    """Play operator: the output follows a position within half the slack.

    >>> Play(np.array([0.0, 3.0, 1.0, -3.0])).followed(1.0).tolist()
    [0.0, 2.0, 2.0, -2.0]
    """

    def __init__(self, position: Array):
        self.position = position
        # a turning point still belongs to the stroke before it
        turns = np.flatnonzero(np.diff(np.sign(np.diff(position))) != 0) + 2
        self._first = np.concatenate([[0], turns])
        self._ends = position[np.append(turns, len(position)) - 1].tolist()

    def followed(self, half: float) -> Array:
        """Return the output position for a given half slack."""
        last, before = float(self.position[0]), []
        for end in self._ends:  # the turning points determine monotonic motion
            before.append(last)
            last = min(max(last, end - half), end + half)
        out = np.repeat(before, np.diff(self._first, append=len(self.position)))
        np.maximum(out, self.position - half, out=out)
        return np.minimum(out, self.position + half, out=out)
