"""Artefacts of a scan: dust, scratches, a stuck stylus, clipping, rounding.

Each is a plain function from heights to a mask or a number; none changes a height.
"""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from tribolab.arrays.medians import median, medians_of_rows
from tribolab.friction.oscillation.spectrum.noise import quantisation_step

_BLOCKS = {1: 20, 2: 4}  # blocks of the baseline along each axis, for profiles (1) and maps (2)
# features that cover a larger share of all points are form, such as a chamfer
_WIDEST = {1: 0.04, 2: 0.2}
_STUCK_BLOCKS = 50  # number of blocks of a profile in which a stuck stylus is searched
_MIN_IN_BLOCK = 16
# half widths of the band of heights at a noisy stop, relative to the roughness of the blocks
_BANDS = 0.02 * np.sqrt(2.0) ** np.arange(11)
_PILE_RATIO = 4.0  # points in the outermost band / those in the next one; 1.4 for rough summits
_TRIM = 20  # up to this many points beyond the end of the range may be outliers


def outlying_features(height: np.ndarray, sigma: float, factor: float, most: int) -> np.ndarray:
    """Return a mask of the few peaks or valleys far from all others: dust, scratches, pores.

    Parameters
    ----------
    height
        Heights without form [m] (x) or (y, x), without gaps.
    sigma
        Smallest size of a feature, in robust standard deviations (median absolute deviation over
        0.6745) from the median line.
    factor
        Smallest ratio of its size to the largest other deviation to the same side.
    most
        Largest number of peaks; more belong to the surface. For valleys one: honed and porous
        surfaces have valleys deeper than `sigma`.

    Returns
    -------
    ndarray of bool
        True at all points of the features, down to one standard deviation.

    Notes
    -----
    Sizes are compared with the largest of the same side, not with a normal distribution, because
    valleys of a honed surface, pores and tool arcs are often many and equally deep.

    Examples
    --------
    >>> height = np.sin(np.arange(4000) / 7.0)
    >>> height[1000:1010] += 30.0
    >>> np.flatnonzero(outlying_features(height, 6.0, 2.0, 3))[[0, -1]].tolist()
    [1000, 1009]
    """
    deviation = height - _baseline(height)
    scale = float(median(np.abs(deviation))) / 0.6745
    found = np.zeros(height.shape, dtype=bool)
    widest = height.size * _WIDEST[height.ndim]
    if not scale > 0:
        return found
    for sign in (1.0, -1.0):
        size = sign * deviation
        labels, number = ndimage.label(size > scale)
        peaks = np.asarray(ndimage.maximum(size, labels, np.arange(1, number + 1)))
        peaks = np.where(np.bincount(labels.flat)[1:] <= widest, peaks, 0.0)
        order = np.argsort(peaks)[::-1]
        ranked = np.append(peaks[order], scale)
        for count in range(min(most if sign > 0 else 1, number), 0, -1):
            if sign < 0 and ranked[count] > sigma * scale:
                continue
            if ranked[count - 1] > max(sigma * scale, factor * ranked[count]):
                found |= np.isin(labels, order[:count] + 1)
                break
    return found


