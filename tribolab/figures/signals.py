"""Signals that the figures of a run show: friction against time, and distance per stroke."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab.arrays.chunks import lowered, pieces
from tribolab.arrays.medians import quantile_in_pieces
from tribolab.arrays.scratch import room
from tribolab.core.errors import AnalysisError

if TYPE_CHECKING:
    import xarray as xr

# share of the usual load below which the contact counts as unloaded: F_x/F_N is mostly noise
_LOADED = 0.2

# names of the variables from which `main_signal` is made
LOOKED_AT = ("friction_force", "normal_force", "friction_coefficient")


class Signal(NamedTuple):
    """Signal to draw: its name, values (time), and the removed offset in words."""

    name: str
    values: np.ndarray
    note: str


def offset_of(friction: xr.Dataset | None, name: str) -> float:
    """Return the median of a friction variable, e.g. of a removed offset; 0 if unknown."""
    if friction is None or name not in friction:
        return 0.0
    values = np.asarray(friction[name], float)
    values = values[np.isfinite(values)]
    return float(np.median(values)) if values.size else 0.0


def _subtract_offset(data: xr.DataArray, offset: float) -> np.ndarray:
    values = np.asarray(data, float)
    return lowered(values, offset) if offset else values  # subtracting 0 would copy a long record


def main_signal(run: xr.Dataset, friction: xr.Dataset | None = None) -> Signal:
    """Return the friction coefficient (time), or the friction force if no load was recorded.

    Parameters
    ----------
    run
        A run (time).
    friction
        Its friction result, whose offsets are removed from the signal.

    Returns
    -------
    Signal
        The signal without its offset; a coefficient is NaN while the contact is unloaded.

    Raises
    ------
    AnalysisError
        If the run has neither a friction coefficient nor a friction force.
    """
    if "friction_force" in run and "normal_force" in run:
        zero = offset_of(friction, "friction_force_offset")
        load, force = (np.asarray(run[n], float) for n in ("normal_force", "friction_force"))
        ratio = _ratio(force, zero, load, offset_of(friction, "normal_force_offset"))
        return Signal("friction_coefficient", ratio, "offset removed" if zero else "")
    for name in ("friction_coefficient", "friction_force"):
        if name in run:
            zero = offset_of(friction, f"{name}_offset")
            return Signal(name, _subtract_offset(run[name], zero), "offset removed" if zero else "")
    known = ", ".join(map(str, run.data_vars)) or "nothing"
    raise AnalysisError(
        "the run has neither 'friction_force' nor 'friction_coefficient', so there is no trace to "
        f"draw; it has {known}"
    )


def _ratio(force: np.ndarray, force_zero: float, load: np.ndarray, load_zero: float) -> np.ndarray:
    """Return force / load after subtraction of their zeros; NaN while the contact is unloaded."""
    least = _LOADED * _usual_load(load, load_zero)
    ratio = room(load.size)
    for first, last in pieces(0, load.size):
        pressing = load[first:last] - load_zero
        pressed = (pressing > least) & (pressing > 0)
        own = ratio[first:last]
        own[:] = np.nan
        np.divide(force[first:last] - force_zero, pressing, out=own, where=pressed)
    return ratio


def _usual_load(load: np.ndarray, zero: float) -> float:
    """Return the 95 % quantile of the load after subtraction of its zero; infinite if unknown."""

    def is_above(first: int, last: int) -> np.ndarray:
        some = load[first:last] - zero
        return some[np.isfinite(some)]

    usual = quantile_in_pieces(is_above, load.size, 0.95)
    return np.inf if np.isnan(usual) else float(usual)


class Stroke(NamedTuple):
    """One segment of a run: its samples, the distance at each, and the ends of its trimmed part."""

    number: int
    samples: slice
    distance: np.ndarray
    trimmed: tuple[float, float]
    speed: float
    direction: int


def strokes_of(run: xr.Dataset, segments: xr.Dataset) -> list[Stroke]:
    """Return each segment of a run with its samples and the distance [m] since its start.

    The distance comes from the position, else from the speed; if both are unknown, it is the time
    since the start [s]. It never decreases, even if the position is noisy.
    """
    time = np.asarray(run["time"], float)
    first = np.searchsorted(time, np.asarray(segments["start"], float), "left")
    last = np.searchsorted(time, np.asarray(segments["stop"], float), "right")
    inner = [np.asarray(segments[name], float) for name in ("trimmed_start", "trimmed_stop")]
    speeds = np.asarray(segments["sliding_speed"], float)
    directions = np.asarray(segments["direction"], int)
    parts = []
    for k in range(segments.sizes["segment"]):
        part = slice(int(first[k]), int(last[k]))
        if part.stop - part.start < 2:
            continue
        way = _sliding_distance(run, time, part, speeds[k])
        ends = np.interp([inner[0][k], inner[1][k]], time[part], way)
        parts.append(
            Stroke(k, part, way, (float(ends[0]), float(ends[1])), speeds[k], int(directions[k]))
        )
    return parts


def _sliding_distance(run: xr.Dataset, time: np.ndarray, part: slice, speed: float) -> np.ndarray:
    seconds = time[part] - time[part.start]
    way = seconds * (speed if np.isfinite(speed) else 1.0)
    if "position" in run:
        position = np.asarray(run["position"][part], float)
        if np.isfinite(position).all():
            way = (position - position[0]) * np.sign(position[-1] - position[0] or 1.0)
    elif "sliding_velocity" in run:
        velocity = np.abs(np.asarray(run["sliding_velocity"][part], float))
        if np.isfinite(velocity).all():
            way = np.r_[0.0, np.cumsum((velocity[1:] + velocity[:-1]) / 2 * np.diff(seconds))]
    return np.maximum.accumulate(np.maximum(way, 0.0))
