"""Zero of a force, and its drift, from the middles of friction loops (pairs of strokes)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.friction.zero import limits
from tribolab.friction.zero.offsets import Wander, wander


class Middles(NamedTuple):
    """Middles of the friction loops, and drift of the zero, for pairs of strokes in temporal order.

    Parameters
    ----------
    member
        Indices of the forward and the backward stroke (pair, 2).
    share
        Weights of their forces in the middle [1] (pair, 2).
    time, value
        Time [s] and middle of each loop (pair).
    slope
        Drift of the zero at each pair, per second (pair).
    ends, part
        Pairs between which the slope was taken (pair, 2), and share of it that is used (pair).
    """

    member: np.ndarray
    share: np.ndarray
    time: np.ndarray
    value: np.ndarray
    slope: np.ndarray
    ends: np.ndarray
    part: np.ndarray


def middles(
    mean: np.ndarray, load: np.ndarray, sign: np.ndarray, pair: np.ndarray, time: np.ndarray
) -> Middles | None:
    """Return the middle of each pair's friction loop and the drift there; None without a pair.

    Parameters
    ----------
    mean, load, sign, pair, time
        Mean force, mean normal force (or one for all), direction, number of the pair (-1 for none)
        and time [s] of each segment.

    Notes
    -----
    With F_f = mu N_f + Z(t_f) and F_b = -mu N_b + Z(t_b) the sum (F_f N_b + F_b N_f)/(N_f + N_b) is
    Z at the time (t_f N_b + t_b N_f)/(N_f + N_b), exactly for a linear drift: a change of load
    between the strokes is not mistaken for an offset. The slope at a pair is that from the pair
    before to the pair after, no steeper than twice either of the two parts and zero if these differ
    in sign: a zero that jumps once does not drift.

    Examples
    --------
    >>> time = np.arange(6.0)
    >>> sign = np.array([1, -1, 1, -1, 1, -1])
    >>> found = middles(9.0 * sign + 0.5 * time, np.ones(6), sign, np.arange(6) // 2, time)
    >>> found.value.tolist(), found.slope.tolist()
    ([0.25, 1.25, 2.25], [0.5, 0.5, 0.5])
    """
    count = pair.max(initial=-1) + 1
    if count == 0:
        return None
    member = np.empty((count, 2), dtype=int)
    for column, which in enumerate((1, -1)):
        chosen = np.flatnonzero((pair >= 0) & (sign == which))
        member[pair[chosen], column] = chosen
    both = load[member]
    share = both[:, ::-1] / both.sum(axis=1, keepdims=True)
    value = (share * mean[member]).sum(axis=1)
    when = (share * time[member]).sum(axis=1)
    known = np.flatnonzero(np.isfinite(value))
    slope, part = np.zeros(count), np.zeros(count)
    ends = np.repeat(np.arange(count)[:, None], 2, axis=1)
    if known.size > 1:
        t, m = when[known], value[known]
        step = np.diff(m) / np.diff(t)
        before, after = np.append(step[0], step), np.append(step, step[-1])
        place = np.arange(known.size)
        low, high = np.maximum(place - 1, 0), np.minimum(place + 1, known.size - 1)
        chord = (m[high] - m[low]) / (t[high] - t[low])
        # the first and the last pair have the slope of the interval next to them
        if known.size > 2:
            before[0], after[-1] = step[1], step[-2]
        limit = np.where(before * after > 0, np.minimum(np.abs(before), np.abs(after)), 0.0)
        limited = np.sign(chord) * np.minimum(
            np.abs(chord), limits.MAX_SLOPE_OF_DRIFT.value * limit
        )
        slope[known] = limited
        part[known] = np.where(chord != 0, limited / np.where(chord != 0, chord, 1), 0.0)
        ends[known, 0], ends[known, 1] = known[low], known[high]
    return Middles(member, share, when, value, slope, ends, part)


class StrokeSums(NamedTuple):
    """Each force minus its zero, as a weighted sum over strokes (segment, term)."""

    stroke: np.ndarray
    weight: np.ndarray


def interpolated(
    middles: Middles, pair: np.ndarray, time: np.ndarray
) -> tuple[np.ndarray, np.ndarray, StrokeSums]:
    """Return zero and drift at each segment, interpolated between the middles of the loops.

    Returns
    -------
    tuple
        Zero of each segment (segment) in the unit u of the middles, its drift [u/s] (segment), and
        the strokes that contribute to each force without its zero. A stroke of a pair uses the
        middle and slope of its own loop; a stroke before all loops uses the first one, a stroke
        after all the last one; a stroke between two loops uses the straight line between them.
    """
    count = time.size
    known = np.flatnonzero(np.isfinite(middles.value))
    order = known[np.argsort(middles.time[known])]
    loop, weight = np.zeros((count, 3), dtype=int), np.zeros((count, 3))
    slope = np.zeros(count)
    for i in range(count):
        p = pair[i]
        if p < 0 and order.size:
            after = int(np.searchsorted(middles.time[order], time[i]))
            if 0 < after < order.size:
                a, b = order[after - 1], order[after]
                u = (time[i] - middles.time[a]) / (middles.time[b] - middles.time[a])
                loop[i], weight[i] = (a, b, b), (1 - u, u, 0.0)
                slope[i] = (middles.value[b] - middles.value[a]) / (
                    middles.time[b] - middles.time[a]
                )
                continue
            p = order[min(after, order.size - 1)]
        a, b = middles.ends[p]
        apart = middles.time[b] - middles.time[a]
        ahead = middles.part[p] * (time[i] - middles.time[p]) / apart if apart > 0 else 0.0
        loop[i], weight[i] = (p, a, b), (1.0, -ahead, ahead)
        slope[i] = middles.slope[p]
    value = (weight * np.where(weight != 0, middles.value[loop], 0.0)).sum(axis=1)
    own = np.arange(count)[:, None]
    stroke = np.concatenate([own, middles.member[loop].reshape(count, 6)], axis=1)
    of_loops = -(weight[:, :, None] * middles.share[loop]).reshape(count, 6)
    return value, slope, StrokeSums(stroke, np.concatenate([np.ones((count, 1)), of_loops], axis=1))


def error_of_rows(
    rows: StrokeSums, middles: Middles, own: np.ndarray, time: np.ndarray
) -> np.ndarray:
    """Return the standard error of each segment's force minus its zero.

    Parameters
    ----------
    rows, middles
        From `interpolated` and `middles`.
    own
        Standard error of the mean force of each stroke (segment).
    time
        Time of each stroke [s] (segment).

    Notes
    -----
    The variance of a sum over strokes includes their own errors, or fast fluctuations of the zero
    (independent at every stroke) if larger: a long stroke includes them in its own error. It also
    includes the random walk of the zero, <Z(t) Z(t')> = D min(t, t'). Both are estimated from the
    scatter of the middles beyond their errors and a common drift.
    """
    error = np.sqrt(((middles.share * own[middles.member]) ** 2).sum(axis=1))
    same = rows.stroke[:, :, None] == rows.stroke[:, None, :]
    product = rows.weight[:, :, None] * rows.weight[:, None, :]
    squares = np.nan_to_num(own)[rows.stroke] ** 2
    variance = (product * same * squares[:, :, None]).sum(axis=(1, 2))
    variance = np.where(np.isfinite(own), variance, np.nan)
    fast = (product * same).sum(axis=(1, 2))
    when = time[rows.stroke]
    when = when - when.min(axis=1, keepdims=True)
    walk = np.minimum(when[:, :, None], when[:, None, :])
    slow = np.maximum((product * walk).sum(axis=(1, 2)), 0.0)
    # the smaller of both, because few loops hardly determine a common drift
    moved = [
        np.maximum(variance, moves.fast * fast) + moves.rate * slow
        for moves in _movements(middles, error)
    ]
    return np.sqrt(np.minimum(*moved))


def _movements(middles: Middles, error: np.ndarray) -> tuple[Wander, Wander]:
    """Return the drift of the zero between loops: total, and beyond a common linear drift."""
    order = np.flatnonzero(np.isfinite(middles.value))
    order = order[np.argsort(middles.time[order], kind="stable")]
    value, error, time = middles.value[order], error[order], middles.time[order]
    plain = wander(value, error, time)
    if order.size < 3:
        return plain, plain
    level = value - (value[-1] - value[0]) / (time[-1] - time[0]) * (time - time[0])
    freedom = (order.size - 1) / (order.size - 2)
    beyond = wander(level, error, time)
    return plain, Wander(freedom * beyond.fast, freedom * beyond.rate)
