"""Start of the steady part of a sequence, from a fitted exponential, step or line.

Notes
-----
Oscillations are removed first [1]_. The best fit of a step, a line and ``a + b exp(-t/c)`` is
tested against the spectrum of the residuals. The sequence is steady when ``b exp(-t/c)`` is below 1
% of ``a``, or below the standard error of ``a`` if that is larger. A change at the end of the run
is found by the same test, backwards.

Over 120 records of 1000 values each, a running-in is found in up to 1 % of steady records; one of
five standard deviations and a time constant of 2 to 25 % of the run in 98 % of records in white
noise (``tests/coverage/running_in_coverage.py``).

References
----------
.. [1] `tribolab.friction.mean_error.lines`
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special
from scipy.fft import dct

from tribolab.friction.mean_error import limits as of_means
from tribolab.friction.mean_error.autoregression import sieve_of
from tribolab.friction.mean_error.level import levels_of
from tribolab.friction.mean_error.lines import lines_of, waves_of
from tribolab.friction.running_in import limits
from tribolab.friction.running_in.kinds import NONE, NOT_FINISHED, RUN_IN, STEP

_TIME_GRID = np.geomspace(0.004, 1.0, 24)  # time constants that are tried, relative to the sequence
# time constants of exponentials removed before oscillations are sought
_NO_OSCILLATION_TIMES = (0.03, 0.15)
_GOLDEN_ROUNDS, _GOLDEN = 20, 0.382


class Settling(NamedTuple):
    """Running-in and steady part of a sequence, as indices of its values.

    The steady part is ``values[start:stop]``; without one, both are the length of the sequence.
    `start_u` is the standard uncertainty of `start`, and `first` the fitted initial value in its
    unit. `more` means that one exponential does not describe the running-in.
    """

    kind: str
    start: int
    stop: int
    start_u: float
    first: float
    more: bool = False

    @property
    def is_steady(self) -> bool:
        """Whether there is a steady part."""
        return self.stop > self.start


def blocks_of(values: np.ndarray, most: int) -> np.ndarray:
    """Return means over equal intervals, at most `most` (stretch)."""
    if values.size <= most:
        return values
    edges = np.linspace(0, values.size, most + 1).astype(int)
    return np.add.reduceat(values, edges[:-1]) / np.diff(edges)


def settling_of(values: np.ndarray) -> Settling:
    """Find the steady part of a sequence.

    Parameters
    ----------
    values
        Values of equal strokes or intervals, in order, without NaN (stroke).

    Examples
    --------
    >>> n, rng = np.arange(400), np.random.default_rng(0)
    >>> found = settling_of(0.3 + 0.2 * np.exp(-n / 20) + 0.005 * rng.standard_normal(400))
    >>> found.kind, 75 < found.start < 95, round(found.first, 1)
    ('running-in', True, 0.5)
    >>> settling_of(0.3 + 0.005 * rng.standard_normal(400)).kind
    'none'
    """
    size = values.size
    if size < limits.MIN_VALUES.value or np.ptp(values) <= 1e-12 * np.abs(values).max(initial=0):
        return Settling(NONE, 0, size, 0.0, float(values[:1].mean()) if size else np.nan)
    stop = size
    # backwards from the end, without a possible running-in
    last = _settling(values[size // 3 :][::-1])
    if last.kind in (RUN_IN, STEP) and last.start <= limits.LONGEST_CHANGE_AT_END.value * size:
        stop = size - last.start
    found = _settling(values[:stop])
    if found.kind == STEP and found.start > stop / 2:  # the longer part is the steady one
        return found._replace(kind=STEP, start=0, stop=found.start)
    if not found.is_steady:
        found = _after_peak(values[:stop]) or found._replace(start=size, stop=size)
    return found


def _after_peak(values: np.ndarray) -> Settling | None:
    """Return the running-in after an early extreme, e.g. if friction rises first; else None."""
    blocks = blocks_of(values, int(limits.BLOCKS_FOR_PEAK.value))
    level = blocks[-(blocks.size // 3) :].mean()
    peak = int(np.abs(blocks - level).argmax()) / blocks.size
    if not 0 < peak <= limits.LATEST_PEAK.value:
        return None
    first = int(peak * values.size)
    found = _settling(values[first:])
    if found.kind != RUN_IN:
        return None
    return found._replace(start=first + found.start, stop=first + found.stop)


class _Fit(NamedTuple):
    """Normalised sequence of at most 384 intervals, and the oscillations fitted to it."""

    values: np.ndarray
    waves: np.ndarray
    time: np.ndarray  # middles of the intervals, relative to the whole

    def rest(self, *shapes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return residuals, coefficients and design of a fit of mean, shapes and waves."""
        design = np.column_stack([np.ones(self.values.size), *shapes, self.waves])
        size, *_ = np.linalg.lstsq(design, self.values, rcond=None)
        return self.values - design @ size, size, design


