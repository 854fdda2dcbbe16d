"""The posterior of a joint fit: normal for each size of the shared errors, mixed by evidence."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import linalg, special

from tribolab.errors import AnalysisError
from tribolab.fit.joint.model import JointModel, Shared, shared_errors
from tribolab.fit.joint.priors import JointPriors

# Sizes of shared errors over the scale of their priors. Wider ones are tried where much of the
# weight lies at the end, as where the model does not describe the curves.
_LEVELS = np.array([0.06, 0.25, 0.5, 0.8, 1.2, 1.8, 2.6])
_CORRELATED = np.array([0.06, 0.3, 0.6, 1.0, 1.5, 2.3])
_AT_END = 0.2
_WIDENINGS = 5
_STEPS = 200
_HOPELESS = 25.0  # of ln of odds
_CLOSE = 1e-6  # of the decrement: a thousandth of a standard deviation
_CLOSE_ENOUGH = 1e-2  # of one that creeps
_COUNTS = 1e-4  # share of a mode that is looked at twice


class Posterior(NamedTuple):
    """A mixture of normal distributions of the parameters.

    Parameters
    ----------
    weight, level, correlated
        Share of each component [1], and the sizes tau and kappa of its shared errors (component).
    mean, covariance
        Of the parameters (component, parameter), (component, parameter, parameter).
    log_evidence
        ln of the probability density of the points ln mu.
    """

    weight: np.ndarray
    level: np.ndarray
    correlated: np.ndarray
    mean: np.ndarray
    covariance: np.ndarray
    log_evidence: float

    @property
    def centre(self) -> np.ndarray:
        """Mean of the parameters (parameter)."""
        return self.weight @ self.mean

    @property
    def spread(self) -> np.ndarray:
        """Covariance of the parameters (parameter, parameter): within components, and between."""
        off = self.mean - self.centre
        between = np.einsum("c,ci,cj->ij", self.weight, off, off)
        return np.einsum("c,cij->ij", self.weight, self.covariance) + between

    def quantile(self, probability: float) -> np.ndarray:
        """Return the quantile of each parameter's marginal (parameter)."""
        deviation = np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2))
        return mixture_quantile(self.weight, self.mean, deviation, probability)

    def shared_quantile(self, which: str, probability: float) -> float:
        """Return the quantile of "level" or "correlated", linear between the sizes tried."""
        sizes = getattr(self, which)
        values, place = np.unique(sizes, return_inverse=True)
        share = np.bincount(place, self.weight)
        edges = np.r_[0.0, (values[1:] + values[:-1]) / 2, values[-1] * 1.2]
        return float(np.interp(probability, np.r_[0.0, np.cumsum(share)], edges))


def mixture_quantile(
    weight: np.ndarray, mean: np.ndarray, deviation: np.ndarray, probability: float
) -> np.ndarray:
    """Return quantiles of mixtures of normals: weight (component), the rest (component, any).

    Examples
    --------
    >>> ones = np.ones((2, 1))
    >>> mixture_quantile(np.array([0.5, 0.5]), 0 * ones, ones, 0.975).round(3).tolist()
    [1.96]
    """
    reach = 1.0 + abs(float(special.ndtri(probability)))
    low = (mean - reach * deviation).min(axis=0)
    high = (mean + reach * deviation).max(axis=0)
    deviation = np.maximum(deviation, 1e-300)
    for _ in range(50):  # bisection, of all at once
        middle = (low + high) / 2
        below = weight @ special.ndtr((middle - mean) / deviation) < probability
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return (low + high) / 2


def posterior_of(model: JointModel, priors: JointPriors, start: np.ndarray) -> Posterior:
    """Return the posterior of a model's parameters.

    Parameters
    ----------
    model
        With its points.
    priors
        Of the shared errors; those of the parameters are in the model.
    start
        Where to look for the most probable parameters (parameter).

    Raises
    ------
    AnalysisError
        If the most probable parameters cannot be found.

    Notes
    -----
    Covariance of the points' ln mu ``diag(s^2) + tau^2 B + kappa^2 K``, see `shared_errors`. For
    each tau and kappa of a grid the most probable parameters by Gauss-Newton, their covariance
    ``(J' V^-1 J + P)^-1`` and the evidence by Laplace's approximation [1]_; the grid's points are
    mixed by evidence times their share of the prior.

    References
    ----------
    .. [1] H. Rue, S. Martino, N. Chopin, J. R. Stat. Soc. B 71, 319 (2009).
       doi:10.1111/j.1467-9868.2008.00700.x
    """
    shared = shared_errors(model.points, model.points, priors.correlation_length)
    widths = np.ones(2)
    for _ in range(_WIDENINGS + 1):
        level = widths[0] * priors.level * _LEVELS
        correlated = widths[1] * priors.correlated * _CORRELATED
        modes = _modes(model, shared, level, correlated, start)
        chance = np.array([mode.log_evidence for mode in modes])
        sizes = np.array([[mode.level, mode.correlated] for mode in modes]).T
        for size, grid, scale in zip(
            sizes, (level, correlated), (priors.level, priors.correlated), strict=True
        ):
            chance += _log_share(grid, scale)[np.searchsorted(grid, size)]
        log_evidence = float(special.logsumexp(chance))
        weight = np.exp(chance - log_evidence)
        at_end = np.array([weight[sizes[k] == grid[-1]].sum()
                           for k, grid in enumerate((level, correlated))]) > _AT_END  # fmt: skip
        if not at_end.any():
            break
        widths = np.where(at_end, 2 * widths, widths)
    left = np.array([mode.left for mode in modes])
    if (left[weight > _COUNTS] > _CLOSE_ENOUGH).any():
        raise AnalysisError("the most probable parameters are not found; take fewer curves")
    return Posterior(
        weight,
        sizes[0],
        sizes[1],
        np.array([mode.theta for mode in modes]),
        np.array([mode.covariance for mode in modes]),
        log_evidence,
    )


