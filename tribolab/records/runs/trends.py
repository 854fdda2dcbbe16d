"""Trends along the segments of a run, for the page and the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from tribolab.core.wording import many, percent
from tribolab.friction.coefficient.steadiness import LIMITS, undecided


def undecided_segments(change: np.ndarray, chance: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """Return a mask of segments whose trend is undecided, as in the check on steadiness."""
    return undecided(change, chance, samples, LIMITS)


def trend_texts(rows: Sequence[Mapping[str, Any]], quantity: str) -> list[tuple[float, str]]:
    """Return the trend of each segment as a number for sorting and a text.

    Parameters
    ----------
    rows
        The segments of a run, as in report.json.
    quantity
        Main quantity of the run: a friction coefficient, else a force.

    Examples
    --------
    >>> few = {"trend_change": -0.16, "trend_p_value": 0.36, "effective_samples": 2.8}
    >>> many = {"trend_change": 8e-4, "trend_p_value": 1e-9, "effective_samples": 300}
    >>> rows = [{"friction_coefficient": 0.8} | row for row in (few, many)]
    >>> [text for _, text in trend_texts(rows, "friction_coefficient")]
    ['−20 %, not decided (p = 0.36)', '+0.1 %, significant']
    """
    trends = _trends(rows, quantity)
    if trends is None:
        return [(0.0, "–") for _ in rows]
    return [_trend_text(*trend) for trend in zip(*trends, strict=True)]


def undecided_trends(runs: Iterable[tuple[str, Sequence[Mapping[str, Any]], str]]) -> str:
    """Return a text on the number of undecided trends, and the largest; else "".

    Parameters
    ----------
    runs
        Name, segments and quantity of each run, as for `trend_texts`.

    Examples
    --------
    >>> row = {"friction_coefficient": 0.8, "trend_p_value": 0.36, "effective_samples": 2.8}
    >>> short = [row | {"trend_change": change} for change in (-0.16, 0.0)]
    >>> undecided_trends([("a", short, "friction_coefficient")])
    'Trend undecided in 1 of 2 segments, at most −20 % along one (run a): the record is \
too short to distinguish drift from noise'
    """
    number = total = 0
    largest, where = 0.0, ""
    for name, rows, quantity in runs:
        total += len(rows)
        if (trends := _trends(rows, quantity)) is None or not trends[2].any():
            continue
        change = trends[0][trends[2]]
        number += change.size
        worst = float(change[np.argmax(np.abs(change))])
        if abs(worst) > abs(largest):
            largest, where = worst, name
    if not number:
        return ""
    size = f"{'+' if largest > 0 else ''}{percent(largest)}"
    return (
        f"Trend undecided in {number} of {many(total, 'segment')}, at most {size} along one (run "
        f"{where}): the record is too short to distinguish drift from noise"
    )


def _trends(
    rows: Sequence[Mapping[str, Any]], quantity: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return the relative change of friction, p value, and mask of undecided trends."""

    def column(name: str) -> np.ndarray:
        return np.array([np.nan if (v := row.get(name)) is None else v for row in rows], float)

    change, key = column("trend_change"), "friction_coefficient"
    if quantity != key:
        key = f"{quantity}_N"
        change = column("force_trend_N_s") * (column("trimmed_stop_s") - column("trimmed_start_s"))
    value = np.abs(column(key))
    typical = value[np.isfinite(value)]
    if not (typical > 0).any():
        return None
    change, chance = change / typical.mean(), column("trend_p_value")
    return change, chance, undecided_segments(change, chance, column("effective_samples"))


def _trend_text(change: float, chance: float, is_open: bool) -> tuple[float, str]:
    if not np.isfinite(change):
        return 0.0, "–"
    size = f"{'+' if change > 0 else ''}{percent(float(change))}"
    if is_open:
        return float(change), f"{size}, not decided (p = {chance:.2g})"
    return float(
        change
    ), f"{size}, {'significant' if chance < LIMITS['chance'] else f'p = {chance:.2g}'}"