def _settling(values: np.ndarray) -> Settling:
    blocks = blocks_of(values, int(of_means.BLOCKS.value))
    middle, scale = float(blocks.mean()), float(blocks.std())
    count, size = blocks.size, values.size
    if size < limits.MIN_VALUES.value or not scale > 1e-12 * abs(middle):
        return Settling(NONE, 0, size, 0.0, middle)
    time = (np.arange(count) + 0.5) / count
    fit = _Fit((blocks - middle) / scale, np.empty((count, 0)), time)
    calm, *_ = fit.rest(time, *(np.exp(-time / each) for each in _NO_OSCILLATION_TIMES))
    (cycles,) = lines_of(calm[None])
    if cycles:
        fit = fit._replace(waves=np.column_stack([waves_of(each, count) for each in cycles]))
    constant, least = _best_course(fit)
    step = _step(fit, least, size)
    if step is not None:
        first = float(values[: step.start].mean())
        return step._replace(first=first)
    rest, coefficients, design = fit.rest(_shape(time, constant))
    noise, freedom = _noise(rest, _shape(time, constant), constant)
    shape = _shape(time, constant) - _shape(time, constant).mean()
    sure = special.stdtrit(freedom, 1 - limits.BY_CHANCE.value / 2)
    if abs(coefficients[1]) < sure * np.sqrt(noise / (shape @ shape)):
        return Settling(NONE, 0, size, 0.0, middle)
    first = middle + scale * float(coefficients[0] + coefficients[1] * (constant is not None))
    unfinished = Settling(NOT_FINISHED, size, size, np.nan, first)
    if constant is None or np.exp(-1 / constant) > limits.NOT_FINISHED.value:
        return unfinished
    constant = _refine(fit, constant)
    rest, coefficients, design = fit.rest(np.exp(-time / constant))
    asymptote = middle + scale * float(coefficients[0])
    tail = values[int(min(0.7, 4 * constant) * size) :]
    error = float(levels_of(blocks_of(tail, count)[None]).sem[0])
    near = max(limits.STEADY_WITHIN.value * abs(asymptote), error)
    times = float(np.log(max(scale * abs(coefficients[1]) / near, 1.0)))
    start = int(constant * times * size)
    first = asymptote + scale * float(coefficients[1])
    if start > limits.LATEST_START.value * size:
        return unfinished._replace(first=first)
    own = coefficients[1] * np.exp(-time / constant) * time / constant**2
    jacobian = np.column_stack([design[:, 0], design[:, 1], own])
    spread = np.linalg.pinv(jacobian.T @ jacobian) * noise
    slope = np.array([0.0, constant / max(abs(coefficients[1]), 1e-9), times])
    doubt = size * float(np.sqrt(max(slope @ spread @ slope, 0.0)))
    more = _has_slow_remainder(fit, constant, own, freedom)
    return Settling(RUN_IN, start, size, doubt, first, more)


def _shape(time: np.ndarray, constant: float | None) -> np.ndarray:
    """Return a line, or an exponential with a time constant (stretch)."""
    return time if constant is None else np.exp(-time / constant)


