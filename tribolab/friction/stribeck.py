"""Measured Stribeck curve from repeats of a measurement, with their scatter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, shown
from tribolab.core.provenance import join_sources, made
from tribolab.friction.decisions.rejected import kept
from tribolab.friction.joined import Label, grouped, joined_curves
from tribolab.friction.mean_error.freedom import with_freedom
from tribolab.friction.points.mean_of_repeats import Mean, mean_of_repeats, pooled_between_runs
from tribolab.friction.points.strokes import (
    Observations,
    grouped_by_speed,
    means_of_run,
    observations_of,
)
from tribolab.units.stamping import stamp

_COLUMNS = (
    "sliding_speed",
    "friction_coefficient",
    "friction_coefficient_std",
    "friction_coefficient_sem",
    "friction_coefficient_within",
    "friction_coefficient_between",
    "friction_coefficient_u",
    "friction_coefficient_dof",
    "friction_coefficient_U95",
    "runs",
    "segments",
)


def measured_stribeck_curve(
    frictions: Sequence[xr.Dataset],
    speed_tolerance: float = 0.1,
    *,
    over: str = "sliding_speed",
    **labels: Sequence[Label],
) -> xr.Dataset:
    """Return friction coefficient against sliding speed from the segments of runs.

    Parameters
    ----------
    frictions
        Results of `friction_coefficient`, one for each run of the same system, or of several
        systems with `labels`. Segments that a person rejected (`decide`) are left out.
    speed_tolerance
        Largest relative difference of the speeds of one point. The two strokes of a pair are
        combined at their mean speed; a run whose speed only rises or only falls repeats no speed.
    over
        The abscissa: ``"sliding_speed"``, or another speed of the segments, such as
        ``"rolling_speed"``, the entrainment speed of a machine whose two bodies turn. It becomes
        the dim of the result.
    **labels
        Labels that distinguish the runs, one for each run, e.g. ``surface=["Sb-R", "Smooth"]``.
        Runs with the same labels make one curve.

    Returns
    -------
    xarray.Dataset
        On dim ``sliding_speed`` [m/s] (mean speed of each group): ``friction_coefficient``;
        ``_std``, the pooled standard deviation within the segments (the error bar of the reference
        study); ``_sem`` and ``_u``, its standard uncertainty, ``_dof``, their degrees of freedom,
        and ``_U95``, the expanded uncertainty (95 % coverage); ``_within``, the standard deviation
        of the observations of one run about the run's mean (NaN if no run has two); ``_between``,
        the standard deviation of the runs' means (NaN for one run); ``runs`` and ``segments``.
        Attributes: the provenance, with the files of all runs as its source; ``speeds_grouped``
        ("stated", "clear", "fair" or "unclear"): how clearly the points differ in speed;
        ``repeats_are``: the kind of repeats. With `labels` all variables are also over these dims
        (`joined_curves`).

    Raises
    ------
    AnalysisError
        If there is no run, none has a friction coefficient, or there is not one label for each run.

    Notes
    -----
    Two strokes whose common offset was removed by the half loop are one observation. Observations
    at one speed make the run's mean, and the runs' means make the point, each by the rule of
    `tribolab.friction.points.mean_of_repeats`: the scatter of strokes is estimated from all speeds
    of the run, that of runs from all speeds of the curve, with degrees of freedom reduced by an
    offset between runs. A single observation has its own error, in which a trend along the stroke
    counts as drift. With one run the scatter between runs is unknown, and the error is the run's
    own. Speeds are grouped without chaining (`tribolab.friction.points.speed_groups`), by set
    speeds if all are known.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> one = xr.Dataset({
    ...     "sliding_speed": ("segment", [1e-3, 1.02e-3, 1e-2]),
    ...     "friction_coefficient": ("segment", [0.30, 0.32, 0.5]),
    ...     "friction_coefficient_std": ("segment", [0.01, 0.01, 0.02]),
    ...     "friction_coefficient_sem": ("segment", [0.002, 0.002, 0.004]),
    ... })
    >>> curve = measured_stribeck_curve([one])
    >>> curve.friction_coefficient.values.round(3).tolist(), curve.segments.values.tolist()
    ([0.31, 0.5], [2, 1])
    >>> measured_stribeck_curve([one, one, one], medium=["dry", "oil", "dry"]).runs.values.tolist()
    [[2.0, 2.0], [1.0, 1.0]]
    """
    if over != "sliding_speed":
        frictions = [_as_sliding(friction, over) for friction in frictions]
        curve = measured_stribeck_curve(frictions, speed_tolerance, over="sliding_speed", **labels)
        return stamp(curve.rename(sliding_speed=over))
    if labels:
        return _join_curves(frictions, speed_tolerance, labels)
    if len(frictions) == 0:
        raise AnalysisError("a measured Stribeck curve needs at least one run; none was given")
    for friction in frictions:
        if "friction_coefficient" not in friction:
            raise AnalysisError(
                f"{friction.attrs.get('source', 'run')}: no 'friction_coefficient'; a run without"
                " normal force has friction forces only and makes no Stribeck curve"
            )
    seen = observations_of([kept(friction) for friction in frictions])
    members, verdict = grouped_by_speed(seen, speed_tolerance)
    columns = np.array(_rows(seen, members), dtype=float).reshape(-1, len(_COLUMNS)).T
    data = {k: ("sliding_speed", v) for k, v in zip(_COLUMNS[1:], columns[1:], strict=True)}
    for count in ("runs", "segments"):
        data[count] = "sliding_speed", data[count][1].astype(int)
    curve = xr.Dataset(data, coords={"sliding_speed": columns[0]})
    origin = made("measured Stribeck curve", **join_sources(f.attrs for f in frictions))
    return stamp(
        curve,
        **origin,
        speed_tolerance=float(speed_tolerance),
        speeds_grouped=verdict,
        repeats_are=_repeats_are(frictions),
    )


def _rows(seen: Observations, members: Sequence[np.ndarray]) -> list[tuple[float, ...]]:
    """Return a row for each point of the curve, as in `_COLUMNS`."""
    runs = np.unique(seen.run)
    means: dict[tuple[int, int], Mean] = {}  # by run and point
    for number, run in enumerate(runs.tolist()):
        own = [(k, part[seen.run[part] == run]) for k, part in enumerate(members)]
        own = [(k, part) for k, part in own if part.size]
        for (k, _), mean in zip(own, means_of_run(seen, [part for _, part in own]), strict=True):
            means[number, k] = mean
    table = np.full((runs.size, len(members)), np.nan)
    for (number, k), mean in means.items():
        table[number, k] = np.log(mean.mean) if mean.mean > 0 else np.nan
    return [
        _row(seen.of(part), [means[n, k] for n in range(runs.size) if (n, k) in means], table, k)
        for k, part in enumerate(members)
    ]


def _row(
    seen: Observations, means: Sequence[Mean], table: np.ndarray, column: int
) -> tuple[float, ...]:
    whole = means[0]
    y = np.array([mean.mean for mean in means])
    if y.size > 1:
        others = pooled_between_runs(np.delete(table, column, axis=1))
        whole = mean_of_repeats(y, np.array([mean.sem for mean in means]), others)
    error = with_freedom(np.array(whole.sem), np.array(whole.u95))
    squares, freedom = 0.0, 0
    for run in np.unique(seen.run):
        own = seen.mean[seen.run == run]
        squares, freedom = squares + float(((own - own.mean()) ** 2).sum()), freedom + own.size - 1
    strokes = float(seen.strokes.sum())
    return (
        float(np.exp(np.log(seen.speed).mean())),
        whole.mean,
        float(np.sqrt(seen.strokes @ seen.variance / strokes)),
        float(error.sem),
        float(np.sqrt(squares / freedom)) if freedom else np.nan,
        float(np.std(y, ddof=1)) if y.size > 1 else np.nan,
        float(error.sem),
        float(error.dof),
        whole.u95,
        float(y.size),
        strokes,
    )


def _repeats_are(frictions: Sequence[xr.Dataset]) -> str:
    """Return the kind of repeats whose scatter is used."""
    specimens = [str(friction.attrs.get("specimen", "")) for friction in frictions]
    if len(frictions) > 1 and all(specimens) and len(set(specimens)) == len(frictions):
        return "between specimens"
    if len(frictions) > 1 and all(specimens) and len(set(specimens)) == 1:
        return "between runs on one specimen"
    return "between runs"


def _as_sliding(friction: xr.Dataset, over: str) -> xr.Dataset:
    """Return a friction result with another speed as the sliding speed."""
    if over not in friction:
        raise AnalysisError(
            f"{friction.attrs.get('source', 'run')}: the segments have no '{shown(over)}'",
            function="measured_stribeck_curve",
        )
    return friction.assign(sliding_speed=np.abs(friction[over]))


def _join_curves(
    frictions: Sequence[xr.Dataset], speed_tolerance: float, labels: Mapping[str, Sequence[Label]]
) -> xr.Dataset:
    """Return the curves of all combinations of labels as one dataset."""
    groups = grouped(frictions, labels, "measured_stribeck_curve")
    curves = joined_curves(
        [(measured_stribeck_curve(group, speed_tolerance), key) for group, key in groups]
    )
    origin = made("measured Stribeck curves", **join_sources(f.attrs for f in frictions))
    return curves.assign_attrs(**origin, speed_tolerance=float(speed_tolerance))
