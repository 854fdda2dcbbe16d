"""Detection of reciprocating motion from the sign of the friction force."""

from __future__ import annotations

import numpy as np

_CLEAR = 0.3  # share of the typical magnitude; the sign of smaller forces is ignored
_BOTH = 0.2  # least share of the samples with either sign
_OFTEN = 4  # fewest sign changes; a cycle has two, a single stroke and its return one


def reversals(force: np.ndarray) -> int:
    """Return the number of sign changes of a friction force, 0 if it does not reciprocate.

    Parameters
    ----------
    force
        Friction force or coefficient of an interval of unknown sliding direction.

    Returns
    -------
    int
        Zero unless the motion reciprocates: at least four sign changes, with at least a fifth of
        the clear samples (above 0.3 of the 95th percentile of the magnitude) on each side. The
        mean of such a force is the zero error and not friction.

    Examples
    --------
    >>> reversals(np.tile([1.0, 1.1, -0.9, -1.0], 5)), reversals(np.array([1.0, 0.9, -0.1, 1.1]))
    (9, 0)
    """
    force = force[np.isfinite(force)]
    if not force.size:
        return 0
    clear = force[np.abs(force) > _CLEAR * np.quantile(np.abs(force), 0.95)] > 0
    if not clear.size or not _BOTH <= clear.mean() <= 1 - _BOTH:
        return 0
    changes = int(np.count_nonzero(clear[1:] != clear[:-1]))
    return changes if changes >= _OFTEN else 0
