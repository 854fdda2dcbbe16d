"""Plateaus of a noisy velocity, found by comparing means over windows of many lengths.

Notes
-----
1. Neighbouring window means are compared at every scale W = 1, 2, 4 ... blocks (moving-sum
   statistic, bottom-up [1]_). A break is where they differ by more than noise and by more than a
   relative `resolution`; a scale adds a break only if no finer scale has one within its window.
2. Neighbouring pieces that one straight line v(t) describes as well as two are merged. A ramp
   thus becomes one steep piece, a plateau with a slow drift one nearly flat piece.
3. A piece is a plateau if its fitted line changes by less than `drift` of its speed.

References
----------
.. [1] Messer et al. (2014), Ann. Appl. Stat. 8, 2027-2067. doi:10.1214/14-AOAS782
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.segments import limits
from tribolab.friction.segments.noise import HEIGHT_DIGITS, LAG_BLOCKS, Noise

# decimals to which costs of mergers are compared: smaller differences are rounding
_COST_DIGITS = 6
# smaller squares of residuals, relative to all squares, are rounding errors
_ROUNDING_OF_SQUARES = 1e-11


class Pieces(NamedTuple):
    """Pieces with a straight line v(t): blocks [first, last), mean, change, and their errors."""

    first: np.ndarray
    last: np.ndarray
    mean: np.ndarray
    change: np.ndarray
    change_error: np.ndarray
    mean_error: np.ndarray


def find_breaks(
    velocity: np.ndarray, noise: Noise, resolution: float, rest_speed: float
) -> np.ndarray:
    """Return the indices of blocks at which the mean velocity changes, at any scale."""
    m = velocity.size
    total = np.concatenate([[0.0], np.cumsum(velocity)])
    breaks = np.zeros(0, dtype=int)
    free = np.zeros(m + 1, dtype=int)  # 1 at a break
    width, memory = 1, 1.0
    while 2 * width <= m:
        k = np.arange(width, m - width + 1, max(1, width // 64))
        before = (total[k] - total[k - width]) / width
        after = (total[k + width] - total[k]) / width
        jump = np.abs(after - before)
        error = np.sqrt((noise.variance(before) + noise.variance(after)) / width)
        larger = np.maximum(np.abs(before), np.abs(after))
        wanted = np.maximum(resolution * larger, rest_speed)
        with np.errstate(divide="ignore", invalid="ignore"):
            score = np.where(jump > 1e-12 * larger, jump / error, 0.0)
        crowd = np.concatenate([[0], np.cumsum(free)])
        clear = crowd[np.minimum(k + width, m + 1)] - crowd[np.maximum(k - width + 1, 0)] == 0
        if clear.any():
            # correlated noise scatters window means more than white noise; wide windows are too few
            # for an estimate, and keep that of the narrower ones
            if 16 * width <= m:
                usual = score[clear][:: 1 + m // 2048]
                usual = usual[np.isfinite(usual)]
                at = k[clear][:: 1 + m // 2048]
                bends = [_bends(total, noise, width, far * width, at) for far in (1, LAG_BLOCKS)]
                if min(usual.size, *(bend.size for bend in bends)) > 16:
                    # a ramp scatters the means as well, but its second differences are zero
                    bent = max(float(median(bend)) for bend in bends)
                    spread = min(float(median(usual)), bent)
                    memory = max(memory, spread / 0.6745)
            hit = clear & (score > limits.MIN_ERRORS_OF_BREAK.value * memory) & (jump > wanted)
            found_now = _peaks(k[hit], (jump[hit] / np.maximum(larger[hit], rest_speed)), width)
            free[found_now] = 1
            breaks = np.concatenate([breaks, found_now])
        width *= 2
    return np.sort(breaks)


def _bends(total: np.ndarray, noise: Noise, width: int, far: int, k: np.ndarray) -> np.ndarray:
    """Return second differences of window means `far` apart, in standard errors; 0 for a ramp."""
    k = k[(k >= far) & (k + far + width < total.size)]
    first, second, third = (
        (total[k + i * far + width] - total[k + i * far]) / width for i in (-1, 0, 1)
    )
    bend = np.abs(first - 2 * second + third)
    larger = np.maximum(np.abs(first), np.abs(third))
    variance = noise.variance(first) + 4 * noise.variance(second) + noise.variance(third)
    with np.errstate(divide="ignore", invalid="ignore"):
        score = np.where(bend > 1e-12 * larger, bend / np.sqrt(variance / width), 0.0)
    return score[np.isfinite(score)]


def _peaks(position: np.ndarray, height: np.ndarray, width: int) -> np.ndarray:
    """Return the positions of the highest peaks that are at least `width` apart."""
    if position.size == 0:
        return position
    if width == 1:
        return position
    # each peak, from the highest on, excludes those close to it; rounding makes the peaks at a
    # start from rest equally high, and the earliest is selected
    order = np.argsort(-np.round(height, HEIGHT_DIGITS), kind="stable")
    taken = np.zeros(position[-1] + width + 2, dtype=bool)
    chosen = []
    for index in order:
        here = position[index]
        if not taken[here]:
            chosen.append(here)
            taken[max(0, here - width + 1) : here + width] = True
    return np.array(chosen, dtype=int)


def _moments(
    time: np.ndarray, velocity: np.ndarray, variance: np.ndarray, starts: np.ndarray
) -> np.ndarray:
    """Return block count, weight, means and centred second moments of pieces (moment, piece)."""
    weight = 1 / variance
    add = np.add.reduceat
    size = np.diff(np.append(starts, time.size))
    total = add(weight, starts)
    t = add(weight * time, starts) / total
    v = add(weight * velocity, starts) / total
    dt, dv = time - np.repeat(t, size), velocity - np.repeat(v, size)
    second = [add(weight * a * b, starts) for a, b in ((dt, dt), (dt, dv), (dv, dv))]
    return np.stack([size.astype(float), total, t, v, *second])


def _merge_moments(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the moments of each pair of pieces after merging the pair."""
    total = a[1] + b[1]
    share = a[1] * b[1] / total
    dt, dv = b[2] - a[2], b[3] - a[3]
    return np.stack(
        [
            a[0] + b[0],
            total,
            (a[1] * a[2] + b[1] * b[2]) / total,
            (a[1] * a[3] + b[1] * b[3]) / total,
            a[4] + b[4] + share * dt * dt,
            a[5] + b[5] + share * dt * dv,
            a[6] + b[6] + share * dv * dv,
        ]
    )


