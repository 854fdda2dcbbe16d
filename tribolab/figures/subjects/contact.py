"""Figures of rough contacts without adhesion: contact area, gaps, pressure of a line contact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from tribolab.core.untyped import Arguments
from tribolab.core.wording import number
from tribolab.figures.colours import BLACK, surface_colours
from tribolab.figures.envelopes import thinned
from tribolab.figures.labelled import SurfaceOrSeveral, by_load, by_surface
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Mark, Panel, Series, Style, axis_of
from tribolab.figures.subjects.surfaces import shaded_loads

_MPA, _MM, _UM = 1e-6, 1e3, 1e6
_MAX_NAMED_LOADS = 5
PRESSURE_AXIS = axis_of("pressure", unit="MPa", log=True)
AREA_AXIS = axis_of("contact_area_ratio", log=True, decades=4)  # smaller areas are negligible
_MAX_POINTS = 200  # largest number of points of a line


@plotted()
def contact_area(
    contacts: SurfaceOrSeveral, loads: xr.Dataset | None = None, *, surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw relative contact area (without adhesion) against pressure, and mark Hertz pressures.

    Parameters
    ----------
    contacts
        ``contact_area_ratio`` (pressure), with ``_low`` and ``_high`` if known, by the surface's
        name, or one dataset (surface, pressure).
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
    ...         {"contact_area_ratio": tl.contact.contact_area_ratio(pressure, psd, "2 MPa")},
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
        for drawn in area_series(name, contact, "line", colours[name])
    ]
    return FigureSpec(
        title="Contact area without adhesion",
        note="Shaded: effect of the band of the spectrum. Grey: mean Hertz pressures.",
        panels=(Panel(PRESSURE_AXIS, AREA_AXIS, name="contact area"),),
        series=tuple(series),
        marks=hertz_marks(loads),
    )


def area_series(
    name: str, data: xr.Dataset, style: Style, colour: int, what: str = "", medium: str = ""
) -> list[Series]:
    """Return the contact area of a surface as a line, and its band if it is known."""
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


def hertz_marks(loads: xr.Dataset | None) -> tuple[Mark, ...]:
    """Return a grey line at the mean Hertz pressure of each load."""
    if loads is None:
        return ()
    force = loads["normal_force"].values
    few = force.size <= _MAX_NAMED_LOADS
    words = f"Hertz at {', '.join(number(f) for f in force)} N" if few else "Hertz"
    return tuple(Mark("x", _MPA * float(p), text=words) for p in loads["pressure"].values)


@plotted()
def gaps(distributions: SurfaceOrSeveral, *, surfaces: Sequence[str] = ()) -> FigureSpec:
    """Draw the gap distribution as u P(u) against ln u: equal areas are equal probabilities.

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
    >>> gap = tl.contact.gap_distribution
    >>> found = {name: gap("0.04 MPa", psd, "2 MPa") for name, psd in psds.items()}
    >>> tl.plot.figure_data(gaps(found)).series.unique().tolist()
    ['Sb-S', 'Sb-R']
    """
    distributions = by_surface(distributions)
    colours = surface_colours([*surfaces, *distributions])
    series = []
    for name, data in distributions.items():
        smallest = data.attrs.get("cutoff_m", 0.0)  # size of an atom: smaller gaps have no meaning
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
    """Draw the pressure across dry line contacts of rough surfaces, and the Hertz pressure.

    Parameters
    ----------
    lines
        ``pressure`` [Pa] and ``x`` [m] (point or x; load) by the surface's name.
    hertz
        Coordinate x [m] and pressure [Pa] of the smooth contact.
    surfaces
        As for `contact_area`.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psds = {name: xu2026.psd(name, points=301) for name in ("Sb-S", "Sb-R")}
    >>> lines = {
    ...     name: tl.contact.rough_line_contact("310 N/m", xu2026.contact, psd, points=101)
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
    """Draw the contact pressure against the mean separation divided by the rms roughness.

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
