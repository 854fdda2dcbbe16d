"""Figures of surfaces (profiles, spectra) and of rubber (modulus, viscoelastic friction)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.figures.colours import shade_of, surface_colours
from tribolab.figures.envelopes import envelope
from tribolab.figures.labelled import SurfaceOrSeveral, by_load, by_surface
from tribolab.figures.labels import column
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Panel, Series, Style, axis_of
from tribolab.surface.form import remove_form

_MEASURED = 0
_COLUMNS = 600  # columns of a profile in which minimum and maximum are drawn
_BETWEEN = 0.1  # gap between profiles, as share of a profile's height range


@plotted()
def profiles(
    scans: SurfaceOrSeveral, *, form: str = "none", surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw one profile of each surface, stacked above each other.

    Parameters
    ----------
    scans
        ``height`` (x) or (y, x) by the surface's name; of several scans (``scan``), the first is
        drawn, and of a map its middle row. Missing heights are gaps.
    form
        Form to remove, as for `tribolab.surface.remove_form`.
    surfaces
        All surfaces of the study in their order, so that each has the same colour in all figures.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> scan = rig.scans("Sb-R", 1, length=2e-3)
    >>> tl.plot.figure_data(profiles({"Sb-R": scan})).series.unique().tolist()
    ['Sb-R']
    """
    scans = by_surface(scans)
    colours = surface_colours([*surfaces, *scans])
    series: list[Series] = []
    top = 0.0
    for name, scan in scans.items():
        own = str(scan.attrs.get("form_removed", form))
        first = scan[["height"]].isel({dim: [0] for dim in ("scan",) if dim in scan.dims})
        height = (first if own == "none" else remove_form(first, own))["height"]
        profile = height.isel({dim: height.sizes[dim] // 2 for dim in height.dims if dim != "x"})
        if not np.isfinite(profile.values).any():  # this row of a map has no measured height
            continue
        x, z = envelope(profile["x"].values, profile.values, _COLUMNS)
        z = 1e6 * (z - np.nanmean(z))
        if series:
            z = z - np.nanmax(z) + top
        top = float(np.nanmin(z)) - _BETWEEN * float(np.nanmax(z) - np.nanmin(z))
        series.append(
            Series(name, 1e3 * (x - x[0]), z, colour=colours[name], surface=name, thin=True)
        )
    return FigureSpec(
        title="Profiles",
        note="The first scan of each surface (of a height map, its middle row) after form removal, "
        "without a cut-off; Ra, Rq and Rz are those after the cut-off. Profiles are shifted in "
        "height.",
        panels=(Panel(Axis("position", "mm"), Axis("height", "µm")),),
        series=tuple(series),
    )


@plotted()
def spectra(psds: SurfaceOrSeveral, *, surfaces: Sequence[str] = ()) -> FigureSpec:
    """Draw two-dimensional roughness power spectra with bands; extrapolated parts are dashed.

    Parameters
    ----------
    psds
        Spectra with ``psd_2d`` (wavenumber) by the surface's name, or one dataset (surface,
        wavenumber); ``psd_2d_low``, ``psd_2d_high`` and ``origin`` if known.
    surfaces
        All surfaces of the study in their order, so that each has the same colour in all figures.

    Raises
    ------
    AnalysisError
        If there is no spectrum to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> psd = tl.surface.extrapolate(tl.surface.psd_2d(rig.scans("Sb-R", 2, length=2e-3)))
    >>> tl.plot.figure_data(spectra({"Sb-R": psd})).series.unique().tolist()
    ['Sb-R']
    """
    psds = by_surface(psds)
    if not psds:
        raise AnalysisError("there is nothing to draw: no spectrum was given")
    colours = surface_colours([*surfaces, *psds])
    series: list[Series] = []
    for name, psd in psds.items():
        series += _spectrum(name, psd, colours[name])
    keys = (Key("measured"), Key("extrapolated", "dashed"))
    return FigureSpec(
        title="Roughness power spectra",
        note="Solid: measured; dashed: extrapolated; shaded: 95 % band.",
        panels=(
            Panel(
                axis_of("wavenumber", log=True),
                axis_of("psd_2d", "power spectrum", log=True),
                name="spectrum",
            ),
        ),
        series=tuple(series),
        keys=keys if any(one.style == "dashed" for one in series) else (),
    )


def _spectrum(name: str, psd: xr.Dataset, colour: int) -> list[Series]:
    q, value = psd["wavenumber"].values, psd["psd_2d"].values
    nothing = value * np.nan
    low, high = (
        psd[f"psd_2d{end}"].values if f"psd_2d{end}" in psd else nothing
        for end in ("_low", "_high")
    )
    origin = psd["origin"].values if "origin" in psd else np.zeros(q.size, int)
    whole = dict(
        zip(
            (*map(column, ("wavenumber", "psd_2d", "psd_2d_low", "psd_2d_high")), "origin"),
            (q, value, low, high, origin),
            strict=True,
        )
    )
    fine = np.isfinite(low) & np.isfinite(high)
    series = [
        Series(name, q[fine], low[fine], "band", colour, high=high[fine], surface=name, columns={})
    ]
    styles: tuple[tuple[np.ndarray, Style], ...] = (
        (origin == _MEASURED, "line"),
        (origin != _MEASURED, "dashed"),
    )
    for part, style in styles:
        # dashed parts start and end on the solid line, so that there is no gap
        joined = part | (np.roll(part, 1) & (np.arange(q.size) > 0) & (style == "dashed"))
        joined |= np.roll(part, -1) & (np.arange(q.size) < q.size - 1) & (style == "dashed")
        if part.any():
            line = np.where(joined & (value > 0), value, np.nan)
            hover = (f"{name}: extrapolated",) if style == "dashed" else ()
            numbers = whole if len(series) == 1 else {}
            series.append(
                Series(name, q, line, style, colour, surface=name, hover=hover, columns=numbers)
            )
    return series if fine.any() else series[1:]


@plotted()
def modulus(table: xr.Dataset) -> FigureSpec:
    """Draw storage and loss modulus against angular frequency.

    Parameters
    ----------
    table
        ``storage_modulus``, ``loss_modulus`` [Pa] (angular_frequency).

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> numbers = np.array([[1e6, 1e7, 1e8], [1e5, 5e6, 2e7]])
    >>> table = xr.Dataset(
    ...     {
    ...         "storage_modulus": ("angular_frequency", numbers[0]),
    ...         "loss_modulus": ("angular_frequency", numbers[1]),
    ...     },
    ...     {"angular_frequency": [1.0, 1e3, 1e6]},
    ... )
    >>> figure_data(modulus(table)).series.unique().tolist()
    ['storage modulus', 'loss modulus']
    """
    omega = table["angular_frequency"].values
    surface = str(table.attrs.get("surface", ""))
    values = {name: table[f"{name}_modulus"].values / 1e6 for name in ("storage", "loss")}
    kept = {name: np.where(value > 0, value, np.nan) for name, value in values.items()}
    # colours distinguish the two moduli, because there is only one rubber
    return FigureSpec(
        title="Modulus of the rubber",
        panels=(Panel(axis_of("angular_frequency", log=True), Axis("modulus", "MPa", log=True)),),
        series=(
            Series("storage modulus", omega, kept["storage"], surface=surface),
            Series("loss modulus", omega, kept["loss"], "dashed", 1, surface=surface),
        ),
    )


@plotted()
def viscoelastic(frictions: SurfaceOrSeveral, *, surfaces: Sequence[str] = ()) -> FigureSpec:
    """Draw the viscoelastic friction coefficient against sliding speed.

    Parameters
    ----------
    frictions
        ``friction_coefficient`` (sliding_speed; load) by the surface's name. Curves with a remark
        in brackets after the name, such as "Smooth (complete contact)", are dashed.
    surfaces
        All surfaces of the study in their order, so that each has the same colour in all figures.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> mu = xr.Dataset(
    ...     {"friction_coefficient": ("sliding_speed", [0.01, 0.03, 0.02])},
    ...     {"sliding_speed": [1e-6, 1e-4, 1e-2]},
    ... )
    >>> figure_data(viscoelastic({"Sb-R": mu})).friction_coefficient.tolist()
    [0.01, 0.03, 0.02]
    """
    frictions = by_surface(frictions)
    colours = surface_colours([*surfaces, *frictions])
    series = []
    for name, friction in frictions.items():
        style: Style = "dashed" if " (" in name else "line"
        for load, line in by_load(friction):
            v, mu = line["sliding_speed"].values, line["friction_coefficient"].values
            series.append(Series(name, v, mu, style, colours[name], surface=name, load=load))
    x, y = (
        axis_of("sliding_speed", log=True),
        axis_of("friction_coefficient", "viscoelastic friction"),
    )
    return FigureSpec(
        title="Friction by losses in the rubber",
        note="Without flash heating and adhesion.",
        panels=(Panel(x, replace(y, include=(0.0,))),),
        series=shaded_loads(series),
    )


def shaded_loads(series: Sequence[Series]) -> tuple[Series, ...]:
    """Return series shaded by load, the lowest darkest; series without a load are unchanged."""
    loads = sorted({one.load for one in series if one.load is not None})
    return tuple(
        one if one.load is None else replace(one, shade=shade_of(loads.index(one.load), len(loads)))
        for one in series
    )
