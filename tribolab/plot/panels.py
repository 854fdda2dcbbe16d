"""All strokes of a run side by side: small multiples, one panel per speed."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from tribolab.errors import AnalysisError
from tribolab.plot.labels import aligned, column, plain, speed_text
from tribolab.plot.reduce import envelope
from tribolab.plot.signals import Signal, Stroke, main_signal
from tribolab.plot.signals import strokes as find_strokes
from tribolab.plot.style import (
    BACKWARD,
    DOUBLE_MM,
    FORWARD,
    MEAN,
    SKY,
    PaperFigure,
    margins,
    new_figure,
    paper_style,
)

_MOST_PANELS = 24
_MOST_LINES = 6  # per direction and panel
_POINTS = 2000  # pixel columns in the whole figure, which keeps it below 150 kB
_TOLERANCE = 0.05
_COLOURS = {1: FORWARD, -1: BACKWARD, 0: SKY}


def strokes(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None = None,
    *,
    title: str = "",
) -> PaperFigure:
    """Draw every segment over its own sliding distance, one panel per speed, slowest first.

    A run that spends 1000 s at 1 um/s and a second at 1 cm/s cannot be judged on one time axis;
    here every speed has the same room.

    Parameters
    ----------
    run
        A run (time).
    segments
        Its segments (segment).
    friction
        Its friction result (segment): adds the means, and removes the offset that was found.
    title
        Text above the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Forward and backward strokes overlaid, both counted positive in their own direction. Each
        panel has its own vertical scale, which fits the part that counts; the trimmed ends are
        grey. Of many strokes at one speed evenly chosen ones are drawn and the panel says so.

    Raises
    ------
    AnalysisError
        If there is no segment to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4, 1e-3)))
    >>> run = rig.simulate_run("Sb-S", "dry", rig=short).noise_free
    >>> segments = tl.find_segments(run)
    >>> friction = tl.friction_coefficient(run, segments)
    >>> tl.plot.figure_data(strokes(run, segments, friction)).panel.unique().tolist()
    ['100 µm/s', '1 mm/s']
    """
    signal = main_signal(run, friction)
    parts = find_strokes(run, segments)
    if not parts:
        raise AnalysisError("the run has no segment, so there are no strokes to draw")
    groups = _by_speed(parts)
    shown = _evenly(groups, _MOST_PANELS)
    # the widest grid that leaves the fewest places empty
    across = min((5, 4, 3), key=lambda n: -len(shown) % n) if len(shown) > 5 else len(shown)
    down = -(-len(shown) // across)
    panel_height = {1: 52.0, 2: 40.0}.get(across, 27.0)
    height = panel_height * down + (down - 1) * 5.0
    lines = sum(len(_chosen(group)) for group in shown)
    budget = int(np.clip(_POINTS // lines, 30, 300))
    with paper_style():
        figure = new_figure(DOUBLE_MM, height + 19.0)
        grid = figure.subplots(down, across, squeeze=False)
        margins(figure, 15, 3, 11, 8, wspace=0.085 * across, hspace=5.0 / panel_height)
        for axes, group in zip(grid.flat, shown, strict=False):
            _panel(figure, axes, group, signal, friction, budget, narrow=across > 4)
        for axes in grid.flat[len(shown) :]:
            axes.remove()
        for k, axes in enumerate(grid.flat[: len(shown)]):
            below = k + across < len(shown)
            axes.tick_params(labelbottom=not below)
        unit = "" if signal.name == "friction_coefficient" else " (N)"
        word = r"friction coefficient $\mu$" if not unit else r"friction force $F_x$ (N)"
        figure.supylabel(word, x=2.5 / DOUBLE_MM, fontsize=8, va="center")
        known = np.isfinite([part.speed for part in parts]).all() or "position" in run
        share = "distance slid / length of the stroke" if known else "time / duration of the stroke"
        figure.supxlabel(share, y=0.8 / (height + 19.0), fontsize=8)
        _key(figure, parts, friction is not None, height + 19.0)
        heading = plain(title)
        if len(shown) < len(groups):
            heading += f"  ({len(shown)} of {len(groups)} speeds shown)"
        figure.text(15 / DOUBLE_MM, 1 - 1.6 / (height + 19), heading.strip(), va="top", fontsize=8)
    return figure


def _by_speed(parts: list[Stroke]) -> list[list[Stroke]]:
    """Group strokes whose speeds agree within the tolerance; unknown speeds come last."""
    ordered = sorted(parts, key=lambda p: (not np.isfinite(p.speed), p.speed, p.number))
    groups: list[list[Stroke]] = []
    for part in ordered:
        first = groups[-1][0].speed if groups else None
        same = first is not None and np.isclose(
            first, part.speed, rtol=2 * _TOLERANCE, atol=0, equal_nan=True
        )
        if same:
            groups[-1].append(part)
        else:
            groups.append([part])
    return groups


def _evenly(items: list, most: int) -> list:
    if len(items) <= most:
        return items
    return [items[k] for k in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def _chosen(group: list[Stroke]) -> list[Stroke]:
    sides = [[p for p in group if np.sign(p.direction) == side] for side in (1, 0, -1)]
    return [part for side in sides for part in _evenly(side, _MOST_LINES)]


def _panel(figure, axes: Axes, group, signal: Signal, friction, budget: int, narrow: bool) -> None:
    panel = speed_text(float(np.median([part.speed for part in group])))
    chosen = _chosen(group)
    every = []
    for part in chosen:
        length = part.distance[-1] or 1.0
        sign = _sign(part, signal, friction)
        x, y = envelope(part.distance / length, sign * signal.values[part.samples], budget)
        colour = _COLOURS[int(np.sign(part.direction))]
        axes.plot(x, y, color=colour, linewidth=0.5, alpha=0.65, zorder=3)
        numbers = {"distance_over_length": x, column(signal.name): y}
        figure.keep(panel, f"segment {part.number}", **numbers)
        counted = (x >= part.trimmed[0] / length) & (x <= part.trimmed[1] / length)
        every.append(y[counted])
        if friction is not None and signal.name in friction:
            mean = float(friction[signal.name][part.number])
            mean = mean if signal.name == "friction_coefficient" else sign * mean
            inner = np.array(part.trimmed) / length
            axes.plot(inner, [mean, mean], color=MEAN, linewidth=0.9, zorder=5)
    trimmed = np.array([np.array(part.trimmed) / (part.distance[-1] or 1.0) for part in chosen])
    for a, b in ((0.0, trimmed[:, 0].min()), (trimmed[:, 1].max(), 1.0)):
        axes.axvspan(a, b, color="#E4E4E4", linewidth=0, zorder=0)
    values = np.concatenate(every)
    values = values[np.isfinite(values)]
    room = 0.6 if narrow else 0.4  # for the text, of two lines in a narrow panel
    if values.size:
        low, high = values.min(), values.max()
        span = max(high - low, 0.02 * abs(high)) or 1.0
        axes.set_ylim((low + high - span) / 2 - 0.15 * span, (low + high + span) / 2 + room * span)
    axes.set_xlim(0, 1)
    axes.yaxis.set_major_locator(MaxNLocator(3))
    axes.tick_params(top=False, right=False)
    axes.set_xticks([0, 0.5, 1], ["0", "0.5", "1"])
    left = panel if len(chosen) == len(group) else f"{panel} ({len(chosen)} of {len(group)})"
    inset = {"textcoords": "offset points", "xycoords": "axes fraction", "va": "top"}
    axes.annotate(left, (0, 1), xytext=(3, -3), fontsize=7, zorder=6, **inset)
    text = _mean_text(group, signal, friction)
    corner, side = ((0, 1), (3, -11.5)) if narrow else ((1, 1), (-3, -3))
    align = "left" if narrow else "right"
    axes.annotate(text, corner, xytext=side, ha=align, fontsize=7, zorder=6, **inset)


def _sign(part: Stroke, signal: Signal, friction) -> float:
    """Sign that makes ordinary friction positive; an instrument may have rectified already."""
    if friction is not None and "friction_coefficient" in friction:
        values = signal.values[part.samples]
        values = values[np.isfinite(values)]
        mean = float(friction["friction_coefficient"][part.number])
        if values.size and np.isfinite(mean):
            return 1.0 if np.mean(values) * mean >= 0 else -1.0
    return -1.0 if part.direction < 0 else 1.0


def _mean_text(group: list[Stroke], signal: Signal, friction) -> str:
    if friction is None or signal.name != "friction_coefficient" or signal.name not in friction:
        return ""
    means = np.array([float(friction[signal.name][part.number]) for part in group])
    if not np.isfinite(means).any():
        return ""
    return rf"$\mu$ = {aligned(float(np.nanmean(means)))}"


def _key(figure: PaperFigure, parts: list[Stroke], means: bool, height: float) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    words = {1: "forward", -1: "backward", 0: "direction unknown"}
    seen = sorted({int(np.sign(part.direction)) for part in parts}, reverse=True)
    handles = [Line2D([], [], color=_COLOURS[d], linewidth=0.8, label=words[d]) for d in seen]
    if means:
        handles.append(Line2D([], [], color=MEAN, linewidth=0.9, label="mean"))
    handles.append(Patch(color="#E4E4E4", linewidth=0, label="trimmed"))
    figure.legend(
        handles=handles,
        loc="upper right",
        bbox_to_anchor=(1 - 3 / DOUBLE_MM, 1 - 1.4 / height),
        ncols=5,
        handlelength=1.4,
    )
