"""One measured curve of a joint fit, and the points that all of them make together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.errors import AnalysisError, Cure, shown
from tribolab.fit.joint.model import Points
from tribolab.fit.joint.response import Response

_PRIOR_FREEDOM = 4.0
_NO_ERROR = Cure(
    notebook="give it friction_coefficient_sem, as tl.measured_stribeck_curve does",
    campaign="repeat the runs, or record for longer",
)


class LoadCurve(NamedTuple):
    """Friction measured at one load, and what is computed beside it.

    Parameters
    ----------
    name
        What a reader calls it, such as "31 N".
    surface
        Its surface; "" if there is one only.
    load
        F_N/L [N/m].
    measured
        ``friction_coefficient`` over (sliding_speed), or over (run, sliding_speed), with ``_sem``
        or, failing that, ``_std``.
    response
        What is computed beside it. Of a dry curve it holds what multiplies the wet shear stress.
    dry
        Whether it was measured without the liquid.
    """

    name: str
    surface: str
    load: float
    measured: xr.Dataset
    response: Response
    dry: bool = False


class Measured(NamedTuple):
    """Points of all curves, the run of each, and how many cannot be taken."""

    points: Points
    run: np.ndarray
    left_out: int


def points_of(
    curves: Sequence[LoadCurve], speed_range: tuple[float, float] = (0.0, np.inf)
) -> Measured:
    """Return the points of all curves, one after the other.

    Parameters
    ----------
    curves
        The measured curves.
    speed_range
        Lowest and highest speed [m/s] to take.

    Raises
    ------
    AnalysisError
        If a curve has no point with a friction above zero and a known error, or all together
        have fewer than four.

    Notes
    -----
    A point whose error is not known gets the median of its curve. Errors told by few runs are
    themselves uncertain, and one that is small by chance would outweigh all others: the variance
    of a point of k runs becomes ``((k - 1) s^2 + 4 s0^2)/(k + 3)``, with s0^2 the mean over the
    curve of the relative variances [1]_.

    References
    ----------
    .. [1] G. K. Smyth, Stat. Appl. Genet. Mol. Biol. 3, 3 (2004). doi:10.2202/1544-6115.1027
    """
    columns: list[tuple[np.ndarray, ...]] = []
    levels = left_out = 0
    for number, curve in enumerate(curves):
        whole = curve.measured
        runs = (
            [whole.isel(run=k) for k in range(whole.sizes["run"])]
            if "run" in whole.dims
            else [whole]
        )
        speed, friction, error, run = (
            np.concatenate(part)
            for part in zip(*(_of_run(curve.name, r, k) for k, r in enumerate(runs)), strict=True)
        )
        taken = (speed >= speed_range[0]) & (speed <= speed_range[1])
        kept = taken & (friction > 0)
        left_out += int(np.count_nonzero(taken & ~kept))
        if not kept.any():
            raise AnalysisError(
                f"{shown(curve.name)}: no friction above zero from {speed_range[0]:g} to "
                f"{speed_range[1]:g} m/s"
            )
        known = kept & np.isfinite(error)
        if not known.any():
            raise AnalysisError(
                "no point has an error that is known, so nothing says how far to trust it",
                where=shown(curve.name),
                cure=_NO_ERROR,
            )
        relative = np.where(known, error, np.median(error[known])) / np.where(kept, friction, 1.0)
        columns.append(
            (
                np.log(speed[kept]),
                np.log(friction[kept]),
                relative[kept],
                np.full(kept.sum(), number),
                levels + run[kept],
                run[kept],
            )
        )
        levels += len(runs)
    *table, run = (np.concatenate(part) for part in zip(*columns, strict=True))
    if run.size < 4:
        raise AnalysisError(f"{run.size} points in all; at least 4 are wanted for a joint fit")
    return Measured(Points(*table), run, left_out)


def _of_run(
    name: str, measured: xr.Dataset, number: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Speed [m/s], friction, its standard error (NaN: not known) and the run's number by point."""
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
    for ending in ("_std", "_sem"):  # the better of the two last
        if f"friction_coefficient{ending}" in measured:
            values = measured[f"friction_coefficient{ending}"].values.astype(float)
            error = np.where(np.isfinite(values) & (values > 0), values, error)
    if "runs" in measured:
        error = _moderated(error, friction, measured["runs"].values)
    there = np.isfinite(friction) & (speeds > 0)
    return speeds[there], friction[there], error[there], np.full(there.sum(), number)


def _moderated(error: np.ndarray, friction: np.ndarray, runs: np.ndarray) -> np.ndarray:
    """Draw the variances that few runs tell to their mean over the curve."""
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(friction > 0, error / friction, np.nan) ** 2
    several = np.isfinite(relative) & (runs > 1)
    if not several.any():
        return error
    usual, freedom = relative[several].mean(), np.where(several, runs - 1, 0)
    drawn = (freedom * relative + _PRIOR_FREEDOM * usual) / (freedom + _PRIOR_FREEDOM)
    return np.where(several, np.sqrt(drawn) * friction, error)
