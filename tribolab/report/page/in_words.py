"""Texts and numbers that the page derives from curves and sliding modes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tribolab.core.coverage import NORMAL
from tribolab.core.wording import force_text, many
from tribolab.records.wording import error_text
from tribolab.report.page_figures.curves import system_name
from tribolab.report.plain import listed

_MIN_SHARE = 0.005  # share of the variance below which a contribution is not listed


def by_speed(points: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return the points of a curve whose speed and friction are known, from slow to fast."""
    known = [r for r in points if r["friction_coefficient"] is not None and r["sliding_speed_m_s"]]
    return sorted(known, key=lambda row: row["sliding_speed_m_s"])


def half_speed(falling: Sequence[Mapping[str, Any]]) -> float | None:
    """Return the speed [m/s] at which friction has dropped to half its value at the first point.

    Interpolated on a logarithmic scale of speed; None if friction does not drop so far.

    Parameters
    ----------
    falling
        Points of a curve by increasing speed, from the peak friction on.
    """
    half = 0.5 * falling[0]["friction_coefficient"]
    for row, other in itertools.pairwise(falling):
        a, b = row["friction_coefficient"], other["friction_coefficient"]
        if a >= half > b:
            share = (a - half) / (a - b)
            v, w = (math.log(each["sliding_speed_m_s"]) for each in (row, other))
            return math.exp(v + share * (w - v))
    return None


def budget_shares(curve: Mapping[str, Any]) -> list[tuple[str, float]]:
    """Return the contributions to a curve's uncertainty, with their mean share of the variance."""
    shares: dict[str, float] = {}
    for piece in curve["budget"]:
        shares[piece["part"]] = shares.get(piece["part"], 0.0) + (piece["share"] or 0.0)
    mean = {part: total / len(curve["points"]) for part, total in shares.items()}
    return sorted(
        ((part, share) for part, share in mean.items() if share > _MIN_SHARE),
        key=lambda pair: -pair[1],
    )


def conditions(of: Sequence[Mapping[str, Any]]) -> str:
    """Return the conditions of curves or models in words, grouped by surface and medium.

    Examples
    --------
    >>> of = [{"surface": "Sb-R", "medium": "dry", "nominal_normal_force_N": load}
    ...       for load in (31.0, 91.0)]
    >>> conditions(of)
    'Sb-R, dry, at 31 N and 91 N'
    """
    grouped: dict[str, list[float | None]] = {}
    for curve in of:
        if not (curve["surface"] or curve["medium"]) and "condition" in curve:
            grouped[curve["condition"]] = [None]  # the condition includes the load
            continue
        name = system_name(curve["surface"], curve["medium"], curve.get("runs", ()))
        grouped.setdefault(name, []).append(curve["nominal_normal_force_N"])
    return "; ".join(
        name if loads == [None] else f"{name}, at {listed(list(map(force_text, loads)))}"
        for name, loads in grouped.items()
    )


def oscillation_text(mode: Mapping[str, Any]) -> str:
    """Return text on how many segments stick and slip, and how the frequency scales with speed.

    Parameters
    ----------
    mode
        Sliding mode as in report.json.
    """
    count = mode["segments_oscillating"]
    if not count:
        return ""
    of = f"{count} of {many(mode['segments'], 'segment')}"
    if mode["verdict"] == "no stick-slip":
        verb = "looks" if count == 1 else "look"
        return f"Only {of} {verb} like stick-slip, which noise can cause."
    text = f"Stick-slip in {of}."
    if mode["scaling_exponent"] is not None:
        power = error_text(mode["scaling_exponent"], NORMAL * mode["scaling_error"])
        scaling = str(mode["scaling"])
        text += f" {scaling[:1].upper()}{scaling[1:]} (frequency ∝ speed to the power {power})."
    return text
