"""The error bars of friction over speed where they are the point: beside the curves they vanish."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.plot.friction.curves import curve_looks
from tribolab.plot.look.error_bars import error_bar
from tribolab.plot.look.frame import logarithmic, speed_axis
from tribolab.plot.look.labels import column, label
from tribolab.plot.look.panel import Panels, name_all, name_panel, several_panels
from tribolab.plot.look.style import GREY, SINGLE_MM, PaperFigure, keep, margins, new_figure, tidy

_ABOVE, _BELOW = 42.0, 30.0  # mm


def friction_spread(
    measured: xr.Dataset | Sequence[xr.Dataset],
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    axes: Panels | None = None,
) -> Figure:
    """Draw measured friction over speed with its error bars, and below it the bars themselves.

    Parameters
    ----------
    measured
        One or several measured curves, as for `tribolab.plot.stribeck`, each with
        ``friction_coefficient_std`` and, if known, ``friction_coefficient_U95``.
    surfaces
        All surfaces of the study in their order, so that each keeps its colour.
    title
        Text above the figure.
    axes
        The axes to draw in, for friction and for its error bars; they keep their look. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Above: points with bars of one standard deviation while sliding, the error bar of the
        reference study; lines guide the eye. Below, on a logarithmic scale: the standard deviation
        with filled markers, the expanded uncertainty of the mean with open ones.

    Raises
    ------
    AnalysisError
        If no curve has a standard deviation above zero.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> curve = xr.Dataset(
    ...     {
    ...         "friction_coefficient": ("sliding_speed", [1.1, 0.9]),
    ...         "friction_coefficient_std": ("sliding_speed", [5e-3, 4e-3]),
    ...     },
    ...     {"sliding_speed": [1e-6, 1e-4]},
    ... )
    >>> figure_data(friction_spread(curve)).friction_coefficient_std.tolist()
    [0.005, 0.004]
    """
    curves = [measured] if isinstance(measured, xr.Dataset) else list(measured)
    curves = [curve for curve in curves if _has_spread(curve)]
    if not curves:
        raise AnalysisError("there is nothing to draw: no curve has a standard deviation")
    with several_panels(axes, ("friction", "error bars"), _stacked) as (figure, (above, below)):
        for curve, (text, look) in zip(curves, curve_looks(curves, surfaces), strict=True):
            x = curve["sliding_speed"].values
            mu, std = (curve[f"friction_coefficient{end}"].values for end in ("", "_std"))
            above.errorbar(
                x, mu, std, color=look.colour, marker=look.marker, markersize=1.6, linewidth=0.5,
                elinewidth=0.9, capsize=2.2, capthick=0.9, label=text or "measured",
            )  # fmt: skip
            wide = error_bar(curve, "friction_coefficient")
            for y, face in ((std, look.colour), (wide, "white")):
                below.plot(
                    x, np.where(y > 0, y, np.nan), color=look.colour, marker=look.marker,
                    markersize=3.0, markerfacecolor=face, markeredgewidth=0.7, linewidth=0.5,
                )  # fmt: skip
            numbers = dict(zip(_COLUMNS, (x, mu, std, wide), strict=True))
            keep(figure, "error bars", text or "measured", **numbers)
        _finish(above, below)
        if isinstance(figure, PaperFigure) and axes is None:
            _name(figure, above, title)
        else:
            name_all(above)
            name_all(below)
            name_panel(above, title)
    return figure


_COLUMNS = (
    column("sliding_speed"),
    *(column(f"friction_coefficient{end}") for end in ("", "_std", "_U95")),
)


def _has_spread(curve: xr.Dataset) -> bool:
    name = "friction_coefficient_std"
    return name in curve and bool((curve[name] > 0).any())


def _stacked() -> tuple[PaperFigure, list[Axes]]:
    figure = new_figure(SINGLE_MM, _ABOVE + _BELOW + 22.0)
    ratios = {"height_ratios": [_ABOVE, _BELOW]}
    return figure, list(figure.subplots(2, 1, sharex=True, gridspec_kw=ratios))


def _finish(above: Axes, below: Axes) -> None:
    """Set scales and labels, and name what is filled and what is open."""
    low, high = above.dataLim.intervalx
    for panel in (above, below):
        speed_axis(panel, (low, high), named=panel is below)
    above.set_ylim(min(0.0, above.dataLim.y0), 1.25 * above.dataLim.y1)
    above.set_ylabel(label("friction_coefficient"))
    bottom, top = below.dataLim.y0, below.dataLim.y1
    logarithmic(below, "y")
    below.set_ylim(bottom / 2, 5 * top)  # room for the letter
    below.set_ylabel(r"error bar of $\mu$")
    for words, face in (("standard deviation", GREY), ("U95", "white")):
        below.plot(
            [], [], color=GREY, marker="o", markersize=3.0, markerfacecolor=face, linewidth=0.5,
            label=words,
        )  # fmt: skip


def _name(figure: PaperFigure, above: Axes, title: str) -> None:
    height = _ABOVE + _BELOW + 22.0
    margins(figure, 14, 3, 10.5, 12 if title else 9, hspace=0.1)
    for panel, letter in zip(figure.axes, "ab", strict=True):
        tidy(panel, letter)
    for panel, down in ((above, 0.8), (figure.axes[1], 4.6)):
        handles, texts = panel.get_legend_handles_labels()
        figure.legend(
            handles, texts, loc="upper right", ncols=len(texts),
            bbox_to_anchor=(1 - 3 / SINGLE_MM, 1 - (down + (3 if title else 0)) / height),
        )  # fmt: skip
    if title:
        figure.text(14 / SINGLE_MM, 1 - 1.0 / height, title, va="top", fontsize=8)
