"""What the models rest on: shear stress over load, what moves them, and inside the contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribolab.campaign.store.data_files import read_data
from tribolab.figures.spec import (
    Axis,
    FigureSpec,
    Panel,
    Series,
    SeriesLabels,
    Style,
    places,
    safe,
    thinned,
)
from tribolab.records.model_words import shear_stress_u95, stress_interval
from tribolab.records.parts import number_of
from tribolab.records.wording import with_error
from tribolab.report.document.models import ModelRow
from tribolab.report.live.curves import system_name
from tribolab.report.live.record import Band, LiveRecord, Missed
from tribolab.report.live.shown import shown_figures
from tribolab.report.plain import plain_speed
from tribolab.words import force_text, is_dry, percent

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.records.parts import Row

_MPA = 1e-6


def record_of_models(
    models: Sequence[ModelRow], surfaces: Sequence[str], folder: Path
) -> LiveRecord:
    """Return the figures of the section on models, and what the curves need of the models.

    Parameters
    ----------
    models
        Those that are done.
    surfaces
        Names in the order of the campaign.
    folder
        The results folder with their data files.
    """
    bands, missed = _of_curves(models, folder)
    colours = places([*surfaces, *(row.model.surface for row in models)])
    drawn = [shear_stress_figure(models, colours), sensitivity(models, colours)]
    drawn += _profiles(models, folder)
    drawn.append(_factors(models, folder, colours))
    return LiveRecord(shown_figures(drawn), bands, missed)


def _of_curves(
    models: Sequence[ModelRow], folder: Path
) -> tuple[dict[str, Band], dict[str, Missed]]:
    """Return what models do not know and what they miss, by the name of the measured curve."""
    bands, missed = {}, {}
    for row in models:
        name, parts = row.model.curve, row.model.parts
        if "uncertainty" in parts:
            data = _read(row, folder, "uncertainty")
            edges = (data[f"friction_coefficient_{end}"].values.tolist() for end in ("low", "high"))
            bands[name] = Band(data["sliding_speed"].values.tolist(), *edges)
        if row.fit is not None and "fit" in parts:
            fit = _read(row, folder, "fit")
            off = "friction_coefficient_residual"
            names = ("sliding_speed", off, f"{off}_u", "friction_coefficient_model")
            columns = [fit[name].values.tolist() for name in names]
            missed[name] = Missed(*columns)
    return bands, missed


def _read(row: ModelRow, folder: Path, group: str) -> xr.Dataset:
    return read_data(folder / row.model.data_file, group=group)


def _labels(row: ModelRow) -> SeriesLabels:
    model = row.model
    return {"surface": model.surface, "medium": model.medium, "load": model.normal_force}


def shear_stress_figure(models: Sequence[ModelRow], colours: Mapping[str, int]) -> FigureSpec:
    """Return the fitted shear stresses over the load."""
    series = []
    for (surface, medium), rows in _by_system(models).items():
        fits = [(row, row.fit) for row in rows if row.fit and row.fit["shear_stress_Pa"] > 0]
        for name, words, open_ in (
            ("", "", True),
            ("corrected_", ", with adhesion", False),
        ):
            known = [(r, f) for r, f in fits if np.isfinite(f[f"{name}shear_stress_Pa"])]
            error = "corrected_shear_stress_error_Pa" if name else "shear_stress_total_error_Pa"
            series.append(
                Series(
                    system_name(surface, medium) + (words if name else ""),
                    [row.model.normal_force for row, _ in known],
                    [fit[f"{name}shear_stress_Pa"] * _MPA for _, fit in known],
                    style="points",
                    colour=colours[surface],
                    surface=surface,
                    medium=medium,
                    error=[shear_stress_u95(fit, fit[error]) * _MPA for _, fit in known],
                    hover=[_told(row, fit, name) for row, fit in known],
                    open=open_,
                )
            )
    series = [drawn for drawn in series if drawn.x]
    return FigureSpec(
        "model-shear_stress",
        "model",
        "Shear stress in the contact",
        "Open: as fitted, for the contact area without adhesion; filled: in the larger area that "
        "adhesion makes. Bars: U95, with the spectrum's part where known.",
        "Fitted shear stress over the load, by surface and medium.",
        (Panel(Axis("load", "N"), Axis("shear stress σ", "MPa", least=0.0)),),
        tuple(series),
        width="whole",
    )


def _told(row: ModelRow, fit: Mapping[str, Any], name: str) -> str:
    error = "corrected_shear_stress_error_Pa" if name else "shear_stress_total_error_Pa"
    u95 = shear_stress_u95(fit, fit[error]) * _MPA
    value = with_error(fit[f"{name}shear_stress_Pa"] * _MPA, u95, " MPa")
    lines = [f"load {force_text(row.model.normal_force)}", f"σ = {value} (U95)"]
    if not name:
        interval = stress_interval(fit["shear_stress_low_Pa"], fit["shear_stress_high_Pa"])
        lines.append(f"95 % interval: {interval} MPa")
    return "\n".join(lines)


def _by_system(models: Sequence[ModelRow]) -> dict[tuple[str, str], list[ModelRow]]:
    by_system: dict[tuple[str, str], list[ModelRow]] = {}
    for row in models:
        by_system.setdefault((row.model.surface, row.model.medium), []).append(row)
    return by_system


def sensitivity(models: Sequence[ModelRow], colours: Mapping[str, int]) -> FigureSpec:
    """Return how far each thing that is not known moves the model."""
    series = []
    for row in models:
        varied = sorted(row.sensitivity, key=lambda change: float(change["largest_change"] or 0))
        if not varied:
            continue
        series.append(
            Series(
                system_name(row.model.surface, row.model.medium),
                [100 * float(change["largest_change"] or 0) for change in varied],
                [str(change["variation"]) for change in varied],
                style="bars",
                colour=colours[row.model.surface],
                hover=[_moved(change) for change in varied],
                **_labels(row),
            )
        )
    return FigureSpec(
        "model-sensitivity",
        "model",
        "What moves the model most",
        "How far friction moves at most, in per cent of the height of the model's curve, when one "
        "thing that is not known goes from one end of its range to the other.",
        "Bars: largest change of the computed friction for each thing that is not known.",
        (Panel(Axis("largest change of µ", "% of the curve's height", log=True), Axis("")),),
        tuple(series),
        one_load=True,
        width="whole",
        height=380,
        rows=True,
    )


def _moved(change: Row) -> str:
    share, speed = (number_of(change, f"largest_change{end}") for end in ("", "_speed_m_s"))
    lines = [str(change["variation"]), f"{change['low'] or '–'} to {change['high'] or '–'}"]
    lines.append(f"moves µ by {percent(share)} of the curve's height")
    lines.append(f"at {plain_speed(speed)}")
    return "\n".join([*lines, str(change["reason"])])


_PROFILES = (
    ("separation", Axis("separation", "µm", log=True), 1e6),
    ("contact_pressure", Axis("p solid", "MPa"), 1e-6),
    ("fluid_pressure", Axis("p liquid", "MPa"), 1e-6),
)
_NOTHING = 1e-3  # of the highest pressure: beyond, nothing of a profile is to be seen


def _profiles(models: Sequence[ModelRow], folder: Path) -> list[FigureSpec]:
    figures = []
    for (surface, medium), rows in _by_system(models).items():
        series: list[Series] = []
        for row in rows:
            if "profiles" in row.model.parts:
                series += _across(row, _read(row, folder, "profiles"))
        name = system_name(surface, medium)
        x = Axis("across the contact", "mm")
        figures.append(
            FigureSpec(
                f"model-profiles-{safe(name)}",
                "model",
                f"{name}: across the contact",
                "The flat slides to the right. Mean separation, pressure that the solids carry, "
                "and pressure in the liquid; a colour for each sliding speed.",
                f"Mean separation, pressure in the solid contact and in the liquid of {name}.",
                tuple(Panel(x, y) for _, y, _ in _PROFILES),
                tuple(series),
                one_load=True,
            )
        )
    return figures


def _across(row: ModelRow, data: xr.Dataset) -> list[Series]:
    pressure = data["contact_pressure"] + data["fluid_pressure"]
    seen = np.flatnonzero((pressure > _NOTHING * pressure.max()).any("sliding_speed").values)
    kept = seen[thinned(seen.size, 160)]
    series = []
    for number in range(data.sizes["sliding_speed"]):
        line = data.isel(sliding_speed=number, point=kept)
        label = plain_speed(float(line["sliding_speed"]))
        for panel, (name, _, factor) in enumerate(_PROFILES):
            x, y = 1e3 * line["x"].values, factor * line[name].values
            series.append(Series(label, x, y, colour=number, panel=panel, **_labels(row)))
    return series


_FACTORS: tuple[tuple[str, str, Style, int], ...] = (
    ("pressure_flow_factor", "pressure flow factor", "line", 0),
    ("shear_flow_factor", "shear flow factor", "dashed", 0),
    ("shear_stress_factor", "friction factor of the mean shear", "line", 1),
    ("shear_stress_correction", "friction factor of roughness-born pressure", "dashed", 1),
    ("pressure_stress_factor", "friction factor of the pressure gradient", "dotted", 1),
)


def _factors(models: Sequence[ModelRow], folder: Path, colours: Mapping[str, int]) -> FigureSpec:
    series, seen = [], set()
    for row in models:
        surface = row.model.surface
        if "factors" not in row.model.parts or surface in seen or is_dry(row.model.medium):
            continue
        seen.add(surface)
        data = _read(row, folder, "factors")
        for name, words, style, panel in _FACTORS:
            series.append(
                Series(
                    surface,
                    1e6 * data["separation"].values,
                    data[name].values,
                    style,
                    colours[surface],
                    panel,
                    surface=surface,
                    hover=(words,),
                )
            )
    x = Axis("mean separation", "µm", log=True)
    return FigureSpec(
        "model-factors",
        "model",
        "Flow and friction factors",
        "How roughness changes the flow of the liquid (above: full, by pressure; dashed, by shear) "
        "and its friction (below: full, of the mean shear; dashed, of the pressure that roughness "
        "makes; dotted, of the pressure gradient). Where surfaces agree their lines lie on each "
        "other.",
        "Flow factors and friction factors over the mean separation.",
        (Panel(x, Axis("flow factor")), Panel(x, Axis("friction factor"))),
        tuple(series),
    )
