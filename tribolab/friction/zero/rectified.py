"""Detection of a rectified friction force from its values at the reversals."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.arrays.chunks import anywhere, one_by_one
from tribolab.arrays.medians import median, median_of_known
from tribolab.friction.zero import limits

# standard deviations between the 5th and 95th percentile of normal noise
_PERCENTILE_WIDTH = float(2 * special.ndtri(0.95))


class Pressed:
    """Samples under load; the usual load is computed at the first use.

    Parameters
    ----------
    normal
        Normal force (time); if None, contact is assumed.
    parts
        Samples of each trimmed segment.
    share
        Share of the usual load above which surfaces are in contact.
    """

    def __init__(self, normal: np.ndarray | None, parts: list[slice], share: float) -> None:
        self._normal, self._parts, self._share = normal, parts, share

    @cached_property
    def _least(self) -> float:
        assert self._normal is not None  # checked by `within`
        loads = np.empty(sum(self._normal[part].size for part in self._parts))
        end = 0
        for part in one_by_one(self._parts):
            begin, end = end, end + self._normal[part].size
            np.abs(self._normal[part], out=loads[begin:end])
        return self._share * float(np.nanmedian(loads, overwrite_input=True))

    def within(self, part: slice) -> np.ndarray:
        """Return a mask of an interval's samples that are under load."""
        if self._normal is None:
            return np.ones(len(range(*part.indices(part.stop))), dtype=bool)
        return np.abs(self._normal[part]) > self._least


class ForceTrace(NamedTuple):
    """Force and strokes of a run, from which a lost sign of the force is detected.

    Parameters
    ----------
    force
        The force (time).
    loaded
        Samples under load.
    parts
        Samples of each trimmed segment, in temporal order.
    mean, error
        Mean force of each segment and its standard error (segment).
    sign
        Recorded direction of each segment (segment).
    rest
        Reading of the force in rests without load, NaN without one.
    turned
        Factor applied to the force.
    speed
        Speed of each segment [m/s] (segment), if known.
    """

    force: np.ndarray
    loaded: Pressed
    parts: list[slice]
    mean: np.ndarray
    error: np.ndarray
    sign: np.ndarray
    rest: float
    turned: float = 1.0
    speed: np.ndarray | None = None

    def within(self, part: slice) -> np.ndarray:
        """Return the finite force readings of an index range."""
        force = self.turned * self.force[part]
        return force[np.isfinite(force)]

    def is_below(self, part: slice) -> bool:
        """Return whether all force readings of an index range are below zero."""
        return bool(np.nanmax(self.turned * self.force[part]) < 0)

    def alike(self, number: int) -> bool:
        """Return whether a segment and the next have equal speed, so that they may be a pair."""
        if self.speed is None:
            return True
        slow, fast = sorted(np.abs(self.speed[number : number + 2]).tolist())
        return bool(slow >= (1 - limits.MAX_SPEED_DIFFERENCE_OF_REVERSAL.value) * fast)

    def between(self, number: int) -> np.ndarray:
        """Return the finite readings under load between a segment and the next."""
        gap = slice(self.parts[number].stop, self.parts[number + 1].start)
        force = self.turned * self.force[gap][self.loaded.within(gap)]
        return force[np.isfinite(force)]


class Fold(NamedTuple):
    """Whether the force lost its sign ("signed", "rectified", "undecided"), with the evidence."""

    kind: str
    why: str
    seen: bool = False  # several readings show how the force passes its middle


SIGNED = Fold("signed", "")


