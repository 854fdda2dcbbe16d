"""Starts after rests of different lengths: a test of static friction."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.records.parts import BAD, Row, number_of
from tribolab.records.runs.run_record import RunRecord

_MIN_TIMES = 3  # smallest number of distinct rest times: fewer occur between ordinary strokes
_MIN_RATIO = 1.5  # smallest ratio of distinct rest times


def starts_of(record: RunRecord) -> tuple[Row, ...]:
    """Return the starts of a run after rests of different lengths; empty for other tests."""
    return () if record.outcome.quality in BAD else starts_after_rests(record.starts)


def starts_after_rests(starts: Sequence[Row]) -> tuple[Row, ...]:
    """Return the starts after a rest if the rests have different lengths; else nothing."""
    rows = [row for row in starts if (number_of(row, "waiting_time_s") or 0) > 0]
    times: list[float] = []
    for time in sorted(number_of(row, "waiting_time_s") or 0.0 for row in rows):
        if not times or time > _MIN_RATIO * times[-1]:
            times.append(time)
    return tuple(rows) if len(times) >= _MIN_TIMES else ()
