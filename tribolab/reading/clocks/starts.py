"""Shift between two clocks from the starts of motion: force changes only after the table moves.

Before a start, at t_0 on the motion clock, the friction force only relaxes; after it, it is an
unknown function of the sliding distance d, since friction builds up over a distance:

    F = a + b u + c u^2 + sum_j A_j [1 - exp(-d(t - s) / l_j)],   u = min(t - s - t_0, 0),

with lengths l_j from the distance within a few samples to that within the window. The increase of
the residual with the shift s gives the error of each start: a millisecond for a fast one, large for
a slow one. The starts are combined robustly. Stops are not used: friction follows the velocity
while the table decelerates, and remains when it is at rest.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribolab.arrays.medians import median
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.motion import integral

_MAX_STARTS = 64
_COMPARED_SAMPLES = 200  # samples used after a start, and at most as many before it
_THINNED_SAMPLES = 160  # longer windows are thinned to this many samples
_FIRST_SAMPLES = 0.5  # the shortest length is the distance covered in this many samples
_CURVE_TERMS = 8  # number of exponentials in a start's curve


class StartShift(NamedTuple):
    """Shift in the middle of the motion log [s] and rate, with their standard deviations."""

    shift: float
    uncertainty: float
    rate: float
    rate_uncertainty: float


class _Start(NamedTuple):
    """Start of motion: time on the motion clock, and window before and after it [s]."""

    time: float
    before: float
    after: float
    few: float  # s, time to slide the shortest length
    sampling: float  # s, resolution of the two logs


class _Curve(NamedTuple):
    """Path at a start [m], and the lengths of the exponentials after it [m]."""

    begin: float
    lengths: Array


class Logs:
    """The two logs, with their integrals over time."""

    def __init__(
        self,
        force_time: Array,
        force: Array,
        motion_time: Array,
        velocity: Array,
        way: NDArray[np.int64],
    ):
        self.force_time, self.force, self.motion_time = force_time, force, motion_time
        self.way = way  # -1 backward, 0 at rest, 1 forward
        self.impulse = integral(force_time, force)
        self.speed = np.abs(velocity)
        self.change = np.diff(self.speed) / np.diff(motion_time)
        self.path = integral(motion_time, self.speed)
        self._curves: dict[_Start, _Curve] = {}

    def slid(self, start: _Start, since: Array) -> Array:
        """Return the distance [m] slid at times `since` [s] after a start."""
        return np.maximum(self._path(start.time + since) - self._curve(start).begin, 0.0)

    def _curve(self, start: _Start) -> _Curve:
        if start not in self._curves:
            ends = start.time + np.array([0.0, start.few, start.after])
            begin, early, end = self._path(ends).tolist()
            end = max(end - begin, 1e-300)
            shortest = max(early - begin, 1e-5 * end)
            lengths = shortest * (end / shortest) ** np.linspace(0.0, 1.0, _CURVE_TERMS)
            self._curves[start] = _Curve(begin, lengths)
        return self._curves[start]

    def _path(self, time: Array) -> Array:
        """Return the path [m] at given times, with velocity interpolated linearly."""
        time = np.clip(time, self.motion_time[0], self.motion_time[-1])
        # searched only in the part that is needed
        ends = np.searchsorted(self.motion_time, [time.min(), time.max()], "right")
        first, last = np.minimum(ends, len(self.path) - 1) - 1
        part = slice(first, last + 2)
        i = np.searchsorted(self.motion_time[part], time, "right") - 1
        i = np.clip(i, 0, last - first)
        since = time - self.motion_time[part][i]
        way: Array = self.change[part][i] * (0.5 * since)
        way += self.speed[part][i]
        way *= since
        way += self.path[part][i]
        return way

    def shapes(self, start: _Start, since: Array) -> Array:
        """Return the functions of time of which the force is composed (..., function, time)."""
        lengths = self._curve(start).lengths
        out = np.empty((*since.shape[:-1], 3 + _CURVE_TERMS, since.shape[-1]))
        out[..., 0, :] = 1.0
        np.minimum(since, 0.0, out=out[..., 1, :])
        out[..., 1, :] /= start.before
        np.square(out[..., 1, :], out=out[..., 2, :])
        after = out[..., 3:, :]
        np.multiply(self.slid(start, since)[..., None, :], -1.0 / lengths[:, None], out=after)
        np.expm1(after, out=after)
        np.negative(after, out=after)
        return out


def changes(way: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the index of the first sample of each rest and stroke, and of the last sample."""
    return np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way) - 1]])


