"""Error of friction loops whose two strokes differ in speed."""

from __future__ import annotations

import numpy as np

from tribolab.friction.zero import limits

# loops whose speeds differ by more than a decade are not compared
_LN_SPEED_OF_NEIGHBOURS = np.log(10)


def across_speeds(half: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, bool]:
    """Return the error of taking the half loop of two unequal speeds as the friction at either.

    Parameters
    ----------
    half
        Half loop of each pair, in any unit (pair).
    speed
        Speed of the two strokes [m/s] (pair, 2).

    Returns
    -------
    tuple
        Standard uncertainty (pair), in the unit of `half`, and whether the run itself shows how
        friction changes with speed.

    Notes
    -----
    The half loop is the mean of the friction at both speeds, and differs from each by half their
    difference, |dF/d ln v| |ln v_f/v_b|/2. The slope is the steepest between the loop and its
    neighbours in speed within a decade, loops of one speed combined; at least 5 % of friction per
    change of speed by e, and 15 % without a neighbour.

    Examples
    --------
    >>> across_speeds(np.array([10.0]), np.array([[1e-3, 2e-3]]))[0].round(3).tolist()
    [0.52]
    >>> same = np.array([[1e-3, 1e-3], [2e-3, 2e-3], [1e-3, 2e-3]])
    >>> found, measured = across_speeds(np.array([10.0, 11.0, 10.5]), same)
    >>> found.round(2).tolist(), measured
    ([0.0, 0.0, 0.5], True)
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        place, ratio = np.log(speed).mean(axis=1), np.abs(np.log(speed[:, 0] / speed[:, 1]))
    known = np.isfinite(place + half)
    ratio = np.where(np.isfinite(ratio), ratio, 0.0)
    steep = np.full(half.size, limits.SPEED_DEPENDENCE.value) * np.abs(half)
    if not known.any() or not (ratio > 0).any():
        return np.nan_to_num(steep * ratio / 2), False
    # strokes of unequal speed are used only if there are no others
    source = known & (ratio <= limits.MAX_SPEED_DIFFERENCE_OF_LOOP.value)
    measured = bool(
        source.any() and np.ptp(place[source]) > limits.MAX_SPEED_DIFFERENCE_OF_LOOP.value
    )
    if not measured:
        source = known
    order = np.flatnonzero(source)[np.argsort(place[source], kind="stable")]
    groups = np.split(
        order, np.flatnonzero(np.diff(place[order]) > limits.MAX_SPEED_DIFFERENCE_OF_LOOP.value) + 1
    )
    at = np.array([place[g].mean() for g in groups])
    level = np.array([np.abs(half[g]).mean() for g in groups])
    slope = np.abs(np.diff(level) / np.diff(at)) if at.size > 1 else np.zeros(0)
    near = np.diff(at) <= _LN_SPEED_OF_NEIGHBOURS
    for i in np.flatnonzero(known):
        # steps of the curve that overlap the loop's range of speeds
        inside = near & (at[:-1] <= place[i] + ratio[i]) & (at[1:] >= place[i] - ratio[i])
        if inside.any():
            steep[i] = max(
                float(slope[inside].max()), limits.MIN_SPEED_DEPENDENCE.value * abs(half[i])
            )
    return np.nan_to_num(steep * ratio / 2), measured
