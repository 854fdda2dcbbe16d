"""Waves that repeat with each turn of a rig, and their effect on the mean of an unfinished turn.

Notes
-----
A disc that runs out moves the friction once (and twice) per turn. Over whole turns that cancels,
however few they are; a spectrum of the record alone cannot know this of one or two turns and takes
them for a slow wander. Where the rotation is recorded, the waves are fitted at its angle [1]_ and
the error of the mean is that of the rest, and beside it what a wave of this size, at any phase,
leaves in the mean over an unfinished turn, ``A abs(sin(pi k) / (pi k)) / sqrt(2)`` after k turns.
A wave is believed where it stands far above the spectrum of what is left.

Of more than a sixth as many turns as a record has stretches, the stretches do not show the wave's
course, and what they keep of it looks like a line beside which slow noise is overlooked. There the
waves are fitted to shorter stretches, `_STRETCHES_PER_TURN` of each turn, and subtracted whether
they are significant or not: they hardly change the mean. If the recorded speed is wrong by up to
`MAX_ERROR_OF_SPEED`, the wave would run out of step over many turns; the angle is stretched to
where the wave is largest.

Less than a turn tells neither the size of the wave nor its middle: the error is widened to what
the part that is seen may hide in the worst case, half a turn about a crest.

References
----------
.. [1] Percival and Walden (1993), Spectral Analysis for Physical Applications, ch. 10, Cambridge.
   doi:10.1017/CBO9780511622762
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribolab.friction import limits

MAX_COARSE_TURNS = 64.0  # turns in a record: of more, finer stretches of time are looked at
_TURNS_OF_SECOND_ORDER = 2.0  # turns from which on a wave twice per turn is looked for, too
_MIN_TURNS = 0.25  # of a turn: less is taken for as much
_STRETCHES_PER_TURN, _MIN_STRETCHES_PER_TURN = 8, 4  # stretches of each of many turns
# stretches: of more turns, 16 and more are averaged in each of the coarse ones
_MAX_STRETCHES = 6144


class Wave(NamedTuple):
    """What repeats a whole number of times per turn, as it was fitted to a record."""

    signal: np.ndarray  # over the record's stretches, in the signal's unit
    amplitude: float
    turns: float  # of the wave: twice those of the rig, if it repeats twice

    @property
    def left(self) -> float:
        """Standard error that an unfinished turn leaves in the mean, whatever its phase."""
        return float(self.amplitude * abs(np.sinc(self.turns)) / np.sqrt(2))

    def stands_out(self, power: np.ndarray) -> bool:
        """Whether it is far above the spectrum of what is left, from 0 to half the sampling."""
        count = self.signal.size
        cycles = np.linspace(0, count / 2, power.size)
        beside = power[(cycles >= self.turns / 2) & (cycles <= 2 * self.turns)]
        return bool(
            self.signal @ self.signal / 2 > limits.MIN_WAVE_OVER_SPECTRUM.value * beside.max()
        )


def turned(time: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Angle that a rig has turned through since the first sample.

    Parameters
    ----------
    time, speed
        Moments [s] and rotation speed [rad/s] (time).

    Returns
    -------
    numpy.ndarray
        Angle [rad] (time); not a number everywhere where a speed is missing.

    Examples
    --------
    >>> turned(np.array([0.0, 1.0, 3.0]), np.array([2.0, 2.0, 4.0])).tolist()
    [0.0, 2.0, 8.0]
    """
    angle = np.zeros(time.size)
    np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time), out=angle[1:])
    return angle if np.isfinite(angle[-1:]).all() else np.full(time.size, np.nan)


def hidden_by_part(turns: float) -> float:
    """Return the standard error that part of a turn hides, over the scatter that it shows.

    Notes
    -----
    Worst about a crest: the mean is off by sinc(k), which 1.96 errors shall hold; the scatter is
    ``(1 + sinc(2 k))/2 - sinc(k)**2``, squared, with ``sinc(x) = sin(pi x)/(pi x)``.
    """
    k = max(turns, _MIN_TURNS)
    scatter = np.sqrt((1 + np.sinc(2 * k)) / 2 - np.sinc(k) ** 2)
    return float(np.sinc(k) / scatter / 1.96)


def fitted_waves(blocks: np.ndarray, angle: np.ndarray) -> list[Wave]:
    """Fit waves of once (and twice) per turn to a record, its mean beside them.

    Parameters
    ----------
    blocks, angle
        Means of the signal and of the angle [rad] over equal stretches of time (stretch).
    """
    turns = turns_of(angle)
    orders = (1, 2) if turns >= _TURNS_OF_SECOND_ORDER else (1,)
    columns = [f(order * angle) for order in orders for f in (np.cos, np.sin)]
    design = np.stack([np.ones(blocks.size), *columns], axis=1)
    size, *_ = np.linalg.lstsq(design, blocks, rcond=None)
    waves = []
    for order in orders:
        own = slice(2 * order - 1, 2 * order + 1)
        amplitude = float(np.hypot(*size[own]))
        waves.append(Wave(design[:, own] @ size[own], amplitude, order * turns))
    return waves


def stretches_for_many_turns(turns: float, coarse: int, samples: int) -> int:
    """Return how many stretches show the course of many turns, a multiple of the coarse ones.

    Parameters
    ----------
    turns, coarse, samples
        Of a record. 0 where the coarse ones show it, too, or the samples do not.

    Examples
    --------
    >>> stretches_for_many_turns(100.0, 384, 1440), stretches_for_many_turns(10.0, 384, 1440)
    (1152, 0)
    """
    if not turns > coarse / 6:
        return 0
    finer = min(
        math.ceil(_STRETCHES_PER_TURN * turns / coarse), min(samples, _MAX_STRETCHES) // coarse
    )
    return finer * coarse if finer * coarse >= _MIN_STRETCHES_PER_TURN * turns else 0


def in_step(blocks: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return the angle [rad], stretched by up to `MAX_ERROR_OF_SPEED` to where its wave is largest.

    Parameters
    ----------
    blocks, angle
        Means of the signal and of the angle over equal stretches of time (stretch).
    """
    # by a quarter of a turn each
    steps = math.ceil(4 * limits.MAX_ERROR_OF_SPEED.value * turns_of(angle))
    stretched = 1 + np.linspace(
        -limits.MAX_ERROR_OF_SPEED.value, limits.MAX_ERROR_OF_SPEED.value, 2 * steps + 1
    )
    size = np.abs(np.exp(1j * np.outer(stretched, angle)) @ (blocks - blocks.mean()))
    best: np.ndarray = stretched[size.argmax()] * angle
    return best


def turns_of(angle: np.ndarray) -> float:
    """Return the turns of a record, from the angle [rad] of its stretches; NaN if unknown."""
    if angle.size < 2:
        return np.nan
    return float(abs(angle[-1] - angle[0]) / (2 * np.pi) * angle.size / (angle.size - 1))


def turn_remark(turns: float) -> str:
    """Return a remark if less than a turn was recorded; else "".

    Examples
    --------
    >>> turn_remark(0.43)
    'only 0.43 of a turn: what repeats with each turn is not averaged out'
    """
    if not turns < 1:
        return ""
    return f"only {turns:.2g} of a turn: what repeats with each turn is not averaged out"
