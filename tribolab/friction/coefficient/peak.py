"""The height of a peak among noisy readings: of a round one by a parabola, of a pointed one not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median

_CLEAR = 3.0  # standard errors of the peak above sliding from which it is one
FEWEST_OF_PEAK = 5  # readings that a parabola is fitted to
_NOISE = 1.4826 / np.sqrt(2)  # median of the steps between samples -> standard deviation
# of the way from sliding to the highest reading: what belongs to the peak; of a pointed one less
_NEAR = (0.8, 0.9, 0.95, 0.98)
_MISFIT = 2.0  # standard deviations of a scatter from which it is more than noise


class Peak(NamedTuple):
    """When it was [s], its height and standard error, and whether it stands out of what follows."""

    moment: float
    height: float
    error: float
    stands: bool


def noise_between(values: np.ndarray) -> float:
    """Return the standard deviation of readings' own noise, from the steps between them.

    Parameters
    ----------
    values
        Readings (time); infinite where there are too few.
    """
    steps = np.abs(np.diff(values[np.isfinite(values)]))
    return _NOISE * float(median(steps)) if steps.size >= FEWEST_OF_PEAK else np.inf


def peak_of_start(
    time: np.ndarray, ratio: np.ndarray, sliding: float, sem: float, noise: float
) -> Peak:
    """Tell the height of the highest part of a start.

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
        NaN where there are too few readings.
    """
    known = np.isfinite(ratio)
    time, ratio = time[known], ratio[known]
    if ratio.size < FEWEST_OF_PEAK or not np.isfinite(sliding) or not np.isfinite(noise):
        return Peak(np.nan, np.nan, np.nan, False)
    smooth, width, clear = _smoothed(ratio, sliding, noise)
    top = int(np.argmax(smooth))
    if clear:
        moment, height, error = _of_top(time, ratio, smooth, width, sliding, noise)
    else:  # the highest of noise: what a stretch as long as its own mean holds
        near, when = ratio[top : top + width], time[top : top + width]
        height, error, moment = float(near.mean()), noise / np.sqrt(near.size), float(when.mean())
        # where the start ends and sliding begins is not seen
        error = float(np.hypot(error, height - sliding))
    error = float(np.hypot(error, sem))
    return Peak(moment, height, error, bool(clear and height - sliding > _CLEAR * error))


def _of_top(
    time: np.ndarray,
    ratio: np.ndarray,
    smooth: np.ndarray,
    width: int,
    sliding: float,
    noise: float,
) -> tuple[float, float, float]:
    """Return moment, height and error of a peak that stands out of the noise."""
    top = int(np.argmax(smooth))
    for share in _NEAR:
        low = np.flatnonzero(smooth < sliding + share * (smooth[top] - sliding))
        first = low[low < top][-1] + 1 if (low < top).any() else 0
        last = low[low > top][0] if (low > top).any() else smooth.size
        near, when = ratio[first : last + width - 1], time[first : last + width - 1]
        if near.size < FEWEST_OF_PEAK or not np.ptp(when) > 0:
            break
        moment, height, error, scatter = _parabola(when, near, noise)
        spread = _MISFIT * noise / np.sqrt(2 * max(near.size - 3, 1))
        if scatter <= noise + spread:
            return moment, height, float(np.hypot(error, np.sqrt(max(scatter**2 - noise**2, 0.0))))
    beside = smooth[[max(top - width, 0), min(top + width, smooth.size - 1)]]
    step = float(smooth[top] - beside.min())
    between = 0.5 * np.sqrt(max(step**2 - 2 * noise**2 / width, 0.0))
    moment = float(time[top : top + width].mean())
    return moment, float(smooth[top]), float(np.hypot(noise / np.sqrt(width), between))


def _smoothed(ratio: np.ndarray, sliding: float, noise: float) -> tuple[np.ndarray, int, bool]:
    """Return running means over the fewest readings in which a peak stands out of the noise.

    Also how many readings these are, and whether there is such a peak at all; where there is none,
    the means are those over an eighth of the start.
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
    """Moment and height of a parabola's highest point within its readings, its error, scatter."""
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
