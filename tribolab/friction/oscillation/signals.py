"""Friction of each segment, positive if it resists motion, for the analysis of stick-slip."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import one_by_one
from tribolab.arrays.medians import median_of_known
from tribolab.core.errors import AnalysisError
from tribolab.friction.coefficient.coefficient import friction_signal
from tribolab.friction.coefficient.segment_samples import trimmed_slices
from tribolab.friction.oscillation import limits
from tribolab.friction.segments.stretches import name_of
from tribolab.friction.zero.rests import unloaded_rests

_SIGN_SAMPLES = 100_000  # most samples of a segment from which its sign is determined


class SegmentSignal(NamedTuple):
    """Friction of one segment, positive if it resists motion, and the signal of its sensor."""

    part: slice
    time: np.ndarray
    values: np.ndarray
    raw: np.ndarray
    load: float


def signals(run: xr.Dataset, segments: xr.Dataset) -> Iterator[SegmentSignal]:
    """Yield the friction of each segment, one at a time to save memory."""
    time, parts = run["time"].values, trimmed_slices(run, segments)
    direction = segments["direction"].values.astype(float)
    signal = friction_signal(run)
    if signal == "friction_force":
        force = run["friction_force"].values
        # with a reversed sign, sticks and slips would be exchanged
        means = [
            d * np.nanmean(force[s][:_SIGN_SAMPLES])
            for s, d in zip(parts, direction, strict=True)
            if np.isfinite(force[s][:_SIGN_SAMPLES]).any()
        ]
        if means and max(means) < 0:
            direction = -direction
        normal = run["normal_force"].values if "normal_force" in run else None
        zero = 0.0
        if normal is not None and "omitted_reason" in segments and len(parts):
            first = np.concatenate([normal[s][:1000] for s in parts])
            if np.isfinite(first).any():
                rests = unloaded_rests(run, segments, float(median_of_known(first))).normal
                zero = float(rests.value.mean()) if rests else 0.0
        for part, sign in one_by_one(zip(parts, direction, strict=True)):
            raw = force[part]
            if normal is None:
                yield SegmentSignal(part, time[part], _signed(raw, sign), raw, np.nan)
                continue
            pressed = normal[part] - zero
            load = float(np.mean(pressed)) if pressed.size else np.nan
            if not load > 0:  # no contact, or a gap
                known = pressed[np.isfinite(pressed) & (pressed > 0)]
                load = float(known.mean()) if known.size > 0.5 * pressed.size else np.nan
            if np.isfinite(load):
                with np.errstate(divide="ignore", invalid="ignore"):
                    ratio = np.divide(_signed(raw, sign), pressed, out=pressed)
                yield SegmentSignal(part, time[part], ratio, raw, load)
            else:
                nothing = np.full(raw.size, np.nan)
                yield SegmentSignal(part, time[part], nothing, raw, load)
    elif signal == "friction_coefficient":
        ratio = run["friction_coefficient"].values
        # a coefficient that never changes sign was recorded without direction
        begins = [ratio[s][:_SIGN_SAMPLES] for s in parts]
        signed = any(np.nanmean(x) < 0 for x in begins if np.isfinite(x).any())
        for part, sign in one_by_one(zip(parts, direction, strict=True)):
            raw = ratio[part]
            values = _signed(raw, sign if signed else 1.0)
            yield SegmentSignal(part, time[part], values, raw, np.nan)
    else:
        raise AnalysisError(
            f"{name_of(run)}: no friction force or coefficient was read: its column is missing or "
            "empty"
        )


def _signed(values: np.ndarray, sign: float) -> np.ndarray:
    if sign == 0:
        sign = -1.0 if np.nanmean(values) < 0 else 1.0
    return -values if sign < 0 else values


def is_clipped(values: np.ndarray) -> bool:
    """Return whether a signal is clipped: it often stays at its largest or smallest value."""
    if values.size < 32 or values.size > 1 << 21:
        return False
    for end in (np.nanmax(values), np.nanmin(values)) if np.isfinite(values).any() else ():
        at = values == end
        three = at[2:] & at[1:-1] & at[:-2]
        if at.all() or int((three[1:] & ~three[:-1]).sum()) >= limits.MIN_CLIPPED_STRETCHES.value:
            return not at.all()
    return False
