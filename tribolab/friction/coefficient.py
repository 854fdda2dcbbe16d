"""Friction coefficient of each segment, with offsets removed and honest errors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from tribolab.errors import AnalysisError, nearest
from tribolab.friction.offsets import Zero, pair_strokes, unloaded_rest, wander
from tribolab.friction.statistics import NOTHING, Estimate, describe
from tribolab.friction.steadiness import judged
from tribolab.quantities import stamp

OFFSETS = ("auto", "half loop", "zero load", "none")
NO_CONTACT = 0.02  # share of the run's load below which there is no contact
LOST = 0.05  # share of samples without contact that spoils a segment


def friction_coefficient(
    run: xr.Dataset,
    segments: xr.Dataset,
    offset: str = "auto",
    *,
    pair_tolerance: float = 0.25,
) -> xr.Dataset:
    """Friction coefficient of each segment: the mean of the pointwise ratio F_x / F_N.

    Parameters
    ----------
    run
        The run, with ``friction_force`` and ``normal_force``, or ``friction_coefficient``, or
        ``friction_force`` alone (then only forces come out).
    segments
        From `find_segments` on the same run.
    offset
        ``"half loop"``: half the sum of the mean friction forces of two neighbouring strokes of
        one speed and opposite direction is removed from both. ``"zero load"``: the reading of a
        rest without load. ``"none"``. ``"auto"``: half loop where strokes pair, else zero load
        where the run has such a rest, else none. The zero of the normal force is always taken
        from rests without load if there are any, except with ``"none"``.
    pair_tolerance
        Largest relative difference of speed between the two strokes of a pair.

    Returns
    -------
    xarray.Dataset
        The variables of `segments` and, on dim ``segment``: ``friction_coefficient`` (signed by
        direction, so that ordinary friction is positive), ``_std`` (sample standard deviation of
        the pointwise ratio, the error bar of [1]_), ``_sem``, ``effective_samples``,
        ``autocorrelation_time`` [s], ``trend`` [1/s], ``trend_change``, ``trend_p_value``,
        ``steady`` (1; 0 not steady, 2 undecided); ``friction_force``, ``normal_force`` [N] (+
        ``_std``, ``_sem``),
        ``friction_force_offset``, ``normal_force_offset`` [N], ``pair``, ``half_loop`` [N] and
        ``remark`` (text: why a value is missing or special). Attribute ``offset``.

    Raises
    ------
    AnalysisError
        If the run has no friction, the segments are another run's, or the offset asked for cannot
        be had.

    Notes
    -----
    With F_f = mu N_f + F_0 and F_b = -mu N_b + F_0 the mean forces of a pair and N_f, N_b its mean
    normal forces, F_0 = (F_f N_b + F_b N_f)/(N_f + N_b) is removed (the half sum where the load is
    the same or unknown), and mu = (F_f - F_b)/(N_f + N_b). Both strokes then have the same
    coefficient, and they are one observation, not two. Each keeps the standard deviation and the
    trend of its own stroke. Both errors are
    sqrt(max((sem_f^2 + sem_b^2)/4, s^2/2) + D dt/4)/F_N, because each value rests on both strokes:
    sem_f and sem_b are the errors of the ratio times F_N; s^2 and D say how the zero moves from
    pair to pair beyond those errors (they need at least two pairs); dt is the time between the
    strokes.
    With another offset the error is sqrt(sem^2 + (sem(F_0)/F_N)^2). The zero of
    the normal force adds mu sem(F_N0)/F_N.

    References
    ----------
    .. [1] Xu et al. (2026), Appendix C.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.friction.segments import find_segments
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
    if offset not in OFFSETS:
        raise AnalysisError(f"offset: '{offset}' is not known{nearest(offset, OFFSETS)}")
    belong(run, segments)
    pair = pair_strokes(segments, pair_tolerance)
    if "friction_force" in run:
        result = _from_forces(run, segments, offset, pair)
    elif "friction_coefficient" in run:
        result = _from_ratio(run, segments, offset, pair)
    else:
        raise AnalysisError(
            f"{_name(run)}: the run has neither 'friction_force' nor 'friction_coefficient'"
        )
    kept = segments.drop_dims("omitted") if "omitted" in segments.dims else segments
    attrs = {**segments.attrs, **result.attrs}
    return stamp(judged(kept.merge(result, combine_attrs="drop")), **attrs)


