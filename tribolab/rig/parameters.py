"""Parameters of the virtual rig in SI units: protocol, scatter, sensors, loggers and clocks."""

from __future__ import annotations

from dataclasses import dataclass, field

from tribolab.studies import xu2026


@dataclass(frozen=True)
class Protocol:
    """Protocol of a run: rest, loading, two strokes at each speed, unloading, rest.

    Parameters
    ----------
    speeds
        Set speeds [m/s], in the order of the run.
    stroke, stroke_exponent
        Length of a stroke at speed v [m], ``stroke * (v / 1 um/s) ** stroke_exponent``: enough for
        ten stick-slip periods at the lowest speed, short enough at the highest for a short slab.
    unloaded_rest, loading, loaded_rest, rest
        Durations [s] of: the rest without load at each end, the change of load, the rest under load
        before the first stroke, and the rest between strokes.
    ramp_fraction, shortest_ramp, longest_ramp
        Duration of an acceleration ramp: share of the time of a stroke, within these limits [s].
    build_up, run_in, overshoot
        At the start of a stroke, the contact shears before it slides: friction reverses within the
        distance `build_up` [m]. It then has a peak of relative height `overshoot`, which decays
        within `run_in` [m] (7 % of the shortest stroke).
    relaxation_time, relaxed_part
        At rest, the friction force relaxes to a share `relaxed_part` with this relaxation time [s].

    Examples
    --------
    >>> Protocol(speeds=(1e-5, 1e-4)).stroke
    0.00045
    """

    speeds: tuple[float, ...] = xu2026.SPEEDS
    stroke: float = 0.45e-3
    stroke_exponent: float = 1 / 3
    unloaded_rest: float = 10.0
    loading: float = 5.0
    loaded_rest: float = 5.0
    rest: float = 2.0
    ramp_fraction: float = 0.03
    shortest_ramp: float = 0.03
    longest_ramp: float = 0.3
    build_up: float = 9e-6
    run_in: float = 31e-6
    overshoot: float = 0.10
    relaxation_time: float = 1.0
    relaxed_part: float = 0.4


@dataclass(frozen=True)
class Scatter:
    """True random variations of friction and load (the errors of the sensors are separate).

    Parameters
    ----------
    repeat
        Relative standard deviation of friction between repeats.
    fluctuation, fluctuation_length
        Relative standard deviation of friction along the track, and its correlation length as a
        share of the stroke.
    load_control, load_control_time
        Relative standard deviation of the controlled load, and its correlation time [s].

    Examples
    --------
    >>> Scatter(repeat=0.0).fluctuation  # runs that repeat exactly
    0.004
    """

    repeat: float = 0.01
    fluctuation: float = 0.004
    fluctuation_length: float = 0.01
    load_control: float = 0.005
    load_control_time: float = 20.0


@dataclass(frozen=True)
class ForceCell:
    """Errors of the two-axis force cell with amplifier and AD converter; forces in N.

    Parameters
    ----------
    noise, flicker, flicker_time
        Standard deviations of white and of slow noise, and correlation time of slow noise [s].
    hum
        Amplitude of the 50 Hz mains hum before the logger averages it.
    offset_friction, offset_normal
        Standard deviation of the zero offsets between runs.
    drift
        Standard deviation of a smooth drift during a run; in the normal force, a fifth of it.
    step
        Force per count of the converter: 16 bit for +-500 N.

    Examples
    --------
    >>> f"{ForceCell().step:.4f} N"
    '0.0153 N'
    """

    noise: float = 0.04
    flicker: float = 0.03
    flicker_time: float = 3.0
    hum: float = 0.03
    offset_friction: float = 1.2
    offset_normal: float = 0.4
    drift: float = 0.15
    step: float = 1000 / 2**16


@dataclass(frozen=True)
class Encoder:
    """Errors of the table's encoder: noise and resolution of position and velocity.

    Parameters
    ----------
    velocity_noise
        Smallest and largest relative noise of the velocity; each run has a random value between.
    velocity_floor, velocity_step
        Noise of the velocity at rest, and its resolution [m/s].
    position_noise, position_step
        Noise and resolution of the position [m].

    Examples
    --------
    >>> Encoder(velocity_noise=(0.0, 0.0)).position_step
    1e-07
    """

    velocity_noise: tuple[float, float] = (0.01, 0.03)
    velocity_floor: float = 2e-8
    velocity_step: float = 2e-9
    position_noise: float = 3e-8
    position_step: float = 1e-7


@dataclass(frozen=True)
class Loggers:
    """Sampling rates of the loggers: ``rate * (v / 1 um/s) ** exponent``; at rest, ``rate``.

    Parameters
    ----------
    force_rate, motion_rate
        Sampling rates of force and motion at 1 um/s [Hz].
    exponent
        With 1/2, a rate of 10 Hz at 1 um/s becomes 1 kHz at 1 cm/s.
    jitter
        Standard deviation of the sampling time, relative to the sampling interval.

    Examples
    --------
    >>> slow = Loggers(force_rate=2.0)
    >>> slow.force_rate * (1e-2 / 1e-6) ** slow.exponent  # Hz at 1 cm/s
    200.0
    """

    force_rate: float = 10.0
    motion_rate: float = 4.0
    exponent: float = 0.5
    jitter: float = 0.02


@dataclass(frozen=True)
class Clocks:
    """Errors between the clocks of both loggers: ``force time = motion time (1 + rate) + shift``.

    Parameters
    ----------
    largest_shift
        Largest shift [s] of either sign.
    largest_rate
        Largest relative difference of the clocks' rates.

    Examples
    --------
    >>> Clocks(largest_shift=0.0, largest_rate=0.0).largest_shift  # one clock for both logs
    0.0
    """

    largest_shift: float = 2.0
    largest_rate: float = 10e-6


@dataclass(frozen=True)
class Rig:
    """All parameters of the virtual rig: protocol, sensors, loggers and clocks.

    Parameters
    ----------
    protocol, scatter, force_cell, encoder, loggers, clocks
        Parameters of each part.

    Examples
    --------
    >>> quiet = Rig(Protocol(speeds=(1e-4,)), force_cell=ForceCell(noise=0.0, flicker=0.0, hum=0.0))
    >>> quiet.protocol.speeds, quiet.loggers.force_rate
    ((0.0001,), 10.0)
    """

    protocol: Protocol = field(default_factory=Protocol)
    scatter: Scatter = field(default_factory=Scatter)
    force_cell: ForceCell = field(default_factory=ForceCell)
    encoder: Encoder = field(default_factory=Encoder)
    loggers: Loggers = field(default_factory=Loggers)
    clocks: Clocks = field(default_factory=Clocks)
