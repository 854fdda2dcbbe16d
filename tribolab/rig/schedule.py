"""Schedule of a run: motion and load against time, in phases of constant acceleration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribolab.rig.parameters import Protocol


@dataclass(frozen=True)
class Schedule:
    """Phases of a run in order of time, each with constant acceleration (one element per phase).

    Parameters
    ----------
    start, duration
        Start on the force clock, and duration [s].
    position, velocity, acceleration
        Values at the start of the phase [m], [m/s], [m/s2].
    load_start, load_stop
        Load at the start and end of the phase, relative to the set load; linear in between.
    set_speed
        Set speed of the stroke [m/s], 0 at rest.
    stroke
        Number of the stroke, from 0; at rest, that of the stroke before, or -1.
    sliding
        1 at constant speed, 0 while accelerating or braking, -1 at rest.
    """

    start: np.ndarray
    duration: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    load_start: np.ndarray
    load_stop: np.ndarray
    set_speed: np.ndarray
    stroke: np.ndarray
    sliding: np.ndarray

    @property
    def end(self) -> float:
        """Time at the end of the run [s]."""
        return float(self.start[-1] + self.duration[-1])

    def phase(self, time: np.ndarray) -> np.ndarray:
        """Return the index of the phase at given times [s]."""
        return np.clip(np.searchsorted(self.start, time, side="right") - 1, 0, None)

    def motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the true position [m] and velocity [m/s] at given times [s]."""
        i = self.phase(time)
        passed, a = time - self.start[i], self.acceleration[i]
        velocity = self.velocity[i] + a * passed
        return self.position[i] + (self.velocity[i] + 0.5 * a * passed) * passed, velocity

    def load(self, time: np.ndarray) -> np.ndarray:
        """Return the load at given times [s], relative to the set load."""
        i = self.phase(time)
        part = (time - self.start[i]) / self.duration[i]
        return self.load_start[i] + (self.load_stop[i] - self.load_start[i]) * part


def make_schedule(protocol: Protocol) -> Schedule:
    """Return the phases that a protocol requires.

    Examples
    --------
    >>> from tribolab.rig.parameters import Protocol
    >>> int(make_schedule(Protocol(speeds=(1e-4,))).stroke.max())
    1
    """
    p = protocol
    # columns: duration, acceleration, load at start and end, set speed, stroke, sliding
    rows: list[tuple[float, ...]] = [(p.unloaded_rest, 0, 0, 0, 0, -1, -1)]
    rows.append((p.loading, 0, 0, 1, 0, -1, -1))
    rows.append((p.loaded_rest, 0, 1, 1, 0, -1, -1))
    velocities = [0.0, 0.0, 0.0]
    stroke = -1
    for speed in p.speeds:
        length = p.stroke * (speed / 1e-6) ** p.stroke_exponent
        ramp = float(np.clip(p.ramp_fraction * length / speed, p.shortest_ramp, p.longest_ramp))
        steady = length / speed - ramp  # each ramp covers half of speed * ramp
        for direction in (1, -1):
            stroke += 1
            rows += [
                (ramp, direction * speed / ramp, 1, 1, speed, stroke, 0),
                (steady, 0, 1, 1, speed, stroke, 1),
                (ramp, -direction * speed / ramp, 1, 1, speed, stroke, 0),
                (p.rest, 0, 1, 1, 0, stroke, -1),
            ]
            velocities += [0.0, direction * speed, direction * speed, 0.0]
    rows += [(p.loading, 0, 1, 0, 0, stroke, -1), (p.unloaded_rest, 0, 0, 0, 0, stroke, -1)]
    velocities += [0.0, 0.0]
    table = np.array(rows, dtype=float).T
    duration, acceleration = table[0], table[1]
    velocity = np.array(velocities)
    travel = (velocity + 0.5 * acceleration * duration) * duration
    return Schedule(
        start=np.concatenate([[0.0], np.cumsum(duration)[:-1]]),
        duration=duration,
        position=np.concatenate([[0.0], np.cumsum(travel)[:-1]]),
        velocity=velocity,
        acceleration=acceleration,
        load_start=table[2],
        load_stop=table[3],
        set_speed=table[4],
        stroke=table[5].astype(int),
        sliding=table[6].astype(int),
    )