def _baseline(height: np.ndarray) -> np.ndarray:
    """Return a baseline through the medians of blocks."""
    sizes = [max(8, -(-points // _BLOCKS[height.ndim])) for points in height.shape]
    counts = [max(1, points // size) for points, size in zip(height.shape, sizes, strict=True)]
    if min(counts) < 2:
        return np.full(height.shape, median(height))
    cut = height[tuple(slice(0, c * s) for c, s in zip(counts, sizes, strict=True))]
    if height.ndim == 1:
        blocks = cut.reshape(counts[0], sizes[0])
    else:
        parted = cut.reshape(counts[0], sizes[0], counts[1], sizes[1]).swapaxes(1, 2)
        blocks = parted.reshape(counts[0] * counts[1], -1)
    middles = medians_of_rows(blocks).reshape(counts)
    for axis, (points, size, count) in enumerate(zip(height.shape, sizes, counts, strict=True)):
        # positions in units of blocks, from the centre of the first block
        places = (np.arange(points) + 0.5) / size - 0.5
        left = np.clip(places.astype(int), 0, count - 2)
        share = np.clip(places - left, 0.0, 1.0)
        share = share if axis == height.ndim - 1 else share[:, None]
        middles = (1 - share) * middles.take(left, axis) + share * middles.take(left + 1, axis)
    return middles


def stuck_stretch(height: np.ndarray, share: float, quiet: float) -> tuple[int, int] | None:
    """Return the interval in which the stylus is stuck: a straight line, except for white noise.

    Parameters
    ----------
    height
        Heights of one profile [m] (x), without gaps; with or without form.
    share
        Smallest share of the traverse.
    quiet
        Largest standard deviation from a line within a fiftieth of the traverse, over the median
        of all fiftieths.

    Returns
    -------
    tuple of int, or None
        First point and the one after the last.

    Notes
    -----
    The heights of a smooth part of a surface resemble their neighbours; the noise of a gauge at
    rest does not. Levelling can tilt the line. A profile that is mostly flat is a surface
    with flats, not stuck.

    Examples
    --------
    >>> height = np.sin(np.arange(4000) / 7.0)
    >>> height[1000:2000] = 0.3
    >>> stuck_stretch(height, 0.08, 0.1)
    (1000, 2000)
    """
    size = height.size // _STUCK_BLOCKS
    if size < _MIN_IN_BLOCK:
        return None
    blocks = height[: size * _STUCK_BLOCKS].reshape(_STUCK_BLOCKS, size)
    spread, noise = _line_scatter(blocks)
    usual = float(median(spread))
    still = (spread <= quiet * usual) & _is_white(spread, noise)
    labels, number = ndimage.label(still)
    if not number or still.mean() > 0.5:
        return None
    lengths = np.bincount(labels)[1:]
    longest = int(np.argmax(lengths)) + 1
    at = np.flatnonzero(labels == longest)
    first, last = int(at[0]) * size, (int(at[-1]) + 1) * size
    whole, roughness = (float(part[0]) for part in _line_scatter(height[None, first:last]))
    if not _is_white(np.array(whole), np.array(roughness)):
        return None
    first, last = _widen(height, first, last, max(5.0 * whole, 1e-3 * usual))
    return (first, last) if last - first >= share * height.size else None


def _line_scatter(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return each row's scatter about a straight line, and its white-noise part."""
    x = np.linspace(-1.0, 1.0, rows.shape[1])
    rest = rows - rows.mean(axis=1, keepdims=True)
    rest = rest - np.outer(rest @ x / (x @ x), x)
    noise = np.sqrt((np.diff(rest, axis=1) ** 2).mean(axis=1) / 2.0)
    spread = rest.std(axis=1)
    rounding = 1e-9 * np.abs(rows).max()
    return np.where(spread > rounding, spread, 0.0), np.where(spread > rounding, noise, 0.0)


def _is_white(spread: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Return whether neighbouring heights are independent (von Neumann's ratio)."""
    return np.asarray(noise**2 >= 0.6 * spread**2)


def _widen(height: np.ndarray, first: int, last: int, near: float) -> tuple[int, int]:
    """Return an interval, extended to both sides as far as the heights continue its line."""
    x = np.arange(height.size, dtype=float)
    slope, level = np.polyfit(x[first:last], height[first:last], 1)
    away = np.abs(height - level - slope * x) > near
    before, after = np.flatnonzero(away[:first]), np.flatnonzero(away[last:])
    return (
        int(before[-1]) + 1 if before.size else 0,
        last + int(after[0]) if after.size else height.size,
    )


def noisy_stop(height: np.ndarray, share: float, in_a_row: int) -> np.ndarray:
    """Return a mask of points clipped at an end of the measuring range, where readings are noisy.

    Parameters
    ----------
    height
        Heights of one profile [m] (x), as measured: with tilt and form; without gaps.
    share
        Smallest share of the points.
    in_a_row
        Smallest length of the longest sequence of clipped points.

    Notes
    -----
    Points pile up in a band at the end, four times as many as in the next band of its width
    (round summits make 1.4 times as many), and inside the band neighbours differ as independent
    readings do. Plateaus pile up too, but their heights resemble their neighbours', and tilt
    and form run through them.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> height = np.minimum(np.sin(np.arange(4000) / 30.0), 0.9) + 0.002 * rng.normal(size=4000)
    >>> bool(0.1 < noisy_stop(height, 0.01, 8).mean() < 0.2)
    True
    """
    found = np.zeros(height.size, dtype=bool)
    if height.size < _STUCK_BLOCKS * _MIN_IN_BLOCK:
        return found
    blocks = height[: height.size - height.size % _STUCK_BLOCKS].reshape(_STUCK_BLOCKS, -1)
    scale, digit = float(median(_line_scatter(blocks)[0])), rounding_step(height)
    for sign in (1.0, -1.0):
        size = sign * height
        for band in _BANDS:
            width = max(2.0 * band * scale, 3.0 * digit)
            top = float(np.partition(size, -_TRIM)[-_TRIM])
            at_end = size > top - width
            below = np.count_nonzero((size <= top - width) & (size > top - 2.0 * width))
            count = np.count_nonzero(at_end)
            if count < max(share * size.size, _PILE_RATIO * below):
                continue
            if longest_run(at_end) >= in_a_row and _white_within(size, at_end):
                found |= at_end
                break
    return found


def longest_run(marked: np.ndarray) -> int:
    """Return the length of the longest sequence of True.

    Examples
    --------
    >>> longest_run(np.array([True, False, True, True, False]))
    2
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], marked.astype(np.int8), [0]])))
    return int((edges[1::2] - edges[::2]).max(initial=0))


def _white_within(values: np.ndarray, marked: np.ndarray) -> bool:
    """Return whether the marked values scatter like independent readings of one height."""
    both = marked[1:] & marked[:-1]
    if both.sum() < 8:
        return False
    noise = np.sqrt((np.diff(values)[both] ** 2).mean() / 2.0)
    return bool(_is_white(np.array(values[marked].std()), np.array(noise)))


def rounding_step(height: np.ndarray) -> float:
    """Return the rounding step of the heights [m], also after levelling; 0 if there is none.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> wave = np.sin(np.arange(4000) / 30.0) + 0.1 * rng.normal(size=4000)
    >>> float(round(rounding_step(np.round(wave, 1) + 0.123 * np.arange(4000)), 9))
    0.1
    """
    known = height[np.isfinite(height)]
    bends = np.diff(known, 2)
    bends[np.abs(bends) < 1e-9 * np.ptp(known)] = 0.0
    return max(quantisation_step(known), quantisation_step(np.round(bends, 15)))
