"""Motion to and fro that nothing but the friction force tells of."""

from __future__ import annotations

import numpy as np

_CLEAR = 0.3  # of the force's usual height: what is nearer to zero has no sign
_BOTH = 0.2  # of the samples with a sign have each of both
_OFTEN = 4  # times the sign changes at least; a stroke and its return change it once


def reversals(force: np.ndarray) -> int:
    """Count how often a friction force turns from one clear sign to the other.

    Parameters
    ----------
    force
        Friction force, or its coefficient, of a stretch whose direction of sliding is not known.

    Returns
    -------
    int
        Zero unless it looks like sliding to and fro: four changes of sign or more, with at least
        a fifth of the clear samples (beyond 0.3 of the 95th percentile of its magnitude) on each
        side. The mean of such a force is what the zero is off, and no friction.

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
