"""Figures that compare curves: friction relative to its maximum, and each run of the repeats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tribolab.core.wording import force_text, load_text, many, number, span
from tribolab.figures.colours import surface_colours
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, SeriesLabels, places
from tribolab.figures.subjects.curves import FRICTION_AXIS, SPEED_AXIS
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import number_of
from tribolab.records.wording import error_text
from tribolab.report.page_figures.curves import (
    FrictionOverSpeed,
    distinguish_media,
    labels_of,
    system_name,
    systems,
)
from tribolab.report.page_figures.points import RunPoint, of_curve
from tribolab.report.plain import plain_speed

_SHARE = Axis("µ / maximum of µ")
_HALF = 0.5


def comparisons(known: FrictionOverSpeed) -> list[FigureSpec]:
    """Return a figure of all curves, each divided by its maximum, and one of each repeat alone.

    Absolute friction is on the card of each surface and medium.
    """
    colours = surface_colours([*known.surfaces, *(c.outcome.surface for c in known.curves)])
    return [*_normalised_curves(known, colours), _every_run(known, colours)]


def _load(curve: CurveRecord) -> str:
    force = curve.outcome.normal_force
    return load_text(None, curve.outcome.load_from) if force is None else force_text(force)


def _normalised_curves(known: FrictionOverSpeed, colours: Mapping[str, int]) -> list[FigureSpec]:
    """Return a figure of µ divided by its maximum against speed; empty for a single curve."""
    alone = len(systems(known)) == 1  # a single surface and medium: a colour for each load
    loads = places(map(_load, known.curves))
    series = []
    for curve in known.curves:
        outcome = curve.outcome
        load = _load(curve)
        name = load if alone else system_name(outcome.surface, outcome.medium, outcome.run_names)
        drawn = _normalised_series(curve, name, loads[load] if alone else colours[outcome.surface])
        series += [drawn] if drawn else []
    if len(series) < 2:
        return []
    speeds = [v for drawn in series for v in drawn.x]
    half = Series(
        ("half the maximum"), [min(speeds), max(speeds)], [_HALF, _HALF], "dotted", colour=6
    )
    figure = FigureSpec(
        id="curves-compared",
        section="curves",
        title="Transition speeds",
        note="µ of each curve divided by its maximum, so all plateaus are at 1. Bars: U95 of the "
        "point. "
        + distinguish_media([curve.outcome.medium for curve in known.curves], "filled", "open"),
        alt=f"Friction relative to its highest value over sliding speed of "
        f"{many(len(series), 'curve')}.",
        panels=(Panel(SPEED_AXIS, _SHARE),),
        series=(*series, half),
        one_load=not alone,
        width="whole",
        height=440,
    )
    return [figure]


def _normalised_series(curve: CurveRecord, label: str, colour: int) -> Series | None:
    known = [(row, number_of(row, "friction_coefficient")) for row in curve.points]
    drawn = [(row, mu) for row, mu in known if mu is not None and row["sliding_speed_m_s"]]
    rows = [row for row, _ in drawn]
    top = max((mu for _, mu in drawn), default=0.0)
    if len(rows) < 2 or not top > 0:
        return None
    shares = [mu / top for _, mu in drawn]
    errors = [
        None if (wide := number_of(row, "friction_coefficient_U95")) is None else wide / top
        for row in rows
    ]
    return Series(
        label,
        [row["sliding_speed_m_s"] for row in rows],
        shares,
        style="points",
        colour=colour,
        error=errors,
        hover=[
            f"v = {plain_speed(number_of(row, 'sliding_speed_m_s'))}\n"
            f"{error_text(share, error)} of {number(top)}, the highest µ"
            for row, share, error in zip(rows, shares, errors, strict=True)
        ],
        link=curve.outcome.run_names[:1],
        **labels_of(curve.outcome),
    )


def _every_run(known: FrictionOverSpeed, colours: Mapping[str, int]) -> FigureSpec:
    """Return a figure with the friction of every single run, for curves with repeats."""
    series: list[Series] = []
    for curve in known.curves:
        outcome = curve.outcome
        label = system_name(outcome.surface, outcome.medium, outcome.run_names)
        names = [name for name in outcome.run_names if known.points.get(name)]
        if len(names) > 1:
            series += [
                _run(
                    name,
                    of_curve(known.points[name], outcome.normal_force),
                    label,
                    colours[outcome.surface],
                    labels_of(outcome),
                )
                for name in names
            ]
    return FigureSpec(
        id="curves-runs",
        section="curves",
        title="Every run of the repeats",
        note="A point for each run and speed. Bars: U95 within the run, without "
        "the scatter between runs. "
        + distinguish_media([curve.medium for curve in series], "filled", "open"),
        alt=f"Friction coefficient over sliding speed of {many(len(series), 'run')}, "
        f"µ {span(mu for drawn in series for mu in drawn.y)}.",
        panels=(Panel(SPEED_AXIS, FRICTION_AXIS),),
        series=tuple(series),
        one_load=True,
        width="whole",
        height=440,
    )


def _run(
    name: str, points: Sequence[RunPoint], label: str, colour: int, labels: SeriesLabels
) -> Series:
    return Series(
        label,
        [point.speed for point in points],
        [point.mu for point in points],
        style="points",
        colour=colour,
        error=[point.within for point in points],
        hover=[_tooltip(point) for point in points],
        link=(name,),
        **(labels | {"runs": (name,)}),
    )


def _tooltip(point: RunPoint) -> str:
    within = "not known" if point.within is None else f"± {number(point.within, 2)}"
    return (
        f"{point.run}\nv = {plain_speed(point.speed)}\nµ = {number(point.mu)}\n"
        f"U95 within the run: {within}\n{many(point.segments, 'segment')}, "
        f"{point.effective_samples:.0f} independent samples"
    )
