"""Table of the pairs of strokes in a friction result."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.units.stamping import stamp


def half_loops(friction: xr.Dataset) -> xr.Dataset:
    """Return a table of the pairs of strokes, one row for each half loop.

    Parameters
    ----------
    friction
        From `friction_coefficient`; rejected segments are in no pair.

    Returns
    -------
    xarray.Dataset
        On dim ``pair``: ``forward_speed``, ``backward_speed`` [m/s], ``half_loop``,
        ``half_loop_sem``, ``friction_force_offset`` [N] and, if the normal force is known,
        ``friction_coefficient`` (the half loop over the mean normal force of both strokes).

    Examples
    --------
    >>> from tribolab import rig
    >>> from tribolab.friction.coefficient.coefficient import friction_coefficient
    >>> from tribolab.friction.segments.find import find_segments
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4, 1e-3)))
    >>> run = rig.simulate_run("Sb-S", "dry", rig=short).noise_free
    >>> pairs = half_loops(friction_coefficient(run, find_segments(run)))
    >>> pairs.half_loop.values.round(1).tolist()
    [59.2, 60.1]
    """
    pair = friction["pair"].values
    sign = friction["direction"].values
    numbers = np.arange(pair.max(initial=-1) + 1)
    forward, backward = (
        np.array([np.flatnonzero((pair == n) & (sign == d))[0] for n in numbers], dtype=int)
        for d in (1, -1)
    )
    speed = friction["sliding_speed"].values
    data = {"forward_speed": speed[forward], "backward_speed": speed[backward]}
    if "half_loop" in friction:
        paired_error = friction["friction_force_sem"].values[forward]
        data["half_loop"] = friction["half_loop"].values[forward]
        data["half_loop_sem"] = paired_error
        data["friction_force_offset"] = friction["friction_force_offset"].values[forward]
    if "normal_force" in friction:
        load = friction["normal_force"].values
        with np.errstate(divide="ignore", invalid="ignore"):
            data["friction_coefficient"] = 2 * data["half_loop"] / (load[forward] + load[backward])
    table = xr.Dataset({k: ("pair", v) for k, v in data.items()}, coords={"pair": numbers})
    return stamp(table, **friction.attrs)
