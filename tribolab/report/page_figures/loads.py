"""Figures of friction against load, at the lowest, a middle and the highest speed."""

from __future__ import annotations

from tribolab.core.wording import is_dry
from tribolab.figures.colours import surface_colours
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series
from tribolab.records.parts import Row, number_of
from tribolab.report.page_figures.curves import FrictionOverSpeed, system_name, systems
from tribolab.report.page_figures.points import MAX_SPEED_RATIO, point_error
from tribolab.report.plain import plain_speed

_MIN_LOADS = 2
_LOAD, _MU = Axis("normal force", "N"), Axis("friction coefficient µ")


def over_load_figures(known: FrictionOverSpeed) -> list[FigureSpec]:
    """Return figures of friction against load, if a surface and medium have several loads."""
    several = {
        name: [curve for curve in curves if curve.outcome.normal_force is not None]
        for name, curves in systems(known).items()
        if any(name)
    }
    several = {name: curves for name, curves in several.items() if len(curves) >= _MIN_LOADS}
    rows = [row for curves in several.values() for curve in curves for row in curve.points]
    speeds = sorted({number_of(row, "sliding_speed_m_s") or 0.0 for row in rows} - {0.0})
    if not speeds:
        return []
    colours = surface_colours([*known.surfaces, *(surface for surface, _ in several)])
    figures = []
    for place, speed in enumerate(dict.fromkeys((speeds[0], speeds[len(speeds) // 2], speeds[-1]))):
        series = []
        for (surface, medium), curves in several.items():
            found = [
                (curve.outcome.normal_force, row)
                for curve in curves
                if (row := _point_at(curve.points, speed)) is not None
            ]
            if len(found) < _MIN_LOADS:
                continue
            series.append(
                Series(
                    system_name(surface, medium),
                    [load for load, _ in found],
                    [row["friction_coefficient"] for _, row in found],
                    style="points",
                    colour=colours[surface],
                    error=[point_error(row, ()).size for _, row in found],
                    surface=surface,
                    medium=medium,
                    open=is_dry(medium),
                    joined=True,
                )
            )
        if series:
            figures.append(
                FigureSpec(
                    id=f"load-{place}",
                    section="view-load",
                    title=f"at {plain_speed(speed)}",
                    note="Bars: U95.",
                    alt=f"Friction coefficient over load at {plain_speed(speed)}.",
                    panels=(Panel(_LOAD, _MU),),
                    series=tuple(series),
                )
            )
    return figures


def _point_at(points: tuple[Row, ...], speed: float) -> Row | None:
    for row in points:
        v = number_of(row, "sliding_speed_m_s")
        if (
            v
            and speed / MAX_SPEED_RATIO <= v <= speed * MAX_SPEED_RATIO
            and row["friction_coefficient"] is not None
        ):
            return row
    return None
