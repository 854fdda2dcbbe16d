"""Friction coefficient of each segment, with the zero removed and with its uncertainty."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs, over_dims
from tribolab.arrays.chunks import one_by_one
from tribolab.arrays.medians import median
from tribolab.core.attributes import RunAttributes
from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError, Cure, nearest, shown
from tribolab.core.untyped import Json
from tribolab.friction.coefficient.reversal import reversal_of
from tribolab.friction.coefficient.steadiness import judged
from tribolab.friction.decisions.rejected import compute_both
from tribolab.friction.mean_error.freedom import with_freedom
from tribolab.friction.run_out import turn_remark, turned
from tribolab.friction.segments.limits import MAX_LOST_CONTACT
from tribolab.friction.segments.stretches import name_of
from tribolab.friction.statistics import Estimate, estimates_of, undetermined_remark, wander_remark
from tribolab.friction.zero import limits
from tribolab.friction.zero.load_reading import WIDTH_OVER_SIGMA, load_reading
from tribolab.friction.zero.of_run import Settings, zero_of_run
from tribolab.friction.zero.parts import ZeroReference
from tribolab.friction.zero.rests import light_rest, unloaded_rests
from tribolab.friction.zero.without_sliding import of_loaded_and_idle, without_sliding
from tribolab.friction.zero.words import of_light_rest, of_partial_contact
from tribolab.units.stamping import stamp

_OFFSETS = ("auto", "half loop", "zero load", "none")


@of_runs
@over_dims(segments=("segment", "omitted"))
def friction_coefficient(
    run: xr.Dataset,
    segments: xr.Dataset,
    offset: str = "auto",
    *,
    pair_tolerance: float = 0.25,
    zero_uncertainty: str | float | None = None,
    rectified: bool | None = None,
    other_zeros: Sequence[float] = (),
) -> xr.Dataset:
    """Return the friction coefficient of each segment: mean of the pointwise ratio F_x / F_N.

    Parameters
    ----------
    run
        The run, with ``friction_force`` and ``normal_force``, or ``friction_coefficient``, or
        ``friction_force`` alone (which gives forces only).
    segments
        From `find_segments` on the same run, or from `decide`: rejected segments do not affect the
        others, and have the values they would have if accepted. A further dim (of several trims)
        becomes a dim of the result.
    offset
        ``"half loop"``: the middle of the loop of two neighbouring strokes of opposite direction,
        corrected for drift between loops. ``"zero load"``: the reading of unloaded rests,
        interpolated in time. ``"none"``. ``"auto"``: half loop if strokes pair, unless unloaded
        rests contradict it; else zero load if the run has an unloaded rest; else the zero that is
        stated or known from other runs; else none. The zero of the normal force is always
        taken from rests without load if there are any, except with ``"none"``.
    pair_tolerance
        Largest relative difference of speed between the two strokes of a pair. If the zero cannot
        be found otherwise, strokes whose speeds differ by up to their mean pair as well, and the
        zero is reported as doubtful.
    zero_uncertainty
        Standard uncertainty of the friction signal's zero, if no stroke or rest determines it
        ("0.2 N", or a number in SI); else the attribute ``friction_force_zero_uncertainty_N``.
    rectified
        Whether the friction signal was recorded without its sign; else the run's attribute
        ``friction_force_rectified``; else it is found from the signal at the reversals.
    other_zeros
        Zeros of other runs on the same instrument, in the unit of the friction signal.

    Returns
    -------
    xarray.Dataset
        The variables of `segments` and, on dim ``segment``: ``friction_coefficient`` (signed by
        direction, so that ordinary friction is positive), ``_std`` (sample standard deviation of
        the pointwise ratio, the error bar of [1]_), ``_sem``, ``_dof`` and ``_U95`` (95 % coverage,
        t_0.975(dof) sem) of this mean over the path, ``friction_coefficient_beyond_sem``, ``_dof``
        and ``_U95`` of the same number as an estimate for the surface beyond the path (a trend
        along the path may continue), ``friction_coefficient_shared_sem`` (the part of these errors
        that all segments share: zero and reading of the load, tilt, drag),
        ``friction_coefficient_level`` (without the unfinished period of an oscillation),
        ``effective_samples``, ``autocorrelation_time`` [s], ``trend`` [1/s], ``trend_change``,
        ``trend_p_value``, ``steady`` (1; 0 not steady, 2 undecided); ``friction_force``,
        ``normal_force`` [N] (+ ``_std``, ``_sem``), ``friction_force_offset``,
        ``normal_force_offset`` [N], ``pair``, ``half_loop`` [N], ``tilt_found`` [rad] (from both
        directions; without an unloaded rest, the tilt that would explain the zero), ``zero_from``
        (text: the source of the zero) and ``remark`` (text: why a value is missing or special).
        Attributes ``offset``, ``middle_of_loop`` (interpretation of the middle of the loops) and
        ``zero_doubts`` (doubts about the zero).

    Raises
    ------
    AnalysisError
        If the run has no friction, the segments are another run's, or the requested offset cannot
        be determined.

    Notes
    -----
    With F_f = mu N_f + Z(t_f) and F_b = -mu N_b + Z(t_b) the mean forces of a pair and N_f, N_b its
    mean normal forces, (F_f N_b + F_b N_f)/(N_f + N_b) is the zero Z between the strokes (the half
    sum if the load is the same or unknown), corrected for its drift from loop to loop
    (`tribolab.friction.zero.middles`). A tilted force cell shifts the middle like a zero, but in
    proportion to the load: unloaded rests, or the uncertainties of both in the run's attribute
    ``uncertainty``, separate the two, and mu = tan((atan f + atan b)/2) of the ratios f and b of
    both directions is free of both [2]_ (`reversal_of`). Both strokes then have the same
    coefficient, and they are one observation, not two. Each keeps the standard deviation and the
    trend of its own stroke. Their error includes the errors of all strokes used, the scatter of the
    zero from loop to loop beyond those and a common drift, and, for strokes of unequal speed, the
    change of friction between the speeds (`tribolab.friction.zero.unequal`). With another zero the
    error is sqrt(sem^2 + (sem(Z)/F_N)^2). The zero of the normal force adds mu sem(F_N0)/F_N. A
    signal without sign has the direction of sliding put back as its sign.

    References
    ----------
    .. [1] Xu et al. (2026), Appendix C.
    .. [2] Burris and Sawyer (2009), Tribol. Lett. 35, 17-23. doi:10.1007/s11249-009-9438-2

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.friction.segments.find import find_segments
    >>> v = np.repeat([0.0, 1e-3, 0.0, -1e-3, 0.0], 100)
    >>> run = xr.Dataset(
    ...     {
    ...         "sliding_velocity": ("time", v),
    ...         "friction_force": ("time", 9.0 * np.sign(v) + 1.0),
    ...         "normal_force": ("time", np.full(500, 30.0)),
    ...     },
    ...     {"time": np.arange(500) / 10},
    ... )
    >>> found = friction_coefficient(run, find_segments(run))
    >>> found.friction_coefficient.values.round(6).tolist(), found.attrs["offset"]
    ([0.3, 0.3], 'half loop')
    """
    if offset not in _OFFSETS:
        raise AnalysisError(f"offset: '{shown(offset)}' is not known{nearest(offset, _OFFSETS)}")
    belong(run, segments)
    settings = Settings(offset, pair_tolerance, zero_uncertainty, rectified, other_zeros)
    return stamp(compute_both(segments, lambda part: _segment_friction(run, part, settings)))


def friction_signal(run: xr.Dataset) -> str:
    """Return the name of the friction signal: a force, or a recorded coefficient; or "".

    A recorded coefficient is preferred to a force under an unknown load.

    >>> friction_signal(xr.Dataset({"friction_force": 1.0, "friction_coefficient": 0.3}))
    'friction_coefficient'
    """
    if "friction_coefficient" in run and not {"friction_force", "normal_force"} <= {*run}:
        return "friction_coefficient"
    return "friction_force" if "friction_force" in run else ""


def _segment_friction(run: xr.Dataset, segments: xr.Dataset, settings: Settings) -> xr.Dataset:
    signal = friction_signal(run)
    if signal == "friction_force":
        result = _force_friction(run, segments, settings)
    elif signal == "friction_coefficient":
        result = _ratio_friction(run, segments, settings)
    else:
        raise AnalysisError(
            f"{name_of(run)}: no friction force or coefficient was read: its column is missing or "
            "empty"
        )
    bare = segments.drop_dims("omitted") if "omitted" in segments.dims else segments
    bare = bare.drop_vars([name for name in result.data_vars if name in bare])
    both = bare.merge(result, combine_attrs="drop")
    return judged(both).assign_attrs({**segments.attrs, **result.attrs})


def belong(run: xr.Dataset, segments: xr.Dataset) -> None:
    """Raise an error if `segments` is not a result of `find_segments` on this run."""
    if "segment" not in getattr(segments, "sizes", ()):
        raise AnalysisError(
            f"a {type(segments).__name__} without segments was given as segments",
            where=name_of(run),
            cure=Cure(notebook="give what tl.find_segments(run) returns"),
        )
    mine, theirs = (d.attrs.get("source_sha256") for d in (run, segments))
    outside = False
    if segments.sizes["segment"]:
        if not run.sizes.get("time"):
            raise AnalysisError(f"{name_of(run)}: the run has no samples")
        time = run["time"].values
        slack = 1e-6 * (time[-1] - time[0])
        outside = bool(
            (segments["start"].values < time[0] - slack).any()
            or (segments["stop"].values > time[-1] + slack).any()
        )
    if outside or (mine and theirs and mine != theirs):
        raise AnalysisError(
            "the segments lie outside this run or come from another file",
            where=name_of(run),
            cure=Cure(notebook="find them in the same run with find_segments(run)"),
        )


def trimmed_slices(run: xr.Dataset, segments: xr.Dataset) -> list[slice]:
    """Return the index ranges of the samples of each trimmed segment."""
    time = run["time"].values
    first = np.searchsorted(time, segments["trimmed_start"].values, side="left")
    last = np.searchsorted(time, segments["trimmed_stop"].values, side="right")
    return [slice(a, max(a, b)) for a, b in zip(first, last, strict=True)]


def _middles(time: np.ndarray, parts: list[slice], segments: xr.Dataset) -> np.ndarray:
    """Return the mean time of each segment's samples: a drifting signal equals its mean there."""
    ends = (segments["trimmed_start"].values + segments["trimmed_stop"].values) / 2
    means = [
        time[s].mean() if s.stop > s.start else end
        for s, end in one_by_one(zip(parts, ends, strict=True))
    ]
    return np.array(means, dtype=float)


