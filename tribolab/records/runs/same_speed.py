"""Grouping of the segments of a run by speed."""

from __future__ import annotations

import numpy as np

_SAME_SPEED = 0.05  # relative difference of speed within a group


def segments_by_speed(speed: np.ndarray, known: np.ndarray) -> list[np.ndarray]:
    """Return the indices of segments grouped by speed, the lowest speed first.

    Parameters
    ----------
    speed
        [m/s] (segment).
    known
        Mask of segments to use (segment); those without a positive speed are ignored.

    Examples
    --------
    >>> speed = np.array([1.0, 2.0, 1.01, np.nan])
    >>> [group.tolist() for group in segments_by_speed(speed, np.ones(4, bool))]
    [[0, 2], [1]]
    """
    counted = known & (speed > 0)
    order = np.flatnonzero(counted)[np.argsort(speed[counted], kind="stable")]
    cuts = np.flatnonzero(np.diff(np.log(speed[order])) > _SAME_SPEED) + 1
    return [np.sort(part) for part in np.split(order, cuts) if part.size]
