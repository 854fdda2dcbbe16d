"""All strokes of a run side by side: small multiples, one panel per speed."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox, TransformedBbox

from tribolab.errors import AnalysisError
from tribolab.figures.envelope import envelope
from tribolab.figures.labels import column, plain
from tribolab.figures.look.guests import whole_figure
from tribolab.figures.look.style import (
    BACKWARD,
    DOUBLE_MM,
    FORWARD,
    MEAN,
    SKY,
    keep,
    new_figure,
    paper_style,
)
from tribolab.figures.signals import Signal, Stroke, main_signal, strokes_of
from tribolab.untyped import Arguments
from tribolab.words import MINUS, aligned, number, speed_text

_MOST_PANELS = 24
_MOST_LINES = 6  # per direction and panel
_POINTS = 2000  # pixel columns in the whole figure, which keeps it below 150 kB
_TOLERANCE = 0.05
_COLOURS = {1: FORWARD, -1: BACKWARD, 0: SKY}
_Item = TypeVar("_Item")


def strokes(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None = None,
    *,
    title: str = "",
    fig: Figure | SubFigure | None = None,
) -> Figure:
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
    fig
        A figure, or a part of one from `Figure.subfigures`, to draw in; without it one is made.

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
    parts = strokes_of(run, segments)
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
    with paper_style():  # in a figure of the user's, too: all of it is text and lines of ours
        page = new_figure(DOUBLE_MM, height + 19.0) if fig is None else fig
        figure = page if isinstance(page, Figure) else whole_figure(page)
        sheet = _sheet(page, height + 19.0)
        wide = (DOUBLE_MM - 18.0) / (across + (across - 1) * 0.085 * across)
        for k, group in enumerate(shown):
            row, column_ = divmod(k, across)
            left = 15.0 + column_ * wide * (1 + 0.085 * across)
            cell = _Cell(sheet, left, 11.0 + (down - 1 - row) * (panel_height + 5.0), wide)
            _panel(figure, cell, panel_height, group, signal, friction, budget, across > 4)
            cell.ticks_below(panel_height, labelled=k + across >= len(shown))
        unit = "" if signal.name == "friction_coefficient" else " (N)"
        word = r"friction coefficient $\mu$" if not unit else r"friction force $F_x$ (N)"
        page.supylabel(word, x=2.5 / DOUBLE_MM, fontsize=8, va="center")
        known = np.isfinite([part.speed for part in parts]).all() or "position" in run
        share = "distance slid / length of the stroke" if known else "time / duration of the stroke"
        page.supxlabel(share, y=0.8 / (height + 19.0), fontsize=8)
        _key(page, parts, friction is not None, height + 19.0)
        heading = plain(title)
        if len(shown) < len(groups):
            heading += f"  ({len(shown)} of {len(groups)} speeds shown)"
        page.text(15 / DOUBLE_MM, 1 - 1.6 / (height + 19), heading.strip(), va="top", fontsize=8)
    return figure


def _sheet(figure: Figure | SubFigure, height: float) -> Axes:
    """Axes over the whole figure, in mm: a run may have two dozen panels, and axes are slow."""
    sheet = figure.add_axes((0, 0, 1, 1), xlim=(0, DOUBLE_MM), ylim=(0, height), autoscale_on=False)
    sheet.set_axis_off()
    return sheet


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


def _evenly(items: list[_Item], most: int) -> list[_Item]:
    if len(items) <= most:
        return items
    return [items[k] for k in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def _chosen(group: list[Stroke]) -> list[Stroke]:
    sides = [[p for p in group if np.sign(p.direction) == side] for side in (1, 0, -1)]
    return [part for side in sides for part in _evenly(side, _MOST_LINES)]


def _panel(
    figure: Figure,
    cell: _Cell,
    height: float,
    group: list[Stroke],
    signal: Signal,
    friction: xr.Dataset | None,
    budget: int,
    narrow: bool,
) -> None:
    panel = speed_text(float(np.median([part.speed for part in group])))
    chosen = _chosen(group)
    every, traces, means = [], [], []
    for part in chosen:
        length = part.distance[-1] or 1.0
        sign = _sign(part, signal, friction)
        x, y = envelope(part.distance / length, sign * signal.values[part.samples], budget)
        colour = _COLOURS[int(np.sign(part.direction))]
        traces.append((x, y, colour))
        numbers = {"distance_over_length": x, column(signal.name): y}
        keep(figure, panel, f"segment {part.number}", **numbers)
        counted = (x >= part.trimmed[0] / length) & (x <= part.trimmed[1] / length)
        every.append(y[counted])
        if friction is not None and signal.name in friction:
            mean = float(friction[signal.name][part.number])
            mean = mean if signal.name == "friction_coefficient" else sign * mean
            inner = np.array(part.trimmed) / length
            means.append((inner, np.array([mean, mean])))
    trimmed = np.array([np.array(part.trimmed) / (part.distance[-1] or 1.0) for part in chosen])
    values = np.concatenate(every)
    values = values[np.isfinite(values)]
    low, high = 0.0, 1.0
    if values.size:
        room = 0.6 if narrow else 0.4  # for the text, of two lines in a narrow panel
        low, high = values.min(), values.max()
        span = max(high - low, 0.02 * abs(high)) or 1.0
        low, high = (low + high - span) / 2 - 0.15 * span, (low + high + span) / 2 + room * span
    cell.frame(height, low, high)
    for a, b in ((0.0, trimmed[:, 0].min()), (trimmed[:, 1].max(), 1.0)):
        cell.shade(a, b)
    for x, y, colour in traces:
        cell.line(x, y, color=colour, linewidth=0.5, alpha=0.65, zorder=3)
    for x, y in means:
        cell.line(x, y, color=MEAN, linewidth=0.9, zorder=5)
    left = panel if len(chosen) == len(group) else f"{panel} ({len(chosen)} of {len(group)})"
    cell.say(left, "left", 1.0)
    cell.say(_mean_text(group, signal, friction), *(("left", 4.0) if narrow else ("right", 1.0)))


class _Cell:
    """A panel on the sheet: places in it are 0 to 1 across, and values up.

    Parameters
    ----------
    sheet
        From `_sheet`.
    left, bottom, width
        Its place [mm].
    """

    def __init__(self, sheet: Axes, left: float, bottom: float, width: float) -> None:
        self.sheet, self.left, self.bottom, self.width = sheet, left, bottom, width

    def frame(self, height: float, low: float, high: float) -> None:
        """Draw the frame and the ticks of the values from `low` to `high`."""
        self.height, self.low, self.scale = height, low, height / (high - low)
        self.box = TransformedBbox(
            Bbox.from_bounds(self.left, self.bottom, self.width, height), self.sheet.transData
        )
        self._add(Rectangle((self.left, self.bottom), self.width, height, fill=False, **_EDGE))
        ticks = np.asarray(MaxNLocator(3).tick_values(low, high))
        ticks = ticks[(ticks >= low) & (ticks <= high)]
        for tick, text in zip(ticks, _tick_labels(ticks), strict=True):
            y = self.bottom + (tick - low) * self.scale
            self._add(Line2D([self.left, self.left + _TICK], [y, y], **_LINE))
            self.sheet.text(self.left - 1.2, y, text, ha="right", va="center", fontsize=7)

    def ticks_below(self, height: float, *, labelled: bool) -> None:
        """Draw the ticks of the places in the stroke."""
        for place, text in ((0.0, "0"), (0.5, "0.5"), (1.0, "1")):
            x = self.left + place * self.width
            self._add(Line2D([x, x], [self.bottom, self.bottom + min(_TICK, height)], **_LINE))
            if labelled:
                self.sheet.text(x, self.bottom - 1.2, text, ha="center", va="top", fontsize=7)

    def line(self, x: np.ndarray, y: np.ndarray, **look: Any) -> None:
        """Draw values over places; what lies outside the frame is cut off."""
        up = self.bottom + (y - self.low) * self.scale
        line = Line2D(self.left + x * self.width, up, **look)
        self._add(line)
        line.set_clip_box(self.box)

    def shade(self, begin: float, end: float) -> None:
        """Shade the places from `begin` to `end`."""
        corner = (self.left + begin * self.width, self.bottom)
        size = ((end - begin) * self.width, self.height)
        self._add(Rectangle(corner, *size, color="#E4E4E4", linewidth=0, zorder=0))

    def say(self, text: str, side: str, below: float) -> None:
        """Write into a corner, so far below the upper edge [mm]."""
        if text:
            x = self.left + 1.0 if side == "left" else self.left + self.width - 1.0
            y = self.bottom + self.height - below
            self.sheet.text(x, y, text, ha=side, va="top", fontsize=7, zorder=6)

    def _add(self, artist: Artist) -> None:
        # the sheet's own limits need no look at what is on it
        self.sheet.add_artist(artist)


_TICK = 1.0  # mm
_LINE: Arguments = {"color": "#222222", "linewidth": 0.6, "zorder": 4}
_EDGE: Arguments = {"edgecolor": "#222222", "linewidth": 0.6, "zorder": 4}


def _tick_labels(ticks: np.ndarray) -> list[str]:
    """Write numbers with as many decimals as their distance asks for."""
    if len(ticks) < 2:
        return [number(float(tick)) for tick in ticks]
    step = float(ticks[1] - ticks[0])
    decimals = next(
        (
            d
            for d in range(5)
            if np.isclose(step * 10**d % 1, 0, atol=1e-6)
            or np.isclose(step * 10**d % 1, 1, atol=1e-6)
        ),
        None,
    )
    if decimals is None:
        return [number(float(tick)) for tick in ticks]
    return [f"{tick + 0.0:.{decimals}f}".replace("-", MINUS) for tick in ticks]


def _sign(part: Stroke, signal: Signal, friction: xr.Dataset | None) -> float:
    """Sign that makes ordinary friction positive; an instrument may have rectified already."""
    if friction is not None and "friction_coefficient" in friction:
        values = signal.values[part.samples]
        values = values[np.isfinite(values)]
        mean = float(friction["friction_coefficient"][part.number])
        if values.size and np.isfinite(mean):
            return 1.0 if np.mean(values) * mean >= 0 else -1.0
    return -1.0 if part.direction < 0 else 1.0


def _mean_text(group: list[Stroke], signal: Signal, friction: xr.Dataset | None) -> str:
    if friction is None or signal.name != "friction_coefficient" or signal.name not in friction:
        return ""
    means = np.array([float(friction[signal.name][part.number]) for part in group])
    if not np.isfinite(means).any():
        return ""
    return f"µ = {aligned(float(np.nanmean(means)))}"


def _key(figure: Figure | SubFigure, parts: list[Stroke], means: bool, height: float) -> None:
    words = {1: "forward", -1: "backward", 0: "direction unknown"}
    seen = sorted({int(np.sign(part.direction)) for part in parts}, reverse=True)
    handles: list[Artist] = [
        Line2D([], [], color=_COLOURS[d], linewidth=0.8, label=words[d]) for d in seen
    ]
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
