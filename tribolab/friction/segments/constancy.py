"""Tests whether a part of a velocity record has constant speed.

Notes
-----
A plateau and the flat top of a sinusoid look alike from within. Three criteria distinguish them,
using only the piece and its neighbourhood:

1. The cubic through the piece may change by no more than `drift` of the speed: a triangle has no
   trend, but it has a curvature.
2. A plateau ends. If its speed changes gradually, over more than `MIN_GRADUAL_END` of its length,
   a quartic through the piece and its neighbourhood tests whether both are one motion: it then
   describes the piece better than a constant.
3. Ends that deviate from the level by more than half of `drift` belong to the adjacent ramp.
"""

from __future__ import annotations

import numpy as np

from tribolab.arrays.chunks import running_total
from tribolab.arrays.medians import median, median_of_known
from tribolab.friction.segments import limits
from tribolab.friction.segments.noise import running_median
from tribolab.friction.segments.proof import Readings, changes_significantly

_BINS_OF_PIECE = 16  # number of bins into which a piece is divided
_NEIGHBOURHOOD = 1.5  # lengths of a piece that are examined on each side of it
# up to this many readings in a piece, a bin has too few to estimate their noise
_FEW_READINGS = 16 * _BINS_OF_PIECE


class MeanVelocities:
    """Mean velocities of a record over short intervals (bins), from its velocity or position.

    Parameters
    ----------
    time
        Finite samples [s].
    velocity, position
        Either of them, [m/s] or [m].
    """

    def __init__(
        self,
        time: np.ndarray,
        velocity: np.ndarray | None = None,
        position: np.ndarray | None = None,
    ) -> None:
        self.time = time
        self._from_position = position is not None
        # factor by which noise decreases in a bin of twice the width
        self.averaging = 2**-1.5 if self._from_position else 2**-0.5
        own = position if position is not None else velocity
        if own is None:
            raise ValueError("a velocity or a position is wanted")
        self.readings = Readings(time, own, self._from_position)
        values = running_median(own) if self._from_position else own
        self._first = float(values[0])
        # offsets are subtracted so that sums do not lose precision
        self._total = running_total(values, self._first)
        self._moment = running_total(time if self._from_position else time[:0], float(time[0]))

    def means(self, edges: np.ndarray) -> np.ndarray:
        """Return the mean velocity between successive times; NaN without samples.

        Each is the mean of the middle half of eight sorted part means, which spikes do not affect,
        if there are enough samples. From positions, it is the slope between their means around the
        two times.
        """
        return self._slopes(edges) if self._from_position else self._levels(edges)

    def _levels(self, edges: np.ndarray) -> np.ndarray:
        at = np.searchsorted(self.time, edges)
        count = np.diff(at)
        with np.errstate(divide="ignore", invalid="ignore"):
            if count.size and median(count) >= 16:
                fine = at[:-1, None] + (count[:, None] * np.arange(8) / 8).astype(int)
                fine = np.append(fine.ravel(), at[-1])
                parts = np.diff(self._total[fine]) / np.diff(fine)
                return np.sort(parts.reshape(-1, 8), axis=1)[:, 2:-2].mean(axis=1) + self._first
            return np.diff(self._total[at]) / count + self._first

    def _slopes(self, edges: np.ndarray) -> np.ndarray:
        half = np.diff(edges).mean() / 2 if edges.size > 1 else 0.0
        around = np.clip([edges - half, edges + half], edges[0], edges[-1])
        at = np.searchsorted(self.time, around)
        count = at[1] - at[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            where, when = (
                (total[at[1]] - total[at[0]]) / count for total in (self._total, self._moment)
            )
            return np.diff(where) / np.diff(when)


def _fit(place: np.ndarray, values: np.ndarray, degree: int) -> np.ndarray:
    """Fit a polynomial by least squares and return its values at the fitted points."""
    basis = np.polynomial.legendre.legvander(place, degree)
    return basis @ np.linalg.lstsq(basis, values, rcond=None)[0]


def _scatter(values: np.ndarray) -> float:
    """Return the standard deviation of bins by their noise, regardless of slow changes."""
    if values.size < 4:
        return 0.0
    return float(median(np.abs(np.diff(values, 2))) / (0.6745 * np.sqrt(6)))


def _smoothed(values: np.ndarray) -> np.ndarray:
    """Return the running median of three bins."""
    if values.size < 3:
        return values
    padded = np.concatenate([values[:1], values, values[-1:]])
    return np.median(np.stack([padded[i : i + values.size] for i in range(3)]), axis=0)


def constant_part(data: MeanVelocities, first: int, last: int, drift: float) -> tuple[int, int]:
    """Return the samples [first, last) of a piece without those ends that deviate from its level.

    Parameters
    ----------
    data
        The record.
    first, last
        The piece: samples [first, last).
    drift
        Relative change that a constant speed may show.
    """
    noise = 0.0
    # try coarser bins if noise hides the ends
    for count in (4 * _BINS_OF_PIECE, 2 * _BINS_OF_PIECE, _BINS_OF_PIECE):
        count = min(count, (last - first) // 2)
        if count < 2 * limits.MIN_BINS_OF_CURVATURE.value:
            break
        at = first + (last - first) * np.arange(count + 1) // count
        values = data.means(data.time[np.minimum(at, data.time.size - 1)])
        middle = values[count // 4 : count - count // 4]
        if not np.isfinite(middle).any():
            break
        level = float(median_of_known(middle))
        # few bins determine their scatter poorly: use at least that of the finer ones
        noise = max(_scatter(middle), noise)
        limit = max(drift / 2 * abs(level), 4 * noise)
        off = np.abs(values - level) > limit
        off &= np.isfinite(values)
        before = int(np.argmin(np.append(off, False)))
        after = int(np.argmin(np.append(off[::-1], False)))
        if before + after >= count // 2:  # deviations not only at the ends: the piece has no level
            break
        first, last = int(at[before]), int(at[count - after])
        if limit > 4 * noise:
            break
        noise *= data.averaging
    return first, last


def is_constant(data: MeanVelocities, first: int, last: int, drift: float) -> bool:
    """Return whether a piece has constant speed; False only if the data show a change clearly.

    Parameters are those of `constant_part`; the notes of this module state the criteria.
    """
    count = min(_BINS_OF_PIECE, last - first)
    if count < limits.MIN_BINS_OF_CURVATURE.value:
        return True
    begin, end = float(data.time[first]), float(data.time[last - 1])
    width = (end - begin) / count
    if not width > 0:
        return True
    edges = begin + width * np.arange(count + 1)
    inside = data.means(edges)
    known = np.isfinite(inside)
    if np.count_nonzero(known) < limits.MIN_BINS_OF_CURVATURE.value:
        return True
    place = np.linspace(-1, 1, count)[known]
    inside = inside[known]
    level = float(inside.mean())
    core = slice(1, -1)  # starting and stopping transients at the ends are trimmed
    if _changes(place[core], inside[core], drift * abs(level)):
        return False
    if last - first <= _FEW_READINGS and changes_significantly(
        data.readings, begin, end, drift * abs(level)
    ):
        return False
    if _fluctuates(
        data, begin, end, last - first, limits.MAX_DRIFTS_FROM_PLATEAU.value * drift * abs(level)
    ):
        return False
    return not _is_one_motion(data, inside, begin, end, level, drift)


def _changes(place: np.ndarray, values: np.ndarray, most: float) -> bool:
    """Return whether the speed changes significantly by more than `most` along the piece."""
    cubic = _fit(place, values, 3)
    left = float(((values - cubic) ** 2).sum())
    about = float(((values - values.mean()) ** 2).sum())
    variance = max(left, 1e-12 * float((values**2).sum())) / max(values.size - 4, 1)
    if np.ptp(cubic) > most and about - left > limits.MIN_GAIN_OF_CUBIC.value * variance:
        return True
    # a kink is not cubic: compare means of quarters, whose range is 3/4 of a ramp's
    parts = np.array_split(values, 4)
    apart = float(np.ptp([part.mean() for part in parts])) * 4 / 3
    scatter = float(np.sqrt(np.mean(np.diff(values, 2) ** 2) / 6))
    sure = 8 * (1 + 8 / values.size)  # few bins determine their scatter poorly
    return apart > most and apart > sure * scatter / np.sqrt(values.size / 4)


def _fluctuates(data: MeanVelocities, begin: float, end: float, samples: int, most: float) -> bool:
    """Return whether an oscillation, not noise, changes the speed by more than `most` (rms)."""
    count = min(samples, 1024)
    # wider bins reveal changes that noise hides in narrow ones
    while count >= 4 * limits.MIN_BINS_OF_CURVATURE.value:
        values = data.means(np.linspace(begin, end, count + 1))
        values = values[np.isfinite(values)]
        variance = (
            float(values.var()) if values.size >= 4 * limits.MIN_BINS_OF_CURVATURE.value else 0.0
        )
        if variance > most**2:
            # von Neumann ratio: in white noise neighbours differ as much as distant bins
            alike = 1 - float(np.mean(np.diff(values) ** 2)) / (2 * variance)
            if (
                alike > limits.MIN_CORRELATION_OF_FLUCTUATION.value + 1 / np.sqrt(values.size)
                and alike * variance > most**2
            ):
                return True
        count //= 2
    return False


def _is_one_motion(
    data: MeanVelocities, inside: np.ndarray, begin: float, end: float, level: float, drift: float
) -> bool:
    """Return whether the piece and its neighbourhood are one smooth motion, not a plateau."""
    count = inside.size
    width = (end - begin) / count
    steps = np.arange(int(_NEIGHBOURHOOD * count) + 1)
    sides = []
    for edges in (begin - width * steps[::-1], end + width * steps):
        inner = (edges >= data.time[0] - width / 2) & (edges <= data.time[-1] + width / 2)
        values = data.means(edges[inner]) if inner.any() else np.zeros(0)
        sides.append(values)
    sides[0] = sides[0][::-1]  # from the piece outwards
    near = []
    for values in sides:
        close = np.abs(
            _smoothed(values) - level
        ) <= limits.MAX_DRIFTS_FROM_PLATEAU.value * drift * abs(level)
        near.append(values[: int(np.argmin(np.append(close, False)))])
    longest = max(len(values) for values in near)
    if longest < limits.MIN_GRADUAL_END.value * count:
        return False
    neighbours = np.concatenate([near[0][::-1], near[1]])
    if np.abs(neighbours - level).max() <= drift / 4 * abs(level):
        return False
    values = np.concatenate([near[0][::-1], inside, near[1]])
    if values.size < count + 3:
        return False
    smooth = _fit(np.linspace(-1, 1, values.size), values, 4)
    own = slice(near[0].size, near[0].size + count)
    about = float(((inside - level) ** 2).sum()) / (count - 1)
    left = float(((inside - smooth[own]) ** 2).sum()) / count * values.size / (values.size - 5)
    # the more gradually a plateau ends, the stronger the evidence required
    return bool(
        left
        < np.interp(
            longest / count,
            (limits.MIN_GRADUAL_END.value, 1),
            (limits.MAX_VARIANCE_OF_SMOOTH_MOTION.value, 1.1),
        )
        * about
    )
