"""How many runs a precision takes, over how long each of them slides."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import plain
from tribolab.figures.look.frame import speed_axis
from tribolab.figures.look.guests import one_panel
from tribolab.figures.look.style import (
    condition_style,
    keep,
)

_ASSURED = {"runs": "assured_runs", "cheapest_runs": "cheapest_assured_runs"}
# which they are, how far beside the speed, line and filling
_DRAWN = (("runs", 0.93, "-", None), ("cheapest_runs", 1.07, ":", "white"))


def runs_needed(table: pd.DataFrame, *, title: str = "", ax: Axes | None = None) -> Figure:
    """Draw how many runs reach a precision at each speed.

    Parameters
    ----------
    table
        As in `tribolab.across.planning.MeasuringPlan`: ``condition``, ``sliding_speed_m_s``,
        ``runs`` and ``cheapest_runs``; where there are ``assured_runs`` and
        ``cheapest_assured_runs``, bars reach up to them.
    title
        Text above.
    ax
        Axes to draw in; without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Filled: runs that slide as long as the pilot's; open: runs of the cheapest sliding time;
        bars up to the runs that reach the precision with assurance. Both stand a little beside
        their speed.

    Raises
    ------
    AnalysisError
        If there are no points.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> table = pd.DataFrame({"condition": ["dry"], "sliding_speed_m_s": [1e-3], "runs": [7.0]})
    >>> figure_data(runs_needed(table.assign(cheapest_runs=5.0))).cheapest_runs.tolist()
    [5.0]
    """
    if table.empty:
        raise AnalysisError("there is nothing to draw: the plan has no points")
    with one_panel(ax, title) as (figure, axes):
        for number, (condition, rows) in enumerate(table.groupby("condition", sort=False)):
            colour, marker = condition_style(number)
            speed = rows["sliding_speed_m_s"].to_numpy(dtype=float)
            own = {name: rows[name].to_numpy(dtype=float) for name in ("runs", "cheapest_runs")}
            for name, shift, style, fill in _DRAWN:
                at = shift * speed
                axes.plot(
                    at, own[name], f"{marker}{style}", color=colour, markersize=4,
                    markerfacecolor=fill or colour,
                    label=plain(str(condition)) if fill is None else None,
                )  # fmt: skip
                sure = _ASSURED[name]
                if sure in rows:
                    own[sure] = rows[sure].to_numpy(dtype=float)
                    axes.vlines(at, own[name], own[sure], colors=colour, linewidth=1)
                    axes.plot(at, own[sure], "_", color=colour, markersize=6)
            keep(figure, "runs", str(condition), sliding_speed_m_s=speed, **own)
        speed_axis(axes, table["sliding_speed_m_s"].to_numpy(dtype=float))
        drawn = [name for name in (*_ASSURED, *_ASSURED.values()) if name in table]
        top = float(np.nanmax(table[drawn].to_numpy(dtype=float), initial=2.0))
        axes.set_ylim(0.0, 1.15 * top)
        axes.set_ylabel("runs")
    return figure
