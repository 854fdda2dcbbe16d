"""Posterior of a joint fit: a mixture of normal distributions, weighted by evidence."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.core.errors import AnalysisError
from tribolab.fit.joint.model import JointModel, shared_by_points
from tribolab.fit.joint.modes import modes_of
from tribolab.fit.joint.priors import JointPriors

# Sizes of the shared errors, relative to the scale of their priors. The grid is widened if much
# weight is at its end, e.g. if the model does not describe the curves.
_LEVEL_GRID = np.array([0.06, 0.25, 0.5, 0.8, 1.2, 1.8, 2.6])
_CORRELATED_GRID = np.array([0.06, 0.3, 0.6, 1.0, 1.5, 2.3])
_MAX_WEIGHT_AT_END = 0.2
_MAX_WIDENINGS = 5
_MAX_DECREMENT = 1e-2  # largest remaining gain of a mode that converges slowly
_MIN_MODE_WEIGHT = 1e-4  # weight above which a mode must have converged


class Posterior(NamedTuple):
    """Mixture of normal distributions of the parameters.

    Parameters
    ----------
    weight, level, correlated
        Weight of each component [1], and the sizes tau and kappa of its shared errors (component).
    mean, covariance
        Mean and covariance of the parameters (component, parameter[, parameter]).
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
        """Posterior mean of the parameters (parameter)."""
        return self.weight @ self.mean

    @property
    def spread(self) -> np.ndarray:
        """Posterior covariance of the parameters (parameter, parameter)."""
        off = self.mean - self.centre
        between = np.einsum("c,ci,cj->ij", self.weight, off, off)
        return np.einsum("c,cij->ij", self.weight, self.covariance) + between

    def quantile(self, probability: float) -> np.ndarray:
        """Return a quantile of the marginal distribution of each parameter (parameter)."""
        deviation = np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2))
        return mixture_quantile(self.weight, self.mean, deviation, probability)

    def shared_quantile(self, which: str, probability: float) -> float:
        """Return a quantile of the size of "level" or "correlated" errors, by interpolation."""
        sizes = getattr(self, which)
        values, index = np.unique(sizes, return_inverse=True)
        share = np.bincount(index, self.weight)
        edges = np.r_[0.0, (values[1:] + values[:-1]) / 2, values[-1] * 1.2]
        return float(np.interp(probability, np.r_[0.0, np.cumsum(share)], edges))


def mixture_quantile(
    weight: np.ndarray, mean: np.ndarray, deviation: np.ndarray, probability: float
) -> np.ndarray:
    """Return quantiles of mixtures of normal distributions (component, ...).

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
    for _ in range(50):  # bisection of all quantiles together
        middle = (low + high) / 2
        below = weight @ special.ndtr((middle - mean) / deviation) < probability
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return (low + high) / 2


def posterior_of(model: JointModel, priors: JointPriors, start: np.ndarray) -> Posterior:
    """Return the posterior of the parameters of a model.

    Parameters
    ----------
    model
        Model with its points.
    priors
        Priors of the shared errors; those of the parameters are in the model.
    start
        Starting values of the parameters (parameter).

    Raises
    ------
    AnalysisError
        If the most probable parameters cannot be found.

    Notes
    -----
    The covariance of the points' ln mu is ``diag(s^2) + tau^2 B + kappa^2 K``, see
    `shared_by_points`. For each tau and kappa of a grid, the most probable parameters are found by
    Gauss-Newton, with their covariance ``(J' V^-1 J + P)^-1`` and the evidence in Laplace's
    approximation [1]_. The grid points are weighted by evidence times prior.

    References
    ----------
    .. [1] H. Rue, S. Martino, N. Chopin, J. R. Stat. Soc. B 71, 319 (2009).
       doi:10.1111/j.1467-9868.2008.00700.x
    """
    shared = shared_by_points(model.points, model.points, priors.correlation_length)
    widths = np.ones(2)
    for _ in range(_MAX_WIDENINGS + 1):
        level = widths[0] * priors.level * _LEVEL_GRID
        correlated = widths[1] * priors.correlated * _CORRELATED_GRID
        sizes = np.stack(np.meshgrid(level, correlated, indexing="ij")).reshape(2, -1)
        shares = _log_prior(level, priors.level), _log_prior(correlated, priors.correlated)
        before = np.add.outer(*shares).ravel()
        modes = modes_of(model, shared, sizes, before, start)
        chance = modes.log_evidence + before
        log_evidence = float(special.logsumexp(chance))
        weight = np.exp(chance - log_evidence)
        ends = [weight[sizes[k] == grid[-1]].sum() for k, grid in enumerate((level, correlated))]
        at_end = np.array(ends) > _MAX_WEIGHT_AT_END
        if not at_end.any():
            break
        widths = np.where(at_end, 2 * widths, widths)
    if (modes.left[weight > _MIN_MODE_WEIGHT] > _MAX_DECREMENT).any():
        raise AnalysisError("the most probable parameters are not found; take fewer curves")
    return Posterior(weight, sizes[0], sizes[1], modes.theta, modes.covariance, log_evidence)


def _log_prior(size: np.ndarray, scale: float) -> np.ndarray:
    """Return ln of the Rayleigh probability of the interval around each size of a grid.

    Examples
    --------
    >>> round(float(np.exp(_log_prior(np.array([0.5, 1.0, 2.0]), 1.0)).sum()), 12)
    1.0
    """
    edges = np.r_[0.0, (size[1:] + size[:-1]) / 2, np.inf] / scale
    below = np.exp(-np.diff(edges**2) / 2)
    return -(edges[:-1] ** 2) / 2 + np.log1p(-below)