def folded(trace: ForceTrace) -> Fold:
    """Decide whether a friction force was recorded without its sign.

    Parameters
    ----------
    trace
        The force and its strokes.

    Returns
    -------
    Fold
        "signed" if the force changes sign with the direction, or goes from one level straight to
        the other without a change of sign: then a large offset is real. "rectified" if it goes to
        zero and back at the reversals, or if unloaded rests show its zero outside the levels of the
        strokes instead of between them. Else "undecided".

    Notes
    -----
    A force F = |s mu N + Z| has the levels mu N + Z and mu N - Z in the two directions, and an
    offset Z > mu N gives Z + mu N and Z - mu N: the half sum of one is the half difference of the
    other. The levels alone cannot distinguish them; the transition between them can.

    Examples
    --------
    >>> force = 9.0 * np.sin(np.linspace(0, 4 * np.pi, 400)).clip(-0.5, 0.5)
    >>> parts = [slice(30, 80), slice(130, 180), slice(230, 280), slice(330, 380)]
    >>> pressed = Pressed(None, parts, 0.5)
    >>> def shown(force):
    ...     mean = np.array([force[part].mean() for part in parts])
    ...     sign, error = np.array([1, -1, 1, -1]), np.full(4, 0.01)
    ...     return folded(ForceTrace(force, pressed, parts, mean, error, sign, np.nan)).kind
    >>> shown(force), shown(np.abs(force)), shown(force + 20)
    ('signed', 'rectified', 'signed')
    """
    known = np.isfinite(trace.mean)
    if known.sum() < 2 or not (known & (trace.sign > 0)).any():
        return SIGNED
    turned = 1.0 if median_of_known(trace.mean) >= 0 else -1.0
    trace = trace._replace(turned=turned, mean=turned * trace.mean, rest=turned * trace.rest)
    # a stroke whose mean is significantly negative, or whose readings all are, shows that the
    # force has its sign
    if (trace.mean[known] < -3 * np.nan_to_num(trace.error[known])).any():
        return SIGNED
    if any(trace.is_below(trace.parts[i]) for i in one_by_one(np.flatnonzero(known))):
        return SIGNED
    if (known & (trace.sign < 0)).any():
        return _decide_two_ways(trace, known)
    return _decide_one_way(trace)


def _decide_two_ways(trace: ForceTrace, known: np.ndarray) -> Fold:
    """Decide from the turns whether the sign was lost, if directions were recorded."""
    forward, backward = (
        np.flatnonzero(known & (trace.sign * direction > 0)) for direction in (1, -1)
    )
    levels = [float(median(trace.mean[which])) for which in (forward, backward)]
    low, high = sorted(levels)
    one_sign = "the friction force has one sign in both directions of sliding"
    if np.isfinite(trace.rest):
        distance = abs(abs(trace.rest) - (high - low) / 2)
        between = abs(trace.rest - (high + low) / 2)
        if between < 0.5 * distance:
            return SIGNED
        if distance < 0.5 * between:
            return Fold("rectified", f"{one_sign}, and rests without load do not lie between them")
    dips, below, straight, clear, seen = _reversals(trace)
    if dips >= limits.MIN_REVERSALS_WITH_DIP.value:
        return Fold(
            "rectified", f"{one_sign}, and goes to zero and back at {dips:.0%} of the turns"
        )
    # standard error of the mean over the strokes of a direction
    strokes = min(forward.size, backward.size)
    error = np.sqrt(np.nanmean(np.nan_to_num(trace.error) ** 2) / strokes)
    differ = high - low > max(limits.MIN_ERRORS_OF_LEVEL.value * error, 1e-6 * high)
    if (
        seen
        and below <= limits.MAX_REVERSALS_WITH_SPIKE.value
        and differ
        and straight >= limits.MIN_REVERSALS_WITH_DIP.value
    ):
        return SIGNED._replace(seen=clear >= limits.MIN_REVERSALS_WITH_DIP.value)
    like = high - low < limits.MAX_DIFFERENCE_OF_LEVELS.value * (high + low) / 2
    why = f"{one_sign}, and the reversals do not show whether it passes through zero"
    return Fold("undecided: alike" if like else "undecided", why)


