"""Run length of a control chart: number of points until a false or true alarm."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tribolab.metrology.control_charts import (
    DEFAULT_RULES,
    FEWEST_OF_BASELINE,
    MANY,
    RANGE_FREEDOM,
    Baseline,
    signals_of,
)

_SERIES, _BLOCK, _MAX_RUN = 4000, 250, 2000  # simulated series, points per step, most points
_SHORT, _MORE = 400, 4  # for series of up to _SHORT points, _MORE times as many are simulated
_SEED = 20260101


def average_run_length(
    rules: Sequence[str] = DEFAULT_RULES,
    *,
    shift: float = 0.0,
    drift: float = 0.0,
    baseline: int | None = None,
) -> float:
    """Return the average number of points until a chart with these rules signals.

    Parameters
    ----------
    rules
        As for `control_chart`.
    shift, drift
        Step, and slope per point, of the instrument from the start of the chart, in standard
        deviations of a point. Without them the result is ARL0, the points between false alarms.
    baseline
        Number of points from which centre and deviation were estimated; None if they are known.

    Notes
    -----
    Simulated, with an error of some 2 %. With an estimated, possibly wrong baseline run lengths
    scatter much more than with a known one, and some charts never signal: the result is the number
    of all points divided by that of signals, with at most 2000 points per series.

    Examples
    --------
    >>> 350 < average_run_length(["3 sigma"]) < 390
    True
    """
    lengths = _run_lengths(tuple(rules), shift, drift, baseline, _MAX_RUN)
    signalled = int((lengths <= _MAX_RUN).sum())
    return float(np.minimum(lengths, _MAX_RUN).sum() / max(1, signalled))


def median_run_length(
    rules: Sequence[str] = DEFAULT_RULES,
    *,
    shift: float = 0.0,
    drift: float = 0.0,
    baseline: int | None = None,
) -> float:
    """Return the median number of points until a signal; arguments as for `average_run_length`."""
    return float(np.median(_run_lengths(tuple(rules), shift, drift, baseline, _MAX_RUN)))


def signal_probability(
    points: int,
    rules: Sequence[str] = DEFAULT_RULES,
    *,
    shift: float = 0.0,
    drift: float = 0.0,
    baseline: int | None = None,
) -> float:
    """Return the probability of a signal within a number of points; see `average_run_length`."""
    lengths = _run_lengths(tuple(rules), shift, drift, baseline, points)
    return float((lengths <= points).mean())


@functools.lru_cache(maxsize=64)
def _run_lengths(
    rules: tuple[str, ...], shift: float, drift: float, baseline: int | None, longest: int
) -> NDArray[np.float64]:
    """Return the number of points until the first signal, in many simulated series."""
    rng = np.random.default_rng(_SEED)
    count = _SERIES * (_MORE if longest <= _SHORT else 1)
    usual, centre, sigma = Baseline(0.0, 1.0), np.zeros(count), np.ones(count)
    if baseline is not None and baseline >= FEWEST_OF_BASELINE:
        before = rng.normal(size=(count, baseline))
        centre = before.mean(axis=1)
        sigma, freedom = before.std(axis=1, ddof=1), baseline - 1.0
        if baseline >= MANY:
            sigma = np.abs(np.diff(before, axis=1)).mean(axis=1) * math.sqrt(math.pi) / 2
            freedom *= RANGE_FREEDOM
        usual = Baseline(0.0, 1.0, baseline, freedom)
    lengths = np.full(count, np.inf)
    running = np.arange(count)
    series = np.zeros((count, 0))
    while running.size and series.shape[1] < longest:
        # always evaluated from the first point, because some rules have a memory
        start = series.shape[1]
        point = np.arange(start, start + min(_BLOCK, longest - start))
        fresh = rng.normal(size=(running.size, point.size)) + shift + drift * (point + 1)
        fresh = (fresh - centre[running, None]) / sigma[running, None]
        series = np.concatenate([series, fresh], axis=1)
        marks = np.any(list(signals_of(series, usual, rules).values()), axis=0)
        first = np.where(marks.any(axis=1), marks.argmax(axis=1) + 1.0, np.inf)
        done = np.isfinite(first)
        lengths[running[done]] = first[done]
        running, series = running[~done], series[~done]
    return lengths
