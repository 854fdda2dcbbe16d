"""Static and kinetic friction over the rest time before each start."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.core.wording import many
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, places
from tribolab.friction.statistics import NORMAL
from tribolab.records.parts import number_of
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.starts import starts_of


def static_figures(runs: Sequence[RunRecord]) -> list[FigureSpec]:
    """Return static and kinetic friction over rest time, of runs that have both."""
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
            note="Filled: static friction at each restart ± U95; open: kinetic friction after it.",
            alt=f"Static and kinetic friction coefficients of {many(len(chosen), 'run')} over the "
            "hold time.",
            panels=(Panel(Axis("hold time", "s", log=True), Axis("friction coefficient µ")),),
            series=tuple(series),
            width="whole",
            height=430,
        )
    ]
