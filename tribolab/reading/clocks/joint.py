"""How far apart two clocks are, from one fit of the friction force by all that the motion does.

At a trial shift the force is a sum, linear in its amplitudes, of

    what rises with the distance moved since the way turned: stops S_r(x) = x - play_r(x) with
        lengths r on a grid (a stick is a stop, slack a difference of two, hysteresis a sum);
    what goes with the speed: sign(v) times hat functions of log |v|;
    the inertia of what hangs on the sensor: dv/dt;
    a slow drift: hat functions of time.

The residual as a function of the shift is its profile likelihood. Where the motion log shows the
sample and not the stage, the force rises elastically before the log shows motion: in a second
model the turns of the force are ramps that end where motion begins, as long as the distance takes
that the stage goes. The answers of both models are weighed by how well they fit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribolab.arrays.medians import median
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.basis import SLACK_LENGTHS, Basis

_FITTED_SAMPLES = 2000  # of the force, looked at in one fit
_CANCELLATION = 1e-6  # of the whole: a difference of sums that is smaller is summed itself
_DRIFT_FUNCTIONS = 8  # hat functions of time, at most
_POWER_RANGE = 2.0, 8.0  # of what a model leaves unexplained: how much less it counts
_POWER_PER_RESIDUAL = 0.01  # of the independent residuals
# how likely it is beforehand that force leads; else any slack is as likely
_PRIOR_FORCE_LEADS = 0.5
_MAX_EVENTS = 60
_RIDGE_PENALTY = 1e-7
_GRID_SHIFTS = 17  # on a grid
_REFINED_SHIFTS = 13  # of a grid about what the one before found: one to each standard error


class JointShift(NamedTuple):
    """Shift [s], its standard deviation [s], the mean moment it refers to [s], each model's answer.

    `stroke` is the duration of the shortest of the fast strokes [s].
    """

    shift: float
    uncertainty: float
    time: float
    stroke: float
    answers: list[Answer]

    @property
    def unexplained(self) -> float:
        """Part of the force that the best model leaves unexplained."""
        return min(answer.unexplained for answer in self.answers)


class Answer(NamedTuple):
    """What one model says: shift [s], its error [s], the parts left unexplained and of inertia.

    `freedom` is the number of independent residuals, `prior` how likely the model is beforehand.
    """

    model: str
    shift: float
    error: float
    unexplained: float
    inertia: float
    freedom: float
    prior: float


def told_by_motion(
    force_time: Array,
    force: Array,
    basis: Basis,
    shift: float,
    span: float,
    least: float = 0.0,
) -> JointShift | None:
    """Tell the shift by fitting the force by the motion, around a first estimate.

    Parameters
    ----------
    force_time, force
        Force log: its own clock [s] and the friction force.
    basis
        What the motion log shows, on its clock.
    shift, span
        Where to begin, and how far on either side of it to look [s]: no further than half of a
        fast stroke, but for at least `least` [s].

    Returns
    -------
    JointShift or None
        None if too few samples lie around the changes of the motion, or nothing is explained.
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
    """Return the sampling interval [s] of both logs after starts of the motion, as one error."""
    own, other = _interval(force_time, basis, shift), _interval(basis.time, basis, 0.0)
    return float(np.hypot(own, other))


def _interval(time: Array, basis: Basis, shift: float) -> float:
    """Tell the sampling interval [s] after the starts of the motion."""
    at = np.searchsorted(time, basis.time[basis.begins] + shift)
    at = np.clip(at[:, None] + np.arange(1, 12), 0, len(time) - 1)
    return float(median(np.diff(time[at], axis=1)))


