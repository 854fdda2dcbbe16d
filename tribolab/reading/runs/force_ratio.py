"""Plausibility of the ratio of two forces as friction coefficient."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median

LARGEST = 10.0  # soft rubber on glass reaches 4, gels and gecko feet at light loads more
SMALLEST = 2e-4  # superlubric contacts reach 1e-3 and slightly less
_LOADED = 0.5  # share of the largest load
_MIN_LOADED_ROWS = 20  # rows under load needed


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
    # a reciprocating drive passes through zero, so the median of the forces is not their size
    ratio = float(np.percentile(friction[loaded], 75) / median(normal[loaded]))
    if ratio == 0 or SMALLEST <= ratio <= LARGEST:
        return ""
    text = f"the friction force is {ratio:.3g} times the normal force"
    return f"{text}: are the two swapped, or a unit wrong?"
