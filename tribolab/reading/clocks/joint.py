"""Shift between two clocks from one fit of the friction force by all effects of the motion.

At a trial shift the force is a sum, linear in its amplitudes, of

    functions of the distance since the last reversal: stop operators S_r(x) = x - play_r(x) with
        lengths r on a grid (one for sticking, a difference of two for slack, a sum for hysteresis);
    functions of the speed: sign(v) times hat functions of log |v|;
    inertia of the mass on the sensor: dv/dt;
    slow drift: hat functions of time.

The residual as a function of the shift gives the profile likelihood of the shift. If the motion
log records the sample and not the stage, the force rises elastically before the log shows motion.
In a second model the reversals of the force are therefore ramps that end at the start of motion and
last as long as the stage needs to travel the length r. The results
of both models are weighted by their fit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribolab.arrays.medians import median
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.basis import SLACK_LENGTHS, Basis
from tribolab.reading.clocks.force_samples import DRIFT_FUNCTIONS, ForceSamples, force_samples

_ROUNDING = 1e-14  # relative rounding error of a difference of products
_CANCELLATION = 1e-6  # relative sum of squares below which it is computed sample by sample
_POWER_RANGE = 2.0, 8.0  # least and largest exponent of the weights by unexplained variance
_POWER_PER_RESIDUAL = 0.01  # exponent per independent residual
# prior probability that the force leads; all slack values share the rest equally
_PRIOR_FORCE_LEADS = 0.5
_RIDGE_PENALTY = 1e-7
_GRID_SHIFTS = 17  # shifts of the first grid
_REFINED_SHIFTS = 13  # shifts of a refined grid, about one per standard error


class JointShift(NamedTuple):
    """Shift [s], standard deviation [s], mean time it refers to [s], and result of each model.

    `stroke` is the duration of the shortest fast stroke [s].
    """

    shift: float
    uncertainty: float
    time: float
    stroke: float
    answers: list[Answer]

    @property
    def unexplained(self) -> float:
        """Share of the force variance unexplained by the best model."""
        return min(answer.unexplained for answer in self.answers)


class Answer(NamedTuple):
    """Result of one model: shift [s], its error [s], unexplained share of variance, inertia share.

    `freedom` is the number of independent residuals, `prior` the prior probability of the model.
    """

    model: str
    shift: float
    error: float
    unexplained: float
    inertia: float
    freedom: float
    prior: float


def shift_from_motion(
    force_time: Array, force: Array, basis: Basis, shift: float, span: float, least: float = 0.0
) -> JointShift | None:
    """Estimate the shift by a fit of the force by the motion, around a first estimate.

    Parameters
    ----------
    force_time, force
        Force log: its own clock [s] and the friction force.
    basis
        Basis functions on the clock of the motion log.
    shift, span
        Start and half width of the search [s]. The half width is limited to half of a fast stroke,
        or to `least` [s] if that is longer.

    Returns
    -------
    JointShift or None
        None if there are too few samples around the changes of motion, or the fit is poor.
    """
    period = sampling(force_time, basis, shift)
    span = min(span, max(least, 0.5 * basis.stroke))
    answers = fit_jointly(force_time, force, basis, shift, span, period)
    if (
        not answers
        or min(answer.unexplained for answer in answers) > limits.MAX_UNEXPLAINED_VARIANCE.value
    ):
        return None
    mean, error = mixture(answers)
    least = float(np.hypot(0.5 * period, 0.2 * basis.averaged))
    when = float(basis.time[basis.events].mean())
    return JointShift(mean, float(np.hypot(error, least)), when, basis.stroke, answers)


def sampling(force_time: Array, basis: Basis, shift: float) -> float:
    """Return the sampling intervals [s] of both logs after starts, added in quadrature."""
    own, other = _interval(force_time, basis, shift), _interval(basis.time, basis, 0.0)
    return float(np.hypot(own, other))


def _interval(time: Array, basis: Basis, shift: float) -> float:
    """Return the median sampling interval [s] of a log after the starts of motion."""
    at = np.searchsorted(time, basis.time[basis.begins] + shift)
    at = np.clip(at[:, None] + np.arange(1, 12), 0, len(time) - 1)
    return float(median(np.diff(time[at], axis=1)))


def fit_jointly(
    force_time: Array, force: Array, basis: Basis, shift: float, span: float, finest: float
) -> list[Answer]:
    """Fit the force by each model, around a shift [s]; `finest` [s] limits the resolution."""
    first = force_samples(force_time, force, basis, shift, span)
    models = []
    for name, table in basis.models:
        answer = _shift_of_model(force_time, force, basis, table, shift, span, finest, first)
        if answer is not None:
            models.append((name, table, answer))
    if not models:
        return []
    shifts = np.array([answer[0] for _, _, answer in models])
    # the same samples for all models, so that residuals are comparable
    half = 0.5 * float(np.ptp(shifts)) + finest
    used = force_samples(force_time, force, basis, 0.5 * float(shifts.min() + shifts.max()), half)
    if not used.force.size:  # the shifts are too far apart for common samples
        return []
    answers = []
    for name, table, (at, error) in models:
        prior = (
            _PRIOR_FORCE_LEADS
            if name == "before"
            else (1.0 - _PRIOR_FORCE_LEADS) / (1 + len(SLACK_LENGTHS))
        )
        near = at + error * np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
        answers.append(
            Answer(name, at, error, *_Fit(used, basis.rows, table, near).profile()[1:], prior)
        )
    return answers


def mixture(answers: list[Answer]) -> tuple[float, float]:
    """Return mean and standard deviation [s] of the shifts of all models, weighted by their fit."""
    unexplained = np.array([answer.unexplained for answer in answers])
    best = int(np.argmin(unexplained))
    # if residuals are correlated, no model is exact, and poorer fits keep some weight
    power = np.clip(_POWER_PER_RESIDUAL * answers[best].freedom, *_POWER_RANGE)
    weight = np.array([answer.prior for answer in answers])
    weight *= (unexplained / unexplained[best]) ** -power
    weight /= weight.sum()
    shift = np.array([answer.shift for answer in answers])
    error = np.array([answer.error for answer in answers])
    mean = float(weight @ shift)
    return mean, limits.ERROR_OF_MODELS.value * float(
        np.sqrt(weight @ (error**2 + (shift - mean) ** 2))
    )


def _shift_of_model(
    force_time: Array,
    force: Array,
    basis: Basis,
    table: Array,
    shift: float,
    span: float,
    finest: float,
    samples: ForceSamples,
) -> tuple[float, float] | None:
    """Return shift and error [s] of one model, from ever narrower grids; None if it diverges."""
    at, half = shift, span
    for narrowed in range(12):
        if narrowed:
            samples = force_samples(force_time, force, basis, at, half)
        if len(samples.time) < 3 * len(table) + 30:
            return None
        shifts = at + half * np.linspace(-1.0, 1.0, _REFINED_SHIFTS if narrowed else _GRID_SHIFTS)
        likelihood = _Fit(samples, basis.rows, table, shifts).profile()[0]
        weight = np.exp(likelihood - likelihood.max())
        weight /= weight.sum()
        mean = float(weight @ shifts)
        error = float(np.sqrt(weight @ (shifts - mean) ** 2))
        if error > 0.45 * half:
            break
        at = mean
        if half <= max(6.0 * error, finest):
            break
        half = max(6.0 * error, 0.15 * half, 0.5 * finest)
    # outside the search range: no result
    return None if abs(mean - shift) > 1.2 * span else (mean, error)


class _Fit:
    """Linear fit of the force by the basis functions of one model, at several trial shifts."""

    def __init__(self, samples: ForceSamples, motion_time: Array, table: Array, shifts: Array):
        self.samples, self.shifts = samples, shifts
        self.whole = float(samples.force @ samples.force)
        rows = _rows_between(motion_time, samples.time - shifts.max(), samples.time - shifts.min())
        self.motion_time, values = motion_time[rows], np.ascontiguousarray(table[:, rows].T)
        self.step = np.diff(self.motion_time)
        self.table, self.change = values[:-1], np.diff(values, axis=0)
        shape = len(samples.time), values.shape[1]
        self._columns, self._begin = np.empty(shape), np.empty(shape)

    def columns(self, shift: float) -> Array:
        """Return the basis functions at the times of the samples (sample, function).

        The next call overwrites it: for hundreds of calls per run, new memory would take half of
        the time.
        """
        at = self.samples.time - shift
        i = self.motion_time[1:-1].searchsorted(at)  # clipped to the ends of the log
        at -= self.motion_time.take(i)
        at /= self.step.take(i)
        part = np.clip(at, 0.0, 1.0, out=at)
        # mode "clip" avoids a copy; no index is out of range
        self.change.take(i, axis=0, out=self._columns, mode="clip")
        self._columns *= part[:, None]
        self.table.take(i, axis=0, out=self._begin, mode="clip")
        self._columns += self._begin
        return self._columns

    def squares(self) -> tuple[Array, Array, Array]:
        """Return residual sum of squares, amplitudes and share of inertia at each shift."""
        normals, rights, whole = [], [], []
        for shift in self.shifts:
            columns = self.columns(shift)
            # removing the drift from the products is faster than from the columns
            along = self.samples.both @ columns
            products = columns.T @ columns
            whole.append(products.diagonal())
            normals.append(products - along[:-1].T @ along[:-1])
            rights.append(along[-1])
        normal, right = np.stack(normals), np.stack(rights)[:, :, None]
        own = np.einsum("sii->si", normal)
        ridge = _RIDGE_PENALTY * own + 1e-12 * own.sum(axis=1, keepdims=True)
        # a column that the drift explains leaves only rounding errors
        ridge = np.maximum(ridge, _ROUNDING * np.stack(whole) + np.finfo(float).tiny)
        ridged = normal + ridge[:, :, None] * np.eye(own.shape[1])
        amplitudes = np.linalg.solve(ridged, right)
        explained = amplitudes * (2.0 * right - normal @ amplitudes)
        left = self.whole - explained.sum(axis=(1, 2))
        amplitudes = amplitudes[:, :, 0]
        for k in np.flatnonzero(left < _CANCELLATION * self.whole):
            residual = self.residual(self.shifts[k], amplitudes[k])
            left[k] = residual @ residual
        inertia = np.sqrt(np.maximum(own[:, -1], 0.0)) * np.abs(amplitudes[:, -1])
        return left, amplitudes, inertia / np.sqrt(self.whole)

    def residual(self, shift: float, amplitudes: Array) -> Array:
        """Return the residual of the force."""
        explained = self.columns(shift) @ amplitudes
        drift = self.samples.drift
        left: Array = self.samples.force - explained + drift @ (drift.T @ explained)
        return left

    def profile(self) -> tuple[Array, float, float, float]:
        """Return log likelihoods (shift), then residual, inertia and freedom of the best fit."""
        squares, amplitudes, inertia = self.squares()
        best = int(np.argmin(squares))
        residual = self.residual(self.shifts[best], amplitudes[best])
        correlation = float(residual[1:] @ residual[:-1]) / max(float(residual @ residual), 1e-30)
        correlation_length = max(1.0, (1.0 + correlation) / max(1.0 - correlation, 1e-3))
        freedom = max(len(residual) - amplitudes.shape[1] - DRIFT_FUNCTIONS, 1) / correlation_length
        squares = np.maximum(squares, 1e-12 * self.whole)
        return (
            -0.5 * freedom * np.log(squares),
            float(squares.min()) / self.whole,
            float(inertia[best]),
            freedom,
        )


def _rows_between(motion_time: Array, first: Array, last: Array) -> NDArray[np.int64]:
    """Return the rows of a motion log needed to interpolate within time intervals, each once."""
    ends = len(motion_time) - 2
    low = np.clip(np.searchsorted(motion_time, first) - 1, 0, ends)
    high = np.clip(np.searchsorted(motion_time, last) - 1, 0, ends) + 1
    low[1:] = np.maximum(low[1:], high[:-1] + 1)
    count = np.maximum(high - low + 1, 0)
    before = np.cumsum(count) - count
    return np.repeat(low - before, count) + np.arange(int(count.sum()))
