"""Two groups of runs beside each other: at which points they differ, all points taken together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from tribolab.errors import AnalysisError

Array = NDArray[np.float64]
Groups = Sequence[tuple[Array, Array]]

FEWEST = 4  # runs in each group, from which on permutations of runs can tell at the 5 % level
_PERMUTATIONS = 4999
_EXHAUSTIVE = 5000
_SAME = 1e-9  # relative: rounding does not tell a permutation from itself

DIFFERENT, EQUIVALENT, UNDECIDED = "different", "equivalent", "undecided"


@dataclass(frozen=True)
class Differences:
    """Differences of the means of two groups of runs, second less first, over all points.

    Parameters
    ----------
    first, second
        Means of the groups (point).
    difference, standard_error, degrees_of_freedom
        Of the difference: Welch's (point).
    p_value
        Of each point alone, two-sided (point).
    adjusted_p_value
        Of each point as one of all of them: that this or a larger one of any point came by chance.
    factor
        Standard errors to each side within which all differences lie together (point).
    method
        ``"permutation"`` or ``"Holm"``.
    """

    first: Array
    second: Array
    difference: Array
    standard_error: Array
    degrees_of_freedom: Array
    p_value: Array
    adjusted_p_value: Array
    factor: Array
    method: str

    def interval(self, level: float) -> tuple[Array, Array]:
        """Return the interval of each point alone that holds the difference at this level."""
        return interval(self.difference, self.standard_error, self.degrees_of_freedom, level)

    @property
    def low(self) -> Array:
        """Lower ends of the intervals that hold all differences together."""
        return self.difference - self.factor * self.standard_error

    @property
    def high(self) -> Array:
        """Upper ends of the intervals that hold all differences together."""
        return self.difference + self.factor * self.standard_error


def interval(
    difference: Array, standard_error: Array, degrees_of_freedom: Array, level: float
) -> tuple[Array, Array]:
    """Return the ends of Student's interval about differences at a level, e.g. 0.95."""
    half = stats.t.ppf(0.5 + level / 2, degrees_of_freedom) * standard_error
    return difference - half, difference + half


def differences_of_groups(
    groups: Groups,
    *,
    not_in_scatter: Sequence[Array] | None = None,
    alpha: float = 0.05,
    seed: int = 0,
) -> Differences:
    r"""Compare two groups of runs at many points, with an error rate for all points together.

    Parameters
    ----------
    groups
        For each condition the values of the runs of both groups, (run, point) each; NaN where a
        run has none. The points of all conditions are one family.
    not_in_scatter
        For each condition the standard uncertainty of the difference that the scatter of the runs
        does not show (point), e.g. of a gain that the groups do not share.
    alpha
        Chance that any point of the family is called different where none is.
    seed
        Of the permutations that are drawn where there are too many to take all.

    Returns
    -------
    Differences
        Over the points of all conditions, one after the other. NaN where a group has fewer than
        two runs.

    Raises
    ------
    AnalysisError
        If there is nothing to compare.

    Notes
    -----
    At each point Welch's t [1]_. Runs change their groups within their condition, whole, so that
    what binds the points of a run stays in it; the largest \|t\| of the condition's points over
    these permutations tells which are too large for chance [2]_. Conditions are independent of each
    other, and Sidak's step-down rule takes their number into account. Where there are fewer than
    four runs in a group, or too few permutations for so many conditions (of four and four runs
    there are 70, which is enough for one; of five and five 252, enough for six), Holm's rule
    adjusts the p values of Student's distribution instead, and the intervals are Bonferroni's. The
    intervals of permutations are made of the runs' deviations from the means of their groups: a
    difference that there is must not widen them.

    References
    ----------
    .. [1] Welch (1947), Biometrika 34, 28-35. doi:10.1093/biomet/34.1-2.28
    .. [2] Westfall and Young (1993), Resampling-based multiple testing, Wiley.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> first, second = rng.normal(1.0, 0.01, (5, 3)), rng.normal(1.0, 0.01, (5, 3))
    >>> second[:, 1] += 0.1
    >>> compared = differences_of_groups([(first, second)])
    >>> (compared.adjusted_p_value < 0.05).tolist(), compared.method
    ([False, True, False], 'permutation')
    """
    if not groups:
        raise AnalysisError("there is nothing to compare: the two have no condition in common")
    parts = [_welch(first, second) for first, second in groups]
    means_a, means_b, squares, freedom = (np.concatenate(part) for part in zip(*parts, strict=True))
    extra = np.zeros_like(squares) if not_in_scatter is None else np.concatenate(not_in_scatter)
    error = np.sqrt(squares + extra**2)
    difference = means_b - means_a
    score = _ratio(difference, error)
    p_value = np.asarray(2 * stats.t.sf(np.abs(score), freedom))
    ends = np.cumsum([first.shape[1] for first, _ in groups])
    if _enough_permutations(groups, alpha):
        adjusted, factor = _by_permutation(groups, ends, np.abs(score), alpha, seed)
        method = "permutation"
    else:
        adjusted = holm(p_value)
        count = max(1, int(np.isfinite(p_value).sum()))
        factor = np.asarray(stats.t.ppf(1 - alpha / (2 * count), freedom))
        method = "Holm"
    adjusted = np.where(np.isfinite(score) | np.isinf(score), adjusted, np.nan)
    return Differences(
        means_a, means_b, difference, error, freedom, p_value, adjusted, factor, method
    )