class _Mode(NamedTuple):
    """The most probable parameters at some sizes of shared errors, their covariance, evidence.

    The search for a mode far from all others may creep: what it would still gain is `left`.
    """

    level: float
    correlated: float
    theta: np.ndarray
    covariance: np.ndarray
    log_evidence: float
    left: float


def _log_share(size: np.ndarray, scale: float) -> np.ndarray:
    """Return ln of Rayleigh's mass between the middles of neighbouring sizes.

    Examples
    --------
    >>> round(float(np.exp(_log_share(np.array([0.5, 1.0, 2.0]), 1.0)).sum()), 12)
    1.0
    """
    edges = np.r_[0.0, (size[1:] + size[:-1]) / 2, np.inf] / scale
    below = np.exp(-np.diff(edges**2) / 2)
    return -(edges[:-1] ** 2) / 2 + np.log1p(-below)


def _modes(
    model: JointModel,
    shared: Shared,
    level: np.ndarray,
    correlated: np.ndarray,
    start: np.ndarray,
) -> list[_Mode]:
    """Return the modes for all sizes of shared errors that are not out of the question.

    The largest first: where much may be shared the mode is easily found, and near it the next.
    """
    modes: list[_Mode] = []
    alone = np.diag(model.points.error**2)
    for tau in level[::-1]:
        first, most = start, -np.inf
        for kappa in correlated[::-1]:
            covariance = alone + tau**2 * shared.level + kappa**2 * shared.near
            mode = _mode(model, covariance, first)._replace(level=tau, correlated=kappa)
            modes.append(mode)
            first, most = mode.theta, max(most, mode.log_evidence)
            if kappa == correlated[-1]:
                start = first
            if mode.log_evidence + mode.left < most - _HOPELESS:
                break  # with less shared it is worse still
    return modes


def _mode(model: JointModel, covariance: np.ndarray, start: np.ndarray) -> _Mode:
    """Find the most probable parameters by Gauss-Newton with a step that is halved."""
    where = model.parameters
    free = where.spread > 0
    lower = linalg.cholesky(covariance, lower=True)
    target = linalg.solve_triangular(lower, model.points.log_friction, lower=True)
    scale = where.spread[free]

    def looked_at(theta: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        value, slopes = model.predicted(theta)
        both = linalg.solve_triangular(lower, np.column_stack([value, slopes[:, free]]), lower=True)
        residual, off = target - both[:, 0], (theta - where.mean)[free] / scale
        return residual, both[:, 1:], off, float(residual @ residual + off @ off)

    theta, left = np.where(free, start, where.mean), 0.0
    residual, jacobian, off, size = looked_at(theta)
    for _ in range(_STEPS):
        normal = jacobian.T @ jacobian + np.diag(scale**-2.0)
        uphill = jacobian.T @ residual - off / scale
        factor = linalg.cho_factor(normal)
        step = np.zeros(theta.size)
        step[free] = linalg.cho_solve(factor, uphill)
        if uphill @ step[free] < _CLOSE:
            theta = theta + step
            break
        for halving in range(30):
            trial = theta + step / 2.0**halving
            looked = looked_at(trial)
            if looked[-1] < size:
                break
        else:
            break  # the rounding of the sums is reached
        theta, (residual, jacobian, off, size) = trial, looked
    else:
        left = float(uphill @ step[free])
    spread = np.zeros((theta.size, theta.size))
    spread[np.ix_(free, free)] = linalg.cho_solve(factor, np.eye(scale.size))
    log_evidence = (
        -0.5 * size
        - 0.5 * residual.size * np.log(2 * np.pi)
        - np.log(np.diag(lower)).sum()
        - np.log(scale).sum()
        - np.log(np.diag(factor[0])).sum()
    )
    return _Mode(np.nan, np.nan, theta, spread, float(log_evidence), left)
