"""A joint fit of several loads: curves with the posterior's band, and what they leave over."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tribolab.figures.error_bars import COVERAGE
from tribolab.figures.labels import column, label, plain
from tribolab.figures.look.frame import shaded_band, speed_axis
from tribolab.figures.look.guests import Panels, name_all, name_panel, several_panels
from tribolab.figures.look.style import (
    GREY,
    LOAD_MARKERS,
    SINGLE_MM,
    PaperFigure,
    keep,
    margins,
    new_figure,
    shade,
    surface_styles,
    tidy,
)

_CURVES_HEIGHT, _LEFT_HEIGHT = 56.0, 30.0  # mm


class FittedCurves(Protocol):
    """What is drawn of a `JointFit`: its points and its curves."""

    @property
    def points(self) -> xr.Dataset:
        """Measured points beside the model (point)."""

    @property
    def curves(self) -> xr.Dataset:
        """The model with its band (curve, sliding_speed)."""


def joint_fit(
    fit: FittedCurves,
    *,
    surface: str = "",
    surfaces: Sequence[str] = (),
    title: str = "",
    axes: Panels | None = None,
) -> Figure:
    """Draw the curves of a joint fit with their band, and what is left between points and model.

    Parameters
    ----------
    fit
        From `tribolab.fit_shear_stress_jointly`.
    surface, surfaces
        Its name, if there is one only, and all names of the study in their order, for the colours.
    title
        Text above the figure.
    axes
        The axes to draw in, for the curves and for the differences; they keep their look. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Above: points with 95 % intervals of their own errors; the model at each load with the 95 %
        band of its parameters and, paler, with the errors that the points of a load share as well.
        Below: the relative residuals in %, and as a line the share that the fit assigns to an
        offset per load and to errors correlated between neighbouring speeds.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psd, load = xu2026.psd("Sb-S", 301), [310.0, 910.0]
    >>> speed = np.geomspace(1e-7, 1e-1, 19)
    >>> curves = tl.stribeck_curve(xu2026.contact, psd, 1.4, load, 8e5, speed, cells=60)
    >>> measured = curves[["friction_coefficient"]].isel(sliding_speed=slice(3, -3))
    >>> measured["friction_coefficient_sem"] = 0.02 * measured.friction_coefficient
    >>> fit = tl.fit_shear_stress_jointly(
    ...     measured, xu2026.contact, psd, 1.4, measured["load"], curves=curves
    ... )
    >>> tl.plot.figure_data(joint_fit(fit)).series.unique().tolist()
    ['310 N/m', '910 N/m']
    """
    names = [str(name) for name in fit.curves["curve"].values]
    looks = dict(zip(names, _looks(fit.curves, surface, surfaces), strict=True))
    with several_panels(axes, ("friction", "difference"), _stacked) as (figure, (above, below)):
        below.axhline(0, color=GREY, linewidth=0.8, zorder=1)
        for name, (colour, marker) in looks.items():
            _curve(figure, above, fit.curves.sel(curve=name), name, colour)
            mine = fit.points.isel(point=fit.points["curve"].values == name)
            _points(figure, above, mine, name, colour, marker)
            _left(figure, below, mine, name, colour, marker)
        speed = fit.points["sliding_speed"].values
        for panel in (above, below):
            speed_axis(panel, speed, room=1.5, named=panel is below)
        above.set_ylabel(label("friction_coefficient"))
        above.set_ylim(0, 1.06 * above.dataLim.y1)
        below.set_ylabel(r"difference (% of $\mu$)")
        below.yaxis.set_major_locator(MaxNLocator(4, symmetric=True))
        reach = 1.1 * float(np.abs(below.dataLim.intervaly).max()) or 1.0
        below.set_ylim(-reach, reach)
        if isinstance(figure, PaperFigure) and axes is None:
            _finish(figure, above, title)
        else:
            name_all(above)
            name_panel(above, title)
    return figure


def _looks(curves: xr.Dataset, surface: str, surfaces: Sequence[str]) -> list[tuple[str, str]]:
    """Return colour and marker of each curve: shades of the surface's, dark at the least load.

    A dry curve has the colour of the wet one at its load, and another marker.
    """
    own = [str(name) or surface for name in curves["surface"].values]
    styles = surface_styles([*surfaces, *own])
    loads = curves["load"].values
    looks: list[tuple[str, str]] = []
    seen: list[tuple[str, float]] = []
    for name, load in zip(own, loads, strict=True):
        beside = np.unique(loads[[other == name for other in own]])
        rank = int(np.searchsorted(beside, load))
        colour = shade(styles[name].colour, rank, beside.size)
        again = seen.count((name, load))  # measured dry at a load that was measured wet, too
        seen.append((name, load))
        looks.append((colour, LOAD_MARKERS[(rank + again * beside.size) % len(LOAD_MARKERS)]))
    return looks


def _curve(figure: Figure, axes: Axes, curve: xr.Dataset, name: str, colour: str) -> None:
    v, mu = curve["sliding_speed"].values, curve["friction_coefficient"].values
    numbers = {column("sliding_speed"): v, "friction_coefficient": mu}
    for kind in ("load", ""):
        ends = [f"friction_coefficient_{kind}{'_' * bool(kind)}{end}" for end in ("low", "high")]
        low, high = (curve[end].values for end in ends)
        shaded_band(axes, v, low, high, colour)
        numbers |= dict(zip(ends, (low, high), strict=True))
    axes.plot(v, mu, color=colour, linewidth=1.1)
    keep(figure, "curves", name, **numbers)


def _points(
    figure: Figure, axes: Axes, points: xr.Dataset, name: str, colour: str, marker: str
) -> None:
    v, mu = points["sliding_speed"].values, points["friction_coefficient"].values
    size = COVERAGE * points["friction_coefficient_sem"].values
    axes.errorbar(
        v, mu, size, color=colour, marker=marker, markersize=3.6, linestyle="none",
        elinewidth=0.8, capsize=1.6, capthick=0.8, zorder=4, label=plain(name),
    )  # fmt: skip
    columns = {column("sliding_speed"): v, "friction_coefficient": mu}
    keep(figure, "points", name, **columns, friction_coefficient_U95=size)


def _left(
    figure: Figure, axes: Axes, points: xr.Dataset, name: str, colour: str, marker: str
) -> None:
    """Draw differences, and beneath them what is shared; each run's points are joined."""
    v, off = points["sliding_speed"].values, 100 * np.expm1(points["relative_residual"].values)
    shared = 100 * np.expm1(points["shared_residual"].values)
    relative = points["friction_coefficient_sem"] / points["friction_coefficient"]
    error = 100 * COVERAGE * relative.values
    axes.errorbar(
        v, off, error, color=colour, marker=marker, markersize=2.8, linestyle="none",
        elinewidth=0.7, capsize=1.4, capthick=0.7, zorder=4,
    )  # fmt: skip
    for run in np.unique(points["run_number"].values):
        mine = points["run_number"].values == run
        order = np.argsort(v[mine])
        axes.plot(v[mine][order], shared[mine][order], color=colour, linewidth=0.9, zorder=3)
    columns = {"sliding_speed_m_s": v, "difference_percent": off, "error_percent": error}
    keep(figure, "differences", name, **columns, shared_percent=shared)