def holm(p_values: Array) -> Array:
    """Return p values adjusted for their number by Holm's rule; NaN stay and do not count.

    Examples
    --------
    >>> holm(np.array([0.01, 0.04, 0.03])).tolist()
    [0.03, 0.06, 0.06]
    """
    adjusted = np.full(p_values.shape, np.nan)
    known = np.flatnonzero(np.isfinite(p_values))
    order = known[np.argsort(p_values[known], kind="stable")]
    steps = p_values[order] * np.arange(order.size, 0, -1)
    adjusted[order] = np.minimum(1.0, np.maximum.accumulate(steps))
    return adjusted


def verdicts(compared: Differences, margin: Array | None, alpha: float = 0.05) -> list[str]:
    """Say of each point whether the two differ, are equivalent within a margin, or neither is sure.

    Parameters
    ----------
    compared
        From `differences_of_groups`.
    margin
        The largest difference that does not matter (point); None if nobody stated one, and then
        nothing is equivalent.
    alpha
        Of both tests: adjusted for all points where it is asked whether they differ; for each point
        alone where it is asked whether they are equivalent, since the two curves are equivalent
        only if all their points are.

    Notes
    -----
    Equivalent is what two one-sided tests say: the interval of level 1 - 2 alpha lies within the
    margin (Schuirmann 1987, doi:10.1007/BF01068419). It comes first: a difference may be sure and
    yet too small to matter.
    """
    low, high = compared.interval(1 - 2 * alpha)
    words = []
    for place, chance in enumerate(compared.adjusted_p_value):
        within = margin is not None and max(-low[place], high[place]) <= margin[place]
        differs = chance <= alpha
        words.append(EQUIVALENT if within else DIFFERENT if differs else UNDECIDED)
    return words


def _welch(first: Array, second: Array) -> tuple[Array, Array, Array, Array]:
    """Means of both groups, squared standard error of their difference, degrees of freedom."""
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
    """Difference over its error; two values that are the same to the last digit do not differ."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(difference == 0, np.where(np.isnan(error), np.nan, 0.0), difference / error)


def _enough_permutations(groups: Groups, alpha: float) -> bool:
    """Tell whether permutations could call the clearest difference one, in every condition."""
    if min(len(part) for pair in groups for part in pair) < FEWEST:
        return False
    ways = min(math.comb(len(first) + len(second), len(first)) for first, second in groups)
    return 1 - (1 - 2 / ways) ** len(groups) <= alpha


def _by_permutation(
    groups: Groups, ends: NDArray[np.int64], scores: Array, alpha: float, seed: int
) -> tuple[Array, Array]:
    """Return adjusted p values, and the factor of the intervals that hold all points."""
    rng = np.random.default_rng(seed)
    own, factor = np.empty_like(scores), np.empty_like(scores)
    level = (1 - alpha) ** (1 / len(groups))
    places = np.split(np.arange(scores.size), ends[:-1])
    for place, (first, second) in zip(places, groups, strict=True):
        chosen = _choices(len(first), len(second), rng)
        own[place] = _share_above(_largest(np.concatenate([first, second]), chosen), scores[place])
        about = np.concatenate([_about_mean(first), _about_mean(second)])
        factor[place] = np.quantile(_largest(about, chosen[1:]), level, method="higher")
    least = np.array([np.min(own[place], initial=1.0) for place in places])
    adjusted, bound = np.empty_like(own), 0.0
    for rank, number in enumerate(np.argsort(least, kind="stable")):
        place, left = places[number], len(groups) - rank
        adjusted[place] = np.maximum(bound, 1 - (1 - own[place]) ** left)
        bound = float(np.min(adjusted[place], initial=1.0))
    return adjusted, factor


def _about_mean(values: Array) -> Array:
    with np.errstate(invalid="ignore", divide="ignore"):
        known = np.isfinite(values)
        return values - np.where(known, values, 0.0).sum(axis=0) / known.sum(axis=0)


def _largest(values: Array, chosen: NDArray[np.bool_]) -> Array:
    """Largest absolute t of all points for each choice of the runs of the first group."""
    return _scores(values, chosen).max(axis=1, initial=0.0)


def _choices(first: int, second: int, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Return which runs make the first group in each permutation; first as they did."""
    if math.comb(first + second, first) <= _EXHAUSTIVE:
        return _all_choices(first, second)
    return _drawn_choices(first, second, rng)


def _all_choices(first: int, second: int) -> NDArray[np.bool_]:
    picks = np.array(list(itertools.combinations(range(first + second), first)))
    chosen = np.zeros((len(picks), first + second), dtype=bool)
    np.put_along_axis(chosen, picks, True, axis=1)
    return chosen


def _drawn_choices(first: int, second: int, rng: np.random.Generator) -> NDArray[np.bool_]:
    order = rng.random((1 + _PERMUTATIONS, first + second)).argsort(axis=1)
    chosen = order < first
    chosen[0] = np.arange(first + second) < first
    return chosen


def _scores(values: Array, chosen: NDArray[np.bool_]) -> Array:
    """Absolute t of each point for each choice of the runs of the first group."""
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
        scores = np.abs(mean_b - mean_a) / np.sqrt(square_a + square_b)
    return np.nan_to_num(scores, nan=0.0, posinf=np.inf)


def _share_above(largest: Array, scores: Array) -> Array:
    """Share of the permutations in which some point was as far off as each score."""
    ordered = np.sort(largest)
    bound = np.where(np.isfinite(scores), scores * (1 - _SAME), scores)
    return 1 - np.searchsorted(ordered, bound, side="left") / ordered.size
