"""Static friction: the peak of the force at each start of sliding, and how long the contact rested.

What sled tests, seals and wipers are measured for. A start is where a rest ends; the force rises
while nothing slides yet, and falls to the sliding force once the contact has let go.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.errors import AnalysisError
from tribolab.friction.coefficient.coefficient import belong, friction_coefficient
from tribolab.friction.segments.stretches import name_of
from tribolab.several import of_runs
from tribolab.stamping import stamp
from tribolab.units import to_si

BEFORE = 0.5  # of the stroke before: how far back a rise may begin, at most
CLEAR = 3.0  # standard errors of the peak above sliding from which it is one
_FEWEST = 5  # samples of a start
_NOISE = 1.4826 / np.sqrt(2)  # median of the steps between samples -> standard deviation
_NEAR = 0.8  # of the way from sliding to the highest reading: what belongs to the peak


class _Start(NamedTuple):
    """Start of one segment: samples before and within it, and how long the contact rested."""

    number: int
    first: int
    last: int
    rested: float


@of_runs
def static_friction(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None = None,
    within: str | float | None = None,
) -> xr.Dataset:
    """Measure static friction at each start of sliding that follows a rest.

    Parameters
    ----------
    run
        With ``friction_force`` and ``normal_force``, or ``friction_coefficient``.
    segments
        From `tribolab.find_segments` on the same run: they say where it was at rest.
    friction
        From `tribolab.friction_coefficient` on both; computed if not given.
    within
        Distance from the start of motion within which the peak is looked for [m]; by default
        the untrimmed first part of the segment.

    Returns
    -------
    xarray.Dataset
        On dim ``start_of_sliding`` (one for each segment after a rest; its number is the
        coordinate): ``static_friction_coefficient`` with ``_sem``; ``breakaway_force`` [N] with
        ``_sem`` (where forces are known); ``friction_coefficient`` of the sliding that follows;
        ``static_excess`` (static over sliding, less 1); ``peak`` (1 where the force stands out of
        what follows, 0 where it only rises to it: then the static coefficient is no more than the
        highest of the start), ``breakaway_time`` [s], ``waiting_time`` (rest under load before)
        [s], ``direction``, ``sliding_speed`` [m/s].

    Raises
    ------
    AnalysisError
        If the run has no friction, or the segments are another run's.

    Notes
    -----
    The highest of n noisy readings lies above the true peak. So readings near the top (from 80 %
    of the way between sliding and the highest reading on) are fitted by a parabola, and the peak
    is its highest value within them; the error is that of the fit, with the noise between
    neighbouring samples as the readings' own, and that of the zero. With fewer than five readings
    near the top the peak is their mean. Where a single reading does not stand out of the noise,
    means over 2, 4, 8 ... readings are looked at. ASTM D1894 and ISO 8295 take the highest reading.

    References
    ----------
    .. [1] Dieterich (1972), J. Geophys. Res. 77, 3690-3697. doi:10.1029/JB077i020p03690
       (static friction grows with the time of rest)

    Examples
    --------
    A contact that lets go at 0.6 and slides at 0.4, after 4 s of rest:

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
    signal = "friction_force" if "friction_force" in run else "friction_coefficient"
    if signal not in run:
        raise AnalysisError("the run has no friction", where=name_of(run))
    if friction is None:
        friction = friction_coefficient(run, segments)
    belong(run, segments)
    belong(run, friction)
    reach = None if within is None else to_si(within, "m", "within")
    rows = [_measured(run, friction, signal, start) for start in _starts(run, segments, reach)]
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
    """What is known of one start, in the names of the result."""

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


def _starts(run: xr.Dataset, segments: xr.Dataset, reach: float | None) -> list[_Start]:
    """Segments that a rest goes before, or the beginning of the record."""
    time = run.variables["time"].values
    resting = segments.variables["omitted_reason"].values == "at rest"
    begin, end = (segments.variables[f"omitted_{k}"].values[resting] for k in ("start", "stop"))
    start, trimmed = segments.variables["start"].values, segments.variables["trimmed_start"].values
    stop, speed = segments.variables["stop"].values, segments.variables["sliding_speed"].values
    starts = []
    for i in range(start.size):
        before = np.flatnonzero(end <= start[i] + 1e-9)
        earliest = stop[i - 1] if i else time[0]
        if not before.size or end[before[-1]] < earliest:
            continue  # it was already moving
        rest = before[-1]
        limit = trimmed[i]
        if reach is not None and speed[i] > 0:
            limit = start[i] + reach / speed[i]
        # the force may rise before the velocity shows motion
        back = max(begin[rest], start[i] - BEFORE * (stop[i] - start[i]))
        first, last = np.searchsorted(time, [back, limit])
        if last - first >= _FEWEST:
            rested = _rested(run, begin, end, int(rest))
            starts.append(_Start(i, int(first), int(last), rested))
    return starts


