"""Mean drop of friction in stick-slip, from the average of cycles, which reduces noise."""

from __future__ import annotations

import numpy as np

from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.events import Events, find_events
from tribolab.friction.oscillation.spectrum.spectra import EvenRecord

_WINDOW_OF_FALL = 0.38  # periods averaged on each side of the fall
_GAP_TO_FALL = 0.005  # periods between the fall and the intervals before and after it ...
_AVERAGED_PART = 0.06  # ... and their length in periods; slow noise is alike in both
_FALL_ROUNDS = 3
_CYCLE_PHASES = 256  # phases among which the extremes of a smooth cycle are sought


def abrupt_drop(record: EvenRecord, events: Events) -> float:
    """Return the mean drop of a wave that rises slowly and falls abruptly.

    Parameters
    ----------
    record
        The record in which the events were found.
    events
        At least two, with similar periods.

    Returns
    -------
    float
        The size in the signal's unit; NaN for too few samples or events.

    Notes
    -----
    Cycles are aligned at the middles of their falls and averaged. For a linear fall, the integral
    of z(1 - z), with z the remaining share of the drop, is a sixth of its duration. The means of
    short intervals just before and after the fall are extrapolated to its ends with the loading
    slope. No extreme values are selected, so that noise does not bias the drop.

    Examples
    --------
    >>> from tribolab.friction.oscillation.events import find_events
    >>> t = np.arange(0, 20, 0.01)
    >>> saw = t % 1.0 + 0.1 * np.random.default_rng(0).standard_normal(t.size)
    >>> found = find_events(t, saw, 0.8)
    >>> drops = found.drop.mean(), abrupt_drop(EvenRecord(t, saw, 0.01, True), found)
    >>> [round(float(drop), 1) for drop in drops]
    [1.2, 1.0]
    """
    if events.middle.size < 2:
        return np.nan
    period = float(np.diff(events.middle).mean())
    spacing = record.spacing / period
    count = int(_WINDOW_OF_FALL / spacing)
    # the middle of a fall is between two samples
    place = spacing * (np.arange(-count, count) + 0.5)
    reach = count * record.spacing
    whole = (events.middle - reach >= record.time[0]) & (events.middle + reach <= record.time[-1])
    if count < 2 or not whole.any():
        return np.nan
    moments = events.middle[whole, None] + period * place
    cycle = np.interp(moments, record.time, record.values).mean(axis=0)
    fall = 0.1
    for _ in range(_FALL_ROUNDS):
        edge = 0.5 * fall + _GAP_TO_FALL
        before, after = place < -edge, place > edge
        near = np.abs(place) <= edge + max(_AVERAGED_PART, 1.5 * spacing)
        if min((before & near).sum(), (after & near).sum(), before.sum() - 1, after.sum() - 1) < 1:
            return np.nan
        slope = 0.5 * (_slope(place[before], cycle[before]) + _slope(place[after], cycle[after]))
        level = cycle - slope * place
        high, low = level[before & near].mean(), level[after & near].mean()
        part = (level - low)[np.abs(place) <= edge + _AVERAGED_PART] / (high - low)
        fall = float(
            np.clip(6 * spacing * (part * (1 - part)).sum(), spacing, limits.MAX_ABRUPT_FALL.value)
        )
    return float(high - low - slope * fall)


def abrupt_rise(record: EvenRecord, events: Events) -> float:
    """Return the mean rise of a wave that falls slowly and rises abruptly, as in `abrupt_drop`."""
    turned = record._replace(values=-record.values)
    swing = float(np.min(events.drop)) if events.drop.size else 0.0
    return abrupt_drop(turned, find_events(turned.time, turned.values, 0.6 * swing))


def smooth_drop(record: EvenRecord, events: Events) -> float:
    """Return the mean drop, from peak to valley, of a wave that rises and falls smoothly.

    Parameters and result are those of `abrupt_drop`, with at least three events. A straight line, a
    sine and its second harmonic are fitted, whose phase advances by one period from the middle of
    one fall to the next: nearly the best possible estimate of a sine in noise.

    Examples
    --------
    >>> from tribolab.friction.oscillation.events import find_events
    >>> t = np.arange(0, 20, 0.01)
    >>> wave = 0.5 * np.sin(6 * t) + 0.1 * np.random.default_rng(0).standard_normal(t.size)
    >>> found = find_events(t, wave, 0.5)
    >>> drops = found.drop.mean(), smooth_drop(EvenRecord(t, wave, 0.01, True), found)
    >>> [round(float(drop), 1) for drop in drops]
    [1.3, 1.0]
    """
    if events.middle.size < 3:
        return np.nan
    first, last = np.searchsorted(record.time, events.middle[[0, -1]])
    time, values = record.time[first:last], record.values[first:last]
    if values.size < 12:
        return np.nan
    phase = 2 * np.pi * np.interp(time, events.middle, np.arange(events.middle.size))
    along = (time - time[0]) / (time[-1] - time[0])
    terms = np.stack([np.ones(time.size), along, *_two_harmonics(phase)], axis=1)
    size = np.linalg.lstsq(terms, values)[0][2:]
    turn = np.linspace(0, 2 * np.pi, _CYCLE_PHASES, endpoint=False)
    return float(np.ptp(size @ _two_harmonics(turn)))


def _two_harmonics(phase: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(phase), np.sin(phase), np.cos(2 * phase), np.sin(2 * phase)])


def _slope(x: np.ndarray, y: np.ndarray) -> float:
    x = x - x.mean()
    return float(x @ y / (x @ x))
