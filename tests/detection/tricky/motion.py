"""What the stage does: legs of constant speed, rests and shapes become a velocity over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Shape = Callable[[np.ndarray], np.ndarray]  # velocity over the share of the leg that has passed


@dataclass(frozen=True)
class Leg:
    """A part of the programme: `speed` [m/s, signed] for `duration` [s] under `load` (share).

    With a `shape` the velocity is speed * shape(u), u from 0 to 1, and no speed is constant.
    """

    speed: float
    duration: float
    load: float = 1.0
    shape: Shape | None = None


@dataclass(frozen=True)
class Motion:
    """Velocity [m/s], acceleration [m/s2], position [m] and load (share) over time [s].

    `start`, `stop`, `speed`: the plateaus that slide under load, on the same clock.
    """

    time: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    position: np.ndarray
    load: np.ndarray
    start: np.ndarray
    stop: np.ndarray
    speed: np.ndarray
    leg_ends: np.ndarray

    @property
    def rate(self) -> float:
        """Samples per second."""
        return 1.0 / float(self.time[1] - self.time[0])


def rest(duration: float, load: float = 1.0) -> Leg:
    """Stand still."""
    return Leg(0.0, duration, load)


def strokes(
    speeds: Sequence[float], duration: float, pause: float = 0.0, ways: Sequence[int] = (1, -1)
) -> list[Leg]:
    """Slide at each speed in each of the ways, with a pause after each stroke."""
    legs = []
    for speed in speeds:
        for way in ways:
            legs.append(Leg(way * speed, duration))
            if pause:
                legs.append(rest(pause))
    return legs


def shaped(speed: float, duration: float, shape: Shape) -> Leg:
    """Slide with a velocity that changes all the time."""
    return Leg(speed, duration, shape=shape)


def run_programme(legs: Sequence[Leg], rate: float, ramp: float = 0.05) -> Motion:
    """Carry out the legs; between two speeds the velocity changes linearly within `ramp` [s]."""
    knots_t, knots_v, load_t, load_n = [0.0], [0.0], [0.0], [legs[0].load]
    plateaus, ends, now, share = [], [], 0.0, legs[0].load
    for leg in legs:
        begin = now
        if leg.shape is None:
            now += ramp
            knots_t += [now, now + leg.duration]
            knots_v += [leg.speed, leg.speed]
            if leg.speed and leg.load > 0.5:
                plateaus.append((now, now + leg.duration, leg.speed))
            now += leg.duration
        else:
            u = np.linspace(0.0, 1.0, 400)
            knots_t += list(now + ramp + u * leg.duration)
            knots_v += list(leg.speed * leg.shape(u))
            now += ramp + leg.duration
        if leg.load != share:  # within the first fifth of a rest
            load_t += [begin + 0.1 * leg.duration, begin + 0.3 * leg.duration]
            load_n += [share, leg.load]
            share = leg.load
        ends.append(now)
    load_t.append(now + 1.0)
    load_n.append(share)
    time = np.arange(int(now * rate)) / rate
    velocity = np.interp(time, knots_t, knots_v)
    fine = np.gradient(velocity, time)
    position = np.concatenate([[0.0], np.cumsum(0.5 * (velocity[1:] + velocity[:-1])) / rate])
    start, stop, speed = np.array(plateaus).reshape(-1, 3).T
    load = np.interp(time, load_t, load_n)
    return Motion(time, velocity, fine, position, load, start, stop, speed, np.array(ends))
