"""True friction and normal force during a run, before the sensors add errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from tribolab.rig.laws import StickSlip
from tribolab.rig.noise import slow_noise
from tribolab.rig.parameters import Protocol, Scatter
from tribolab.rig.schedule import Schedule
from tribolab.rig.waves import WAVES

_TRIM = 0.10  # share of a segment that the paper removes at each end (App. C)
_FINE = 20_000  # points per segment at which true means are computed


@dataclass(frozen=True)
class StrokeFriction:
    """True friction coefficient along one stroke, as a function of distance from its start.

    Parameters
    ----------
    level
        Friction coefficient in steady sliding.
    length
        Length of the stroke [m].
    ripple
        Function from distance [m] to stick-slip and fluctuation, which are added to the level.
    left
        Friction left from the stroke before, positive if it acts against the new motion.
    """

    level: float
    length: float
    ripple: Callable[[np.ndarray], np.ndarray]
    left: float
    protocol: Protocol

    def __call__(self, distance: np.ndarray) -> np.ndarray:
        """Return the friction coefficient at distances [m] from the start of the stroke."""
        steady = self.level + self.ripple(distance)
        built = 1 - (1 - np.clip(distance / self.protocol.build_up, 0, 1)) ** 3
        part = np.clip(distance / self.protocol.run_in, 0, 1)
        peak = 27 / 4 * part * (1 - part) ** 2  # 1 at a third of the run-in, 0 at its end
        run_in = self.level * self.protocol.overshoot * peak
        return self.left + (steady - self.left) * built + run_in


@dataclass(frozen=True)
class Signals:
    """True friction and normal force of a run, as functions of time on the force clock [s].

    Parameters
    ----------
    schedule
        Motion and load.
    strokes
        Friction along each stroke.
    normal_force
        Set load [N].
    load_error
        Function from time [s] to the relative error of the load.
    truth
        Table of true values, one row per segment of constant speed.
    """

    schedule: Schedule
    strokes: tuple[StrokeFriction, ...]
    normal_force: float
    load_error: Callable[[np.ndarray], np.ndarray]
    truth: pd.DataFrame
    protocol: Protocol

    def force_normal(self, time: np.ndarray) -> np.ndarray:
        """Return the normal force [N] at given times [s]; zero without load."""
        return self.normal_force * self.schedule.load(time) * (1 + self.load_error(time))

    def friction(self, time: np.ndarray) -> np.ndarray:
        """Return the friction coefficient at times [s], positive while the table moves to +x."""
        p, plan = self.protocol, self.schedule
        phase = plan.phase(time)
        stroke, moving = plan.stroke[phase], plan.sliding[phase] >= 0
        position, _ = plan.motion(time)
        friction = np.zeros(time.shape)
        first = np.flatnonzero(np.diff(plan.stroke, prepend=-1))  # first phase of each stroke
        for k, law in enumerate(self.strokes):
            direction = 1 if k % 2 == 0 else -1
            ran = np.flatnonzero((stroke == k) & moving)
            distance = np.abs(position[ran] - plan.position[first[k]])
            friction[ran] = direction * law(distance)
            stopped = plan.start[first[k] + 3]
            rests = np.flatnonzero((stroke == k) & ~moving)
            last = direction * float(law(np.array([law.length]))[0])
            friction[rests] = last * _relaxed_share(p, time[rests] - stopped)
        return friction


def _relaxed_share(protocol: Protocol, time: np.ndarray | float) -> np.ndarray:
    """Return the share of the friction force that remains after a time at rest [s]."""
    left = np.exp(-np.asarray(time) / protocol.relaxation_time)
    return protocol.relaxed_part + (1 - protocol.relaxed_part) * left


def make_signals(
    schedule: Schedule,
    protocol: Protocol,
    scatter: Scatter,
    law: Callable[[np.ndarray], np.ndarray],
    slip: StickSlip,
    normal_force: float,
    factor: float,
    rng: np.random.Generator,
) -> Signals:
    """Return the true signals of one run, with random variations of friction and load.

    Parameters
    ----------
    schedule, protocol, scatter
        Phases of the run, its protocol, and its random variations.
    law, slip
        Friction coefficient at speeds [m/s], and stick-slip.
    normal_force
        Normal force [N].
    factor
        Friction of this run relative to the law.
    rng
        Generator.

    Returns
    -------
    Signals
        Its `truth` states for each segment the friction of the law (times `factor`), and the mean
        true friction after trimming by 10 %, which also contains stick-slip and fluctuation.
    """
    slide = np.flatnonzero(schedule.sliding == 1)
    strokes: list[StrokeFriction] = []
    rows = []
    left = 0.0  # signed friction coefficient that is left after the rest before a stroke
    for k, phase in enumerate(slide):
        direction, speed = 1 if k % 2 == 0 else -1, float(schedule.set_speed[phase])
        duration, ramp = float(schedule.duration[phase]), float(schedule.duration[phase - 1])
        level = factor * float(law(np.array([speed]))[0])
        length = speed * (duration + ramp)
        form, wavelength, drop = slip.at(speed)
        # distances from the start of the stroke, in its part with constant speed
        fine = 0.5 * speed * ramp + speed * duration * (np.arange(_FINE) + 0.5) / _FINE
        ripple = _ripple(form, length, wavelength, drop * level, level, scatter, fine, rng)
        stroke = StrokeFriction(level, length, ripple, left=left * direction, protocol=protocol)
        strokes.append(stroke)
        last = direction * float(stroke(np.array([length]))[0])
        left = last * float(_relaxed_share(protocol, protocol.rest))
        cut = int(_TRIM * _FINE)
        rows.append(
            {
                "segment": k,
                "start_s": schedule.start[phase],
                "stop_s": schedule.start[phase] + duration,
                "sliding_speed_m_s": speed,
                "direction": direction,
                "friction_coefficient": level,
                "friction_coefficient_trimmed_mean": stroke(fine[cut:-cut]).mean(),
                "stick_slip": form,
                "stick_slip_wavelength_m": wavelength,
                "stick_slip_drop": drop * level,
            }
        )
    load_noise = slow_noise(rng, schedule.end, scatter.load_control_time)
    return Signals(
        schedule,
        tuple(strokes),
        normal_force,
        lambda time: scatter.load_control * load_noise(time),
        pd.DataFrame(rows),
        protocol,
    )


def _ripple(
    form: str,
    length: float,
    wavelength: float,
    drop: float,
    level: float,
    scatter: Scatter,
    fine: np.ndarray,
    rng: np.random.Generator,
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the ripple of a stroke: stick-slip with zero mean, plus random fluctuation."""
    noise = slow_noise(rng, length, scatter.fluctuation_length * length)
    wave = WAVES[form](rng, length, wavelength, drop) if form != "none" else None

    mean = float(wave(fine).mean()) if wave else 0.0

    def ripple(distance: np.ndarray) -> np.ndarray:
        value = level * scatter.fluctuation * noise(distance)
        return value + wave(distance) - mean if wave else value

    return ripple
