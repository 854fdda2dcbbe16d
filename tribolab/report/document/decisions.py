"""What a person's decisions did to the results: tables, and how far they moved the curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from tribolab.campaign.store.outcome import Outcome
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import Notice, Row, number_of
from tribolab.records.run_record import RunRecord
from tribolab.records.wording import plain_value
from tribolab.report import tables
from tribolab.report.document.document import labels
from tribolab.words import many, number, percent, speed_text

DECISIONS, CURVES = "decisions.csv", "stribeck_as_found.csv"
_SPEED, _MU = "sliding_speed_m_s", "friction_coefficient"
_ALIKE = 0.1  # relative difference of speed up to which two points are one


def curve_notices(curve: CurveRecord) -> list[Notice]:
    """Say how far decisions moved a curve; nothing where they did not."""
    if not curve.points_as_found:
        return []
    pairs, lost = _pairs(curve)
    parts = []
    if pairs:
        speed, mu, found = max(pairs, key=lambda pair: abs(pair[1] / pair[2] - 1))
        parts.append(
            f"change µ by at most {percent(mu / found - 1)}: "
            f"{number(mu, 4)} with them, {number(found, 4)} without, at {speed_text(speed)}"
        )
    if lost:
        parts.append(f"leave {many(lost, 'speed')} without µ")
    what = f"decisions {' and '.join(parts)}" if parts else "decisions change what it rests on"
    members = "; ".join(curve.outcome.run_names)
    text = f"{what}; the curve without them: tables/{CURVES}"
    return [Notice("note", members, curve.outcome.name, text)]


def _pairs(curve: CurveRecord) -> tuple[list[tuple[float, float, float]], int]:
    """Return speed and friction with decisions and without, and how many speeds have it no more."""
    now = [(v, mu) for row in curve.points if (v := row[_SPEED]) and (mu := row[_MU]) is not None]
    speeds = np.array([speed for speed, _ in now], dtype=float)
    pairs, lost = [], 0
    for row in curve.points_as_found:
        speed, found = number_of(row, _SPEED), number_of(row, _MU)
        if not speed or not found:
            continue
        apart = np.abs(np.log(speeds / speed))
        if apart.size and apart.min() <= np.log1p(_ALIKE):
            pairs.append((speed, float(now[int(apart.argmin())][1]), found))
        else:
            lost += 1
    return pairs, lost


def write_tables(outcome: Outcome, curves: Sequence[CurveRecord], folder: Path) -> None:
    """Write the decisions, a row each, and the curves without them, where there are any.

    Parameters
    ----------
    outcome
        Its store has the runs.
    curves
        Those that are shown.
    folder
        Of the tables.
    """

    def decided() -> Iterator[Row]:
        for entry in outcome.store.all("run", RunRecord):
            name: Row = {"run": entry.record.outcome.name}
            front = name | labels(entry.record.outcome)
            for decision in entry.record.facts.decisions:
                yield front | decision.row()

    def found() -> Iterator[Row]:
        for curve in curves:
            name: Row = {"curve": curve.outcome.name}
            front = name | labels(curve.outcome)
            yield from (front | plain_value(row) for row in curve.points_as_found)

    if any(True for _ in decided()):
        tables.write_rows(decided, folder / DECISIONS, ["run"])
    if any(True for _ in found()):
        tables.write_rows(found, folder / CURVES, ["curve"])
