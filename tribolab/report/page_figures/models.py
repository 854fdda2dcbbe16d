"""Figures of the mixed-lubrication models: curves, shear stress, sensitivity, film profiles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from tribolab.campaign.store.data_files import read_data
from tribolab.core.errors import AnalysisError
from tribolab.core.wording import force_text, is_dry, percent
from tribolab.figures.colours import surface_colours
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, SeriesLabels, safe
from tribolab.figures.subjects.film import film_profiles, lubrication_factors
from tribolab.figures.subjects.master import master_curve
from tribolab.figures.subjects.mixed import mixed_curve, shear_stress
from tribolab.fit.master_curve import collapse_test
from tribolab.records.models.model_words import shear_stress_u95, stress_interval
from tribolab.records.parts import number_of
from tribolab.records.wording import error_text
from tribolab.report.document.models import ModelRow
from tribolab.report.page_figures.curves import system_name
from tribolab.report.page_figures.record import Band
from tribolab.report.plain import plain_speed

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.records.parts import Row

_MPA = 1e-6


def model_specs(
    models: Sequence[ModelRow], surfaces: Sequence[str], folder: Path
) -> list[FigureSpec]:
    """Return all figures of the mixed-lubrication models.

    Parameters
    ----------
    models
        Models with results.
    surfaces
        Names in the order of the campaign.
    folder
        The results folder with their data files.
    """
    order = [*surfaces, *(row.model.surface for row in models)]
    return [
        *_curves(models, order, folder),
        *_regime_maps(models, folder),
        shear_stress_figure(models, order),
        sensitivity(models, surface_colours(order)),
        *_profiles(models, folder),
        _factors(models, order, folder),
    ]


def bands_of_models(models: Sequence[ModelRow], folder: Path) -> dict[str, Band]:
    """Return the uncertainty band of each computed curve, by name of the measured curve."""
    bands = {}
    for row in models:
        if "uncertainty" in row.model.parts:
            data = _read(row, folder, "uncertainty")
            edges = (data[f"friction_coefficient_{end}"].values.tolist() for end in ("low", "high"))
            bands[row.model.curve] = Band(data["sliding_speed"].values.tolist(), *edges)
    return bands


def _read(row: ModelRow, folder: Path, group: str) -> xr.Dataset:
    return read_data(folder / row.model.data_file, group=group)


def _labels(row: ModelRow) -> SeriesLabels:
    model = row.model
    return {"surface": model.surface, "medium": model.medium, "load": model.normal_force}


def shear_stress_figure(models: Sequence[ModelRow], surfaces: Sequence[str]) -> FigureSpec:
    """Return a figure of the fitted shear stress against load, per surface and medium."""
    rows = [
        fit
        | {
            "surface": row.model.surface,
            "medium": row.model.medium,
            "normal_force_N": row.model.normal_force,
            "corrected_u95_Pa": shear_stress_u95(fit, fit["corrected_shear_stress_error_Pa"]),
            "hover": _stress_tooltip(row, fit, ""),
            "corrected_hover": _stress_tooltip(row, fit, "corrected_"),
        }
        for row in models
        if (fit := row.fit) and fit["shear_stress_Pa"] > 0
    ]
    if not rows:
        return FigureSpec()
    spec = shear_stress.spec(pd.DataFrame(rows), surfaces=surfaces)
    return replace(
        spec,
        id="model-shear_stress",
        section="model",
        width="whole",
        alt="Fitted shear stress over the load, by surface and medium.",
    )


def _stress_tooltip(row: ModelRow, fit: Mapping[str, Any], name: str) -> str:
    error = "corrected_shear_stress_error_Pa" if name else "shear_stress_total_error_Pa"
    u95 = shear_stress_u95(fit, fit[error]) * _MPA
    value = error_text(fit[f"{name}shear_stress_Pa"] * _MPA, u95, " MPa")
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
    """Return a figure of how much the computed friction changes with each uncertain input."""
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
                hover=[_change_tooltip(change) for change in varied],
                **_labels(row),
            )
        )
    return FigureSpec(
        "model-sensitivity",
        "model",
        "Sensitivity of the model to its inputs",
        "Largest change of the computed friction if one uncertain input goes from one end of its "
        "range to the other, in per cent of the peak friction of the model.",
        "Bars: largest change of the computed friction for each uncertain input.",
        (Panel(Axis("largest change of µ", "% of the peak friction", log=True), Axis("")),),
        tuple(series),
        one_load=True,
        width="whole",
        height=380,
        rows=True,
    )


def _change_tooltip(change: Row) -> str:
    share, speed = (number_of(change, f"largest_change{end}") for end in ("", "_speed_m_s"))
    lines = [str(change["variation"]), f"{change['low'] or '–'} to {change['high'] or '–'}"]
    lines.append(f"changes µ by {percent(share)} of the peak friction")
    lines.append(f"at {plain_speed(speed)}")
    return "\n".join([*lines, str(change["reason"])])


def _curves(models: Sequence[ModelRow], order: Sequence[str], folder: Path) -> list[FigureSpec]:
    """Return a figure per surface and medium: measured points, computed curve, residuals."""
    figures = []
    for (surface, medium), rows in _by_system(models).items():
        specs = []
        for row in rows:
            if row.fit is None or not {"fit", "curve"} <= set(row.model.parts):
                continue
            spread = _read(row, folder, "uncertainty") if "uncertainty" in row.model.parts else None
            fit, curve = (_read(row, folder, part) for part in ("fit", "curve"))
            spec = mixed_curve.spec(fit, curve, uncertainty=spread, surface=surface, surfaces=order)
            specs.append(_labelled(spec, row))
        if specs:
            name = system_name(surface, medium)
            alt = f"Measured and computed friction coefficient of {name} over sliding speed, with "
            figures.append(
                _merged(specs, f"model-{safe(name)}", name, f"{alt}the residuals.", one_load=True)
            )
    return figures


def _regime_maps(models: Sequence[ModelRow], folder: Path) -> list[FigureSpec]:
    """Return figures of µ and film ratio against viscosity × speed, per surface and load."""
    groups: dict[tuple[str, float | None], list[ModelRow]] = {}
    for row in models:
        if row.fit is not None and {"fit", "curve", "factors"} <= set(row.model.parts):
            groups.setdefault((row.model.surface, row.model.normal_force), []).append(row)
    figures = []
    for (surface, load), rows in groups.items():
        fits, curves = ([_read(row, folder, part) for row in rows] for part in ("fit", "curve"))
        roughness = _read(rows[0], folder, "factors").attrs["rms_roughness_m"]
        viscosities = [curve.attrs["viscosity_Pa_s"] for curve in curves]
        try:
            collapse = collapse_test(fits, viscosities) if len(rows) > 1 else None
        except AnalysisError:  # too few points: drawn without the test
            collapse = None
        spec = master_curve.spec(
            fits,
            viscosities,
            names=[row.model.medium for row in rows],
            collapse=collapse,
            model=curves[0],
            rms_roughness=roughness,
        )
        name = f"{surface or '–'}{'' if load is None else f' {force_text(load)}'}"
        figures.append(
            replace(
                spec,
                id=f"model-regimes-{safe(name)}",
                section="model",
                title=f"{name}: regimes over viscosity × speed",
                note="Film ratio: computed central separation over h_rms; mixed lubrication from 1 "
                f"to 3. Model: {rows[0].model.medium}.",
                alt=f"Friction coefficient and film ratio of {name} over viscosity times speed.",
                series=tuple(replace(one, surface=surface, load=load) for one in spec.series),
            )
        )
    return figures


def _labelled(spec: FigureSpec, row: ModelRow) -> FigureSpec:
    """Return a figure whose series have the surface, medium and load of a model."""
    return replace(spec, series=tuple(replace(one, **_labels(row)) for one in spec.series))


def _merged(
    specs: Sequence[FigureSpec], id: str, name: str, alt: str, *, one_load: bool
) -> FigureSpec:
    """Return a single figure with the series of several figures (of one surface and medium)."""
    series = tuple(one for spec in specs for one in spec.series)
    title = f"{name}: {specs[0].title[:1].lower()}{specs[0].title[1:]}"
    note = max((spec.note for spec in specs), key=len)  # the longest note also explains the model
    return replace(
        specs[0],
        note=note,
        id=id,
        section="model",
        title=title,
        alt=alt,
        series=series,
        one_load=one_load,
    )


def _profiles(models: Sequence[ModelRow], folder: Path) -> list[FigureSpec]:
    figures = []
    for (surface, medium), rows in _by_system(models).items():
        name = system_name(surface, medium)
        specs = [
            _labelled(film_profiles.spec(_read(row, folder, "profiles")), row)
            for row in rows
            if "profiles" in row.model.parts
        ]
        if specs:
            alt = f"Mean separation, pressure in the solid contact and in the liquid of {name}."
            id = f"model-profiles-{safe(name)}"
            figures.append(_merged(specs, id, name, alt, one_load=True))
    return figures


def _factors(models: Sequence[ModelRow], order: Sequence[str], folder: Path) -> FigureSpec:
    data: dict[str, xr.Dataset] = {}
    for row in models:
        surface = row.model.surface
        if "factors" in row.model.parts and surface not in data and not is_dry(row.model.medium):
            data[surface] = _read(row, folder, "factors")
    if not data:
        return FigureSpec()
    alt = "Flow factors and friction factors over the mean separation."
    spec = lubrication_factors.spec(data, surfaces=order)
    return replace(spec, id="model-factors", section="model", alt=alt)
