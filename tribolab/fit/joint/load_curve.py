"""Measured friction curves of a joint fit, and their points in one sequence."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.optimize import nnls

from tribolab.core.errors import AnalysisError, Cure, shown
from tribolab.fit import limits
from tribolab.fit.joint.model import Points
from tribolab.fit.joint.response import Response

_SCATTER_ROUNDS = 20
_NO_ERROR = Cure(
    notebook="give it friction_coefficient_sem, as tl.measured_stribeck_curve does",
    campaign="repeat the runs, or record for longer",
)


class LoadCurve(NamedTuple):
    """Measured friction at one load, with the friction computed for this load.

    Parameters
    ----------
    name
        Displayed name, such as "31 N".
    surface
        Surface; "" if there is only one.
    load
        F_N/L [N/m].
    measured
        ``friction_coefficient`` over (sliding_speed), or over (run, sliding_speed), with ``_sem``
        or else ``_std``.
    response
        Computed friction. For a dry curve: a constant friction per shear stress.
    dry
        Whether the curve was measured without the liquid.
    """

    name: str
    surface: str
    load: float
    measured: xr.Dataset
    response: Response
    dry: bool = False


class MeasuredPoints(NamedTuple):
    """Points of all curves, their run numbers, and the number of omitted points."""

    points: Points
    run: np.ndarray
    left_out: int


def points_of(
    curves: Sequence[LoadCurve], speed_range: tuple[float, float] = (0.0, np.inf)
) -> MeasuredPoints:
    """Return the points of all curves in one sequence.

    Parameters
    ----------
    curves
        The measured curves.
    speed_range
        Lowest and highest speed [m/s] to use.

    Raises
    ------
    AnalysisError
        If a curve has no point with a friction above zero and a known error, or there are fewer
        than four points.

    Notes
    -----
    A point of unknown error gets the median relative error of its curve. Errors from few runs are
    uncertain, and a point whose error is small by chance would outweigh all others. Therefore the
    variance of a point of k runs becomes ``((k - 1) s^2 + 4 s0^2)/(k + 3)`` [1]_, with ``s0^2 = a^2
    mu^2 + b^2`` fitted to all such points: one part is proportional to friction, the other, e.g.
    from the zero of the force, is constant.

    References
    ----------
    .. [1] G. K. Smyth, Stat. Appl. Genet. Mol. Biol. 3, 3 (2004). doi:10.2202/1544-6115.1027
    """
    parts: list[_Run] = []
    for number, curve in enumerate(curves):
        whole = curve.measured
        given = whole.get("friction_coefficient")
        several = given is not None and "run" in given.dims  # other variables may have the run dim
        runs = [whole.isel(run=k) for k in range(whole.sizes["run"])] if several else [whole]
        parts += [_run_points(curve.name, run, number, k) for k, run in enumerate(runs)]
    counts = [part.speed.size for part in parts]
    speed, friction, error, repeats = (
        np.concatenate([getattr(part, name) for part in parts])
        for name in ("speed", "friction", "error", "repeats")
    )
    level = np.repeat(np.arange(len(parts)), counts)
    of_curve = np.repeat([part.curve for part in parts], counts)
    run = np.repeat([part.run for part in parts], counts)
    taken = (speed >= speed_range[0]) & (speed <= speed_range[1])
    kept = taken & (friction > 0)
    if kept.sum() < limits.MIN_POINTS_OF_LOAD.value:
        raise AnalysisError(
            f"{kept.sum()} points with a friction above zero in all; at least "
            f"{limits.MIN_POINTS_OF_LOAD.value} are wanted for a joint fit"
        )
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(kept, _moderate(error, friction, repeats, kept) / friction, np.nan)
    for number, curve in enumerate(curves):
        mine = kept & (of_curve == number)
        if not mine.any():
            raise AnalysisError(
                f"{shown(curve.name)}: no friction above zero from {speed_range[0]:g} to "
                f"{speed_range[1]:g} m/s"
            )
        known = mine & np.isfinite(relative)
        if not known.any():
            raise AnalysisError(
                "no point has an error that is known, so nothing says how far to trust it",
                where=shown(curve.name),
                cure=_NO_ERROR,
            )
        relative[mine & ~known] = np.median(relative[known])
    points = Points(
        np.log(speed[kept]), np.log(friction[kept]), relative[kept], of_curve[kept], level[kept]
    )
    return MeasuredPoints(points, run[kept], int(np.count_nonzero(taken & ~kept)))


class _Run(NamedTuple):
    """Points of one curve or of one of its runs; unknown errors are NaN."""

    speed: np.ndarray
    friction: np.ndarray
    error: np.ndarray
    repeats: np.ndarray
    curve: int
    run: int


def _run_points(name: str, measured: xr.Dataset, curve: int, run: int) -> _Run:
    """Return the points of one run at which both speed and friction are known."""
    given = measured.get("friction_coefficient")
    if given is None or given.dims != ("sliding_speed",):
        raise AnalysisError(
            "a 'friction_coefficient' over 'sliding_speed' is wanted",
            where=shown(name),
            cure=Cure(notebook="tl.measured_stribeck_curve makes such a curve"),
        )
    speeds = measured.get("measured_speed", measured["sliding_speed"]).values.astype(float)
    friction = given.values.astype(float)
    error = np.full(friction.size, np.nan)
    for ending in ("_std", "_sem"):  # _sem overwrites _std
        if f"friction_coefficient{ending}" in measured:
            values = measured[f"friction_coefficient{ending}"].values.astype(float)
            error = np.where(np.isfinite(values) & (values > 0), values, error)
    repeats = measured["runs"].values if "runs" in measured else np.zeros(friction.size)
    there = np.isfinite(friction) & (speeds > 0)
    return _Run(speeds[there], friction[there], error[there], repeats[there], curve, run)


def _moderate(
    error: np.ndarray, friction: np.ndarray, repeats: np.ndarray, kept: np.ndarray
) -> np.ndarray:
    """Return the standard errors; those from few runs are shrunk towards the usual error."""
    several = kept & np.isfinite(error) & (repeats > 1)
    if several.sum() < limits.MIN_POINTS_OF_LOAD.value:
        return error
    variance = error[several] ** 2
    columns = np.stack([friction[several] ** 2, np.ones(several.sum())], axis=1)
    usual = np.full(variance.size, variance.mean())
    # the standard error of a variance from k - 1 squares is proportional to the variance
    for _ in range(_SCATTER_ROUNDS):
        parts, _ = nnls(columns / usual[:, None], variance / usual)
        usual = np.maximum(columns @ parts, 1e-3 * variance.mean())
    freedom = repeats[several] - 1
    drawn = error.copy()
    drawn[several] = np.sqrt(
        (freedom * variance + limits.PRIOR_FREEDOM_OF_SCATTER.value * usual)
        / (freedom + limits.PRIOR_FREEDOM_OF_SCATTER.value)
    )
    return drawn
