"""Velocity from a position record: slopes over blocks, without outliers."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.chunks import pieces
from tribolab.arrays.medians import median
from tribolab.arrays.scratch import room
from tribolab.friction.segments import limits
from tribolab.friction.segments.noise import quantum

_DIGIT_SAMPLE = 8192  # this many readings suffice to find their last digit
_DIGIT_ROUNDING = 0.01  # rounding errors of arithmetic, relative to a digit
_RATE_SAMPLES = 8  # samples on each side of a jump that determine the usual rate


def position_noise(time: np.ndarray, position: np.ndarray) -> float:
    """Estimate the standard deviation of the position readings [m].

    It is found from the distance of each reading to the line between its neighbours, which is zero
    at constant speed. It is at least the rounding error, which a regular pattern of digits may
    hide.
    """
    if time.size < 3:
        return 0.0
    off = np.empty(time.size - 2)  # kept in full, because the median needs all
    for first, last in pieces(0, off.size):
        off[first:last] = _chord_error(time[first : last + 2], position[first : last + 2])
    noise = float(np.median(off, overwrite_input=True) / 0.6745)
    rounding = digit(position) / np.sqrt(12)
    # if most readings repeat, their median distance is zero
    return max(noise, rounding) or quantum(position) / np.sqrt(12)


def _chord_error(time: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return each reading's distance from its neighbours' chord, scaled to one reading's noise."""
    share = (time[1:-1] - time[:-2]) / (time[2:] - time[:-2])
    chord = position[:-2] + share * (position[2:] - position[:-2])
    size = np.sqrt(1 + share**2 + (1 - share) ** 2)
    return np.abs(position[1:-1] - chord) / size


def is_staircase(position: np.ndarray) -> bool:
    """Return whether most readings equal the one before, as digits are coarser than the motion."""
    steps = position.size - 1
    still = sum(
        int(np.count_nonzero(np.diff(position[a : b + 1]) == 0)) for a, b in pieces(0, steps)
    )
    return steps > 1 and still > 0.5 * steps


