"""Load of a run: stated, or measured at one or several levels.

Notes
-----
If no load is stated, that of a segment is its measured mean. In sorted order, two neighbours that
differ by more than a tenth belong to different levels: set-points differ by more, while drift and
the wobble of a disc are smaller. If the segments of one level spread by more than a tenth, the load
changes continuously and has no levels.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab.core.wording import LOAD_MEASURED, LOAD_STATED, LOAD_VARIES, load_label

if TYPE_CHECKING:
    import xarray as xr

_VARIES = 1.1  # ratio of the largest to the smallest load of the segments of one level


class RunLoad(NamedTuple):
    """Load of a run [N], its source, the load measured during sliding, and load levels.

    For several set levels the load counts as stated, and `normal_force` is None.
    """

    normal_force: float | None
    load_from: str
    measured_load: float | None
    levels: tuple[float, ...] = ()


def load_of(stated: float | None, signals: xr.Dataset, friction: xr.Dataset) -> RunLoad:
    """Return the load that identifies a run: stated, or else measured while it slid.

    Parameters
    ----------
    stated
        Set-point [N] of the campaign file.
    signals, friction
        Signals and friction of the run; its file may also state a set-point.
    """
    if stated is None:
        stated = signals.attrs.get("set_normal_force_N")
    if stated is not None:
        return RunLoad(float(stated), LOAD_STATED, None)
    if "normal_force" not in friction:
        return RunLoad(None, "", None)
    force = friction["normal_force"].values
    lasts = friction["trimmed_stop"].values - friction["trimmed_start"].values
    lasts = lasts if (lasts > 0).any() else np.ones(force.size)  # each result has the same weight
    good = np.isfinite(force) & (force > 0) & (lasts > 0)
    if not good.any():
        return RunLoad(None, "", None)
    if force[good].max() > _VARIES * force[good].min():
        levels = load_levels(force[good], lasts[good])
        source = LOAD_STATED if levels and _is_set_point(signals) else LOAD_VARIES
        return RunLoad(None, source, None, levels)
    mean = float(np.average(force[good], weights=lasts[good]))
    if _is_set_point(signals):
        return RunLoad(load_label(mean), LOAD_STATED, None)
    return RunLoad(round_load(mean), LOAD_MEASURED, mean)


def _is_set_point(signals: xr.Dataset) -> bool:
    """Whether the recorded load of a run is only its set-point, not a measurement."""
    names = ("normal_force", "set_normal_force")
    if any(name not in signals or signals[name].dims != ("time",) for name in names):
        return False
    measured, wanted = (signals[name].values for name in names)
    return np.array_equal(measured, wanted, equal_nan=True)


def load_levels(force: np.ndarray, lasts: np.ndarray) -> tuple[float, ...]:
    """Return the load levels of a run whose segments were measured under several, smallest first.

    Parameters
    ----------
    force, lasts
        Mean load [N] of each segment, above 0, and its duration as weight (segment).

    Returns
    -------
    tuple
        Mean load [N] of each level; empty if the load changes continuously.

    Examples
    --------
    >>> even = np.ones(4)
    >>> load_levels(np.array([20.1, 40.2, 19.9, 40.0]), even)
    (20.0, 40.1)
    >>> load_levels(np.array([20.0, 21.5, 23.0, 24.5]), even)
    ()
    """
    order = np.argsort(force)
    edges = np.flatnonzero(force[order][1:] > _VARIES * force[order][:-1]) + 1
    groups = np.split(order, edges)
    if any(force[group[-1]] > _VARIES * force[group[0]] for group in groups):
        return ()
    return tuple(float(np.average(force[group], weights=lasts[group])) for group in groups)


def level_mask(force: np.ndarray, levels: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return a mask of the segments measured at the wanted load levels of a run.

    Parameters
    ----------
    force
        Mean load [N] (segment); a segment without load belongs to no level.
    levels, wanted
        Load [N] of each level and whether it is wanted (level).

    Examples
    --------
    >>> level_mask(np.array([19.8, 40.5, np.nan]), np.array([20.0, 40.0]), np.array([False, True]))
    array([False,  True, False])
    """
    known = np.isfinite(force) & (force > 0)
    off = np.abs(np.log(np.where(known, force, levels[0])[:, None] / levels))
    chosen: np.ndarray = known & wanted[off.argmin(axis=1)]
    return chosen


def round_load(load: float) -> float:
    """Return a measured load rounded to three digits, as a label."""
    return float(f"{load:.3g}")
