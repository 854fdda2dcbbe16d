"""All significant oscillations of a record, each with its own frequency."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.oscillation import gather
from tribolab.friction.oscillation.spectrum.survey import Survey

_MAX_HARMONIC = 16  # highest harmonic that is examined on its own
# surroundings of a line: from its frequency divided by a factor to its frequency times the factor
_SURROUNDINGS = (1.15, 1.5)
_WINDOW_BINS = 0.8  # width of a line due to the window, in bins


class Component(NamedTuple):
    """One oscillation: frequency and its error [Hz], swing (in the signal's unit), p value."""

    frequency: float
    frequency_error: float
    swing: float
    false_alarm: float


def components(seen: Survey) -> tuple[Component, ...]:
    """Find all significant oscillations, the strongest first.

    Parameters
    ----------
    seen
        From `tribolab.friction.oscillation.spectrum.survey.survey`.

    Notes
    -----
    The strongest is removed from the spectrum with its harmonics, whose width grows as the square
    of their number [1]_, then the search is repeated. Harmonics no stronger than those of a
    sawtooth are not listed. A second line must also exceed its surroundings significantly: the
    spectrum of an irregular wave is ragged, but has no such line.

    References
    ----------
    .. [1] Stratonovich (1967), Topics in the Theory of Random Noise, vol. 2.
    """
    lines: list[Component] = []
    strongest = 0.0
    whole, taken = seen, np.zeros(seen.fine.frequency.size, bool)
    core = taken.copy()
    for _ in range(4 * limits.MAX_LINES.value):
        strong = np.where(
            seen.significant & (seen.cycles >= limits.MIN_CYCLES_IN_RECORD.value), seen.excess, 0.0
        )
        if not strong.any() or len(lines) == limits.MAX_LINES.value:
            break
        top = int(np.argmax(strong))
        stop = seen.first[top + 1] if top + 1 < seen.first.size else seen.fine.frequency.size
        at = int(seen.first[top] + np.argmax(seen.fine.power[seen.first[top] : stop]))
        level = np.interp(seen.fine.frequency, seen.middle, seen.background)
        frequency, error, powers = gather(seen.fine, level, at)
        own = float(powers[0])
        narrow = not lines or _exceeds_neighbours(whole, core, at)
        spread = _spread(seen, level, frequency)
        near = np.abs(seen.fine.frequency / frequency - 1) < 0.15
        near[seen.first[top] : stop] = True
        if narrow and own > limits.MIN_VARIANCE_OF_LINE.value * strongest:
            swing = float(np.sqrt(8 * own))
            alarm = float(max(seen.chance[top], seen.rise[top]))
            lines.append(Component(frequency, error, swing, alarm))
            strongest = max(strongest, own)
            near |= _harmonics(seen, level, frequency, own, spread)
            core |= _line(whole, at)
        taken |= near
        seen = seen.without(taken)
    lines.sort(key=lambda line: -line.swing)
    return tuple(lines if _dominate_surroundings(whole, core, lines) else lines[:1])


def _line(seen: Survey, at: int) -> np.ndarray:
    """Return a mask of the bins that a narrow line covers (bin)."""
    f = seen.fine.frequency
    return np.abs(f - f[at]) <= max(limits.WIDTH_OF_LINE.value * f[at], 2.01 * seen.fine.width[at])


def _dominate_surroundings(seen: Survey, core: np.ndarray, lines: list[Component]) -> bool:
    """Return whether lines are narrow: they contain most of the power near them."""
    if len(lines) < 2:
        return True
    f = seen.fine.frequency
    level = np.interp(f, seen.middle, seen.background)
    excess = np.maximum(seen.fine.power - level, 0) * seen.fine.width
    own = [line.frequency for line in lines]
    around = (f > min(own) / _SURROUNDINGS[1]) & (f < max(own) * _SURROUNDINGS[1])
    return bool(excess[core].sum() > limits.MIN_POWER_IN_LINES.value * excess[around].sum())


def _spread(seen: Survey, level: np.ndarray, frequency: float) -> float:
    """Return the width of a spectral line [Hz]: standard deviation of its power in frequency."""
    f = seen.fine.frequency
    near = np.abs(f / frequency - 1) < 0.15
    weight = np.maximum(seen.fine.power - level, 0)[near]
    if not weight.sum() > 0:
        return 0.0
    variance = (f[near] - frequency) ** 2 @ weight / weight.sum()
    # minus the width due to the window
    return float(np.sqrt(max(variance - (_WINDOW_BINS * seen.fine.width[0]) ** 2, 0.0)))


def _harmonics(
    seen: Survey, level: np.ndarray, frequency: float, own: float, spread: float
) -> np.ndarray:
    """Return a mask of the bins of a line's harmonics, if no stronger than in a sawtooth (bin)."""
    f = seen.fine.frequency
    width = float(seen.fine.width[0])
    excess = np.maximum(seen.fine.power - level, 0) * seen.fine.width
    covered = np.zeros(f.size, bool)
    for k in range(2, min(int(f[-1] / frequency), _MAX_HARMONIC) + 2):
        reach = min(max(3 * k * k * spread, 3 * width, 0.03 * k * frequency), 0.5 * frequency)
        part = np.abs(f - k * frequency) <= reach
        if excess[part].sum() <= limits.MAX_POWER_OF_HARMONIC.value * own / k**2:
            covered |= part
        if reach >= 0.5 * frequency or k > _MAX_HARMONIC:  # from here on the harmonics overlap
            beyond = f > (k - 0.5) * frequency
            if excess[beyond].sum() <= limits.MAX_POWER_OF_HARMONIC.value * own * (1 / (k - 0.5)):
                return covered | beyond
    return covered


def _exceeds_neighbours(seen: Survey, core: np.ndarray, at: int) -> bool:
    """Return whether a bin exceeds its neighbours significantly."""
    f, power = seen.fine.frequency, seen.fine.power
    neighbours = ~core & ~_line(seen, at)
    levels = [np.interp(f[at], seen.middle, seen.background)]
    for factor in _SURROUNDINGS:
        part = neighbours & (f > f[at] / factor) & (f < f[at] * factor)
        if part.sum() > 2:
            levels.append(power[part].mean())
    half = seen.fine.freedom[at] / 2
    single = special.gammaincc(half, half * power[at] / max(levels))
    return bool(single * f.size < limits.LINE_BY_CHANCE.value)
