"""Runs with known plateaus: strokes both ways over four decades, ramps, rests, noise."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.units.stamping import stamp

SPEEDS = np.geomspace(1e-6, 1e-2, 13)


class Made(NamedTuple):
    run: xr.Dataset
    start: np.ndarray
    stop: np.ndarray
    velocity: np.ndarray


def strokes(
    speeds=SPEEDS,
    *,
    both_ways=True,
    samples=400,
    noise=0.02,
    floor=1e-7,
    step=0.0,
    rate="constant",
    ramp=0.05,
    rest=0.2,
    seed=0,
) -> Made:
    """Build a run of strokes.

    `samples` per plateau; `rate` "constant" samples at 100 Hz, "follows" at a rate that grows with
    the square root of the speed and so changes by a factor of 100 within the run, "jitter" moves
    each moment by a tenth of the spacing besides.
    """
    rng = np.random.default_rng(seed)
    signs = (1, -1) if both_ways else (1,)
    targets = np.array([s * sign for s in speeds for sign in signs])
    up, idle = max(int(ramp * samples), 1), int(rest * samples)
    profile, spacing, edges, at = [np.zeros(idle)], [np.full(idle, 0.01)], [], idle
    for target in targets:
        leg = np.linspace(0, target, up + 2)[1:-1]
        part = np.concatenate([leg, np.full(samples, target), leg[::-1], np.zeros(idle)])
        dt = 0.01 if rate == "constant" else 0.01 * np.sqrt(1e-4 / abs(target))
        profile.append(part)
        spacing.append(np.full(part.size, dt))
        edges.append((at + up, at + up + samples))
        at += part.size
    v, dt = np.concatenate(profile), np.concatenate(spacing)
    time = np.concatenate([[0.0], np.cumsum(dt)[:-1]])
    if rate == "jitter":
        time[1:] += 0.1 * dt[1:] * rng.uniform(-1, 1, time.size - 1)
    first, last = np.array(edges).T
    reading = v * (1 + noise * rng.standard_normal(v.size)) + floor * rng.standard_normal(v.size)
    if step:
        reading = np.round(reading / step) * step
    run = xr.Dataset({"sliding_velocity": ("time", reading)}, {"time": time})
    return Made(stamp(run, source="made.csv"), time[first], time[last - 1], targets)


def with_friction(
    made: Made, mu=0.3, load=31.0, *, scatter=0.002, offset=0.0, seed=0
) -> xr.Dataset:
    """Add forces: friction along the velocity, normal force, and an offset of the friction."""
    rng = np.random.default_rng(seed)
    n = made.run.sizes["time"]
    sign = np.zeros(n)
    time = made.run["time"].values
    for start, stop, v in zip(made.start, made.stop, made.velocity, strict=True):
        sign[(time >= start) & (time <= stop)] = np.sign(v)
    normal = load + 0.1 * rng.standard_normal(n)
    force = sign * mu * normal + load * scatter * rng.standard_normal(n) + offset
    return stamp(
        made.run.assign(friction_force=("time", force), normal_force=("time", normal)),
        source="made.csv",
    )


def matches(segments: xr.Dataset, made: Made, slack=0.05, error=0.01) -> bool:
    """Whether the segments are the plateaus: all, nothing else, ends within `slack` of each."""
    if segments.sizes["segment"] != made.velocity.size:
        return False
    length = made.stop - made.start
    signed = segments["sliding_speed"].values * segments["direction"].values
    return bool(
        (np.abs(segments["start"].values - made.start) <= slack * length).all()
        and (np.abs(segments["stop"].values - made.stop) <= slack * length).all()
        and (np.abs(signed - made.velocity) <= error * np.abs(made.velocity)).all()
    )


def reasons(segments):
    return set(segments["omitted_reason"].values)


def velocity_run(velocity, dt=0.01):
    velocity = np.asarray(velocity, dtype=float)
    return xr.Dataset(
        {"sliding_velocity": ("time", velocity)}, {"time": np.arange(velocity.size) * dt}
    )
