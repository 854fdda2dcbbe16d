"""Record of a simulated run: its logs and true values."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd
import xarray as xr

from tribolab.arrays.broadcasting import of_lists
from tribolab.core.untyped import Json


@dataclass(frozen=True)
class SimulatedRun:
    """Simulated run: its logs and its true signals.

    Parameters
    ----------
    name
        ``<surface>_<medium>_<load>N_<number>``.
    force_log
        ``friction_force``, ``normal_force`` [N] over ``time`` [s] on the force clock.
    motion_log
        ``position`` [m], ``sliding_velocity``, ``set_speed`` [m/s] over ``time`` on the motion
        clock.
    noise_free
        At the force log's times: the true ``friction_coefficient`` (signed as the force),
        ``friction_force``, ``normal_force``, ``position``, ``sliding_velocity``.
    segments
        One row per constant-speed segment; units are in the column names.
    facts
        Random and chosen parameters of this run, ready for JSON.

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
    """Return the record of a rig that has only one clock: forces and the true velocity.

    Parameters
    ----------
    run
        From `simulate_run`; a list of runs gives a list.

    Returns
    -------
    xarray.Dataset
        ``friction_force`` and ``normal_force`` [N] of the force log, and ``sliding_velocity``
        [m/s], over ``time``.

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
