"""Permutation and rotation tests of two groups of runs at many points."""

from __future__ import annotations

import functools
import itertools
import math

import numpy as np
from numpy.typing import NDArray
from scipy import special

from tribolab.core.aliases import Array

_MIN_RUNS = 4  # fewest runs per group for a permutation test
MOST_ROTATED = 40  # most runs of both groups together for a rotation test
_DRAWS, _FEW_DRAWS = 4999, 1999  # random draws; fewer suffice for levels from _FEW_LEVEL on
_FEW_LEVEL = 0.005
_EXHAUSTIVE = 5000  # number of permutations up to which all of them are used
_MIN_SHARE = 0.8  # share of the significance level that permutations must be able to reach
_ROUNDING = 1e-9  # relative tolerance, so that rounding does not separate a draw from the data


def permutations_will_do(first: int, second: int, level: float) -> bool:
    """Return whether there are enough permutations of the runs for a significance level.

    Two groups of four runs have 70 permutations, which are equal in pairs. The possible levels are
    multiples of 2/70, and the largest below 5 % is 2.9 %.

    Examples
    --------
    >>> permutations_will_do(5, 5, 0.05), permutations_will_do(4, 4, 0.05)
    (True, False)
    """
    if min(first, second) < _MIN_RUNS:
        return False
    step = (2 if first == second else 1) / math.comb(first + second, first)
    return math.floor(level / step * (1 + _ROUNDING)) * step >= _MIN_SHARE * level


def permutation_test(
    first: Array, second: Array, terms: Array, scores: Array, level: float, seed: int
) -> tuple[Array, Array]:
    r"""Return adjusted p values, and the factor of simultaneous intervals, by permutation of runs.

    Parameters
    ----------
    first, second
        Values of the runs of both groups (run, point); NaN for missing values.
    terms
        Errors not in the scatter of the runs: signed standard uncertainties, each fully
        correlated between points (term, point).
    scores
        Differences divided by their standard errors (point).
    level
        Error rate of all points together.
    seed
        Seed of the draws.

    Notes
    -----
    Whole runs are permuted between groups, which preserves the correlation between points of a run;
    the largest \|t\| of the points is compared with its permutation distribution [1]_. P values and
    intervals are from the same draws, of the runs' deviations from the means of their groups,
    because an existing difference must not widen the intervals. The measured groups are one of the
    draws. Each term is drawn from a normal distribution.

    References
    ----------
    .. [1] Westfall and Young (1993), Resampling-based multiple testing, Wiley.
    """
    rng = np.random.default_rng(seed)
    chosen = _choices(len(first), len(second), rng)
    about = np.concatenate([_centre(first), _centre(second)])
    drawn = _largest(*_means_and_squares(about, chosen), terms, rng)
    same = chosen == chosen[0]
    drawn[same.all(axis=1) | ~same.any(axis=1)] = np.inf  # the groups as measured, or interchanged
    factor = np.sort(drawn)[::-1][_allowed_draws(level, drawn.size)]
    return _share_above(drawn, scores), np.full(scores.shape, float(factor))


def rotation_test(
    first: Array,
    second: Array,
    terms: Array,
    p_values: Array,
    degrees_of_freedom: Array,
    level: float,
    seed: int,
) -> tuple[Array, Array]:
    """Return adjusted p values, and the factor of simultaneous intervals, by rotation of residuals.

    Parameters
    ----------
    first, second, terms, level, seed
        As for `permutation_test`, without gaps.
    p_values, degrees_of_freedom
        p value and degrees of freedom of each point alone (point).

    Notes ----- If all runs are from one normal distribution, their deviations from the mean are as
    likely as any rotation of them in the space of the runs, for any correlation between points.
    Random rotations therefore give the null distribution of the smallest p of all points (Welch's,
    with each point's own degrees of freedom), if both groups have the same scatter [1]_. P values
    and intervals are from the same draws, as in `permutation_test`.

    References
    ----------
    .. [1] Langsrud (2005), Stat. Comput. 15, 53-60. doi:10.1007/s11222-005-4789-5
    """
    counts = len(first), len(second)
    turns = _rotations(sum(counts) - 1, _FEW_DRAWS if level >= _FEW_LEVEL else _DRAWS, seed)
    about = np.concatenate([_centre(first), _centre(second)])
    drawn = _smallest(about, counts, terms, turns, seed)
    drawn[0] = 0.0  # the groups as measured
    bound = float(np.sort(drawn)[_allowed_draws(level, drawn.size)])
    factor = -special.stdtrit(np.minimum(degrees_of_freedom, 1e9), bound / 2)
    return _share_below(drawn, p_values), np.asarray(factor)


def _allowed_draws(level: float, draws: int) -> int:
    """Return how many draws may exceed a difference that still counts as significant."""
    return math.floor(level * draws * (1 + _ROUNDING))


