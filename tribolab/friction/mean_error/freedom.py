"""Conversion between U95 and a standard error with its degrees of freedom."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.core.coverage import NORMAL

# degrees of freedom among which that of a given u95/sem is found
_DOF = np.geomspace(1.0, 1e4, 8000)


_WIDTHS = special.stdtrit(_DOF, 0.975)


class StandardError(NamedTuple):
    """A standard error and its degrees of freedom, which together make U95."""

    sem: np.ndarray
    dof: np.ndarray


def with_freedom(sem: np.ndarray, u95: np.ndarray) -> StandardError:
    """Return the standard error and degrees of freedom that together give a known U95.

    Parameters
    ----------
    sem, u95
        Arrays of equal shape and unit.

    Returns
    -------
    StandardError
        ``t_0.975(dof) sem = u95``. The standard error is changed if no degrees of freedom fit: to
        ``u95/1.96`` (dof infinite) or ``u95/12.7`` (dof 1).

    Examples
    --------
    >>> found = with_freedom(np.array([1.0, 1.0]), np.array([2.776, 1.0]))
    >>> found.dof.round(2).tolist(), found.sem.round(2).tolist()
    ([4.0, inf], [1.0, 0.51])
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(sem > 0, u95 / sem, np.inf)
    dof = np.interp(-ratio, -_WIDTHS, _DOF)
    dof = np.where(ratio <= _WIDTHS[-1], np.inf, dof)
    width = np.where(np.isinf(dof), NORMAL, special.stdtrit(np.minimum(dof, 1e9), 0.975))
    return StandardError(np.where(np.isfinite(u95), u95 / width, np.nan), dof)


def coverage_of(dof: float) -> float:
    """Return the ratio of U95 to the standard error, for given degrees of freedom."""
    return NORMAL if np.isinf(dof) else float(special.stdtrit(dof, 0.975))
