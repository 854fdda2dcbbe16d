"""The load that a run is known by: as stated, else as measured."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab.words import LOAD_MEASURED, LOAD_STATED, LOAD_VARIES

if TYPE_CHECKING:
    import xarray as xr

_VARIES = 1.1  # largest over smallest load of the segments of a run that has one load


class RunLoad(NamedTuple):
    """Load [N] of a run, where it is from, and what was measured while it slid."""

    normal_force: float | None
    load_from: str
    measured_load: float | None


def load_of(stated: float | None, signals: xr.Dataset, friction: xr.Dataset) -> RunLoad:
    """Return the load that a run is known by: as stated, else as measured while it slid.

    Parameters
    ----------
    stated
        Set-point [N] of the campaign file.
    signals, friction
        Of the run; its own file may state a set-point, too.
    """
    if stated is None:
        stated = signals.attrs.get("set_normal_force_N")
    if stated is not None:
        return RunLoad(float(stated), LOAD_STATED, None)
    if "normal_force" not in friction:
        return RunLoad(None, "", None)
    force = friction["normal_force"].values
    lasts = friction["trimmed_stop"].values - friction["trimmed_start"].values
    good = np.isfinite(force) & (force > 0) & (lasts > 0)
    if not good.any():
        return RunLoad(None, "", None)
    if force[good].max() > _VARIES * force[good].min():
        return RunLoad(None, LOAD_VARIES, None)
    mean = float(np.average(force[good], weights=lasts[good]))
    return RunLoad(rounded_load(mean), LOAD_MEASURED, mean)


def rounded_load(load: float) -> float:
    """Return a measured load to three digits: it is a label, its error stands elsewhere."""
    return float(f"{load:.3g}")
