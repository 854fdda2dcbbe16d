"""Variance components of unbalanced or nested data, by restricted maximum likelihood."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import linalg, optimize

from tribolab.core.aliases import Array
from tribolab.core.errors import AnalysisError

# starting values of the variance ratios, several because the likelihood can have several maxima
_STARTS = (0.1, 2.0)
_LARGEST = 1e6  # upper bound of the variance ratios


@dataclass(frozen=True)
class Components:
    """Variances of the factors and of the residual, and the estimated fixed effects."""

    factors: tuple[float, ...]
    residual: float
    effects: Array
    log_likelihood: float


def variance_components(
    values: ArrayLike, factors: Sequence[ArrayLike], fixed: ArrayLike | None = None
) -> Components:
    """Return the variance components of values with one or more random factors.

    Parameters
    ----------
    values
        (observation)
    factors
        Level of each observation, for each factor (observation); a factor nested in another has
        distinct levels in each level of the other.
    fixed
        Groups with separate means (observation), e.g. conditions; by default there is one mean.

    Raises
    ------
    AnalysisError
        If no degrees of freedom remain for the variances.

    Notes ----- With V = 1 + sum of gamma_j Z_j Z_j', the restricted likelihood is maximised over
    the ratios of variances gamma_j >= 0, with dense matrices; the residual variance and the means
    follow from them [1]_. For balanced data this is the analysis of variance, if none of its
    components is negative.

    References
    ----------
    .. [1] Patterson and Thompson (1971), Biometrika 58, 545-554. doi:10.1093/biomet/58.3.545

    Examples
    --------
    >>> laboratory = ["a", "a", "b", "b", "c", "c"]
    >>> parts = variance_components([1.0, 1.2, 2.0, 2.2, 3.0, 3.2], [laboratory])
    >>> round(parts.residual, 3), round(parts.factors[0], 3)
    (0.02, 0.99)
    """
    y = np.asarray(values, dtype=float)
    groups = np.zeros(y.size) if fixed is None else np.asarray(fixed)
    x = _indicators(groups)
    left = y.size - x.shape[1]
    if left < 1 + len(factors) or not np.isfinite(y).all():
        raise AnalysisError(
            f"{y.size} values in {x.shape[1]} groups are too few to tell {len(factors) + 1} "
            "variances apart"
        )
    parts = [z @ z.T for z in map(_indicators, factors)]
    scale = float(np.var(y)) or 1.0
    bounds = optimize.Bounds(np.zeros(len(parts)), np.full(len(parts), _LARGEST))

    def loss_at(ratios: NDArray[np.float64]) -> float:
        return _solve(y / np.sqrt(scale), x, parts, ratios)[0]

    best: optimize.OptimizeResult | None = None
    for start in itertools.product(_STARTS, repeat=len(parts)):
        first = np.array(start, dtype=np.float64)
        tried = optimize.minimize(loss_at, first, method="L-BFGS-B", bounds=bounds, tol=1e-12)
        if best is None or tried.fun < best.fun:
            best = tried
    ratios = np.zeros(0) if best is None else np.asarray(best.x)
    loss, residual, effects = _solve(y / np.sqrt(scale), x, parts, ratios)
    return Components(
        tuple(float(ratio * residual * scale) for ratio in ratios),
        float(residual * scale),
        effects * np.sqrt(scale),
        -loss,
    )


def _indicators(levels: ArrayLike) -> Array:
    """Return a matrix that is 1 at the level (column) of each observation (row)."""
    _, codes = np.unique(np.asarray(levels), return_inverse=True)
    return np.eye(int(codes.max()) + 1)[codes]


def _solve(y: Array, x: Array, parts: Sequence[Array], ratios: Array) -> tuple[float, float, Array]:
    """Return minus the restricted log-likelihood, residual variance and means, for given ratios."""
    covariance = np.eye(y.size)
    for ratio, part in zip(ratios, parts, strict=True):
        covariance += ratio * part
    factor = linalg.cholesky(covariance, lower=True)
    white_x = linalg.solve_triangular(factor, x, lower=True)
    white_y = linalg.solve_triangular(factor, y, lower=True)
    information = white_x.T @ white_x
    effects = np.linalg.solve(information, white_x.T @ white_y)
    rest = white_y - white_x @ effects
    left = y.size - x.shape[1]
    residual = float(rest @ rest) / left
    loss = 0.5 * (
        left * np.log(max(residual, 1e-300))
        + 2 * np.log(np.diag(factor)).sum()
        + np.linalg.slogdet(information)[1]
    )
    return float(loss), residual, np.asarray(effects, dtype=float)
