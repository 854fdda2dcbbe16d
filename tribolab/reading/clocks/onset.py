"""Fine adjustment of two clocks by the onsets of sliding.

Friction does not reverse immediately at the start of a stroke, but over a distance: sorted by
velocity only, force samples seem to be late. So the start of each stroke is fitted by

    F(t) = a + b exp(-s(t - shift) / d),

with s the distance since the start of the stroke (0 before it), a and b free, and d the best of a
few distances. All strokes share the shift, with the negative log likelihood

    L(shift) = sum_i n_i / 2 log RSS_i(shift).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits

_COMPARED_PART = 0.05  # share of a stroke's length that is fitted, with equal time before it
_STICK_DISTANCES = 17  # number of trial distances d; each is twice the previous one
_LONGEST_STICK = 1e-6 * 2.0 ** (_STICK_DISTANCES - 1)  # longest d, as a share of the stroke length
_SEARCHED_TIME = 0.3  # share of the duration of fast strokes (or rests) that is searched
_MAX_SAMPLES = 5000  # most samples of one start; longer, slow starts are not informative


class Sharpened(NamedTuple):
    """Shift [s], its uncertainty [s], and the mean time [s, motion clock] to which it refers."""

    shift: float
    uncertainty: float
    time: float


class Onset(NamedTuple):
    """Start of one stroke: force against its clock, distance [m] against the motion clock."""

    time: Array
    force: Array
    motion_time: Array
    distance: Array
    length: float


def refine_by_onsets(
    force_time: Array,
    force: Array,
    motion_time: Array,
    velocity: Array,
    shift: float,
    period: float,
) -> Sharpened | None:
    """Refine the shift between two clocks by the starts of strokes.

    Parameters
    ----------
    force_time, force
        Force log: its own clock [s] and the friction force.
    motion_time, velocity
        Motion log: its own clock [s] and the signed velocity [m/s].
    shift
        First estimate: motion clock + shift = force clock [s].
    period
        Sampling interval [s] where it is shortest; half of it limits the resolution.

    Returns
    -------
    Sharpened or None
        None if no start of a stroke is found, or they show no clear shift near the first estimate.
    """
    onsets, half_width = _onsets(force_time, force, motion_time, velocity, shift)
    if not onsets:
        return None
    centre, half = shift, half_width
    while half > 0.5 * period:
        shifts = centre + half * np.linspace(-1.0, 1.0, 41)
        centre = float(shifts[np.argmin(_misfit(onsets, shifts))])
        half /= 8.0
    if abs(centre - shift) > 0.98 * half_width:
        return None
    steps = period * np.concatenate([[0.0], 0.5 * 1.25 ** np.arange(30)])
    steps = steps[steps <= half_width]
    left, right = (_misfit(onsets, centre + sign * steps) for sign in (-1.0, 1.0))
    if min(left.max(), right.max()) - left[0] < limits.MIN_PEAK_OF_LIKELIHOOD.value:
        return None
    risen = np.flatnonzero(
        np.minimum(left, right)[1:] - left[0] > limits.LIKELIHOOD_AT_UNCERTAINTY.value
    )
    if risen.size == 0:
        return None
    when = float(np.mean([onset.motion_time[0] for onset in onsets]))
    return Sharpened(centre, float(steps[1 + risen[0]]), when)


def _onsets(
    force_time: Array, force: Array, motion_time: Array, velocity: Array, shift: float
) -> tuple[list[Onset], float]:
    """Return the starts of fast strokes, and the half width [s] of the search around `shift`."""
    speed = np.abs(np.nan_to_num(velocity))
    moving = speed > 1e-5 * speed.max()
    edges = np.flatnonzero(np.diff(np.concatenate([[0], moving.astype(np.int8), [0]])))
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(motion_time))])
    lengths = way[edges[1::2] - 1] - way[edges[::2]]
    strokes = lengths > limits.MIN_LENGTH_OF_STROKE.value * lengths.max(initial=0.0)
    firsts, lasts = edges[::2][strokes], edges[1::2][strokes]
    fast = np.array(
        [
            first > 1 and speed[first:last].max() > limits.MIN_SPEED_OF_ONSET.value * speed.max()
            for first, last in zip(firsts, lasts, strict=True)
        ]
    )
    if not fast.any():
        return [], 0.0
    rested = motion_time[firsts - 1] - motion_time[np.concatenate([[0], lasts[:-1]])]
    lasted = motion_time[lasts - 1] - motion_time[firsts]
    half_width = _SEARCHED_TIME * float(median(np.minimum(rested, lasted)[fast]))
    onsets = []
    for first, last, rest in zip(firsts[fast], lasts[fast], rested[fast], strict=True):
        distance = way[first - 1 : last] - way[first - 1]
        begin = motion_time[first - 1]
        until = motion_time[
            first - 1 + int(np.searchsorted(distance, _COMPARED_PART * distance[-1]))
        ]
        before = max(min(until - begin, rest - 2.0 * half_width), 0.0) + half_width
        ends = [begin - before, until + half_width]
        window = slice(*np.searchsorted(force_time - shift, ends))
        if 8 <= window.stop - window.start <= _MAX_SAMPLES and np.ptp(force[window]) > 0:
            onsets.append(
                Onset(
                    force_time[window],
                    force[window],
                    motion_time[first - 1 : last],
                    distance,
                    float(distance[-1]),
                )
            )
    return onsets, half_width


def _misfit(onsets: list[Onset], shifts: Array) -> Array:
    """Return the negative log likelihood L of each shift."""
    total = np.zeros(len(shifts))
    for onset in onsets:
        way = np.interp(onset.time - shifts[:, None], onset.motion_time, onset.distance)
        left = np.full(len(shifts), np.inf)
        n, force = len(onset.force), onset.force - onset.force.mean()
        square = float(force @ force)
        drift = np.stack([force, np.ones(n)], axis=1)
        rise = np.exp(way * (-1.0 / (_LONGEST_STICK * onset.length)))
        for _ in range(_STICK_DISTANCES):
            explained, whole = (rise @ drift).T
            norm = np.maximum(np.einsum("sn,sn->s", rise, rise) - whole**2 / n, 1e-12)
            left = np.minimum(left, square - explained**2 / norm)
            np.square(rise, out=rise)  # the square of the exponential has half the distance d
        total += 0.5 * n * np.log(np.maximum(left, 1e-9 * square + 1e-30))
    return total