def _starts(logs: Logs, shift: float) -> list[_Start]:
    """Return the starts, including reversals, that both logs cover."""
    change = changes(logs.way)
    moving = logs.way[change[1:-1]] != 0
    numbers = np.flatnonzero(moving & (np.diff(change[1:]) >= 8)) + 1
    if len(numbers) > _MAX_STARTS:
        numbers = numbers[np.linspace(0, len(numbers) - 1, _MAX_STARTS).astype(np.int64)]
    starts = []
    for before, first, last in zip(
        change[numbers - 1], change[numbers], change[numbers + 1], strict=True
    ):
        begin = float(logs.motion_time[first - 1])
        at = int(np.searchsorted(logs.force_time, begin + shift))
        # not right at the start, as the shift is not yet known
        after = np.diff(logs.force_time[at + 20 : at + 80])
        ahead = np.diff(logs.force_time[max(at - 12, 0) : max(at - 1, 0)])
        if len(after) < 20 or len(ahead) < 5:
            continue
        interval = float(median(after))
        moved = float(median(np.diff(logs.motion_time[first : first + 16])))
        rest, stroke = begin - logs.motion_time[before], logs.motion_time[last] - begin
        starts.append(
            _Start(
                begin,
                min(0.6 * rest, max(_COMPARED_SAMPLES * interval, 12.0 * float(median(ahead)))),
                min(0.5 * stroke, max(_COMPARED_SAMPLES * interval, 12.0 * moved)),
                _FIRST_SAMPLES * interval,
                0.5 * float(np.hypot(interval, moved)),
            )
        )
    return [start for start in starts if start.before > 0]


def shift_from_starts(
    logs: Logs, shift: float, span: float, allowed: Callable[[Array], NDArray[np.bool_]]
) -> StartShift | None:
    """Estimate the shift from the starts of motion.

    Parameters
    ----------
    logs
        Both logs.
    shift, span
        Start and half width of the search [s].
    allowed
        Function that returns a mask of the shifts [s] to be tried; it must allow `shift`.

    Returns
    -------
    StartShift or None
        None if no start determines it.
    """
    for width in (span, 0.5 * span):  # the samples around a start depend on the shift
        starts = _starts(logs, shift)
        if not starts:
            return None
        shifts = shift + width * np.linspace(-1.0, 1.0, 161)
        shift = _best_common_shift(logs, starts, shifts[allowed(shifts)])
    middle = 0.5 * (logs.motion_time[0] + logs.motion_time[-1])
    since = np.array([start.time for start in starts]) - middle
    sampling = np.array([start.sampling for start in starts])
    centre = np.full(len(starts), shift)
    seen = np.full((2, len(starts)), np.inf)
    half = 0.05 * span
    while True:
        step = half / 20.0
        offsets = half * np.linspace(-1.0, 1.0, 41)
        for k, start in enumerate(starts):
            moments, error = _shift_of_start(logs, start, centre[k] + offsets)
            # without information, error = 0.58 half; near the ends of the grid a peak is cut off
            if error < 0.4 * half and abs(moments - centre[k]) < 0.7 * half:
                seen[:, k] = moments, error
        found = np.isfinite(seen[1])
        if not found.any():
            return None
        # no start is known better than the sampling
        errors = np.hypot(seen[1], sampling)
        fit = _combined(since[found], seen[0][found], errors[found], sampling.min())
        if step < sampling.min():
            return fit
        centre = fit.shift + fit.rate * since
        half = 4.0 * step


def _best_common_shift(logs: Logs, starts: list[_Start], shifts: Array) -> float:
    """Return the shift on a grid at which the force around all starts fits best."""
    total = np.zeros(len(shifts))
    half = np.sinh(np.linspace(0.0, 4.0, 49)) / np.sinh(4.0)  # finer near the start
    for start in starts:
        edges = np.concatenate([-start.before * half[::-1], start.after * half[1:]])
        basis = np.linalg.qr(logs.shapes(start, 0.5 * (edges[1:] + edges[:-1])).T)[0]
        impulse = np.interp(start.time + edges + shifts[:, None], logs.force_time, logs.impulse)
        means = np.diff(impulse, axis=1) / np.diff(edges)
        means -= means.mean(axis=1, keepdims=True)
        residual = means - (means @ basis) @ basis.T
        # relative to the local variance, as otherwise the quietest interval would fit best
        variance = np.maximum((means**2).sum(axis=1), 1e-30)
        total += np.logaddexp(
            _likelihood(residual, variance, basis.shape[1]), -limits.MAX_LIKELIHOOD_OF_START.value
        )
    return float(shifts[np.argmax(total)])


