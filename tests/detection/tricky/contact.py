"""What friction does: laws of the speed, build-up after a reversal, running in."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tricky.motion import Motion


@dataclass(frozen=True)
class Law:
    """Kinetic friction: `mu` at the speed `at`, and how it depends on speed, way and distance.

    `slope` is the relative change per decade of speed (weakening below 0), `run_in` the relative
    surplus at the start that falls over `run_in_distance` [m], `backward` the factor of the
    backward way, `build_up` the distance [m] within which friction turns over.
    """

    mu: float
    at: float
    slope: float = 0.0
    stribeck: float = 0.0
    run_in: float = 0.0
    run_in_distance: float = 1.0
    backward: float = 1.0
    build_up: float = 0.0

    def level(self, velocity: np.ndarray, slid: np.ndarray) -> np.ndarray:
        """Kinetic friction coefficient (time), positive."""
        decades = np.log10(np.maximum(np.abs(velocity), 1e-3 * self.at) / self.at)
        level = self.mu * (1 + self.slope * np.clip(decades, -3, 3))
        level *= 1 + self.stribeck * np.exp(-np.sqrt(np.abs(velocity) / self.at))
        level *= 1 + self.run_in * np.exp(-slid / self.run_in_distance)
        return np.where(velocity < 0, self.backward, 1.0) * np.maximum(level, 0.02 * self.mu)


@dataclass(frozen=True)
class Slid:
    """True friction coefficient: kinetic `level` (>0) and the signed share that is built up."""

    level: np.ndarray
    share: np.ndarray
    slid_since_reversal: np.ndarray = field(repr=False)

    @property
    def ratio(self) -> np.ndarray:
        """Friction force over normal force, signed (time)."""
        return self.level * self.share


def slide(motion: Motion, law: Law) -> Slid:
    """Let the contact follow the motion."""
    step = np.abs(motion.velocity) / motion.rate
    path = np.cumsum(step)
    way = np.sign(motion.velocity)
    moving = np.flatnonzero(way != 0)
    share, since = np.zeros(way.size), np.zeros(way.size)
    if moving.size:
        turns = moving[np.flatnonzero(np.diff(way[moving], prepend=0.0) != 0)]
        before = 0.0
        for first, last in zip(turns, [*turns[1:], way.size], strict=True):
            slid = path[first:last] - path[first]
            left = np.exp(-slid / law.build_up) if law.build_up else np.zeros(slid.size)
            share[first:last] = way[first] + (before - way[first]) * left
            since[first:last] = slid
            before = share[last - 1]
    return Slid(law.level(motion.velocity, path), share, since)
