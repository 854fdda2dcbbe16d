"""Friction coefficient of segments whose friction force was recorded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import one_by_one
from tribolab.arrays.medians import median
from tribolab.core.attributes import RunAttributes
from tribolab.friction.coefficient.reversal import reversal_of
from tribolab.friction.coefficient.segment_samples import Turning, mean_times, trimmed_slices
from tribolab.friction.coefficient.segment_table import (
    column,
    correlation_columns,
    error_columns,
    remark_on,
    segment_table,
)
from tribolab.friction.mean_error.estimates import Estimate, estimates_of
from tribolab.friction.segments.limits import MAX_LOST_CONTACT
from tribolab.friction.zero import limits
from tribolab.friction.zero.load_reading import WIDTH_OVER_SIGMA, load_reading
from tribolab.friction.zero.of_run import Settings, zero_of_run
from tribolab.friction.zero.rests import light_rest, unloaded_rests
from tribolab.friction.zero.without_sliding import of_loaded_and_idle, without_sliding
from tribolab.friction.zero.words import of_light_rest, of_partial_contact


def force_friction(run: xr.Dataset, segments: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Return each segment's friction coefficient from recorded forces; the force without a load."""
    time, force = run["time"].values, run["friction_force"].values
    parts = trimmed_slices(run, segments)
    turns = Turning.of(run, segments)
    forces = estimates_of((time[s], force[s], *turns.angle(s)) for s in one_by_one(parts))
    means = column(forces, "mean")
    loads: list[Estimate] = []
    load = np.nan
    if "normal_force" in run:
        normal = run["normal_force"].values
        loads = estimates_of((time[s], normal[s]) for s in one_by_one(parts))
        pressed = column(loads, "mean")
        load = float(median(pressed[pressed > 0])) if (pressed > 0).any() else np.nan
    rests, normal_rests, partial = unloaded_rests(run, segments, load)
    n0, n0_error = np.zeros(means.size), np.zeros(means.size)
    middle = mean_times(time, parts, segments)
    if normal_rests is not None and settings.offset != "none":
        n0, n0_error = normal_rests.at(middle)
    pressed = column(loads, "mean") - n0 if loads else np.ones(means.size)
    divisor = np.where(pressed > 0, pressed, 1.0)
    own_errors = column(forces, "sem")
    zero, signs, pair = zero_of_run(
        run, segments, "friction_force", parts, means, own_errors, divisor, middle, rests, settings
    )
    if normal_rests is None and (light := light_rest(run, segments, load, pressed)):
        zero = replace(zero, doubts=(*zero.doubts, of_light_rest(light, load, means.size)))
    shared = np.zeros(means.size)  # error of the load [N], common to all segments
    if loads and "normal_force" in run:
        reading = load_reading(run, segments, parts, pressed, n0, means, zero)
        shared = reading.error
        zero = replace(zero, doubts=(*zero.doubts, *reading.doubts))
    if partial is not None and settings.offset != "none":
        shared = np.hypot(shared, partial.level / WIDTH_OVER_SIGMA)  # either may be the zero
        if partial.level > limits.DOUBTFUL_REST.value * load:
            doubted = of_partial_contact(partial, load, means.size)
            zero = replace(zero, doubts=(*zero.doubts, doubted))
    others = without_sliding(run, segments, rests, load)
    idle = of_loaded_and_idle(others, zero, means, load)
    zero = replace(zero, doubts=(*zero.doubts, *idle.doubts))
    turn = signs.sign * signs.unfold
    data = {
        "friction_force": turn * means - signs.sign * zero.value,
        "friction_force_std": column(forces, "std"),
        "friction_force_sem": np.hypot(zero.error(own_errors), idle.error),
        "friction_force_offset": zero.value,
        "half_loop": zero.half_loop,
        "pair": pair,
    }
    if not loads:
        empty = [force.samples == 0 for force in forces]
        few = np.array([remark_on(force) for force in forces], dtype=object)
        reasons = np.where(empty, "no samples that are numbers", few).astype(object)
        trend = turn * column(forces, "trend") - signs.sign * zero.slope
        data |= correlation_columns(forces) | {"force_trend": trend}
        return segment_table(data, reasons, zero, run, "")

    ratio = (turn * means - signs.sign * zero.value) / divisor
    stated = RunAttributes.from_attrs(run.attrs).uncertainty
    both = reversal_of(zero, pair, divisor, middle, ratio, rests, stated)
    pointwise: list[_RatioRemarks] = []

    def records() -> Iterator[tuple[np.ndarray, ...]]:
        for i, s in enumerate(one_by_one(parts)):
            own = time[s] - middle[i]
            own *= zero.slope[i]
            own += zero.value[i] - both.tilted[i]
            own *= signs.sign[i]
            np.subtract(turn[i] * force[s], own, out=own)
            at, ratio, own_ratio = _ratio(time[s], own, normal[s] - n0[i], loads[i], n0[i], load)
            pointwise.append(own_ratio)
            yield at, ratio, *turns.angle(s, at)

    ratios = estimates_of(records())
    remarks = [own_ratio.remark(ratio) for own_ratio, ratio in zip(pointwise, ratios, strict=True)]
    mu, tilt = both.remove_tilt(column(ratios, "mean"), signs.sign, divisor)

    with np.errstate(divide="ignore", invalid="ignore"):
        in_common = np.hypot(mu * shared, idle.error) / pressed

    def whole(scatter: np.ndarray) -> np.ndarray:
        # fluctuations of the load change friction and load together but not the ratio: the scatter
        # of the ratio, not of the force, determines the error
        known = np.isfinite(scatter)
        errors_by_ratio = zero.error(np.where(known, scatter * divisor, own_errors))
        with np.errstate(divide="ignore", invalid="ignore"):
            error = np.where(known, errors_by_ratio / pressed, np.nan)
            return np.sqrt(error**2 + (mu * n0_error / pressed) ** 2 + in_common**2)

    data |= {
        "friction_coefficient": mu,
        "friction_coefficient_std": column(ratios, "std"),
        **error_columns(ratios, whole),
        "friction_coefficient_shared_sem": in_common,
        "friction_coefficient_level": mu + column(ratios, "level") - column(ratios, "mean"),
        "normal_force": pressed,
        "normal_force_std": column(loads, "std"),
        "normal_force_sem": np.sqrt(column(loads, "sem") ** 2 + n0_error**2 + shared**2),
        "normal_force_offset": n0,
        "tilt_found": tilt,
        **correlation_columns(ratios),
        "trend": column(ratios, "trend"),
        "trend_change": column(ratios, "trend_change"),
    }
    return segment_table(data, np.array(remarks, dtype=object), zero, run, both.middle)


