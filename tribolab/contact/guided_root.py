"""Root search for expensive functions, guided by similar cheap ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

Functions = Callable[[np.ndarray, np.ndarray], np.ndarray]

_ROUGH, _FINE = 1e-4, 1e-11  # tolerances of the root: for the cheap and for the expensive function
_SLOPE_STEP = 1e-3  # step for the slope of the cheap function, as a share of the bracket
_SECANTS = 12


class Root(NamedTuple):
    """Roots of several functions (k), the function values there, and the number of steps."""

    x: np.ndarray
    value: np.ndarray
    steps: np.ndarray


def guided_root(
    expensive: Functions, cheap: Functions, low: np.ndarray, high: np.ndarray, iterations: int
) -> Root:
    """Return the root of each expensive function in an interval, guided by a cheap function.

    Parameters
    ----------
    expensive, cheap
        Called as ``expensive(x, which)`` with the indices of the functions; the last call of
        `expensive` is at its root.
    low, high
        Ends between which each function changes sign once (k).
    iterations
        Largest number of steps of each search.

    Returns
    -------
    Root
        A search has failed if its value is not nearly zero.

    Notes
    -----
    The root of the cheap function is bracketed [1]_. From there secants of the expensive function
    are used within the current bracket, the first with the slope of the cheap one. If they do not
    converge in a few steps, the root of the expensive function is bracketed, too.

    References
    ----------
    .. [1] T. R. Chandrupatla, Adv. Eng. Softw. 28, 145 (1997).
       doi:10.1016/S0965-9978(96)00051-8

    Examples
    --------
    >>> aim = np.array([2.0, 3.0])
    >>> root = guided_root(lambda x, k: x**2 - aim[k], lambda x, k: x**2 - 1.01 * aim[k],
    ...                    np.zeros(2), np.full(2, 9.0), 50)
    >>> root.x.round(6)
    array([1.414214, 1.732051])
    """
    every = np.arange(low.size)
    start, *_ = _find_bracketed(cheap, low, high, every, iterations, _ROUGH)
    outside = np.flatnonzero(np.isnan(start))  # the cheap root lies just outside the interval
    if outside.size:
        ends = np.array([low[outside], high[outside]])
        size = np.abs([cheap(end, outside) for end in ends])
        start[outside] = np.where(size[0] < size[1], *ends)
    side = _SLOPE_STEP * (high - low)
    aside = np.where(start + side > high, start - side, start + side)
    slope = (cheap(aside, every) - cheap(start, every)) / (aside - start)
    x, value, steps = _by_secants(expensive, start, slope, low, high, min(_SECANTS, iterations))
    lost = np.flatnonzero(~(np.abs(value) < _FINE))
    if lost.size:
        again = _find_bracketed(expensive, low[lost], high[lost], lost, iterations, _FINE)
        x[lost], steps[lost] = again.x, steps[lost] + again.steps
        value[lost] = expensive(x[lost], lost)
    return Root(x, value, steps)


def _find_bracketed(
    functions: Functions,
    low: np.ndarray,
    high: np.ndarray,
    which: np.ndarray,
    iterations: int,
    close: float,
) -> Root:
    """Return the root of each function between two ends, by Chandrupatla's method."""
    # imported late: scipy loads slowly
    from scipy.optimize.elementwise import find_root

    root = find_root(
        functions,
        (low, high),
        args=(which,),
        tolerances={"xatol": 0.0, "xrtol": 4e-16, "fatol": close, "frtol": 0.0},
        maxiter=iterations,
    )
    return Root(root.x, root.f_x, root.nit)


def _by_secants(
    functions: Functions,
    start: np.ndarray,
    slope: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    steps: int,
) -> Root:
    """Return roots found by the secant method, starting from points with known slopes."""
    x, low, high, slope = (part.copy() for part in (start, low, high, slope))
    value, taken = np.full_like(x, np.nan), np.zeros(x.size, dtype=int)
    todo = np.arange(x.size)
    for number in range(steps):
        before, known = x[todo], value[todo]
        if number:
            with np.errstate(divide="ignore", invalid="ignore"):
                aim = before - known / slope[todo]
            inside = (aim > low[todo]) & (aim < high[todo])
            x[todo] = np.where(inside, aim, (low[todo] + high[todo]) / 2)
        value[todo] = functions(x[todo], todo)
        taken[todo] += 1
        if number:
            with np.errstate(divide="ignore", invalid="ignore"):
                slope[todo] = (value[todo] - known) / (x[todo] - before)
        above = value[todo] > 0
        high[todo[above]], low[todo[~above]] = x[todo[above]], x[todo[~above]]
        todo = todo[~(np.abs(value[todo]) < _FINE)]
        if not todo.size:
            break
    return Root(x, value, taken)
