"""Comparison of computed forces with the friction coefficient stated in the file."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.untyped import Json

_APART = 0.02  # relative; both come from the same readings, rounded to three digits
_LOADED = 0.1  # share of the largest load
_MIN_ROWS = 5  # rows needed
_FORCES = ("friction_force", "normal_force")


def keep_forces_that_agree(columns: dict[str, np.ndarray], attrs: Json) -> None:
    """Remove computed forces whose ratio contradicts the recorded coefficient.

    Contact forces follow from torque and axial force by the geometry. If the file also has the
    coefficient, it shows whether the geometry is right.

    Parameters
    ----------
    columns
        Arrays in SI by quantity (time); changed in place.
    attrs
        Attributes of the run with the formulas in ``derived``. ``ratio_to_stated_coefficient`` is
        added, and if forces are removed, ``forces_left_out`` with the reason.
    """
    made = [name for name in _FORCES if name in attrs.get("derived", {})]
    if not made or not {"friction_coefficient", *_FORCES} <= set(columns):
        return
    friction, load = (np.abs(columns[name]) for name in _FORCES)
    stated = np.abs(columns["friction_coefficient"]) * load
    sound = np.isfinite(friction) & np.isfinite(stated)
    sound &= (stated > 0) & (load > _LOADED * np.nanmax(load, initial=0.0))
    if np.count_nonzero(sound) < _MIN_ROWS:
        return
    ratio = float(median(friction[sound] / stated[sound]))
    attrs["ratio_to_stated_coefficient"] = ratio
    if abs(ratio - 1) <= _APART:
        return
    for name in made:
        del columns[name], attrs["derived"][name]
    if not attrs["derived"]:
        del attrs["derived"]
    attrs["forces_left_out"] = (
        f"{' and '.join(made)} by formula, whose ratio is {ratio:.4g} times the friction "
        "coefficient of the file"
    )
