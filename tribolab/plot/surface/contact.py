"""Figures of rough contacts: contact area, adhesion, gaps, pressure across a line contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.typing import LineStyleType

from tribolab.figures.labels import column, label
from tribolab.figures.look.frame import (
    SurfaceOrSeveral,
    by_surface,
    colours,
    logarithmic,
    name_style,
    name_surfaces,
    shaded_band,
)
from tribolab.figures.look.guests import one_panel
from tribolab.figures.look.style import BLACK, GREY, keep
from tribolab.words import is_dry, number

_SMALLEST_AREA = 1e-4
_WET_STYLES: tuple[LineStyleType, ...] = ("-", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)))
_DRY_STYLES: tuple[LineStyleType, ...] = ("--", (0, (2, 1)))


def contact_area(
    contacts: SurfaceOrSeveral,
    loads: xr.Dataset | None = None,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the relative contact area without adhesion over pressure, Hertz pressures marked.

    Parameters
    ----------
    contacts
        ``contact_area_ratio`` (pressure), with ``_low`` and ``_high`` where known, by the
        surface's name, or one dataset over (surface, pressure).
    loads
        ``pressure`` and ``normal_force`` (load): the mean Hertz pressures to mark.
    surfaces
        All surfaces of the study in their order, so that each keeps its colour.
    title
        Text above the figure.
    ax
        Axes to draw in, which keep their look; without them a figure is made. The legend takes in
        what is drawn there already; ``ax.legend()`` makes it anew after more has been drawn.

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
    chosen = colours(list(contacts), surfaces)
    with one_panel(ax, title) as (figure, axes):
        for name, contact in contacts.items():
            p, area = contact.pressure.values, contact.contact_area_ratio.values
            columns = {column("pressure"): p, "contact_area_ratio": area}
            if "contact_area_ratio_low" in contact:
                low, high = (contact[f"contact_area_ratio_{end}"].values for end in ("low", "high"))
                shaded_band(axes, p, low, high, chosen[name])
                columns |= {"contact_area_ratio_low": low, "contact_area_ratio_high": high}
            axes.plot(p, area, color=chosen[name], linewidth=1.1)
            keep(figure, "contact area", name, **columns)
        name_surfaces(axes, chosen)
        _mark(figure, axes, loads)
        _area_axes(axes)
    return figure


def adhesive_area(
    contacts: SurfaceOrSeveral,
    adhesions: SurfaceOrSeveral,
    loads: xr.Dataset | None = None,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the relative contact area over pressure, without adhesion and with it in each medium.

    Parameters
    ----------
    contacts
        As for `contact_area`.
    adhesions
        ``contact_area_ratio`` (medium, pressure), with ``_low`` and ``_high`` where known, by the
        surface's name.
    loads, surfaces, title, ax
        As for `contact_area`.

    Returns
    -------
    matplotlib.figure.Figure
        Dotted: without adhesion; dashed: dry; full and other lines: the other media.

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
    contacts = by_surface(contacts)
    adhesions = by_surface(adhesions)
    chosen = colours(list(adhesions), surfaces)
    media = _media(adhesions)
    with one_panel(ax, title) as (figure, axes):
        for name, contact in adhesions.items():
            if name in contacts:
                p, area = (contacts[name][k].values for k in ("pressure", "contact_area_ratio"))
                axes.plot(p, area, color=chosen[name], linestyle=":", linewidth=1.1)
                columns = {column("pressure"): p, "contact_area_ratio": area}
                keep(figure, "contact area", f"{name}, no adhesion", **columns)
            for medium in contact.medium.values.tolist():
                wet, p = contact.sel(medium=medium), contact.pressure.values
                area = wet.contact_area_ratio.values
                columns = {column("pressure"): p, "contact_area_ratio": area}
                if "contact_area_ratio_low" in wet:
                    low, high = (wet[f"contact_area_ratio_{end}"].values for end in ("low", "high"))
                    shaded_band(axes, p, low, high, chosen[name])
                    columns |= {"contact_area_ratio_low": low, "contact_area_ratio_high": high}
                axes.plot(p, area, color=chosen[name], linestyle=media[medium], linewidth=1.1)
                keep(figure, "contact area", f"{name}, {medium}", **columns)
        name_surfaces(axes, chosen)
        name_style(axes, "no adhesion", linestyle=":")
        for medium, style in media.items():
            name_style(axes, medium, linestyle=style)
        _mark(figure, axes, loads)
        _area_axes(axes)
    return figure


def effective_work(
    adhesions: SurfaceOrSeveral,
    *,
    relative_to: Mapping[str, float] | None = None,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the effective work of adhesion over the magnification.

    Parameters
    ----------
    adhesions
        ``effective_work_of_adhesion`` [J/m2] (medium, wavenumber) with the coordinate
        ``magnification``, by the surface's name, each at one pressure.
    relative_to
        Work of adhesion gamma_0 [J/m2] of smooth surfaces in each medium: with it
        gamma_eff/gamma_0 is drawn.
    surfaces, title, ax
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
    chosen = colours(list(adhesions), surfaces)
    media = _media(adhesions)
    with one_panel(ax, title, left=16) as (figure, axes):
        for name, contact in adhesions.items():
            for medium in contact.medium.values.tolist():
                zeta = contact.magnification.values
                work = contact.effective_work_of_adhesion.sel(medium=medium).values
                columns = {"magnification": zeta, column("effective_work_of_adhesion"): work}
                drawn = work
                if relative_to is not None:
                    drawn = columns["relative_to_smooth"] = work / relative_to[medium]
                axes.plot(zeta, drawn, color=chosen[name], linestyle=media[medium], linewidth=1.1)
                keep(figure, "effective work of adhesion", f"{name}, {medium}", **columns)
        name_surfaces(axes, chosen)
        for medium, style in media.items():
            name_style(axes, medium, linestyle=style)
        logarithmic(axes, "x")
        axes.set_xlim(1, axes.dataLim.x1)
        axes.set_ylim(-0.02 * axes.dataLim.y1, 1.06 * axes.dataLim.y1)
        axes.set_xlabel(label("magnification"))
        words = r"$\gamma_{\mathrm{eff}}$ (J/m$^2$)"
        if relative_to is not None:
            words = r"$\gamma_{\mathrm{eff}}/\gamma_0$"
        axes.set_ylabel(f"effective work of\nadhesion {words}")
    return figure


def gaps(
    distributions: SurfaceOrSeveral,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the distribution of the gap, u P(u) over ln u: equal areas are equal shares.

    Parameters
    ----------
    distributions
        ``gap_density`` [1/m] (gap) by the surface's name, each at one pressure.
    surfaces, title, ax
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
    chosen = colours(list(distributions), surfaces)
    with one_panel(ax, title, left=16) as (figure, axes):
        ends = []
        for name, data in distributions.items():
            u, density = data.gap.values, data.gap_density.values
            share = u * density
            axes.plot(u, share, color=chosen[name], linewidth=1.1)
            ends.append(u[share > 1e-3 * share.max()][[0, -1]])
            columns = {column("gap"): u, "gap_density_1_m": density}
            keep(figure, "gap", name, **columns)
        name_surfaces(axes, chosen)
        logarithmic(axes, "x")
        # below the cut-off a gap is smaller than an atom
        smallest = min(data.attrs.get("cutoff_m", 0.0) for data in distributions.values())
        axes.set_xlim(max(np.min(ends) / 1.5, smallest), 1.5 * np.max(ends))
        axes.set_ylim(0, 1.08 * axes.dataLim.y1)
        axes.set_xlabel(label("gap"))
        axes.set_ylabel("share of the area per\nlogarithm of the gap $u\\,P(u)$")
    return figure


def line_pressure(
    lines: SurfaceOrSeveral,
    hertz: tuple[np.ndarray, np.ndarray] | None = None,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the pressure across dry rough line contacts, beside that of Hertz.

    Parameters
    ----------
    lines
        ``pressure`` [Pa] and ``x`` [m] (point or x) by the surface's name, each at one load.
    hertz
        x [m] and pressure [Pa] of the smooth contact.
    surfaces, title, ax
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
    chosen = colours(list(lines), surfaces)
    with one_panel(ax, title) as (figure, axes):
        widest = 0.0
        for name, line in lines.items():
            x, p = line["x"].values, line["pressure"].values
            axes.plot(1e3 * x, 1e-6 * p, color=chosen[name], linewidth=1.1)
            keep(figure, "pressure", name, x_m=x, pressure_Pa=p)
            widest = max(widest, 1e3 * np.abs(x[p > 1e-3 * p.max()]).max())
        name_surfaces(axes, chosen)
        if hertz is not None:
            x, p = hertz
            axes.plot(1e3 * x, 1e-6 * p, color=BLACK, linestyle="--", linewidth=0.8, label="Hertz")
            keep(figure, "pressure", "Hertz", x_m=x, pressure_Pa=p)
        axes.set_xlim(-1.15 * widest, 1.15 * widest)
        axes.set_ylim(0, 1.08 * axes.dataLim.y1)
        axes.set_xlabel("coordinate across the contact $x$ (mm)")
        axes.set_ylabel("contact pressure $p$ (MPa)")
    return figure


def _media(adhesions: SurfaceOrSeveral) -> dict[str, LineStyleType]:
    """Give every medium a line style: dashed where it is dry."""
    names = dict.fromkeys(m for data in adhesions.values() for m in data.medium.values.tolist())
    dry = [name for name in names if is_dry(name)]
    wet = [name for name in names if not is_dry(name)]
    return {
        name: styles[rank % len(styles)]
        for group, styles in ((wet, _WET_STYLES), (dry, _DRY_STYLES))
        for rank, name in enumerate(group)
    }


def _mark(figure: Figure, axes: Axes, loads: xr.Dataset | None) -> None:
    if loads is None:
        return
    pressure, force = loads.pressure.values, loads.normal_force.values
    for p in pressure:
        axes.axvline(p, color=GREY, linewidth=0.6, zorder=0)
    text = ", ".join(number(f) for f in force) if force.size <= 5 else "the loads"
    name_style(axes, f"Hertz at {text} N" if force.size <= 5 else "Hertz", linewidth=0.6)
    keep(figure, "Hertz pressure", "loads", normal_force_N=force, pressure_Pa=pressure)


def _area_axes(axes: Axes) -> None:
    logarithmic(axes, "x", "y")
    axes.set_xlim(axes.dataLim.x0, axes.dataLim.x1)
    axes.set_ylim(max(axes.dataLim.y0 / 1.3, _SMALLEST_AREA), 1.3)
    axes.set_xlabel(label("pressure"))
    axes.set_ylabel(label("contact_area_ratio"))


def contact_separation(
    separations: SurfaceOrSeveral,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the contact pressure over the mean separation in units of the roughness.

    Parameters
    ----------
    separations
        ``contact_pressure`` [Pa] (separation) with the attribute ``rms_roughness_m``, by the
        surface's name.
    surfaces, title, ax
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
    chosen = colours(list(separations), surfaces)
    with one_panel(ax, title) as (figure, axes):
        for name, separation in separations.items():
            over = separation.separation.values / separation.attrs["rms_roughness_m"]
            p = separation.contact_pressure.values
            axes.plot(over, 1e-6 * p, color=chosen[name], linewidth=1.1)
            columns = {"separation_over_rms_roughness": over, "contact_pressure_Pa": p}
            keep(figure, "contact pressure", name, **columns)
        name_surfaces(axes, chosen)
        logarithmic(axes, "y")
        axes.set_xlim(0, axes.dataLim.x1)
        axes.set_xlabel(r"mean separation / roughness $\bar u/h_{\mathrm{rms}}$")
        axes.set_ylabel(r"contact pressure $p_{\mathrm{cont}}$ (MPa)")
    return figure