def _name(run: xr.Dataset) -> str:
    return str(run.attrs.get("source", "run"))


def belong(run: xr.Dataset, segments: xr.Dataset) -> None:
    """Refuse segments of another run."""
    mine, theirs = (d.attrs.get("source_sha256") for d in (run, segments))
    outside = False
    if segments.sizes["segment"]:
        if not run.sizes.get("time"):
            raise AnalysisError(f"{_name(run)}: the run has no samples")
        time = run["time"].values
        slack = 1e-6 * (time[-1] - time[0])
        outside = bool(
            (segments["start"].values < time[0] - slack).any()
            or (segments["stop"].values > time[-1] + slack).any()
        )
    if outside or (mine and theirs and mine != theirs):
        raise AnalysisError(
            f"{_name(run)}: the segments lie outside this run or come from another file;"
            " find them in the same run with find_segments(run)"
        )


def trimmed_slices(run: xr.Dataset, segments: xr.Dataset) -> list[slice]:
    """Find the samples of each trimmed segment."""
    time = run["time"].values
    first = np.searchsorted(time, segments["trimmed_start"].values, side="left")
    last = np.searchsorted(time, segments["trimmed_stop"].values, side="right")
    return [slice(a, max(a, b)) for a, b in zip(first, last, strict=True)]


def _middles(segments: xr.Dataset) -> np.ndarray:
    return (segments["trimmed_start"].values + segments["trimmed_stop"].values) / 2


def _signs(segments: xr.Dataset, means: np.ndarray) -> np.ndarray:
    """Direction of each segment; where it is unknown, the sign of its friction."""
    direction = segments["direction"].values.astype(float)
    return np.where(direction != 0, direction, np.where(means < 0, -1.0, 1.0))


def _column(found: list[Estimate], name: str) -> np.ndarray:
    return np.array([getattr(one, name) for one in found], dtype=float)


def _halves(
    values: np.ndarray, sign: np.ndarray, pair: np.ndarray, combine: Callable
) -> np.ndarray:
    """Combine the values of each pair's forward and backward stroke; NaN without a pair."""
    result = np.full(values.size, np.nan)
    for number in range(pair.max(initial=-1) + 1):
        both = np.flatnonzero(pair == number)
        forward, backward = both[np.argsort(-sign[both])]
        result[[forward, backward]] = combine(values[forward], values[backward])
    return result


