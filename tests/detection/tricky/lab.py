"""What a lab records: forces, velocity and position with its sensors' offsets and noise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from tricky import noise
from tricky.contact import Law, Slid, slide
from tricky.motion import Leg, Motion, run_programme
from tricky.trial import Truth, truth_of

Drift = Callable[[np.ndarray], np.ndarray]  # [N] over the share of the run that has passed


@dataclass(frozen=True)
class Lab:
    """A rig: load [N], typical speed [m/s], noise (share of the friction force) and its kind."""

    load: float
    speed: float
    mu: float
    noise: float
    kind: str
    load_noise: float
    speed_noise: float

    @property
    def friction(self) -> float:
        """Typical friction force [N]."""
        return self.mu * self.load


def draw_lab(
    rng: np.random.Generator,
    *,
    load: tuple[float, float] = (0.05, 2000.0),
    speed: tuple[float, float] = (5e-7, 0.3),
    mu: tuple[float, float] = (0.003, 2.0),
    noises: tuple[str, ...] = noise.USUAL,
) -> Lab:
    """Draw a rig; loads, speeds and coefficients evenly over their logarithms."""

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    return Lab(
        load=log(*load),
        speed=log(*speed),
        mu=log(*mu),
        noise=log(0.003, 0.04),
        kind=str(rng.choice(noises)),
        load_noise=log(3e-4, 3e-3),
        speed_noise=log(1e-3, 1e-2),
    )


def draw_law(rng: np.random.Generator, lab: Lab, **more: float) -> Law:
    """Draw a friction law around the lab's coefficient."""
    shape = rng.choice(["plain", "weakening", "strengthening", "stribeck"])
    law = {"mu": lab.mu, "at": lab.speed, "build_up": 0.02 * lab.speed}
    law |= {
        "plain": {},
        "weakening": {"slope": -rng.uniform(0.03, 0.15)},
        "strengthening": {"slope": rng.uniform(0.03, 0.2)},
        "stribeck": {"stribeck": rng.uniform(0.2, 1.0)},
    }[str(shape)]
    return Law(**law | more)


@dataclass
class Record:
    """Signals of one run in SI (time) and the truth."""

    motion: Motion
    slid: Slid
    lab: Lab
    normal: np.ndarray
    friction: np.ndarray
    velocity: np.ndarray
    position: np.ndarray
    truth: Truth

    def dataset(self, *names: str) -> xr.Dataset:
        """Return a run with the signals asked for, as `tl.read` would give it."""
        signals = {
            "friction_force": (self.friction, "N"),
            "normal_force": (self.normal, "N"),
            "sliding_velocity": (self.velocity, "m/s"),
            "position": (self.position, "m"),
        }
        chosen = names or ("friction_force", "normal_force", "sliding_velocity")
        data = {n: ("time", signals[n][0], {"units": signals[n][1]}) for n in chosen}
        run = xr.Dataset(data, {"time": ("time", self.motion.time, {"units": "s"})})
        return run.assign_attrs(source="other_lab.dat")


def record(
    rng: np.random.Generator,
    lab: Lab,
    legs: list[Leg],
    law: Law,
    *,
    rate: float,
    ramp: float = 0.05,
    offset: float = 0.0,
    drift: Drift | None = None,
    normal_offset: float = 0.0,
    normal_drift: Drift | None = None,
    mass: float = 0.0,
    tilt: float = 0.0,
    fluctuation: Callable[[np.ndarray], np.ndarray] | None = None,
    load_wave: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Record:
    """Measure: `fluctuation` (time) is a part of mu, relative, whose long mean is zero.

    Offsets and drifts are in shares of the lab's friction force (of its load for the normal
    force); `mass` [kg] hangs on the force sensor; `tilt` is the share by which the load is larger
    forward and smaller backward.
    """
    motion = run_programme(legs, rate, ramp)
    time, n = motion.time, motion.time.size
    passed = time / time[-1]
    slid = slide(motion, law)
    load = lab.load * motion.load
    load = load * (1 + tilt * np.sign(motion.velocity))
    if load_wave is not None:
        load = load * (1 + load_wave(time))
    ratio = slid.ratio
    if fluctuation is not None:
        ratio = ratio * (1 + fluctuation(time))
    force = ratio * load + mass * motion.acceleration
    zero = offset + (drift(passed) if drift else 0.0)
    force = force + lab.friction * zero
    force = force + noise.noise(rng, n, rate, lab.noise * lab.friction, lab.kind)
    zero = normal_offset + (normal_drift(passed) if normal_drift else 0.0)
    normal = load + lab.load * zero + lab.load * lab.load_noise * rng.standard_normal(n)
    top = np.abs(motion.velocity).max()
    velocity = motion.velocity * (1 + lab.speed_noise * rng.standard_normal(n))
    velocity = velocity + 1e-4 * top * rng.standard_normal(n)
    travels = np.abs(motion.speed) * (motion.stop - motion.start)
    digit = 1e-3 * travels.min() if travels.size else 1e-5 * np.ptp(motion.position)
    position = np.round(motion.position / digit) * digit
    truth = truth_of(motion, slid)
    return Record(motion, slid, lab, normal, force, velocity, position, truth)
