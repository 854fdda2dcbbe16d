"""Friction from stroke to stroke: of runs with many strokes, which a mean alone hides."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.figures.envelope import envelope_index
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, places
from tribolab.records.parts import Row, number_of
from tribolab.records.same_speed import of_one_speed
from tribolab.words import many

MOST_RUNS = 8  # that are shown
_FEWEST = 20  # strokes of one speed
_COLUMNS = 250  # of a run, each with its lowest and its highest stroke


class Strokes(NamedTuple):
    """A run, the moments of its strokes [s], and the friction coefficient of each (stroke)."""

    run: str
    time: np.ndarray
    mu: np.ndarray


def strokes_of(name: str, segments: Sequence[Row]) -> Strokes | None:
    """Return the strokes of a run; None where it has not many at any speed.

    Parameters
    ----------
    name
        Of the run.
    segments
        Rows of its segments, as in report.json; what a person rejected is left out.

    Examples
    --------
    >>> rows = [{"sliding_speed_m_s": 0.1, "friction_coefficient": 0.3, "trimmed_start_s": t,
    ...          "trimmed_stop_s": t + 0.5} for t in range(30)]
    >>> strokes_of("pin", rows).time[:2].tolist(), strokes_of("pin", rows[:9])
    ([0.25, 1.25], None)
    """
    if len(segments) < _FEWEST:
        return None
    counted = [row for row in segments if not row.get("rejected")]
    keys = ("sliding_speed_m_s", "friction_coefficient", "trimmed_start_s", "trimmed_stop_s")
    table = np.array([[number_of(row, key) for key in keys] for row in counted], float)
    table = table.reshape(-1, len(keys))
    speed, mu, start, stop = table.T
    time = (start + stop) / 2
    known = np.isfinite(mu) & np.isfinite(time)
    if max((len(part) for part in of_one_speed(speed, known)), default=0) < _FEWEST:
        return None
    order = np.flatnonzero(known)[np.argsort(time[known], kind="stable")]
    return Strokes(name, time[order], mu[order])


def along_figures(strokes: Sequence[Strokes], count: int) -> list[FigureSpec]:
    """Return the figure of friction from stroke to stroke, if there are runs with many.

    Parameters
    ----------
    strokes
        Of the runs that are shown.
    count
        How many runs have as many strokes.
    """
    if not strokes:
        return []
    colours = places([each.run for each in strokes])
    series = []
    for each in strokes:
        kept = envelope_index(each.time, each.mu, _COLUMNS)
        series.append(
            Series(
                each.run,
                each.time[kept],
                each.mu[kept],
                style="points",
                colour=colours[each.run],
                hover=(each.run,),
                runs=(each.run,),
                link=(each.run,),
            )
        )
    which = f" The first {len(strokes)} of {count} such runs." if count > len(strokes) else ""
    return [
        FigureSpec(
            id="curves-along",
            section="view-time",
            title="Friction from stroke to stroke",
            note="A point for each stroke, at the time of its middle; of very many the lowest and "
            f"the highest of each column.{which}",
            alt=f"Friction coefficient of the strokes of {many(len(strokes), 'run')} over time.",
            panels=(Panel(Axis("time", "s"), Axis("friction coefficient µ")),),
            series=tuple(series),
            width="whole",
            height=430,
        )
    ]