def fit_jointly(
    force_time: Array, force: Array, basis: Basis, shift: float, span: float, finest: float
) -> list[Answer]:
    """Ask each model; `finest` is the sampling interval [s] that limits it."""
    first = _samples(force_time, force, basis, shift, span)
    models = []
    for name, table in basis.models:
        told = _one(force_time, force, basis, table, shift, span, finest, first)
        if told is not None:
            models.append((name, table, told))
    if not models:
        return []
    shifts = np.array([told[0] for _, _, told in models])
    # the same samples for all, so that their residuals can be compared
    half = 0.5 * float(np.ptp(shifts)) + finest
    used = _samples(force_time, force, basis, 0.5 * float(shifts.min() + shifts.max()), half)
    if not used.force.size:  # the models' shifts lie so far apart that no sample serves all
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
    """Mean and standard deviation of the answers of all models, by how well they fit."""
    unexplained = np.array([answer.unexplained for answer in answers])
    best = int(np.argmin(unexplained))
    # what is left is noise if it hangs together little; else no model is quite right
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


def _one(
    force_time: Array,
    force: Array,
    basis: Basis,
    table: Array,
    shift: float,
    span: float,
    finest: float,
    samples: _Samples,
) -> tuple[float, float] | None:
    """Shift and its error by one model; the range narrows as they become known."""
    at, half = shift, span
    for narrowed in range(12):
        if narrowed:
            samples = _samples(force_time, force, basis, at, half)
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
    # it has wandered off: this model tells nothing
    return None if abs(mean - shift) > 1.2 * span else (mean, error)


