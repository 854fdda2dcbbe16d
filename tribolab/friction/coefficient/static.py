"""Static friction: peak of the force at each start of sliding, and duration of the rest before it.

It is measured for sleds, seals and wipers. A start is the end of a rest: the force rises before
sliding begins, and falls to the sliding force after the contact breaks away.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs
from tribolab.arrays.medians import median_of_known
from tribolab.core.errors import AnalysisError
from tribolab.friction.coefficient import limits
from tribolab.friction.coefficient.coefficient import friction_coefficient, friction_signal
from tribolab.friction.coefficient.peak import noise_between, peak_of_start
from tribolab.friction.coefficient.segment_samples import belong
from tribolab.friction.segments.specimens import begins_of_specimens
from tribolab.friction.segments.stretches import name_of
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp

_EXTENSION = 1.5  # the search is extended by this factor if the force still rises
# the force still rises if the mean of this last share of the readings is the highest
_END_SHARE = 0.1


class _Start(NamedTuple):
    """Segment number, samples in which its static friction is searched, and rest before it [s].

    The samples are `first` to `last`, or up to `latest` while the force still rises.
    """

    number: int
    first: int
    last: int
    latest: int
    rested: float


@of_runs
def static_friction(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None = None,
    within: str | float | None = None,
) -> xr.Dataset:
    """Return the static friction coefficient at each start of sliding that follows a rest.

    Parameters
    ----------
    run
        With ``friction_force`` and ``normal_force``, or ``friction_coefficient``.
    segments
        From `tribolab.find_segments` on the same run; they define the rests.
    friction
        From `tribolab.friction_coefficient` on both; computed if not given.
    within
        Distance from the start of motion within which the peak is looked for [m]; by default
        the untrimmed first part of the segment, extended while the force still rises, e.g. for a
        sled on a soft string (at most half of the segment).

    Returns
    -------
    xarray.Dataset
        On dim ``start_of_sliding`` (one for each segment after a rest; its number is the
        coordinate): ``static_friction_coefficient`` with ``_sem``; ``breakaway_force`` [N] with
        ``_sem`` (where forces are known); ``friction_coefficient`` of the sliding that follows;
        ``static_excess`` (static over sliding, minus 1); ``peak`` (1 if the peak is significant, 0
        if not: then the static coefficient is only the highest value of the start),
        ``breakaway_time`` [s], ``waiting_time`` (rest under load before; NaN if the record, or that
        of the specimen, begins with the motion) [s], ``direction``, ``sliding_speed`` [m/s].

    Raises
    ------
    AnalysisError
        If the run has no friction, or the segments are another run's.

    Notes
    -----
    The highest of n noisy readings exceeds the true peak. Therefore a parabola is fitted to the
    readings in the upper 20 % between sliding and the maximum, and the peak is its maximum. The
    error combines that of the fit, given the noise between neighbouring samples, and that of the
    zero. For a pointed peak that does not fit a parabola within the noise, fewer
    readings are used; with fewer than five the peak is the highest reading, as in ASTM D1894 and
    ISO 8295, and its error includes half of the larger step next to it. If no single reading
    exceeds the noise, means over 2, 4, 8 ... readings are used.

    References
    ----------
    .. [1] Dieterich (1972), J. Geophys. Res. 77, 3690-3697. doi:10.1029/JB077i020p03690
       (static friction grows with the time of rest)

    Examples
    --------
    A contact that breaks away at 0.6 and slides at 0.4, after 4 s of rest:

    >>> time = np.arange(0, 20, 0.01)
    >>> ratio = np.interp(time, [0, 3.5, 4, 4.5, 20], [0, 0, 0.6, 0.4, 0.4])
    >>> data = {"sliding_velocity": 1e-3 * (time > 4), "friction_force": 10 * ratio}
    >>> data["normal_force"] = np.full(time.size, 10.0)
    >>> run = xr.Dataset({name: ("time", v) for name, v in data.items()}, {"time": time})
    >>> from tribolab.friction.segments.find import find_segments
    >>> run.attrs["friction_force_zero_uncertainty_N"] = 0.01
    >>> starts = static_friction(run, find_segments(run))
    >>> starts.static_friction_coefficient.values.round(1), starts.waiting_time.values.round()
    (array([0.6]), array([4.]))
    """
    signal = friction_signal(run)
    if not signal:
        raise AnalysisError("the run has no friction", where=name_of(run))
    if friction is None:
        friction = friction_coefficient(run, segments)
    belong(run, segments)
    belong(run, friction)
    reach = None if within is None else to_si(within, "m", "within")
    rows = [
        _measure(run, friction, signal, start) for start in _starts(run, segments, friction, reach)
    ]
    names = list(_Peak._fields)
    data = {name: np.array([getattr(row, name) for row in rows], float) for name in names}
    number = data.pop("number").astype(int)
    data["static_excess"] = data["static_friction_coefficient"] / data["friction_coefficient"] - 1
    if signal != "friction_force" or "normal_force" not in run:
        data = {name: v for name, v in data.items() if not name.startswith("breakaway_force")}
    table = xr.Dataset(
        {name: ("start_of_sliding", values) for name, values in data.items()},
        coords={"start_of_sliding": number},
    )
    for name in ("peak", "direction"):
        table[name] = table[name].astype(np.int8)
    return stamp(table, **run.attrs)


class _Peak(NamedTuple):
    """Static friction at one start of sliding; the fields are named as in the dataset."""

    number: int
    static_friction_coefficient: float
    static_friction_coefficient_sem: float
    breakaway_force: float
    breakaway_force_sem: float
    friction_coefficient: float
    peak: int
    breakaway_time: float
    waiting_time: float
    direction: int
    sliding_speed: float


def _starts(
    run: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset, reach: float | None
) -> list[_Start]:
    """Return the starts of segments after a rest, or at the unloaded beginning of a record."""
    time = run.variables["time"].values
    resting = segments.variables["omitted_reason"].values == "at rest"
    begin, end = (segments.variables[f"omitted_{k}"].values[resting] for k in ("start", "stop"))
    start, trimmed = segments.variables["start"].values, segments.variables["trimmed_start"].values
    stop, speed = segments.variables["stop"].values, segments.variables["sliding_speed"].values
    starts = []
    slack = _starts_slack(run, friction, start)
    for i in range(start.size):
        if slack[i]:
            latest = start[i] + limits.MAX_TIME_OF_RISE.value * (stop[i] - start[i])
            if reach and speed[i] > 0:
                latest = start[i] + reach / speed[i]
            first, last, end_of_it = np.searchsorted(time, [start[i], trimmed[i], latest])
            last = end_of_it if reach else last
            if last - first >= limits.MIN_SAMPLES_OF_PEAK.value:
                starts.append(_Start(i, int(first), int(last), int(end_of_it), float("nan")))
            continue
        before = np.flatnonzero(end <= start[i] + 1e-9)
        earliest = stop[i - 1] if i else time[0]
        if not before.size or end[before[-1]] < earliest:
            continue  # no rest since the previous segment: this is no start
        rest = before[-1]
        limit, latest = trimmed[i], start[i] + limits.MAX_TIME_OF_RISE.value * (stop[i] - start[i])
        if reach is not None and speed[i] > 0:
            limit = latest = start[i] + reach / speed[i]
        # the force may rise before motion is detected
        back = max(
            begin[rest], start[i] - limits.MAX_TIME_BEFORE_SEGMENT.value * (stop[i] - start[i])
        )
        first, last, end_of_it = np.searchsorted(time, [back, limit, max(limit, latest)])
        if last - first >= limits.MIN_SAMPLES_OF_PEAK.value:
            rested = _rest_duration(run, begin, end, int(rest))
            starts.append(_Start(i, int(first), int(last), int(end_of_it), rested))
    return starts


def _starts_slack(run: xr.Dataset, friction: xr.Dataset, start: np.ndarray) -> np.ndarray:
    """Return a mask of segments that begin a record or specimen with a force still near zero."""
    signal = friction_signal(run)
    time, values = run.variables["time"].values, run.variables[signal].values
    begins = np.append(time[:1], begins_of_specimens(run))
    first = np.isin(start, begins)
    zero = friction.variables[f"{signal}_offset"].values
    sliding = np.abs(friction.variables[signal].values)
    for i in np.flatnonzero(first):
        at = int(np.searchsorted(time, start[i]))
        read = values[at : at + limits.MIN_SAMPLES_OF_PEAK.value]
        first[i] = (
            abs(float(np.nanmean(read)) - zero[i]) < limits.MAX_FORCE_BEFORE_RISE.value * sliding[i]
        )
    return first


def _rest_duration(run: xr.Dataset, begin: np.ndarray, end: np.ndarray, rest: int) -> float:
    """Return the duration of the rest under load before the motion [s]."""
    time = run.variables["time"].values
    first, last = np.searchsorted(time, [begin[rest], end[rest]])
    if "normal_force" not in run or last <= first:
        return float(end[rest] - begin[rest])
    load = run.variables["normal_force"].values[first:last]
    level = float(median_of_known(load[-max(load.size // 10, 1) :]))
    light = np.flatnonzero(load < 0.5 * level)
    since = time[first + light[-1]] if light.size and level > 0 else begin[rest]
    return float(end[rest] - since)


def _measure(run: xr.Dataset, friction: xr.Dataset, signal: str, start: _Start) -> _Peak:
    i = start.number
    part = slice(start.first, start.latest)
    time = run.variables["time"].values[part]
    zero = float(friction.variables[f"{signal}_offset"].values[i])
    way = int(friction.variables["direction"].values[i]) or 1
    values = way * (np.asarray(run.variables[signal].values[part], float) - zero)
    sliding = float(friction.variables["friction_coefficient"].values[i])
    sem = float(friction.variables["friction_coefficient_sem"].values[i])
    load = _load(run, friction, i, part)
    ratio = values / load if load is not None else values
    noise = min(noise_between(ratio), noise_between(ratio[start.last - start.first :]))
    taken = _count_readings(ratio, start.last - start.first)
    moment, height, error, clear = peak_of_start(time[:taken], ratio[:taken], sliding, sem, noise)
    pressed = float(median_of_known(load)) if load is not None else np.nan
    return _Peak(
        number=int(friction["segment"].values[i]),
        static_friction_coefficient=height,
        static_friction_coefficient_sem=error,
        breakaway_force=height * pressed,
        breakaway_force_sem=error * pressed,
        friction_coefficient=sliding,
        peak=int(clear),
        breakaway_time=moment,
        waiting_time=start.rested,
        direction=way,
        sliding_speed=float(friction.variables["sliding_speed"].values[i]),
    )


def _load(run: xr.Dataset, friction: xr.Dataset, i: int, part: slice) -> np.ndarray | None:
    """Return the normal force at a start of sliding, minus its zero [N]; NaN without contact."""
    if "normal_force" not in run or "friction_force" not in run:
        return None
    zeros = friction.variables.get("normal_force_offset")
    offset = 0.0 if zeros is None else zeros.values[i]
    load = np.asarray(run.variables["normal_force"].values[part], float) - float(offset)
    usual = float(friction.variables["normal_force"].values[i])
    return np.where(load > 0.5 * usual, load, np.nan)


def _count_readings(ratio: np.ndarray, usual: int) -> int:
    """Return how many readings of a start are searched: `usual`, or more while friction rises."""
    taken = usual
    while taken < ratio.size:
        size = max(int(_END_SHARE * taken), limits.MIN_SAMPLES_OF_PEAK.value)
        blocks = [ratio[max(end - size, 0) : end] for end in range(taken, 0, -size)]
        means = [float(np.nanmean(b)) for b in blocks if np.isfinite(b).any()]
        if means and means[0] < max(means):
            break
        taken = min(int(_EXTENSION * taken) + 1, ratio.size)
    return taken
