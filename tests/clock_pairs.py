"""Pairs of a force log and a motion log with clocks of their own, and all that blurs their match.

A stage drives the sample. Its drive has slack (the motor turns, the stage waits), the sample sticks
until the elastic force has built up, mass hangs on the force sensor, the sensor has hysteresis,
noise and drift, and the loggers have rates and clocks of their own. The motion log shows the
motor, or the sample's own sliding.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.units.stamping import stamp

STEP = 2e-4  # s, of the time on which a pair is made

KINDS = (
    "clean",
    "inertia",
    "stick of the stage",
    "stick of the sample",
    "slack",
    "hysteresis",
    "noise and drift",
    "rates",
    "clock rate",
    "everything",
)


@dataclass(frozen=True)
class Pair:
    """Two logs and the truth.

    Parameters
    ----------
    force, motion
        The logs as a reader gives them (time).
    shift
        Motion clock + shift = force clock [s] in the middle of the motion log.
    rate
        Relative difference of the clocks.
    kind, protocol
        What was put in, and how the stage moved.
    shortest
        Duration of the shortest stroke [s].
    """

    force: xr.Dataset
    motion: xr.Dataset
    shift: float
    rate: float
    kind: str
    protocol: str
    shortest: float


def make_pair(seed: int, kind: str, protocol: str | None = None, dated: bool = False) -> Pair:
    """Make one pair of logs; everything is drawn at random from `seed`.

    Parameters
    ----------
    seed
        Of all random numbers.
    kind
        One of `KINDS`.
    protocol
        "sweep", "strokes", "sine" or "steps"; drawn when not given.
    dated
        Whether both logs say when they were begun, to the second.
    """
    rng = np.random.default_rng([seed, KINDS.index(kind)])

    def has(*kinds: str) -> bool:
        return kind in kinds or kind == "everything"

    names = ("sweep", "strokes", "sine", "steps")
    drawn = str(rng.choice(names, p=(0.45, 0.35, 0.1, 0.1)))
    protocol = protocol or drawn
    velocity, fastest, shortest = _velocity(rng, protocol)
    time = STEP * np.arange(len(velocity))
    motor = STEP * np.cumsum(velocity)
    way = fastest * shortest  # about the longest stroke
    slack = min(10 ** rng.uniform(-5.0, -3.5), 0.03 * way)
    stage = play(motor, 0.5 * slack) if has("slack") else motor
    reach = min(10 ** rng.uniform(-5.3, -3.5), 0.05 * way) if has(*KINDS[2:4]) else 1e-6
    sample = play(stage, reach)
    shown = sample if kind == "stick of the sample" else motor
    if kind == "everything" and rng.random() < 0.5:
        shown = sample
    shown_velocity = np.gradient(shown, STEP)

    level = 10 ** rng.uniform(0.3, 1.5)  # N
    slope = rng.uniform(-0.1, 0.2)  # per decade
    speed = np.abs(np.gradient(sample, STEP))
    law = 1 + slope * np.log10(np.maximum(speed, 1e-3 * fastest) / fastest)
    force = level * _held(law, speed > 0) * (stage - sample) / reach
    if rng.random() < 0.5:
        force = force * _relaxed(rng, sample)
    if has("inertia"):
        mass = rng.uniform(0.5, 24.0) * rng.choice([-1.0, 1.0])
        force = force + mass * np.gradient(np.gradient(stage, STEP), STEP)
    if has("hysteresis"):
        span = float(np.ptp(force))
        force = force + rng.uniform(0.01, 0.1) * (force - play(force, 0.05 * span))
    loud = has("noise and drift")
    if loud:
        knots = np.cumsum(rng.standard_normal(12)) * rng.uniform(0.02, 0.15) * level
        force = force + np.interp(time, np.linspace(0, time[-1], 12), knots)

    if has("rates"):
        rates = 10 ** rng.uniform(np.log10(20), 3, 2)
    else:
        rates = np.full(2, rng.choice([100.0, 200.0, 500.0, 1000.0]))
    at_force = np.arange(rng.uniform(0, 1 / rates[0]), time[-1], 1 / rates[0])
    at_motion = np.arange(rng.uniform(0.0, 1.0), time[-1] - rng.uniform(0.0, 1.0), 1 / rates[1])
    if rng.random() < 0.5:  # a converter that averages over its interval
        sums = np.concatenate([[0.0], np.cumsum(force)])
        first = np.searchsorted(time, at_force - 0.5 / rates[0])
        last = np.maximum(np.searchsorted(time, at_force + 0.5 / rates[0]), first + 1)
        reading = (sums[last] - sums[first]) / (last - first)
    else:
        reading = np.interp(at_force, time, force)
    noise = level * (rng.uniform(0.02, 0.1) if loud else 0.01)
    reading = reading + noise * rng.standard_normal(len(reading)) + rng.normal(0, 0.3 * level)

    clock_rate = float(rng.uniform(-100e-6, 100e-6)) if has("clock rate") else 0.0
    shift = float(rng.uniform(-2.0, 2.0) if rng.random() < 0.5 else rng.uniform(-30.0, 30.0))
    middle = 0.5 * (at_motion[0] + at_motion[-1])
    motion_clock = (at_motion - middle) / (1 + clock_rate) + middle - shift
    motion = {}
    resolved = rng.uniform(1e-4, 3e-3) * fastest
    if rng.random() < 0.75:
        values = np.interp(at_motion, time, shown_velocity)
        values = values * (1 + 0.003 * rng.standard_normal(len(values)))
        values += resolved * rng.standard_normal(len(values))
        motion["sliding_velocity"] = np.round(values / resolved) * resolved
    else:
        step = 10 ** rng.uniform(-8, -6)
        motion["position"] = np.round(np.interp(at_motion, time, shown) / step) * step
    dates = ("2026-03-02T09:12:31", "2026-03-02T09:12:31") if dated else (None, None)
    if dated:
        apart = round(motion_clock[0] + shift - at_force[0])
        dates = (dates[0], f"2026-03-02T09:12:{31 + apart:02d}")
    force_log = _log({"friction_force": reading}, at_force, "a_force.csv", dates[0])
    motion_log = _log(motion, motion_clock, "a_motion.csv", dates[1])
    return Pair(force_log, motion_log, shift, clock_rate, kind, protocol, shortest)


def play(position: np.ndarray, half: float) -> np.ndarray:
    """Follow `position` with slack: what is driven stays within `half` of the driver.

    >>> import numpy as np
    >>> play(np.array([0.0, 3.0, 1.0, -3.0]), 1.0).tolist()
    [0.0, 2.0, 2.0, -2.0]
    """
    # a turning point still belongs to the way that led to it
    turns = np.flatnonzero(np.diff(np.sign(np.diff(position))) != 0) + 2
    out, last = np.empty_like(position), float(position[0])
    for part in np.split(np.arange(len(position)), turns):
        at = position[part]
        rising = at[-1] >= (position[part[0] - 1] if part[0] else at[0])
        out[part] = np.maximum(last, at - half) if rising else np.minimum(last, at + half)
        last = float(out[part[-1]])
    return out


def _relaxed(rng: np.random.Generator, sample: np.ndarray) -> np.ndarray:
    """What is left of the friction at rest, which it gets back as it slides."""
    part, tau = rng.uniform(0.1, 0.5), rng.uniform(0.1, 2.0)
    back = 10 ** rng.uniform(-5.5, -4.5)
    speed = np.abs(np.gradient(sample, STEP))
    moving = speed > 0
    edges = np.concatenate([[0], np.flatnonzero(np.diff(moving)) + 1, [len(moving)]])
    lost = np.zeros(len(moving))
    now = 0.0
    for first, end in zip(edges[:-1], edges[1:], strict=True):
        if moving[first]:
            lost[first:end] = now * np.exp(-np.cumsum(speed[first:end]) * STEP / back)
        else:
            rested = STEP * np.arange(end - first)
            lost[first:end] = part - (part - now) * np.exp(-rested / tau)
        now = float(lost[end - 1])
    return 1.0 - lost


def _held(values: np.ndarray, where: np.ndarray) -> np.ndarray:
    """Values where they hold, else the last that held."""
    index = np.maximum.accumulate(np.where(where, np.arange(len(values)), 0))
    return values[index]


def _velocity(rng: np.random.Generator, protocol: str) -> tuple[np.ndarray, float, float]:
    """Velocity of the motor over time, fastest speed, duration of the shortest stroke."""
    fastest = 10 ** rng.uniform(-3.0, -0.7)
    acceleration = 10 ** rng.uniform(-1.0, np.log10(3.0))
    rest = float(rng.choice([0.0, rng.uniform(0.3, 2.0)]))
    ends = rng.uniform(1.5, 5.0, 2)
    if protocol == "sine":
        frequency = 10 ** rng.uniform(-1, 0.3)
        number = int(rng.integers(6, 20))
        amplitude = min(fastest, acceleration / (2 * np.pi * frequency))
        t = np.arange(0.0, number / frequency, STEP)
        wave = amplitude * np.sin(2 * np.pi * frequency * t)
        parts = [np.zeros(int(ends[0] / STEP)), wave, np.zeros(int(ends[1] / STEP))]
        return np.concatenate(parts), float(amplitude), 0.5 / frequency
    if protocol == "sweep":
        speeds = np.geomspace(fastest * 10 ** -rng.uniform(1, 3), fastest, int(rng.integers(3, 9)))
        strokes = [
            (way * v, duration)
            for v, duration in zip(
                speeds, np.geomspace(rng.uniform(3, 8), 1.0, len(speeds)), strict=True
            )
            for way in (1, -1)
        ]
    elif protocol == "strokes":
        duration = rng.uniform(0.8, 4.0)
        strokes = [(way * fastest, duration) for way in (1, -1)] * int(rng.integers(3, 10))
    else:
        number = int(rng.integers(3, 8))
        speeds = fastest * 10 ** -rng.uniform(0, 1.5, number)
        strokes = [(v, t) for v, t in zip(speeds, rng.uniform(2, 6, number), strict=True)]
    wanted = [np.zeros(int(ends[0] / STEP))]
    for v, duration in strokes:
        wanted += [np.full(int(duration / STEP), v), np.zeros(int(rest / STEP))]
    velocity = np.concatenate([*wanted, np.zeros(int(ends[1] / STEP))])
    # every change of velocity is a ramp
    changes = np.flatnonzero(np.diff(velocity)) + 1
    for at, after in zip(changes, [*changes[1:], len(velocity)], strict=True):
        jump = velocity[at] - velocity[at - 1]
        long = min(int(abs(jump) / acceleration / STEP) + 1, after - at)
        velocity[at : at + long] = velocity[at - 1] + jump * np.arange(long) / long
    return velocity, fastest, min(abs(d) for _, d in strokes)


def _log(values: dict, clock: np.ndarray, name: str, date: str | None) -> xr.Dataset:
    attrs = {
        "source": name,
        "source_sha256": "0",
        "instrument": "made",
        "columns_used": {},
        "columns_not_used": "",
        "time_origin_s": float(clock[0]),
        "speed_from": "recorded",
    } | ({"recorded_at": date} if date else {})
    data = {key: ("time", value) for key, value in values.items()}
    return stamp(xr.Dataset(data, {"time": clock - clock[0]}, attrs))


def write_pair(pair: Pair, folder: Path) -> Path:
    """Write both logs as the linear slider does; the path of the force log."""
    motion = pair.motion
    time = motion["time"].values
    if "position" in motion:
        position = motion["position"].values
        velocity = np.gradient(position, time)
    else:
        velocity = motion["sliding_velocity"].values
        steps = 0.5 * np.diff(time) * (velocity[1:] + velocity[:-1])
        position = np.concatenate([[0.0], np.cumsum(steps)])
    force = pair.force["friction_force"].values
    tables = {
        "force": (pair.force, ",", "Fx [N],Fz [N]", [force, np.full(len(force), 31.0)]),
        "motion": (
            motion,
            ";",
            "Position [mm];Velocity [mm/s]",
            [1e3 * position, 1e3 * velocity],
        ),
    }
    for log, (data, mark, labels, columns) in tables.items():
        clock = data["time"].values + data.attrs["time_origin_s"]
        date = data.attrs.get("recorded_at")
        head = f"# Linear slider, {log} log\n" + (f"# date: {date}\n" if date else "")
        np.savetxt(
            folder / f"a_31N_01_{log}.csv",
            np.column_stack([clock, *columns]),
            "%.9g",
            mark,
            header=f"{head}Time [s]{mark}{labels}",
            comments="",
        )
    return folder / "a_31N_01_force.csv"
