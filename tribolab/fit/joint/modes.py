"""Most probable parameters of a joint fit, for many assumed sizes of the shared errors at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import lapack

from tribolab.core.errors import AnalysisError
from tribolab.fit.joint.model import JointModel, Shared

_MAX_STEPS = 200
_NEGLIGIBLE_LN_ODDS = 25.0  # ln(odds) against the best mode above which a search ends
_CONVERGED_DECREMENT = 1e-6  # gain in log probability of a converged mode: 1e-3 standard deviations
_MAX_GAIN = 10.0  # largest remaining gain of a search, relative to that expected of its next step
_MIN_GAIN = 0.5  # share of the expected gain below which a shorter step is tried
# shares of a Newton step that are tried; the second set only if none of the first is better
_STEP_SHARES = (
    (0.5, 0.25, 0.12, 0.03),
    (1e-2, 1e-3, 1e-4, 1e-6, 1e-8),
)


class PosteriorModes(NamedTuple):
    """Most probable parameters for each size of shared errors, with covariance and evidence.

    The search for a mode may be stopped early, or converge slowly: `left` is the gain in log
    probability that it may still make.
    """

    theta: np.ndarray
    covariance: np.ndarray
    log_evidence: np.ndarray
    left: np.ndarray


def modes_of(
    model: JointModel, shared: Shared, sizes: np.ndarray, before: np.ndarray, start: np.ndarray
) -> PosteriorModes:
    """Return the modes for given sizes of shared errors (level and correlated, mode).

    `before` is the log prior of each (mode). The mode of the largest sizes, which is easily found,
    is the start for all others, which are computed at once.
    """
    alone = np.diag(model.points.error**2)
    white = np.array(
        [_whitening(alone + t**2 * shared.level + k**2 * shared.near) for t, k in sizes.T]
    )
    largest = _find_modes(model, white[-1:], before[-1:], start[None])
    return _find_modes(model, white, before, np.repeat(largest.theta, len(white), axis=0))


def _whitening(covariance: np.ndarray) -> np.ndarray:
    """Return the whitening matrix L^-1, where L L^T is the covariance."""
    lower, failed = lapack.dpotrf(covariance, lower=True)
    if failed:
        raise AnalysisError("the points' covariance is singular: two of them are one")
    inverse, _ = lapack.dtrtri(lower, lower=True)
    return np.asarray(inverse)


class _State(NamedTuple):
    """Residuals and derivatives at some parameters, in units of the errors (mode)."""

    theta: np.ndarray
    residual: np.ndarray  # (mode, point)
    jacobian: np.ndarray  # (mode, point, free parameter)
    off: np.ndarray  # deviation from the prior in its standard deviations (mode, free parameter)
    size: np.ndarray  # sum of squares of residual and off

    def at(self, which: np.ndarray) -> _State:
        """Return the state of some modes."""
        return _State(*(part[which] for part in self))

    def put(self, which: np.ndarray, other: _State) -> None:
        """Replace the state of some modes."""
        for mine, part in zip(self, other, strict=True):
            mine[which] = part


def _evaluate(model: JointModel, white: np.ndarray, theta: np.ndarray) -> _State:
    where = model.parameters
    free = where.spread > 0
    value, slopes = model.predicted(theta)
    off = (theta - where.mean)[:, free] / where.spread[free]
    residual = (white @ (model.points.log_friction - value)[..., None])[..., 0]
    size = (residual**2).sum(axis=1) + (off**2).sum(axis=1)
    return _State(theta, residual, white @ slopes[..., free], off, size)


def _find_modes(
    model: JointModel, white: np.ndarray, before: np.ndarray, start: np.ndarray
) -> PosteriorModes:
    """Find the most probable parameters by Gauss-Newton, stopping at modes of negligible weight."""
    where = model.parameters
    free = where.spread > 0
    scale = where.spread[free]
    state = _evaluate(model, white, np.where(free, start, where.mean))
    constant = np.log(np.diagonal(white, axis1=1, axis2=2)).sum(axis=1) - np.log(scale).sum()
    constant -= 0.5 * state.residual.shape[1] * np.log(2 * np.pi)
    evidence, left = np.empty(len(white)), np.zeros(len(white))
    normal = np.empty((len(white), scale.size, scale.size))
    todo = np.arange(len(white))
    for number in range(_MAX_STEPS):
        now = state.at(todo)
        normal[todo] = now.jacobian.transpose(0, 2, 1) @ now.jacobian + np.diag(scale**-2.0)
        uphill = (now.residual[:, None] @ now.jacobian)[:, 0] - now.off / scale
        step = np.zeros_like(now.theta)
        step[:, free] = np.linalg.solve(normal[todo], uphill[..., None])[..., 0]
        left[todo] = (uphill * step[:, free]).sum(axis=1)
        volume = np.linalg.slogdet(normal[todo])[1]
        evidence[todo] = constant[todo] - 0.5 * (now.size + volume)
        close = left[todo] < _CONVERGED_DECREMENT
        state.theta[todo[close]] += step[close]
        left[todo[close]] = 0.0
        chance = evidence + before
        hopeless = chance[todo] + _MAX_GAIN * left[todo] < chance.max() - _NEGLIGIBLE_LN_ODDS
        going = ~(close | (hopeless & (number > 0)))
        todo, step = todo[going], step[going]
        if not todo.size:
            break
        stuck = _take_step(model, white, state, todo, step, left[todo])
        left[todo[stuck]] = 0.0  # rounding prevents any further gain
        todo = todo[~stuck]
    spread = np.zeros((*start.shape, start.shape[1]))
    spread[:, free[:, None] & free] = np.linalg.inv(normal).reshape(len(white), -1)
    return PosteriorModes(state.theta, spread, evidence, left)


def _take_step(
    model: JointModel,
    white: np.ndarray,
    state: _State,
    which: np.ndarray,
    step: np.ndarray,
    expected: np.ndarray,
) -> np.ndarray:
    """Move some modes by a step or a share of it; return which of them could not be improved."""
    before, white = state.at(which), white[which]
    best = _evaluate(model, white, before.theta + step)
    # if the gain is much less than expected, the full step is too long
    short = np.flatnonzero(before.size - best.size < _MIN_GAIN * expected)
    for parts in _STEP_SHARES:
        if not short.size:
            break
        tried = [
            _evaluate(model, white[short], before.theta[short] + part * step[short])
            for part in parts
        ]
        for other in tried:
            better = other.size < best.size[short]
            best.put(short[better], other.at(better))
        short = short[best.size[short] >= before.size[short]]
    stuck = best.size >= before.size
    state.put(which[~stuck], best.at(~stuck))
    return np.asarray(stuck)
