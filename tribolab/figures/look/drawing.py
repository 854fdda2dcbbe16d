"""Drawing of a described figure with matplotlib, as a new figure or in given axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.typing import LineStyleType

from tribolab.core.errors import AnalysisError
from tribolab.core.untyped import Arguments
from tribolab.figures.axes import Scale, scales
from tribolab.figures.colours import MARKERS, PALETTE
from tribolab.figures.labels import plain
from tribolab.figures.look.guests import Panels, guests, name_all, whole_figure
from tribolab.figures.look.scales import MAX_WITH_SMALL_TICKS, RAMP, axis_text, scale_axis, x_range
from tribolab.figures.look.sheet import Sheet, finish, new_sheet
from tribolab.figures.look.style import keep, paper_style
from tribolab.figures.spec import FigureSpec, Key, Mark, Series, legend

_LINES: dict[str, LineStyleType] = {
    "line": "-", "dashed": "--", "dotted": (0, (1, 1.2)), "dashdot": "-.", "longdash": (0, (8, 2)),
}  # fmt: skip
_MAX_LEGEND_ENTRY = 64  # most characters of a legend entry
_LEVELS = 0.3, 3.0  # ends of a map's colour scale, log10(power / noise), as on the page


def draw(
    spec: FigureSpec, *, title: str = "", ax: Axes | Panels | None = None, width: float = 0.0
) -> Figure:
    """Draw a described figure with matplotlib.

    Parameters
    ----------
    spec
        Description of the figure.
    title
        Text above it.
    ax
        Axes to draw in, one for each panel; they keep their style. By default a figure is made.
    width
        Width of a new figure [mm]: 86 (one column) or 178 (two); 0 uses that of the description.

    Raises
    ------
    AnalysisError
        If there is nothing to draw, or the numbers of axes and panels differ.

    Examples
    --------
    >>> from tribolab.figures.spec import Axis, FigureSpec, Panel, Series
    >>> line = Series("line", x=[0, 1], y=[0, 2])
    >>> len(draw(FigureSpec(panels=(Panel(Axis("x"), Axis("y")),), series=(line,))).axes)
    1
    """
    spec = replace(spec, series=tuple(plain_values(series) for series in spec.series))
    if ax is None:
        with paper_style():
            sheet = new_sheet(spec, title, width)
            _fill(spec, sheet)
            finish(spec, sheet)
            return sheet.figure
    given = [ax] if isinstance(ax, Axes) else list(np.ravel(np.asarray(ax, dtype=object)))
    if len(given) != len(spec.panels):
        count = len(spec.panels)
        names = ", ".join(plain(panel.name or panel.y.label) for panel in spec.panels)
        raise AnalysisError(
            f"axes: {count} {'is' if count == 1 else 'are'} wanted, for {names}; got {len(given)}"
        )
    with guests(given):
        sheet = Sheet(whole_figure(given[0]), given)
        _fill(spec, sheet)
    for panel in given:
        name_all(panel)
    if title:
        given[0].set_title(plain(title))
    return sheet.figure


def plain_values(series: Series) -> Series:
    """Return a series with its data as lists of plain numbers, not arrays."""
    names = ("x", "y", "high", "error", "error_below", "sizes")
    numbers = {name: np.asarray(getattr(series, name)).tolist() for name in names}
    return replace(series, **numbers, columns=_columns_of(series))


def _columns_of(series: Series) -> dict[str, Any] | None:
    if series.columns is None:
        return {"": (series.x, series.y, series.high, series.error)}
    return {name: np.asarray(values) for name, values in series.columns.items()}


def _fill(spec: FigureSpec, sheet: Sheet) -> None:
    seen = [scales(panel, k, spec.series) for k, panel in enumerate(spec.panels)]
    for number, (axes, panel) in enumerate(zip(sheet.panels, spec.panels, strict=True)):
        mine = [series for series in spec.series if series.panel == number]
        x, y = seen[number]
        named = list(legend(mine).values())
        along = x_range(spec, number, seen)
        small = len(spec.panels) <= MAX_WITH_SMALL_TICKS
        scale_axis(axes, "x", panel.x, along, small)
        scale_axis(axes, "y", panel.y, y, small)
        limits = axes.get_xlim(), axes.get_ylim()
        axes.set_autoscale_on(False)
        for series in sorted(mine, key=lambda series: series.style != "band"):
            label = series.label if any(series is one for one in named) else ""
            _series(axes, series, y, mine, plain(label, _MAX_LEGEND_ENTRY) or "_nolegend_")
            _store(sheet.figure, spec, series)
        for mark in spec.marks:
            if mark.panel == number:
                _mark(axes, mark)
        _write_labels_above(
            axes, [mark for mark in spec.marks if mark.panel == number], x_range(spec, number, seen)
        )
        if any(series.style == "heat" for series in mine):
            _colour_bar(axes)
        axes.set_xlim(limits[0])  # restore the limits, which error bars have changed
        axes.set_ylim(limits[1])
        axes.set_xlabel(axis_text(panel.x) if _is_last(spec, number) else "")
        if not y.names and _is_first(spec, number):
            axes.set_ylabel(axis_text(panel.y))
    for key in spec.keys:
        _key(sheet.panels[0], key)


def _is_last(spec: FigureSpec, number: int) -> bool:
    """Whether no panel below a panel has the same abscissa, so that it needs the label."""
    below = spec.panels[number + max(spec.across, 1) :: max(spec.across, 1)]
    return not any(panel.x == spec.panels[number].x for panel in below)


def _is_first(spec: FigureSpec, number: int) -> bool:
    """Whether no panel to the left of a panel has the same ordinate, so that it needs the label."""
    row = spec.panels[number - number % max(spec.across, 1) : number]
    return not any(panel.y.label == spec.panels[number].y.label for panel in row)


def colour_of(series: Series | Mark | Key) -> str:
    """Return the colour of a series as hexadecimal RGB: from the palette, shaded by load."""
    base = PALETTE[series.colour % len(PALETTE)]
    shade = getattr(series, "shade", 0.0)
    if not shade:
        return base
    rgb, target = np.array(to_rgb(base)), np.full(3, float(shade > 0))
    return to_hex(rgb + abs(shade) * (target - rgb))


def _floats(values: Any) -> np.ndarray:
    return np.array([np.nan if value is None else value for value in values], float)


def _series(axes: Axes, series: Series, y_seen: Scale, every: Sequence[Series], label: str) -> None:
    colour = colour_of(series)
    x = _floats(series.x)
    y = _floats(map(y_seen.names.index, series.y)) if y_seen.names else _floats(series.y)
    if series.style == "points":
        _points(axes, series, x, y, colour, label, lying=bool(y_seen.names))
    elif series.style == "band":
        high, least = _floats(series.high), 10.0 ** (y_seen.low - 3) if y_seen.log else -np.inf
        fine = np.isfinite(y) & np.isfinite(high)
        axes.fill_between(
            x[fine], np.maximum(y[fine], least), high[fine], color=colour, alpha=0.2, linewidth=0,
            label=label,
        )  # fmt: skip
    elif series.style == "bars":
        bars = [one for one in every if one.style == "bars" and set(one.y) & set(series.y)]
        thick = 0.8 / len(bars)
        shift = ((len(bars) - 1) / 2 - next(k for k, b in enumerate(bars) if b is series)) * thick
        axes.barh(y + shift, x, 0.9 * thick, color=colour, label=label)
    elif series.style == "heat":
        axes.scatter(
            x, y, 5.0, _floats(series.high), marker="s", cmap=RAMP, vmin=_LEVELS[0],
            vmax=_LEVELS[1], linewidths=0, rasterized=True, label=label,
        )  # fmt: skip
    else:
        if y_seen.log:
            y = np.where(y > 0, y, np.nan)
        axes.plot(
            x, y, color=colour, linestyle=_LINES[series.style], linewidth=0.5 if series.thin else
            1.1, label=label, zorder=3, markevery=[],
        )  # fmt: skip


def _points(
    axes: Axes, series: Series, x: np.ndarray, y: np.ndarray, colour: str, label: str,
    *, lying: bool,
) -> None:  # fmt: skip
    marker = MARKERS[(series.colour if series.marker is None else series.marker) % len(MARKERS)]
    if len(series.error):
        above = _floats(series.error)
        below = _floats(series.error_below) if len(series.error_below) else above
        known = np.isfinite(above) & np.isfinite(x) & np.isfinite(y)
        bars = np.maximum(np.nan_to_num(np.stack([below, above])), 0.0)[:, known]
        look: Arguments = (
            {"elinewidth": 2.4, "alpha": 0.28}
            if series.pale
            else {"elinewidth": 0.8, "capsize": 1.8, "capthick": 0.8}
        )
        if known.any():
            axes.errorbar(
                x[known], y[known], **{"xerr" if lying else "yerr": bars}, fmt="none",
                ecolor=colour, zorder=2.5, **look,
            )  # fmt: skip
    face = "white" if series.open else colour
    if len(series.sizes):
        axes.scatter(
            x, y, 17.6 * _floats(series.sizes), marker=marker, facecolors=face, edgecolors=colour,
            linewidths=0.9, label=label, zorder=4,
        )  # fmt: skip
        return
    line = ("--" if series.open else "-") if series.joined else "none"
    axes.plot(
        x, y, color=colour, marker=marker, markersize=4.2 if not series.thin else 2.0,
        markeredgewidth=0.9, markerfacecolor=face, linestyle=line, linewidth=0.7, label=label,
        zorder=4,
    )  # fmt: skip


def _colour_bar(axes: Axes) -> None:
    """Draw the colour scale of a heat map inside its panel."""
    maps = [drawn for drawn in axes.collections if drawn.get_array() is not None]
    inset = axes.inset_axes((0.04, 0.93, 0.3, 0.035))
    whole_figure(axes).colorbar(maps[-1], cax=inset, orientation="horizontal", ticks=[0.5, 1, 2, 3])
    inset.tick_params(labelsize=6, pad=1, length=2)
    inset.set_xlabel("log₁₀ of the ratio", fontsize=6, labelpad=1)


def _write_labels_above(axes: Axes, marks: Sequence[Mark], seen: Scale) -> None:
    """Write labels at the upper end of marks, in two rows; labels without room are omitted."""
    width = 25.4 * axes.get_window_extent().width / whole_figure(axes).dpi  # width of the axes, mm
    ends = [6.0, 0.0]  # mm occupied in each of two rows; the panel letter is in the first
    for mark in marks:
        at = seen.place(mark.value + ((mark.until or mark.value) - mark.value) / 2)
        if not mark.above or at is None:
            continue
        middle, need = at * width, len(mark.above) * 1.35 + 2.0  # width of the label in mm at 7 pt
        row = next((k for k in (0, 1) if middle - need / 2 >= ends[k]), None)
        if row is None or middle + need / 2 > width:
            continue
        ends[row] = middle + need / 2
        axes.annotate(
            mark.above, (at, 1), xytext=(0, -3 - 8.5 * row), xycoords="axes fraction",
            textcoords="offset points", ha="center", va="top", fontsize=7, zorder=6,
        )  # fmt: skip


def _mark(axes: Axes, mark: Mark) -> None:
    colour, words = colour_of(mark), plain(mark.text) or "_nolegend_"
    if mark.until is not None:
        across = axes.axvspan if mark.side == "x" else axes.axhspan
        across(
            mark.value, mark.until, color=colour, alpha=mark.opacity, linewidth=0, label=words,
            zorder=1,
        )  # fmt: skip
    else:
        line = axes.axvline if mark.side == "x" else axes.axhline
        line(
            mark.value, color=colour, linestyle=_LINES[mark.style], linewidth=0.7, zorder=0.5,
            alpha=mark.opacity, label=words,
        )  # fmt: skip


def _key(axes: Axes, key: Key) -> None:
    colour = colour_of(key)
    if key.style == "band":
        axes.fill_between([], [], [], color=colour, alpha=0.2, linewidth=0, label=plain(key.label))
        return
    axes.plot(
        [], [], color=colour, linewidth=1.1, label=plain(key.label),
        linestyle="none" if key.style == "points" else _LINES[key.style],
        marker="o" if key.marker or key.style == "points" else "", markersize=4,
        markerfacecolor="white" if key.open else colour,
    )  # fmt: skip


def _store(figure: Figure, spec: FigureSpec, series: Series) -> None:
    """Store the numbers of a series in the figure, for `figure_data`."""
    columns, panel = series.columns or {}, spec.panels[series.panel]
    if "" in columns:
        x, y, high, error = columns[""]
        names = [axis.column or axis.label or "name" for axis in (panel.x, panel.y)]
        ends = ("_low", "_high") if series.style == "band" else ("", "_level")
        columns = {names[0]: np.asarray(x), names[1] + ends[0]: np.asarray(y)}
        if len(high):
            columns[names[1] + ends[1]] = np.asarray(high)
        if len(error):
            columns[names[1] + ("_std" if series.pale else "_U95")] = np.asarray(error, float)
    if columns:
        numbers = {name: np.asarray(values) for name, values in columns.items()}
        keep(figure, panel.name or panel.y.label, series.name or series.label, **numbers)
