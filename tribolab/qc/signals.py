"""Checks on one signal: missing, stuck, clipped, quantised and outlying samples.

Each is a plain function from an array and limits to flags (see :mod:`tribolab.qc.flags`). None
changes a sample. Long records are processed piece by piece, each with whole-array operations.
"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import anywhere, pieces
from tribolab.arrays.medians import medians_of_rows
from tribolab.arrays.scratch import filled
from tribolab.friction.oscillation.spectrum.noise import quantisation_step
from tribolab.qc.flags import GOOD, MISSING, NOT_EVALUATED, SUSPECT, uniform

_BLOCK = 64  # samples in a block that has one noise level; a step of a run may be as short
_NOISE_RATIO = 1.6  # ratio of noise levels of neighbouring blocks that is not due to chance

_SAMPLES_PER_READING = 3  # samples per reading from which a channel counts as refreshed slowly
_MAX_EXAMINED = 1 << 24  # records with more samples are not examined for slow refreshing


def missing(values: np.ndarray) -> np.ndarray:
    """Return flags: missing for NaN, good for all other values.

    Examples
    --------
    >>> missing(np.array([1.0, np.nan]))
    array([1, 9], dtype=int8)
    """
    if not anywhere(np.isnan, values):
        return uniform(values.shape, GOOD)
    return np.where(np.isnan(values), np.int8(MISSING), np.int8(GOOD))


def spikes(values: np.ndarray, threshold: float = 8.0) -> np.ndarray:
    """Return flags on single samples that deviate from the values expected from both sides.

    Parameters
    ----------
    values
        The signal (time).
    threshold
        Smallest height of a spike, in standard deviations of the local noise.

    Returns
    -------
    ndarray
        suspect at spikes, good elsewhere; not evaluated at the ends and next to missing values.

    Notes
    -----
    On each side, a sample is compared with its neighbour and with the straight line through the two
    nearest samples; its height is the smallest of the four deviations. Sawteeth and steps are
    therefore not spikes. Nor is a peak after which the signal has another level: both neighbours
    must agree within half the height.
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
    """Return how far each sample, except the two at each end, deviates from its neighbours."""
    bend = np.diff(step)
    # deviation from the last sample, and from the line through the last two; so for the next ones
    sides = (step[1:-2], bend[:-2], -step[2:-1], bend[2:])
    upward = np.minimum(np.minimum(sides[0], sides[1]), np.minimum(sides[2], sides[3]))
    downward = np.maximum(np.maximum(sides[0], sides[1]), np.maximum(sides[2], sides[3]))
    return np.maximum(upward, -downward)


