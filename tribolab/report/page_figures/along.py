"""Figures of friction against distance, time or cycles, in runs at one speed: running-in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tribolab.core.untyped import Arguments
from tribolab.core.wording import many
from tribolab.figures.colours import BLACK
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, places
from tribolab.friction.points import limits as of_points
from tribolab.friction.running_in.kinds import STRETCHES, STROKES
from tribolab.records.parts import BAD, Row, number_of
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import RunningIn
from tribolab.records.wording import error_text

MAX_RUNS = 8  # most runs shown


class Along(NamedTuple):
    """A run at one speed, its friction along the path, and its running-in if it is long enough."""

    record: RunRecord
    course: Sequence[Row]
    settled: RunningIn | None

    @property
    def counted(self) -> str:
        """Name of the interval that each value averages, e.g. a stroke."""
        return STROKES if self.settled is None else self.settled.counted


def along_of(record: RunRecord) -> Along | None:
    """Return the data of a run at one speed with at least two strokes or running-in; else None."""
    settled = record.facts.running_in
    if record.outcome.quality in BAD or len(settled) > 1:
        return None
    if settled:
        return Along(record, record.course, settled[0])
    course = _strokes(record)
    return Along(record, course, None) if len(course) > 1 else None


def _strokes(record: RunRecord) -> list[Row]:
    """Return a row with friction for each stroke of a run; empty if the run has several speeds."""
    rows = [row for row in record.facts.segments if row.get("friction_coefficient") is not None]
    speeds = [number_of(row, "sliding_speed_m_s") or 0.0 for row in rows]
    tolerance = 1 + of_points.SPEED_TOLERANCE.value
    if not speeds or not 0 < max(speeds) < tolerance * min(speeds):
        return []
    gone, made = 0.0, []
    for number, row in enumerate(rows, 1):
        start, stop = number_of(row, "start_s") or 0.0, number_of(row, "stop_s") or 0.0
        way = (number_of(row, "sliding_speed_m_s") or 0.0) * (stop - start)
        error, mu = number_of(row, "friction_coefficient_U95"), row["friction_coefficient"]
        place: Row = {"number": number, "time_s": (start + stop) / 2, "distance_m": gone + way / 2}
        made.append(place | {"friction_coefficient": mu, "U95": error})
        gone += way
    return made


_OVER = (
    ("distance", Axis("sliding distance", "m"), "distance_m", ("start_m", "stop_m")),
    ("time", Axis("time", "s"), "time_s", ("start_s", "stop_s")),
    ("cycles", Axis("cycle"), "number", ("start_number", "stop_number")),
)
_INK: Arguments = {"colour": BLACK}
_STEADY = "steady"  # legend label of the lines at the steady friction; these lines are drawn last
_MU = Axis("friction coefficient µ")


def along_figures(runs: Sequence[Along], count: int) -> list[FigureSpec]:
    """Return figures of friction against distance, time and cycle number, with steady values.

    Parameters
    ----------
    runs
        Runs to show.
    count
        Number of runs at one speed, including those not shown.
    """
    figures = []
    for name, axis, column, ends in _OVER:
        series = [drawn for run in runs for drawn in _series(run, runs, column, ends)]
        if not series or (name == "cycles" and all(r.counted == STRETCHES for r in runs)):
            continue
        which = (
            (f" Only the first {len(runs)} of {count} runs are drawn.") if count > len(runs) else ""
        )
        wear = any(drawn.panel for drawn in series)
        figures.append(
            FigureSpec(
                id=f"along-{name}",
                section=f"view-{name}",
                title=_title(runs),
                note=f"{_note(runs)}{which}",
                alt=f"Friction coefficient of {many(len(runs), 'run')} over {axis.label}.",
                panels=(Panel(axis, _MU), *([Panel(axis, Axis("wear", "µm"))] * wear)),
                series=tuple(sorted(series, key=lambda drawn: drawn.label == _STEADY)),
                width="whole",
                height=520 if wear else 430,
            )
        )
    return figures


def _title(runs: Sequence[Along]) -> str:
    """Return the title of the figure: the steady friction if only one run is shown."""
    if len(runs) > 1:
        return "Friction along the runs"
    (settled,) = (run.settled for run in runs)
    if settled is None:
        return f"µ of {many(len(runs[0].course), 'stroke')}"
    mean = error_text(settled.mean_friction_coefficient, settled.mean_friction_coefficient_U95)
    if settled.is_unsteady:
        return f"not steady at the end of the run; mean over all µ = {mean}"
    steady = settled.steady_friction_coefficient, settled.steady_friction_coefficient_U95
    return f"steady µ = {error_text(*steady)}; mean over all {mean}"


def _note(runs: Sequence[Along]) -> str:
    """Return a note that explains the dashed lines or the error bars."""
    if any(run.settled is not None for run in runs):
        return "Dashes: steady state."
    return "Mean of each stroke with its U95; too few strokes to look for running-in."


def _series(run: Along, runs: Sequence[Along], column: str, ends: tuple[str, str]) -> list[Series]:
    outcome, settled = run.record.outcome, run.settled
    colour = places([each.record.outcome.name for each in runs])[outcome.name]
    labels: Arguments = {"colour": colour, "runs": (outcome.name,), "link": (outcome.name,)}
    labels |= {"surface": outcome.surface, "medium": outcome.medium}
    rows = [row for row in run.course if number_of(row, column) is not None]
    if column == "number" and run.counted == STRETCHES:
        return []
    x = [number_of(row, column) for row in rows]
    mu = [number_of(row, "friction_coefficient") for row in rows]
    if settled is None:
        bars = [number_of(row, "U95") for row in rows]
        labels |= {"error": bars, "joined": True, "hover": (outcome.name,)}
        return [Series(outcome.name, x, mu, "points", **labels)]
    drawn = [Series(outcome.name, x, mu, thin=True, hover=(outcome.name,), **labels)]
    start, stop = (getattr(settled, end) for end in ends)
    level, error = settled.steady_friction_coefficient, settled.steady_friction_coefficient_U95
    if None not in (start, stop, level):
        words = f"{outcome.name}: steady µ = {error_text(level, error)}"
        drawn.append(
            Series(_STEADY, [start, stop], [level] * 2, "dashed", hover=(words,), **labels | _INK)
        )
    wear = [number_of(row, "wear_depth_m") for row in rows]
    if any(depth is not None for depth in wear):
        depth = [None if each is None else 1e6 * each for each in wear]
        drawn.append(Series(outcome.name, x, depth, panel=1, thin=True, **labels))
    return drawn
