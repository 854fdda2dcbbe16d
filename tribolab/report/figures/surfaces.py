"""The figures of the section on surfaces and contact, each drawn by a worker."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab import plot
from tribolab.campaign.store.data_files import optional_data, read_data
from tribolab.report.figures.files import Drawn
from tribolab.words import force_text, many

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from tribolab.records.parts import SurfaceOutcome

_MOST_IN_ONE = 9  # surfaces that can be told apart in one figure


@dataclass(frozen=True)
class SurfaceFigure:
    """A figure to draw: its kind, the data files of the surfaces, where it goes."""

    kind: str
    shown: tuple[tuple[str, str], ...]  # name and data file of each surface that has the data
    surfaces: tuple[str, ...]

    @property
    def files(self) -> tuple[str, ...]:
        """Data files that it reads."""
        return tuple(file for _, file in self.shown)

    @property
    def file(self) -> str:
        """Path of the figure relative to the results folder."""
        return f"figures/{self.kind}.svg"

    @property
    def title(self) -> str:
        """What the figure shows."""
        return _KINDS[self.kind].title


@dataclass(frozen=True)
class _Kind:
    group: str
    title: str
    caption: str
    draw: Callable[[_Opened, dict[str, xr.Dataset]], Figure]


def plan_surface_figures(surfaces: Sequence[SurfaceOutcome]) -> list[SurfaceFigure]:
    """Choose the figures for which at least one surface has data."""
    done = [surface for surface in surfaces if surface.done]
    names = tuple(surface.label for surface in surfaces)
    planned = []
    for kind, known in _KINDS.items():
        mine = [(s.label, s.data_file) for s in done if known.group in s.parts][:_MOST_IN_ONE]
        if kind == "modulus":
            mine = mine[:1]  # one rubber
        if mine:
            planned.append(SurfaceFigure(kind, tuple(mine), names))
    return planned


def draw_surfaces(what: SurfaceFigure, folder: Path) -> Drawn:
    """Draw one figure of surfaces."""
    kind = _KINDS[what.kind]
    task = _Opened(what, folder)
    data = _read(task, kind.group)
    note = kind.caption.format(load=_lowest(data), modulus=_modulus(data))
    caption = f"{kind.title}. {note}".strip()
    alt = f"{kind.title} of {many(len(data), 'surface')} ({', '.join(data)}). {note}".strip()
    return Drawn(kind.draw(task, data), caption, alt, what.kind)


class _Opened(NamedTuple):
    """A figure and the folder with its data files."""

    figure: SurfaceFigure
    folder: Path

    @property
    def surfaces(self) -> tuple[str, ...]:
        return self.figure.surfaces


def _read(task: _Opened, group: str) -> dict[str, xr.Dataset]:
    return {name: read_data(task.folder / file, group=group) for name, file in task.figure.shown}


def _optional(task: _Opened, group: str) -> dict[str, xr.Dataset]:
    """Read a group where it is: of others the campaign knows too little, as its findings say."""
    opened = {name: optional_data(task.folder / file, group) for name, file in task.figure.shown}
    return {name: data for name, data in opened.items() if data is not None}


def _loads(task: _Opened) -> xr.Dataset | None:
    """Return the loads of the surface that has most of them: its Hertz pressures are marked."""
    opened = _optional(task, "loads").values()
    return max(opened, key=lambda loads: loads.sizes["load"], default=None)


def _at_lowest(data: dict[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    return {name: contact.isel(load=0) for name, contact in data.items()}


def _with_loads(data: dict[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    return {name: contact for name, contact in data.items() if contact.sizes.get("load")}


def _lowest(data: dict[str, xr.Dataset]) -> str:
    """Say at which load each curve was computed."""
    forces = {
        float(contact.normal_force.values.flat[0])
        for contact in data.values()
        if "normal_force" in contact and contact.normal_force.size
    }
    return " or ".join(force_text(force) for force in sorted(forces)) or "its lowest load"


def _modulus(data: dict[str, xr.Dataset]) -> str:
    return next((str(d.attrs["modulus"]) for d in data.values() if "modulus" in d.attrs), "")


def _spectra(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    return plot.spectra(data, surfaces=task.surfaces)


def _area(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    return plot.contact_area(data, _loads(task), surfaces=task.surfaces)


def _adhesive_area(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    without = _optional(task, "contact")
    return plot.adhesive_area(without, data, _loads(task), surfaces=task.surfaces)


def _effective_work(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    return plot.effective_work(_at_lowest(_with_loads(data)), surfaces=task.surfaces)


def _gaps(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    return plot.gaps(_at_lowest(data), surfaces=task.surfaces)


def _lines(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    """Rough profiles, and Hertz at the load of the first of them."""
    loads = _optional(task, "loads")
    hertz = None
    if loads:
        first = next(iter(loads.values())).isel(load=0)
        half, top = float(first.contact_width) / 2, float(first.max_pressure)
        x = half * np.sin(np.linspace(-np.pi / 2, np.pi / 2, 201))
        hertz = x, top * np.sqrt(np.maximum(1 - (x / half) ** 2, 0))
    return plot.line_pressure(_at_lowest(data), hertz, surfaces=task.surfaces)


def _modulus_figure(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    return plot.modulus(next(iter(data.values())))


def _viscoelastic(task: _Opened, data: dict[str, xr.Dataset]) -> Figure:
    return plot.viscoelastic(_at_lowest(data), surfaces=task.surfaces)


_KINDS = {
    "spectra": _Kind(
        "psd",
        "Power spectra",
        "Full: measured; dashed: extrapolated; shaded: 95 % band.",
        _spectra,
    ),
    "contact_area": _Kind(
        "contact",
        "Contact area without adhesion",
        "Shaded: what the band of the spectrum allows. Grey: mean Hertz pressures of the loads.",
        _area,
    ),
    "effective_work": _Kind(
        "adhesion_loads",
        "Effective work of adhesion",
        "Over the magnification, at vanishing load. Zero at magnification 1 means that no force "
        "is needed to pull the bodies apart.",
        _effective_work,
    ),
    "adhesive_area": _Kind(
        "adhesion",
        "Contact area with adhesion",
        "Dotted: without adhesion; dashed: dry. Shaded: what the bands of spectrum and work of "
        "adhesion allow. Grey: mean Hertz pressures of the loads.",
        _adhesive_area,
    ),
    "gaps": _Kind(
        "gap",
        "Gap between the surfaces",
        "Where they do not touch, at the mean Hertz pressure of {load}.",
        _gaps,
    ),
    "line_pressure": _Kind(
        "line",
        "Pressure across the dry contact at rest",
        "Without adhesion, at {load}. Dashed: smooth surfaces (Hertz).",
        _lines,
    ),
    "modulus": _Kind("modulus", "Modulus of the rubber", "{modulus}.", _modulus_figure),
    "viscoelastic": _Kind(
        "rubber",
        "Viscoelastic friction",
        "What the losses in the rubber add to friction, at {load}; no flash heating, no adhesion.",
        _viscoelastic,
    ),
}
