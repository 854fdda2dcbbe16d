"""A simulated run: its logs and its true values."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd
import xarray as xr

from tribolab.arrays.broadcasting import of_lists
from tribolab.core.untyped import Json


@dataclass(frozen=True)
class SimulatedRun:
    """Simulated run: the two logs with sensor errors, and the true signals and segments.

    Parameters
    ----------
    name
        ``<surface>_<medium>_<load>N_<number>``.
    force_log
        ``friction_force``, ``normal_force`` [N] (time), on the force clock.
    motion_log
        ``position`` [m], ``sliding_velocity``, ``set_speed`` [m/s] (time), on the motion clock.
    noise_free
        True signals at the times of the force log: ``friction_coefficient`` (signed as the force),
        ``friction_force``, ``normal_force``, ``position``, ``sliding_velocity``.
    segments
        True values, one row per segment of constant speed; units are in the column names.
    facts
        Parameters and randomly drawn errors of this run, as plain data for JSON.

    Examples
    --------
    >>> from tribolab.rig.parameters import Protocol, Rig
    >>> from tribolab.rig.runs import simulate_run
    >>> made = simulate_run("Sb-S", "dry", rig=Rig(Protocol(speeds=(1e-4,))))
    >>> sorted(made.force_log.data_vars), made.segments.direction.tolist()
    (['friction_force', 'normal_force'], [1, -1])
    """

    name: str
    force_log: xr.Dataset
    motion_log: xr.Dataset
    noise_free: xr.Dataset
    segments: pd.DataFrame
    facts: Json


@of_lists("run")
def on_one_clock(run: SimulatedRun) -> xr.Dataset:
    """Return a simulated run as if recorded with one clock: the force log and the true velocity.

    Parameters
    ----------
    run
        From `simulate_run`; a list of runs gives a list.

    Returns
    -------
    xarray.Dataset
        ``friction_force`` and ``normal_force`` [N] of the force log, and ``sliding_velocity`` [m/s]
        (time).

    Examples
    --------
    >>> from tribolab.rig.parameters import Protocol, Rig
    >>> from tribolab.rig.runs import simulate_run
    >>> made = simulate_run("Sb-S", ["dry", "glycerol"], rig=Rig(Protocol(speeds=(1e-4,))))
    >>> sorted(on_one_clock(made)[1].data_vars)
    ['friction_force', 'normal_force', 'sliding_velocity']
    """
    velocity = run.noise_free["sliding_velocity"]
    return run.force_log.assign(sliding_velocity=velocity)