def _noise_levels(values: np.ndarray, block: int = _BLOCK) -> tuple[np.ndarray, int]:
    """Return the noise level of each block, at least the lower quartile, and the block length.

    A block next to a much noisier one has the level of the latter, because it may contain the start
    of a noisier step. The remainder at the end belongs to the last block.
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
        levels[first:last] = medians_of_rows(second.reshape(-1, length))
    quiet = np.quantile(levels, 0.25)
    padded = np.pad(levels, 1, mode="edge")
    loudest = np.maximum(padded[:-2], padded[2:])
    levels = np.where(loudest > _NOISE_RATIO * levels, loudest, levels)
    return np.maximum(levels, quiet) / (0.6745 * np.sqrt(6.0)), length


class _EqualRuns(NamedTuple):
    """Lengths of sequences of identical values, their counts, and start and end of long ones."""

    lengths: np.ndarray
    counts: np.ndarray
    long: np.ndarray


def _runs_of_equal(values: np.ndarray, long: int) -> _EqualRuns:
    """Return lengths and counts of the sequences of identical values, and the long sequences."""
    often: Counter[int] = Counter()
    listed = [np.zeros((0, 2), int)]
    begun = 0  # start of the sequence that continues in the next piece
    for first, last in pieces(1, values.size):
        change = np.flatnonzero(values[first:last] != values[first - 1 : last - 1]) + first
        if last == values.size:
            change = np.append(change, last)
        length = np.diff(change, prepend=begun)
        if not length.size:
            continue
        kinds, counts = np.unique(length, return_counts=True)
        often.update(dict(zip(kinds.tolist(), counts.tolist(), strict=True)))
        some = length >= long
        listed.append(np.stack([change[some] - length[some], change[some]], axis=1))
        begun = int(change[-1])
    lengths = np.array(sorted(often))
    return _EqualRuns(
        lengths, np.array([often[k] for k in lengths.tolist()]), np.concatenate(listed)
    )


def _quantile(values: np.ndarray, counts: np.ndarray, share: float) -> float:
    """Return a quantile of increasing values with given counts, as `numpy.quantile` would."""
    behind = np.cumsum(counts)
    place = share * (int(behind[-1]) - 1)
    below, above = (
        float(values[np.searchsorted(behind, rank, "right")])
        for rank in (np.floor(place), np.ceil(place))
    )
    return below + (place - np.floor(place)) * (above - below)


def stuck(values: np.ndarray, chance: float = 1e-6, shortest: int = 8) -> np.ndarray:
    """Return flags on intervals that repeat one value for longer than chance allows.

    Parameters
    ----------
    values
        The signal (time).
    chance
        Largest probability of such an interval anywhere in a sound, quantised signal of this
        length.
    shortest
        Intervals below this number of samples are never flagged.

    Returns
    -------
    ndarray
        suspect over stuck intervals, good elsewhere.

    Notes
    -----
    With r the share of equal neighbours (without the longest interval), an interval of k equal
    values occurs somewhere among n samples with a probability of about n r^(k-1).
    """
    if values.size < 4 * shortest:
        return uniform(values.size, NOT_EVALUATED)
    equal = _runs_of_equal(values, shortest)
    longest, runs = int(equal.lengths[-1]), int(equal.counts.sum())
    others = max(values.size - longest, 1)
    if runs == 1:
        return uniform(values.size, SUSPECT)  # the whole signal is constant
    # a signal quantised more coarsely than its noise often repeats values: take the 99 % quantile
    # of the lengths of equal runs as the usual length
    usual = _quantile(equal.lengths, equal.counts, 0.99)
    repeat = max((others - (runs - 1)) / others, 1.0 / values.size, 1.0 - 1.0 / usual)
    allowed = 1.0 + np.log(chance / values.size) / np.log(min(repeat, 1.0 - 1e-9))
    bad = equal.long[equal.long[:, 1] - equal.long[:, 0] >= allowed]
    if not bad.size:
        return uniform(values.size, GOOD)
    flags = filled(values.size, GOOD, np.int8)
    for start, stop in bad:
        flags[start:stop] = SUSPECT
    return flags


def saturation(values: np.ndarray, excess: float = 1.5, fewest: int = 5) -> np.ndarray:
    """Return flags on samples that are clipped at an end of the range.

    Parameters
    ----------
    values
        The signal (time).
    excess
        Smallest ratio of samples at the outermost value to those at the next level of the quantised
        signal; the excess must also be five standard deviations of that count. In a signal that is
        not clipped the tail thins out.
    fewest
        Smallest number of samples at the outermost value; in a quantised signal at least two in a
        row.

    Returns
    -------
    ndarray
        suspect at saturated samples, good elsewhere.
    """
    readings = _readings(values)
    if readings is not None:  # count each reading once if the channel is refreshed slowly
        levels, number = readings
        return saturation(levels, excess, fewest)[number]
    known = sum(np.count_nonzero(values[a:b] == values[a:b]) for a, b in pieces(0, values.size))
    if known < 32 or np.nanmin(values) == np.nanmax(values):
        return uniform(values.size, NOT_EVALUATED)
    step = 1.5 * quantisation_step(values)
    bad = []
    for end, sign in ((np.nanmax(values), 1.0), (np.nanmin(values), -1.0)):
        count, below, in_a_row = _end_counts(values, end, sign, step)
        enough = max(fewest, excess * below + 5 * np.sqrt(below))
        if count >= enough and (in_a_row or step == 0):
            bad.append(end)
    if not bad:
        return uniform(values.size, GOOD)
    flags = filled(values.size, GOOD, np.int8)
    for start, stop in pieces(0, values.size):
        flags[start:stop][np.isin(values[start:stop], bad)] = SUSPECT
    return flags


def _readings(values: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Return a slowly refreshed signal's readings, and each sample's reading index; else None."""
    if values.size < 2 or values.size > _MAX_EXAMINED:
        return None
    changes = np.concatenate([[True], values[1:] != values[:-1]])
    lengths = np.diff(np.append(np.flatnonzero(changes), values.size))
    if np.median(lengths) < _SAMPLES_PER_READING:
        return None
    return values[changes], np.cumsum(changes) - 1


def _end_counts(values: np.ndarray, end: float, sign: float, step: float) -> tuple[int, int, bool]:
    """Count samples at an end of the range and near it; also return whether two are adjacent."""
    count, below, in_a_row, before = 0, 0, False, False
    for start, stop in pieces(0, values.size):
        depth = sign * (end - values[start:stop])
        at_end = values[start:stop] == end
        count += int(np.count_nonzero(at_end))
        below += int(np.count_nonzero((depth > 0) & (depth <= step)))
        in_a_row |= bool((before and at_end[0]) or (at_end[1:] & at_end[:-1]).any())
        before = bool(at_end[-1])
    return count, below, in_a_row
