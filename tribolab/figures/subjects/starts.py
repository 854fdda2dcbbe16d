"""Figures of static friction at each start, and of friction in each cycle."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.figures.colours import BLACK, GREY
from tribolab.figures.labels import column
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, axis_of

_WIDE = 10.0  # ratio of longest to shortest rest above which the axis is logarithmic
_TREND = 0.01  # p value below which a linear trend is drawn


@plotted()
def static_friction(
    starts: xr.Dataset | Mapping[str, xr.Dataset], *, over: str = "waiting_time"
) -> FigureSpec:
    """Draw static friction against the rest before each start, with the sliding friction.

    Filled: static friction with its standard error; open: starts whose friction does not exceed the
    sliding friction after them; hexagons: that sliding friction.

    Parameters
    ----------
    starts
        From `tribolab.static_friction`, or several of them by their labels.
    over
        Abscissa: ``"waiting_time"``, ``"sliding_speed"`` or ``"start_of_sliding"``.

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
    series: list[Series] = []
    for k, (name, table) in enumerate(tables.items()):
        x = np.asarray(table[over].values, float)
        mu, error = (table[f"static_friction_coefficient{end}"].values for end in ("", "_sem"))
        sliding = table["friction_coefficient"].values
        names = ("static_friction_coefficient", "static_friction_coefficient_sem")
        numbers = {column(over): x, **dict(zip(map(column, names), (mu, error), strict=True))}
        numbers |= {"friction_coefficient": sliding}
        clear = table["peak"].values == 1
        for part, label, open_ in ((clear, "static", False), (~clear, "no peak", True)):
            if part.any() or not open_:
                series.append(
                    Series(
                        name or label, x[part], mu[part], "points", k, error=error[part],
                        open=open_, columns={} if open_ else numbers, name=name or "static",
                    )
                )  # fmt: skip
        colour = BLACK if len(tables) == 1 else k
        series.append(Series("sliding", x, sliding, "points", colour, marker=6, columns={}))
    whole = np.concatenate([np.asarray(table[over].values, float) for table in tables.values()])
    whole = whole[np.isfinite(whole)]
    log = bool(whole.size and whole.min() > 0 and whole.max() > _WIDE * whole.min())
    return FigureSpec(
        title="Static friction",
        note="Filled: static friction; open: starts that do not exceed the sliding friction. Bars: "
        "standard error of the start.",
        panels=(
            Panel(
                axis_of(over, log=log),
                axis_of("friction_coefficient", include=(0.0,)),
                name="static friction",
            ),
        ),
        series=tuple(series),
    )


@plotted()
def cycles(friction: xr.Dataset | Mapping[str, xr.Dataset]) -> FigureSpec:
    """Draw the friction coefficient of each cycle against the cycle number.

    Dots: from the forces in the middle of the strokes; grey line: from the energy of the loop, if
    known; dashes: the linear trend, if significant (p < 1 %).

    Parameters
    ----------
    friction
        From `tribolab.friction.friction_per_cycle`, or several of them by their labels.

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
    series: list[Series] = []
    for k, (name, table) in enumerate(tables.items()):
        number, mu = table["cycle"].values, table["friction_coefficient"].values
        energy = table.get("friction_coefficient_energy")
        if energy is not None and np.isfinite(energy.values).any():
            label = "from the energy of the loop"
            series.append(Series(label, number, energy.values, colour=GREY, columns={}))
        label = name or "from the forces"
        columns = {column("cycle"): number, column("friction_coefficient"): mu}
        series.append(Series(label, number, mu, "points", k, marker=0, thin=True, columns=columns))
        if float(table["trend_p_value"]) < _TREND:
            time = table["time"].values
            mean, trend = (float(table[n]) for n in ("mean_friction_coefficient", "trend"))
            line = mean + trend * (time - time.mean())
            series.append(Series("trend", number, line, "dashed", BLACK, columns={}))
    return FigureSpec(
        title="Friction of each cycle",
        panels=(Panel(Axis("cycle"), axis_of("friction_coefficient"), name="cycles"),),
        series=tuple(series),
    )
