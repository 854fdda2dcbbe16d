"""Checks on one sampled signal: missing, stuck, saturated, quantised, spiked.

Each is a plain function from an array and limits to flags (see :mod:`tribolab.qc.flags`). None
changes a sample. All are single passes of whole-array operations.
"""

from __future__ import annotations

import numpy as np

from tribolab.friction.oscillation.noise import quantisation_step
from tribolab.qc.flags import GOOD, MISSING, NOT_EVALUATED, SUSPECT


def missing(values: np.ndarray) -> np.ndarray:
    """Flag what is not a number as missing, the rest as good.

    Examples
    --------
    >>> missing(np.array([1.0, np.nan]))
    array([1, 9], dtype=int8)
    """
    return np.where(np.isnan(values), MISSING, GOOD).astype(np.int8)


def spikes(values: np.ndarray, threshold: float = 8.0) -> np.ndarray:
    """Flag single samples that stand out from what both sides lead to expect.

    Parameters
    ----------
    values
        (time)
    threshold
        Height in standard deviations of the local noise.

    Returns
    -------
    ndarray
        suspect at spikes, good elsewhere; not evaluated at the ends and beside missing values.

    Notes
    -----
    The height of a sample is how far it lies beyond its neighbour *and* beyond the straight line
    through the two nearest samples, on each side; the smaller side counts. The teeth of a saw and
    steps are therefore none, and neither is a peak behind which the signal stays elsewhere: the
    neighbours have to agree within half the height.
    """
    flags = np.full(values.size, NOT_EVALUATED, np.int8)
    if values.size < 16:
        return flags
    step = np.diff(values)
    bend = np.diff(step)
    # left of sample i: x[i] - x[i-1], and x[i] - (2 x[i-1] - x[i-2]); right likewise
    sides = (step[1:-2], bend[:-2], -step[2:-1], bend[2:])
    upward = np.minimum(np.minimum(sides[0], sides[1]), np.minimum(sides[2], sides[3]))
    downward = np.maximum(np.maximum(sides[0], sides[1]), np.maximum(sides[2], sides[3]))
    height = np.maximum(upward, -downward)
    scale = np.maximum(_local_noise(values)[2:-2], 0.3 * quantisation_step(values))
    back = np.abs(step[1:-2] + step[2:-1]) < 0.5 * height
    inner = flags[2:-2]
    inner[~np.isnan(height)] = GOOD
    inner[(height > threshold * scale) & (height > 0) & back] = SUSPECT
    return flags


def _local_noise(values: np.ndarray, block: int = 512) -> np.ndarray:
    """Noise level of each block, at least that of the quieter half of the record."""
    second = np.abs(np.diff(values, 2, prepend=values[:1], append=values[-1:]))
    second = np.nan_to_num(second)
    blocks = max(1, values.size // block)
    length = values.size // blocks
    levels = np.median(second[: blocks * length].reshape(blocks, length), axis=1)
    levels = np.maximum(levels, np.quantile(levels, 0.25)) / (0.6745 * np.sqrt(6.0))
    return np.repeat(levels, np.diff(np.append(np.arange(blocks) * length, values.size)))


def _runs_of_equal(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First index and length of every stretch of identical values."""
    change = np.flatnonzero(values[1:] != values[:-1]) + 1
    first = np.concatenate([[0], change])
    return first, np.diff(np.append(first, values.size))


def stuck(values: np.ndarray, chance: float = 1e-6, shortest: int = 8) -> np.ndarray:
    """Flag stretches that repeat one value longer than chance allows.

    Parameters
    ----------
    values
        (time)
    chance
        Largest probability with which a healthy, quantised signal of this length may show such
        a stretch anywhere.
    shortest
        Stretches below this number of samples are never flagged.

    Returns
    -------
    ndarray
        suspect over stuck stretches, good elsewhere.

    Notes
    -----
    With r the share of equal neighbours (the longest stretch left out), a stretch of k equal
    values appears somewhere among n samples with a probability of about n r^(k-1).
    """
    flags = np.full(values.size, GOOD, np.int8)
    if values.size < 4 * shortest:
        flags[:] = NOT_EVALUATED
        return flags
    first, length = _runs_of_equal(values)
    longest = length.max()
    others = max(values.size - longest, 1)
    if length.size == 1:
        flags[:] = SUSPECT  # one value from start to end
        return flags
    # a signal quantised more coarsely than its noise repeats values in health, too: what most
    # stretches do sets what is usual
    usual = float(np.quantile(length, 0.99))
    repeat = max((others - (length.size - 1)) / others, 1.0 / values.size, 1.0 - 1.0 / usual)
    allowed = 1.0 + np.log(chance / values.size) / np.log(min(repeat, 1.0 - 1e-9))
    bad = np.flatnonzero(length >= max(shortest, allowed))
    for index in bad:  # a loop over stuck stretches, few by their definition
        flags[first[index] : first[index] + length[index]] = SUSPECT
    return flags


def saturation(values: np.ndarray, excess: float = 1.5, fewest: int = 5) -> np.ndarray:
    """Flag samples that lie at the end of the range because the signal was cut off there.

    Parameters
    ----------
    values
        (time)
    excess
        How many times more samples lie on the outermost value than on the next level of the
        quantised signal, and by five standard deviations of that count at least; the tail of a
        signal that is not cut off thins out.
    fewest
        Smallest number of samples on the outermost value; where the signal is quantised, at
        least two of them in a row.

    Returns
    -------
    ndarray
        suspect at saturated samples, good elsewhere.
    """
    flags = np.full(values.size, GOOD, np.int8)
    known = values[~np.isnan(values)]
    if known.size < 32 or known.min() == known.max():
        flags[:] = NOT_EVALUATED
        return flags
    step = 1.5 * quantisation_step(values)
    for end, sign in ((known.max(), 1.0), (known.min(), -1.0)):
        at_end = values == end
        count = int(at_end.sum())
        depth = sign * (end - known)
        below = int(((depth > 0) & (depth <= step)).sum())
        in_a_row = bool((at_end[1:] & at_end[:-1]).any())
        enough = max(fewest, excess * below + 5 * np.sqrt(below))
        if count >= enough and (in_a_row or step == 0):
            flags[at_end] = SUSPECT
    return flags