def _stacked() -> tuple[PaperFigure, list[Axes]]:
    figure = new_figure(SINGLE_MM, _CURVES_HEIGHT + _LEFT_HEIGHT)
    ratios = {"height_ratios": [_CURVES_HEIGHT, _LEFT_HEIGHT]}
    return figure, list(figure.subplots(2, 1, sharex=True, gridspec_kw=ratios))


def _finish(figure: PaperFigure, above: Axes, title: str) -> None:
    handles, texts = above.get_legend_handles_labels()
    across = 4 if max(map(len, texts), default=0) < 9 else 2
    top = 2.5 + 3.8 * -(-len(texts) // across) + (4.5 if title else 0)
    height = _CURVES_HEIGHT + _LEFT_HEIGHT + top + 10.5
    figure.set_size_inches(SINGLE_MM / 25.4, height / 25.4)
    margins(figure, 15, 3, 10.5, top, hspace=0.07)
    figure.align_ylabels()
    for panel, letter in zip(figure.axes, "ab", strict=True):
        tidy(panel, letter)
    above.legend(
        handles,
        texts,
        loc="lower left",
        ncols=across,
        bbox_to_anchor=(0, 1 + 0.8 / _CURVES_HEIGHT),
        handlelength=1.4,
        columnspacing=1.1,
    )
    if title:
        figure.text(15 / SINGLE_MM, 1 - 1.3 / height, plain(title), va="top", fontsize=8)
