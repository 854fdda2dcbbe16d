"""Figures of measured and computed friction against speed, by surface and medium, or by load."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from tribolab.core.wording import force_text, is_dry, load_text, many, span, speeds
from tribolab.figures.axes import comparable
from tribolab.figures.colours import GREY
from tribolab.figures.spec import FigureSpec, Panel, Series, SeriesLabels, axis_of
from tribolab.figures.subjects.curves import stribeck
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import CurveOutcome, number_of
from tribolab.records.wording import error_text
from tribolab.report.document.models import ModelRow
from tribolab.report.page_figures.points import (
    RunPoint,
    at_speed,
    describe_point,
    of_curve,
    point_error,
)
from tribolab.report.page_figures.record import Band
from tribolab.report.plain import listed, plain_speed

if TYPE_CHECKING:
    from tribolab.records.parts import Row

_ONE_RATIO = 1.1  # slide-roll ratios that differ by less than this factor count as equal
_MAX_NAMED = 3  # most runs named in a title
_AS_FOUND = "without decisions by hand"
_SPEED, _ROLLING, _MU = "sliding_speed_m_s", "rolling_speed_m_s", "friction_coefficient"  # names


@dataclass(frozen=True)
class FrictionOverSpeed:
    """Measured and computed friction of a campaign against speed.

    Parameters
    ----------
    curves
        Measured curves that can be shown.
    points
        Points of each run, by name of the run.
    models
        Models by name of the measured curve.
    bands
        Uncertainty of the models, by the same name.
    surfaces
        Names in the order of the campaign, which sets their colours.
    """

    curves: Sequence[CurveRecord]
    points: Mapping[str, Sequence[RunPoint]]
    models: Mapping[str, ModelRow]
    bands: Mapping[str, Band]
    surfaces: Sequence[str]


def systems(known: FrictionOverSpeed) -> dict[tuple[str, str], list[CurveRecord]]:
    """Return the measured curves by surface and medium, each list in order of increasing load."""
    by_system: dict[tuple[str, str], list[CurveRecord]] = {}
    for curve in known.curves:
        by_system.setdefault((curve.outcome.surface, curve.outcome.medium), []).append(curve)
    for curves in by_system.values():
        curves.sort(key=lambda curve: curve.outcome.normal_force or 0.0)
    return by_system


def system_name(surface: str, medium: str, runs: Sequence[str] = ()) -> str:
    """Return "surface, medium" as a name; if both are unknown, the runs or their number."""
    named = ", ".join(filter(None, (surface, medium)))
    if named or not runs:
        return named or "runs"
    return listed(list(runs)) if len(runs) <= _MAX_NAMED else f"{len(runs)} runs"


def distinguish_media(media: Collection[str], in_liquid: str, dry: str) -> str:
    """Return a sentence on the styles of wet and dry data; "" if a figure shows only one kind.

    Parameters
    ----------
    media
        Media in the figure.
    in_liquid, dry
        Word for the style of each, e.g. "filled" and "open".

    Examples
    --------
    >>> distinguish_media(["glycerol", "dry"], "filled", "open")
    'Filled: in a liquid; open: dry.'
    >>> distinguish_media(["dry"], "full", "dashed")
    ''
    """
    wet = [medium for medium in media if not is_dry(medium)]
    if not wet or len(wet) == len(media):
        return ""
    unnamed = " or a medium that is not named" if "" in wet else ""
    return f"{in_liquid[:1].upper()}{in_liquid[1:]}: in a liquid{unnamed}; {dry}: dry."


def card_figures(known: FrictionOverSpeed) -> list[FigureSpec]:
    """Return a figure per surface and medium: measured curves, and computed ones with their bands.

    Figures with the same medium have the same axes, so that surfaces can be compared.
    """
    cards = [
        (medium, _card(known, place, surface, medium, curves))
        for place, ((surface, medium), curves) in enumerate(systems(known).items(), start=1)
    ]
    alike: dict[str, list[tuple[Panel, Sequence[Series]]]] = {}
    for medium, card in cards:
        alike.setdefault(medium, []).append((card.panels[0], card.series))
    panels = {medium: comparable(mine) for medium, mine in alike.items()}
    return [replace(card, panels=(panels[medium],)) for medium, card in cards]


def _card(
    known: FrictionOverSpeed, place: int, surface: str, medium: str, curves: Sequence[CurveRecord]
) -> FigureSpec:
    measured, models = [], []
    for curve in curves:
        model = known.models.get(curve.outcome.name)
        if model is not None and _has_stress(model):
            models += _modelled(known, model, curve)
        measured.append(_measured(known, curve, curve_label(curve.outcome, curves)))
        measured += _as_found(curve)
    all_runs = dict.fromkeys(run for curve in curves for run in curve.outcome.run_names)
    name = system_name(surface, medium, list(all_runs))
    rows = [row for curve in curves for row in curve.points]
    values, every = ([number_of(row, name) for row in rows] for name in (_MU, _SPEED))
    one_load = bool(surface or medium)  # else curves are of different runs: show all
    spec = stribeck.spec(measured, models, surfaces=known.surfaces, scale="log")
    spec = _over_entrainment(spec, measured + models)
    return replace(
        spec,
        id=f"card-{place}",
        section="view-curve",
        title=name,
        alt=f"Friction coefficient over sliding speed of {name}: {many(len(curves), 'load')}, "
        f"{speeds(every)}, µ {span(values)}.",
        series=tuple(_card_style(series, one_load) for series in spec.series),
        one_load=one_load,
        width="card",
        height=230,
    )


def _over_entrainment(spec: FigureSpec, drawn: Sequence[xr.Dataset]) -> FigureSpec:
    """Return a figure against entrainment speed if all its data have the same slide-roll ratio."""
    ratios = [float(data.attrs.get("slide_roll_ratio", np.nan)) for data in drawn]
    ratio = float(np.mean(ratios))
    if not ratio > 0 or max(ratios) > _ONE_RATIO * min(ratios):
        return spec
    axis = axis_of("rolling_speed", f"entrainment speed at SRR {100 * ratio:.3g} %,", log=True)
    series = [replace(s, x=(np.asarray(s.x, float) / ratio).tolist()) for s in spec.series]
    return replace(spec, panels=(replace(spec.panels[0], x=axis),), series=tuple(series))


def _card_style(series: Series, one_load: bool) -> Series:
    """Return a series in the style of a card: points not joined; no shade if one load is shown."""
    if series.label == _AS_FOUND:
        return replace(series, colour=GREY, shade=0.0, open=True, joined=False)
    if one_load:
        series = replace(series, shade=0.0, marker=None)
    return replace(series, joined=False)


def curve_label(curve: CurveOutcome, curves: Sequence[CurveRecord]) -> str:
    """Return the legend label of a measured curve, with its load or runs if otherwise ambiguous."""
    loads = [other.outcome.normal_force for other in curves]
    nameless = not (curve.surface or curve.medium)
    if len(curves) > 1 and nameless:
        return ", ".join(curve.run_names[:3])
    if len(curves) == 1 or (None not in loads and len(set(loads)) == len(loads)):
        return "measured"
    return f"measured, {load_text(curve.normal_force, curve.load_from)}"


def labels_of(curve: CurveOutcome) -> SeriesLabels:
    """Return surface, medium, load and runs of a curve, by which its series can be selected."""
    return {
        "surface": curve.surface,
        "medium": curve.medium,
        "load": curve.normal_force,
        "open": is_dry(curve.medium),
        "runs": curve.run_names,
    }


def _dataset(
    outcome: CurveOutcome, rows: Sequence[Row], label: str, **more: Sequence[str]
) -> xr.Dataset:
    """Return a measured or computed curve as a dataset for the figures."""
    known = [row for row in rows if row.get(_MU) is not None]
    names = [_MU, *(f"{_MU}_{end}" for end in ("U95",) if any(f"{_MU}_{end}" in r for r in known))]
    columns = {name: _floats(number_of(row, name) for row in known) for name in names}
    named = {"label": label, "surface": outcome.surface, "medium": outcome.medium}
    labels: dict[str, str | float] = {**named}
    speed = _floats(number_of(row, _SPEED) for row in known)
    rolling = [number_of(row, _ROLLING) for row in known if row.get(_ROLLING) is not None]
    if rolling:
        labels["slide_roll_ratio"] = float(speed[0] / rolling[0])
    return xr.Dataset(
        {name: ("sliding_speed", values) for name, values in {**columns, **more}.items()},
        {"sliding_speed": speed},
        labels | {"normal_force_N": outcome.normal_force, "runs": tuple(outcome.run_names)},
    )


def _floats(values: Iterable[float | None]) -> np.ndarray:
    return np.array([np.nan if value is None else value for value in values], float)


def _measured(known: FrictionOverSpeed, curve: CurveRecord, label: str) -> xr.Dataset:
    outcome = curve.outcome
    of_runs = (p for name in outcome.run_names for p in known.points.get(name, ()))
    every = of_curve(of_runs, outcome.normal_force)
    words, targets = [], []
    rows = [row for row in curve.points if row.get(_MU) is not None]
    for row in rows:
        points = at_speed(every, float(row[_SPEED] or 0.0))
        error = point_error(row, points)
        words.append(describe_point(row, error, points, _first_component(curve.uncertainty_says)))
        targets.append(points[0].run if points else curve.outcome.run_names[0])
    return _dataset(outcome, rows, label, hover=words, link=targets)


def _first_component(text: str) -> str:
    """Return the first contribution that an uncertainty omits, short enough for a tooltip."""
    return text.partition(";")[0].partition(", because")[0]


def _as_found(curve: CurveRecord) -> list[xr.Dataset]:
    """Return the curve as it was before manual decisions; empty if there are no decisions."""
    rows = [row for row in curve.points_as_found if row[_MU] is not None]
    words = [
        f"{_AS_FOUND}\nv = {plain_speed(number_of(row, _SPEED))}\n"
        f"µ = {error_text(number_of(row, _MU), number_of(row, f'{_MU}_U95'))}"
        for row in rows
    ]
    return [_dataset(curve.outcome, rows, _AS_FOUND, hover=words)] if rows else []


def _has_stress(model: ModelRow) -> bool:
    return model.fit is not None and bool(model.fit["shear_stress_Pa"] > 0)


def slide_roll_ratio(curve: CurveRecord) -> float | None:
    """Return the slide-roll ratio [1] of a measured curve; None if one body was at rest."""
    for row in curve.points:
        sliding, rolling = (
            number_of(row, _SPEED),
            number_of(row, _ROLLING) if _ROLLING in row else None,
        )
        if sliding and rolling:
            return sliding / rolling
    return None


def _near_measured(rows: Sequence[Row], curve: CurveRecord) -> list[Row]:
    """Return the rows of a model from 1/10 of the lowest to 10 times the highest measured speed."""
    known = [float(row["sliding_speed_m_s"] or 0) for row in curve.points]
    low, high = min(known) / 10, max(known) * 10
    return [row for row in rows if low <= float(row["sliding_speed_m_s"] or 0) <= high]


def _modelled(known: FrictionOverSpeed, model: ModelRow, curve: CurveRecord) -> list[xr.Dataset]:
    """Return the computed curve with its band, near the measured speeds; empty if it has none."""
    rows = _near_measured(model.curve, curve)
    if not rows:
        return []
    data = _dataset(curve.outcome, rows, "model")
    if ratio := slide_roll_ratio(curve):
        data.attrs["slide_roll_ratio"] = ratio
    if curve.outcome.name in known.bands:
        speed, low, high = map(_floats, known.bands[curve.outcome.name])
        fine = np.isfinite(speed) & np.isfinite(low) & np.isfinite(high)
        v = data["sliding_speed"].values
        for end, values in (("low", low), ("high", high)):
            at_speeds = np.interp(v, speed[fine], values[fine], np.nan, np.nan)
            data[f"{_MU}_{end}"] = ("sliding_speed", at_speeds)
    return [data]


def load_figures(known: FrictionOverSpeed) -> list[FigureSpec]:
    """Return a figure for each load with at least two surfaces, as files for publication."""
    by_load: dict[float, list[CurveRecord]] = {}
    for curve in known.curves:
        if curve.outcome.normal_force is not None and curve.outcome.surface:
            by_load.setdefault(curve.outcome.normal_force, []).append(curve)
    figures = []
    for place, (load, curves) in enumerate(sorted(by_load.items()), start=1):
        if len({curve.outcome.surface for curve in curves}) < 2:
            continue
        measured = [_measured(known, curve, "") for curve in curves]
        spec = stribeck.spec(measured, surfaces=known.surfaces)
        title = f"{force_text(load)}: friction over sliding speed"
        note = "Bars: U95. Dry: open markers, dashed."
        alt = f"Friction coefficient over sliding speed at {force_text(load)}: "
        alt += f"{many(len(curves), 'measured curve')}."
        figures.append(
            replace(
                spec, id=f"stribeck-load_{place}", section="curves", title=title, note=note, alt=alt
            )
        )
    return figures
