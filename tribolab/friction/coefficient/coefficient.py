"""Friction coefficient of each segment, with the zero removed and with its uncertainty."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs, over_dims
from tribolab.arrays.chunks import one_by_one
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import AnalysisError, nearest, shown
from tribolab.friction.coefficient.force_ratio import force_friction
from tribolab.friction.coefficient.reversal import reversal_of
from tribolab.friction.coefficient.segment_samples import (
    Turning,
    belong,
    mean_times,
    trimmed_slices,
)
from tribolab.friction.coefficient.segment_table import (
    column,
    correlation_columns,
    error_columns,
    remark_on,
    segment_table,
)
from tribolab.friction.coefficient.steadiness import judged
from tribolab.friction.decisions.rejected import compute_both
from tribolab.friction.mean_error.estimates import estimates_of
from tribolab.friction.segments.stretches import name_of
from tribolab.friction.zero.of_run import Settings, zero_of_run
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
        others, and have the values they would have if accepted. If they
        have a further dim, e.g. for several trims, so does the result.
    offset
        ``"half loop"``: the middle of the loop of two neighbouring strokes of opposite direction,
        corrected for drift between loops. ``"zero load"``: the reading of unloaded rests,
        interpolated in time. ``"none"``. ``"auto"``: half loop if strokes pair, unless unloaded
        rests contradict it; else zero load if the run has an unloaded rest; else the zero that is
        stated or known from other runs; else none. The zero of the normal force is always
        taken from rests without load if there are any, except with ``"none"``.
    pair_tolerance
        Largest relative difference of speed between the two strokes of a pair. If the zero cannot
        be found otherwise, speeds in a pair may differ by up to their mean, and the zero is
        reported as doubtful.
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
        ``trend_p_value``, ``steady`` (0 no, 1 yes, 2 undecided); ``friction_force``,
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
    error is sqrt(sem^2 + (sem(Z)/F_N)^2). The zero of the normal force adds mu sem(F_N0)/F_N. If
    the signal was recorded without its sign, the direction of sliding gives the sign.

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
    """Return which variable of a run is its friction: force, recorded coefficient, or "" for none.

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
        result = force_friction(run, segments, settings)
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


def _ratio_friction(run: xr.Dataset, segments: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Return the friction of a run whose instrument records only the coefficient."""
    time, ratio = run["time"].values, run["friction_coefficient"].values
    parts = trimmed_slices(run, segments)
    turns = Turning.of(run, segments)
    estimates = estimates_of((time[s], ratio[s], *turns.angle(s)) for s in one_by_one(parts))
    means, own = column(estimates, "mean"), column(estimates, "sem")
    alike, middle = np.ones(means.size), mean_times(time, parts, segments)
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
        "friction_coefficient_std": column(estimates, "std"),
        **error_columns(estimates, zero.error),
        "friction_coefficient_level": mu + column(estimates, "level") - means,
        "friction_coefficient_offset": zero.value,
        "pair": pair,
        **correlation_columns(estimates),
        "trend": turn * column(estimates, "trend"),
        "trend_change": turn * column(estimates, "trend_change"),
    }
    load = next((name for name in ("normal_force", "set_normal_force") if name in run), None)
    if load is not None:  # load at which the instrument computed the coefficient
        normal = run[load].values
        loads = estimates_of((time[s], normal[s]) for s in one_by_one(parts))
        for end, of in (("", "mean"), ("_std", "std"), ("_sem", "sem")):
            data[f"normal_force{end}"] = column(loads, of)
    few = np.array([remark_on(estimate) for estimate in estimates], dtype=object)
    remarks = np.where(column(estimates, "samples") == 0, "no samples that are numbers", few)
    return segment_table(data, remarks.astype(object), zero, run, both.middle)