def _centre(values: Array) -> Array:
    known = np.isfinite(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        return values - np.where(known, values, 0.0).sum(axis=0) / known.sum(axis=0)


def _choices(first: int, second: int, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Return a mask of the runs in the first group, for each permutation (permutation, run)."""
    if math.comb(first + second, first) <= _EXHAUSTIVE:
        return _all_choices(first, second)
    return _draw_choices(first, second, rng)


def _all_choices(first: int, second: int) -> NDArray[np.bool_]:
    picks = np.array(list(itertools.combinations(range(first + second), first)))
    chosen = np.zeros((len(picks), first + second), dtype=bool)
    np.put_along_axis(chosen, picks, True, axis=1)
    return chosen


def _draw_choices(first: int, second: int, rng: np.random.Generator) -> NDArray[np.bool_]:
    order = rng.random((1 + _DRAWS, first + second)).argsort(axis=1)
    chosen = order < first
    chosen[0] = np.arange(first + second) < first
    return chosen


def _means_and_squares(values: Array, chosen: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Return the difference of the means, and its squared standard error (choice, point)."""
    known = np.isfinite(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        middle = np.where(known, values, 0.0).sum(axis=0) / known.sum(axis=0)
        about = np.where(known, values - middle, 0.0)
        count, total, square = known.astype(float), about, about**2
        parts = []
        for group in (chosen.astype(float), (~chosen).astype(float)):
            n, s, q = group @ count, group @ total, group @ square
            spread = np.maximum(q - s**2 / n, 0.0) / (n - 1) / n
            parts.append((s / n, np.where(n < 2, np.nan, spread)))
        (mean_a, square_a), (mean_b, square_b) = parts
        return mean_b - mean_a, square_a + square_b


def _add_terms(difference: Array, terms: Array, rng: np.random.Generator) -> Array:
    """Return differences with random calibration errors added to all draws but the measured one."""
    moved = difference.copy()
    moved[1:] += rng.normal(size=(len(difference) - 1, len(terms))) @ terms
    return moved


def _largest(difference: Array, square: Array, terms: Array, rng: np.random.Generator) -> Array:
    """Return the largest absolute t over all points, for each draw."""
    error = np.sqrt(square + (terms**2).sum(axis=0))
    with np.errstate(invalid="ignore", divide="ignore"):
        scores = np.abs(_add_terms(difference, terms, rng)) / error
    return np.asarray(np.nan_to_num(scores, nan=0.0, posinf=np.inf).max(axis=1, initial=0.0))


@functools.lru_cache(maxsize=4)
def _rotations(size: int, draws: int, seed: int) -> Array:
    """Return random rotation matrices (draw, size, size); the first is the identity."""
    rng = np.random.default_rng(seed)
    turned, scale = np.linalg.qr(rng.normal(size=(1 + draws, size, size)))
    turned *= np.sign(np.diagonal(scale, axis1=1, axis2=2))[:, None, :]
    turned[0] = np.eye(size)
    return np.asarray(turned)


def _smallest(
    values: Array, counts: tuple[int, int], terms: Array, turns: Array, seed: int
) -> Array:
    """Return the smallest p over all points, for each rotation of the runs."""
    total = sum(counts)
    columns = np.concatenate([np.ones((total, 1)), np.eye(total)[:, :-1]], axis=1)
    directions = np.linalg.qr(columns)[0][:, 1:]  # (run, direction): orthogonal to the common mean
    turned = directions @ (turns @ (directions.T @ values))
    means, squares = [], []
    for part, count in zip(np.split(turned, [counts[0]], axis=1), counts, strict=True):
        means.append(part.mean(axis=1))
        squares.append(part.var(axis=1, ddof=1) / count)
    extra = (terms**2).sum(axis=0)
    square = squares[0] + squares[1] + extra
    rng = np.random.default_rng(seed + 1)
    with np.errstate(invalid="ignore", divide="ignore"):
        freedom = square**2 / sum(
            part**2 / (count - 1) for part, count in zip(squares, counts, strict=True)
        )
        score = np.abs(_add_terms(means[1] - means[0], terms, rng)) / np.sqrt(square)
        chance = 2 * special.stdtr(np.minimum(freedom, 1e9), -score)
    return np.asarray(np.nan_to_num(chance, nan=1.0).min(axis=1, initial=1.0))


def _share_above(largest: Array, scores: Array) -> Array:
    """Return the share of draws whose largest score is at least each score."""
    ordered = np.sort(largest)
    bound = np.where(np.isfinite(scores), scores * (1 - _ROUNDING), scores)
    return 1 - np.searchsorted(ordered, bound, side="left") / ordered.size


def _share_below(smallest: Array, p_values: Array) -> Array:
    """Return the share of draws whose smallest p is at most each p."""
    ordered = np.sort(smallest)
    share = np.searchsorted(ordered, p_values * (1 + _ROUNDING), side="right") / ordered.size
    return np.maximum(share, 1 / ordered.size)