def _column(estimates: list[Estimate], name: str) -> np.ndarray:
    return np.array([getattr(estimate, name) for estimate in estimates], dtype=float)


def _force_friction(run: xr.Dataset, segments: xr.Dataset, settings: Settings) -> xr.Dataset:
    time, force = run["time"].values, run["friction_force"].values
    parts = trimmed_slices(run, segments)
    turns = _Turning.of(run, segments)
    forces = estimates_of((time[s], force[s], *turns.angle(s)) for s in one_by_one(parts))
    means = _column(forces, "mean")
    loads: list[Estimate] = []
    load = np.nan
    if "normal_force" in run:
        normal = run["normal_force"].values
        loads = estimates_of((time[s], normal[s]) for s in one_by_one(parts))
        pressed = _column(loads, "mean")
        load = float(median(pressed[pressed > 0])) if (pressed > 0).any() else np.nan
    rests, normal_rests, partial = unloaded_rests(run, segments, load)
    n0, n0_error = np.zeros(means.size), np.zeros(means.size)
    middle = _middles(time, parts, segments)
    if normal_rests is not None and settings.offset != "none":
        n0, n0_error = normal_rests.at(middle)
    pressed = _column(loads, "mean") - n0 if loads else np.ones(means.size)
    divisor = np.where(pressed > 0, pressed, 1.0)
    own_errors = _column(forces, "sem")
    zero, signs, pair = zero_of_run(
        run, segments, "friction_force", parts, means, own_errors, divisor, middle, rests, settings
    )
    if normal_rests is None and (light := light_rest(run, segments, load, pressed)):
        zero = replace(zero, doubts=(*zero.doubts, of_light_rest(light, load, means.size)))
    shared = np.zeros(means.size)  # errors of the load that are common to all segments
    if loads and "normal_force" in run:
        reading = load_reading(run, segments, parts, pressed, n0, means, zero)
        shared = reading.error
        zero = replace(zero, doubts=(*zero.doubts, *reading.doubts))
    if partial is not None and settings.offset != "none":
        shared = np.hypot(shared, partial.level / WIDTH_OVER_SIGMA)  # either zero
        if partial.level > limits.DOUBTFUL_REST.value * load:
            doubted = of_partial_contact(partial, load, means.size)
            zero = replace(zero, doubts=(*zero.doubts, doubted))
    others = without_sliding(run, segments, rests, load)
    idle = of_loaded_and_idle(others, zero, means, load)
    zero = replace(zero, doubts=(*zero.doubts, *idle.doubts))
    turn = signs.sign * signs.unfold
    data = {
        "friction_force": turn * means - signs.sign * zero.value,
        "friction_force_std": _column(forces, "std"),
        "friction_force_sem": np.hypot(zero.error(own_errors), idle.error),
        "friction_force_offset": zero.value,
        "half_loop": zero.half_loop,
        "pair": pair,
    }
    if not loads:
        empty = [force.samples == 0 for force in forces]
        few = np.array([_remark(force) for force in forces], dtype=object)
        reasons = np.where(empty, "no samples that are numbers", few).astype(object)
        trend = turn * _column(forces, "trend") - signs.sign * zero.slope
        data |= _memory(forces) | {"force_trend": trend}
        return _table(data, reasons, zero, run, "")

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
    mu, tilt = both.remove_tilt(_column(ratios, "mean"), signs.sign, divisor)

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
        "friction_coefficient_std": _column(ratios, "std"),
        **_errors(ratios, whole),
        "friction_coefficient_shared_sem": in_common,
        "friction_coefficient_level": mu + _column(ratios, "level") - _column(ratios, "mean"),
        "normal_force": pressed,
        "normal_force_std": _column(loads, "std"),
        "normal_force_sem": np.sqrt(_column(loads, "sem") ** 2 + n0_error**2 + shared**2),
        "normal_force_offset": n0,
        "tilt_found": tilt,
        **_memory(ratios),
        "trend": _column(ratios, "trend"),
        "trend_change": _column(ratios, "trend_change"),
    }
    return _table(data, np.array(remarks, dtype=object), zero, run, both.middle)


