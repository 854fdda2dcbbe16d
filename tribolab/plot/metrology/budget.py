"""The parts of an uncertainty as bars: what the error of a friction coefficient is made of."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.figures.labels import plain
from tribolab.figures.look.guests import name_all, name_panel, several_panels
from tribolab.figures.look.style import (
    BLUE,
    GREY,
    ORANGE,
    SINGLE_MM,
    PaperFigure,
    keep,
    margins,
    new_figure,
    tidy,
)
from tribolab.metrology.budget_result import UncertaintyBudget

_ROW, _FRAME = 5.0, 20.0  # mm, of a bar and of what is around them
_SMALL = 1e-3  # of the largest part: less is no bar


def uncertainty_budget(
    budget: UncertaintyBudget,
    at: int | None = None,
    *,
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw a bar for each part of the uncertainty of one friction coefficient.

    Parameters
    ----------
    budget
        From `tribolab.uncertainty_budget`.
    at
        Number of the segment or speed, from 0; None for the typical one.
    title
        Text above the figure.
    ax
        The axes to draw in; they keep their look. Without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Bars: by how much one standard uncertainty of each part moves the friction coefficient, in
        per cent of it, the largest on top; below them the combined standard uncertainty, which
        says so where nothing is stated of the calibration.

    Examples
    --------
    >>> import tribolab as tl, xarray as xr
    >>> values = {"friction_coefficient": 0.05, "friction_coefficient_sem": 4e-4}
    >>> values |= {"normal_force": 50.0, "direction": 1}
    >>> friction = xr.Dataset({name: ("segment", [value]) for name, value in values.items()})
    >>> stated = {"tilt": {"value": "0.5 deg", "as": "half-width"}}
    >>> figure = uncertainty_budget(tl.uncertainty_budget(friction, stated))
    >>> tl.plot.figure_data(figure).part.tolist()
    ['tilt', 'noise and known zero of the run', 'combined']
    """
    table = budget.table(at)
    mu = abs(table.attrs["friction_coefficient"])
    share = 100 * table["contribution"].to_numpy() / mu
    kept = share >= _SMALL * share[:-1].max(initial=0.0)
    names, share = table.index[kept].to_numpy(dtype=str), share[kept]
    height = _FRAME + _ROW * names.size
    with several_panels(None if ax is None else [ax], ("parts",), lambda: _alone(height)) as (
        figure,
        (axes,),
    ):
        y = np.arange(names.size)[::-1]
        axes.barh(y[:-1], share[:-1], 0.62, color=BLUE, label="parts")
        axes.barh(y[-1:], share[-1:], 0.62, color=ORANGE, label="combined")
        keep(figure, "parts", "parts", part=names, contribution_percent=share)
        axes.axhline(0.5, color=GREY, linewidth=0.6)
        told = [plain(name) for name in names]
        if "statistical only" in budget.says:
            told[-1] += "\nstatistical only"
        axes.set_yticks(y, told)
        axes.tick_params(axis="y", length=0)
        axes.set_ylim(-0.6, names.size - 0.4)
        axes.set_xlim(0, 1.08 * share.max(initial=0.0) or 1.0)
        axes.set_xlabel(r"standard uncertainty (% of $\mu$)")
        tidy(axes)
        if ax is not None:
            name_all(axes)
            name_panel(axes, title)
            return figure
        margins(figure, 45, 3, 10.5, 7.5 if title else 3.5)
        if title:
            figure.text(3 / SINGLE_MM, 1 - 1.0 / height, plain(title), va="top", fontsize=8)
    return figure


def _alone(height: float) -> tuple[PaperFigure, list[Axes]]:
    figure = new_figure(SINGLE_MM, height)
    return figure, [figure.add_subplot()]
