"""Effect of manual decisions (rejected runs or segments) on the measured curves."""

from __future__ import annotations

import numpy as np

from tribolab.core.wording import many, number, percent, speed_text
from tribolab.friction.points.limits import SPEED_TOLERANCE
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import Notice, number_of

_SPEED, _MU = "sliding_speed_m_s", "friction_coefficient"


def curve_notices(curve: CurveRecord) -> list[Notice]:
    """Return a note on how much manual decisions changed a curve; empty if unchanged."""
    if not curve.points_as_found:
        return []
    pairs, lost = _pairs(curve)
    parts = []
    if pairs:
        speed, mu, before = max(pairs, key=lambda pair: abs(pair[1] / pair[2] - 1))
        parts.append(
            f"change µ by at most {percent(mu / before - 1)}: "
            f"{number(mu, 4)} with them, {number(before, 4)} without, at {speed_text(speed)}"
        )
    if lost:
        parts.append(f"leave {many(lost, 'speed')} without µ")
    what = f"decisions {' and '.join(parts)}" if parts else "decisions change what it depends on"
    members = "; ".join(curve.outcome.run_names)
    text = f"{what}; report.json has the curve without them (points_as_found)"
    return [Notice("note", members, curve.outcome.name, text)]


def _pairs(curve: CurveRecord) -> tuple[list[tuple[float, float, float]], int]:
    """Return speed and µ with and without decisions, and at how many speeds decisions removed µ."""
    now = [(v, mu) for row in curve.points if (v := row[_SPEED]) and (mu := row[_MU]) is not None]
    speeds = np.array([speed for speed, _ in now], dtype=float)
    pairs, lost = [], 0
    for row in curve.points_as_found:
        speed, mu = number_of(row, _SPEED), number_of(row, _MU)
        if not speed or not mu:
            continue
        apart = np.abs(np.log(speeds / speed))
        if apart.size and apart.min() <= np.log1p(SPEED_TOLERANCE.value):
            pairs.append((speed, float(now[int(apart.argmin())][1]), mu))
        else:
            lost += 1
    return pairs, lost
