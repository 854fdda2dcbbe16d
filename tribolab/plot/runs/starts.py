"""Figures of the start of sliding, and of friction from cycle to cycle."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import column, label
from tribolab.figures.look.frame import logarithmic
from tribolab.figures.look.guests import one_panel
from tribolab.figures.look.style import BLACK, BLUE, GREEN, GREY, PURPLE, SKY, VERMILLION, keep

_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, SKY)
_WIDE = 10.0  # ratio of the longest to the shortest rest from which their axis is logarithmic


def static_friction(
    starts: xr.Dataset | Mapping[str, xr.Dataset],
    *,
    over: str = "waiting_time",
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw static friction over the time of rest before each start, and sliding friction beside it.

    Parameters
    ----------
    starts
        From `tribolab.static_friction`, or several of them by what to call them.
    over
        Abscissa: ``"waiting_time"``, ``"sliding_speed"`` or ``"start_of_sliding"``.
    title
        Text above the figure.
    ax
        The axes to draw in; they keep their look. Without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Filled markers: static friction with its standard error; small open ones: starts that do
        not stand out of the sliding that follows; dashes: the sliding friction that follows.

    Raises
    ------
    AnalysisError
        If there is no start to draw.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.plot import figure_data
    >>> values = {"static_friction_coefficient": [0.5, 0.6], "waiting_time": [1.0, 10.0]}
    >>> values |= {"static_friction_coefficient_sem": [0.01, 0.01], "peak": [1, 1]}
    >>> values |= {"friction_coefficient": [0.4, 0.4]}
    >>> table = xr.Dataset({k: ("start_of_sliding", v) for k, v in values.items()})
    >>> figure_data(static_friction(table)).static_friction_coefficient.tolist()
    [0.5, 0.6]
    """
    tables = {"": starts} if isinstance(starts, xr.Dataset) else dict(starts)
    tables = {name: table for name, table in tables.items() if table.sizes["start_of_sliding"]}
    if not tables:
        raise AnalysisError("there is nothing to draw: no segment starts from rest")
    ends: list[np.ndarray] = []
    with one_panel(ax, title) as (figure, axes):
        for k, (name, table) in enumerate(tables.items()):
            x = np.asarray(table[over].values, float)
            mu, error = (table[f"static_friction_coefficient{end}"].values for end in ("", "_sem"))
            clear = table["peak"].values == 1
            colour = _COLOURS[k % len(_COLOURS)]
            for which, face, size in ((clear, colour, 4.0), (~clear, "white", 3.0)):
                if which.any():
                    words = name or ("static" if face == colour else "no peak")
                    axes.errorbar(
                        x[which], mu[which], error[which], color=colour, marker="o", linestyle="",
                        markerfacecolor=face, markersize=size, capsize=2, linewidth=0.7,
                        label=words if face == colour or not name else None,
                    )  # fmt: skip
            sliding = table["friction_coefficient"].values
            axes.plot(
                x, sliding, color=BLACK if len(tables) == 1 else colour, marker="_", linestyle="",
                markersize=6, label="sliding" if k == len(tables) - 1 else None,
            )  # fmt: skip
            ends.append(x[np.isfinite(x)])
            numbers = dict(zip(_COLUMNS, (mu, error, sliding), strict=True))
            keep(figure, "static friction", name or "static", **{column(over): x}, **numbers)
        whole = np.concatenate(ends)
        axes.set_ylim(0, 1.1 * axes.dataLim.y1)
        if whole.size and whole.min() > 0 and whole.max() > _WIDE * whole.min():
            logarithmic(axes, "x")
            axes.set_xlim(whole.min() / 1.5, 1.5 * whole.max())
        axes.set_xlabel(label(over))
        axes.set_ylabel(label("friction_coefficient"))
    return figure


def cycles(
    friction: xr.Dataset | Mapping[str, xr.Dataset], *, title: str = "", ax: Axes | None = None
) -> Figure:
    """Draw the friction coefficient of each cycle over the number of the cycle.

    Parameters
    ----------
    friction
        From `tribolab.friction_per_cycle`, or several of them by what to call them.
    title
        Text above the figure.
    ax
        The axes to draw in; they keep their look. Without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Dots: by the forces in the middle of the strokes; a grey line: by the energy of the loop,
        where it is known; dashes: the linear trend, where it is one (p < 1 %).

    Examples
    --------
    >>> import xarray as xr
    >>> from tribolab.plot import figure_data
    >>> data = {"friction_coefficient": ("cycle", [0.3, 0.31]), "time": ("cycle", [0.5, 1.5])}
    >>> alone = {"mean_friction_coefficient": 0.305, "trend": 0.01, "trend_p_value": 1.0}
    >>> table = xr.Dataset(data | alone, {"cycle": [1, 2]})
    >>> figure_data(cycles(table)).friction_coefficient.tolist()
    [0.3, 0.31]
    """
    tables = {"": friction} if isinstance(friction, xr.Dataset) else dict(friction)
    with one_panel(ax, title) as (figure, axes):
        for k, (name, table) in enumerate(tables.items()):
            number, mu = table["cycle"].values, table["friction_coefficient"].values
            energy = table.get("friction_coefficient_energy")
            if energy is not None and np.isfinite(energy.values).any():
                axes.plot(
                    number, energy.values, color=GREY, linewidth=0.8,
                    label="by the loop's energy" if k == 0 else None,
                )  # fmt: skip
            colour = _COLOURS[k % len(_COLOURS)]
            axes.plot(
                number, mu, color=colour, marker=".", markersize=2.5, linestyle="",
                label=name or "by the forces",
            )  # fmt: skip
            if float(table["trend_p_value"]) < 0.01:
                time = table["time"].values
                line = float(table["mean_friction_coefficient"]) + float(table["trend"]) * (
                    time - time.mean()
                )
                axes.plot(
                    number, line, color=BLACK, linewidth=0.8, linestyle="--",
                    label="trend" if k == 0 else None,
                )  # fmt: skip
            numbers = {column("cycle"): number, column("friction_coefficient"): mu}
            keep(figure, "cycles", name or "cycles", **numbers)
        axes.set_xlabel("cycle")
        axes.set_ylabel(label("friction_coefficient"))
    return figure


_COLUMNS = (
    column("static_friction_coefficient"),
    column("static_friction_coefficient_sem"),
    column("friction_coefficient"),
)
