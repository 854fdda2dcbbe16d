"""Figure of the uncertainty budget: a bar for each contribution, and advice to reduce U95."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from tribolab.core.wording import many, percent
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series
from tribolab.metrology.budget_parts import BETWEEN, NOISE, coverage_factor
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import number_of

_MIN_SHARE = 0.005  # share of the variance below which a contribution has no bar
_MIN_GAIN = 0.01  # relative reduction of U95 below which no advice is given


class Contribution(NamedTuple):
    """One contribution to the uncertainty of one point of a curve.

    `relative` is its standard uncertainty divided by µ, `share` its share of the variance, and
    `gain` the relative reduction of U95 by one more repeat or by halving this part.
    """

    part: str
    relative: float
    share: float
    gain: float


def contributions(curves: Iterable[CurveRecord]) -> list[Contribution]:
    """Return every contribution to the uncertainty of every point of the curves."""
    found = []
    for curve in curves:
        points = {row["sliding_speed_m_s"]: row for row in curve.points}
        for piece in curve.budget:
            row = points.get(piece["sliding_speed_m_s"], {})
            mu, share = number_of(row, "friction_coefficient"), number_of(piece, "share")
            size = number_of(piece, "contribution")
            if not mu or share is None or size is None:
                continue
            dof = number_of(row, "friction_coefficient_dof") or math.inf
            runs = number_of(row, "runs") or 1.0
            part = str(piece["part"])
            gain = _gain(part, share, dof, runs)
            found.append(Contribution(part, abs(size / mu), share, gain))
    return found


def _gain(part: str, share: float, dof: float, runs: float) -> float:
    """Return the relative reduction of U95 by one more repeat, or by halving this contribution."""
    if part != BETWEEN:
        return 1 - math.sqrt(1 - 0.75 * share)
    smaller = math.sqrt(1 - share / (runs + 1))
    factors = coverage_factor(dof + 1) / coverage_factor(dof)
    return 1 - smaller * float(factors)


def contribution_figures(curves: Sequence[CurveRecord]) -> list[FigureSpec]:
    """Return a bar chart of the contributions to the uncertainty, averaged over all points."""
    parts: dict[str, list[Contribution]] = {}
    every = contributions(curves)
    for each in every:
        parts.setdefault(each.part, []).append(each)
    count = sum(len(curve.points) for curve in curves)
    size = {
        part: 100 * math.sqrt(sum(each.relative**2 for each in mine) / max(count, 1))
        for part, mine in parts.items()
    }
    share = {part: sum(each.share for each in mine) / max(count, 1) for part, mine in parts.items()}
    kept = sorted((part for part in size if share[part] >= _MIN_SHARE), key=lambda p: size[p])
    if not kept:
        return []
    return [
        FigureSpec(
            id="uncertainty-parts",
            section="uncertainty",
            title="Contributions to the uncertainty",
            note=f"{_advice(parts, share, count)} Root mean square over {many(count, 'point')}.",
            alt="Standard uncertainty of the friction coefficient: "
            f"{many(len(kept), 'contribution')}.",
            panels=(Panel(Axis("standard uncertainty", "% of µ"), Axis("")),),
            series=(Series("part", [size[part] for part in kept], kept, style="bars"),),
            width="whole",
            height=90 + 36 * len(kept),
            rows=True,
        )
    ]


def _advice(parts: dict[str, list[Contribution]], share: dict[str, float], count: int) -> str:
    """Return sentences on the largest contribution, and on what would reduce U95 most."""
    first = max(share, key=lambda part: share[part])
    gains = {part: sum(each.gain for each in mine) / count for part, mine in parts.items()}
    best = max(gains, key=lambda part: gains[part])
    text = f"Largest contribution: {first} ({percent(share[first])} of the variance)."
    if gains[best] < _MIN_GAIN:
        return text
    means = {BETWEEN: "One more repeat of each condition", NOISE: "Records four times as long"}
    what = means.get(best, f"Halving the uncertainty of “{best}”")
    return f"{text} {what} would reduce U95 by about {percent(gains[best])}."
