"""Two campaigns beside each other: differences over speed, and a forest of their numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import plain
from tribolab.figures.look.frame import legend_above, speed_axis
from tribolab.figures.look.guests import name_all, name_panel, one_panel, whole_figure
from tribolab.figures.look.style import (
    BLUE,
    DOUBLE_MM,
    GREY,
    condition_style,
    keep,
    margins,
    new_figure,
    paper_style,
)

_ROW_MM = 5.2
_MANIFOLD = 300.0  # %: what differs by more is drawn on a logarithmic scale


def differences(points: pd.DataFrame, *, title: str = "", ax: Axes | None = None) -> Figure:
    """Draw the relative difference of two measured curves over speed, with what chance can do.

    Parameters
    ----------
    points
        As in `tribolab.across.compare.Comparison`: ``condition``, ``sliding_speed_m_s``,
        ``first``, ``difference``, ``low``, ``high`` and ``verdict``.
    title
        Text above.
    ax
        Axes to draw in; without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Bars hold all differences together with 95 %; filled points differ. Values are relative to
        the first.

    Raises
    ------
    AnalysisError
        If there are no points.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> points = pd.DataFrame({
    ...     "condition": ["dry"], "sliding_speed_m_s": [1e-4], "first": [0.5],
    ...     "difference": [0.05], "low": [0.02], "high": [0.08], "verdict": ["different"],
    ... })
    >>> figure_data(differences(points)).relative_difference.tolist()
    [0.1]
    """
    if points.empty:
        raise AnalysisError("there is nothing to draw: the two have no point in common")
    with one_panel(ax, title) as (figure, axes):
        axes.axhline(0.0, color=GREY, linewidth=0.6)
        groups = list(points.groupby("condition", sort=False))
        for number, (condition, rows) in enumerate(groups):
            shift = 1 + 0.06 * (number - (len(groups) - 1) / 2)
            _curve(figure, axes, str(condition), rows, number, shift)
        speed_axis(axes)
        axes.set_ylabel("relative difference (%)")
        if np.abs(axes.dataLim.intervaly).max() > _MANIFOLD:
            axes.set_yscale("symlog", linthresh=10.0)
    return figure


def _curve(
    figure: Figure, axes: Axes, condition: str, rows: pd.DataFrame, number: int, shift: float
) -> None:
    colour, marker = condition_style(number)
    scale = rows["first"].abs().to_numpy()
    speed, value, low, high = (
        rows[name].to_numpy(dtype=float)
        for name in ("sliding_speed_m_s", "difference", "low", "high")
    )
    bars = np.nan_to_num(100 * np.array([value - low, high - value]) / scale)
    axes.errorbar(
        speed * shift, 100 * value / scale, bars, fmt="none", ecolor=colour, elinewidth=0.8,
        capsize=1.8,
    )  # fmt: skip
    differs = rows["verdict"].isin(["different", "changed by the analysis"]).to_numpy()
    for part, face, text in ((~differs, "white", condition), (differs, colour, condition)):
        axes.plot(
            speed[part] * shift, 100 * value[part] / scale[part], marker, color=colour,
            markerfacecolor=face, markersize=4, label=plain(text) if part.any() else None,
        )  # fmt: skip
    keep(
        figure, "differences", condition, sliding_speed_m_s=speed,
        relative_difference=value / scale, low=low / scale, high=high / scale,
    )  # fmt: skip


_WORDS = {
    "friction_coefficient": "mean friction",
    "shear_stress_Pa": "shear stress",
    "rms_roughness_m": "rms roughness",
    "rms_slope": "rms slope",
}


def forest(
    quantities: pd.DataFrame,
    *,
    names: Sequence[str] = ("first", "second"),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the numbers of two campaigns as relative differences, a row each: a forest plot.

    Parameters
    ----------
    quantities
        As in `tribolab.across.compare.Comparison`: ``quantity``, ``of``, ``first``, ``difference``,
        ``low`` and ``high`` of 95 %, ``low_90`` and ``high_90``.
    names
        Of the two, for the axis.
    title
        Text above.
    ax
        Axes to draw in; without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Thin bars hold 95 %, thick ones 90 %, the level at which equivalence is told.

    Raises
    ------
    AnalysisError
        If there are no numbers.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> row = {"quantity": "rms_slope", "of": "Sb-R", "first": 0.5, "difference": 0.1}
    >>> ends = {"low": 0.02, "high": 0.18, "low_90": 0.04, "high_90": 0.16}
    >>> drawn = figure_data(forest(pd.DataFrame([row | ends])))
    >>> drawn[["relative_difference", "low", "high_90"]].values.tolist()
    [[0.2, 0.04, 0.32]]
    """
    if quantities.empty:
        raise AnalysisError("there is nothing to draw: the two have no number in common")
    if ax is None:
        with paper_style():
            height = 20.0 + _ROW_MM * len(quantities) + (4.5 if title else 0)
            own = new_figure(DOUBLE_MM, height)
            axes = own.add_subplot()
            _forest(own, axes, quantities, names)
            legend_above(own, axes, title)
            own.set_size_inches(DOUBLE_MM / 25.4, height / 25.4)
            margins(own, 66, 4, 10.5, 7.0 + (4.5 if title else 0))
        return own
    figure = whole_figure(ax)
    _forest(figure, ax, quantities, names)
    name_all(ax)
    name_panel(ax, title)
    return figure


def _forest(figure: Figure, axes: Axes, quantities: pd.DataFrame, names: Sequence[str]) -> None:
    scale = quantities["first"].abs().to_numpy()
    value, low, high, low_90, high_90 = (
        quantities[name].to_numpy(dtype=float) / scale
        for name in ("difference", "low", "high", "low_90", "high_90")
    )
    place = np.arange(len(quantities))[::-1]
    axes.axvline(0.0, color=GREY, linewidth=0.6)
    axes.hlines(place, 100 * low, 100 * high, color=BLUE, linewidth=0.8, label="95 %")
    axes.hlines(place, 100 * low_90, 100 * high_90, color=BLUE, linewidth=2.6, label="90 %")
    axes.plot(100 * value, place, "s", color="black", markersize=3.2, label="difference")
    texts = [
        plain(f"{_WORDS.get(str(name), name)}: {of}")
        for name, of in zip(quantities["quantity"], quantities["of"], strict=True)
    ]
    axes.set_yticks(place, texts)
    axes.set_ylim(-0.7, len(quantities) - 0.3)
    axes.tick_params(axis="y", which="both", length=0)
    first, second = map(plain, names)
    axes.set_xlabel(f"{second} less {first}, relative to {first} (%)")
    keep(
        figure, "forest", "difference", relative_difference=value, low=low, high=high,
        low_90=low_90, high_90=high_90,
    )  # fmt: skip
