"""Coarse shift between two clocks, from the friction force explained by velocity classes.

Shift the motion log by s, sort the samples of the friction force into classes of velocity
(sign and third of a decade), and compute the share of variance that the classes explain:

    R^2(s) = [sum_k S_k^2 / N_k - S^2 / N] / [Q - S^2 / N],

with N_k, S_k number and sum of the force samples in class k, and N, S, Q number, sum and sum of
squares of all. As each term is a cross-correlation, FFT gives all s of a grid at once. The result
is late, because friction builds up over a distance after each start and persists at rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from typing import NamedTuple

import numpy as np
from numpy.fft import irfft, rfft
from numpy.typing import NDArray

from tribolab.arrays.medians import median
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits

_GRID_CELLS = 1 << 14  # cells into which the longer log is divided
_CLASSES_PER_DECADE = 3  # velocity classes per decade of speed
_MAX_RIVALS = 8  # most rival shifts
_CELL_EDGE = 1e-6  # tolerance for rounding at the edge of a cell, as a share of its width
_CHANGES_PER_CLASS = 12  # ratio of changes to classes above which the FFT is used


class Coarse(NamedTuple):
    """Shift [s], half width of its uncertainty [s], and rival shifts [s]."""

    shift: float
    half: float
    rivals: Array


def motion_classes(velocity: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return velocity class and direction of each sample; a rest has those of the last motion."""
    classes = velocity_classes(velocity)
    way = np.sign(classes - _CLASSES_PER_DECADE * limits.DECADES_TO_REST.value)
    return np.where(
        way == 0,
        _CLASSES_PER_DECADE * limits.DECADES_TO_REST.value * 2 + 2 + _last_direction(way),
        classes,
    ), way


def velocity_classes(velocity: Array) -> NDArray[np.int64]:
    """Return the class number of each velocity, from 0 for fast backward, through rest, to forward.

    >>> velocity_classes(np.array([-1.0, 0.0, 1.0, 0.9, 0.1])).tolist()
    [0, 15, 30, 30, 27]
    """
    speed = np.abs(np.nan_to_num(velocity))
    fastest = speed.max()
    rank = np.zeros(len(speed), dtype=np.int64)
    moving = speed > fastest * 10.0**-limits.DECADES_TO_REST.value * (1.0 + 1e-9)
    # the fastest speed is in the middle of a class, so that its noise stays in one class
    level = np.round(_CLASSES_PER_DECADE * np.log10(speed[moving] / fastest)).astype(np.int64)
    rank[moving] = np.maximum(level + _CLASSES_PER_DECADE * limits.DECADES_TO_REST.value, 1)
    return (
        rank * np.sign(np.nan_to_num(velocity)).astype(np.int64)
        + _CLASSES_PER_DECADE * limits.DECADES_TO_REST.value
    )


