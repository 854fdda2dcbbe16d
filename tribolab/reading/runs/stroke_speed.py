"""The sliding velocity of a rig of which only the stroke and the frequency are known."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

Drive = Literal["crank", "constant speed"]
_TELLS = 0.3  # share of the friction's variance that has to be at the frequency
_AT_REST = 0.3  # share of the usual swing below which a cycle does not slide
_WHOLE = 0.85  # of it, from which a cycle beside a rest slides all along
_OTHER = 0.1  # of the frequency, by which a drive may be slower or faster than it was set
_AS_LOUD = 0.5  # of the usual variance: a cycle that is no rest
_FEW = 0.05  # of the sliding cycles
FEWEST_CYCLES = 3
_DENSEST = 8  # samples that a cycle has at least


class StrokeVelocity(NamedTuple):
    """Sliding velocity [m/s] (time), and the frequency that the friction has [Hz].

    `unlike` is for how long [s] the friction turns over otherwise than it was stated; the velocity
    is zero there.
    """

    velocity: np.ndarray
    frequency: float
    unlike: float = 0.0


def velocity_of_strokes(
    time: np.ndarray, friction: np.ndarray, stroke: float, frequency: float, drive: Drive
) -> StrokeVelocity | None:
    """Return the sliding velocity of a contact that goes to and fro at a known frequency.

    Parameters
    ----------
    time
        [s] (time), increasing.
    friction
        Friction force or coefficient with its sign (time).
    stroke
        From end to end [m].
    frequency
        Cycles per second as they were set [Hz].
    drive
        ``"crank"``: the velocity is a sine, with pi f L at its highest; ``"constant speed"``: it is
        2 f L both ways.

    Returns
    -------
    StrokeVelocity or None
        None where the friction does not tell the phase: it has no sign, less than 30 % of its
        variance is at the frequency, or there are fewer than 3 cycles of 8 samples; or where it
        turns over with another frequency, more than a tenth off.

    Notes
    -----
    Friction points against the motion, so that its fundamental has the phase of the velocity. That
    is taken cycle by cycle (the mean of the friction times exp(-2 pi i f t) over the cycle), so a
    drive that is a little slower or faster than it was set is followed. A contact that shears
    before it slides turns over late, and inertia early; both move the phase a little, and the speed
    of the middle of a stroke in the second order only.

    Examples
    --------
    >>> time = np.arange(0, 10, 0.01)
    >>> friction = np.sign(np.cos(2 * np.pi * 1.01 * time))
    >>> strokes = velocity_of_strokes(time, friction, 10e-3, 1.0, "crank")
    >>> round(strokes.frequency, 3), float((1e3 * strokes.velocity.max()).round(1))
    (1.01, 31.7)
    """
    cycle = np.floor((time - time[0]) * frequency).astype(int)
    cycles = int(cycle[-1])  # whole ones
    known = np.isfinite(friction) & (cycle < cycles)
    if cycles < FEWEST_CYCLES or np.count_nonzero(known) < _DENSEST * cycles:
        return None
    counts = np.bincount(cycle[known], minlength=cycles)
    means = np.bincount(cycle[known], friction[known], minlength=cycles) / np.maximum(counts, 1)
    rest = friction[known] - means[cycle[known]]
    turned = rest * np.exp(-2j * np.pi * frequency * time[known])
    parts = [
        np.bincount(cycle[known], part, minlength=cycles) for part in (turned.real, turned.imag)
    ]
    wave = (parts[0] + 1j * parts[1]) / np.maximum(counts, 1)
    swing = np.abs(wave)
    usual = np.percentile(swing, 75)
    slides = (swing > _AT_REST * usual) & (counts > 0)
    # a cycle in which it starts or stops goes but a part of the way
    beside = ~(np.append(False, slides[:-1]) & np.append(slides[1:], False))
    slides &= ~beside | (swing > _WHOLE * usual)
    power = np.bincount(cycle[known], rest**2, minlength=cycles)[slides].sum()
    told = 2 * np.sum(counts[slides] * swing[slides] ** 2)
    if np.count_nonzero(slides) < FEWEST_CYCLES or not told > _TELLS * power:
        return None
    middle = time[0] + (np.flatnonzero(slides) + 0.5) / frequency
    next_one = slides[1:] & slides[:-1]
    turn = np.angle(np.sum((wave[1:] * wave[:-1].conj())[next_one]))
    if abs(turn) > 2 * np.pi * _OTHER:
        return None
    swings = np.bincount(cycle[known], rest**2, minlength=cycles) / np.maximum(counts, 1)
    next_to = np.append(False, slides[:-1]) | np.append(slides[1:], False)
    loud = ~slides & ~next_to & (swings > _AS_LOUD * np.median(swings[slides]))
    unlike = np.count_nonzero(loud) / frequency
    phase = np.unwrap(np.angle(wave[slides]))
    drift = np.polyfit(middle, phase, 1)[0] / (2 * np.pi)
    beyond = phase[[0, -1]] + 2 * np.pi * drift * (time[[0, -1]] - middle[[0, -1]])
    phase = np.interp(
        time,
        np.concatenate([[time[0] - 1e-9], middle, [time[-1] + 1e-9]]),
        np.concatenate([beyond[:1], phase, beyond[1:]]),
    )
    angle = 2 * np.pi * frequency * time + phase
    own = frequency + drift
    pace = (
        np.pi * own * stroke * np.cos(angle)
        if drive == "crank"
        else 2 * own * stroke * np.sign(np.cos(angle))
    )
    moving = np.append(slides, slides[-1])[np.minimum(cycle, cycles)]
    is_unlike = np.count_nonzero(loud) > max(2, _FEW * np.count_nonzero(slides))
    return StrokeVelocity(np.where(moving, pace, 0.0), float(own), unlike if is_unlike else 0.0)
