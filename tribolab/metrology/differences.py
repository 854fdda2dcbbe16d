"""Differences between two groups of runs at many points, with a common error rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray
from scipy import special

from tribolab.core.aliases import Array
from tribolab.core.errors import AnalysisError
from tribolab.metrology.resampling import (
    MOST_ROTATED,
    permutation_test,
    permutations_will_do,
    rotation_test,
)

PairedGroups = Sequence[tuple[Array, Array]]

PERMUTATION, ROTATION, BONFERRONI = "permutation", "rotation", "Bonferroni"
DIFFERENT, EQUIVALENT, OPEN = "different", "equivalent", "undecided"


@dataclass(frozen=True)
class Differences:
    """Differences between the means of two groups of runs (second minus first) at all points.

    Parameters
    ----------
    first, second
        Means of the groups (point).
    difference, standard_error, degrees_of_freedom
        Difference, its standard error and degrees of freedom by Welch's test (point).
    p_value
        Two-sided p value of each point alone (point).
    adjusted_p_value
        Probability that any of the points shows such a difference by chance (point).
    factor
        Half-width of the simultaneous confidence intervals, in standard errors (point).
    methods
        Correction for several points: ``"permutation"``, ``"rotation"`` or ``"Bonferroni"``
        (condition).
    """

    first: Array
    second: Array
    difference: Array
    standard_error: Array
    degrees_of_freedom: Array
    p_value: Array
    adjusted_p_value: Array
    factor: Array
    methods: tuple[str, ...]

    def interval(self, level: float) -> tuple[Array, Array]:
        """Return the confidence interval of each point by itself."""
        return interval(self.difference, self.standard_error, self.degrees_of_freedom, level)

    @property
    def low(self) -> Array:
        """Lower ends of the simultaneous confidence intervals of all points (point)."""
        return self.difference - self.factor * self.standard_error

    @property
    def high(self) -> Array:
        """Upper ends of the simultaneous confidence intervals of all points (point)."""
        return self.difference + self.factor * self.standard_error

    @property
    def differs(self) -> NDArray[np.bool_]:
        """Mask of the points whose simultaneous interval excludes zero (point)."""
        return (self.low > 0) | (self.high < 0)


def interval(
    difference: Array, standard_error: Array, degrees_of_freedom: Array, level: float
) -> tuple[Array, Array]:
    """Return the ends of Student's confidence interval at a given level, e.g. 0.95."""
    half = special.stdtrit(degrees_of_freedom, 0.5 + level / 2) * standard_error
    return difference - half, difference + half


def differences_of_groups(
    groups: PairedGroups,
    *,
    not_in_scatter: Sequence[Array] | None = None,
    alpha: float = 0.05,
    seed: int = 0,
) -> Differences:
    r"""Return the differences between two groups of runs, with one error rate for all points.

    Parameters
    ----------
    groups
        For each condition the values of the runs of both groups, (run, point) each; NaN for missing
        values. The points of all conditions are one family.
    not_in_scatter
        For each condition, errors that the scatter of the runs does not include, e.g. of gains
        that the groups do not share: signed standard uncertainties, fully correlated between
        points (term, point).
    alpha
        Probability of a false difference at any point.
    seed
        Seed of the permutations drawn if there are too many to use all.

    Returns
    -------
    Differences
        Over the points of all conditions in sequence. NaN if a group has fewer than two runs.

    Raises
    ------
    AnalysisError
        If there is nothing to compare.

    Notes ----- Each point is tested by Welch's t [1]_. The points of a condition are tested jointly
    by permutations of its runs (`permutation_test`) if each group has four or more, and there are
    enough permutations for the number of conditions; else by rotations (`rotation_test`), which
    assume normally distributed runs. If there are too few runs for permutations and some of them
    lack points, Bonferroni's rule is used with Student's distribution. Conditions are independent;
    Sidak's rule corrects for their number. P values and intervals are from the same draws, so that
    an interval excludes zero if the adjusted p is at most alpha. No adjusted p is below that of the
    point alone, and no interval is narrower.

    References
    ----------
    .. [1] Welch (1947), Biometrika 34, 28-35. doi:10.1093/biomet/34.1-2.28

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> first, second = rng.normal(1.0, 0.01, (5, 3)), rng.normal(1.0, 0.01, (5, 3))
    >>> second[:, 1] += 0.1
    >>> compared = differences_of_groups([(first, second)])
    >>> (compared.adjusted_p_value < 0.05).tolist(), compared.methods
    ([False, True, False], ('permutation',))
    """
    if not groups:
        raise AnalysisError("there is nothing to compare: the two have no condition in common")
    terms = [np.zeros((0, first.shape[1])) for first, _ in groups]
    if not_in_scatter is not None:
        terms = [np.asarray(own, dtype=float) for own in not_in_scatter]
    points = [
        _points(first, second, own) for (first, second), own in zip(groups, terms, strict=True)
    ]
    level = 1 - (1 - alpha) ** (1 / len(groups))
    comparisons = [
        _adjust_jointly(*pair, own, at, level, seed)
        for pair, own, at in zip(groups, terms, points, strict=True)
    ]
    alone = [at.p_value for at in points]
    freedom = np.concatenate([at.degrees_of_freedom for at in points])
    of_each = special.stdtrit(freedom, 1 - alpha / 2)
    adjusted = 1 - (1 - np.concatenate([own for own, _, _ in comparisons])) ** len(groups)
    adjusted = np.where(np.isnan(np.concatenate(alone)), np.nan, adjusted)
    return Differences(
        **{name: np.concatenate([getattr(at, name) for at in points]) for name in _OF_POINTS},
        adjusted_p_value=np.fmax(adjusted, np.concatenate(alone)),
        factor=np.fmax(np.concatenate([factor for _, factor, _ in comparisons]), of_each),
        methods=tuple(method for _, _, method in comparisons),
    )


