"""Which segments of a run slide at one speed."""

from __future__ import annotations

import numpy as np

_SAME_SPEED = 0.05  # relative difference of the speeds of alike segments


def of_one_speed(speed: np.ndarray, known: np.ndarray) -> list[np.ndarray]:
    """Return the places of segments of alike speeds, a group for each speed, the slowest first.

    Parameters
    ----------
    speed
        [m/s] (segment).
    known
        Which of them count (segment); those whose speed is not above zero do not.

    Examples
    --------
    >>> speed = np.array([1.0, 2.0, 1.01, np.nan])
    >>> [group.tolist() for group in of_one_speed(speed, np.ones(4, bool))]
    [[0, 2], [1]]
    """
    counted = known & (speed > 0)
    order = np.flatnonzero(counted)[np.argsort(speed[counted], kind="stable")]
    cuts = np.flatnonzero(np.diff(np.log(speed[order])) > _SAME_SPEED) + 1
    return [np.sort(part) for part in np.split(order, cuts) if part.size]
