"""Bounds of the critical stiffness, below which stick-slip occurs."""

from __future__ import annotations

import numpy as np

from tribolab.friction.oscillation import limits

STIFFNESS = "stiffness_N_m"  # run attribute with the rig's stiffness in the sliding direction
# creep share and k/k_c of simulated cycles (ageing law, slider of test_critical_stiffness),
# measured as in `stick_slip`: near k_c the rise is less steep than the rig's stiffness
_SMALL_EVOLUTION = (  # b = 1.5 a
    [0.0, 0.0469, 0.1005, 0.1442, 0.1845, 0.2298, 0.2675, 0.376],
    [0.0, 0.0998, 0.2953, 0.4871, 0.6725, 0.7955, 0.8282, 0.7717],
)
_LARGE_EVOLUTION = (  # b = 3 a
    [0.0, 0.0215, 0.0438, 0.0645, 0.0899, 0.1197, 0.1392, 0.1845, 0.25],
    [0.0, 0.1004, 0.3017, 0.5016, 0.7024, 0.852, 0.9008, 0.949, 1.0],
)


def critical_stiffness(
    drop: np.ndarray,
    recurrence_distance: np.ndarray,
    stiffness: np.ndarray,
    load: np.ndarray | float,
    cycles: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Return lower and upper bounds of the critical stiffness [N/m] from cycles of stick-slip.

    Parameters
    ----------
    drop
        Mean drop of the friction coefficient [1] (or of the force [N], with a load of 1).
    recurrence_distance
        Mean sliding distance from drop to drop [m].
    stiffness
        Stiffness of the rig: steepest rise of the friction force during a stick [N/m].
    load
        Normal force [N].
    cycles
        Number of cycles; NaN is returned for fewer than 8.

    Returns
    -------
    tuple of ndarray
        Both bounds. The upper one is infinite if creep is too small: the rig is far too soft.

    Notes
    -----
    Steady sliding is unstable if the rig is softer than ``k_c = -(dF/d ln v)/D_c = (b - a) N/D_c``
    (quasi-static rate-and-state friction with memory length D_c [1]_). D_c is not known from one
    run, but the closer k is to k_c, the more the sample creeps between slips: a sample that sticks
    from drop to drop loads the rig by k times that distance. ``1 - drop N/(k distance)`` is the
    share of creep, zero for k << k_c. The bounds are those of cycles simulated with b = 1.5 a and b
    = 3 a, with an error of the creep of 0.05. Inertia makes slips overshoot, which changes drop and
    distance alike; it raises k_c by ``(b - a)/a m v^2/D_c^2``.

    References
    ----------
    .. [1] J. R. Rice, A. L. Ruina, J. Appl. Mech. 50, 343 (1983).

    Examples
    --------
    >>> low, high = critical_stiffness(np.array([0.1]), np.array([1.1e-4]), 1e4, 10.0, 20)
    >>> bool(low[0] > 1e4), bool(low[0] < high[0])
    (True, True)
    """
    drop, distance, k = (np.asarray(x, float) for x in (drop, recurrence_distance, stiffness))
    with np.errstate(divide="ignore", invalid="ignore"):
        creep = 1.0 - drop * load / (k * distance)
        error = limits.ERROR_OF_CREEP.value
        largest = np.interp(creep + error, *_LARGE_EVOLUTION)
        least = np.interp(creep - error, *_SMALL_EVOLUTION)
        low, high = k / largest, k / least
    known = (
        np.isfinite(creep)
        & (creep > -2 * error)
        & (np.asarray(cycles) >= limits.MIN_CYCLES_OF_STIFFNESS.value)
    )
    return np.where(known, low, np.nan), np.where(known, high, np.nan)
