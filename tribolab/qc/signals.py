"""Checks on one sampled signal: missing, stuck, saturated, quantised, spiked.

Each is a plain function from an array and limits to flags (see :mod:`tribolab.qc.flags`). None
changes a sample. All are passes of whole-array operations, over long records piece by piece.
"""

from __future__ import annotations

import numpy as np

from tribolab.friction.oscillation.noise import quantisation_step
from tribolab.pieces import anywhere, pieces
from tribolab.qc.flags import GOOD, MISSING, NOT_EVALUATED, SUSPECT, uniform
from tribolab.room import filled, let_go, room


def missing(values: np.ndarray) -> np.ndarray:
    """Flag what is not a number as missing, the rest as good.

    Examples
    --------
    >>> missing(np.array([1.0, np.nan]))
    array([1, 9], dtype=int8)
    """
    if not anywhere(np.isnan, values):
        return uniform(values.shape, GOOD)
    return np.where(np.isnan(values), np.int8(MISSING), np.int8(GOOD))


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
    flags = filled(values.size, NOT_EVALUATED, np.int8)
    if values.size < 16:
        return flags
    levels, length = _noise_levels(values)
    least = 0.3 * quantisation_step(values)
    for start, stop in pieces(2, values.size - 2):
        inner = flags[start:stop]
        step = np.diff(values[start - 2 : stop + 2])
        height = _height(step)
        block = np.minimum(np.arange(start, stop) // length, levels.size - 1)
        scale = np.maximum(levels[block], least)
        back = np.abs(step[1:-2] + step[2:-1]) < 0.5 * height
        inner[~np.isnan(height)] = GOOD
        inner[(height > threshold * scale) & (height > 0) & back] = SUSPECT
    return flags


def _height(step: np.ndarray) -> np.ndarray:
    """Height of each sample but two at both ends, from the steps between the samples."""
    bend = np.diff(step)
    # left of sample i: x[i] - x[i-1], and x[i] - (2 x[i-1] - x[i-2]); right likewise
    sides = (step[1:-2], bend[:-2], -step[2:-1], bend[2:])
    upward = np.minimum(np.minimum(sides[0], sides[1]), np.minimum(sides[2], sides[3]))
    downward = np.maximum(np.maximum(sides[0], sides[1]), np.maximum(sides[2], sides[3]))
    return np.maximum(upward, -downward)


def _noise_levels(values: np.ndarray, block: int = 512) -> tuple[np.ndarray, int]:
    """Noise level of each block, at least that of the quieter half of the record; its length.

    What is left over at the end belongs to the last block.
    """
    blocks = max(1, values.size // block)
    length = values.size // blocks
    levels = np.empty(blocks)
    for first, last in pieces(0, blocks, block=length):
        start, stop = first * length, last * length
        part = values[max(start - 1, 0) : stop + 1]
        ends = {"prepend": values[:1]} if start == 0 else {}
        ends |= {"append": values[-1:]} if stop == values.size else {}
        second = np.nan_to_num(np.abs(np.diff(part, 2, **ends)))
        levels[first:last] = np.median(second.reshape(-1, length), axis=1)
    return np.maximum(levels, np.quantile(levels, 0.25)) / (0.6745 * np.sqrt(6.0)), length


def _runs_of_equal(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First index and length of every stretch of identical values."""
    kind = np.int32 if values.size < 2**31 else np.int64
    starts = room(values.size + 1, kind)
    starts[0], count = 0, 1
    for first, last in pieces(1, values.size):
        change = np.flatnonzero(values[first:last] != values[first - 1 : last - 1])
        np.add(change, first, out=starts[count : count + change.size], casting="same_kind")
        count += change.size
    starts[count] = values.size
    length = room(count, kind)
    for first, last in pieces(0, count):
        np.subtract(starts[first + 1 : last + 1], starts[first:last], out=length[first:last])
    return starts[:count], length


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
    if values.size < 4 * shortest:
        return uniform(values.size, NOT_EVALUATED)
    first, length = _runs_of_equal(values)
    longest = int(length.max())
    others = max(values.size - longest, 1)
    if length.size == 1:
        return uniform(values.size, SUSPECT)  # one value from start to end
    # a signal quantised more coarsely than its noise repeats values in health, too: what most
    # stretches do sets what is usual
    usual = float(np.quantile(length, 0.99))
    let_go()
    repeat = max((others - (length.size - 1)) / others, 1.0 / values.size, 1.0 - 1.0 / usual)
    allowed = 1.0 + np.log(chance / values.size) / np.log(min(repeat, 1.0 - 1e-9))
    bad = np.flatnonzero(length >= max(shortest, allowed))
    if not bad.size:
        return uniform(values.size, GOOD)
    flags = filled(values.size, GOOD, np.int8)
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
    known = values.size - int(np.isnan(values).sum())
    if known < 32 or np.nanmin(values) == np.nanmax(values):
        return uniform(values.size, NOT_EVALUATED)
    step = 1.5 * quantisation_step(values)
    cut = np.zeros(values.size, bool)
    for end, sign in ((np.nanmax(values), 1.0), (np.nanmin(values), -1.0)):
        at_end = values == end
        count, below = int(at_end.sum()), 0
        for start, stop in pieces(0, values.size):
            depth = sign * (end - values[start:stop])
            below += int(((depth > 0) & (depth <= step)).sum())
        in_a_row = bool((at_end[1:] & at_end[:-1]).any())
        enough = max(fewest, excess * below + 5 * np.sqrt(below))
        if count >= enough and (in_a_row or step == 0):
            cut |= at_end
    if not cut.any():
        return uniform(values.size, GOOD)
    return np.where(cut, np.int8(SUSPECT), np.int8(GOOD))
