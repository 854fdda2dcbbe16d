"""Gain of a force channel, from placing and removing a dead weight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError
from tribolab.friction.mean_error.estimates import estimate_of
from tribolab.units.conversion import positive

_TRIM = 0.1  # share cut off at both ends of each interval with or without the weight
_MIN_SAMPLES = 20  # fewest samples of an interval
_MIN_STEP = 10.0  # least step relative to the noise


class DeadWeightGain(NamedTuple):
    """Gain of a force channel, found with a dead weight.

    Parameters
    ----------
    gain
        Step of the reading divided by the weight [1].
    error
        Standard error of the gain [1], from the noise and the scatter of the intervals.
    zero
        Reading without the weight [N].
    """

    gain: float
    error: float
    zero: float


def dead_weight_gain(
    run: xr.Dataset, weight: str | float, signal: str = "normal_force"
) -> DeadWeightGain:
    """Return the gain of a force channel, from a record with a dead weight placed or removed.

    Parameters
    ----------
    run
        Record with the signal (time); sliding is not needed.
    weight
        The weight [N], or text such as ``"19.62 N"``.
    signal
        Channel that carries the weight: ``"normal_force"``, or ``"friction_force"`` by a pulley.

    Returns
    -------
    DeadWeightGain

    Raises
    ------
    AnalysisError
        If the signal is missing, or has no step between two levels.

    Notes
    -----
    Each sample is assigned to the nearer of the two levels. Each interval between two changes of
    level is averaged without a tenth at both ends, then these means with and without the weight.
    Their difference divided by the weight is the gain. Its error is from (correlated) noise or from
    the scatter of the intervals, whichever is larger.

    Examples
    --------
    >>> time = np.arange(0, 30, 0.02)
    >>> rng = np.random.default_rng(1)
    >>> on = 0.3 + 20.2 * ((time > 10) & (time < 20)) + 0.01 * rng.standard_normal(time.size)
    >>> run = xr.Dataset({"normal_force": ("time", on)}, {"time": time})
    >>> round(dead_weight_gain(run, "20 N").gain, 3)
    1.01
    """
    size = positive(weight, "N", "weight")
    if signal not in run:
        raise AnalysisError(f"the run has no '{signal}' that a weight could load")
    known = np.isfinite(run[signal].values)
    time, values = run["time"].values[known], run[signal].values[known].astype(float)
    if values.size < 4 * _MIN_SAMPLES:
        raise AnalysisError(f"{values.size} samples are too few to see a weight that is put on")
    low, high = np.percentile(values, [2.0, 98.0])
    loaded = values > (low + high) / 2
    ends = np.flatnonzero(np.diff(loaded.astype(int))) + 1
    parts: dict[bool, list[tuple[float, float]]] = {True: [], False: []}
    noise = []
    for piece in np.split(np.arange(values.size), ends):
        inner = piece[int(_TRIM * piece.size) : piece.size - int(_TRIM * piece.size)]
        if inner.size >= _MIN_SAMPLES:
            estimate = estimate_of(time[inner], values[inner])
            parts[bool(loaded[inner[0]])].append((estimate.mean, estimate.u95 / NORMAL))
            noise.append(estimate.std)
    if not parts[True] or not parts[False] or high - low < _MIN_STEP * float(np.median(noise)):
        raise AnalysisError(
            "no step of a weight that is put on or taken off is seen: record some seconds without "
            "the weight before or after those with it"
        )
    (on, on_error), (off, off_error) = (_level(parts[which]) for which in (True, False))
    return DeadWeightGain((on - off) / size, float(np.hypot(on_error, off_error)) / size, off)


def _level(parts: list[tuple[float, float]]) -> tuple[float, float]:
    """Return the mean of the signal over some intervals, and its standard error."""
    means, errors = np.array(parts).T
    count = means.size
    by_noise = float(np.sqrt(np.sum(errors**2))) / count
    by_scatter = float(np.std(means, ddof=1)) / np.sqrt(count) if count > 1 else 0.0
    return float(means.mean()), max(by_noise, float(by_scatter))
