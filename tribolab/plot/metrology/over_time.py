"""A control chart: points over time, what is usual, and what is not."""

from __future__ import annotations

import matplotlib.dates as mdates
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import plain
from tribolab.figures.look.guests import one_panel
from tribolab.figures.look.style import BLUE, GREY, ORANGE, VERMILLION, keep


def control(table: pd.DataFrame, *, title: str = "", ax: Axes | None = None) -> Figure:
    """Draw one quantity of an instrument over time with its control limits.

    Parameters
    ----------
    table
        Of one chart, as `tribolab.across.history.Watched` gives it: ``when``, ``value``,
        ``quantity``, ``unit``, ``baseline``, ``low``, ``high``, ``smoothed``, ``smoothed_low``,
        ``smoothed_high`` and ``signal``.
    title
        Text above.
    ax
        Axes to draw in; without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Open points are the baseline; red crosses signal.

    Raises
    ------
    AnalysisError
        If there are no points.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> empty = dict.fromkeys(["low", "high", "smoothed", "smoothed_low", "smoothed_high"], 0.0)
    >>> row = {"when": "2026-03-02T10:00:00", "value": 0.1, "quantity": "zero", "unit": "N"}
    >>> chart = pd.DataFrame([row | empty | {"baseline": True, "signal": ""}])
    >>> figure_data(control(chart)).value.tolist()
    [0.1]
    """
    if table.empty:
        raise AnalysisError("there is nothing to draw: the chart has no points")
    when = pd.to_datetime(table["when"], format="ISO8601").to_numpy()
    days = np.array(mdates.date2num(when)).astype(float)
    column = {
        name: table[name].to_numpy(dtype=float)
        for name in ("value", "low", "high", "smoothed", "smoothed_low", "smoothed_high")
    }
    first = table["baseline"].to_numpy(dtype=bool)
    signal = (table["signal"] != "").to_numpy()
    with one_panel(ax, title, left=17) as (figure, axes):
        for name in ("low", "high"):
            text = "limits of a point" if name == "low" else None
            axes.plot(days, column[name], color=GREY, linewidth=0.9, label=text)
            axes.plot(days, column[f"smoothed_{name}"], color=ORANGE, linewidth=0.6)
        axes.plot(days, column["smoothed"], color=ORANGE, linewidth=1.2, label="weighted mean")
        for part, face, text in ((first, "white", "baseline"), (~first, BLUE, "since")):
            axes.plot(
                days[part], column["value"][part], "o", color=BLUE, markersize=3,
                markerfacecolor=face, markeredgewidth=0.7, label=text,
            )  # fmt: skip
        if signal.any():
            axes.plot(
                days[signal], column["value"][signal], "x", color=VERMILLION, markersize=6,
                markeredgewidth=1.3, label="signal",
            )  # fmt: skip
        if days.max() == days.min():  # a single campaign: no interval to divide
            axes.set_xlim(days[0] - 1.0, days[0] + 1.0)
        locator = mdates.AutoDateLocator(maxticks=6)
        axes.xaxis.set_major_locator(locator)
        axes.xaxis.set_major_formatter(mdates.ConciseDateFormatter(locator))
        quantity, unit = str(table["quantity"].iloc[0]), str(table["unit"].iloc[0])
        axes.set_ylabel(plain(quantity if unit == "1" else f"{quantity} ({unit})"))
        keep(figure, "control", quantity, days=days, **column)
    return figure
