"""Random processes for the virtual rig: correlated noise and slow drift."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def slow_noise(
    rng: np.random.Generator, span: float, correlation: float
) -> Callable[[np.ndarray], np.ndarray]:
    """Return correlated noise of unit variance as a function that can be evaluated at any time.

    Parameters
    ----------
    rng
        Generator.
    span, correlation
        Length of the record and correlation length, in the same unit (time or distance).

    Returns
    -------
    callable
        The process at given moments: a first-order autoregression on knots an eighth of the
        correlation length apart, linear in between.
    """
    # imported late: scipy loads slowly
    from scipy.linalg import lapack

    step = correlation / 8
    knots = int(np.ceil(span / step)) + 2
    memory = np.exp(-1 / 8)
    kicks = rng.standard_normal(knots)
    kicks[1:] *= np.sqrt(1 - memory**2)
    # solves x_i - memory x_{i-1} = kick_i as a banded system
    recursion = np.vstack([np.ones(knots), np.full(knots, -memory)])
    values = lapack.dtbtrs(recursion, kicks[:, None], uplo="L", diag="U")[0][:, 0]
    grid = step * np.arange(knots)
    return lambda moments: np.interp(moments, grid, values)


def smooth_drift(rng: np.random.Generator, span: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return a smooth random drift, zero at the start, as a function of time.

    It is a sum of three cosines with half a period, one, and one and a half in the record.
    """
    amplitudes = rng.standard_normal(3) * np.sqrt(1 / 3)
    phases = rng.uniform(0, 2 * np.pi, 3)
    turns = np.array([0.5, 1.0, 1.5]) * 2 * np.pi / span

    def drift(moments: np.ndarray) -> np.ndarray:
        start = np.cos(phases) @ amplitudes  # the zero offset is drawn separately
        return np.cos(np.multiply.outer(moments, turns) + phases) @ amplitudes - start

    return drift
