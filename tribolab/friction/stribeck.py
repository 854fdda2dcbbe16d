"""Measured Stribeck curve: repeats of a measurement combined, with what spreads them kept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import special

from tribolab.errors import AnalysisError, shown
from tribolab.friction.along_run import course_along
from tribolab.friction.decisions.rejected import kept
from tribolab.friction.joined import Label, grouped, joined_curves
from tribolab.friction.statistics import error_of_mean, student_widening
from tribolab.friction.zero.of_run import PAIRED
from tribolab.medians import median
from tribolab.provenance import joined_sources, made
from tribolab.stamping import stamp

_MANY = 24  # strokes of one speed that tell how long friction remembers
_LONG = 100  # strokes from which on a line through them is not mistaken for their memory
_FREEDOM = 3  # least degrees of freedom: two runs alone would widen the error twentyfold


class _Known(NamedTuple):
    """Standard uncertainty without Student's factor, and its degrees of freedom."""

    u: float
    dof: float


class _Value(NamedTuple):
    """One observation: a pair of strokes or a single stroke."""

    run: int
    speed: float
    mu: float
    sem: float
    known: _Known
    variance: float
    segments: int
    order: float = 0.0


def measured_stribeck_curve(
    frictions: Sequence[xr.Dataset],
    speed_tolerance: float = 0.1,
    *,
    over: str = "sliding_speed",
    **labels: Sequence[Label],
) -> xr.Dataset:
    """Combine the segments of one or more runs into friction coefficient over sliding speed.

    Parameters
    ----------
    frictions
        Results of `friction_coefficient`, one for each run of the same system, or of several
        systems with `labels`. Segments that a person rejected (`decide`) are left out.
    speed_tolerance
        Speeds that differ by no more than this ratio belong together. The two strokes of a pair
        stay together at their mean speed.
    over
        The abscissa: ``"sliding_speed"``, or another speed of the segments, such as
        ``"rolling_speed"``, the entrainment speed of a machine whose two bodies turn. It is the
        dim of the result then.
    **labels
        What tells the runs apart, one label for each run, e.g. ``surface=["Sb-R", "Smooth"]``.
        Runs with the same labels make one curve.

    Returns
    -------
    xarray.Dataset
        On dim ``sliding_speed`` [m/s] (mean speed of each group): ``friction_coefficient``;
        ``_std``, the pooled standard deviation within the segments (the paper's error bar);
        ``_sem``; ``_u``, the standard uncertainty without Student's factor, and ``_dof``, its
        degrees of freedom; ``_within``, the standard deviation of the observations of one run about
        the run's mean (NaN if no run has two); ``_between``, the standard deviation of the runs'
        means (NaN for one run); ``runs`` and ``segments``. Attributes: the provenance, with the
        files of all runs as its source. With `labels` all that is over these dims, too
        (`joined_curves`).

    Raises
    ------
    AnalysisError
        If there is no run, none has a friction coefficient, or there is not one label for each run.

    Notes
    -----
    Two strokes whose common offset was removed by the half loop are one observation. In each
    run, and then over the runs, the observations y_i with errors s_i are combined by the
    random-effects estimate of DerSimonian and Laird [1]_: weights 1/(s_i^2 + tau^2), tau^2 from
    Q = sum (y_i - y)^2/s_i^2. The standard error is the larger of 1/sqrt(sum w_i) and
    that of Hartung and Knapp [2]_, sqrt(sum w_i (y_i - y)^2 / ((k - 1) sum w_i)), the latter
    widened so that three standard errors cover 99 % of Student's distribution with k - 1 degrees
    of freedom, but no fewer than 3: for two or three runs that disagree the error is a lower
    bound, so look at ``runs``. ``_u`` is that of Hartung and Knapp alone, with k - 1 degrees of
    freedom: t_0.975(k - 1) of it make a 95 % interval, and the standard error, which has such a
    factor in it already, is for weights. Where observations agree better than their own errors
    let them, which a few do by chance, that interval would be too short: ``_u`` is then
    1/sqrt(sum w_i) with all degrees of freedom, if its interval is the wider one [3]_. With one run
    the spread between runs is unknown, and the error is that run's own. Where it has 24
    observations or more at a speed, as a crank gives, those that follow each other need not be
    independent: the error is at least that of the mean of a series with their spectrum, about the
    line or the run-in along the run where friction surely changes over a hundred and more: the
    mean is one over the run.

    References
    ----------
    .. [1] DerSimonian and Laird (1986), Control. Clin. Trials 7, 177-188.
       doi:10.1016/0197-2456(86)90046-2
    .. [2] Hartung and Knapp (2001), Stat. Med. 20, 3875-3889. doi:10.1002/sim.1009
    .. [3] Röver, Knapp and Friede (2015), BMC Med. Res. Methodol. 15, 99, on intervals that are
       counterintuitively short. doi:10.1186/s12874-015-0091-1

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
        return _of_several(frictions, speed_tolerance, labels)
    if len(frictions) == 0:
        raise AnalysisError("a measured Stribeck curve needs at least one run; none was given")
    for friction in frictions:
        if "friction_coefficient" not in friction:
            raise AnalysisError(
                f"{friction.attrs.get('source', 'run')}: no 'friction_coefficient'; a run without"
                " normal force has friction forces only and makes no Stribeck curve"
            )
    values = [v for i, f in enumerate(frictions) for v in _observations(kept(f), i)]
    values.sort(key=lambda v: v.speed)
    speed = np.array([v.speed for v in values])
    edges = np.flatnonzero(np.diff(np.log(speed)) > np.log1p(speed_tolerance)) + 1
    groups = [group for group in np.split(np.arange(speed.size), edges) if group.size]
    rows = [_combined([values[i] for i in group]) for group in groups]
    names = (
        "sliding_speed",
        "friction_coefficient",
        "friction_coefficient_std",
        "friction_coefficient_sem",
        "friction_coefficient_within",
        "friction_coefficient_between",
        "friction_coefficient_u",
        "friction_coefficient_dof",
        "runs",
        "segments",
    )
    columns = np.array(rows, dtype=float).reshape(-1, len(names)).T
    data = {k: ("sliding_speed", v) for k, v in zip(names[1:], columns[1:], strict=True)}
    for count in ("runs", "segments"):
        data[count] = "sliding_speed", data[count][1].astype(int)
    curve = xr.Dataset(data, coords={"sliding_speed": columns[0]})
    origin = made("measured Stribeck curve", **joined_sources(f.attrs for f in frictions))
    return stamp(curve, **origin, speed_tolerance=float(speed_tolerance))


def _as_sliding(friction: xr.Dataset, over: str) -> xr.Dataset:
    """Return a friction result with another speed in the place of the sliding speed."""
    if over not in friction:
        raise AnalysisError(
            f"{friction.attrs.get('source', 'run')}: the segments have no '{shown(over)}'",
            function="measured_stribeck_curve",
        )
    return friction.assign(sliding_speed=np.abs(friction[over]))


def _of_several(
    frictions: Sequence[xr.Dataset], speed_tolerance: float, labels: Mapping[str, Sequence[Label]]
) -> xr.Dataset:
    """Return the curve of each combination of labels, side by side."""
    groups = grouped(frictions, labels, "measured_stribeck_curve")
    curves = joined_curves(
        [(measured_stribeck_curve(group, speed_tolerance), key) for group, key in groups]
    )
    origin = made("measured Stribeck curves", **joined_sources(f.attrs for f in frictions))
    return curves.assign_attrs(**origin, speed_tolerance=float(speed_tolerance))


def _observations(friction: xr.Dataset, run: int) -> list[_Value]:
    """Independent observations of a run: pairs of strokes, and strokes without a partner."""
    speed = friction["sliding_speed"].values
    mu, std, sem = (friction[f"friction_coefficient{e}"].values for e in ("", "_std", "_sem"))
    known = np.isfinite(mu) & (speed > 0)
    samples = friction["effective_samples"].values if "effective_samples" in friction else None
    own = -1 - np.arange(mu.size)
    key = own
    if "pair" in friction and friction.attrs.get("offset") in PAIRED:
        key = np.where(friction["pair"].values >= 0, friction["pair"].values, own)
    result = []
    for group in np.unique(key[known]):
        part = known & (key == group)
        result.append(
            _Value(
                run,
                float(speed[part].mean()),
                float(mu[part].mean()),
                float(sem[part].mean()),  # strokes of a pair share one error
                _known(float(sem[part].mean()), None if samples is None else samples[part]),
                float(np.mean(std[part] ** 2)),
                int(part.sum()),
                float(np.flatnonzero(part).mean()),
            )
        )
    return result


def _known(sem: float, samples: np.ndarray | None) -> _Known:
    """Take out of a standard error what widened it for few effective samples."""
    fewest = np.inf if samples is None else float(np.nanmin(samples, initial=np.inf))
    widening = student_widening(fewest)
    return _Known(sem / widening, np.inf if widening == 1 else max(fewest - 1, 1.0))


def _random_effects(
    y: np.ndarray, s: np.ndarray, known_of: Sequence[_Known]
) -> tuple[float, float, _Known]:
    """Mean, standard error and bare uncertainty of observations that scatter beyond their own."""
    if y.size == 1:
        return float(y[0]), float(s[0]), known_of[0]
    known = s[np.isfinite(s) & (s > 0)]
    # an error that is unknown or zero is as large as the usual one; weights stay finite
    usual = float(median(known)) if known.size else 1e-12 + float(np.std(y))
    w = 1 / np.where(np.isfinite(s) & (s > 0), s, usual) ** 2
    mean = (w @ y) / w.sum()
    excess = w @ (y - mean) ** 2 - (y.size - 1)
    tau2 = max(0.0, excess / (w.sum() - (w @ w) / w.sum()))
    w = 1 / (1 / w + tau2)
    mean = (w @ y) / w.sum()
    spread = w @ (y - mean) ** 2 / ((y.size - 1) * w.sum())
    student = special.stdtrit(max(y.size - 1, _FREEDOM), 0.995) / 3
    error = float(np.sqrt(max(1 / w.sum(), max(student, 1.0) ** 2 * spread)))
    own, scatter = np.sqrt([1 / w.sum(), spread])
    # few that agree by chance are known no better than each of them is
    if special.stdtrit(y.size - 1, 0.975) * scatter < special.ndtri(0.975) * own:
        return float(mean), error, _Known(float(own), np.inf)
    return float(mean), error, _Known(float(scatter), y.size - 1.0)


def mean_of_observations(
    value: np.ndarray, sem: np.ndarray, observation: np.ndarray
) -> tuple[float, float]:
    """Return the mean of one run's strokes at one speed and its standard error.

    As a point of the measured curve has it: with the scatter of the strokes about their mean.

    Parameters
    ----------
    value, sem : (n,)
        Of each stroke, in the order of time; the unit of both is that of the result.
    observation : (n,)
        The same number for strokes that are one observation, as the two of a half loop.

    Examples
    --------
    >>> pairs = np.array([0, 0, 1, 1])
    >>> value, sem = np.array([0.30, 0.31, 0.32, 0.33]), np.full(4, 0.001)
    >>> [round(part, 3) for part in mean_of_observations(value, sem, pairs)]
    [0.315, 0.019]
    """
    _, first, which = np.unique(observation, return_index=True, return_inverse=True)
    count = np.bincount(which)
    mean, own = (np.bincount(which, part) / count for part in (value, sem))
    mean = _about_course(mean, first)
    level = _random_effects(mean, own, [_Known(float(error), np.inf) for error in own])
    middle, error, _ = _wandering(level, mean[np.argsort(first)].tolist())
    return middle, error


def _about_course(values: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Return a run's observations about how friction changes along it, where it surely does.

    What is told as a trend, or as a run-in, leaves the mean over the run as it is.
    """
    if values.size < _LONG:
        return values
    along = np.argsort(order, kind="stable")
    course = course_along(values[along])
    if course is None:
        return values
    result = values.copy()
    result[along] += course.mean() - course
    return result


