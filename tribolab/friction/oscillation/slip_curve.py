"""Stick-slip of several runs against sliding speed, and the scaling of frequency with speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import special

from tribolab.arrays.medians import median_of_known
from tribolab.core.errors import AnalysisError
from tribolab.friction.decisions.rejected import REJECTED, kept
from tribolab.friction.joined import Label, grouped, joined_curves
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.rig_waves import REPEATS
from tribolab.friction.oscillation.slip_table import ringing
from tribolab.friction.oscillation.waveform import CLASSES, NOT_CLEAR, NOT_LOOKED_AT, oscillating
from tribolab.units.stamping import stamp

STEADY_SLIDING = CLASSES[0]
_RESONANCE = "resonance"
FIXED_FREQUENCY = "frequency does not go with the speed: it is fixed"
_MEANS = (
    "drop",
    "dominant_wavelength",
    "recurrence_distance",
    "dominant_frequency",
    "fall_share",
    "harmonic_content",
    "period_scatter",
    "oscillating_time_share",
)
_NUMBERS = (*_MEANS, "oscillation_swing", "rig_swing")
# variables of a `stick_slip` result that a curve needs; others are not read
NEEDED = frozenset(
    {"sliding_speed", "waveform", "instrument", "regularity", REJECTED, *_NUMBERS}
    | {f"force_{name}" for name in _NUMBERS}
)


class Scaling(NamedTuple):
    """Scaling of frequency with speed: f ~ v^exponent.

    Parameters
    ----------
    exponent, error
        Exponent and its standard error; 1 is a fixed wavelength, 0 a fixed frequency.
    speeds
        Number of speeds.
    text
        Interpretation in words.
    """

    exponent: float
    error: float
    speeds: int
    text: str


def stick_slip_curve(
    slips: Sequence[xr.Dataset], speed_tolerance: float = 0.1, **labels: Sequence[Label]
) -> xr.Dataset:
    """Return stick-slip against sliding speed, from the segments of several runs.

    Parameters
    ----------
    slips
        From `stick_slip`, one per run; segments that a person rejected are left out.
    speed_tolerance
        Neighbouring speeds that differ by no more than this are combined.
    **labels
        Labels that distinguish the runs, one for each run, e.g. ``surface=["Sb-R", "Smooth"]``.
        Runs with the same labels make one curve.

    Returns
    -------
    xarray.Dataset
        On dim ``sliding_speed``: ``segments`` that were evaluated, ``segments_oscillating`` among
        them, ``waveform`` and ``regularity`` (the most frequent ones if more than half of the
        decided segments oscillate, else smooth sliding, or "not decided" if most are not), means
        over the oscillating segments and ``_std`` of ``drop``, ``dominant_wavelength`` [m] (of the
        spectrum), ``recurrence_distance`` [m] (between drops), ``dominant_frequency`` [Hz],
        ``fall_share``, ``harmonic_content``, ``period_scatter``, ``oscillating_time_share``, and,
        over all segments, ``oscillation_swing`` (without oscillation the upper limit of an
        undetected one); ``rig_swing`` and ``rig_wave`` (text): waves that repeat with each turn of
        the rig, not stick-slip. Segments whose oscillation is a resonance of the rig, seen in one
        run or over all, count as smooth. Attributes ``scaling_exponent``, ``scaling_error``,
        ``scaling`` and, for a resonance, ``resonance_frequency_Hz``. With `labels` all variables
        are also over these dims (`joined_curves`), and the attributes become variables over them.

    Raises
    ------
    AnalysisError
        If there is no run, or not one label for each run.

    Examples
    --------
    >>> from tribolab.friction.segments.find import find_segments
    >>> from tribolab.friction.oscillation.slip_segments import stick_slip
    >>> from tribolab.rig import simulate_trace
    >>> run = simulate_trace("sawtooth", wavelength=22e-6, samples=1000, speed=1e-5)
    >>> curve = stick_slip_curve([stick_slip(run, find_segments(run))])
    >>> curve.waveform.item(), f"{1e6 * curve.dominant_wavelength.item():.0f} um"
    ('sawtooth stick-slip', '22 um')
    >>> slip = stick_slip(run, find_segments(run))
    >>> stick_slip_curve([slip, slip], medium=["dry", "oil"]).waveform.dims
    ('medium', 'sliding_speed')
    """
    if labels:
        return _join_curves(slips, speed_tolerance, labels)
    if not slips:
        raise AnalysisError("stick-slip against speed needs at least one run; none was given")
    slips = [kept(slip) for slip in slips]
    speed = np.concatenate([s["sliding_speed"].values for s in slips])
    kind = np.concatenate([s["waveform"].values for s in slips]).astype(object)
    own = _column(slips, "dominant_frequency")
    named = np.concatenate([[_RESONANCE in str(t) for t in s["instrument"].values] for s in slips])
    # if each run has one speed, only all of them show that a frequency does not depend on speed
    rings = named.astype(bool) | ringing(kind, own, speed)
    kind[rings] = STEADY_SLIDING
    known = (kind != NOT_LOOKED_AT) & (speed > 0)
    order = np.flatnonzero(known)[np.argsort(speed[known], kind="stable")]
    edges = np.flatnonzero(np.diff(np.log(speed[order])) > np.log1p(speed_tolerance)) + 1
    groups = [group for group in np.split(order, edges) if group.size]
    regular = np.concatenate([_regularity(s) for s in slips]).astype(object)
    repeats = np.array([_repeats(str(t)) for s in slips for t in s["instrument"].values], object)
    columns = {name: _column(slips, name) for name in _NUMBERS}
    rows = [_row(group, kind, regular, repeats, columns) for group in groups]
    names = list(rows[0]) if rows else [*_EMPTY]
    data = {n: ("sliding_speed", np.array([row[n] for row in rows])) for n in names}
    for name in ("waveform", "regularity", "rig_wave"):
        texts = np.array([row[name] for row in rows], dtype=object)
        data[name] = "sliding_speed", texts
    middle = np.array([np.exp(np.mean(np.log(speed[g]))) for g in groups])
    result = stamp(xr.Dataset(data, {"sliding_speed": middle}))
    scaling = frequency_scaling(result)
    result.attrs.update(
        scaling_exponent=scaling.exponent, scaling_error=scaling.error, scaling=scaling.text
    )
    if rings.any():
        result.attrs["resonance_frequency_Hz"] = float(median_of_known(own[rings]))
    return result


_SCALING = {
    "scaling_exponent": "scaling_exponent",
    "scaling_error": "scaling_error",
    "scaling": "scaling",
    "resonance_frequency_Hz": "resonance_frequency",
}  # what is an attribute of one curve is a variable of several


def _join_curves(
    slips: Sequence[xr.Dataset], speed_tolerance: float, labels: Mapping[str, Sequence[Label]]
) -> xr.Dataset:
    """Return the curves of all combinations of labels as one dataset."""
    groups = grouped(slips, labels, "stick_slip_curve")
    curves = [(stick_slip_curve(group, speed_tolerance), key) for group, key in groups]
    joined = joined_curves(curves)
    dims = tuple(labels)
    shape = tuple(joined.sizes[dim] for dim in dims)
    scaling = xr.Dataset()
    for attribute, name in _SCALING.items():
        values = np.full(shape, "" if name == "scaling" else np.nan, object)
        for curve, key in curves:
            at = tuple(joined.indexes[dim].get_loc(key[dim]) for dim in dims)
            values[at] = curve.attrs.get(attribute, values[at])
        scaling[name] = dims, values if name == "scaling" else values.astype(float)
    return joined.assign(stamp(scaling).data_vars)


def one_curve(curve: xr.Dataset) -> xr.Dataset:
    """Return one of several curves in the form of `stick_slip_curve` without labels.

    Parameters
    ----------
    curve
        One of the curves of several systems, with dim ``sliding_speed`` only.
    """
    if "scaling" not in curve:
        return curve
    values = {key: curve[name].item() for key, name in _SCALING.items()}
    known = {key: value for key, value in values.items() if value == value or "scaling" in key}
    alone = curve.drop_vars(_SCALING.values()).assign_attrs(known)
    return alone.sel(sliding_speed=alone["segments"].notnull().values)


_EMPTY = (
    *("segments", "segments_oscillating", "waveform", "regularity"),
    *("oscillation_swing", "rig_swing", "rig_wave"),
)


def _column(slips: Sequence[xr.Dataset], name: str) -> np.ndarray:
    return np.concatenate(
        [
            s[name if name in s else f"force_{name}"].values
            if name in s or f"force_{name}" in s
            else np.full(s.sizes["segment"], np.nan)
            for s in slips
        ]
    )


def _regularity(slip: xr.Dataset) -> np.ndarray:
    return slip["regularity"].values if "regularity" in slip else np.full(slip.sizes["segment"], "")


def _repeats(instrument: str) -> str:
    """Return what the ``instrument`` text says on waves that repeat with each turn of the rig."""
    return next((part for part in instrument.split("; ") if REPEATS in part), "")


def _row(
    group: np.ndarray,
    kind: np.ndarray,
    regular: np.ndarray,
    repeats: np.ndarray,
    columns: dict[str, np.ndarray],
) -> dict[str, float | str]:
    moving = group[oscillating(kind[group])]
    waveform, regularity, count = STEADY_SLIDING, "", moving.size
    decided = int((kind[group] != NOT_CLEAR).sum())
    if moving.size > 0.5 * decided:
        waveform, regularity = _most_common(kind[moving]), _most_common(regular[moving])
    else:  # too few segments oscillate to represent the contact
        moving = moving[:0]
        waveform = STEADY_SLIDING if decided >= 0.5 * group.size else NOT_CLEAR
    row = {
        "segments": group.size,
        "segments_oscillating": count,
        "waveform": waveform,
        "regularity": regularity,
        "rig_wave": _most_common(repeats[group][repeats[group] != ""]),
    }
    for name in _MEANS:
        values = columns[name][moving]
        values = values[np.isfinite(values)]
        row[name] = values.mean() if values.size else np.nan
        row[f"{name}_std"] = values.std(ddof=1) if values.size > 1 else np.nan
    for name in ("oscillation_swing", "rig_swing"):
        swing = columns[name][group]
        row[name] = np.nanmean(swing) if np.isfinite(swing).any() else np.nan
    return row


def _most_common(words: np.ndarray) -> str:
    """Return the most frequent word; the first one of equally frequent words."""
    known = words.astype(str).tolist()
    return max(dict.fromkeys(known), key=known.count, default="")


def frequency_scaling(curve: xr.Dataset) -> Scaling:
    """Fit f ~ v^n to the frequencies of the oscillation at several speeds.

    Parameters
    ----------
    curve
        From `stick_slip_curve`.

    Notes
    -----
    Least squares of ln f against ln v, each speed weighted by its number of segments. The error is
    from the scatter about the line, scaled by Student's t to one standard deviation. The wavelength
    is fixed if 1 is within two errors of n and 0 is not; the frequency is fixed in the opposite
    case; neither is fixed if neither is within two errors.
    """
    nothing = Scaling(np.nan, np.nan, 0, "not known: nothing oscillates at three speeds or more")
    if "dominant_frequency" not in curve:
        return nothing
    f, v = curve["dominant_frequency"].values, curve["sliding_speed"].values
    good = np.isfinite(f) & (oscillating(curve["waveform"].values))
    count = int(good.sum())
    if count < limits.MIN_SPEEDS_OF_EXPONENT.value:
        return nothing._replace(speeds=count)
    x, y = np.log(v[good]), np.log(f[good])
    weight = curve["segments_oscillating"].values[good].astype(float)
    weight /= weight.sum()
    x0 = float(weight @ x)
    spread = float(weight @ (x - x0) ** 2)
    slope = float(weight @ ((x - x0) * y)) / spread
    rest = y - weight @ y - slope * (x - x0)
    variance = max(
        float(weight @ rest**2) * count / (count - 2), limits.MIN_ERROR_OF_FREQUENCY.value**2
    )
    student = special.stdtrit(count - 2, 0.8413)
    error = float(np.sqrt(variance / count / spread)) * float(student)
    fixed_wavelength, fixed_frequency = abs(slope - 1) < 2 * error, abs(slope) < 2 * error
    if fixed_wavelength and fixed_frequency:
        text = "not decided between a fixed wavelength and a fixed frequency"
    elif fixed_wavelength:
        text = "frequency goes with the speed: the wavelength is fixed"
    elif fixed_frequency:
        text = FIXED_FREQUENCY
    elif slope > 1:
        text = "frequency grows faster than the speed: the wavelength shrinks"
    else:
        text = "frequency grows more slowly than the speed: the wavelength grows"
    return Scaling(slope, error, count, text)
