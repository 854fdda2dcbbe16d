"""Limits, ticks and labels of matplotlib axes: linear, logarithmic, dates or names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import AutoMinorLocator, FuncFormatter, MaxNLocator

from tribolab.figures.axes import Scale
from tribolab.figures.labels import plain
from tribolab.figures.look.decades import SmallTicks, few_ticks, power_of_ten, symlog
from tribolab.figures.spec import FigureSpec

RAMP = "cividis"
MAX_WITH_SMALL_TICKS = 6  # in more panels, minor ticks would merge


def x_range(spec: FigureSpec, number: int, seen: Sequence[tuple[Scale, Scale]]) -> Scale:
    """Return the range of a panel's abscissa, which fits all panels with the same abscissa."""
    own = spec.panels[number].x
    alike = [x for panel, (x, _) in zip(spec.panels, seen, strict=True) if panel.x == own]
    return replace(alike[0], low=min(x.low for x in alike), high=max(x.high for x in alike))


def axis_text(axis: Any) -> str:
    """Return the label of an axis with its unit."""
    words = axis.paper or axis.label
    return f"{words} ({axis.unit})" if axis.unit and axis.unit != "date" else words


def scale_axis(axes: Axes, name: str, axis: Any, seen: Scale, small: bool) -> None:
    """Set the limits, scale and ticks of the "x" or "y" axis of a panel."""
    low, high = seen.low, seen.high
    own = getattr(axes, f"{name}axis")
    limits = getattr(axes, f"set_{name}lim")
    if axis.log:
        getattr(axes, f"set_{name}scale")("log")
    if seen.names:
        axes.set_yticks(range(len(seen.names)), [_wrapped(text) for text in seen.names])
        axes.tick_params(axis="y", which="both", length=0)
        limits(low, high)
    elif axis.linear_below is not None:
        symlog(axes, axis.linear_below, low, high)
    elif seen.log:
        limits(10.0**low, 10.0**high)
        few_ticks(own, 10.0**low, 10.0**high, small=small)
        _label_parts(own, low, high)
    elif axis.unit == "date":
        _dates(axes)
        limits(low, high)
    else:
        limits(low, high)
        if axis.unit == "" and axis.label.startswith(("number", "cycle", "pair")):
            own.set_major_locator(MaxNLocator(8, integer=True))
        if small and not any(isinstance(a, SmallTicks) and a.axis is own for a in axes.artists):
            axes.add_artist(SmallTicks(own, AutoMinorLocator()))


def _label_parts(axis: Any, low: float, high: float) -> None:
    """Label values between the decades, e.g. 2 and 5, if a log axis has fewer than 1.7 decades."""
    if high - low < 1.7:
        axis.set_major_locator(_parts_locator(high - low))
        axis.set_major_formatter(FuncFormatter(_part_of_decade))


def _part_of_decade(value: float, place: int | None = None) -> str:
    """Return the label of a tick between decades, e.g. 0.02 or 5·10⁻⁶."""
    if 1e-3 <= value < 1e4 or power_of_ten(value).startswith("10"):
        return f"{value:g}" if 1e-3 <= value < 1e4 else power_of_ten(value)
    exponent = int(np.floor(np.log10(value) + 1e-9))
    return f"{value / 10.0**exponent:.3g}·{power_of_ten(10.0**exponent)}"


def _parts_locator(decades: float) -> Any:
    # imported late: matplotlib's locators load slowly
    from matplotlib.ticker import LogLocator

    return LogLocator(subs=(1, 2, 5) if decades > 0.35 else (1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9))


def _dates(axes: Axes) -> None:
    # imported late: dates load slowly
    import matplotlib.dates as mdates

    locator = mdates.AutoDateLocator(maxticks=6)
    axes.xaxis.set_major_locator(locator)
    axes.xaxis.set_major_formatter(mdates.ConciseDateFormatter(locator))


def _wrapped(text: str) -> str:
    # imported late: needed for long names only
    import textwrap

    apart = str(text).replace("_", "_ ")  # allows line breaks after underscores
    lines = textwrap.wrap(apart, 25, max_lines=3, placeholder=" …") or [""]
    return "\n".join(plain(line.replace("_ ", "_")) for line in lines)
