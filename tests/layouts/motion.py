"""What a machine on one clock does: legs of constant speed and rests, or a crank."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

_RELOADING = 0.4  # share of a rest in which the load changes


class Leg(NamedTuple):
    """Slide at a speed [m/s, signed] for a time [s] under a share of the load; 0 is a rest."""

    speed: float
    duration: float
    load: float = 1.0


@dataclass(frozen=True)
class MachineMotion:
    """Where a machine is and how it is loaded, sample by sample.

    Parameters
    ----------
    time, velocity, acceleration, position
        [s], [m/s], [m/s2], [m] (time).
    load
        Share of the set load (time).
    leg
        Number of the leg, from 1 (time).
    start, stop, speed
        Stretches of constant speed under load: [s], [s], [m/s, signed] (stretch).
    """

    time: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    position: np.ndarray
    load: np.ndarray
    leg: np.ndarray
    start: np.ndarray
    stop: np.ndarray
    speed: np.ndarray


def carried_out(legs: Sequence[Leg], rate: float, ramp: float = 0.1) -> MachineMotion:
    """Carry out legs one after the other.

    Parameters
    ----------
    legs
        What is done.
    rate
        Samples per second [Hz].
    ramp
        Time in which the velocity changes linearly from leg to leg [s].

    Examples
    --------
    >>> motion = carried_out([Leg(0.0, 1.0), Leg(1e-3, 2.0), Leg(-1e-3, 2.0)], rate=100.0)
    >>> motion.speed.tolist(), motion.start.round(6).tolist()
    ([0.001, -0.001], [1.2, 3.3])
    """
    durations = np.array([leg.duration for leg in legs])
    speeds = np.array([leg.speed for leg in legs])
    loads = np.array([leg.load for leg in legs])
    stop = np.cumsum(durations + ramp)
    start = stop - durations
    knots = np.column_stack([start, stop]).ravel()
    knots = np.concatenate([[0.0], knots])
    at_knots = np.concatenate([[0.0], np.repeat(speeds, 2)])
    time = np.arange(int(np.floor(stop[-1] * rate))) / rate
    slope = np.diff(at_knots) / np.diff(knots)
    travel = 0.5 * (at_knots[1:] + at_knots[:-1]) * np.diff(knots)
    place = np.concatenate([[0.0], np.cumsum(travel)])
    k = np.clip(np.searchsorted(knots, time, side="right") - 1, 0, slope.size - 1)
    passed = time - knots[k]
    changes = np.column_stack([start, start + _RELOADING * durations]).ravel()
    shares = np.column_stack([np.concatenate([loads[:1], loads[:-1]]), loads]).ravel()
    slides = (speeds != 0) & (loads > 0)
    return MachineMotion(
        time=time,
        velocity=at_knots[k] + slope[k] * passed,
        acceleration=slope[k],
        position=place[k] + (at_knots[k] + 0.5 * slope[k] * passed) * passed,
        load=np.interp(time, changes, shares),
        leg=np.searchsorted(stop, time, side="right") + 1,
        start=start[slides],
        stop=stop[slides],
        speed=speeds[slides],
    )


def crank(stroke: float, frequency: float, cycles: int, rate: float) -> MachineMotion:
    """Go to and fro as a crank does, from one end of the stroke.

    Parameters
    ----------
    stroke
        From end to end [m].
    frequency
        Cycles per second [Hz].
    cycles
        How many.
    rate
        Samples per second [Hz].

    Examples
    --------
    >>> motion = crank(10e-3, 2.0, 3, rate=200.0)
    >>> float(np.ptp(motion.position).round(6)), float(motion.velocity.max().round(6))
    (0.01, 0.062832)
    """
    time = np.arange(int(cycles / frequency * rate)) / rate
    turned = 2 * np.pi * frequency * time
    pace = np.pi * frequency * stroke
    return MachineMotion(
        time=time,
        velocity=pace * np.sin(turned),
        acceleration=2 * np.pi * frequency * pace * np.cos(turned),
        position=-0.5 * stroke * np.cos(turned),
        load=np.ones(time.size),
        leg=(turned // np.pi).astype(int) + 1,
        start=np.empty(0),
        stop=np.empty(0),
        speed=np.empty(0),
    )
