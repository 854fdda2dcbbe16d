"""Regularity of an oscillation: regular, irregular, or intermittent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.events import Events
from tribolab.friction.oscillation.spectrum.spectra import EvenRecord

SLIP_KINDS = ("regular", "irregular", "intermittent")


class Regularity(NamedTuple):
    """Regularity of an oscillation, share of the time with oscillation, and periods.

    Parameters
    ----------
    kind
        One of `SLIP_KINDS`; empty for too few periods.
    share
        Share of the time with oscillation.
    periods
        Times from drop to drop, pauses left out [s].
    """

    kind: str
    share: float
    periods: np.ndarray


def regularity(record: EvenRecord, events: Events) -> Regularity:
    """Return whether an oscillation is regular, irregular or intermittent, and its periods.

    Parameters
    ----------
    record
        The record in which the events were found.
    events
        Cycles of stick and slip.

    Returns
    -------
    Regularity
        Intermittent if over a seventh of the time is quiet, else irregular if the periods scatter
        by more than 18 %.

    Notes
    -----
    A long time between two drops is a pause if friction neither rises in its middle as in a long
    stick, nor swings as in a long wave. The same applies before the first drop and after the last.

    Examples
    --------
    >>> from tribolab.friction.oscillation.events import find_events
    >>> t = np.arange(0, 60, 0.01)
    >>> saw = np.where((t > 20) & (t < 40), 0.5, t % 1.0)
    >>> found = regularity(EvenRecord(t, saw, 0.01, True), find_events(t, saw, 0.3))
    >>> found.kind, round(found.share, 1)
    ('intermittent', 0.7)
    """
    between = np.diff(events.middle)
    if between.size < 2:
        return Regularity("", np.nan, between)
    usual = float(median(between))
    drop = float(np.mean(events.drop))
    ends = np.array([record.time[0], record.time[-1]])
    first, last = events.middle[0], events.middle[-1]
    quiet = 0.0
    paused = np.zeros(between.size, bool)
    for k in np.flatnonzero(between > limits.MIN_PAUSE.value * usual):
        a, b = events.middle[k], events.middle[k + 1]
        climb = drop * (b - a - 1.3 * usual) / (b - a)
        # a train of periods begins with a rise and ends with a drop, or conversely if reversed
        if any(_is_still(record, a + c * usual, b - (1.3 - c) * usual, climb) for c in (0.3, 1.0)):
            paused[k] = True
            quiet += float(b - a - usual)
    # at an end of the record a period is incomplete
    for c in (0.3, 1.0):
        for a, b in ((ends[0], first - c * usual), (last + c * usual, ends[1])):
            if b - a > usual and _is_still(record, a, b, drop * min((b - a) / usual, 1.0)):
                quiet += 0.5 * float(b - a)  # the mean over both orders of rise and drop
    share = float(np.clip(1 - quiet / (ends[1] - ends[0]), 0.0, 1.0))
    periods = between[~paused]
    if share < 1 - limits.MIN_QUIET_TIME.value:
        return Regularity(SLIP_KINDS[2], share, periods)
    kind = (
        SLIP_KINDS[1]
        if scatter(periods) > limits.MAX_SCATTER_OF_REGULAR_PERIODS.value
        else SLIP_KINDS[0]
    )
    return Regularity(kind, 1.0, periods)


def scatter(periods: np.ndarray) -> float:
    """Return the standard deviation divided by the mean; NaN for fewer than two values."""
    return float(np.std(periods, ddof=1) / periods.mean()) if periods.size > 1 else np.nan


def _is_still(record: EvenRecord, start: float, stop: float, climb: float) -> bool:
    """Return whether friction hardly changes in an interval, compared with a stick's `climb`."""
    part = slice(*np.searchsorted(record.time, [start, stop]))
    values = record.values[part]
    if values.size < 6:
        return False
    pieces = min(values.size // 2, 8)
    size, longer = divmod(values.size, pieces)  # the first pieces are one sample longer
    first = np.arange(pieces) * size + np.minimum(np.arange(pieces), longer)
    means = np.add.reduceat(values, first) / np.diff(first, append=values.size)
    # the centres of the first and the last piece are one piece closer than the ends
    expected = climb * (1 - 1 / pieces)
    return float(np.ptp(means)) < limits.MAX_CHANGE_IN_PAUSE.value * expected
