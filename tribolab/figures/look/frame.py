"""Axes and legends that several figures have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from tribolab.figures.labels import label, plain
from tribolab.figures.look.decades import few_ticks
from tribolab.figures.look.style import (
    GREY,
    SINGLE_MM,
    PaperFigure,
    margins,
    surface_styles,
)

# Datasets by the surface's name, or one with the dim ``surface``.
SurfaceOrSeveral = Mapping[str, xr.Dataset] | xr.Dataset


def logarithmic(axes: Axes, *names: str, small: bool = True) -> None:
    """Make axes (``"x"``, ``"y"``) logarithmic, with ticks that stay few over many decades.

    Parameters
    ----------
    axes
        The panel.
    *names
        Which of its axes.
    small
        Whether there are ticks between those with a number.
    """
    for name in names:
        getattr(axes, f"set_{name}scale")("log")
        interval = getattr(axes.dataLim, f"interval{name}")
        few_ticks(getattr(axes, f"{name}axis"), *interval, small=small)


def speed_axis(
    axes: Axes,
    speeds: Sequence[float] | np.ndarray | None = None,
    *,
    room: float = 1.8,
    named: bool = True,
) -> None:
    """Make the abscissa a logarithmic axis of sliding speed.

    Parameters
    ----------
    axes
        The panel.
    speeds
        Of which the lowest and the highest are its ends [m/s]; by default what is drawn.
    room
        Factor by which the axis reaches further on both sides.
    named
        Whether its label is set.
    """
    speeds = axes.dataLim.intervalx if speeds is None else speeds
    low, high = np.min(speeds), np.max(speeds)
    axes.set_xscale("log")
    axes.set_xlim(low / room, high * room)
    few_ticks(axes.xaxis, low / room, high * room, decades=9)
    if named:
        axes.set_xlabel(label("sliding_speed"))


def colours(surfaces: Sequence[str], every: Sequence[str] = ()) -> dict[str, str]:
    """Return the colour of each surface; `every` names all surfaces of the study in order."""
    styles = surface_styles([*every, *surfaces])
    return {name: styles[name].colour for name in surfaces}


def by_surface(data: SurfaceOrSeveral) -> dict[str, xr.Dataset]:
    """Return datasets by the surface's name, also from one that has a dim ``surface``.

    Where surfaces stand on different wavenumbers, each gets back its own.
    """
    if not isinstance(data, xr.Dataset):
        return dict(data)
    if "surface" not in data.dims:
        return {str(data.attrs.get("surface", "")): data}
    parts = {str(name): data.sel(surface=name, drop=True) for name in data["surface"].to_numpy()}
    if "wavenumber" not in data.dims:
        return parts
    return {name: part.dropna("wavenumber", how="all") for name, part in parts.items()}


def name_surfaces(axes: Axes, chosen: dict[str, str]) -> None:
    """Put each surface with its colour into the legend; a single unnamed one needs no word."""
    for name, colour in chosen.items():
        if name:
            axes.plot([], [], color=colour, linewidth=1.4, label=plain(name))


def name_style(axes: Axes, text: str, **look: Any) -> None:
    """Put a line style that holds for all surfaces into the legend, in grey."""
    axes.plot([], [], **{"color": GREY, "linewidth": 1.1, **look}, label=plain(text))


def legend_above(figure: PaperFigure, axes: Axes, title: str = "", left: float = 14) -> None:
    """Put the legend above the axes, where it hides no point, and make room for it."""
    handles, texts = axes.get_legend_handles_labels()
    across = 3 if max(map(len, texts), default=0) < 14 else 2
    across = 1 if max(map(len, texts), default=0) > 32 else across
    rows = -(-len(texts) // across)
    top = 2.5 + 3.8 * rows + (4.5 if title else 0)
    height = 50.0 + top
    figure.set_size_inches(SINGLE_MM / 25.4, height / 25.4)
    margins(figure, left, 3, 10.5, top)
    if texts:
        axes.legend(
            handles, texts, loc="lower left", ncols=across,
            bbox_to_anchor=(0, 1 + 0.8 / (height - top - 10.5)),
        )  # fmt: skip
    if title:
        figure.text(left / SINGLE_MM, 1 - 1.3 / height, plain(title), va="top", fontsize=8)


def shaded_band(axes: Axes, x: np.ndarray, low: np.ndarray, high: np.ndarray, colour: str) -> None:
    """Shade between two bounds, where both are known."""
    fine = np.isfinite(low) & np.isfinite(high)
    axes.fill_between(x[fine], low[fine], high[fine], color=colour, alpha=0.2, linewidth=0)