def digit(position: np.ndarray) -> float:
    """Return the resolution of the readings [m]; 0 if they are not multiples of a step.

    Parameters
    ----------
    position
        Finite readings [m].

    Examples
    --------
    >>> round(digit(np.array([0.0, 2e-6, 7e-6, 1e-5, 1.1e-5, 1.5e-5, 2.4e-5, 3.3e-5])), 9)
    1e-06
    >>> digit(np.array([0.0, 2.1e-6, 7.3e-6, 1e-5, 1.17e-5, 1.5e-5, 2.44e-5, 3.3e-5]))
    0.0
    """
    levels = np.unique(position[:: 1 + position.size // _DIGIT_SAMPLE])
    gaps = np.diff(levels)
    # readings that differ only in the last bits are equal
    gaps = gaps[gaps > 1e-9 * np.abs(levels).max(initial=0.0)]
    if gaps.size < limits.MIN_SAMPLES_OF_BLOCK.value - 1:
        return 0.0
    least = float(gaps.min())
    times = gaps / least
    if np.abs(times - np.round(times)).max() >= _DIGIT_ROUNDING:
        return 0.0
    return 0.0 if _is_commanded(position, least) else least


def _is_commanded(position: np.ndarray, step: float) -> bool:
    """Return whether a position changes by equal steps or not at all, as a set-point does."""
    moves = others = alone = 0
    for first, last in pieces(0, position.size - 1):
        steps = np.abs(np.diff(position[first : last + 1]))
        still = steps <= _DIGIT_ROUNDING * step
        one = np.abs(steps - step) < _DIGIT_ROUNDING * step
        moves += int(np.count_nonzero(one))
        others += int(np.count_nonzero(~one & ~still))
        alone += int(np.count_nonzero(still[1:-1] & ~still[:-2] & ~still[2:]))
    return moves > 0 and others + alone <= limits.MAX_UNEQUAL_STEPS.value * moves


def is_rounding(position: np.ndarray, noise: float) -> bool:
    """Return whether rounding to the last digit explains all the noise of a record.

    Readings that change by less than a digit or two per sample repeat a pattern, whose blocks have
    less noise than rounding at some speeds, and more at others.

    Parameters
    ----------
    position
        Finite readings [m].
    noise
        From `position_noise` [m].
    """
    return is_staircase(position) or noise <= limits.MAX_NOISE_OF_ROUNDING.value * digit(position)


def _find_jumps(time: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return the indices of the samples after which the position jumps far."""
    least = limits.MIN_JUMP.value * float(np.ptp(position)) if position.size else 0.0
    least = max(least, limits.MIN_DIGITS_OF_JUMP.value * quantum(position))
    parts = [
        first
        + np.flatnonzero(
            (np.abs(np.diff(position[first : last + 1])) > least)
            & (np.diff(time[first : last + 1]) > 0)
        )
        for first, last in pieces(0, position.size - 1)
    ]
    return np.concatenate(parts) if parts else np.zeros(0, dtype=int)


def without_resets(time: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a position record without jumps that are no motion: resets to zero, and wraps.

    Parameters
    ----------
    time, position
        Finite samples [s], [m].

    Returns
    -------
    tuple
        The position without its jumps [m], and the samples after each jump.

    Notes
    -----
    A jump is a single difference of at least `MIN_JUMP` of the range that deviates from the rates
    around it; it is replaced by the difference that their median gives.
    """
    far = _find_jumps(time, position)
    if far.size == 0 or position.size <= 2 * _RATE_SAMPLES:
        return position, np.zeros(0, dtype=int)
    near = far[:, None] + np.concatenate(
        [np.arange(-_RATE_SAMPLES, 0), np.arange(1, _RATE_SAMPLES + 1)]
    )
    neighbour = np.where((near >= 0) & (near < position.size - 1), near, far[:, None])
    around = _rates(time, position, neighbour)
    around[neighbour == far[:, None]] = np.nan
    usual = np.nanmedian(around, axis=1)
    size = np.where(around == 0, np.nan, np.abs(around))
    still = np.isnan(size).all(axis=1)
    size[still] = 0.0
    scatter = np.nanmedian(np.abs(around - usual[:, None]), axis=1)
    limit = np.maximum(
        limits.MIN_RATE_OF_JUMP.value * np.nanmedian(size, axis=1),
        limits.MIN_SCATTER_OF_JUMP.value * scatter,
    )
    jump = np.abs(_rates(time, position, far) - usual) > limit
    at = far[jump]
    moved = position[at + 1] - position[at] - usual[jump] * (time[at + 1] - time[at])
    last = digit(position)
    if last > 0:  # shift by whole digits, so that the readings remain multiples of the digit
        moved = np.round(moved / last) * last
    ahead = np.concatenate([[0.0], np.cumsum(moved)])
    joined = room(position.size)
    for a, b in pieces(0, position.size):
        joined[a:b] = position[a:b] - ahead[np.searchsorted(at + 1, np.arange(a, b), "right")]
    return joined, at + 1


def _rates(time: np.ndarray, position: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the rate of change from given samples to the next ones; NaN if no time passes."""
    spacing = time[at + 1] - time[at]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(spacing > 0, (position[at + 1] - position[at]) / spacing, np.nan)


def block_slopes(
    time: np.ndarray, position: np.ndarray, size: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return mean time and least-squares slope of each block of `size` samples."""
    count = time.size // size
    middle, slope = np.empty(count), np.empty(count)
    for first, last in pieces(0, count, block=size):
        part = slice(first * size, last * size)
        middle[first:last], slope[first:last] = _slopes(
            time[part].reshape(-1, size), position[part].reshape(-1, size)
        )
    return middle, slope


def _slopes(t: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return mean time and slope of each block, one per row, without outliers."""
    middle = t.mean(axis=1, keepdims=True)
    t, x = t - middle, x - x.mean(axis=1, keepdims=True)
    slope = (t * x).sum(axis=1) / (t * t).sum(axis=1)
    # fit again without outliers
    rest = x - slope[:, None] * t
    limit = 4 * np.median(np.abs(rest), axis=1, keepdims=True) / 0.6745
    weight = (np.abs(rest) <= np.maximum(limit, 1e-300)).astype(float)
    total = weight.sum(axis=1, keepdims=True)
    t = t - (weight * t).sum(axis=1, keepdims=True) / np.maximum(total, 1)
    spread = (weight * t * t).sum(axis=1)
    good = spread > 0
    better = (weight * t * x).sum(axis=1) / np.where(good, spread, 1.0)
    return middle[:, 0], np.where(good, better, slope)


def velocity_blocks(
    time: np.ndarray, position: np.ndarray, least: int = limits.MIN_SAMPLES_OF_BLOCK.value
) -> tuple[np.ndarray, np.ndarray, int, float]:
    """Return velocities from slopes over blocks, which are as long as an accuracy of 3 % needs.

    It is reached at the speeds that cover most of the distance, not for slower motion.

    Parameters
    ----------
    time, position
        Finite samples [s], [m].
    least
        Fewest samples in a block.

    Returns
    -------
    tuple
        Mean time of each block [s], velocity [m/s], samples per block, and the usual error of a
        block's velocity [m/s].
    """
    noise = position_noise(time, position)
    size, error = least, 0.0
    while True:
        t, v = block_slopes(time, position, size)
        spacing = median(np.diff(t)) / size if t.size > 1 else np.inf
        error = float(noise * np.sqrt(12 / size) / (size * spacing)) if spacing > 0 else 0.0
        if size * 64 > time.size or _is_accurate(np.abs(v), error):
            return t, v, size, error
        size *= 2


def _is_accurate(speed: np.ndarray, error: float) -> bool:
    """Return whether block velocities are accurate at the speeds that cover most distance."""
    sure = np.maximum(speed - 3 * error, 0.0)  # motion within the noise does not count as distance
    if not sure.any():
        return False
    order = np.argsort(speed)
    share = np.cumsum(sure[order])
    usual = speed[order][np.searchsorted(share, 0.5 * share[-1])]
    return bool(error <= limits.MAX_ERROR_OF_SLOPE.value * median(speed[speed > 0.2 * usual]))


def line(time: np.ndarray, position: np.ndarray) -> tuple[float, float]:
    """Return offset and slope of the straight line through an interval, without single outliers."""
    t0 = time.mean()
    since = time - t0
    keep = np.ones(time.size, dtype=bool)
    offset = slope = 0.0
    for _ in range(3):
        t, x = since[keep], position[keep]
        middle, level = t.mean(), x.mean()
        t = t - middle
        spread = t @ t
        slope = t @ (x - level) / spread if spread else 0.0
        offset = level - slope * middle
        rest = np.abs(position - offset - slope * since)
        limit = 4 * median(rest[keep]) / 0.6745
        if limit == 0:
            break
        keep = rest <= limit
    return float(offset - slope * t0), float(slope)