def _last_direction(way: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the direction of the last motion, because friction persists at rest."""
    moved = np.maximum.accumulate(np.where(way != 0, np.arange(len(way)), 0))
    return way[moved]


def coarse_shift(
    force_time: Array,
    force: Array,
    motion_time: Array,
    classes: NDArray[np.int64],
    expected: float,
    apart: float = 0.0,
) -> Coarse | None:
    """Return the best shift on a grid, its uncertainty, and rivals at least `apart` [s] away."""
    spans = force_time[-1] - force_time[0], motion_time[-1] - motion_time[0]
    cell = max(spans) / _GRID_CELLS
    cells = [int(span / cell + _CELL_EDGE) + 1 for span in spans]
    where = ((force_time - force_time[0]) / cell + _CELL_EDGE).astype(np.int64)
    weights = (np.ones(len(force)), force, force**2)
    sums = [np.asarray(np.bincount(where, w, cells[0]), dtype=float) for w in weights]
    grid = motion_time[0] + cell * (np.arange(cells[1]) + 0.5)
    on_grid = classes[np.clip(np.searchsorted(motion_time, grid) - 1, 0, None)]

    lags, (number, whole, squares), by_class = _sums_by_lag(sums, on_grid)
    between = np.zeros(len(lags))
    for n_k, s_k in by_class:
        between += np.where(n_k > 0.5, s_k**2 / np.maximum(n_k, 0.5), 0.0)
    enough = number >= limits.MIN_OVERLAP.value * number.max()
    mean_part = whole**2 / np.maximum(number, 0.5)
    spread = np.maximum(squares - mean_part, 1e-9)
    explained = np.where(enough, (between - mean_part) / spread, -np.inf)

    shifts = lags * cell + force_time[0] - motion_time[0]
    best = explained.max()
    usual = median(explained[enough])
    if best < limits.MIN_EXPLAINED_VARIANCE.value or best - usual < limits.MIN_CONTRAST.value * min(
        1.0, 1.0 - usual
    ):
        return None
    peak = (explained >= np.roll(explained, 1)) & (explained >= np.roll(explained, -1))
    tie = max(
        usual + limits.MIN_RIVAL_PEAK.value * (best - usual),
        best - 0.5 * (1.0 - best) - limits.ROUNDING_OF_VARIANCE.value,
    )
    good = shifts[peak & (explained >= tie)]
    chosen = float(good[np.argmin(np.abs(good - expected))])
    # repeated motion also fits at other shifts, although fewer samples overlap
    may = np.flatnonzero(peak & (explained > usual + 0.5 * (best - usual)))
    may = may[np.argsort(-explained[may])]
    rivals: list[float] = []
    for shift in map(float, shifts[may]):
        if len(rivals) == _MAX_RIVALS:
            break
        if all(abs(shift - other) > max(apart, 8.0 * cell) for other in (chosen, *rivals)):
            rivals.append(shift)
    return Coarse(chosen, 2.0 * cell, np.array(rivals))


def _sums_by_lag(
    sums: list[Array], classes: NDArray[np.int64]
) -> tuple[NDArray[np.int64], list[Array], Iterator[tuple[Array, Array]]]:
    """Return lags [cells], the sums of all samples, and number and sum by class at each lag.

    Only lags with enough overlap of both logs are included.
    """
    wide, cells = len(classes), len(sums[0])
    lags = np.arange(-wide, cells)
    ends = np.flatnonzero(np.diff(classes, prepend=-1, append=-1))
    piled = [np.concatenate([np.zeros(wide + 1), np.cumsum(s)]) for s in sums]
    piled = [np.concatenate([p, np.full(wide, p[-1])]) for p in piled]

    number = piled[0][wide : wide + len(lags)] - piled[0][: len(lags)]
    enough = np.flatnonzero(number >= limits.MIN_OVERLAP.value * number.max())
    begin = max(int(enough[0]) - 1, 0)  # with one lag of too little overlap on each side
    lags = lags[begin : int(enough[-1]) + 2]

    def sum_below(p: Array, first: int, last: int) -> Array:
        p = p[begin:]
        return p[last : last + len(lags)] - p[first : first + len(lags)]

    whole = [sum_below(p, 0, wide) for p in piled]
    values = np.unique(classes).tolist()
    if len(ends) > _CHANGES_PER_CLASS * len(values):
        return lags, whole, _correlated_classes(sums[:2], classes, lags)
    spans = list(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))

    def by_class() -> Iterator[tuple[Array, Array]]:
        for k in values:
            own = [span for span in spans if classes[span[0]] == k]
            number, total = (
                reduce(np.add, (sum_below(p, *span) for span in own)) for p in piled[:2]
            )
            yield number, total

    return lags, whole, by_class()


def _correlated_classes(
    sums: list[Array], classes: NDArray[np.int64], lags: NDArray[np.int64]
) -> Iterator[tuple[Array, Array]]:
    """Yield number and sum of the force samples in each class (lag), by FFT."""
    length = _power_of_two(len(sums[0]) + len(classes))
    count, total = (rfft(s, length) for s in sums)
    for k in np.unique(classes):
        here = np.conj(rfft((classes == k).astype(float), length))
        yield irfft(count * here, length)[lags], irfft(total * here, length)[lags]


def _power_of_two(least: int) -> int:
    """Return a power of two for a fast FFT; finding a shorter fast length would take longer."""
    return 1 << (least - 1).bit_length()


class Classes:
    """Sum of squares of the force that classes of motion explain, at any clock shift."""

    def __init__(
        self, force_time: Array, force: Array, motion_time: Array, classes: NDArray[np.int64]
    ):
        self._time, self._force = force_time, force
        self._edges = np.arange(len(force) + 1.0)
        self._sum = np.concatenate([[0.0], np.cumsum(force)])
        self._square = np.concatenate([[0.0], np.cumsum(force**2)])
        change = np.flatnonzero(np.diff(classes)) + 1
        middles = 0.5 * (motion_time[change] + motion_time[change - 1])
        self._moments = np.concatenate([motion_time[:1], middles, motion_time[-1:]])
        self._classes = classes[np.concatenate([[0], change])]
        self.period = max(
            float(np.percentile(np.diff(time), 5)) for time in (force_time, motion_time)
        )

    def _parts(self, shifts: Array) -> tuple[Array, Array, Array]:
        """Return changes as sample numbers (shift, change); count and sum (shift, class)."""
        at = np.interp(self._moments + shifts[:, None], self._time, self._edges[:-1] + 0.5)
        total = self._by_class(np.diff(np.interp(at, self._edges, self._sum)))
        return at, self._by_class(np.diff(at)), total

    def explained(self, shifts: Array) -> Array:
        """Return the explained sums of squares (shift), for shifts with nearly equal overlap."""
        return _explained(*self._parts(shifts)[1:])

    def _residual(self, shift: float) -> Array:
        at, number, total = (part[0] for part in self._parts(np.array([shift])))
        means = total / np.maximum(number, 1e-9)
        places = np.clip(np.round(at).astype(np.int64), 0, len(self._force))
        inside = self._force[places[0] : places[-1]]
        return inside - np.repeat(means[self._classes], np.diff(places))

    def ratio(self, shift: float) -> float:
        """Return the share of the variance of the force that classes explain at a shift."""
        return float(self.ratios(np.array([shift]))[0])

    def ratios(self, shifts: Array) -> Array:
        """Return the explained share of the variance at each of several shifts."""
        at, number, total = self._parts(shifts)
        squares = np.diff(np.interp(at[:, [0, -1]], self._edges, self._square))[:, 0]
        whole = squares - total.sum(axis=1) ** 2 / np.maximum(at[:, -1] - at[:, 0], 1e-9)
        return _explained(number, total) / np.maximum(whole, 1e-12)

    def refined(self, shift: float, around: float) -> float:
        """Return the shift [s] near a coarse one at which the classes explain the force best."""
        while around > 0.2 * self.period:
            shifts = shift + around * np.linspace(-1.0, 1.0, 33)
            shift = float(shifts[np.argmax(self.explained(shifts))])
            around /= 8.0
        return shift

    def _by_class(self, values: Array) -> Array:
        """Return the sum over each class of the values in all intervals (shift, class)."""
        rows, classes = len(values), int(self._classes.max()) + 1
        place = self._classes + classes * np.arange(rows)[:, None]
        sums = np.bincount(place.ravel(), values.ravel(), rows * classes)
        return np.asarray(sums, dtype=float).reshape(rows, classes)

    def significance(self, shift: float) -> float:
        """Return the F ratio of explained to residual variance, corrected for correlation."""
        ratio = self.ratio(shift)
        independent = len(self._force) / _correlation_length(self._residual(shift))
        classes = len(np.unique(self._classes)) - 1
        return ratio / classes * independent / max(1.0 - ratio, 1e-12)

    def uncertainty(self, shift: float) -> float:
        """Return the change of shift [s] that lowers the explained sum of squares significantly."""
        residual = self._residual(shift)
        if not residual.size:
            return np.inf
        variance = float(residual.var())
        if variance == 0.0:
            return 0.5 * self.period
        allowed = 4.0 * variance * _correlation_length(residual)
        step = 0.5 * self.period
        while step < 1e6 * self.period:
            below, top, above = self.explained(shift + step * np.array([-1.0, 0.0, 1.0]))
            if top - max(below, above) > allowed:
                break
            step *= 1.25
        return step


def _explained(number: Array, total: Array) -> Array:
    """Return the sum of squares explained by classes, from count and sum of the samples in each."""
    full = number > 0
    between = np.where(full, total**2 / np.where(full, number, 1.0), 0.0).sum(axis=-1)
    whole = np.where(full.any(axis=-1), number.sum(axis=-1), 1.0)
    # zero where the logs do not overlap
    return np.where(full.any(axis=-1), between - total.sum(axis=-1) ** 2 / whole, 0.0)


def _correlation_length(residual: Array) -> float:
    """Return the correlation length in samples, from autocorrelation up to its first zero."""
    if not residual.size:
        return 1.0
    block = -(-len(residual) // _GRID_CELLS)
    rows = len(residual) // block
    means = residual[: rows * block].reshape(rows, block).mean(axis=1)
    if rows < 2 or not means.any():
        return float(block)
    spectrum = np.abs(rfft(means, _power_of_two(2 * rows))) ** 2
    correlation = irfft(spectrum)[:rows]
    correlation /= correlation[0]
    negative = np.flatnonzero(correlation <= 0)
    until = int(negative[0]) if negative.size else rows
    return float(block * (2.0 * correlation[:until].sum() - 1.0))
