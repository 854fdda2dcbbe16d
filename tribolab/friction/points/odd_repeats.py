"""Detection of outlying repeats, by the repeatability under other conditions.

Notes
-----
The repeatability is that of the other conditions, from the squared contrasts of their repeats
without the largest fifth. The largest deviation by chance is found by simulating campaigns with the
same numbers of conditions and repeats, whose scatter differs between conditions. If only two
repeats differ, the outlier cannot be identified. With a single condition, each of at least three
repeats is compared with the scatter of the others by Grubbs' test [1]_.

References
----------
.. [1] Grubbs (1950), Ann. Math. Stat. 21, 27. doi:10.1214/aoms/1177729885
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tribolab.friction.points import limits

_SIMULATED_CAMPAIGNS = 4000
_SEED = 7


class OddRepeat(NamedTuple):
    """An outlying repeat of one condition.

    `repeat` is the index of the outlier, -1 if only two repeats differ. `deviation` is relative to
    the mean of the others, or the relative difference of the two. `repeatability` is the relative
    standard deviation under other conditions. `odd` is False if the repeat is merely suspect.
    """

    condition: int
    repeat: int
    deviation: float
    repeatability: float
    odd: bool


def _contrasts(k: int) -> np.ndarray:
    """Return the k - 1 Helmert contrasts of k repeats, which are independent and of variance 1."""
    rows = np.zeros((k - 1, k))
    for i in range(1, k):
        rows[i - 1, :i], rows[i - 1, i] = 1.0, -float(i)
        rows[i - 1] /= np.sqrt(i * (i + 1))
    return rows


def _scores(groups: Sequence[np.ndarray]) -> tuple[list[np.ndarray], np.ndarray]:
    """Return each repeat's deviation / scatter of the other conditions, and that scatter."""
    squares = [(values @ _contrasts(values.shape[1]).T) ** 2 for values in groups]
    scores, scatters = [], []
    for own, values in enumerate(groups):
        others = np.concatenate([s for k, s in enumerate(squares) if k != own], axis=1)
        count = others.shape[1]
        kept = (
            count - int(limits.TRIMMED.value * count)
            if count >= limits.MIN_CONTRASTS_TO_TRIM.value
            else count
        )
        scatter = np.sqrt(np.sort(others, axis=1)[:, :kept].mean(axis=1))
        repeats = values.shape[1]
        off = (values - values.mean(axis=1, keepdims=True)) / np.sqrt(1 - 1 / repeats)
        z = np.abs(off) / np.maximum(scatter, 1e-300)[:, None]
        scores.append(z[:, :1] if repeats == 2 else z)
        scatters.append(scatter)
    return scores, np.stack(scatters, axis=1)


@lru_cache(maxsize=64)
def _simulated_scores(repeats: tuple[int, ...]) -> np.ndarray:
    """Return the sorted largest scores of simulated campaigns without outliers."""
    rng = np.random.default_rng(_SEED)
    groups = []
    for k in repeats:
        scatter = np.exp(
            limits.UNEVEN_SCATTER.value * rng.standard_normal((_SIMULATED_CAMPAIGNS, 1))
        )
        groups.append(scatter * rng.standard_normal((_SIMULATED_CAMPAIGNS, k)))
    return np.sort(np.concatenate(_scores(groups)[0], axis=1).max(axis=1))


def odd_repeats(groups: Sequence[np.ndarray]) -> list[OddRepeat]:
    """Return the outlying repeats, the worst first.

    Parameters
    ----------
    groups
        Logarithms of the repeated quantity for each condition (repeat): for runs the mean of
        ln(friction) over their common speeds, for scans ln(Rq).

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> groups = [0.01 * rng.standard_normal(2) for _ in range(9)]
    >>> odd_repeats(groups)
    []
    >>> groups[4] = np.array([0.0, 0.16])
    >>> [(odd.condition, odd.repeat, round(odd.deviation, 2)) for odd in odd_repeats(groups)]
    [(4, -1, 0.17)]
    """
    left = [k for k, values in enumerate(groups) if values.size > 1]
    if len(left) == 1:
        return _odd_of_one(left[0], groups[left[0]])
    found = []
    while len(left) > 1:
        own = [groups[k] for k in left]
        scores, scatters = _scores([values[None] for values in own])
        worst = int(np.argmax([z.max() for z in scores]))
        limit = _simulated_scores(tuple(values.size for values in own))
        z = float(scores[worst].max())
        if z <= np.quantile(limit, 1 - limits.SUSPECT_BY_CHANCE.value):
            break
        values, two = own[worst], own[worst].size == 2
        repeat = int(scores[worst][0].argmax())
        others = np.delete(values, repeat)
        deviation = float(np.expm1(abs(values[0] - values[1]))) if two else float(
            np.expm1(values[repeat] - others.mean())
        )  # fmt: skip
        odd = bool(z > np.quantile(limit, 1 - limits.ODD_BY_CHANCE.value))
        found.append(
            OddRepeat(left[worst], -1 if two else repeat, deviation, float(scatters[0, worst]), odd)
        )
        del left[worst]
    return found


def _odd_of_one(condition: int, values: np.ndarray) -> list[OddRepeat]:
    """Return the outlier, if any, among the repeats of a condition that is the only one."""
    # imported late for a quick start
    from scipy import special

    count = values.size
    if count < 3:
        return []
    repeat = int(np.abs(values - values.mean()).argmax())
    others = np.delete(values, repeat)
    scatter = float(others.std(ddof=1))
    deviation = float(values[repeat] - others.mean())
    error = max(scatter * np.sqrt(1 + 1 / others.size), 1e-12)
    chance = 2 * count * special.stdtr(count - 2, -abs(deviation) / error)
    if not chance < limits.ODD_BY_CHANCE.value:
        return []
    return [OddRepeat(condition, repeat, float(np.expm1(deviation)), scatter, True)]
