"""Forces that follow by formula, compared with the friction coefficient that the file states."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.untyped import Json

_APART = 0.02  # relative; both are computed of the same readings, and written with three digits
_LOADED = 0.1  # of the largest load
_FEW = 5  # rows that tell
_FORCES = ("friction_force", "normal_force")


def keep_forces_that_agree(columns: dict[str, np.ndarray], attrs: Json) -> None:
    """Leave out forces by formula whose ratio is not the coefficient beside them.

    A torque and an axial force make the forces of a contact by its geometry. Where a file states
    the coefficient, too, that tells whether the geometry is the right one.

    Parameters
    ----------
    columns
        Arrays in SI by quantity (time); changed in place.
    attrs
        Attributes of the run, whose ``derived`` says what follows by formula.
        ``ratio_to_stated_coefficient`` is added, and where forces are left out,
        ``forces_left_out`` with the reason.
    """
    made = [name for name in _FORCES if name in attrs.get("derived", {})]
    if not made or not {"friction_coefficient", *_FORCES} <= set(columns):
        return
    friction, load = (np.abs(columns[name]) for name in _FORCES)
    stated = np.abs(columns["friction_coefficient"]) * load
    sound = np.isfinite(friction) & np.isfinite(stated)
    sound &= (stated > 0) & (load > _LOADED * np.nanmax(load, initial=0.0))
    if np.count_nonzero(sound) < _FEW:
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
