"""Segments of constant speed of a run, and the intervals that are omitted, with reasons."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs, over_dims, stated_value
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import AnalysisError, UnitError, shown
from tribolab.friction.segments import limits
from tribolab.friction.segments.loaded import loaded
from tribolab.friction.segments.measured import measured
from tribolab.friction.segments.no_segment import add_needed_rate
from tribolab.friction.segments.pieces import ConstancyLimits
from tribolab.friction.segments.specimens import apart
from tribolab.friction.segments.standstill import without_standstills
from tribolab.friction.segments.stretches import (
    Stretch,
    from_position,
    from_set_speed,
    from_steps,
    from_velocity,
    name_of,
    of_points,
    velocity_source,
)
from tribolab.friction.segments.strokes import middle_parts, shuttles
from tribolab.units.conversion import to_si


@of_runs
@over_dims(trim=())
def find_segments(
    run: xr.Dataset,
    trim: str | float | xr.DataArray = 0.10,
    *,
    resolution: float = 0.02,
    drift: float = 0.10,
    min_samples: int = 10,
    min_duration: str | float = 0.0,
    max_gap: str | float | None = None,
    rest_speed: str | float | None = None,
    position_range: tuple[str | float, str | float] | None = None,
    stroke_middle: str | float | None = None,
) -> xr.Dataset:
    """Find the segments of constant speed of a run, or the middles of its strokes.

    Parameters
    ----------
    run
        Dataset with dim ``time`` and one of ``sliding_velocity``, ``position``, ``step``; the first
        available one is used (see Notes). If the position shows standstills in segments of the
        recorded velocity, the position is used.
    trim
        Share of each segment's duration that is omitted at each end, 0 <= trim < 0.5; ``"10 %"`` is
        0.1. An array of several shares adds its dim to the result.
    resolution
        Relative difference of speed that separates two neighbouring plateaus.
    drift
        Relative change of speed within one plateau above which it is a ramp.
    min_samples
        Fewest samples in a segment.
    min_duration
        Shortest segment [s].
    max_gap
        Longest pause between two samples within a segment [s]; by default a twentieth of the
        segment (a quarter if the segments are from ``position``) and at least 20 usual sample
        spacings.
    rest_speed
        Speed below which the slider is at rest [m/s]; by default a twentieth of the noise of a
        reading, or 1e-5 of the highest speed, unless more than 1 % of the longest slide is covered
        at such low speed.
    position_range
        Only the part of each trimmed segment between these positions [m] is used.
    stroke_middle
        For a reciprocating slider without constant speed, as driven by a crank: each stroke is a
        segment, of which this share of its length around the middle is used ("40 %" of a sinusoidal
        stroke is within 9 % of its highest speed). `trim` and the limits of constant speed do not
        apply then; the record before the first and after the last turn is omitted. Default, unless
        a `position_range` is given: half of each stroke if the run is never (or for less than 5 %
        of the time) at constant speed, and its speed follows from a stroke and a frequency
        (attribute ``stroke_m``), or its position and friction show equal reciprocating strokes.

    Returns
    -------
    xarray.Dataset
        On dim ``segment``: ``start``, ``stop``, ``trimmed_start``, ``trimmed_stop`` [s],
        ``sliding_speed`` [m/s], ``direction`` (+1, -1; 0 unknown), ``sliding_distance`` [m] and
        ``samples`` of the trimmed part, and the run's labels (``set_speed``, ``step`` ...) if any.
        On dim ``omitted``: ``omitted_start``, ``omitted_stop`` [s] and ``omitted_reason``.
        Attributes ``trim`` and ``velocity_source`` (``"recorded"``, ``"position"``, ``"step"`` or
        ``"set speed"``); with a `position_range`, ``position_low_m`` and ``position_high_m``; for
        middles of strokes ``stroke_middle``; ``standstill_s`` if the position shows standstills
        that contradict the recorded velocity.

    Raises
    ------
    AnalysisError
        If `trim` is out of range, the run has no samples, or its speed is unknown.

    Notes
    -----
    The segments of the paper [1]_ (Appendix C): "for each imposed sliding speed, the corresponding
    constant-velocity segment was identified from the velocity signal. The first and final 10 % of
    each segment were excluded". A step of relative height s between two plateaus of N samples with
    white relative noise r is resolved if s > max(resolution, 18 r sqrt(2/N)).

    From ``position`` the velocity is a robust slope over blocks that are just long enough. Without
    velocity and position each ``step`` is a segment (speed from ``set_speed`` if known, direction
    from the sign of the mean friction force); with a set speed alone (variable or attribute
    ``set_speed_m_s``) the whole record is one segment. If the rows of a run are results (attribute
    ``rows_are``: ``"points"``, or ``"either"`` without plateaus), each moving row is a segment of
    one sample of unknown error.

    References
    ----------
    .. [1] Xu et al. (2026), Appendix C.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> v = np.repeat([0.0, 1e-3, 0.0, -1e-3, 0.0], 100)
    >>> run = xr.Dataset({"sliding_velocity": ("time", v)}, {"time": np.arange(500) / 10})
    >>> found = find_segments(run)
    >>> found.direction.values.tolist(), found.omitted_reason.values.tolist()
    ([1, -1], ['at rest', 'at rest', 'at rest'])
    """
    share = _share(stated_value(trim))
    if "time" not in run.dims or run.sizes["time"] == 0:
        raise AnalysisError(f"{name_of(run)}: the run has no samples, so no segments can be found")
    shortest = to_si(min_duration, "s", name="min_duration")
    gap = None if max_gap is None else to_si(max_gap, "s", name="max_gap")
    slow = None if rest_speed is None else to_si(rest_speed, "m/s", name="rest_speed")
    min_samples = int(min_samples)
    constancy = ConstancyLimits(resolution, drift, min_samples, slow)

    source, standstill = velocity_source(run), 0.0
    rows_are = RunAttributes.from_attrs(run.attrs).rows_are
    if rows_are == "points":
        return _use_points(run, source)
    if stroke_middle is not None:
        return _use_strokes(run, source, to_si(stroke_middle, "1", "stroke_middle"), min_samples)
    if source == "recorded":
        stretches = from_velocity(run, constancy, gap)
        if "stroke_m" not in run.attrs:
            stretches, standstill = without_standstills(run, stretches)
            source = "position" if standstill else source
        if "stroke_m" in run.attrs:  # a computed velocity has no noise: it is exactly zero at rest
            stretches = [_mark_ramp(run, stretch) for stretch in stretches]
    elif source == "position":
        stretches = apart(run, from_position(run, constancy, gap))
    elif source == "step":
        stretches = from_steps(run, min_samples)
    else:
        stretches = from_set_speed(run, min_samples)
    stretches = [
        s._replace(kind="too short") if s.kind == "constant" and s.stop - s.start < shortest else s
        for s in stretches
    ]
    stretches = loaded(run, stretches, constancy)
    plateaus = measured(run, stretches, source, share, position_range)
    if standstill:
        plateaus.attrs["standstill_s"] = standstill
    by_chance = (
        plateaus.sizes["segment"]
        and _plateau_share(run, plateaus) < limits.MAX_TIME_OF_CHANCE_PLATEAUS.value
    )
    if position_range is not None or (plateaus.sizes["segment"] and not by_chance):
        return plateaus
    if by_chance and not shuttles(run):
        return plateaus
    if rows_are == "either":
        return _use_points(run, source)
    if "stroke_m" not in run.attrs and not shuttles(run):
        return add_needed_rate(run, plateaus)
    try:  # a crank-driven slider has no constant speed: use the middles of its strokes
        middles = _use_strokes(
            run,
            source,
            limits.MIDDLE_OF_CRANK_STROKE.value,
            min(min_samples, limits.MIN_SAMPLES_OF_MIDDLE.value),
        )
    except AnalysisError:  # not reciprocating: the reason why no plateau was found is more useful
        return plateaus
    return add_needed_rate(run, middles)


def _plateau_share(run: xr.Dataset, plateaus: xr.Dataset) -> float:
    """Return the share of a run's time in plateaus."""
    time = run["time"].values
    lasted = float((plateaus["stop"] - plateaus["start"]).sum())
    return lasted / float(time[-1] - time[0]) if time[-1] > time[0] else 1.0


