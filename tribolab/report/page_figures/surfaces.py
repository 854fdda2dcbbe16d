"""Figures of the sections on surfaces and contact, from the data files of a campaign."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.store.data_files import read_data
from tribolab.figures.spec import FigureSpec
from tribolab.figures.subjects import adhesion
from tribolab.figures.subjects import contact as contacts
from tribolab.figures.subjects import surfaces as rough

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.records.parts import SurfaceOutcome


class _Opened:
    """Surfaces that have results, with the results folder from which their data are read."""

    def __init__(
        self, surfaces: Sequence[SurfaceOutcome], order: Sequence[str], folder: Path
    ) -> None:
        self.surfaces = [surface for surface in surfaces if surface.done]
        self.order = [*order, *(surface.name for surface in self.surfaces)]
        self.folder = folder

    def read(self, group: str) -> dict[str, xr.Dataset]:
        """Return one group of data by name of the surface, for surfaces that have this group."""
        return {
            surface.name: read_data(self.folder / surface.data_file, group=group)
            for surface in self.surfaces
            if group in surface.parts
        }

    def loads(self) -> xr.Dataset | None:
        """Return the loads whose Hertz pressures are marked, from the surface with most loads."""
        return max(self.read("loads").values(), key=lambda one: one.sizes["load"], default=None)


def surface_specs(
    surfaces: Sequence[SurfaceOutcome], order: Sequence[str], alone: bool, folder: Path
) -> list[FigureSpec]:
    """Return the figures of the sections on surfaces and contact, if there are data for them.

    Parameters
    ----------
    surfaces
        Records of the surfaces.
    order
        Names in the order of the campaign, which sets colours.
    alone
        Whether there are no runs; then profiles and spectra come first.
    folder
        The results folder with their data files.
    """
    opened = _Opened(surfaces, order, folder)
    names = {surface.name: surface.label for surface in opened.surfaces}
    specs = []
    for name, describe in _FIGURES.items():
        section = name.partition("-")[0]
        section = "view-surfaces" if alone and section == "surfaces" else section
        spec = describe(opened)
        if spec is None or not spec.series:
            continue
        shown = dict.fromkeys(one.surface for one in spec.series if one.surface)
        series = tuple(replace(one, label=names.get(one.label, one.label)) for one in spec.series)
        one_load = len({one.load for one in series if one.load is not None}) > 1
        alt = f"{spec.title}: {', '.join(shown)}."
        specs.append(
            replace(spec, id=name, section=section, alt=alt, series=series, one_load=one_load)
        )
    return specs


def _profiles(opened: _Opened) -> FigureSpec:
    scans, roughness = opened.read("scans"), opened.read("roughness")
    both = {name: scan for name, scan in scans.items() if name in roughness}
    for name, scan in both.items():
        scan.attrs["form_removed"] = roughness[name].attrs.get("form_removed", "none")
    return rough.profiles.spec(both, surfaces=opened.order)


def _modulus(opened: _Opened) -> FigureSpec | None:
    first = next(iter(opened.read("modulus").items()), None)  # any surface: the rubber is the same
    if first is None:
        return None
    spec = rough.modulus.spec(first[1].assign_attrs(surface=first[0]))
    return replace(spec, note=str(first[1].attrs.get("modulus", "")))


def _areas(opened: _Opened) -> FigureSpec:
    dry, adhesive = opened.read("contact"), opened.read("adhesion")
    return adhesion.adhesive_area.spec(dry, adhesive, opened.loads(), surfaces=opened.order)


def _works(opened: _Opened) -> FigureSpec:
    loaded = opened.read("adhesion_loads")
    known = {
        name: data.isel(load=0) if "load" in data.dims else data
        for name, data in loaded.items()
        if "effective_work_of_adhesion" in data and data.sizes.get("load", 1)
    }
    return adhesion.effective_work.spec(known, surfaces=opened.order)


def _each(describe: Callable[..., FigureSpec], group: str, opened: _Opened) -> FigureSpec | None:
    data: Mapping[str, xr.Dataset] = opened.read(group)
    return describe(data, surfaces=opened.order) if data else None


_FIGURES: dict[str, Callable[[_Opened], FigureSpec | None]] = {
    "surfaces-profiles": _profiles,
    "surfaces-spectra": partial(_each, rough.spectra.spec, "psd"),
    "surfaces-modulus": _modulus,
    "contact-area": _areas,
    "contact-work": _works,
    "contact-gaps": partial(_each, contacts.gaps.spec, "gap"),
    "contact-pressure": partial(_each, contacts.line_pressure.spec, "line"),
    "contact-viscoelastic": partial(_each, rough.viscoelastic.spec, "rubber"),
}
