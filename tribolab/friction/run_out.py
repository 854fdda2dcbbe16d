"""Waves that repeat with each turn of a rig, and their effect on means over incomplete turns.

Notes
-----
Run-out of a disc changes friction once (and twice) per turn. Over whole turns this cancels, however
few they are; in a spectrum, one or two turns look like slow drift. If the rotation is recorded, the
waves are fitted at its angle [1]_. The error of the mean is that of the residuals combined with the
effect of a wave of this size, at any phase, on the mean over an incomplete turn, ``A abs(sin(pi k)
/ (pi k)) / sqrt(2)`` after k turns. A wave is accepted if it is far above the residual spectrum.

If there are more than a sixth as many turns as intervals in a record, the intervals do not resolve
the wave, and its remainder looks like a line that hides slow noise. Then the waves are fitted to
shorter intervals, `_STRETCHES_PER_TURN` per turn, and subtracted whether significant or not: they
hardly change the mean. If the recorded speed is wrong by up to `MAX_ERROR_OF_SPEED`, the wave would
lose phase over many turns; the angle is stretched to maximise the wave.

Less than a turn determines neither the size of the wave nor its mean: the error is increased to the
worst case, a part of a turn around a crest.

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

MAX_COARSE_TURNS = 64.0  # most turns in a record for which the usual intervals are fine enough
_TURNS_OF_SECOND_ORDER = 2.0  # fewest turns for which a wave with two periods per turn is fitted
_MIN_TURNS = 0.25  # a smaller part of a turn is treated like this one
# usual and smallest number of intervals per turn, for many turns
_STRETCHES_PER_TURN, _MIN_STRETCHES_PER_TURN = 8, 4
# most such intervals; 16 of them are then averaged in each usual interval
_MAX_STRETCHES = 6144


class Wave(NamedTuple):
    """Wave with a whole number of periods per turn, fitted to a record."""

    signal: np.ndarray  # over the record's intervals, in the signal's unit
    amplitude: float
    turns: float  # periods in the record: the turns of the rig, or twice as many

    @property
    def left(self) -> float:
        """Standard error that an incomplete turn leaves in the mean, averaged over the phase."""
        return float(self.amplitude * abs(np.sinc(self.turns)) / np.sqrt(2))

    def exceeds_spectrum(self, power: np.ndarray) -> bool:
        """Return whether the wave is far above the spectrum `power` of the residuals."""
        count = self.signal.size
        cycles = np.linspace(0, count / 2, power.size)
        neighbours = power[(cycles >= self.turns / 2) & (cycles <= 2 * self.turns)]
        return bool(
            self.signal @ self.signal / 2 > limits.MIN_WAVE_OVER_SPECTRUM.value * neighbours.max()
        )


def turned(time: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Return the angle that a rig has turned since the first sample.

    Parameters
    ----------
    time, speed
        Times [s] and rotation speed [rad/s] (time).

    Returns
    -------
    numpy.ndarray
        Angle [rad] (time); all NaN if a speed is missing.

    Examples
    --------
    >>> turned(np.array([0.0, 1.0, 3.0]), np.array([2.0, 2.0, 4.0])).tolist()
    [0.0, 2.0, 8.0]
    """
    angle = np.zeros(time.size)
    np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time), out=angle[1:])
    return angle if np.isfinite(angle[-1:]).all() else np.full(time.size, np.nan)


def hidden_by_part(turns: float) -> float:
    """Return the standard error of a mean over less than one turn, relative to the scatter in it.

    Notes
    -----
    In the worst case the record is centred on a crest of the wave: its mean deviates by sinc(k)
    amplitudes, which are 1.96 standard errors, and its variance is ``(1 + sinc(2 k))/2 -
    sinc(k)**2`` with ``sinc(x) = sin(pi x)/(pi x)``.
    """
    k = max(turns, _MIN_TURNS)
    scatter = np.sqrt((1 + np.sinc(2 * k)) / 2 - np.sinc(k) ** 2)
    return float(np.sinc(k) / scatter / 1.96)


def fitted_waves(blocks: np.ndarray, angle: np.ndarray) -> list[Wave]:
    """Return the waves with one (and two) periods per turn that fit a record best.

    Parameters
    ----------
    blocks, angle
        Means of the signal and of the angle [rad] over equal time intervals (stretch).
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
    """Return how many intervals resolve the waves of many turns: a multiple of the coarse ones.

    Parameters
    ----------
    turns, coarse, samples
        Numbers of turns, coarse intervals and samples of a record. The result is 0 if the coarse
        intervals resolve the turns, or the samples do not.

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
    """Return the angle [rad], stretched by up to `MAX_ERROR_OF_SPEED` to maximise the fitted wave.

    Parameters are those of `fitted_waves`.
    """
    # from step to step the total angle changes by a quarter turn
    steps = math.ceil(4 * limits.MAX_ERROR_OF_SPEED.value * turns_of(angle))
    stretched = 1 + np.linspace(
        -limits.MAX_ERROR_OF_SPEED.value, limits.MAX_ERROR_OF_SPEED.value, 2 * steps + 1
    )
    size = np.abs(np.exp(1j * np.outer(stretched, angle)) @ (blocks - blocks.mean()))
    best: np.ndarray = stretched[size.argmax()] * angle
    return best


def turns_of(angle: np.ndarray) -> float:
    """Return the turns of a record, from the angle [rad] of its intervals; NaN if unknown."""
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
