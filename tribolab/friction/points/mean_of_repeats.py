"""Mean of a few repeats whose errors differ and whose scatter is poorly known.

Notes
-----
The rule depends on the number k of repeats and the ratio R of their largest to their smallest
error, but not on the values, which would bias the choice. For k = 2 or R up to 5: the plain mean
with Student's t of k - 1 degrees of freedom. Else the scatter tau between repeats is integrated
out: with the reference prior [1]_, or, if the scatter of repeats under other conditions is known
with enough degrees of freedom, with a half-Cauchy-like prior of that scale. The latter is used for
any k, because two repeats alone hardly determine their scatter.

References
----------
.. [1] Bodnar, Link, Arendacka, Possolo and Elster (2017), Stat. Med. 36, 378-399.
   doi:10.1002/sim.7156
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.core.coverage import NORMAL
from tribolab.friction.points import limits

_SCATTER_GRID = np.concatenate([[0.0], np.geomspace(0.01, 1000.0, 110)])
_BISECTIONS = 60


class Mean(NamedTuple):
    """A mean, its standard error, and U95 (95 % coverage); all in the unit of the values."""

    mean: float
    sem: float
    u95: float


class Pooled(NamedTuple):
    """Relative scatter of repeats under other conditions, and its degrees of freedom."""

    scatter: float
    dof: float


def mean_of_repeats(values: np.ndarray, errors: np.ndarray, pooled: Pooled | None = None) -> Mean:
    """Return the mean of repeats with its standard error and U95.

    Parameters
    ----------
    values
        Values of two repeats or more.
    errors
        Their own standard errors, in the unit of the values; an unknown one is set to the others'
        median.
    pooled
        Scatter of repeats under other conditions, if known.

    Examples
    --------
    >>> found = mean_of_repeats(np.array([0.30, 0.31]), np.array([0.001, 0.001]))
    >>> round(found.mean, 3), round(found.u95, 3)
    (0.305, 0.064)
    >>> known = Pooled(0.02, 8.0)
    >>> found = mean_of_repeats(np.array([0.30, 0.31]), np.array([0.001, 0.001]), known)
    >>> round(found.mean, 3), 0.01 < found.u95 < 0.03
    (0.305, True)
    """
    k = values.size
    fine = np.isfinite(errors) & (errors > 0)
    known = pooled if pooled is not None and pooled.dof >= limits.POOLED_DOF.value else None
    spread = errors[fine].max() / errors[fine].min() if fine.any() else 1.0
    plain = k == 2 or spread <= limits.UNEQUAL_ERRORS.value or not fine.any()
    scale = 0.0 if known is None else known.scatter * abs(float(values.mean()))
    if scale > 0 and fine.any():
        own = np.where(fine, errors, np.median(errors[fine]))
        return _integrated(values, own, limits.PRIOR_WIDTH.value * scale)
    if plain:
        sem = float(values.std(ddof=1) / np.sqrt(k))
        u95 = float(special.stdtrit(k - 1, 0.975)) * sem
        # repeats that agree better than their own errors do so by chance
        own_sem = float(np.sqrt((errors[fine] ** 2).sum()) / fine.sum()) if fine.any() else 0.0
        if NORMAL * own_sem > u95:
            return Mean(float(values.mean()), own_sem, NORMAL * own_sem)
        return Mean(float(values.mean()), sem, u95)
    own = np.where(fine, errors, np.median(errors[fine]))
    return _integrated(values, own, None)


def _integrated(y: np.ndarray, s: np.ndarray, scale: float | None) -> Mean:
    """Return the mean of repeats, averaged over the possible scatter between them (Bayesian)."""
    size = float(np.sqrt(np.median(s**2) + y.var()))
    tau = _SCATTER_GRID * size
    w = 1 / (s**2 + tau[:, None] ** 2)
    s1 = w.sum(axis=1)
    m = (w @ y) / s1
    squares = (w * (y - m[:, None]) ** 2).sum(axis=1)
    likely = 0.5 * np.log(w).sum(axis=1) - 0.5 * np.log(s1) - 0.5 * squares
    if scale is None:
        s2, s3 = (w**2).sum(axis=1), (w**3).sum(axis=1)
        information = s2 - 2 * s3 / s1 + (s2 / s1) ** 2
        with np.errstate(divide="ignore"):
            likely += 0.5 * np.log(np.maximum(information, 1e-300)) + np.log(tau)
    else:
        likely -= np.log1p((tau / scale) ** 2)
    middles = np.concatenate([tau[:1], (tau[1:] + tau[:-1]) / 2, tau[-1:]])
    weight = np.exp(likely - likely.max()) * np.diff(middles)
    weight /= weight.sum()
    mean = float(weight @ m)
    off, width = m - mean, np.sqrt(1 / s1)
    sem, u95 = (_half_width(weight, off, width, out) for out in (_ONE_SIGMA, 0.05))
    return Mean(mean, sem, u95)


_ONE_SIGMA = float(2 * special.ndtr(-1.0))


def _half_width(weight: np.ndarray, off: np.ndarray, width: np.ndarray, out: float) -> float:
    """Return x such that a mixture of normal distributions exceeds ±x with probability `out`."""
    low, high = 0.0, float(np.abs(off).max() + 12 * width.max())
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        outside = special.ndtr((-middle - off) / width) + special.ndtr((off - middle) / width)
        if weight @ outside > out:
            low = middle
        else:
            high = middle
    return high


def pooled_scatter(groups: list[np.ndarray]) -> Pooled:
    """Return the relative scatter of repeats pooled over conditions, and its degrees of freedom.

    Parameters
    ----------
    groups
        Values of the repeats of each condition; a single value does not contribute.

    Examples
    --------
    >>> pooled_scatter([np.array([1.0, 1.02]), np.array([0.5, 0.51]), np.array([2.0])]).dof
    2.0
    """
    logs = [np.log(values) for values in groups if values.size > 1 and (values > 0).all()]
    dof = float(sum(values.size - 1 for values in logs))
    if not dof:
        return Pooled(0.0, 0.0)
    squares = sum(float(((values - values.mean()) ** 2).sum()) for values in logs)
    return Pooled(float(np.sqrt(squares / dof)), dof)


def pooled_between_runs(table: np.ndarray) -> Pooled:
    """Return the relative scatter between the runs of one system, pooled over speeds.

    Parameters
    ----------
    table
        Logarithms of friction (run, speed), NaN if a run lacks a speed.

    Notes
    -----
    Runs differ by an offset that all speeds share (a mount, a specimen), and from speed to speed.
    The variance of one run at one speed is the sum of both. Its degrees of freedom are those of
    Satterthwaite: near (k - 1) n without an offset, and k - 1 if the offset is all there is [2]_.

    References
    ----------
    .. [2] Satterthwaite (1946), Biometrics Bull. 2, 110-114. doi:10.2307/3002019

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> apart = 0.01 * rng.standard_normal((3, 12))
    >>> pooled_between_runs(apart).dof > 15, pooled_between_runs(apart + [[0], [1], [2]]).dof < 2.1
    (True, True)
    """
    common = table[:, np.isfinite(table).all(axis=0)]
    runs, speeds = common.shape
    if runs < 2 or not speeds:
        return Pooled(0.0, 0.0)
    rows, columns = common.mean(axis=1), common.mean(axis=0)
    of_runs = float(rows.var(ddof=1))  # variance of offsets, plus 1/n of that from speed to speed
    if speeds == 1:
        return Pooled(float(np.sqrt(of_runs)), runs - 1.0)
    rest = common - rows[:, None] - columns + common.mean()
    freedom = (runs - 1.0) * (speeds - 1.0)
    of_speeds = float((rest**2).sum() / freedom) * (1 - 1 / speeds)
    whole = of_runs + of_speeds
    if not whole > 0:
        return Pooled(0.0, 0.0)
    dof = whole**2 / (of_runs**2 / (runs - 1) + of_speeds**2 / freedom)
    return Pooled(float(np.sqrt(whole)), float(dof))