class _RatioRemarks(NamedTuple):
    """Why the friction coefficient of a segment is missing, and number of samples left out."""

    missing: str = ""
    left: int = 0

    def remark(self, estimate: Estimate) -> str:
        """Return the remarks on the friction coefficient and its error as text."""
        if self.missing or estimate.samples == 0:
            return self.missing or "friction force is not a number"
        remarks = [f"{self.left} samples without contact left out"] if self.left else []
        remarks += filter(None, [remark_on(estimate)])
        return "; ".join(remarks)


def _ratio(
    time: np.ndarray,
    force: np.ndarray,
    normal: np.ndarray,
    load: Estimate,
    zero: float,
    usual: float,
) -> tuple[np.ndarray, np.ndarray, _RatioRemarks]:
    """Return times and force ratio of a segment's samples in contact; overwrites `force`."""
    known, nothing = np.isfinite(normal), np.zeros(0)
    if load.samples == 0 or normal.size == 0:
        why = "normal force is not a number" if normal.size else "no samples"
        return nothing, nothing, _RatioRemarks(why)
    noise = limits.UNLOADED_NOISE.value * np.nan_to_num(load.std)
    if not load.mean - zero > max(limits.UNLOADED_SHARE.value * usual, noise, 0.0):
        why = f"no contact: mean normal force {load.mean - zero:.3g} N"
        return nothing, nothing, _RatioRemarks(why)
    pressed = known & (normal > 0)
    left = normal.size - int(np.count_nonzero(pressed))
    lost = 1 - (normal.size - left) / normal.size
    if lost > MAX_LOST_CONTACT.value:
        why = f"no contact or no normal force in {lost:.0%} of the samples"
        return nothing, nothing, _RatioRemarks(why)
    if left:
        time, force, normal = time[pressed], force[pressed], normal[pressed]
    del known, pressed
    return time, np.divide(force, normal, out=force), _RatioRemarks(left=left)
