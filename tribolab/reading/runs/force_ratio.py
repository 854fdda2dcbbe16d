"""Whether the ratio of two forces can be a friction coefficient, or they were mixed up."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median

LARGEST = 10.0  # soft rubber on glass reaches some 4, gels and gecko feet at light loads more
SMALLEST = 2e-4  # superlubric contacts come to 1e-3 and a little below
_LOADED = 0.5  # of the largest load
_FEW = 20  # rows under load that tell


def doubt_about_coefficient(recorded: np.ndarray) -> str:
    """Say so where a recorded coefficient is out of the question; else "".

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
    if sound.size < _FEW:
        return ""
    size = float(np.percentile(sound, 75))
    told = f"the friction coefficient is {size:.3g}"
    return f"{told}: is it written in percent?" if size > LARGEST else ""


def doubt_about(friction: np.ndarray, normal: np.ndarray) -> str:
    """Say so where the ratio of the forces is out of the question for friction; else "".

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
    if sound.sum() < _FEW:
        return ""
    friction, normal = np.abs(friction[sound]), np.abs(normal[sound])
    loaded = normal > _LOADED * normal.max()
    if loaded.sum() < _FEW:
        return ""
    # a drive to and fro passes through zero: not the middle of its forces is their size
    ratio = float(np.percentile(friction[loaded], 75) / median(normal[loaded]))
    if ratio == 0 or SMALLEST <= ratio <= LARGEST:
        return ""
    told = f"the friction force is {ratio:.3g} times the normal force"
    return f"{told}: are the two swapped, or a unit wrong?"