def _use_points(run: xr.Dataset, source: str) -> xr.Dataset:
    """Return one segment for each row of a file whose rows are results at one speed."""
    return measured(run, of_points(run), source, 0.0, None).assign_attrs(rows_are="points")


def _mark_ramp(run: xr.Dataset, stretch: Stretch) -> Stretch:
    """Return a rest reclassified as a ramp if the velocity, computed for a crank, is not zero."""
    first, last = np.searchsorted(run["time"].values, (stretch.start, stretch.stop))
    if stretch.kind != "at rest" or not run["sliding_velocity"].values[first : last + 1].any():
        return stretch
    return stretch._replace(kind="ramp")


def _share(trim: str | float) -> float:
    try:
        share = to_si(trim, "1", name="trim")
    except UnitError:
        share = np.nan
    if not 0 <= share < 0.5:
        raise AnalysisError(
            f"trim: a share of at least 0 and below 0.5 is wanted, e.g. 0.10 or '10 %'; got "
            f"{shown(repr(trim))}"
        )
    return share


def _use_strokes(run: xr.Dataset, source: str, share: float, min_samples: int) -> xr.Dataset:
    """Return the middle part of each stroke as a segment."""
    if not 0 < share <= 1:
        raise AnalysisError(
            f"stroke_middle: a share above 0 and at most 1 is wanted, e.g. '40 %'; got {share:g}"
        )
    strokes, begin, end, count = middle_parts(run, share)
    time = run["time"].values
    start, stop = time[strokes.first[:-1]], time[strokes.first[1:]]
    good = strokes.usual & (count >= min_samples)
    kind = np.where(good, "constant", np.where(strokes.usual, "too short", "no whole stroke"))
    kind = np.where(strokes.paused, "gap", kind)
    speed = strokes.way * share * strokes.length / np.where(end > begin, end - begin, np.inf)
    stretches = [
        Stretch(float(a), float(b), str(what), float(v))
        for a, b, what, v in zip(start, stop, kind, speed, strict=True)
    ]
    ends = (
        (time[0], start[0], "before the first turn"),
        (stop[-1], time[-1], "after the last turn"),
    )
    stretches += [Stretch(float(a), float(b), why, np.nan) for a, b, why in ends if b > a]
    result = measured(run, stretches, source, 0.0, None, (begin[good], end[good]))
    return result.assign_attrs(stroke_middle=share)
