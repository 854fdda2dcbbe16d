"""Fast ticks of logarithmic axes: plain text for decades, one marker for all minor ticks.

Matplotlib typesets every ``10^-3`` as a formula, and makes five artists of every minor tick: over
many decades this takes most of the time of a figure.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

import numpy as np
from matplotlib import rcParams
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis, XAxis
from matplotlib.backend_bases import RendererBase
from matplotlib.lines import Line2D
from matplotlib.markers import TICKDOWN, TICKLEFT, TICKRIGHT, TICKUP, MarkerStyle
from matplotlib.ticker import (
    FixedLocator,
    FuncFormatter,
    Locator,
    LogLocator,
    NullFormatter,
    NullLocator,
)

from tribolab.core.wording import number

_MAX_DECADES = 1e4
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def few_ticks(axis: Axis, low: float, high: float, decades: int = 8, *, small: bool = True) -> None:
    """Label at most `decades` decades of a logarithmic axis, and add minor ticks if `small`.

    Over many decades, ticks at 2 to 9 would merge and be slow to draw: then there is one per
    decade.
    """
    axis.set_major_locator(LogLocator(numticks=decades))
    axis.set_major_formatter(FuncFormatter(power_of_ten))
    axis.set_minor_locator(NullLocator())
    axis.set_minor_formatter(NullFormatter())
    subs = (1,) if low > 0 and high / low > _MAX_DECADES else range(2, 10)
    there = (a for a in axis.axes.artists if isinstance(a, SmallTicks))
    if small and not any(ticks.axis is axis for ticks in there):
        axis.axes.add_artist(SmallTicks(axis, LogLocator(subs=subs, numticks=90)))


def symlog(axes: Axes, linear_below: float, low: float, high: float) -> None:
    """Make an ordinate logarithmic for positive and negative values, and linear near zero."""
    first = int(np.floor(np.log10(linear_below) + 1e-9))
    largest = max(abs(low), abs(high), linear_below)
    last = max(first, int(np.ceil(np.log10(largest) - 0.1)))  # data may exceed this decade by 26 %
    axes.set_yscale("symlog", linthresh=10.0**first, linscale=0.8)
    step = max(1, -(-(last - first) // 2))
    # the label of the lowest decade would overlap that of zero
    decades = 10.0 ** np.arange(last, first - (step == 1), -step)
    both = low < -(10.0**first)
    axes.yaxis.set_major_locator(FixedLocator(np.r_[-decades if both else [], 0.0, decades]))
    axes.yaxis.set_major_formatter(FuncFormatter(_signed_decade))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_ylim(-(10.0 ** (last + 0.4)) if both else -(10.0**first), 10.0 ** (last + 0.4))


def _signed_decade(value: float, place: int | None = None) -> str:
    return "0" if value == 0 else ("\u2212" if value < 0 else "") + power_of_ten(abs(value))


def power_of_ten(value: float, place: int | None = None) -> str:
    """Return a tick label: a power of ten for decades, a plain number for other values.

    Examples
    --------
    >>> power_of_ten(1e-4), power_of_ten(300.0)
    ('10⁻⁴', '300')
    """
    if not value > 0:
        return ""
    exponent = round(np.log10(value))
    if np.isclose(value, 10.0**exponent, rtol=1e-6, atol=0):
        return "10" + str(exponent).translate(_RAISED)
    return number(value)


class SmallTicks(Artist):
    """Minor ticks of an axis, drawn as two artists, one for each side of the frame.

    Create it inside `paper_style()`, whose style of minor ticks it uses.

    Parameters
    ----------
    axis
        Axis of the ticks.
    locator
        Locator of their positions.
    """

    def __init__(self, axis: Axis, locator: Locator) -> None:
        super().__init__()
        self.axis, self.locator = axis, locator
        locator.set_axis(axis)
        across = isinstance(axis, XAxis)
        self.name = "x" if across else "y"
        rc: Mapping[str, Any] = cast("Mapping[str, Any]", rcParams)
        key = f"{self.name}tick"
        far = rc["xtick.top" if across else "ytick.right"]
        inward = (TICKUP, TICKDOWN) if across else (TICKRIGHT, TICKLEFT)
        self.marks = [
            Line2D(
                [],
                [],
                marker=MarkerStyle(mark),
                linestyle="none",
                color=rc[f"{key}.color"],
                markersize=rc[f"{key}.minor.size"],
                markeredgewidth=rc[f"{key}.minor.width"],
            )
            for mark in inward[: 1 + far]
        ]
        self.set_zorder(axis.get_zorder())

    def draw(self, renderer: RendererBase) -> None:
        """Draw the minor ticks at their current positions."""
        if not self.get_visible() or not self.axis.get_visible():
            return
        low, high = sorted(self.axis.get_view_interval())
        places = np.asarray(self.locator(), float)
        places = places[(places >= low) & (places <= high)]
        axes = self.axis.axes
        across = getattr(axes, f"get_{self.name}axis_transform")(which="tick1")
        for edge, mark in enumerate(self.marks):
            edges = np.full(places.size, float(edge))
            mark.set_data(*((places, edges) if self.name == "x" else (edges, places)))
            mark.set_transform(across)
            mark.set_figure(axes.figure)
            mark.draw(renderer)
        self.stale = False