def _best_course(fit: _Fit) -> tuple[float | None, float]:
    """Return the best time constant, None for a line, and the sum of squares."""
    squares = []
    times = [None, *_TIME_GRID[_TIME_GRID > 1.2 / fit.time.size].tolist()]
    for constant in times:
        rest, *_ = fit.rest(_shape(fit.time, constant))
        dear = 1.0 if constant is not None else limits.LINE_OVER_EXPONENTIAL.value
        squares.append(float(rest @ rest) * dear)
    best = int(np.argmin(squares))
    return times[best], squares[best]


def _refine(fit: _Fit, constant: float) -> float:
    """Return the time constant with the least squares, by golden-section search."""

    def squares(time: float) -> float:
        rest, *_ = fit.rest(np.exp(-fit.time / time))
        return float(rest @ rest)

    low, high = constant / 1.3, constant * 1.3
    for _ in range(_GOLDEN_ROUNDS):
        a, b = low + _GOLDEN * (high - low), high - _GOLDEN * (high - low)
        if squares(a) < squares(b):
            high = b
        else:
            low = a
    return (low + high) / 2


def _coarse_noise(rest: np.ndarray, fitted: int) -> tuple[float, float]:
    """Return the residual variance at the lowest frequencies, and its degrees of freedom."""
    coarse = blocks_of(rest, int(of_means.COARSE_BLOCKS.value))
    sieve = sieve_of((coarse - coarse.mean())[None], fitted)
    noise = float(sieve.long_run_variance[0]) * rest.size / coarse.size
    return noise, max(float(sieve.effective_samples[0]) - 3, 2.0)


def _noise(rest: np.ndarray, shape: np.ndarray, constant: float | None) -> tuple[float, float]:
    """Return the residual variance against which a fit is tested, and its degrees of freedom."""
    noise, freedom = _coarse_noise(rest, 3)
    if constant is None or constant > limits.SHORT_TIME.value:
        return noise, freedom
    count = rest.size
    sieve = sieve_of((rest - rest.mean())[None], 3, min(20, max(8, count // 19)))
    cosines = dct(shape - shape.mean(), norm="ortho")[1:] ** 2
    power = sieve.power(np.arange(1, count) / 2.0, count)[0]
    return float(cosines @ power / cosines.sum()), freedom


def _step(fit: _Fit, least: float, size: int) -> Settling | None:
    """Return a step that describes the sequence better than line and exponential; else None."""
    values, count = fit.values, fit.values.size
    edge = max(4, count // 50)
    total = np.concatenate([[0.0], np.cumsum(values)])
    places = np.arange(edge, count - edge)
    heights = (total[-1] - total[places]) / (count - places) - total[places] / places
    best = int((heights**2 * places * (count - places)).argmax())
    place, height = int(places[best]), float(heights[best])
    early = np.arange(count) < place
    rest, *_ = fit.rest(early.astype(float))
    if rest @ rest * limits.STEP_OVER_EXPONENTIAL.value >= least:
        return None
    noise, _ = _coarse_noise(rest, 3)
    error = np.sqrt(noise * count / (place * (count - place)))
    if abs(height) <= limits.STEP_OVER_NOISE.value * error:
        return None
    return Settling(STEP, int(place / count * size), size, size / count, np.nan)


def _has_slow_remainder(fit: _Fit, constant: float, own: np.ndarray, freedom: float) -> bool:
    """Return whether a line or a slower exponential remains in the residuals of the fit."""
    sure = special.stdtrit(freedom, 1 - limits.BY_CHANCE.value)
    for other in (fit.time, np.exp(-fit.time / (4 * constant))):
        rest, size, design = fit.rest(np.exp(-fit.time / constant), own, other)
        noise, _ = _coarse_noise(rest, 4)
        error = np.sqrt(np.linalg.pinv(design.T @ design)[3, 3] * noise)
        if abs(size[3]) > sure * error:
            return True
    return False
