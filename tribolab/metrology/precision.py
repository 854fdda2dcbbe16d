"""Repeatability and reproducibility by ISO 5725-2: limits, and outlying laboratories."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from tribolab.core.aliases import Array

# 95 % limit of the difference between two single results, in standard deviations: 1.96 sqrt(2)
LIMIT = 2.8


def reproducibility_deviation(repeatability: float, between: ArrayLike) -> float:
    """Return the reproducibility s_R, from s_r and the deviations between laboratories or days.

    Examples
    --------
    >>> reproducibility_deviation(3.0, [4.0])
    5.0
    """
    return math.hypot(repeatability, *np.atleast_1d(np.asarray(between, dtype=float)))


def mandel(means: ArrayLike, deviations: ArrayLike) -> tuple[Array, Array]:
    """Return Mandel's h and k of each laboratory, mount or day.

    Parameters
    ----------
    means, deviations
        Mean and standard deviation of the results of each laboratory (laboratory).

    Returns
    -------
    tuple of numpy.ndarray
        h: deviation of each mean from the overall mean in standard deviations of the means; k: each
        standard deviation relative to the pooled one.

    Examples
    --------
    >>> h, k = mandel([1.0, 1.1, 1.5], [0.1, 0.1, 0.2])
    >>> h.round(2).tolist(), k.round(2).tolist()
    ([-0.76, -0.38, 1.13], [0.71, 0.71, 1.41])
    """
    mean, deviation = np.asarray(means, dtype=float), np.asarray(deviations, dtype=float)
    about = mean - mean.mean()
    spread, pooled = mean.std(ddof=1), np.sqrt(np.mean(deviation**2))
    h = about / spread if spread > 0 else np.zeros_like(mean)
    k = deviation / pooled if pooled > 0 else np.zeros_like(mean)
    return h, k


def mandel_limits(laboratories: int, results: int, level: float = 0.01) -> tuple[float, float]:
    """Return the critical values of Mandel's h (either sign) and k at a significance level.

    Parameters
    ----------
    laboratories
        Number of laboratories, three or more.
    results
        Number of results of each, two or more.
    level
        Significance level: ISO 5725-2 uses 5 % and 1 %.

    Examples
    --------
    >>> [round(limit, 2) for limit in mandel_limits(8, 2)]
    [2.06, 2.26]
    """
    p, n = laboratories, results
    t = float(-special.stdtrit(p - 2, level / 2))
    h = (p - 1) * t / math.sqrt(p * (t**2 + p - 2))
    f = float(special.fdtri(n - 1, (p - 1) * (n - 1), 1 - level))
    return h, math.sqrt(p / (1 + (p - 1) / f))
