"""Segments in which stick-slip shows best: the slowest strokes at the lowest load."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from tribolab.campaign.store.outcome import Outcome
from tribolab.records.parts import CurveOutcome, number_of
from tribolab.records.runs.run_record import RunRecord

_MAX_SPEEDS = 2  # number of speeds per condition
_MIN_SPEED_RATIO = 1.2  # ratio of speeds above which they count as different


class Slow(NamedTuple):
    """A run, its data file, and its slowest forward segments with their speeds [m/s]."""

    run: str
    file: str
    segments: tuple[tuple[int, float], ...]


def lowest_loads(curves: Iterable[CurveOutcome]) -> list[CurveOutcome]:
    """Return the curve at the lowest load, where stick-slip is likely, per surface and medium."""
    best: dict[tuple[str, str], CurveOutcome] = {}
    for curve in curves:
        key = curve.surface, curve.medium
        force = curve.normal_force or 0.0
        if key not in best or force < (best[key].normal_force or 0.0):
            best[key] = curve
    return list(best.values())


def slow_segments(curve: CurveOutcome, outcome: Outcome) -> Slow | None:
    """Return the first run of a curve that has forward strokes, with its slowest forward segments.

    Manually rejected segments are left out; None if no segment remains.
    """
    for name in curve.run_names:
        entry = outcome.store.get("run", name, RunRecord)
        if entry is None or not entry.record.outcome.done:
            continue
        moving = [
            (float(number_of(row, "sliding_speed_m_s") or 0.0), number)
            for number, row in enumerate(entry.record.slip)
            if (number_of(row, "direction") or 0) >= 0
            and number_of(row, "sliding_distance_m") != 0  # else no trace to draw
            and not row.get("rejected")
        ]
        apart: list[tuple[int, float]] = []
        for speed, number in sorted(moving):
            if speed > 0 and (not apart or speed > _MIN_SPEED_RATIO * apart[-1][1]):
                apart.append((number, speed))
        if apart:
            return Slow(name, entry.record.outcome.data_file, tuple(apart[:_MAX_SPEEDS]))
    return None
