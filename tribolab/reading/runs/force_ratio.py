"""Plausibility of recorded forces and coefficients, and their agreement with computed ones."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.untyped import Json

LARGEST = 10.0  # largest plausible ratio; soft rubber on glass reaches 4, gels at light loads more
SMALLEST = 2e-4  # smallest plausible ratio; superlubric contacts reach somewhat less than 1e-3
_LOADED = 0.5  # share of the largest load above which a row is used
_MIN_LOADED_ROWS = 20  # fewest rows under load for a judgement


def doubt_about_coefficient(recorded: np.ndarray) -> str:
    """Return a doubt about an implausible recorded coefficient; else "".

    Parameters
    ----------
    recorded
        Friction coefficient [1] (row).

    Examples
    --------
    >>> doubt_about_coefficient(np.full(30, 0.3))
    ''
    >>> doubt_about_coefficient(np.full(30, 30.0))
    'the friction coefficient is 30: is it written in percent?'
    """
    sound = np.abs(recorded[np.isfinite(recorded)])
    if sound.size < _MIN_LOADED_ROWS:
        return ""
    size = float(np.percentile(sound, 75))
    text = f"the friction coefficient is {size:.3g}"
    return f"{text}: is it written in percent?" if size > LARGEST else ""


def doubt_about(friction: np.ndarray, normal: np.ndarray) -> str:
    """Return a doubt about forces whose ratio is implausible for friction; else "".

    Parameters
    ----------
    friction, normal
        Friction force and normal force [N] (row).

    Examples
    --------
    >>> doubt_about(np.full(30, 3.0), np.full(30, 10.0))
    ''
    >>> doubt_about(np.full(30, 10.0), np.full(30, 0.025))
    'the friction force is 400 times the normal force: are the two swapped, or a unit wrong?'
    """
    sound = np.isfinite(friction) & np.isfinite(normal)
    if sound.sum() < _MIN_LOADED_ROWS:
        return ""
    friction, normal = np.abs(friction[sound]), np.abs(normal[sound])
    loaded = normal > _LOADED * normal.max()
    if loaded.sum() < _MIN_LOADED_ROWS:
        return ""
    # friction passes through zero at each reversal, so its median would be too small
    ratio = float(np.percentile(friction[loaded], 75) / median(normal[loaded]))
    if ratio == 0 or SMALLEST <= ratio <= LARGEST:
        return ""
    text = f"the friction force is {ratio:.3g} times the normal force"
    return f"{text}: are the two swapped, or a unit wrong?"


_APART = 0.02  # largest relative difference; both are computed from readings of three digits
_PRESSED = 0.1  # share of the largest load above which the contact is loaded
_MIN_ROWS = 5  # fewest rows for a comparison
_FORCES = ("friction_force", "normal_force")


def keep_forces_that_agree(columns: dict[str, np.ndarray], attrs: Json) -> None:
    """Remove computed forces whose ratio contradicts the recorded coefficient.

    Forces in the contact are computed from torque and axial force with the geometry of the rig. If
    the file also has the friction coefficient, comparing the two tests this geometry.

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
    sound &= (stated > 0) & (load > _PRESSED * np.nanmax(load, initial=0.0))
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
