"""Surfaces and their contact: spectra, areas, gaps, pressures, and the rubber."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribolab.campaign.store.data_files import read_data
from tribolab.figures.envelope import envelope
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, places, thinned
from tribolab.report.live.record import LiveRecord
from tribolab.report.live.shown import shown_figures
from tribolab.surface.form import remove_form
from tribolab.untyped import Arguments
from tribolab.words import is_dry

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.records.parts import SurfaceOutcome

_AREA = Axis("relative contact area A/A₀", log=True)
_Y = "_low", "_high"
_COLUMNS = 600  # of a profile, each with its lowest and its highest point
_BETWEEN = 0.1  # of a profile's heights, between it and the next


class _Surface(NamedTuple):
    """A surface, its colour, and its data file."""

    name: str
    colour: int
    file: Path
    parts: tuple[str, ...]
    label: str

    def read(self, group: str) -> xr.Dataset | None:
        return read_data(self.file, group=group) if group in self.parts else None

    def series(self, what: str, x: Any, y: Any, **more: Any) -> Series:
        told = (f"{self.label}: {what}",) if what else ()
        labels: Arguments = {"colour": self.colour, "surface": self.name, "hover": told}
        return Series(self.label, x, y, **(labels | more))


def record_of_surfaces(
    surfaces: Sequence[SurfaceOutcome], order: Sequence[str], folder: Path
) -> LiveRecord:
    """Return the figures of the sections on surfaces and contact for which there are data.

    Parameters
    ----------
    surfaces
        What they came to.
    order
        Names in the order of the campaign, which colours follow.
    folder
        The results folder with their data files.
    """
    colours = places([*order, *(surface.name for surface in surfaces)])
    opened = [
        _Surface(
            outcome.name,
            colours[outcome.name],
            folder / outcome.data_file,
            outcome.parts,
            outcome.label,
        )
        for outcome in surfaces
        if outcome.done
    ]
    figures = []
    for kind in _KINDS:
        series = [drawn for surface in opened for drawn in kind.draw(surface)]
        if kind.once:
            series = [drawn for drawn in series if drawn.surface == series[0].surface]
        if kind.stacked:
            series = _stacked(series)
        if series:
            loads = len({drawn.load for drawn in series if drawn.load is not None}) > 1
            alt = f"{kind.title}: {', '.join(dict.fromkeys(drawn.surface for drawn in series))}."
            panels = (Panel(kind.x, kind.y),)
            figures.append(
                FigureSpec(
                    f"{kind.section}-{kind.name}",
                    kind.section,
                    kind.title,
                    kind.note,
                    alt,
                    panels,
                    tuple(series),
                    one_load=loads,
                )
            )
    return LiveRecord(shown_figures(figures))


class _Kind(NamedTuple):
    name: str
    section: str
    title: str
    note: str
    x: Axis
    y: Axis
    draw: Callable[[_Surface], list[Series]]
    once: bool = False
    stacked: bool = False


def _heights(surface: _Surface) -> list[Series]:
    """One profile of a surface, of maps the row in the middle, without the form that was taken off.

    Marks of missing heights are gaps.
    """
    scans, rough = surface.read("scans"), surface.read("roughness")
    if scans is None or rough is None:
        return []
    form = str(rough.attrs.get("form_removed", "none"))
    first = scans[["height"]].isel({dim: [0] for dim in ("scan",) if dim in scans.dims})
    flat = first if form == "none" else remove_form(first, form)
    height = flat["height"]
    middle = {dim: height.sizes[dim] // 2 for dim in height.dims if dim != "x"}
    profile = height.isel(middle)
    if not np.isfinite(profile.values).any():  # a row of a map without any height
        return []
    x, z = envelope(profile["x"].values, profile.values, _COLUMNS)
    return [surface.series("", 1e3 * (x - x[0]), 1e6 * (z - np.nanmean(z)))]


def _stacked(series: Sequence[Series]) -> list[Series]:
    """Profiles one above another, the first on top, by as much as their heights reach."""
    result: list[Series] = []
    top = 0.0
    for one in series:
        z = np.asarray(one.y, float)
        if result:
            z = z - np.nanmax(z) + top
        top = float(np.nanmin(z)) - _BETWEEN * float(np.nanmax(z) - np.nanmin(z))
        result.append(replace(one, y=z))
    return result


def _spectra(surface: _Surface) -> list[Series]:
    data = surface.read("psd")
    if data is None:
        return []
    q = data["wavenumber"].values
    low, high = (data[f"psd_2d{end}"].values for end in _Y)
    measured = data["origin"].values == 0
    if not measured.any():
        measured = np.ones(q.size, bool)
    first, last = np.flatnonzero(measured)[[0, -1]]
    value = data["psd_2d"].values
    return [
        surface.series("", q, low, style="band", high=high),
        surface.series("", q[first : last + 1], value[first : last + 1]),
        *(
            surface.series("extrapolated", q[part], value[part], style="dashed")
            for part in (slice(0, first + 1), slice(last, None))
            if q[part].size > 1
        ),
    ]


def _banded(surface: _Surface, label: str, data: xr.Dataset, style: str) -> list[Series]:
    x = data["pressure"].values / 1e6
    edges = [data[f"contact_area_ratio{end}"] for end in _Y if f"contact_area_ratio{end}" in data]
    value = data["contact_area_ratio"].values
    more = {"medium": str(data["medium"].values)} if "medium" in data.coords else {}
    line = surface.series(label, x, value, style=style, **more)
    if len(edges) < 2:
        return [line]
    low, high = (edge.values for edge in edges)
    return [surface.series(label, x, low, style="band", high=high, **more), line]


def _areas(surface: _Surface) -> list[Series]:
    series = []
    contact, adhesion = surface.read("contact"), surface.read("adhesion")
    if contact is not None:
        series += _banded(surface, "without adhesion", contact, "dotted")
    for medium in [] if adhesion is None else adhesion["medium"].values.tolist():
        style = "dashed" if is_dry(medium) else "line"
        assert adhesion is not None
        series += _banded(surface, f"with adhesion, {medium}", adhesion.sel(medium=medium), style)
    return series


def _work(surface: _Surface) -> list[Series]:
    data = surface.read("adhesion_loads")
    if data is None or "effective_work_of_adhesion" not in data:
        return []
    kept = thinned(data.sizes["wavenumber"])
    series = []
    for medium in data["medium"].values.tolist():
        work = 1e3 * data["effective_work_of_adhesion"].sel(medium=medium).values[kept]
        style = "dashed" if is_dry(medium) else "line"
        x = data["magnification"].values[kept]
        series.append(surface.series(medium, x, work, style=style, medium=medium))
    return series


def _at_loads(
    group: str, name: str, along: str, factors: tuple[float, float]
) -> Callable[[_Surface], list[Series]]:
    """Return what draws one variable of a group, a line for each load."""

    def draw(surface: _Surface) -> list[Series]:
        data = surface.read(group)
        if data is None:
            return []
        dim = next(str(d) for d in data[name].dims if d != "load")
        kept = thinned(data.sizes[dim], 200)
        series = []
        for number in range(data.sizes["load"]):
            line = data.isel({"load": number, dim: kept})
            force = float(line["normal_force"].values.flat[0])
            x, y = factors[0] * line[along].values, factors[1] * line[name].values
            series.append(surface.series("", x, y, load=round(force, 6)))
        return series

    return draw


def _modulus(surface: _Surface) -> list[Series]:
    data = surface.read("modulus")
    if data is None:
        return []
    x = data["angular_frequency"].values
    storage, loss = (data[f"{name}_modulus"].values / 1e6 for name in ("storage", "loss"))
    # one rubber: the lines are told apart by what they are
    return [
        Series("storage modulus", x, storage, surface=surface.name),
        Series("loss modulus", x, loss, "dashed", 1, surface=surface.name),
    ]


_KINDS = (
    _Kind(
        "profiles",
        "surfaces",
        "Profiles",
        "The first scan of each surface without the form that was taken off (of a map the row in "
        "its middle), one above another; a column of points shows its lowest and highest.",
        Axis("position", "mm"),
        Axis("height", "µm"),
        _heights,
        stacked=True,
    ),
    _Kind(
        "spectra",
        "surfaces",
        "Power spectra of the roughness",
        "Full: measured; dashed: extrapolated; shaded: 95 % band.",
        Axis("wavenumber q", "1/m", log=True),
        Axis("power spectrum C(q)", "m⁴", log=True),
        _spectra,
    ),
    _Kind(
        "modulus",
        "surfaces",
        "Modulus of the rubber",
        "",
        Axis("angular frequency", "rad/s", log=True),
        Axis("modulus", "MPa", log=True),
        _modulus,
        once=True,
    ),
    _Kind(
        "area",
        "contact",
        "Real contact area",
        "Dotted: without adhesion; full: with adhesion in a liquid; dashed: with adhesion, dry. "
        "Shaded: what the bands of spectrum and work of adhesion allow.",
        Axis("pressure", "MPa", log=True),
        _AREA,
        _areas,
    ),
    _Kind(
        "work",
        "contact",
        "Effective work of adhesion",
        "Full: in a liquid; dashed: dry. Over the magnification at which the roughness is looked "
        "at; zero at magnification 1 means that no force is needed to pull the bodies apart.",
        Axis("magnification", log=True),
        Axis("effective work of adhesion", "mJ/m²"),
        _work,
    ),
    _Kind(
        "gaps",
        "contact",
        "Gap between the surfaces",
        "How often each gap occurs where they do not touch, at the mean pressure of the load.",
        Axis("gap", "µm", log=True, decades=4),
        Axis("probability density", "1/µm", log=True, decades=6),
        _at_loads("gap", "gap_density", "gap", (1e6, 1e-6)),
    ),
    _Kind(
        "pressure",
        "contact",
        "Pressure across the dry contact at rest",
        "Without adhesion.",
        Axis("across the contact", "mm"),
        Axis("pressure", "MPa"),
        _at_loads("line", "pressure", "x", (1e3, 1e-6)),
    ),
    _Kind(
        "viscoelastic",
        "contact",
        "Friction by losses in the rubber",
        "Without flash heating and adhesion.",
        Axis("sliding speed v", "m/s", log=True),
        Axis("viscoelastic part of µ"),
        _at_loads("rubber", "friction_coefficient", "sliding_speed", (1.0, 1.0)),
    ),
)
