"""Noise of a velocity record as a function of speed; rounding; detection of set-points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import pieces
from tribolab.arrays.medians import median
from tribolab.arrays.scratch import room
from tribolab.friction.segments import limits

LAG_BLOCKS = 4  # distance, in blocks or windows, beyond which noise counts as uncorrelated
# decimals to which jumps of velocity are compared: smaller differences are rounding
HEIGHT_DIGITS = 9


class Noise(NamedTuple):
    """Noise of a block's velocity v [m/s]: standard deviation sqrt(floor^2 + (r(v) * v)^2).

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
        """Return the noise of blocks of another size, by a factor of the standard deviation."""
        return Noise(self.floor * factor, self.speed, self.relative * factor)


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
    """Estimate the noise floor and the noise proportional to speed, from neighbouring blocks.

    The spread of differences is estimated per quarter decade of speed, because a floor that is
    negligible at high speed may dominate at the lowest. The floor is no lower than `least` [m/s].
    """
    middle, difference, near, bend = _differences(velocity)
    nothing = np.zeros(0)
    top = float(middle.max()) if middle.size else 0.0
    if top == 0:
        return Noise(least, nothing, nothing)
    # the offset keeps the highest speed, and decades below it, off the edges of bins
    bins = np.floor(4 * np.log10(np.maximum(middle / top, 1e-8)) + 1e-6).astype(int)
    levels = []
    for group in np.unique(bins):
        inside = bins == group
        if np.count_nonzero(inside) >= 8:
            # first differences include ramps, second ones do not. Correlated noise is small between
            # neighbours, larger between distant blocks; rounding may hide noise at one distance
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
    # speeds with few blocks are ramps, reversals or short plateaus: their relative noise is
    # limited to the smallest one of all speeds
    moves = speed > 3 * floor
    best = relative[moves].min() if moves.any() else np.inf
    relative = np.where(
        share < limits.MIN_SHARE_OF_SPEED_CLASS.value, np.minimum(relative, best), relative
    )
    return Noise(floor, speed, relative)


def _differences(velocity: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return speed, and its first and second differences scaled to the noise of one block."""
    far = max(1, min(LAG_BLOCKS, (velocity.size - 1) // 8))
    left, here, right = velocity[: -2 * far], velocity[far:-far], velocity[2 * far :]
    before = velocity[far - 1 : -far - 1]
    after = velocity[far + 1 : velocity.size - far + 1]
    near, bend = (np.abs(a - 2 * here + b) for a, b in ((before, after), (left, right)))
    difference = np.abs(after - here) / np.sqrt(2)
    return np.abs(left + here + right) / 3, difference, near / np.sqrt(6), bend / np.sqrt(6)


def _spread(deviation: np.ndarray) -> float:
    """Return a robust standard deviation from absolute deviations, most of which are noise.

    The median deviation of quantised, repeating readings is zero: then the mean without the largest
    tenth is used.
    """
    most = np.sort(deviation)[: max(1, deviation.size * 9 // 10)]
    return float(max(median(deviation) / 0.6745, np.mean(most)))
