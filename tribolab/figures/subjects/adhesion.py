"""Figures of adhesive contact: real contact area, effective work of adhesion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray as xr

from tribolab.figures.colours import medium_styles, surface_colours
from tribolab.figures.envelopes import thinned
from tribolab.figures.labelled import SurfaceOrSeveral, by_surface
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Panel, Series, Style, axis_of
from tribolab.figures.subjects.contact import AREA_AXIS, PRESSURE_AXIS, area_series, hertz_marks

_MEDIA = "Full: in a liquid; dashed: dry."


@plotted()
def adhesive_area(
    contacts: SurfaceOrSeveral,
    adhesions: SurfaceOrSeveral,
    loads: xr.Dataset | None = None,
    *,
    surfaces: Sequence[str] = (),
) -> FigureSpec:
    """Draw relative contact area against pressure: without adhesion, and with it in each medium.

    Dotted: without adhesion; dashed: dry; other lines: the other media.

    Parameters
    ----------
    contacts
        As for `contact_area`.
    adhesions
        ``contact_area_ratio`` (medium, pressure), with ``_low`` and ``_high`` if known, by surface.
    loads, surfaces
        As for `contact_area`.

    Examples
    --------
    >>> import numpy as np
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psds = {name: xu2026.psd(name, points=301) for name in ("Sb-S", "Sb-R")}
    >>> psd, pressure = psds["Sb-S"], np.array([1e4, 1e5])
    >>> works = xr.DataArray([0.064, 0.051], {"medium": ["dry", "glycerol"]}, "medium")
    >>> media = [tl.contact.adhesion(pressure, psd, 2e6, w, nodes=60) for w in works]
    >>> wet = xr.concat(media, works.medium)
    >>> bare = wet.isel(medium=0)[["contact_area_ratio_no_adhesion"]]
    >>> bare = bare.rename(contact_area_ratio_no_adhesion="contact_area_ratio")
    >>> figure = adhesive_area({"Sb-S": bare}, {"Sb-S": wet})
    >>> tl.plot.figure_data(figure).series.unique().tolist()
    ['Sb-S, no adhesion', 'Sb-S, dry', 'Sb-S, glycerol']
    """
    contacts, adhesions = by_surface(contacts), by_surface(adhesions)
    colours = surface_colours([*surfaces, *contacts, *adhesions])
    media = _media(adhesions)
    series: list[Series] = []
    for name in dict.fromkeys([*contacts, *adhesions]):
        if name in contacts:
            series += area_series(name, contacts[name], "dotted", colours[name], "no adhesion")
        for medium in adhesions[name]["medium"].values.tolist() if name in adhesions else ():
            data = adhesions[name].sel(medium=medium)
            series += area_series(name, data, media[medium], colours[name], medium, medium)
    return FigureSpec(
        title="Real contact area",
        note=f"Dotted: without adhesion. With adhesion: {_MEDIA[0].lower()}{_MEDIA[1:]} Shaded: "
        "effect of the bands of spectrum and work of adhesion.",
        panels=(Panel(PRESSURE_AXIS, AREA_AXIS, name="contact area"),),
        series=tuple(series),
        marks=hertz_marks(loads),
        keys=(Key("no adhesion", "dotted"), *_media_keys(media)),
    )


def _media(adhesions: Mapping[str, xr.Dataset]) -> dict[str, Style]:
    return medium_styles(m for d in adhesions.values() for m in d["medium"].values.tolist())


def _media_keys(media: Mapping[str, Style]) -> tuple[Key, ...]:
    return tuple(Key(medium, style) for medium, style in media.items())


@plotted()
def effective_work(
    adhesions: SurfaceOrSeveral,
    *,
    relative_to: Mapping[str, float] | None = None,
    surfaces: Sequence[str] = (),
) -> FigureSpec:
    """Draw the effective work of adhesion against magnification.

    Parameters
    ----------
    adhesions
        ``effective_work_of_adhesion`` [J/m2] (medium, wavenumber) with the coordinate
        ``magnification``, at one pressure, by name of the surface.
    relative_to
        Work of adhesion gamma_0 [J/m2] of smooth surfaces in each medium; if given, the figure
        shows gamma_eff/gamma_0.
    surfaces
        As for `contact_area`.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psds = {name: xu2026.psd(name, points=301) for name in ("Sb-S", "Sb-R")}
    >>> found = {
    ...     name: tl.contact.adhesion(4e4, psd, 2e6, 0.064, nodes=60).expand_dims(medium=["dry"])
    ...     for name, psd in psds.items()
    ... }
    >>> tl.plot.figure_data(effective_work(found)).series.unique().tolist()
    ['Sb-S, dry', 'Sb-R, dry']
    """
    adhesions = by_surface(adhesions)
    colours = surface_colours([*surfaces, *adhesions])
    media = _media(adhesions)
    series = []
    for name, data in adhesions.items():
        kept = thinned(data.sizes["wavenumber"])
        for medium in data["medium"].values.tolist():
            work = data["effective_work_of_adhesion"].sel(medium=medium).values[kept]
            drawn = 1e3 * work if relative_to is None else work / relative_to[medium]
            series.append(
                Series(
                    name, data["magnification"].values[kept], drawn, media[medium], colours[name],
                    surface=name, medium=medium, name=f"{name}, {medium}",
                    hover=(f"{name}: {medium}",),
                )
            )  # fmt: skip
    y = Axis("effective work of adhesion", "mJ/m²", include=(0.0,))
    if relative_to is not None:
        words = r"effective work of adhesion $\gamma_{\mathrm{eff}}/\gamma_0$"
        y = Axis("effective work of adhesion γ/γ₀", include=(0.0,), paper=words)
    return FigureSpec(
        title="Effective work of adhesion",
        note=f"{_MEDIA} Over the magnification at which the roughness is resolved; zero at "
        "magnification 1 means that no force is needed to separate the bodies.",
        panels=(Panel(axis_of("magnification", log=True), y),),
        series=tuple(series),
        keys=_media_keys(media),
    )
