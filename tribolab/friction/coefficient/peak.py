"""Peak friction in noisy readings: maximum of a fitted parabola, or of a pointed peak itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.coefficient import limits

_NOISE_OF_STEPS = 1.4826 / np.sqrt(2)  # from median step to standard deviation
# readings above a share of the rise are fitted; the share is raised until a parabola fits
_PEAK_SHARES = (0.8, 0.9, 0.95, 0.98)


class Peak(NamedTuple):
    """Time [s], value and standard error of a peak, and whether it is significant."""

    moment: float
    height: float
    error: float
    clear: bool


def noise_between(values: np.ndarray) -> float:
    """Return the standard deviation of the readings' noise, from the steps between them.

    Parameters
    ----------
    values
        Readings (time); the result is infinite for too few.
    """
    steps = np.abs(np.diff(values[np.isfinite(values)]))
    return (
        _NOISE_OF_STEPS * float(median(steps))
        if steps.size >= limits.MIN_SAMPLES_OF_PEAK.value
        else np.inf
    )


def peak_of_start(
    time: np.ndarray, ratio: np.ndarray, sliding: float, sem: float, noise: float
) -> Peak:
    """Return the peak at the start of sliding.

    Parameters
    ----------
    time, ratio
        Friction over load [1] along time [s].
    sliding, sem
        Coefficient of the sliding that follows, and its standard error [1].
    noise
        Standard deviation of a reading [1], see `noise_between`.

    Returns
    -------
    Peak
        NaN if there are too few readings.
    """
    known = np.isfinite(ratio)
    time, ratio = time[known], ratio[known]
    if (
        ratio.size < limits.MIN_SAMPLES_OF_PEAK.value
        or not np.isfinite(sliding)
        or not np.isfinite(noise)
    ):
        return Peak(np.nan, np.nan, np.nan, False)
    smooth, width, clear = _smooth(ratio, sliding, noise)
    top = int(np.argmax(smooth))
    if clear:
        moment, height, error = _top_peak(time, ratio, smooth, width, sliding, noise)
    else:  # no peak exceeds the noise: the mean of the readings with the highest running mean
        near, when = ratio[top : top + width], time[top : top + width]
        height, error, moment = float(near.mean()), noise / np.sqrt(near.size), float(when.mean())
        # where the start ends and sliding begins is unknown, so the difference is an error
        error = float(np.hypot(error, height - sliding))
    error = float(np.hypot(error, sem))
    return Peak(
        moment,
        height,
        error,
        bool(clear and height - sliding > limits.MIN_ERRORS_OF_PEAK.value * error),
    )


def _top_peak(
    time: np.ndarray,
    ratio: np.ndarray,
    smooth: np.ndarray,
    width: int,
    sliding: float,
    noise: float,
) -> tuple[float, float, float]:
    """Return time, height and error of a significant peak."""
    top = int(np.argmax(smooth))
    for share in _PEAK_SHARES:
        low = np.flatnonzero(smooth < sliding + share * (smooth[top] - sliding))
        first = low[low < top][-1] + 1 if (low < top).any() else 0
        last = low[low > top][0] if (low > top).any() else smooth.size
        near, when = ratio[first : last + width - 1], time[first : last + width - 1]
        if near.size < limits.MIN_SAMPLES_OF_PEAK.value or not np.ptp(when) > 0:
            break
        moment, height, error, scatter = _parabola(when, near, noise)
        spread = limits.MAX_MISFIT_OF_PEAK.value * noise / np.sqrt(2 * max(near.size - 3, 1))
        if scatter <= noise + spread:
            return moment, height, float(np.hypot(error, np.sqrt(max(scatter**2 - noise**2, 0.0))))
    sides = smooth[[max(top - width, 0), min(top + width, smooth.size - 1)]]
    step = float(smooth[top] - sides.min())
    between = 0.5 * np.sqrt(max(step**2 - 2 * noise**2 / width, 0.0))
    moment = float(time[top : top + width].mean())
    return moment, float(smooth[top]), float(np.hypot(noise / np.sqrt(width), between))


def _smooth(ratio: np.ndarray, sliding: float, noise: float) -> tuple[np.ndarray, int, bool]:
    """Return running means, the number of readings in each, and whether a peak exceeds the noise.

    The number is doubled until a peak does, up to an eighth of the readings.
    """
    total = np.concatenate([[0.0], np.cumsum(ratio)])
    width = 1
    while True:
        smooth = (total[width:] - total[:-width]) / width
        beyond = np.sqrt(2 * np.log(max(ratio.size / width, 2.0))) + 1.0
        if smooth.max() - sliding > beyond * noise / np.sqrt(width):
            return smooth, width, True
        if 8 * width >= ratio.size:
            return smooth, width, False
        width *= 2


def _parabola(
    time: np.ndarray, values: np.ndarray, noise: float
) -> tuple[float, float, float, float]:
    """Fit a parabola; return time, value and error of its maximum, and the scatter about it."""
    middle, half = (time[0] + time[-1]) / 2, (time[-1] - time[0]) / 2
    u = (time - middle) / half
    basis = np.stack([np.ones(u.size), u, u * u], axis=1)
    terms, *_ = np.linalg.lstsq(basis, values, rcond=None)
    rest = values - basis @ terms
    scatter = float(np.sqrt(rest @ rest / max(u.size - 3, 1)))
    at = -terms[1] / (2 * terms[2]) if terms[2] < 0 else np.sign(terms[1])
    at = float(np.clip(at, -1.0, 1.0))
    row = np.array([1.0, at, at * at])
    share = float(np.sqrt(row @ np.linalg.pinv(basis.T @ basis) @ row))
    height = float(row @ terms)
    return float(middle + half * at), height, max(noise, scatter) * share, scatter