def _chosen(force_time: Array, basis: Basis, shift: float, half: float) -> NDArray[np.int64]:
    """Choose samples of the force around the changes of the motion, closer the nearer to one."""
    events = basis.time[basis.events] + shift
    inside = (events > force_time[0] + half) & (events < force_time[-1] - half)
    inside[inside] = np.arange(inside.sum()) % (1 + inside.sum() // _MAX_EVENTS) == 0
    events, around = events[inside], basis.around[inside] + shift
    if not len(events):
        return np.zeros(0, dtype=np.int64)
    each = max(20, _FITTED_SAMPLES // len(events)) // 2  # before, and after
    k = np.searchsorted(force_time, events)
    a, b = np.searchsorted(force_time, around.T)
    count = np.stack([b - k, k - a])  # (after or before, event)
    # evenly within the span, more and more thinly beyond it
    flat = np.searchsorted(force_time, events + 2.0 * half) - k
    scale = np.maximum(np.minimum(flat, count), 4)
    u = np.linspace(0.0, np.arcsinh(np.maximum(count, 1) / scale), each, axis=-1)
    thinned, all_of_few = (scale[:, :, None] * np.sinh(u)).astype(np.int64), np.arange(each)
    many = (count > each)[:, :, None]
    places = k[:, None] + np.array([1, -1])[:, None, None] * np.where(many, thinned, all_of_few)
    chosen = _each_once(np.sort(places[many | (all_of_few < count[:, :, None])]))
    good = (chosen >= 0) & (chosen < len(force_time))
    chosen = chosen[good]
    first = max(basis.time[0] + shift + half, force_time[0])
    last = min(basis.time[-1] + shift - half, force_time[-1])
    return chosen[(force_time[chosen] >= first) & (force_time[chosen] <= last)]


def _each_once(increasing: NDArray[np.int64]) -> NDArray[np.int64]:
    """Leave out repeats; `numpy.unique` would hash what is sorted already."""
    if not len(increasing):
        return increasing
    return increasing[np.diff(increasing, prepend=-1 - abs(int(increasing[0]))) != 0]


class _Samples(NamedTuple):
    """Samples of the force around the changes of the motion: what a slow drift leaves of them."""

    time: Array
    force: Array
    drift: Array  # (sample, function), orthonormal
    both: Array  # drift and force, (function, sample)


def _samples(force_time: Array, force: Array, basis: Basis, shift: float, half: float) -> _Samples:
    used = _chosen(force_time, basis, shift, half)
    time, force = force_time[used], force[used]
    if not len(time):
        return _Samples(
            time, force, np.zeros((0, _DRIFT_FUNCTIONS)), np.zeros((_DRIFT_FUNCTIONS + 1, 0))
        )
    knots = np.linspace(time[0], time[-1], _DRIFT_FUNCTIONS)
    drift, _ = np.linalg.qr(
        np.stack([np.interp(time, knots, hat) for hat in np.eye(_DRIFT_FUNCTIONS)], 1)
    )
    force = force - drift @ (drift.T @ force)
    return _Samples(time, force, drift, np.concatenate([drift.T, force[None]]))


class _Fit:
    """The force at trial shifts as a sum of what a model's table holds (column, motion's row)."""

    def __init__(self, samples: _Samples, motion_time: Array, table: Array, shifts: Array):
        self.samples, self.shifts = samples, shifts
        self.whole = float(samples.force @ samples.force)
        rows = _rows_between(motion_time, samples.time - shifts.max(), samples.time - shifts.min())
        self.motion_time, values = motion_time[rows], np.ascontiguousarray(table[:, rows].T)
        self.step = np.diff(self.motion_time)
        self.table, self.change = values[:-1], np.diff(values, axis=0)
        shape = len(samples.time), values.shape[1]
        self._columns, self._begin = np.empty(shape), np.empty(shape)

    def columns(self, shift: float) -> Array:
        """Return what the motion would have the force show: the table at the samples' times.

        The next call writes over it: this is done hundreds of times a run, and fresh memory, which
        no cache holds, would take half of its time.
        """
        at = self.samples.time - shift
        i = self.motion_time[1:-1].searchsorted(at)  # the first interval or the last beyond the log
        at -= self.motion_time.take(i)
        at /= self.step.take(i)
        part = np.clip(at, 0.0, 1.0, out=at)
        # where places are clipped, and none is, it is written without a copy between
        self.change.take(i, axis=0, out=self._columns, mode="clip")
        self._columns *= part[:, None]
        self.table.take(i, axis=0, out=self._begin, mode="clip")
        self._columns += self._begin
        return self._columns

    def squares(self) -> tuple[Array, Array, Array]:
        """Return the sums of squares that are left, amplitudes, and shares of inertia (shift)."""
        normals, told = [], []
        for shift in self.shifts:
            columns = self.columns(shift)
            # a drift is taken out of the products: out of the columns it would take longer
            along = self.samples.both @ columns
            normals.append(columns.T @ columns - along[:-1].T @ along[:-1])
            told.append(along[-1])
        normal, right = np.stack(normals), np.stack(told)[:, :, None]
        own = np.einsum("sii->si", normal)
        ridge = _RIDGE_PENALTY * own + 1e-12 * own.sum(axis=1, keepdims=True)
        ridge = np.maximum(ridge, np.finfo(float).tiny)  # of a motion that explains nothing
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
        """Return what the motion leaves of the force."""
        explained = self.columns(shift) @ amplitudes
        drift = self.samples.drift
        left: Array = self.samples.force - explained + drift @ (drift.T @ explained)
        return left

    def profile(self) -> tuple[Array, float, float, float]:
        """Return the log likelihood (shift), and of the best shift what `Answer` tells."""
        squares, amplitudes, inertia = self.squares()
        best = int(np.argmin(squares))
        residual = self.residual(self.shifts[best], amplitudes[best])
        alike = float(residual[1:] @ residual[:-1]) / max(float(residual @ residual), 1e-30)
        hanging = max(1.0, (1.0 + alike) / max(1.0 - alike, 1e-3))
        freedom = max(len(residual) - amplitudes.shape[1] - _DRIFT_FUNCTIONS, 1) / hanging
        squares = np.maximum(squares, 1e-12 * self.whole)
        return (
            -0.5 * freedom * np.log(squares),
            float(squares.min()) / self.whole,
            float(inertia[best]),
            freedom,
        )


def _rows_between(motion_time: Array, first: Array, last: Array) -> NDArray[np.int64]:
    """Rows of a motion log that lie about increasing intervals of time, each once."""
    ends = len(motion_time) - 2
    low = np.clip(np.searchsorted(motion_time, first) - 1, 0, ends)
    high = np.clip(np.searchsorted(motion_time, last) - 1, 0, ends) + 1
    low[1:] = np.maximum(low[1:], high[:-1] + 1)
    count = np.maximum(high - low + 1, 0)
    before = np.cumsum(count) - count
    return np.repeat(low - before, count) + np.arange(int(count.sum()))
