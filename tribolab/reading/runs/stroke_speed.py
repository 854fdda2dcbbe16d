"""Sliding velocity of a reciprocating rig that records neither position nor speed."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

Drive = Literal["crank", "constant speed"]
_TELLS = 0.3  # least share of the variance of friction at the set frequency
_AT_REST = 0.3  # share of the usual amplitude below which a cycle does not slide
_WHOLE = 0.85  # share of the usual amplitude above which a cycle next to a rest is complete
_OTHER = 0.1  # relative tolerance of the drive's frequency
_AS_LOUD = 0.5  # share of the usual variance above which a cycle is not at rest
_SMALL_SHARE = 0.05  # share of the sliding cycles, below which unlike cycles are ignored
FEWEST_CYCLES = 3
DENSEST = 8  # fewest samples per cycle; with fewer, only the mean speed is known


class StrokeVelocity(NamedTuple):
    """Sliding velocity [m/s] (time), and frequency of friction [Hz].

    `unlike` is the time [s] in which friction varies, but not at the set frequency; the velocity is
    set to zero there.
    """

    velocity: np.ndarray
    frequency: float
    unlike: float = 0.0


def velocity_of_strokes(
    time: np.ndarray, friction: np.ndarray, stroke: float, frequency: float, drive: Drive
) -> StrokeVelocity | None:
    """Return the sliding velocity of a reciprocating contact with a known frequency.

    Parameters
    ----------
    time
        Time [s] (time), increasing.
    friction
        Friction force or coefficient with its sign (time).
    stroke
        Length from end to end [m].
    frequency
        Set frequency of cycles [Hz].
    drive
        ``"crank"``: sinusoidal velocity with amplitude pi f L; ``"constant speed"``: 2 f L in both
        directions.

    Returns
    -------
    StrokeVelocity or None
        None if friction does not determine the phase: it has no sign, less than 30 % of its
        variance is at the frequency, there are fewer than 3 cycles of 8 samples, or its frequency
        deviates by more than a tenth.

    Notes
    -----
    Friction opposes motion, so that its fundamental has the phase of the velocity. The phase is
    computed cycle by cycle (mean of friction times exp(-2 pi i f t) over the cycle), and so follows
    a drive that deviates from its setting. Shear before sliding delays the reversal, and inertia
    advances it; both change the phase slightly, but the mid-stroke speed only in second order.

    Examples
    --------
    >>> time = np.arange(0, 10, 0.01)
    >>> friction = np.sign(np.cos(2 * np.pi * 1.01 * time))
    >>> strokes = velocity_of_strokes(time, friction, 10e-3, 1.0, "crank")
    >>> round(strokes.frequency, 3), float((1e3 * strokes.velocity.max()).round(1))
    (1.01, 31.7)
    """
    cycle = np.floor((time - time[0]) * frequency).astype(int)
    cycles = int(cycle[-1])  # complete cycles
    known = np.isfinite(friction) & (cycle < cycles)
    if cycles < FEWEST_CYCLES or np.count_nonzero(known) < DENSEST * cycles:
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
    # a cycle with a start or stop covers only part of the stroke
    single = ~(np.append(False, slides[:-1]) & np.append(slides[1:], False))
    slides &= ~single | (swing > _WHOLE * usual)
    power = np.bincount(cycle[known], rest**2, minlength=cycles)[slides].sum()
    reversing = 2 * np.sum(counts[slides] * swing[slides] ** 2)
    if np.count_nonzero(slides) < FEWEST_CYCLES or not reversing > _TELLS * power:
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
    is_unlike = np.count_nonzero(loud) > max(2, _SMALL_SHARE * np.count_nonzero(slides))
    return StrokeVelocity(np.where(moving, pace, 0.0), float(own), unlike if is_unlike else 0.0)
