"""Plateaus of a noisy velocity, from blocks at many scales.

Works on arrays of velocity, independent of files and forces.

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

from tribolab.arrays.chunks import pieces
from tribolab.arrays.medians import median
from tribolab.arrays.scratch import room
from tribolab.friction.segments import limits

_LAG_BLOCKS = 4  # distance of blocks, or windows, at which short-correlated noise is independent
_HEIGHT_DIGITS = 9  # digits of a peak height: breaks that differ by less are equally high
_COST_DIGITS = 6  # digits of a cost: mergers that differ by less have equal cost
_ROUNDING_OF_SQUARES = 1e-11  # relative to the squares: smaller residuals of a line are rounding


class Noise(NamedTuple):
    """Noise of one block: standard deviation sqrt(floor^2 + (r(v) * v)^2).

    `speed` [m/s] ascends, and `relative` is r at these speeds; between them r is interpolated over
    the logarithm of speed.
    """

    floor: float
    speed: np.ndarray
    relative: np.ndarray

    def variance(self, velocity: np.ndarray | float) -> np.ndarray:
        """Return the variance of one block at a velocity."""
        if not self.speed.size:
            return np.full(np.shape(velocity), self.floor**2)
        size = np.abs(velocity)
        place = np.log(np.maximum(size, self.speed[0]))
        share = np.interp(place, np.log(self.speed), self.relative)
        return self.floor**2 + (share * size) ** 2

    def scaled(self, factor: float) -> Noise:
        """Return the noise of larger or smaller blocks."""
        return Noise(self.floor * factor, self.speed, self.relative * factor)


class Pieces(NamedTuple):
    """Straight pieces of the block series: [first, last) blocks, mean, change along the line."""

    first: np.ndarray
    last: np.ndarray
    mean: np.ndarray
    change: np.ndarray
    change_error: np.ndarray
    mean_error: np.ndarray


def running_median(values: np.ndarray) -> np.ndarray:
    """Return the running median of five samples, which removes spikes and preserves edges."""
    if values.size < 5:
        return values
    median = room(values.size)
    ends = values[:1].repeat(2), values[-1:].repeat(2)
    for first, last in pieces(0, values.size):
        before = ends[0][first:] if first < 2 else ends[0][:0]
        after = ends[1][values.size - last :] if last > values.size - 2 else ends[1][:0]
        near = values[max(first - 2, 0) : last + 2]
        padded = np.concatenate([before, near, after])
        stack = np.stack([padded[i : i + last - first] for i in range(5)])
        median[first:last] = np.partition(stack, 2, axis=0)[2]
    return median


def quantum(values: np.ndarray) -> float:
    """Return the step of quantised readings; 0 if not quantised."""
    some = values[:: 1 + values.size // 8192]
    levels = np.unique(some)
    if levels.size < 2 or 2 * levels.size > some.size:
        return 0.0
    gaps = np.diff(levels)
    # values that differ only in the last digit are one level
    gaps = gaps[gaps > 1e-9 * np.abs(levels).max()]
    return float(gaps.min()) if gaps.size else 0.0


def is_commanded(velocity: np.ndarray, step: float) -> bool:
    """Return whether a velocity is a set-point and not a rounded reading.

    Parameters
    ----------
    velocity
        Finite readings [m/s].
    step
        From `quantum` [m/s].

    Notes
    -----
    A rounded reading of a slow change increases digit by digit. A set-point is constant for a long
    time and jumps from level to level.

    Examples
    --------
    >>> commanded = np.repeat([0.0, 2.0, 0.0, -2.0, 0.0, 2.0], 100)
    >>> read = np.round(np.linspace(0, 10, 600))
    >>> [is_commanded(values, quantum(values)) for values in (commanded, read)]
    [True, False]
    """
    if not step > 0:
        return False
    jumps, sizes = [np.zeros(0)], [np.zeros(0)]
    count = 0
    for first, last in pieces(0, velocity.size):
        own = np.abs(np.diff(velocity[max(first - 1, 0) : last]))
        jumps.append(own[own > 0.5 * step])
        count += jumps[-1].size
        if count * limits.MIN_SAMPLES_OF_COMMAND.value > velocity.size:
            return False
        sizes.append(np.unique(np.round(np.abs(velocity[first:last]) / step)))
    size = np.unique(np.concatenate(sizes))
    return (
        size[size > 0].size == 1
        or float(median(np.concatenate(jumps))) >= limits.MIN_DIGITS_OF_COMMAND.value * step
    )


def estimate_noise(velocity: np.ndarray, least: float = 0.0) -> Noise:
    """Estimate the absolute floor and the relative part of the noise from neighbouring blocks.

    The spread of differences is estimated per quarter decade of speed, because a floor that is
    negligible at high speed may dominate at the lowest. The floor is no lower than `least` [m/s].
    """
    middle, difference, near, bend = _differences(velocity)
    nothing = np.zeros(0)
    top = float(middle.max()) if middle.size else 0.0
    if top == 0:
        return Noise(least, nothing, nothing)
    # offset: the highest speed, and whole decades below it, are not at the edge of a bin
    bins = np.floor(4 * np.log10(np.maximum(middle / top, 1e-8)) + 1e-6).astype(int)
    levels = []
    for group in np.unique(bins):
        inside = bins == group
        if np.count_nonzero(inside) >= 8:
            # a ramp has first differences, but no second ones; correlated noise has small second
            # differences between neighbours, but larger ones between distant blocks; digits repeat,
            # and hide at one of the distances
            spread = max(
                _spread(near[inside]), min(_spread(difference[inside]), _spread(bend[inside]))
            )
            share = np.count_nonzero(inside) / middle.size
            levels.append((median(middle[inside]), spread, share))
    if not levels:
        usual = max(median(near), min(median(difference), median(bend)))
        floor = max(float(usual / 0.6745), least)
        return Noise(floor, nothing, nothing)
    speed, spread, share = np.array(levels).T
    floor = max(float(spread.min()), least)
    known = speed > 3 * least
    if not known.any():
        return Noise(floor, nothing, nothing)
    speed, spread, share = speed[known], spread[known], share[known]
    relative = np.sqrt(np.maximum(spread**2 - floor**2, 0)) / speed
    # bins with few blocks are ramps, reversals or a short plateau: no worse than the best
    moves = speed > 3 * floor
    best = relative[moves].min() if moves.any() else np.inf
    relative = np.where(
        share < limits.MIN_SHARE_OF_SPEED_CLASS.value, np.minimum(relative, best), relative
    )
    return Noise(floor, speed, relative)


def _differences(velocity: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return speed, first and second (near, distant) differences, scaled to white noise."""
    far = max(1, min(_LAG_BLOCKS, (velocity.size - 1) // 8))
    left, here, right = velocity[: -2 * far], velocity[far:-far], velocity[2 * far :]
    before = velocity[far - 1 : -far - 1]
    after = velocity[far + 1 : velocity.size - far + 1]
    near, bend = (np.abs(a - 2 * here + b) for a, b in ((before, after), (left, right)))
    difference = np.abs(after - here) / np.sqrt(2)
    return np.abs(left + here + right) / 3, difference, near / np.sqrt(6), bend / np.sqrt(6)


def _spread(deviation: np.ndarray) -> float:
    """Return the robust standard deviation of deviations that are mostly noise.

    The median deviation of quantised, repeating readings is zero: then the mean without the largest
    tenth is used.
    """
    most = np.sort(deviation)[: max(1, deviation.size * 9 // 10)]
    return float(max(median(deviation) / 0.6745, np.mean(most)))


def find_breaks(
    velocity: np.ndarray, noise: Noise, resolution: float, rest_speed: float
) -> np.ndarray:
    """Return the blocks at which the mean velocity changes, by moving sums from fine to coarse."""
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
                bends = [_bends(total, noise, width, far * width, at) for far in (1, _LAG_BLOCKS)]
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
    """Return the highest candidates at least `width` apart."""
    if position.size == 0:
        return position
    if width == 1:
        return position
    # candidates of one cluster are close together: the highest of each bin, then thin out. From
    # rest all are equally high: rounding selects the earliest
    order = np.argsort(-np.round(height, _HEIGHT_DIGITS), kind="stable")
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
    """Return weight, mean time, mean velocity and centred second moments of pieces, as columns."""
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
    """Return the moments of two merged pieces (pairwise update, stable)."""
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
    time: np.ndarray,
    velocity: np.ndarray,
    noise: Noise,
    breaks: np.ndarray,
    resolution: float,
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