def _rested(run: xr.Dataset, begin: np.ndarray, end: np.ndarray, rest: int) -> float:
    """How long the contact rested under load before it moved [s]."""
    time = run.variables["time"].values
    first, last = np.searchsorted(time, [begin[rest], end[rest]])
    if "normal_force" not in run or last <= first:
        return float(end[rest] - begin[rest])
    load = run.variables["normal_force"].values[first:last]
    level = float(np.nanmedian(load[-max(load.size // 10, 1) :]))
    light = np.flatnonzero(load < 0.5 * level)
    since = time[first + light[-1]] if light.size and level > 0 else begin[rest]
    return float(end[rest] - since)


def _measured(run: xr.Dataset, friction: xr.Dataset, signal: str, start: _Start) -> _Peak:
    i = start.number
    part = slice(start.first, start.last)
    time = run.variables["time"].values[part]
    zero = float(friction.variables[f"{signal}_offset"].values[i])
    way = int(friction.variables["direction"].values[i]) or 1
    values = way * (np.asarray(run.variables[signal].values[part], float) - zero)
    sliding = float(friction.variables["friction_coefficient"].values[i])
    sem = float(friction.variables["friction_coefficient_sem"].values[i])
    load = _load(run, friction, i, part)
    ratio = values / load if load is not None else values
    moment, height, error, stands = _peak(time, ratio, sliding, sem)
    pressed = float(np.nanmedian(load)) if load is not None else np.nan
    return _Peak(
        number=int(friction["segment"].values[i]),
        static_friction_coefficient=height,
        static_friction_coefficient_sem=error,
        breakaway_force=height * pressed,
        breakaway_force_sem=error * pressed,
        friction_coefficient=sliding,
        peak=int(stands),
        breakaway_time=moment,
        waiting_time=start.rested,
        direction=way,
        sliding_speed=float(friction.variables["sliding_speed"].values[i]),
    )


def _load(run: xr.Dataset, friction: xr.Dataset, i: int, part: slice) -> np.ndarray | None:
    """Return the normal force over a start without its zero; what is not pressed is NaN."""
    if "normal_force" not in run or "friction_force" not in run:
        return None
    zeros = friction.variables.get("normal_force_offset")
    offset = 0.0 if zeros is None else zeros.values[i]
    load = np.asarray(run.variables["normal_force"].values[part], float) - float(offset)
    usual = float(friction.variables["normal_force"].values[i])
    return np.where(load > 0.5 * usual, load, np.nan)


def _peak(
    time: np.ndarray, ratio: np.ndarray, sliding: float, sem: float
) -> tuple[float, float, float, bool]:
    """Moment, height and error of the highest part of a start, and whether it stands out."""
    known = np.isfinite(ratio)
    time, ratio = time[known], ratio[known]
    if ratio.size < _FEWEST or not np.isfinite(sliding):
        return np.nan, np.nan, np.nan, False
    noise = _NOISE * float(np.median(np.abs(np.diff(ratio))))
    smooth, width, clear = _smoothed(ratio, sliding, noise)
    top = int(np.argmax(smooth))
    level = sliding + _NEAR * (smooth[top] - sliding)
    low = np.flatnonzero(smooth < level)
    first = low[low < top][-1] + 1 if (low < top).any() else 0
    last = low[low > top][0] if (low > top).any() else ratio.size
    if not clear:  # the highest of noise: what a stretch as long as its own mean holds
        first, last = top, min(top + 1, smooth.size)
    near, when = ratio[first : last + width - 1], time[first : last + width - 1]
    if not clear or near.size < _FEWEST or not np.ptp(when) > 0:
        height, error, moment = float(near.mean()), noise / np.sqrt(near.size), float(when.mean())
    else:
        height, error, moment = _parabola(when, near, noise)
    if not clear:  # where the start ends and sliding begins is not seen
        error = float(np.hypot(error, height - sliding))
    error = float(np.hypot(error, sem))
    return moment, height, error, bool(clear and height - sliding > CLEAR * error)


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


def _parabola(time: np.ndarray, values: np.ndarray, noise: float) -> tuple[float, float, float]:
    """Height of a parabola's highest point within its readings, its error, and the moment."""
    middle, half = (time[0] + time[-1]) / 2, (time[-1] - time[0]) / 2
    u = (time - middle) / half
    basis = np.stack([np.ones(u.size), u, u * u], axis=1)
    terms, *_ = np.linalg.lstsq(basis, values, rcond=None)
    rest = values - basis @ terms
    scatter = max(noise, float(np.sqrt(rest @ rest / max(u.size - 3, 1))))
    at = -terms[1] / (2 * terms[2]) if terms[2] < 0 else np.sign(terms[1])
    at = float(np.clip(at, -1.0, 1.0))
    row = np.array([1.0, at, at * at])
    error = scatter * float(np.sqrt(row @ np.linalg.pinv(basis.T @ basis) @ row))
    return float(row @ terms), error, float(middle + half * at)
