"""Sampling of the true signals, with noise, offsets, drift, resolution and clock errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribolab.rig.calibration import Calibration
from tribolab.rig.noise import slow_noise, smooth_drift
from tribolab.rig.parameters import Clocks, Encoder, ForceCell, Loggers
from tribolab.rig.schedule import Schedule
from tribolab.rig.signals import Signals

TRUE = Calibration()  # force cell without calibration errors
_MAINS = 50.0  # mains frequency [Hz]
_TIME_STEP = 1e-5  # s, resolution of the time stamps


@dataclass(frozen=True)
class Errors:
    """Systematic errors of one run: zero offsets, clocks, and noise level of the velocity.

    Parameters
    ----------
    friction_force_offset, normal_force_offset
        Zero offsets of the force cell [N].
    clock_shift, clock_rate
        ``force time = motion time * (1 + clock_rate) + clock_shift`` [s].
    velocity_noise
        Relative noise of the velocity.
    """

    friction_force_offset: float
    normal_force_offset: float
    clock_shift: float
    clock_rate: float
    velocity_noise: float


def draw_errors(
    cell: ForceCell, encoder: Encoder, clocks: Clocks, rng: np.random.Generator
) -> Errors:
    """Return randomly drawn systematic errors for one run."""
    return Errors(
        friction_force_offset=float(rng.normal(0, cell.offset_friction)),
        normal_force_offset=float(rng.normal(0, cell.offset_normal)),
        clock_shift=float(rng.uniform(-clocks.largest_shift, clocks.largest_shift)),
        clock_rate=float(rng.uniform(-clocks.largest_rate, clocks.largest_rate)),
        velocity_noise=float(rng.uniform(*encoder.velocity_noise)),
    )


def sample_times(
    schedule: Schedule,
    rate: float,
    loggers: Loggers,
    rng: np.random.Generator,
    begin: float = 0.0,
    end: float = np.inf,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the sampling times of a logger on the force clock, and the interval after each [s].

    The rate increases with the set speed (`Loggers.exponent`). Each phase of the run has a whole
    number of samples, evenly spaced except for jitter. Times increase strictly.
    """
    speed = np.maximum(schedule.set_speed, 1e-6)
    wanted = schedule.duration * rate * (speed / 1e-6) ** loggers.exponent
    count = np.maximum(1, np.round(wanted)).astype(int)
    interval = np.repeat(schedule.duration / count, count)
    number = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    time = np.repeat(schedule.start, count) + number * interval
    # jitter relative to the shorter neighbouring interval, so that samples keep their order
    shorter = np.minimum(interval, np.concatenate([interval[:1], interval[:-1]]))
    jitter = np.clip(rng.standard_normal(time.size), -5, 5) * loggers.jitter
    time = np.round((time + jitter * shorter) / _TIME_STEP) * _TIME_STEP
    time[0] = 0.0
    keep = (time >= begin) & (time <= min(end, schedule.end))
    return time[keep], interval[keep]


def read_forces(
    signals: Signals,
    time: np.ndarray,
    interval: np.ndarray,
    cell: ForceCell,
    errors: Errors,
    rng: np.random.Generator,
    calibration: Calibration = TRUE,
) -> tuple[np.ndarray, np.ndarray]:
    """Return friction and normal force [N] as the force cell records them at given times [s].

    A logger averages over its sampling interval, so that a slow one hardly records mains hum.
    """
    end = signals.schedule.end
    normal = signals.force_normal(time)
    friction, normal = calibration.seen(signals.friction(time) * normal, normal)
    hum = cell.hum * np.sinc(_MAINS * interval) * np.sin(2 * np.pi * _MAINS * time)
    readings = []
    for true, offset, drift, hummed in (
        (friction, errors.friction_force_offset, cell.drift, hum),
        (normal, errors.normal_force_offset, cell.drift / 5, 0.5 * hum),
    ):
        reading = true + offset + hummed + drift * smooth_drift(rng, end)(time)
        reading += cell.flicker * slow_noise(rng, end, cell.flicker_time)(time)
        reading += cell.noise * rng.standard_normal(time.size)
        readings.append(np.round(reading / cell.step) * cell.step)
    return readings[0], readings[1]


def read_motion(
    signals: Signals, time: np.ndarray, encoder: Encoder, errors: Errors, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return position [m], velocity and set speed [m/s] as the table's controller records them."""
    position, velocity = signals.schedule.motion(time)
    set_speed = signals.schedule.set_speed[signals.schedule.phase(time)]
    noise = rng.standard_normal((3, time.size))
    velocity = velocity * (1 + errors.velocity_noise * noise[0])
    velocity = velocity + encoder.velocity_floor * noise[1]
    position = position + encoder.position_noise * noise[2]
    return (
        np.round(position / encoder.position_step) * encoder.position_step,
        np.round(velocity / encoder.velocity_step) * encoder.velocity_step,
        set_speed,
    )


def motion_clock(time: np.ndarray, errors: Errors) -> np.ndarray:
    """Return times of the force clock as the clock of the motion logger shows them [s]."""
    shown = (time - errors.clock_shift) / (1 + errors.clock_rate)
    return np.round(shown / _TIME_STEP) * _TIME_STEP