@dataclass(frozen=True)
class _Points:
    """Results of Welch's test at the points of one condition; named as in `Differences`."""

    first: Array
    second: Array
    difference: Array
    standard_error: Array
    degrees_of_freedom: Array
    p_value: Array


_OF_POINTS = tuple(field.name for field in fields(_Points))


def _points(first: Array, second: Array, terms: Array) -> _Points:
    mean_a, mean_b, square, freedom = _welch(first, second)
    total = square + (terms**2).sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = np.where(square > 0, freedom * (total / square) ** 2, freedom)
    error = np.sqrt(total)
    score = np.abs(_ratio(mean_b - mean_a, error))
    p_value = 2 * special.stdtr(freedom, -score)
    return _Points(mean_a, mean_b, mean_b - mean_a, error, freedom, np.asarray(p_value))


def _adjust_jointly(
    first: Array, second: Array, terms: Array, at: _Points, level: float, seed: int
) -> tuple[Array, Array, str]:
    """Return adjusted p values and interval factors of a condition's points, and the method."""
    if permutations_will_do(len(first), len(second), level):
        scores = np.abs(_ratio(at.difference, at.standard_error))
        return *permutation_test(first, second, terms, scores, level, seed), PERMUTATION
    known = np.isfinite(at.p_value)
    own, factor = np.ones(known.size), np.full(known.size, np.nan)
    whole = first[:, known], second[:, known]
    gaps = not all(np.isfinite(values).all() for values in whole)
    if known.any() and not gaps and len(first) + len(second) <= MOST_ROTATED:
        own[known], factor[known] = rotation_test(
            *whole, terms[:, known], at.p_value[known], at.degrees_of_freedom[known], level, seed
        )
        return own, factor, ROTATION
    count = max(1, int(known.sum()))
    factor = np.asarray(special.stdtrit(at.degrees_of_freedom, 1 - level / (2 * count)))
    return np.minimum(1.0, count * at.p_value), factor, BONFERRONI


def verdicts(compared: Differences, margin: Array | None, alpha: float = 0.05) -> list[str]:
    """Return for each point: different, equivalent within a margin, or undecided.

    Parameters
    ----------
    compared
        From `differences_of_groups`.
    margin
        Largest irrelevant difference (point); None if not stated: then no point is equivalent.
    alpha
        Level of the equivalence test of each single point: two curves are equivalent only if all
        points are.

    Notes
    -----
    Different: `Differences.differs`. Equivalent, by two one-sided tests: the interval of level 1 -
    2 alpha is within the margin (Schuirmann 1987, doi:10.1007/BF01068419). Equivalence has
    priority: a significant difference may be too small to be relevant.
    """
    low, high = compared.interval(1 - 2 * alpha)
    words = []
    for i, differs in enumerate(compared.differs):
        within = margin is not None and max(-low[i], high[i]) <= margin[i]
        words.append(EQUIVALENT if within else DIFFERENT if differs else OPEN)
    return words


def _welch(first: Array, second: Array) -> tuple[Array, Array, Array, Array]:
    """Return both means, the squared error of their difference, and its degrees of freedom."""
    count_a, mean_a, square_a = _mean_and_error(first)
    count_b, mean_b, square_b = _mean_and_error(second)
    total = square_a + square_b
    least = np.minimum(count_a, count_b)
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = total**2 / (square_a**2 / (count_a - 1) + square_b**2 / (count_b - 1))
    exact = np.where(total == 0, count_a + count_b - 2, freedom)
    return mean_a, mean_b, total, np.where(least < 2, np.nan, exact)


def _mean_and_error(values: Array) -> tuple[Array, Array, Array]:
    known = np.isfinite(values)
    count = known.sum(axis=0).astype(float)
    filled = np.where(known, values, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = filled.sum(axis=0) / count
        about = np.where(known, values - mean, 0.0)
        square = (about**2).sum(axis=0) / (count - 1) / count
    return count, mean, np.where(count < 2, np.nan, square)


def _ratio(difference: Array, error: Array) -> Array:
    """Return difference divided by error; 0 for a difference of 0, even without error."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(difference == 0, np.where(np.isnan(error), np.nan, 0.0), difference / error)