def _removed(
    means: np.ndarray,
    errors: np.ndarray,
    load: np.ndarray,
    sign: np.ndarray,
    pair: np.ndarray,
    zero: Zero | None,
    offset: str,
    name: str,
    time: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, str]:
    """Offset of each segment, error of its mean without it, half loop, method.

    `load` is the mean normal force of each segment, or one for all where it is not known; `time`
    is the middle of each segment [s].
    """
    half = _halves(means, sign, pair, lambda f, b: (f - b) / 2)
    half_error = _halves(errors, sign, pair, lambda f, b: np.hypot(f, b) / 2)
    # F_f = mu N_f + F_0 and F_b = -mu N_b + F_0: what the load did between the strokes must not
    # pass for an offset
    share = _halves(load, sign, pair, lambda f, b: np.array([b, f]) / (f + b))
    middle = _halves(means * share, sign, pair, lambda f, b: f + b)
    paired = np.isfinite(middle)
    if offset == "half loop" and not paired.any():
        raise AnalysisError(
            f"{name}: offset 'half loop' needs two neighbouring strokes of one speed and opposite"
            " direction, and there are none; use offset='auto', or widen pair_tolerance"
        )
    if offset == "zero load" and zero is None:
        raise AnalysisError(
            f"{name}: offset 'zero load' needs a rest without load, and there is none (or no"
            " velocity or normal force that would show it); use offset='auto'"
        )
    if offset == "none":
        return np.zeros(means.size), errors, half, "none: not wanted"
    if offset == "zero load" or (offset == "auto" and not paired.any() and zero is not None):
        return np.full(means.size, zero.value), np.hypot(errors, zero.error), half, "zero load"
    if not paired.any():
        why = "none: no pair of strokes, no rest without load"
        return np.zeros(means.size), errors, half, why
    when = _halves(time, sign, pair, lambda f, b: (f + b) / 2)
    apart = _halves(time, sign, pair, lambda f, b: np.abs(f - b))
    one = np.unique(pair[paired], return_index=True)[1]
    zero_moves = wander(middle[paired][one], half_error[paired][one], when[paired][one])
    # a stroke without a partner: the zero without load, else what the pairs say on average
    if zero is None:
        spread = np.std(middle[paired]) if one.size > 1 else 0.0
        zero = Zero(
            float(middle[paired].mean()), float(np.hypot(spread, half_error[paired].mean()))
        )
    removed = np.where(paired, middle, zero.value)
    # a stroke that lasts longer than the zero's fast movements shows them in its own error
    by_pair = np.maximum(half_error**2, zero_moves.fast / 2) + zero_moves.rate * apart / 4
    by_pair = np.sqrt(by_pair)
    return removed, np.where(paired, by_pair, np.hypot(errors, zero.error)), half, "half loop"


def _from_forces(
    run: xr.Dataset, segments: xr.Dataset, offset: str, pair: np.ndarray
) -> xr.Dataset:
    time, force = run["time"].values, run["friction_force"].values
    parts = trimmed_slices(run, segments)
    forces = [describe(time[s], force[s]) for s in parts]
    means = _column(forces, "mean")
    sign = _signs(segments, means)
    loads, load = [], np.nan
    if "normal_force" in run:
        normal = run["normal_force"].values
        loads = [describe(time[s], normal[s]) for s in parts]
        pressed = _column(loads, "mean")
        load = float(np.median(pressed[pressed > 0])) if (pressed > 0).any() else np.nan
    zero, normal_zero = unloaded_rest(run, segments, load)
    if offset == "none":
        normal_zero = None
    n0 = normal_zero or Zero(0.0, 0.0)
    pressed = np.ones(means.size)
    if loads:
        pressed = _column(loads, "mean") - n0.value
    held = np.where(pressed > 0, pressed, 1.0)
    own_errors = _column(forces, "sem")
    arguments = sign, pair, zero, offset, _name(run), _middles(segments)
    removed, errors, half, method = _removed(means, own_errors, held, *arguments)
    data = {
        "friction_force": sign * (means - removed),
        "friction_force_std": _column(forces, "std"),
        "friction_force_sem": errors,
        "friction_force_offset": removed,
        "half_loop": half,
        "pair": pair,
    }
    if not loads:
        empty = [one.samples == 0 for one in forces]
        remarks = np.where(empty, "no samples that are numbers", "").astype(object)
        data |= _memory(forces) | {"force_trend": sign * _column(forces, "trend")}
        return _table(data, remarks, method)

    ratios, remarks = [], []
    for s, d, f0, one in zip(parts, sign, removed, loads, strict=True):
        ratio, remark = _ratio(time[s], d * (force[s] - f0), normal[s] - n0.value, one, n0, load)
        ratios.append(ratio)
        remarks.append(remark)
    mu, scatter = _column(ratios, "mean"), _column(ratios, "sem")
    # the load's fluctuations move friction and load together and leave the ratio alone: its own
    # scatter, not the force's, says how well friction is known
    known = np.isfinite(scatter)
    own_errors = np.where(known, scatter * held, own_errors)
    _, errors_by_ratio, _, _ = _removed(means, own_errors, held, *arguments)
    with np.errstate(divide="ignore", invalid="ignore"):
        sem = np.where(known, errors_by_ratio / pressed, np.nan)
        sem = np.hypot(sem, mu * n0.error / pressed)
    data |= {
        "friction_coefficient": mu,
        "friction_coefficient_std": _column(ratios, "std"),
        "friction_coefficient_sem": sem,
        "normal_force": pressed,
        "normal_force_std": _column(loads, "std"),
        "normal_force_sem": np.hypot(_column(loads, "sem"), n0.error),
        "normal_force_offset": np.full(mu.size, n0.value),
        **_memory(ratios),
        "trend": _column(ratios, "trend"),
        "trend_change": _column(ratios, "trend_change"),
    }
    return _table(data, np.array(remarks, dtype=object), method)


