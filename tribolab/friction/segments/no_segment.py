"""Reasons why a run has no segment."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.core.errors import AnalysisError
from tribolab.friction.segments import limits
from tribolab.friction.segments.strokes import find_strokes

# a sine covers the middle half of its stroke in a third of the time
_SAMPLES_OF_STROKE = 3 * limits.MIN_SAMPLES_OF_MIDDLE.value


def add_needed_rate(run: xr.Dataset, segments: xr.Dataset) -> xr.Dataset:
    """Add the samples per stroke and the sampling rate needed, if too low for a segment."""
    if segments.sizes["segment"] or not {"position", "sliding_velocity"} & set(run.data_vars):
        return segments
    try:
        first = find_strokes(run).first
    except AnalysisError:  # no strokes
        return segments
    samples, lasts = (
        float(median(np.diff(first))),
        float(median(np.diff(run["time"].values[first]))),
    )
    if samples >= _SAMPLES_OF_STROKE:
        return segments
    rate = _SAMPLES_OF_STROKE / lasts
    return segments.assign_attrs(samples_of_stroke=samples, needed_rate_Hz=rate)


def why_no_segment(segments: xr.Dataset) -> str:
    """Return the reason why a run has no segment, as a sentence; else "".

    Parameters
    ----------
    segments
        From `find_segments`.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.friction.segments.find import find_segments
    >>> v = 1e-3 * np.arange(500.0)
    >>> run = xr.Dataset({"sliding_velocity": ("time", v)}, {"time": np.arange(500) / 10})
    >>> why_no_segment(find_segments(run))
    'no segment: the run never slides at constant speed (ramp 100 % of the time)'
    """
    if segments.sizes["segment"]:
        return ""
    if (samples := segments.attrs.get("samples_of_stroke")) is not None:
        return (
            f"no segment: a stroke has {samples:g} samples, and its middle half needs "
            f"{_SAMPLES_OF_STROKE}; record at {segments.attrs['needed_rate_Hz']:.3g} Hz or more"
        )
    lasted = _omitted_times(segments)
    whole = sum(lasted.values())
    shares = [
        f"{why} {lasted[why] / whole:.0%}".replace("%", " %")
        for why in sorted(lasted, key=lambda why: -lasted[why])
        if whole > 0 and lasted[why] >= 0.005 * whole
    ]
    detail = f" ({', '.join(shares)} of the time)" if shares else ""
    return f"no segment: the run never slides at constant speed{detail}"


def consists_of_ramps(segments: xr.Dataset) -> bool:
    """Return whether the speed of a run rises or falls for most of it, so that it has no segment.

    Parameters
    ----------
    segments
        From `find_segments`.
    """
    if segments.sizes["segment"]:
        return False
    lasted = _omitted_times(segments)
    return lasted.get("ramp", 0.0) > limits.RAMP_SHARE.value * sum(lasted.values())


def _omitted_times(segments: xr.Dataset) -> dict[str, float]:
    """Return the time omitted for each reason [s]."""
    lasted = segments["omitted_stop"].values - segments["omitted_start"].values
    reason = segments["omitted_reason"].values.astype(str)
    return {why: float(lasted[reason == why].sum()) for why in dict.fromkeys(reason)}
