"""What the sensors of a machine on one clock show, and what is true."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from layouts.motion import MachineMotion
from tribolab.rig.noise import slow_noise

_TRIM = 0.1  # of a stretch at either end: what the truth is the mean of
_SLOWEST = 1e-9  # [m/s]: friction laws have logarithms


@dataclass(frozen=True)
class Sensors:
    """How well forces are measured, in shares of the friction force or the load.

    Parameters
    ----------
    noise, normal_noise
        Standard deviation of white noise.
    offset, normal_offset
        Zero of the sensor.
    fluctuation, fluctuation_time
        The friction itself fluctuates: relative standard deviation and correlation time [s].
    """

    noise: float = 0.01
    normal_noise: float = 0.003
    offset: float = 0.05
    normal_offset: float = 0.01
    fluctuation: float = 0.004
    fluctuation_time: float = 0.05


@dataclass(frozen=True)
class MeasuredRecord:
    """Signals of a machine on one clock.

    Parameters
    ----------
    motion
        What it does.
    friction_force, normal_force
        As the sensors show them [N] (time).
    ratio
        True friction coefficient, with the sign of the velocity (time).
    friction_coefficient
        True mean of its size over each stretch of constant speed, trimmed (stretch).
    set_force, friction_zero
        Load, and what the friction sensor shows without friction [N].
    moving_mass
        Between contact and force sensor [kg].
    """

    motion: MachineMotion
    friction_force: np.ndarray
    normal_force: np.ndarray
    ratio: np.ndarray
    friction_coefficient: np.ndarray
    set_force: float
    friction_zero: float
    moving_mass: float

    def middle_friction_coefficient(self, share: float = 0.5) -> float:
        """Return the true mean over the middle part of all strokes of one length."""
        place = self.motion.position
        centre, length = float(place.max() + place.min()) / 2, float(np.ptp(place))
        inside = np.abs(place - centre) <= 0.5 * share * length
        return float(np.abs(self.ratio[inside]).mean())


def recorded(
    motion: MachineMotion,
    law: Callable[[np.ndarray], np.ndarray],
    normal_force: float,
    *,
    seed: int = 0,
    sensors: Sensors | None = None,
    moving_mass: float = 0.0,
    build_up: float = 1e-5,
) -> MeasuredRecord:
    """Measure a motion.

    Parameters
    ----------
    motion
        From `carried_out` or `crank`.
    law
        Friction coefficient over the sliding speed [m/s].
    normal_force
        Load [N].
    seed
        Of the noise.
    sensors
        How well is measured.
    moving_mass
        Mass between contact and sensor [kg]; its inertia adds to the force.
    build_up
        Distance in which friction turns over when the direction changes [m].

    Examples
    --------
    >>> from layouts.motion import Leg, carried_out
    >>> made = recorded(
    ...     carried_out([Leg(1e-3, 5.0)], 100.0), lambda speed: np.full(speed.shape, 0.3), 10.0
    ... )
    >>> made.friction_coefficient.round(2).tolist()
    [0.3]
    """
    sensors = sensors or Sensors()
    rng = np.random.default_rng(seed)
    time = motion.time
    wave = slow_noise(rng, float(time[-1]) + 1.0, sensors.fluctuation_time)(time)
    level = law(np.maximum(np.abs(motion.velocity), _SLOWEST)) * (1 + sensors.fluctuation * wave)
    ratio = level * _turned(motion, build_up)
    pressed = normal_force * motion.load
    scale = float(np.median(np.abs(ratio))) * normal_force
    noise = rng.standard_normal((2, time.size))
    friction = ratio * pressed + moving_mass * motion.acceleration
    friction = friction + scale * (sensors.offset + sensors.noise * noise[0])
    zero = sensors.normal_offset + sensors.normal_noise * noise[1]
    means = []
    for start, stop in zip(motion.start, motion.stop, strict=True):
        cut = _TRIM * (stop - start)
        inside = (time >= start + cut) & (time <= stop - cut)
        means.append(np.abs(ratio[inside].mean()))
    return MeasuredRecord(
        motion,
        friction,
        pressed + normal_force * zero,
        ratio,
        np.array(means),
        normal_force,
        scale * sensors.offset,
        moving_mass,
    )


def _turned(motion: MachineMotion, build_up: float) -> np.ndarray:
    """Return how far friction has turned into the direction of sliding, from -1 to 1.

    Along a way of one direction it goes there exponentially; the state at its start is what the
    way before it left.
    """
    way = np.sign(motion.velocity)
    moved = np.abs(np.diff(motion.position, prepend=motion.position[0]))
    gone = np.cumsum(moved)
    starts = np.flatnonzero(np.diff(way, prepend=np.nan) != 0).tolist()
    state, turned = 0.0, np.zeros(way.size)
    for start, stop in zip(starts, [*starts[1:], way.size], strict=True):
        if way[start]:
            left = np.exp(-(gone[start:stop] - gone[max(start - 1, 0)]) / build_up)
            turned[start:stop] = way[start] + (state - way[start]) * left
        else:
            turned[start:stop] = state
        state = float(turned[stop - 1])
    return turned
