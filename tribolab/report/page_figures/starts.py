"""Figure of static and kinetic friction against the hold time before each start."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.coverage import NORMAL
from tribolab.core.wording import load_text, many, number
from tribolab.figures.spec import Axis, FigureSpec, KeyRow, KeyTable, Panel, Series, places
from tribolab.friction.points.mean_of_repeats import mean_of_repeats
from tribolab.records.parts import Row, RunOutcome, number_of
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.starts import starts_of
from tribolab.records.wording import error_text
from tribolab.report.page_figures.curves import system_name
from tribolab.report.plain import plain_speed

_HEADS = (
    "Condition",
    "Load",
    "Hold time (s)",
    "Static µ ± U95",
    "Kinetic µ ± U95",
    "Speed",
    "Starts",
)
_SAME_REST = 1.05  # rests that differ by at most this factor count as equal


class _Start(NamedTuple):
    """One start of sliding: its run, its row of results, and the rest before it [s]."""

    outcome: RunOutcome
    row: Row
    rest: float


def static_figures(runs: Sequence[RunRecord]) -> list[FigureSpec]:
    """Return a figure of static and kinetic friction against hold time; empty without starts."""
    chosen = [(run.outcome, rows) for run in runs if (rows := starts_of(run))]
    if not chosen:
        return []
    colours = places([outcome.name for outcome, _ in chosen])
    series = []
    for outcome, rows in chosen:
        x = [number_of(row, "waiting_time_s") for row in rows]
        for name, words in (
            ("static_friction_coefficient", "static"),
            ("friction_coefficient", "kinetic"),
        ):
            error = [number_of(row, f"{name}_sem") for row in rows]
            series.append(
                Series(
                    f"{outcome.name}, {words}",
                    x,
                    [number_of(row, name) for row in rows],
                    style="points",
                    colour=colours[outcome.name],
                    error=[None if each is None else NORMAL * each for each in error],
                    surface=outcome.surface,
                    medium=outcome.medium,
                    runs=(outcome.name,),
                    link=(outcome.name,),
                    open=words == "kinetic",
                )
            )
    return [
        FigureSpec(
            id="static-kinetic",
            section="view-static",
            title="Static and kinetic friction vs. hold time",
            note="Filled: static friction at each restart ± U95 (of a pointed peak it includes "
            "half a step between readings); open: kinetic friction after it.",
            alt=f"Static and kinetic friction coefficients of {many(len(chosen), 'run')} over the "
            "hold time.",
            panels=(Panel(Axis("hold time", "s", log=True), Axis("friction coefficient µ")),),
            series=tuple(series),
            width="whole",
            height=430,
            numbers=_numbers(chosen),
        )
    ]


def _numbers(chosen: Sequence[tuple[RunOutcome, Sequence[Row]]]) -> KeyTable:
    """Return a table of static and kinetic friction, averaged over starts after equal rests."""
    groups: dict[tuple[str, str, float, float], list[_Start]] = {}
    starts = [
        _Start(outcome, row, number_of(row, "waiting_time_s") or 0.0)
        for outcome, rows in chosen
        for row in rows
    ]
    key = "", "", 0.0, 0.0
    for start in sorted(starts, key=lambda start: (*_system(start), start.rest)):
        if _system(start) != key[:3] or start.rest > _SAME_REST * key[3]:
            key = (*_system(start), start.rest)
        groups.setdefault(key, []).append(start)
    return KeyTable(_HEADS, tuple(map(_mean_row, groups.values())))


def _system(start: _Start) -> tuple[str, str, float]:
    return start.outcome.surface, start.outcome.medium, start.outcome.normal_force or 0.0


def _mean_of_starts(group: Sequence[_Start], name: str) -> str:
    """Return text with the mean of a quantity over several starts, and its U95.

    U95 is at least that of one start, because all starts share the error of the zero.
    """
    values, own = (_known(number_of(s.row, name + end) for s in group) for end in ("", "_sem"))
    if not values.size:
        return "–"
    errors = [NORMAL * float(np.median(own))] if own.size else []
    if values.size > 1:
        errors.append(mean_of_repeats(values, np.full(values.size, np.nan)).u95)
    return error_text(float(values.mean()), max(errors, default=None))


def _mean_row(group: Sequence[_Start]) -> KeyRow:
    """Return the row of the table for starts after equal rests: mean static and kinetic µ."""
    first = group[0].outcome
    speeds = _known(number_of(start.row, "sliding_speed_m_s") for start in group)
    cells = (
        system_name(first.surface, first.medium, [start.outcome.name for start in group]),
        load_text(first.normal_force, first.load_from),
        number(statistics.fmean(start.rest for start in group)),
        _mean_of_starts(group, "static_friction_coefficient"),
        _mean_of_starts(group, "friction_coefficient"),
        plain_speed(float(speeds.mean())) if speeds.size else "–",
        str(len(group)),
    )
    return KeyRow(cells, first.surface, first.medium, first.normal_force)


def _known(values: Iterable[float | None]) -> np.ndarray:
    return np.array([value for value in values if value is not None], float)