def _shift_of_start(logs: Logs, start: _Start, shifts: Array) -> tuple[float, float]:
    """Return the shift and its standard deviation [s] from the force around one start of motion."""
    window = start.time + np.array([shifts[0] - start.before, shifts[-1] + start.after])
    first, last = np.searchsorted(logs.force_time, window)
    part = slice(first, last, max(1, -(-(last - first) // _THINNED_SAMPLES)))
    time, force = logs.force_time[part], logs.force[part]
    force = force - force.mean()
    shapes = logs.shapes(start, time - start.time - shifts[:, None])
    if len(time) < shapes.shape[1] + 8:
        return float(shifts.mean()), np.inf
    normal = shapes @ np.swapaxes(shapes, 1, 2)
    # the curves are nearly collinear, and single amplitudes are not needed
    ridge = 1e-8 * np.trace(normal, axis1=1, axis2=2)
    normal += ridge[:, None, None] * np.eye(shapes.shape[1])
    amplitudes = np.linalg.solve(normal, (shapes @ force)[..., None])[..., 0]
    residual = force - (amplitudes[:, None, :] @ shapes)[:, 0]
    weight = np.exp(_likelihood(residual, np.ones(len(shifts)), shapes.shape[1]))
    weight /= weight.sum()
    mean = float(weight @ shifts)
    return mean, float(np.sqrt(weight @ (shifts - mean) ** 2 + (shifts[1] - shifts[0]) ** 2 / 12))


def _likelihood(residual: Array, variance: Array, parameters: int) -> Array:
    """Return the log likelihood of each row relative to the best, for correlated residuals."""
    squares = np.maximum((residual**2).sum(axis=1), 1e-30)
    relative = squares / variance
    best = residual[np.argmin(relative)]
    correlation = float(best[1:] @ best[:-1]) / max(float(best @ best), 1e-30)
    correlation_length = max(1.0, (1.0 + correlation) / max(1.0 - correlation, 1e-3))
    freedom = max(residual.shape[1] - parameters - 1, 1) / correlation_length
    return -0.5 * freedom * np.log(relative / relative.min())


def _combined(since: Array, shifts: Array, errors: Array, common: float) -> StartShift:
    """Return shift and rate from the shifts of all starts, `since` [s] after the middle."""
    design = np.stack([np.ones_like(since), since], axis=1)
    prior = np.diag([0.0, limits.CLOCK_RATE_ERROR.value**-2])
    order = np.argsort(shifts)
    half = np.cumsum(errors[order] ** -2.0)
    # the first guess is the weighted median, on which outliers have little effect
    middle = shifts[order][np.searchsorted(half, 0.5 * half[-1])]
    solution = np.array([middle, 0.0])
    for _ in range(50):
        apart = (shifts - design @ solution) / errors
        weight = errors**-2.0 / (1.0 + (apart / 2.0) ** 2)
        before, weighted = solution, weight[:, None] * design
        solution = np.linalg.solve(design.T @ weighted + prior, weighted.T @ shifts)
        if abs(design @ (solution - before)).max() < 1e-9 * errors.min():
            break
    apart = (shifts - design @ solution) / errors
    squares = float((errors**2 * weight) @ apart**2)
    scatter = max(1.0, squares / max(len(shifts) - 1, 1))
    normal = design.T @ (weight[:, None] * design) / scatter + prior
    error = np.sqrt(np.diag(np.linalg.inv(normal)))
    if error[1] > limits.MAX_ERROR_OF_CLOCK_RATE.value * limits.CLOCK_RATE_ERROR.value:
        # a poorly determined rate would only move the shift away from the known time
        solution = np.array([solution @ (weight @ design) / weight.sum(), 0.0])
    # the sampling delays all starts alike, so this `common` error does not average out
    error[0] = np.hypot(error[0], common)
    return StartShift(float(solution[0]), float(error[0]), float(solution[1]), float(error[1]))