def _wandering(
    level: tuple[float, float, _Known], in_order: Sequence[float]
) -> tuple[float, float, _Known]:
    """Widen the error of a run's mean where neighbouring strokes are off by the same."""
    mean, error, known = level
    if len(in_order) < _MANY:
        return level
    series = np.array(in_order)
    plain, wide = (float(part[0]) for part in error_of_mean(series[None]))
    if not plain > known.u:
        return mean, max(error, plain), known
    freedom = max((len(in_order) - 1.0) * (known.u / plain) ** 2, 1.0)
    return mean, max(error, wide), _Known(plain, min(freedom, known.dof))


def _combined(values: list[_Value]) -> tuple[float, ...]:
    """One row of the curve from the observations of one speed."""
    run = np.array([v.run for v in values])
    mu, sem = np.array([v.mu for v in values]), np.array([v.sem for v in values])
    means, squares, freedom = [], 0.0, 0
    for number in np.unique(run):
        part = run == number
        own = [v for v in values if v.run == number]
        order = np.array([v.order for v in own])
        about = _about_course(mu[part], order)
        level = _random_effects(about, sem[part], [v.known for v in own])
        means.append(_wandering(level, about[np.argsort(order, kind="stable")].tolist()))
        squares += float(np.sum((mu[part] - mu[part].mean()) ** 2))
        freedom += int(part.sum()) - 1
    y, s = np.array([mean[:2] for mean in means]).T
    mean, error, known = _random_effects(y, s, [mean[2] for mean in means])
    weight = np.array([v.segments for v in values], dtype=float)
    variance = weight @ np.array([v.variance for v in values]) / weight.sum()
    return (
        float(np.exp(np.mean(np.log([v.speed for v in values])))),
        mean,
        float(np.sqrt(variance)),
        error,
        float(np.sqrt(squares / freedom)) if freedom else np.nan,
        float(np.std(y, ddof=1)) if y.size > 1 else np.nan,
        *known,
        float(np.unique(run).size),
        float(weight.sum()),
    )
