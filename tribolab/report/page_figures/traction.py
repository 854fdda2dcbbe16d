"""Figures of measured and computed friction against slide-roll ratio (both bodies move)."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.core.wording import many, speed_text
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, axis_of
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import Row, number_of
from tribolab.report.page_figures.curves import FrictionOverSpeed, labels_of, system_name, systems

_MU, _RATIO, _ROLLING = "friction_coefficient", "slide_roll_ratio", "rolling_speed_m_s"


def traction_figures(known: FrictionOverSpeed) -> list[FigureSpec]:
    """Return a figure of friction against slide-roll ratio for each surface and medium."""
    figures = []
    for place, ((surface, medium), curves) in enumerate(systems(known).items(), start=1):
        series = [s for curve in curves for s in _series(known, curve)]
        if not series:
            continue
        name = system_name(surface, medium)
        count = sum(one.style == "points" for one in series)
        figures.append(
            FigureSpec(
                id=f"traction-{place}",
                section="curves",
                title=f"{name}: friction over the slide-roll ratio",
                note="Points: measured (bars: U95). Lines: model with the fitted shear stress.",
                alt=f"Friction over the slide-roll ratio, {name}: {many(count, 'traction curve')}.",
                panels=(Panel(Axis("slide-roll ratio SRR", "%"), axis_of(_MU)),),
                series=tuple(series),
                one_load=True,
            )
        )
    return figures


def _series(known: FrictionOverSpeed, curve: CurveRecord) -> list[Series]:
    """Return measured friction against slide-roll ratio, and the model, per entrainment speed."""
    model = known.models.get(curve.outcome.name)
    found = []
    for number, (speed, rows) in enumerate(_by_speed(curve.traction).items()):
        error = [number_of(row, f"{_MU}_U95") for row in rows]
        x, mu = _percent(rows), [number_of(row, _MU) for row in rows]
        own = labels_of(curve.outcome)
        text = f"U = {speed_text(speed)}"
        found.append(Series(text, x, mu, "points", number, error=error, **own))
        line = _by_speed(model.traction).get(speed, []) if model else []
        if line:
            computed = [number_of(row, _MU) for row in line]
            found.append(Series(f"model, {text}", _percent(line), computed, "line", number, **own))
    return found


def _percent(rows: Sequence[Row]) -> list[float]:
    return [100 * float(number_of(row, _RATIO) or 0.0) for row in rows]


def _by_speed(rows: Sequence[Row]) -> dict[float, list[Row]]:
    """Return rows grouped by entrainment speed [m/s]."""
    found: dict[float, list[Row]] = {}
    for row in rows:
        found.setdefault(float(number_of(row, _ROLLING) or 0.0), []).append(row)
    return found