def _errors(
    estimates: list[Estimate], whole: Callable[[np.ndarray], np.ndarray]
) -> dict[str, np.ndarray]:
    """Return standard errors, degrees of freedom and U95, over the path and beyond it (segment)."""
    errors: dict[str, np.ndarray] = {}
    for end, name in (("", "friction_coefficient"), ("_beyond", "friction_coefficient_beyond")):
        wide = NORMAL * whole(_column(estimates, f"u95{end}") / NORMAL)
        sem, dof = with_freedom(whole(_column(estimates, f"sem{end}")), wide)
        errors |= {f"{name}_sem": sem, f"{name}_dof": dof, f"{name}_U95": wide}
    return errors


def _remark(estimate: Estimate) -> str:
    """Return the reason why an error is large, as text; else ""."""
    wide = undetermined_remark(estimate) or wander_remark(estimate)
    return "; ".join(filter(None, (turn_remark(estimate.turns), wide)))


class _Turning(NamedTuple):
    """Rotation of a rig that turns in one direction; both fields None without one."""

    time: np.ndarray | None = None
    speed: np.ndarray | None = None

    @classmethod
    def of(cls, run: xr.Dataset, segments: xr.Dataset) -> _Turning:
        # an oscillating arc rubs the same part of the disc: there are no turns to average over
        direction = segments["direction"].values
        if "rotation_speed" not in run or ((direction > 0).any() and (direction < 0).any()):
            return cls()
        return cls(run["time"].values, run["rotation_speed"].values)

    def angle(self, part: slice, at: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
        """Return the angle [rad] of a segment's samples, or at given times; () if unknown."""
        if self.time is None or self.speed is None or part.stop - part.start < 2:
            return ()
        time = self.time[part]
        angle = turned(time, self.speed[part])
        whole = at is None or at.size == time.size
        return (angle if at is None or whole else np.interp(at, time, angle),)


class _RatioRemarks(NamedTuple):
    """Remarks on the ratio of one segment: why it is missing, and number of omitted samples."""

    missing: str = ""
    left: int = 0

    def remark(self, estimate: Estimate) -> str:
        """Return the remarks as text, with those of the mean."""
        if self.missing or estimate.samples == 0:
            return self.missing or "friction force is not a number"
        remarks = [f"{self.left} samples without contact left out"] if self.left else []
        remarks += filter(None, [_remark(estimate)])
        return "; ".join(remarks)


def _ratio(
    time: np.ndarray,
    force: np.ndarray,
    normal: np.ndarray,
    load: Estimate,
    zero: float,
    usual: float,
) -> tuple[np.ndarray, np.ndarray, _RatioRemarks]:
    """Return the times and ratio of one segment, empty without contact; overwrites `force`."""
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


def _ratio_friction(run: xr.Dataset, segments: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Return the friction of a run whose instrument records only the coefficient."""
    time, ratio = run["time"].values, run["friction_coefficient"].values
    parts = trimmed_slices(run, segments)
    turns = _Turning.of(run, segments)
    estimates = estimates_of((time[s], ratio[s], *turns.angle(s)) for s in one_by_one(parts))
    means, own = _column(estimates, "mean"), _column(estimates, "sem")
    alike, middle = np.ones(means.size), _middles(time, parts, segments)
    zero, signs, pair = zero_of_run(
        run, segments, "friction_coefficient", parts, means, own, alike, middle, None, settings
    )
    turn = signs.sign * signs.unfold
    about = turn * means - signs.sign * zero.value
    stated = RunAttributes.from_attrs(run.attrs).uncertainty
    both = reversal_of(zero, pair, alike, middle, about, None, stated)
    read = about + signs.sign * both.tilted
    mu, tilt = both.remove_tilt(read, signs.sign, alike)
    data = {
        "friction_coefficient": mu,
        "tilt_found": tilt,
        "friction_coefficient_std": _column(estimates, "std"),
        **_errors(estimates, zero.error),
        "friction_coefficient_level": mu + _column(estimates, "level") - means,
        "friction_coefficient_offset": zero.value,
        "pair": pair,
        **_memory(estimates),
        "trend": turn * _column(estimates, "trend"),
        "trend_change": turn * _column(estimates, "trend_change"),
    }
    load = next((name for name in ("normal_force", "set_normal_force") if name in run), None)
    if load is not None:  # normal force under which the instrument computed it
        normal = run[load].values
        loads = estimates_of((time[s], normal[s]) for s in one_by_one(parts))
        for end, of in (("", "mean"), ("_std", "std"), ("_sem", "sem")):
            data[f"normal_force{end}"] = _column(loads, of)
    few = np.array([_remark(estimate) for estimate in estimates], dtype=object)
    remarks = np.where(_column(estimates, "samples") == 0, "no samples that are numbers", few)
    return _table(data, remarks.astype(object), zero, run, both.middle)


def _memory(estimates: list[Estimate]) -> dict[str, np.ndarray]:
    names = ("effective_samples", "autocorrelation_time", "trend_p_value")
    return {name: _column(estimates, name) for name in names}


def _table(
    data: dict[str, np.ndarray],
    remarks: np.ndarray,
    zero: ZeroReference,
    run: xr.Dataset,
    middle: str,
) -> xr.Dataset:
    columns = data | {"zero_from": zero.zero_from, "remark": remarks}
    table = xr.Dataset({name: ("segment", values) for name, values in columns.items()})
    attrs: Json = {"offset": zero.method, "zero_doubts": list(zero.doubts)}
    if middle:
        attrs["middle_of_loop"] = middle
    if np.isfinite(zero.stated):
        attrs["zero_stated"] = zero.stated
    if "uncertainty" in run.attrs:
        attrs["uncertainty"] = run.attrs["uncertainty"]
    return table.assign_attrs(attrs)
