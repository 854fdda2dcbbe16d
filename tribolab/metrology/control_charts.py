"""Control charts, which show whether an instrument still measures as in its baseline."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

from tribolab.core.aliases import Array
from tribolab.core.errors import AnalysisError

Signalled = NDArray[np.bool_]

SHEWHART, EWMA, CUSUM, WESTERN = "3 sigma", "EWMA", "CUSUM", "Western Electric"
RULES = (SHEWHART, EWMA, CUSUM, WESTERN)
DEFAULT_RULES = (SHEWHART, EWMA)

_LIMIT = 3.0
_EWMA_WEIGHT, _EWMA_LIMIT = 0.2, 2.86
_CUSUM_SLACK, _CUSUM_LIMIT = 0.5, 4.77
FEWEST_OF_BASELINE = 5  # fewest points of a baseline
MANY = 30  # least number of baseline points for a standard deviation from moving ranges
# ratio of mean moving range to standard deviation, for independent normally distributed values
_RANGE_TO_SIGMA = 2 / math.sqrt(math.pi)
RANGE_FREEDOM = 0.62  # degrees of freedom of a mean moving range, for each point after the first


@dataclass(frozen=True)
class Baseline:
    """Baseline of a control chart: centre and standard deviation, and how well they are known.

    Parameters
    ----------
    centre, sigma
        Mean and standard deviation of the baseline.
    points
        Number of points; infinite if centre and deviation are known exactly.
    degrees_of_freedom
        Degrees of freedom of the standard deviation.
    correlation
        Correlation of neighbouring points.
    correlated
        Whether the correlation is significant.
    """

    centre: float
    sigma: float
    points: float = math.inf
    degrees_of_freedom: float = math.inf
    correlation: float = 0.0
    correlated: bool = False

    def student_limit(self, limit: float) -> float:
        """Return a limit in estimated standard deviations, equivalent to `limit` in known ones.

        Notes
        -----
        Student's t of equal probability; the error of the centre is added elsewhere.
        """
        if math.isinf(self.degrees_of_freedom):
            return limit
        return float(-special.stdtrit(self.degrees_of_freedom, float(special.ndtr(-limit))))


def baseline_of(values: ArrayLike) -> Baseline:
    """Return the centre and standard deviation of the points of a baseline.

    Parameters
    ----------
    values
        (point), in temporal order, five or more.

    Raises
    ------
    AnalysisError
        If there are fewer than five points, or they do not vary.

    Notes
    -----
    With fewer than 30 points, sigma is the standard deviation of all points, which is the most
    accurate. With more points it is the mean moving range divided by 1.128, which slow drift hardly
    increases; but if neighbours are significantly correlated (r_1 above 2/sqrt(n)), moving ranges
    are too small, and the standard deviation of all points is used.

    Examples
    --------
    >>> usual = baseline_of([1.0, 1.2, 1.1, 0.9, 1.0])
    >>> round(usual.centre, 3), round(usual.sigma, 3)
    (1.04, 0.114)
    """
    y = np.asarray(values, dtype=float)
    if y.size < FEWEST_OF_BASELINE:
        raise AnalysisError(
            f"a baseline wants {FEWEST_OF_BASELINE} points or more; there are {y.size}"
        )
    overall = float(y.std(ddof=1))
    if not overall > 1e-12 * abs(y.mean()):
        raise AnalysisError("the points of the baseline are all the same: nothing tells the spread")
    about = y - y.mean()
    correlation = float((about[1:] * about[:-1]).sum() / (about**2).sum())
    correlated = abs(correlation) > 2 / math.sqrt(y.size)
    moving = mean_moving_range(y)
    if correlated or moving == 0 or y.size < MANY:
        sigma, freedom = overall, y.size - 1.0
    else:
        sigma, freedom = moving, RANGE_FREEDOM * (y.size - 1)
    return Baseline(float(y.mean()), sigma, float(y.size), freedom, correlation, correlated)


def mean_moving_range(values: Array) -> float:
    """Return the standard deviation of a series, estimated from differences of neighbours."""
    return float(np.abs(np.diff(values)).mean()) / _RANGE_TO_SIGMA


@dataclass(frozen=True)
class Chart:
    """Control chart: the points after the baseline, and which of them signal.

    Parameters
    ----------
    low, high
        Limits of a single point (3 sigma).
    smoothed, smoothed_low, smoothed_high
        The exponentially weighted mean and its limits (point).
    signals
        For each rule, a mask of the points that signal (point).
    """

    low: float
    high: float
    smoothed: Array
    smoothed_low: Array
    smoothed_high: Array
    signals: dict[str, Signalled]

    @property
    def any_signal(self) -> Signalled:
        """Mask of the points that signal by any of the rules (point)."""
        return np.any(list(self.signals.values()), axis=0)


def control_chart(
    values: ArrayLike, baseline: Baseline, rules: Sequence[str] = DEFAULT_RULES
) -> Chart:
    """Return the control chart of points that were measured after a baseline.

    Parameters
    ----------
    values
        (point), in temporal order.
    baseline
        From `baseline_of`, or known.
    rules
        Any of ``"3 sigma"``, ``"EWMA"``, ``"CUSUM"``, ``"Western Electric"``. More rules give more
        false alarms; `average_run_length` computes their rate.

    Raises
    ------
    AnalysisError
        If a rule is unknown.

    Notes
    -----
    A single point signals beyond 3 sigma [1]_; for an estimated sigma beyond the t of equal
    probability including the error of the centre, s t sqrt(1 + 1/m). The EWMA is z_i = 0.2 x_i +
    0.8 z_(i-1) with limits of 2.86 of its own standard deviations, which are narrow at first [2]_.
    The two CUSUMs add excesses over half a sigma and signal above 4.77. The Western Electric rules:
    one point beyond 3 sigma, two of three beyond 2, four of five beyond 1, eight on one side.

    References
    ----------
    .. [1] Shewhart (1931), Economic control of quality of manufactured product.
    .. [2] Lucas and Saccucci (1990), Technometrics 32, 1-12. doi:10.1080/00401706.1990.10484583

    Examples
    --------
    >>> chart = control_chart([0.1, -0.5, 4.0], Baseline(0.0, 1.0))
    >>> chart.any_signal.tolist()
    [False, False, True]
    """
    y = np.asarray(values, dtype=float)
    unknown = [rule for rule in rules if rule not in RULES]
    if unknown:
        raise AnalysisError(f"no rule is called '{unknown[0]}'; there are {', '.join(RULES)}")
    standard = ((y - baseline.centre) / baseline.sigma)[None, :]
    judged = signals_of(standard, baseline, rules)
    centre_error = 1 / baseline.points
    half = baseline.student_limit(_LIMIT) * math.sqrt(1 + centre_error) * baseline.sigma
    smoothed, deviation = _smooth(standard, centre_error)
    width = baseline.student_limit(_EWMA_LIMIT) * deviation * baseline.sigma
    return Chart(
        baseline.centre - half,
        baseline.centre + half,
        baseline.centre + baseline.sigma * smoothed[0],
        baseline.centre - width,
        baseline.centre + width,
        {rule: marks[0] for rule, marks in judged.items()},
    )


def signals_of(standard: Array, baseline: Baseline, rules: Sequence[str]) -> dict[str, Signalled]:
    """Return a mask of the points that signal, for each rule.

    Parameters
    ----------
    standard
        (Points - centre)/sigma (series, point), for several series.
    baseline
        Accuracy of centre and sigma.
    rules
        As for `control_chart`.
    """
    error = 1 / baseline.points
    limit = baseline.student_limit(_LIMIT) * math.sqrt(1 + error)
    made: dict[str, Signalled] = {}
    if SHEWHART in rules:
        made[SHEWHART] = np.abs(standard) > limit
    if EWMA in rules:
        smoothed, deviation = _smooth(standard, error)
        made[EWMA] = np.abs(smoothed) > baseline.student_limit(_EWMA_LIMIT) * deviation
    if CUSUM in rules:
        made[CUSUM] = _cusum(standard, baseline)
    if WESTERN in rules:
        made[WESTERN] = _western(standard, limit)
    return made


def _smooth(standard: Array, centre_error: float) -> tuple[Array, Array]:
    """Return exponentially weighted means (series, point), and their standard deviation (point)."""
    z = np.empty_like(standard)
    last = np.zeros(standard.shape[0])
    for point in range(standard.shape[1]):
        last = _EWMA_WEIGHT * standard[:, point] + (1 - _EWMA_WEIGHT) * last
        z[:, point] = last
    steps = np.arange(1, standard.shape[1] + 1)
    decay = 1 - (1 - _EWMA_WEIGHT) ** steps  # sum of the weights so far
    own = _EWMA_WEIGHT / (2 - _EWMA_WEIGHT) * (1 - (1 - _EWMA_WEIGHT) ** (2 * steps))
    return z, np.sqrt(own + centre_error * decay**2)


def cusums(standard: Array, slack: float = _CUSUM_SLACK) -> tuple[Array, Array]:
    """Return the upper and lower cumulative sums, CUSUM (series, point)."""
    up, down = np.empty_like(standard), np.empty_like(standard)
    high, low = np.zeros(standard.shape[0]), np.zeros(standard.shape[0])
    for point in range(standard.shape[1]):
        high = np.maximum(0.0, high + standard[:, point] - slack)
        low = np.maximum(0.0, low - standard[:, point] - slack)
        up[:, point], down[:, point] = high, low
    return up, down


def _cusum(standard: Array, baseline: Baseline) -> Signalled:
    up, down = cusums(standard)
    return np.maximum(up, down) > _CUSUM_LIMIT * baseline.student_limit(_LIMIT) / _LIMIT


def _western(standard: Array, limit: float) -> Signalled:
    marks = np.abs(standard) > limit
    for side in (1.0, -1.0):
        turned = side * standard
        for size, wanted, beyond in ((3, 2, 2 / 3), (5, 4, 1 / 3), (8, 8, 0.0)):
            there = (turned > beyond * limit).astype(int)
            total = np.cumsum(there, axis=1)
            total[:, size:] -= total[:, :-size].copy()
            # only a point on that side can complete the pattern
            marks |= (total >= wanted) & (there == 1)
    return marks
