"""Faults of the zero and of the load reading that look like friction, and their sound twins.

Coefficients of 0.15 to 1, loads of 1 N to 100 N, white noise, one way or both ways, rests with and
without load.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from tribolab.units.stamping import stamp
from tricky.trial import Trial, Truth, sound, tricky

Leg = tuple[float, int, float]  # duration [s], direction, share of the load


def record(
    rng: np.random.Generator,
    legs: Sequence[Leg],
    *,
    leak: float = 0.0,
    tilt: float = 0.0,
    drag: float = 0.0,
    creep: float = 0.0,
    zero: float = 0.0,
    gain: Callable[[np.ndarray], np.ndarray] = np.ones_like,
    exponent: float = 0.0,
) -> Trial:
    """Record a run and its truth.

    `leak` is the share of friction in the load reading, `tilt` that of the load in the friction
    (of the friction), `drag` the idle friction (of the friction), `creep` and `zero` of the load
    reading (of the load), `gain` that of the load reading over the share of the run, `exponent`
    that of the load in the coefficient.
    """
    mu, load = rng.uniform(0.15, 1.0), np.exp(rng.uniform(0, np.log(100)))
    rate, speed = rng.uniform(20, 80), np.exp(rng.uniform(np.log(1e-4), np.log(1e-2)))
    noise = load * np.exp(rng.uniform(np.log(5e-4), np.log(5e-3)))
    kept = rng.uniform(0, 0.9)  # share of friction that a rest under load keeps after sliding
    ramp = rng.uniform(0.2, 0.5)
    ends = np.cumsum([duration for duration, _, _ in legs])
    time = np.arange(int(ends[-1] * rate)) / rate
    knots = np.column_stack([ends - [d for d, _, _ in legs], ends])
    knots[:, 0] += ramp
    way, share = (
        np.interp(time, knots.ravel(), np.repeat([g[k] for g in legs], 2)) for k in (1, 2)
    )
    moving = np.abs(way) > 0.5
    last = np.maximum.accumulate(np.where(moving, np.arange(time.size), -1))
    before = np.where(last < 0, 0.0, np.sign(way[last.clip(0)]))
    leg = np.searchsorted(ends, time, side="right").clip(max=len(legs) - 1)
    turns = np.array([d for _, d, _ in legs])[leg] * before < 0
    held = before * np.maximum(kept, np.abs(way))
    friction_share = np.where(turns | (last < 0), way, held)
    truth = mu * np.maximum(share, 1e-3) ** exponent
    normal = load * share
    friction = truth * normal * friction_share
    typical, u = mu * load, time / time[-1]
    force = friction + tilt * mu * normal + drag * typical * np.where(moving, way, 0.0)
    reading = (normal + leak * friction) * gain(u) * (1 + creep * u) + zero * load
    scatter = noise * rng.standard_normal((2, time.size))
    signals = {
        "friction_force": force + scatter[0] * min(mu, 1.0) + rng.uniform(-0.05, 0.05) * typical,
        "normal_force": reading + scatter[1],
        "sliding_velocity": speed * way * (1 + 2e-3 * rng.standard_normal(time.size)),
    }
    run = stamp(xr.Dataset({k: ("time", v) for k, v in signals.items()}, {"time": time}))
    slides = np.array([bool(d) and part > 0 for _, d, part in legs])
    signed = speed * np.array([d for _, d, _ in legs])
    start, stop = knots[slides].T
    return Trial(run, Truth(start, stop, signed[slides], time, truth))


def one_way(rng: np.random.Generator, before: Sequence[Leg] = ()) -> list[Leg]:
    """Slide one way a few times between rests under load and without."""
    bare, slides = (rng.uniform(6, 15), 0, 0.0), int(rng.integers(1, 4))
    legs = [bare, *before, (rng.uniform(3, 10), 0, 1.0)]
    for _ in range(slides):
        legs += [(rng.uniform(20, 90), 1, 1.0), (rng.uniform(2, 6), 0, 1.0)]
    return [*legs, bare]


def both_ways(rng: np.random.Generator, shares: Sequence[float] = (1.0, 1.0)) -> list[Leg]:
    """Slide to and fro, some strokes at each share of the load, between rests."""
    duration, many = rng.uniform(8, 30), int(rng.integers(2, 5))
    legs: list[Leg] = [(8.0, 0, 0.0)]
    for share in shares:
        legs += [(4.0, 0, share), *[(duration, way, share) for _ in range(many) for way in (1, -1)]]
        legs += [(2.0, 0, share)]
    return [*legs, (8.0, 0, 0.0)]


def some_way(rng: np.random.Generator) -> list[Leg]:
    """Slide one way or both ways."""
    return one_way(rng) if rng.integers(2) else both_ways(rng)


def with_rests(rng: np.random.Generator, legs: list[Leg]) -> list[Leg]:
    """Keep 1 to 10 % of the load where it was taken off: always alike, or not quite."""
    share, spread = rng.uniform(0.01, 0.1), float(rng.choice([0.0, 0.3]))
    bare = [share * (1 + spread * rng.uniform(-1, 1)) for _ in legs]
    return [(d, way, p or own) for (d, way, p), own in zip(legs, bare, strict=True)]


def sign(rng: np.random.Generator) -> float:
    """Draw a sign."""
    return float(rng.choice([-1, 1]))


def idle(rng: np.random.Generator) -> list[Leg]:
    """Slide without load, with a rest after it."""
    return [(rng.uniform(8, 20), 1, 0.0), (rng.uniform(3, 8), 0, 0.0)] * int(rng.integers(1, 3))


def step(rng: np.random.Generator) -> Callable[[np.ndarray], np.ndarray]:
    """Let the load reading drop to 0.62 to 0.71 from the middle of the run on."""
    factor, at = rng.uniform(0.62, 0.71), rng.uniform(0.35, 0.65)
    return lambda u: np.where(u > at, factor, 1.0)


@tricky("load")
def leak_into_load(rng: np.random.Generator) -> Trial:
    """Friction of one-way sliding leaks into the load reading."""
    return record(rng, one_way(rng), leak=sign(rng) * rng.uniform(0.03, 0.1))


@tricky("zero")
def partial_unloading(rng: np.random.Generator) -> Trial:
    """All rests keep some of the load."""
    return record(rng, with_rests(rng, some_way(rng)))


@tricky("zero")
def drag_one_way(rng: np.random.Generator) -> Trial:
    """The bearing drags, as strokes without load show."""
    return record(rng, one_way(rng, idle(rng)), drag=rng.uniform(0.01, 0.08))


@tricky("load")
def load_reading_drops(rng: np.random.Generator) -> Trial:
    """The load reading drops, the load does not."""
    return record(rng, both_ways(rng), gain=step(rng))


@tricky("zero")
def tilt_below_limit(rng: np.random.Generator) -> Trial:
    """The load reads as friction, by less than 2 % of it."""
    return record(rng, one_way(rng), tilt=sign(rng) * rng.uniform(0.005, 0.0195))


@tricky("load")
def creep_below_limit(rng: np.random.Generator) -> Trial:
    """The load reading creeps by up to 3 %."""
    return record(rng, some_way(rng), creep=sign(rng) * rng.uniform(0.005, 0.03))


@tricky("zero")
def tilt_beyond_limit(rng: np.random.Generator) -> Trial:
    """The load reads as friction, by 3 to 15 % of it, as rests under load show."""
    return record(rng, one_way(rng), tilt=sign(rng) * rng.uniform(0.03, 0.15))


@tricky("load")
def creep_beyond_limit(rng: np.random.Generator) -> Trial:
    """The load reading creeps by 5 to 15 % under a dead weight."""
    return record(rng, some_way(rng), creep=sign(rng) * rng.uniform(0.05, 0.15))


@sound
def load_once_a_second(rng: np.random.Generator) -> Trial:
    """The load reading is refreshed once a second."""
    trial = record(rng, some_way(rng))
    load = trial.data["normal_force"]
    first = np.searchsorted(load["time"].values, np.floor(load["time"].values))
    return replace(trial, data=trial.data.assign(normal_force=load.copy(data=load.values[first])))


@sound
def plain_run(rng: np.random.Generator) -> Trial:
    """Nothing is wrong."""
    return record(rng, some_way(rng))


@sound
def untared_load_cell(rng: np.random.Generator) -> Trial:
    """The load cell was not tared; rests without load show it."""
    return record(rng, some_way(rng), zero=sign(rng) * rng.uniform(0.005, 0.05))


@sound
def idle_strokes(rng: np.random.Generator) -> Trial:
    """Strokes without load show that nothing drags."""
    return record(rng, one_way(rng, idle(rng)))


@sound
def load_programme(rng: np.random.Generator) -> Trial:
    """Loads of 0.2, 0.4 and 1 of the nominal one; friction of a plain or a Hertz contact."""
    shares = rng.permutation([0.2, 0.4, 1.0])
    return record(rng, both_ways(rng, shares), exponent=-rng.uniform(0, 1 / 3))


@sound
def load_steps_one_way(rng: np.random.Generator) -> Trial:
    """The same loads, put on again and again while it slides one way."""
    shares = np.tile(rng.permutation([0.2, 0.4, 1.0]), rng.integers(1, 7))
    slides = [(rng.uniform(20, 60), 1, share) for share in shares]
    legs = [(rng.uniform(6, 15), 0, 0.0), (4.0, 0, slides[0][2]), *slides, (3.0, 0, slides[-1][2])]
    return record(rng, [*legs, (rng.uniform(6, 15), 0, 0.0)], exponent=-rng.uniform(0, 1 / 3))