def _reversals(trace: ForceTrace) -> tuple[float, float, float, float, int]:
    """Return shares of turns (dip, below, straight, clearly straight), and the number of turns.

    "Dip" and "below" are readings far below both levels. A turn is "straight" if it has readings
    between the two levels, beyond their noise, and none below them; if the levels overlap, at least
    ten readings. "Clearly straight" requires several readings.
    """
    dips, below, straight, clear, seen = 0, 0, 0, 0, 0
    for i in one_by_one(range(len(trace.parts) - 1)):
        if trace.sign[i] * trace.sign[i + 1] > 0 and (trace.sign < 0).any():
            continue
        turn = trace.between(i)
        first, second = (trace.within(part) for part in trace.parts[i : i + 2])
        if turn.size < 3 or first.size < 3 or second.size < 3:
            continue
        seen += 1
        ends = sorted(
            (np.percentile(part, [5, 95]) for part in (first, second)), key=lambda e: e[0]
        )
        (low, top), (bottom, highest) = ends
        dip = bool(turn.min() < limits.MAX_LEVEL_OF_DIP.value * low)
        dips += dip
        if (
            dip
            or 0
            < np.count_nonzero(turn < low - limits.MIN_DEPTH_OF_DIP.value * (top - low))
            <= limits.MAX_READINGS_OF_DIP.value
        ):
            below += 1
        elif top < bottom:
            # readings between the levels, too far from either to be noise of that level
            far = _noise_quantile(turn.size) / _PERCENTILE_WIDTH
            above = (low + top) / 2 + far * (top - low)
            beneath = (bottom + highest) / 2 - far * (highest - bottom)
            on_the_way = int(np.count_nonzero((turn > above) & (turn < beneath)))
            straight += on_the_way > 0
            clear += on_the_way >= limits.MIN_READINGS_BETWEEN_LEVELS.value
        else:
            straight += turn.size >= 10
    if not seen:
        return 0.0, 0.0, 0.0, 0.0, 0
    return dips / seen, below / seen, straight / seen, clear / seen, seen


def _noise_quantile(count: int) -> float:
    """Return how many standard deviations the largest of `count` readings may deviate by chance."""
    return float(special.ndtri(1 - limits.NOISE_PASSES.value / count))


def _decide_one_way(trace: ForceTrace) -> Fold:
    """Decide from the turns whether the sign was lost, if no direction was recorded."""
    if len(trace.parts) < 2 or anywhere(lambda part: _negative(trace.turned * part), trace.force):
        return SIGNED
    level = float(median_of_known(trace.mean))
    if np.isfinite(trace.rest) and abs(trace.rest) > 0.02 * level:
        odd, even = np.nanmean(trace.mean[::2]), np.nanmean(trace.mean[1::2])
        error = np.sqrt(np.nanmean(np.nan_to_num(trace.error) ** 2))
        apart = abs(odd - even)
        if (
            apart > limits.MIN_ERRORS_OF_LEVEL.value * error
            and abs(apart - 2 * abs(trace.rest)) < 0.3 * apart
        ):
            why = "strokes are by turns above and below their mean by what rests without load read"
            return Fold("rectified", why)
        return SIGNED
    # only turns between strokes of equal speed, as a start at another speed is no reversal
    turns = (i for i in range(len(trace.parts) - 1) if trace.alike(i))
    stops = (_touches_zero(trace, i) for i in turns)
    touched = [touches for touches in stops if touches is not None]
    dips = sum(touched) / len(touched) if touched else 0.0
    if dips >= limits.MIN_REVERSALS_WITH_DIP.value:
        why = (
            f"neither speed nor force has a sign, and the force goes to zero at {dips:.0%} of the "
            "stops and never below it"
        )
        return Fold("rectified", why)
    return SIGNED


def _negative(force: np.ndarray) -> np.ndarray:
    return (force < 0) & np.isfinite(force)


def _touches_zero(trace: ForceTrace, number: int) -> bool | None:
    """Return whether the force reaches zero between two strokes, within noise and resolution."""
    turn, stroke = trace.between(number), trace.within(trace.parts[number])
    if turn.size < 3 or stroke.size < 3:
        return None
    lowest = int(np.argmin(turn))
    # a V has three large steps among the four around its minimum, a flat stop at most two
    steps = np.sort(np.abs(np.diff(turn[max(lowest - 2, 0) : lowest + 3])))
    # noise from differences between neighbours, which slow waves do not affect
    noise = median(np.abs(np.diff(stroke))) / 0.954
    return bool(turn[lowest] < max(limits.MAX_ERRORS_OF_TOUCH.value * noise, steps[1]))
