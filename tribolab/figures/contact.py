"""Rough contacts: contact area, adhesion, gaps, pressure across a line contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.figures.colours import BLACK, medium_styles, surface_colours
from tribolab.figures.labelled import SurfaceOrSeveral, by_load, by_surface
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import (
    Axis,
    FigureSpec,
    Key,
    Mark,
    Panel,
    Series,
    Style,
    axis_of,
    thinned,
)
from tribolab.figures.surfaces import shaded_loads
from tribolab.untyped import Arguments
from tribolab.words import number

_MPA, _MM, _UM = 1e-6, 1e3, 1e6
_MAX_NAMED_LOADS = 5
_PRESSURE = axis_of("pressure", unit="MPa", log=True)
_AREA = axis_of("contact_area_ratio", log=True, decades=4)  # less is no contact to speak of
_MEDIA = "Full: in a liquid; dashed: dry."
_MAX_POINTS = 200  # of a line at each of several loads


@plotted()
def contact_area(
    contacts: SurfaceOrSeveral, loads: xr.Dataset | None = None, *, surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw the relative contact area without adhesion over pressure, Hertz pressures marked.

    Parameters
    ----------
    contacts
        ``contact_area_ratio`` (pressure), with ``_low`` and ``_high`` if known, by the surface's
        name, or one dataset over (surface, pressure).
    loads
        ``pressure`` and ``normal_force`` (load): the mean Hertz pressures to mark.
    surfaces
        All surfaces of the study in their order, so that each has the same colour in all figures.

    Examples
    --------
    >>> import numpy as np
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psds = {name: xu2026.psd(name, points=301) for name in ("Sb-S", "Sb-R")}
    >>> pressure = xr.DataArray(np.geomspace(1e3, 1e6, 7), dims="pressure")
    >>> areas = {
    ...     name: xr.Dataset(
    ...         {"contact_area_ratio": tl.contact_area_ratio(pressure, psd, "2 MPa")},
    ...         {"pressure": pressure},
    ...     )
    ...     for name, psd in psds.items()
    ... }
    >>> tl.plot.figure_data(contact_area(areas)).series.unique().tolist()
    ['Sb-S', 'Sb-R']
    """
    contacts = by_surface(contacts)
    colours = surface_colours([*surfaces, *contacts])
    series = [
        drawn
        for name, contact in contacts.items()
        for drawn in _area(name, contact, "line", colours[name])
    ]
    return FigureSpec(
        title="Contact area without adhesion",
        note="Shaded: effect of the band of the spectrum. Grey: mean Hertz pressures.",
        panels=(Panel(_PRESSURE, _AREA, name="contact area"),),
        series=tuple(series),
        marks=_hertz(loads),
    )


def _area(
    name: str, data: xr.Dataset, style: Style, colour: int, what: str = "", medium: str = ""
) -> list[Series]:
    x, area = _MPA * data["pressure"].values, data["contact_area_ratio"].values
    label = f"{name}, {what}" if what else name
    hover = (label,) if what else ()
    line = Series(
        name, x, area, style, colour, surface=name, medium=medium, name=label, hover=hover
    )
    edges = [f"contact_area_ratio_{end}" for end in ("low", "high")]
    if not all(edge in data for edge in edges):
        return [line]
    low, high = (data[edge].values for edge in edges)
    band = Series(name, x, low, "band", colour, high=high, surface=name, medium=medium, name=label)
    return [band, line]


def _hertz(loads: xr.Dataset | None) -> tuple[Mark, ...]:
    """Return a grey line at the mean Hertz pressure of each load."""
    if loads is None:
        return ()
    force = loads["normal_force"].values
    few = force.size <= _MAX_NAMED_LOADS
    words = f"Hertz at {', '.join(number(f) for f in force)} N" if few else "Hertz"
    return tuple(Mark("x", _MPA * float(p), text=words) for p in loads["pressure"].values)