def _misfit(m: np.ndarray) -> np.ndarray:
    """Return the weighted squared residuals of the straight line through a piece."""
    with np.errstate(divide="ignore", invalid="ignore"):
        explained = np.where(m[4] > 0, m[5] ** 2 / m[4], 0.0)
    left = m[6] - explained
    return np.where(left > _ROUNDING_OF_SQUARES * m[6], left, 0.0)


def straight_pieces(
    time: np.ndarray, velocity: np.ndarray, noise: Noise, breaks: np.ndarray, resolution: float
) -> Pieces:
    """Merge neighbouring pieces that one straight line describes as well as two."""
    starts = np.concatenate([[0], breaks])
    # the weight follows the mean of the piece: weights by single readings would bias it to zero
    size = np.diff(np.append(starts, time.size))
    level = np.repeat(np.add.reduceat(velocity, starts) / size, size)
    variance = noise.variance(level) + (1e-4 * level) ** 2
    variance = variance + max((1e-7 * np.max(np.abs(velocity))) ** 2, 1e-60)
    m = _moments(time, velocity, variance, starts)
    while m.shape[1] > 1:
        a, b = m[:, :-1], m[:, 1:]
        left, right, both = _misfit(a), _misfit(b), _misfit(_merge_moments(a, b))
        shorter = np.minimum(a[0], b[0])
        memory = np.maximum(1.0, (left + right) / np.maximum(a[0] + b[0] - 4, 1))
        speed = np.maximum(np.abs(a[3]), np.abs(b[3]))
        # a step s fitted by one line leaves s/4 rms: the limit is a quarter of the resolution
        small = (resolution * speed / 4) ** 2 / (
            noise.variance(speed) + (1e-4 * speed) ** 2 + 1e-60
        )
        cost = (both - left - right) / np.maximum(
            limits.MAX_COST_OF_MERGER.value * memory, shorter * small
        )
        # a line through two samples costs nothing: rounding makes ties merge in temporal order
        cost = np.round(cost, _COST_DIGITS)
        if not (cost < 1).any():
            break
        ahead = np.concatenate([[np.inf], cost[:-1]])
        after = np.concatenate([cost[1:], [np.inf]])
        merge = np.flatnonzero((cost < 1) & (cost <= ahead) & (cost < after))
        if merge.size == 0:
            merge = np.array([int(np.argmin(cost))])
        m[:, merge] = _merge_moments(m[:, merge], m[:, merge + 1])
        m = np.delete(m, merge + 1, axis=1)
        starts = np.delete(starts, merge + 1)
    last = np.append(starts[1:], time.size)
    duration = time[last - 1] - time[starts]
    duration = duration * m[0] / np.maximum(m[0] - 1, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(m[4] > 0, m[5] / m[4], 0.0)
        scatter = np.maximum(1.0, _misfit(m) / np.maximum(m[0] - 2, 1))
        slope_error = np.where(m[4] > 0, np.sqrt(scatter / m[4]), 0.0)
    return Pieces(
        starts, last, m[3], slope * duration, slope_error * duration, np.sqrt(scatter / m[1])
    )
