"""Standard error of a fit if the errors of neighbouring points are correlated."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.core.coverage import NORMAL
from tribolab.fit import limits

_CORRELATION_GRID = np.array([0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.95])
_GROWTH_GRID = 1.35 ** np.arange(18)
# Prior of the points' errors: their stated size is correct with 90 % probability, and neighbours
# are then independent with 50 %. Stated errors that are too small usually omit errors common to
# a run: then neighbours are independent with 10 %. A correlation of 0.5 is hardly visible in 13
# residuals, whose slow variation the fit removes, but increases the error 1.6 times: a higher
# prior of independence would dominate. Values were chosen on simulated curves of 13 speeds for
# 95 % coverage with independent and with correlated errors of the stated size
# (tests/coverage/shear_stress_coverage.py).
_INDEPENDENCE_PRIORS = (0.5, 2.0), (0.1, 8.0)


class ResidualError(NamedTuple):
    """Standard error of the first parameter of a fit with correlated residuals.

    Parameters
    ----------
    error
        Standard error, in the parameter's unit.
    half_interval
        Half the 95 % interval.
    correlation
        Estimated correlation of the errors of neighbouring points [1].
    growth
        Estimated factor [1] by which the points' errors are too small.
    """

    error: float
    half_interval: float
    correlation: float
    growth: float


def residual_error(
    residual: np.ndarray,
    jacobian: np.ndarray,
    error: np.ndarray,
    position: np.ndarray,
    known: bool = True,
) -> ResidualError:
    """Return the error of a weighted least-squares fit whose residuals may be correlated.

    Parameters
    ----------
    residual
        Measured minus fitted (point).
    jacobian
        Derivatives of the fitted values by the parameters (point, parameter).
    error
        Standard errors of the points (point).
    position
        Increasing positions of the points, e.g. ln v (point).
    known
        Whether the size of `error` is known; else only the ratios of the errors are used.

    Notes
    -----
    The covariance of the points is ``s^2 e_i e_j rho^(|x_i - x_j|/d)``, with d the median spacing,
    on a grid of rho and s >= 1 (any s if the errors are unknown). The grid points are weighted by
    their
    restricted likelihood, ``|V|^-1/2 |J' V^-1 J|^-1/2 exp(-r' Q r/2)``, times their prior. The
    estimate is that with the points' own weights; its standard error under each V is averaged. For
    s = 1 the errors are known and the normal quantile is used, else Student's t.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> ones, x = np.ones((40, 1)), np.arange(40.0)
    >>> alone = residual_error(rng.standard_normal(40), ones, np.ones(40), x)
    >>> slow = np.sin(x / 8)
    >>> together = residual_error(slow - slow.mean(), ones, np.ones(40), x)
    >>> alone.correlation < 0.2, together.correlation > 0.6, together.error > 2 * alone.error
    (True, True, True)
    """
    scaled, jac = residual / error, jacobian / error[:, None]
    size = np.linalg.norm(jac, axis=0)
    jac = jac / size  # scaled columns give a well conditioned matrix
    apart = np.abs(position[:, None] - position)
    freedom = residual.size - jac.shape[1]
    growth = _GROWTH_GRID if known else np.concatenate([1 / _GROWTH_GRID[:0:-1], _GROWTH_GRID])
    prior = _prior(growth, known)
    weights = np.linalg.pinv(jac)[0]
    evidence, variance = np.empty(prior.shape), np.empty(_CORRELATION_GRID.size)
    spacing = float(np.median(np.diff(position))) or 1.0
    for i, rho in enumerate(_CORRELATION_GRID):
        together = np.eye(residual.size) if rho == 0 else rho ** (apart / spacing)
        lower = np.linalg.cholesky(together)
        white = np.linalg.solve(lower, np.column_stack([scaled, jac]))
        columns, _ = np.linalg.qr(white[:, 1:])
        left = white[:, 0] - columns @ (columns.T @ white[:, 0])
        volume = np.linalg.slogdet(white[:, 1:].T @ white[:, 1:])[1]
        volume += 2 * np.sum(np.log(np.diag(lower)))
        evidence[i] = -freedom * np.log(growth) - 0.5 * volume - 0.5 * left @ left / growth**2
        variance[i] = weights @ together @ weights
    with np.errstate(divide="ignore"):
        evidence = evidence + np.log(prior)
    share = np.exp(evidence - evidence.max())
    share /= share.sum()
    errors = share * np.sqrt(variance)[:, None] * growth / size[0]
    quantile = np.full(growth.size, special.stdtrit(freedom, 0.975))
    if known:
        quantile[growth == 1] = NORMAL
    return ResidualError(
        error=float(errors.sum()),
        half_interval=float((errors * quantile).sum()),
        correlation=float(share.sum(1) @ _CORRELATION_GRID),
        growth=float(share.sum(0) @ growth),
    )


def _prior(growth: np.ndarray, known: bool) -> np.ndarray:
    """Return the prior probability of each correlation and error growth (correlation, growth)."""
    by_correlation = []
    for independent, power in _INDEPENDENCE_PRIORS:
        some = np.where(_CORRELATION_GRID > 0, _CORRELATION_GRID**power, 0.0)
        alone = np.where(_CORRELATION_GRID == 0, independent, 0.0)
        by_correlation.append(alone + (1 - independent) * some / some.sum())
    if not known:
        return np.repeat(by_correlation[0][:, None] / growth.size, growth.size, axis=1)
    less = limits.PRIOR_RATIO_OF_GROWTH.value ** np.arange(growth.size - 1)
    return np.column_stack(
        [
            limits.PRIOR_OF_STATED_ERRORS.value * by_correlation[0],
            np.outer(
                by_correlation[1], (1 - limits.PRIOR_OF_STATED_ERRORS.value) * less / less.sum()
            ),
        ]
    )