@plotted()
def adhesive_area(
    contacts: SurfaceOrSeveral,
    adhesions: SurfaceOrSeveral,
    loads: xr.Dataset | None = None,
    *,
    surfaces: Sequence[str] = (),
) -> FigureSpec:
    """Draw the relative contact area over pressure, without adhesion and with it in each medium.

    Dotted: without adhesion; dashed: dry; other lines: the other media.

    Parameters
    ----------
    contacts
        As for `contact_area`.
    adhesions
        ``contact_area_ratio`` (medium, pressure), with ``_low`` and ``_high`` if known, by the
        surface's name.
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
    >>> wet = xr.concat([tl.adhesion(pressure, psd, 2e6, w, nodes=60) for w in works], works.medium)
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
            series += _area(name, contacts[name], "dotted", colours[name], "no adhesion")
        for medium in adhesions[name]["medium"].values.tolist() if name in adhesions else ():
            data = adhesions[name].sel(medium=medium)
            series += _area(name, data, media[medium], colours[name], medium, medium)
    return FigureSpec(
        title="Real contact area",
        note=f"Dotted: without adhesion. With adhesion: {_MEDIA[0].lower()}{_MEDIA[1:]} Shaded: "
        "effect of the bands of spectrum and work of adhesion.",
        panels=(Panel(_PRESSURE, _AREA, name="contact area"),),
        series=tuple(series),
        marks=_hertz(loads),
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
    """Draw the effective work of adhesion over the magnification.

    Parameters
    ----------
    adhesions
        ``effective_work_of_adhesion`` [J/m2] (medium, wavenumber) with the coordinate
        ``magnification``, by the surface's name, each at one pressure.
    relative_to
        Work of adhesion gamma_0 [J/m2] of smooth surfaces in each medium: with it
        gamma_eff/gamma_0 is drawn.
    surfaces
        As for `contact_area`.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psds = {name: xu2026.psd(name, points=301) for name in ("Sb-S", "Sb-R")}
    >>> found = {
    ...     name: tl.adhesion(4e4, psd, 2e6, "64 mJ/m^2", nodes=60).expand_dims(medium=["dry"])
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


@plotted()
def gaps(distributions: SurfaceOrSeveral, *, surfaces: Sequence[str] = ()) -> FigureSpec:
    """Draw the distribution of the gap, u P(u) over ln u: equal areas are equal shares.

    Parameters
    ----------
    distributions
        ``gap_density`` [1/m] (gap; load) by the surface's name.
    surfaces
        As for `contact_area`.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psds = {name: xu2026.psd(name, points=301) for name in ("Sb-S", "Sb-R")}
    >>> found = {name: tl.gap_distribution("0.04 MPa", psd, "2 MPa") for name, psd in psds.items()}
    >>> tl.plot.figure_data(gaps(found)).series.unique().tolist()
    ['Sb-S', 'Sb-R']
    """
    distributions = by_surface(distributions)
    colours = surface_colours([*surfaces, *distributions])
    series = []
    for name, data in distributions.items():
        smallest = data.attrs.get("cutoff_m", 0.0)  # a smaller gap is smaller than an atom
        for load, line in by_load(data):
            u = line["gap"].values
            share = u * line["gap_density"].values
            kept = (share > 1e-3 * share.max()) & (u >= smallest)
            some = np.flatnonzero(kept)[thinned(int(kept.sum()), _MAX_POINTS)]
            look: Arguments = {"colour": colours[name], "surface": name}
            series.append(Series(name, _UM * u[some], share[some], load=load, **look))
    y = Axis("area share u P(u)", include=(0.0,), paper="area share per ln(gap) $u\\,P(u)$")
    return FigureSpec(
        title="Gap between the surfaces",
        note="Share of the area per logarithm of the gap where the surfaces do not touch, at the "
        "mean pressure of the load: equal areas under a curve are equal shares.",
        panels=(Panel(axis_of("gap", unit="µm", log=True), y),),
        series=shaded_loads(series),
    )


@plotted()
def line_pressure(
    lines: SurfaceOrSeveral,
    hertz: tuple[np.ndarray, np.ndarray] | None = None,
    *,
    surfaces: Sequence[str] = (),
) -> FigureSpec:
    """Draw the pressure across dry rough line contacts, and that of Hertz.

    Parameters
    ----------
    lines
        ``pressure`` [Pa] and ``x`` [m] (point or x; load) by the surface's name.
    hertz
        x [m] and pressure [Pa] of the smooth contact.
    surfaces
        As for `contact_area`.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psds = {name: xu2026.psd(name, points=301) for name in ("Sb-S", "Sb-R")}
    >>> lines = {
    ...     name: tl.rough_line_contact("310 N/m", xu2026.contact, psd, points=101)
    ...     for name, psd in psds.items()
    ... }
    >>> tl.plot.figure_data(line_pressure(lines)).series.unique().tolist()
    ['Sb-S', 'Sb-R']
    """
    lines = by_surface(lines)
    colours = surface_colours([*surfaces, *lines])
    series = []
    for name, data in lines.items():
        for load, line in by_load(data):
            x, p = _MM * line["x"].values, _MPA * line["pressure"].values
            wide = np.flatnonzero(np.abs(x) <= 1.15 * np.abs(x[p > 1e-3 * p.max()]).max())
            kept = wide[thinned(wide.size, _MAX_POINTS)]
            look: Arguments = {"colour": colours[name], "surface": name}
            series.append(Series(name, x[kept], p[kept], load=load, **look))
    series = list(shaded_loads(series))
    if hertz is not None:
        x, p = _MM * hertz[0], _MPA * hertz[1]
        series.append(Series("Hertz", x, p, "dashed", BLACK))
    return FigureSpec(
        title="Pressure across the dry contact at rest",
        note="Without adhesion.",
        panels=(
            Panel(
                Axis("across the contact", "mm", paper="coordinate across the contact $x$"),
                Axis("contact pressure", "MPa", include=(0.0,), paper="contact pressure $p$"),
                name="pressure",
            ),
        ),
        series=tuple(series),
    )


@plotted()
def contact_separation(
    separations: SurfaceOrSeveral, *, surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw the contact pressure over the mean separation in units of the roughness.

    Parameters
    ----------
    separations
        ``contact_pressure`` [Pa] (separation) with the attribute ``rms_roughness_m``, by the
        surface's name.
    surfaces
        As for `contact_area`.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> found = xr.Dataset(
    ...     {"contact_pressure": ("separation", [2e5, 3e4, 5e3])},
    ...     {"separation": [1e-6, 2e-6, 3e-6]},
    ...     {"rms_roughness_m": 1e-6},
    ... )
    >>> numbers = figure_data(contact_separation({"Sb-R": found}))
    >>> numbers.separation_over_rms_roughness.tolist()
    [1.0, 2.0, 3.0]
    """
    separations = by_surface(separations)
    colours = surface_colours([*surfaces, *separations])
    series = [
        Series(
            name,
            data["separation"].values / data.attrs["rms_roughness_m"],
            _MPA * data["contact_pressure"].values,
            colour=colours[name],
            surface=name,
        )
        for name, data in separations.items()
    ]
    x = Axis(
        "mean separation / rms roughness",
        include=(0.0,),
        paper=r"mean separation / roughness $\bar u/h_{\mathrm{rms}}$",
        column="separation_over_rms_roughness",
    )
    y = Axis("contact pressure", "MPa", log=True, paper=r"contact pressure $p_{\mathrm{cont}}$")
    return FigureSpec(
        title="Pressure carried at a mean separation",
        panels=(Panel(x, y, name="contact pressure"),),
        series=tuple(series),
    )