def _ratio(
    time: np.ndarray,
    force: np.ndarray,
    normal: np.ndarray,
    load: Estimate,
    zero: Zero,
    usual: float,
) -> tuple[Estimate, str]:
    """Pointwise ratio of one segment, or why there is none."""
    known = np.isfinite(normal)
    if load.samples == 0 or normal.size == 0:
        return NOTHING, "normal force is not a number" if normal.size else "no samples"
    if not load.mean - zero.value > max(NO_CONTACT * usual, 0.0):
        return NOTHING, f"no contact: mean normal force {load.mean - zero.value:.3g} N"
    pressed = known & (normal > 0)
    lost = 1 - np.count_nonzero(pressed) / normal.size
    if lost > LOST:
        return NOTHING, f"no contact or no normal force in {lost:.0%} of the samples"
    found = describe(time[pressed], force[pressed] / normal[pressed])
    if found.samples == 0:
        return found, "friction force is not a number"
    left = normal.size - int(np.count_nonzero(pressed))
    return found, f"{left} samples without contact left out" if left else ""


def _from_ratio(run: xr.Dataset, segments: xr.Dataset, offset: str, pair: np.ndarray) -> xr.Dataset:
    """Segments of a run whose instrument records only the coefficient."""
    time, ratio = run["time"].values, run["friction_coefficient"].values
    found = [describe(time[s], ratio[s]) for s in trimmed_slices(run, segments)]
    means = _column(found, "mean")
    sign = _signs(segments, means)
    rectified = bool((means[np.isfinite(means)] >= 0).all())
    if rectified:  # a coefficient that never changes sign carries no direction
        sign, pair = np.ones_like(sign), np.full_like(pair, -1)
        if offset == "auto":
            offset = "none"
    alike = np.ones(means.size)
    arguments = sign, pair, None, offset, _name(run), _middles(segments)
    removed, errors, _, method = _removed(means, _column(found, "sem"), alike, *arguments)
    if rectified and offset == "none":
        method = "none: the instrument gives the coefficient without sign"
    data = {
        "friction_coefficient": sign * (means - removed),
        "friction_coefficient_std": _column(found, "std"),
        "friction_coefficient_sem": errors,
        "friction_coefficient_offset": removed,
        "pair": pair,
        **_memory(found),
        "trend": sign * _column(found, "trend"),
        "trend_change": sign * _column(found, "trend_change"),
    }
    remarks = np.where(_column(found, "samples") == 0, "no samples that are numbers", "")
    return _table(data, remarks.astype(object), method)


def _memory(found: list[Estimate]) -> dict[str, np.ndarray]:
    names = ("effective_samples", "autocorrelation_time", "trend_p_value")
    return {name: _column(found, name) for name in names}


def _table(data: dict[str, np.ndarray], remarks: np.ndarray, method: str) -> xr.Dataset:
    table = xr.Dataset({name: ("segment", values) for name, values in data.items()})
    table["remark"] = "segment", remarks
    return table.assign_attrs(offset=method)
