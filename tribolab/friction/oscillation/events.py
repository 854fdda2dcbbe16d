"""Stick and slip events of a record, found from its turning points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import medians_of_rows
from tribolab.friction.oscillation import limits

# interval of a stick, from 0 to 1, in which the loading rate is determined
_LOADING_PART = (0.08, 0.92)
# number of cells in that interval, and in the window for one slope; fewer cells add noise
_LOADING_CELLS, _SLOPE_CELLS = 48, 16


class Events(NamedTuple):
    """Whole cycles of a record: rise from valley to peak (stick), fall to the next valley (slip).

    Parameters
    ----------
    start, peak, stop
        Times of valley, peak and next valley [s] (event).
    middle
        Time at which half of the drop is complete [s] (event). The fall is steep there, so that
        noise shifts this time less than that of the peak.
    rise, drop
        Heights of the rise and of the drop, in the signal's unit (event).
    """

    start: np.ndarray
    peak: np.ndarray
    stop: np.ndarray
    middle: np.ndarray
    rise: np.ndarray
    drop: np.ndarray


def without_spikes(values: np.ndarray, noise: float) -> tuple[np.ndarray, int]:
    """Return a signal with each single outlying sample replaced by the mean of its neighbours.

    Parameters
    ----------
    values
        (time)
    noise
        Standard deviation, from `tribolab.friction.oscillation.spectrum.noise.noise_level`.

    Returns
    -------
    tuple
        The values, and the number of spikes.
    """
    if values.size < 5:
        return values, 0
    least = limits.MIN_SPIKE_OVER_NOISE.value * noise
    far = np.abs(np.diff(values)) > least
    spikes = 1 + np.flatnonzero(far[:-1] & far[1:])
    left, here, right = (values[spikes + step] for step in (-1, 0, 1))
    middle = np.clip(here, np.minimum(left, right), np.maximum(left, right))
    # both neighbours must be at one level, else it is a drop and not a spike
    apart = np.abs(here - middle)
    single = (apart > least) & (apart > 2 * np.abs(right - left))
    if not single.any():
        return values, 0
    result = values.copy()
    result[spikes[single]] = 0.5 * (left + right)[single]
    return result, int(single.sum())


def turning_points(values: np.ndarray, hysteresis: float) -> np.ndarray:
    """Find the valleys and peaks that remain after dropping swings below a threshold.

    Parameters
    ----------
    values
        (time)
    hysteresis
        Smallest swing that counts.

    Returns
    -------
    ndarray
        Indices of alternating valleys and peaks (turn).

    Notes
    -----
    All swings below the threshold that are smaller than both neighbours are removed at once,
    repeatedly until none remains. The smallest swing never decides whether a larger one counts, so
    that the result does not depend on the order.

    Examples
    --------
    >>> turning_points(np.array([0.0, 5.0, 4.0, 6.0, 0.0, 1.0, -1.0]), 3.0).tolist()
    [0, 3, 6]
    """
    step = np.sign(np.diff(values))
    moved = np.flatnonzero(step)
    if moved.size == 0:
        return np.zeros(0, int)
    turned = np.flatnonzero(step[moved[1:]] != step[moved[:-1]])
    points = np.concatenate([[moved[0]], moved[turned + 1], [moved[-1] + 1]])
    while points.size > 2:
        swing = np.abs(np.diff(values[points]))
        small = swing < hysteresis
        if not small.any():
            break
        left = np.append(np.inf, swing[:-1])
        right = np.append(swing[1:], np.inf)
        take = np.flatnonzero(small & (swing < left) & (swing <= right))
        gone = np.zeros(points.size, bool)
        inner = take[(take > 0) & (take < swing.size - 1)]
        gone[inner] = gone[inner + 1] = True
        gone[0] |= bool((take == 0).any())
        gone[-1] |= bool((take == swing.size - 1).any())
        points = points[~gone]
    if points.size == 2 and abs(values[points[1]] - values[points[0]]) < hysteresis:
        return np.zeros(0, int)
    return points


def find_events(time: np.ndarray, values: np.ndarray, hysteresis: float) -> Events:
    """Return the cycles of stick and slip in a record.

    Parameters
    ----------
    time, values
        [s], and friction in any unit, positive as resistance (time).
    hysteresis
        Smallest swing that counts.

    Returns
    -------
    Events
        Cycles that begin or end outside the record are left out.

    Examples
    --------
    >>> t = np.arange(0, 4, 0.01)
    >>> found = find_events(t, t % 1.0, 0.3)
    >>> found.drop.size, round(float(found.drop.mean()), 2)
    (2, 0.99)
    """
    turns = turning_points(values, hysteresis)
    if turns.size < 4:
        return Events(*[np.zeros(0)] * len(Events._fields))
    # the record begins and ends in the middle of a swing: drop the first and the last turn
    turns = turns[1:-1]
    if values[turns[0]] > values[turns[1]]:
        turns = turns[1:]
    turns = turns[: (turns.size - 1) // 2 * 2 + 1]
    if turns.size < 3:
        return Events(*[np.zeros(0)] * len(Events._fields))
    t, v = time[turns], values[turns]
    middle = _half_way(time, values, turns[1:-1:2], turns[2::2])
    return Events(t[:-2:2], t[1:-1:2], t[2::2], middle, v[1:-1:2] - v[:-2:2], v[1:-1:2] - v[2::2])


def _half_way(
    time: np.ndarray, values: np.ndarray, peak: np.ndarray, valley: np.ndarray
) -> np.ndarray:
    """Return the time at which half of each drop is complete."""
    count = valley - peak + 1
    first = np.cumsum(count) - count
    inside = np.arange(count.sum()) + np.repeat(peak - first, count)
    middle = np.repeat(0.5 * (values[peak] + values[valley]), count)
    last = peak + np.add.reduceat((values[inside] > middle).astype(int), first) - 1
    return 0.5 * (time[last] + time[last + 1])


def loading_rate(time: np.ndarray, values: np.ndarray, events: Events) -> float:
    """Return the highest loading rate of friction while sticking [unit/s]; NaN without events.

    Parameters
    ----------
    time, values
        The record in which the events were found.
    events
        From `find_events`.

    Notes
    -----
    The spring loads at k (v - V). Near the critical stiffness the sample slides (V > 0) before and
    after each slip, so the whole rise is less steep than the spring. Each stick is divided into
    windows, and the median over the sticks is taken in each: the steepest window has the least
    sliding.

    Examples
    --------
    >>> t = np.arange(0, 10, 0.01)
    >>> saw = t % 1.0
    >>> round(loading_rate(t, saw, find_events(t, saw, 0.5)), 2)
    1.0
    """
    if not events.drop.size:
        return np.nan
    # means over cells use all samples; single values at the ends are biased by noise
    edges = np.linspace(*_LOADING_PART, _LOADING_CELLS + 1)
    stick = (events.peak - events.start)[:, None]
    steps = 0.5 * np.diff(time) * (values[1:] + values[:-1] - 2.0 * values[0])
    integral = np.concatenate([[0.0], np.cumsum(steps)])
    cells = np.diff(np.interp(events.start[:, None] + stick * edges, time, integral), axis=1)
    cells /= np.maximum(stick * (edges[1] - edges[0]), 1e-300)
    x = edges[:_SLOPE_CELLS] - edges[:_SLOPE_CELLS].mean()
    rows = np.lib.stride_tricks.sliding_window_view(cells, _SLOPE_CELLS, axis=1)[
        :, :: _SLOPE_CELLS // 2
    ]
    slopes = rows @ x / float(x @ x) / np.maximum(stick, 1e-300)
    return float(medians_of_rows(slopes.T).max())
