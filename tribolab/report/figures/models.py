"""The figures of the section on mixed lubrication, each drawn by a worker."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import pandas as pd

from tribolab import plot
from tribolab.campaign.store.data_files import read_data
from tribolab.records.model_words import has_shear_stress
from tribolab.records.parts import Row
from tribolab.report.document.models import SHEAR_STRESS, ModelRow
from tribolab.report.figures.files import Drawn
from tribolab.words import force_text, is_dry, many, span

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from tribolab.campaign.store.outcome import Outcome
    from tribolab.records.joint_record import JointRecord
    from tribolab.records.parts import ModelOutcome

_NO_MODEL = ": no shear stress describes this curve, so only the model's viscous part is drawn"
_NO_LINE = ": no model at {}, where no shear stress describes the curve"
_MOST_IN_ONE = 9  # surfaces or loads that can be told apart in one figure


class ShownModel(NamedTuple):
    """A model that a figure shows, and where its data are."""

    name: str
    surface: str
    medium: str
    normal_force: float | None
    data_file: str
    parts: tuple[str, ...]


@dataclass(frozen=True)
class ModelFigure:
    """A figure to draw: its kind, the models that it shows, where it goes.

    Parameters
    ----------
    kind
        Key of `_KINDS`.
    name
        What its file is called.
    title
        What it shows.
    models
        Models with the data.
    surfaces
        All surfaces of the study, for their colours.
    dry
        Data file of the dry measured curve beside it; "" if there is none.
    table
        Rows of fits, where it shows those.
    missing
        What the figure cannot show, behind its title.
    """

    kind: str
    name: str
    title: str
    models: tuple[ShownModel, ...]
    surfaces: tuple[str, ...]
    dry: str = ""
    table: tuple[Row, ...] = ()
    missing: str = ""

    @property
    def file(self) -> str:
        """Path of the figure relative to the results folder."""
        return f"figures/{self.name}.svg"

    @property
    def files(self) -> tuple[str, ...]:
        """Data files that it reads."""
        files = [model.data_file for model in self.models]
        return (*files, self.dry) if self.dry else tuple(files)


def plan_model_figures(
    outcome: Outcome, rows: Sequence[ModelRow], joints: Sequence[JointRecord] = ()
) -> list[ModelFigure]:
    """Choose the figures for which there are data."""
    fitted = [row.model for row in rows if row.fit is not None]
    surfaces = tuple(dict.fromkeys(curve.surface for curve in outcome.curves))
    planned: list[ModelFigure] = []

    def add(kind: str, name: str, title: str, models: Iterable[ModelOutcome], **more: Any) -> None:
        shown = tuple(
            ShownModel(m.name, m.surface, m.medium, m.normal_force, m.data_file, m.parts)
            for m in models
        )
        planned.append(ModelFigure(kind, name, title, shown, surfaces, **more))

    stressed = [row.model for row in rows if row.fit is not None and row.fit["shear_stress_Pa"] > 0]
    for model in fitted:
        missing = "" if model in stressed else _NO_MODEL
        add("curve", model.name, _title(model), [model], dry=_dry(outcome, model), missing=missing)
    for number, surface in enumerate(dict.fromkeys(model.surface for model in fitted)):
        mine = [model for model in fitted if model.surface == surface][:_MOST_IN_ONE]
        if len(mine) > 1:
            without = [force_text(m.normal_force) for m in mine if m not in stressed]
            missing = _NO_LINE.format(" and ".join(without)) if without else ""
            add("loads", f"model_surface_{number + 1}", surface, mine, missing=missing)
    for joint in joints:
        shown = ShownModel(joint.name, joint.surface, joint.medium, None, joint.file, ())
        title = ", ".join(filter(None, (joint.surface, joint.medium, "all loads in one fit")))
        planned.append(ModelFigure("joint", joint.name, title, (shown,), surfaces))
    if stressed:
        fits = tuple(row.labels | row.fit for row in rows if row.model in stressed and row.fit)
        add("shear_stress", "shear_stress", "Shear stress over the load", stressed, table=fits)
    for kind, part, title in (
        ("effect", "profiles", "With and without friction factors"),
        ("factors", "factors", "Flow and friction factors"),
    ):
        mine = [row.model for row in rows if part in row.model.parts][:_MOST_IN_ONE]
        if mine:
            add(kind, f"model_{kind}", title, mine)
    for kind, part in (("profiles", "profiles"), ("sensitivity", "uncertainty")):
        for row in rows:
            if part in row.model.parts:
                name = f"{kind}_{row.model.name.removeprefix('model_')}"
                add(kind, name, _title(row.model), [row.model])
    return planned


def _title(model: ModelOutcome) -> str:
    force = force_text(float("nan") if model.normal_force is None else model.normal_force)
    return ", ".join(part for part in (model.surface, model.medium, force) if part)


def _dry(outcome: Outcome, model: ModelOutcome) -> str:
    """Return the data file of the dry curve of the same surface and load."""
    for curve in outcome.curves:
        same = (curve.surface, curve.normal_force) == (model.surface, model.normal_force)
        if curve.done and same and is_dry(curve.medium):
            return curve.data_file
    return ""


def draw_model(what: ModelFigure, folder: Path) -> Drawn:
    """Draw one figure of models."""
    draw, caption = _KINDS[what.kind]
    figure, numbers = draw(_Opened(what, folder))
    title = what.title + what.missing
    if what.missing and what.kind == "curve":
        caption = _CAPTION_OF_VISCOUS
    return Drawn(figure, f"{title}. {caption}", f"{title}. {numbers} {caption}", what.kind)


class _Opened(NamedTuple):
    """A figure and the folder with its data files."""

    figure: ModelFigure
    folder: Path


def _read(task: _Opened, model: ShownModel, group: str) -> xr.Dataset:
    return read_data(task.folder / model.data_file, group=group)


def _by_surface(task: _Opened, group: str) -> dict[str, xr.Dataset]:
    return {model.surface: _read(task, model, group) for model in task.figure.models}


def _curve(task: _Opened) -> tuple[Figure, str]:
    (model,) = task.figure.models
    fit = _read(task, model, "fit")
    spread = _read(task, model, "uncertainty") if "uncertainty" in model.parts else None
    dry = read_data(task.folder / task.figure.dry) if task.figure.dry else None
    figure = plot.mixed_curve(
        fit,
        _read(task, model, "curve"),
        uncertainty=spread,
        dry=dry,
        surface=model.surface,
        surfaces=task.figure.surfaces,
        title=task.figure.title,
    )
    measured = f"Measured µ from {span(fit['friction_coefficient'].values.tolist())}"
    if not has_shear_stress(fit):
        return figure, f"{measured}; no shear stress."
    return figure, f"{measured}; fitted shear stress {fit.attrs['shear_stress_Pa'] / 1e6:.3g} MPa."


def _loads(task: _Opened) -> tuple[Figure, str]:
    measured, models = [], []
    for model in task.figure.models:
        labels: dict[str, str | float | None] = {
            "surface": model.surface,
            "medium": model.medium,
            "normal_force_N": model.normal_force,
        }
        fit, curve = (_read(task, model, group) for group in ("fit", "curve"))
        measured.append(fit.assign_attrs(labels))
        if has_shear_stress(fit):
            models.append(curve.assign_attrs(labels))
    figure = plot.stribeck(measured, models, surfaces=task.figure.surfaces, title=task.figure.title)
    return figure, f"Measured and computed at {many(len(task.figure.models), 'load')}."


class _Fitted(NamedTuple):
    """Points and curves of a joint fit."""

    points: xr.Dataset
    curves: xr.Dataset


def _joint(task: _Opened) -> tuple[Figure, str]:
    (model,) = task.figure.models
    fit = _Fitted(_read(task, model, "points"), _read(task, model, "curves"))
    figure = plot.joint_fit(
        fit, surface=model.surface, surfaces=task.figure.surfaces, title=task.figure.title
    )
    surfaces = len(set(fit.curves["surface"].values.tolist()))
    counted = many(fit.curves.sizes["curve"], "load" if surfaces == 1 else "curve")
    said = f"at {counted}" if surfaces == 1 else f"in {counted} of {surfaces} surfaces"
    return figure, f"Measured and computed {said}."


def _shear_stress(task: _Opened) -> tuple[Figure, str]:
    table = pd.DataFrame(list(task.figure.table), columns=SHEAR_STRESS)
    figure = plot.shear_stress(table, surfaces=task.figure.surfaces)
    words = span((table["shear_stress_Pa"] / 1e6).tolist(), " MPa")
    return figure, f"As fitted {words}."


def _effect(task: _Opened) -> tuple[Figure, str]:
    curves = _by_surface(task, "curve")
    return plot.friction_factor_effect(curves, surfaces=task.figure.surfaces), ""


def _factors(task: _Opened) -> tuple[Figure, str]:
    factors = _by_surface(task, "factors")
    return plot.lubrication_factors(factors, surfaces=task.figure.surfaces), ""


def _profiles(task: _Opened) -> tuple[Figure, str]:
    profiles = _read(task, task.figure.models[0], "profiles")
    return plot.film_profiles(profiles, title=task.figure.title), ""


def _sensitivity(task: _Opened) -> tuple[Figure, str]:
    (model,) = task.figure.models
    data = _read(task, model, "uncertainty")
    most = str(data["variation"].values[int(data["largest_change"].values.argmax())])
    figure = plot.model_sensitivity(
        data, surface=model.surface, surfaces=task.figure.surfaces, title=task.figure.title
    )
    return figure, f"Moved most by: {most}."


_MEASURED = "Points: measured, with U95 (95 % coverage); "
_CAPTION_OF_VISCOUS = (
    _MEASURED + "dotted: the model's viscous part; open symbols: dry. Below: the residuals."
)

_KINDS: dict[str, tuple[Callable[[_Opened], tuple[Figure, str]], str]] = {
    "curve": (
        _curve,
        _MEASURED + "full: the model with the fitted shear stress; dashed: its solid part; "
        "dotted: its viscous part; shaded: what the model does not know; open symbols: dry. Below: "
        "the residuals.",
    ),
    "loads": (_loads, "Points: measured; lines: the model with the shear stress of each load."),
    "joint": (
        _joint,
        "Above: points with 95 % intervals of their own errors; the model at each load with the "
        "95 % band of its parameters and, paler, with the errors that the points of a load share. "
        "Below: relative residuals; lines: the share of the offset per load and of errors "
        "correlated between neighbouring speeds.",
    ),
    "shear_stress": (
        _shear_stress,
        "Open: as fitted, for the area without adhesion, with the 95 % interval, the spectrum's "
        "error in it; filled: in the area that adhesion makes. A bar that reaches zero: the shear "
        "stress is not told from zero.",
    ),
    "effect": (_effect, "At the lowest load. Full: with them, dashed: without."),
    "factors": (
        _factors,
        "(a) Pressure flow factor and shear flow factor; (b) friction factors. Where surfaces "
        "agree their lines lie on each other.",
    ),
    "profiles": (
        _profiles,
        "Across the contact, the flat sliding to the right: (a) mean separation, (b) pressure in "
        "the solid contact, (c) pressure in the fluid.",
    ),
    "sensitivity": (
        _sensitivity,
        "Left: the model with its band. Right: how far each thing that is not known moves the "
        "curve at most, at the two ends of its range.",
    ),
}
