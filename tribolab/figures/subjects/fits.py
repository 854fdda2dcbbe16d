"""Figures of a joint fit to all loads, and of the sensitivity of a model to its inputs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
import xarray as xr

from tribolab.core.untyped import Arguments
from tribolab.figures.colours import BLUE, ORANGE, shade_of, surface_colours
from tribolab.figures.error_bars import COVERAGE
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Mark, Panel, Series, axis_of
from tribolab.figures.subjects.curves import SPEED_AXIS


class FittedCurves(Protocol):
    """Result of a joint fit, as far as the figure needs it: its points and its curves."""

    @property
    def points(self) -> xr.Dataset:
        """Measured points and fitted friction (point)."""

    @property
    def curves(self) -> xr.Dataset:
        """Fitted friction and its band (curve, sliding_speed)."""


@plotted(panels=2)
def joint_fit(fit: FittedCurves, *, surface: str = "", surfaces: Sequence[str] = ()) -> FigureSpec:
    """Draw the curves of a joint fit at all loads with their bands, and the relative residuals.

    Above: points with 95 % intervals of their own errors; the model at each load with the 95 % band
    of its parameters and of the errors shared by the points of a load. Below: the relative
    residuals in %; lines: the share that the fit assigns to an offset per load and to errors
    correlated between neighbouring speeds.

    Parameters
    ----------
    fit
        From `tribolab.fit.fit_shear_stress_jointly`.
    surface, surfaces
        Name of the surface if there is only one, and all names of the study, for the colours.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psd, load = xu2026.psd("Sb-S", 301), [310.0, 910.0]
    >>> speed = np.geomspace(1e-7, 1e-1, 19)
    >>> curves = tl.stribeck_curve(xu2026.contact, psd, 1.4, load, 8e5, speed, cells=60)
    >>> measured = curves[["friction_coefficient"]].isel(sliding_speed=slice(3, -3))
    >>> measured["friction_coefficient_sem"] = 0.02 * measured.friction_coefficient
    >>> fit = tl.fit.fit_shear_stress_jointly(
    ...     measured, xu2026.contact, psd, 1.4, measured["load"], curves=curves
    ... )
    >>> tl.plot.figure_data(joint_fit(fit)).series.unique().tolist()
    ['310 N/m', '910 N/m']
    """
    series: list[Series] = []
    names = [str(name) for name in fit.curves["curve"].values]
    for name, look in zip(names, _looks(fit.curves, surface, surfaces), strict=True):
        mine = fit.points.isel(point=fit.points["curve"].values == name)
        series += _of_load(name, mine, fit.curves.sel(curve=name), look)
    return FigureSpec(
        title="All loads in one fit",
        note="Points: measured, with 95 % intervals; lines: the model at each load; bands: 95 %, "
        "from the parameters and the errors shared by the points of a load. Below: relative "
        "residuals; lines: their share assigned to an offset per load and to errors correlated "
        "between neighbouring speeds.",
        panels=(
            Panel(SPEED_AXIS, axis_of("friction_coefficient", log=True), name="friction"),
            Panel(SPEED_AXIS, Axis("difference", "% of µ"), height=0.55, name="difference"),
        ),
        series=tuple(series),
        marks=(Mark("y", 0.0, panel=1),),
    )


def _looks(curves: xr.Dataset, surface: str, surfaces: Sequence[str]) -> list[Arguments]:
    """Return the looks of curves: colour by surface, shade by load, marker by load and medium."""
    own = [str(name) or surface for name in curves["surface"].values]
    colours = surface_colours([*surfaces, *own])
    loads = curves["load"].values
    looks: list[Arguments] = []
    seen: list[tuple[str, float]] = []
    for name, load in zip(own, loads, strict=True):
        of_surface = np.unique(loads[[other == name for other in own]])
        rank = int(np.searchsorted(of_surface, load))
        again = seen.count((name, load))  # earlier curves with this surface and load
        seen.append((name, load))
        shade = shade_of(rank, of_surface.size)
        marker = rank + again * of_surface.size
        looks.append({"colour": colours[name], "shade": shade, "marker": marker})
    return looks


def _of_load(name: str, points: xr.Dataset, curve: xr.Dataset, look: Arguments) -> list[Series]:
    """Return the series for one load: band, line, points, residuals and their shared part."""
    v, measured = curve["sliding_speed"].values, points["sliding_speed"].values
    mu, sem = (points[f"friction_coefficient{end}"].values for end in ("", "_sem"))
    off, shared = (
        100 * np.expm1(points[part].values) for part in ("relative_residual", "shared_residual")
    )
    low, high = (curve[f"friction_coefficient_load_{end}"].values for end in ("low", "high"))
    fine = np.isfinite(low) & np.isfinite(high)
    series = [
        Series(name, v[fine], low[fine], "band", high=high[fine], **look),
        Series(name, v, curve["friction_coefficient"].values, **look),
        Series(name, measured, mu, "points", error=COVERAGE * sem, **look),
        Series(name, measured, off, "points", panel=1, error=100 * COVERAGE * sem / mu, **look),
    ]
    runs = points["run_number"].values if "run_number" in points else np.zeros(measured.size)
    for run in np.unique(runs):
        mine = np.flatnonzero(runs == run)
        mine = mine[np.argsort(measured[mine])]
        series.append(Series(name, measured[mine], shared[mine], panel=1, **look))
    return series


@plotted(panels=2)
def model_sensitivity(
    uncertainty: xr.Dataset, *, surface: str = "", surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw a computed curve with its band, and its sensitivity to each uncertain input.

    Bars: the largest change of mu over all speeds, up and down, relative to the peak of the curve,
    for the low and the high end of each range; the longest on top.

    Parameters
    ----------
    uncertainty
        From `tribolab.fit.model_uncertainty`.
    surface, surfaces
        Name of the surface, and all names of the study in their order, for the colour.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> given = {"viscosity": 1.4, "load": 310.0, "shear_stress": 0.0}
    >>> given |= {"speed": [1e-3, 1e-1], "cells": 100}
    >>> spread = tl.fit.model_uncertainty(xu2026.contact, None, **given)
    >>> tl.plot.figure_data(model_sensitivity(spread)).panel.unique().tolist()
    ['band', 'bars']
    """
    own: Arguments = {"colour": surface_colours([*surfaces, surface])[surface], "surface": surface}
    v, mu = (uncertainty[name].values for name in ("sliding_speed", "friction_coefficient"))
    low, high = (uncertainty[f"friction_coefficient_{end}"].values for end in ("low", "high"))
    fine = np.isfinite(low) & np.isfinite(high)
    model = f"model {surface}".strip()
    series = [
        Series("uncertainty", v[fine], low[fine], "band", high=high[fine], name=model, **own),
        Series(model, v, mu, **own),
    ]
    names = uncertainty["variation"].values.astype(str)
    change = 100 * (uncertainty["friction_coefficient_varied"].values - mu) / mu.max()
    filled = np.nan_to_num(change)
    place = np.argmax(np.abs(filled), axis=-1)[..., None]
    # change of largest magnitude among all speeds, with its sign (variation, end)
    most = np.take_along_axis(filled, place, axis=-1)[..., 0]
    most = np.where(np.isfinite(change).any(axis=-1), most, np.nan)
    order = np.argsort(np.nanmax(np.abs(np.nan_to_num(most)), axis=1))
    for end, colour in enumerate((BLUE, ORANGE)):
        label = f"{('low', 'high')[end]} end of the range"
        series.append(
            Series(label, most[order, end], names[order].tolist(), "bars", colour, panel=1)
        )
    return FigureSpec(
        title="Sensitivity of the model",
        note="Left: the model with its band. Right: largest change of friction for the two ends of "
        "the range of each unknown.",
        panels=(
            Panel(SPEED_AXIS, axis_of("friction_coefficient", log=True), name="band"),
            Panel(
                Axis("largest change of µ", "% of the peak", column="change_percent"),
                Axis("", column="variation"),
                name="bars",
            ),
        ),  # fmt: skip
        series=tuple(series),
        marks=(Mark("x", 0.0, panel=1),),
        across=2,
    )
