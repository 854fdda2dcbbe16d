"""The figures of a run: its trace over time and distance."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import FixedLocator, NullLocator
from matplotlib.transforms import blended_transform_factory

from tribolab.figures.envelope import envelope
from tribolab.figures.labels import column, label, plain
from tribolab.figures.look.guests import Panels, name_all, name_panel, several_panels, width_mm
from tribolab.figures.look.style import (
    BACKWARD,
    DOUBLE_MM,
    FORWARD,
    MEAN,
    NEUTRAL,
    SKY,
    PaperFigure,
    keep,
    new_figure,
    tidy,
)
from tribolab.figures.signals import Signal, Stroke, main_signal, strokes_of
from tribolab.words import speed_text

_COLUMNS = 420  # pixel columns of a double-column panel: two to a typographic point
_LEFT, _RIGHT, _BOTTOM, _TOP = 17.0, 3.0, 11.0, 6.0
_WIDTH = DOUBLE_MM - _LEFT - _RIGHT
_HEIGHTS = {"time": 44.0, "motion": 26.0, "distance": 44.0}  # mm
_GAPS = {"motion": 3.0, "distance": 13.0}
_MOTION = ("sliding_velocity", "set_speed", "position")
_SHADE = {1: FORWARD, -1: BACKWARD, 0: SKY}


def trace(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None = None,
    *,
    title: str = "",
    axes: Panels | None = None,
) -> Figure:
    """Draw a run over time and over sliding distance, with its segments shaded.

    Parameters
    ----------
    run
        A run (time).
    segments
        Its segments (segment); the trimmed ends are shaded more lightly.
    friction
        Its friction result (segment): the mean of every segment is drawn, and the offset that
        was found is removed from the trace.
    title
        Text above the figure.
    axes
        The axes to draw in, one for each panel below; they keep their look. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Panels: friction coefficient (or force, where no load was recorded) over time; sliding
        velocity (else set speed, else position) over time; friction over the distance slid in
        the segments. What was not recorded, or is constant, has no panel.

    Raises
    ------
    AnalysisError
        If the run has neither a friction force nor a friction coefficient.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4, 1e-3)))
    >>> run = rig.simulate_run("Sb-S", "dry", rig=short).noise_free
    >>> segments = tl.find_segments(run)
    >>> friction = tl.friction_coefficient(run, segments)
    >>> figure = trace(run, segments, friction, title="Sb-S, dry")
    >>> tl.plot.figure_data(figure).panel.unique().tolist()
    ['time', 'motion', 'distance']
    """
    signal = main_signal(run, friction)
    parts = strokes_of(run, segments)
    time = np.asarray(run["time"], float)
    motion = next((n for n in _MOTION if n in run and np.ptp(np.asarray(run[n], float)) != 0), "")
    known = bool(parts) and bool(np.isfinite([part.speed for part in parts]).all())
    rows = ["time"] + ["motion"] * bool(motion) + ["distance"] * known
    with several_panels(axes, rows, lambda: _rows(rows)) as (figure, given):
        panels = dict(zip(rows, given, strict=True))
        _over_time(figure, panels["time"], time, signal, segments, friction)
        last = panels["time"]
        if motion:
            last = panels["motion"]
            _motion(figure, last, time, motion, run, segments)
            panels["time"].tick_params(labelbottom=axes is not None)
        last.set_xlabel(label("time", "time"))
        if known:
            _over_distance(figure, panels["distance"], signal, parts, friction)
        _key(panels["time"], parts, friction is not None, joined=axes is not None)
        if axes is not None:
            panels["time"].set_xlabel(label("time", "time"))
            name_panel(panels["time"], title)
            return figure
        for letter, row in zip("abc", rows, strict=False):
            tidy(panels[row], letter if len(rows) > 1 else "")
        if title:
            top = 1 - 1.2 / _total(rows)
            figure.text(_LEFT / DOUBLE_MM, top, plain(title), va="top", fontsize=8)
    return figure


def _total(rows: list[str]) -> float:
    """Height [mm] of a figure with these panels."""
    return sum(_HEIGHTS[row] + _GAPS.get(row, 0.0) for row in rows) + _BOTTOM + _TOP


def _rows(rows: list[str]) -> tuple[PaperFigure, list[Axes]]:
    total = _total(rows)
    figure = new_figure(DOUBLE_MM, total)
    panels, top = [], total - _TOP
    for row in rows:
        top -= _GAPS.get(row, 0.0) + _HEIGHTS[row]
        box = (_LEFT / DOUBLE_MM, top / total, _WIDTH / DOUBLE_MM, _HEIGHTS[row] / total)
        panels.append(figure.add_axes(box))
    return figure, panels


def _over_time(
    figure: Figure,
    axes: Axes,
    time: np.ndarray,
    signal: Signal,
    segments: xr.Dataset,
    friction: xr.Dataset | None,
) -> None:
    x, y = envelope(time, signal.values, _COLUMNS)
    axes.plot(x, y, color="black", linewidth=0.5, zorder=3)
    keep(figure, "time", "trace", **{column("time"): x, column(signal.name): y})
    axes.set_ylabel(_ylabel(signal.name))
    axes.set_xlim(time[0], time[-1] if time[-1] > time[0] else time[0] + 1)
    _room_above(axes, y)
    starts, stops = (np.asarray(segments[n], float) for n in ("start", "stop"))
    inner = [np.asarray(segments[n], float) for n in ("trimmed_start", "trimmed_stop")]
    directions = np.asarray(segments["direction"], int)
    _shade(axes, starts, stops, inner[0], inner[1], directions)
    speeds = np.asarray(segments["sliding_speed"], float)
    _speeds_above(axes, starts, stops, speeds)
    _means(axes, inner[0], inner[1], signal, friction, np.arange(starts.size), directions)


def _motion(
    figure: Figure,
    axes: Axes,
    time: np.ndarray,
    name: str,
    run: xr.Dataset,
    segments: xr.Dataset,
) -> None:
    x, y = envelope(time, np.asarray(run[name], float), _COLUMNS)
    axes.plot(x, y, color="black", linewidth=0.6, zorder=3)
    keep(figure, "motion", name, **{column("time"): x, column(name): y})
    axes.set_xlim(time[0], time[-1] if time[-1] > time[0] else time[0] + 1)
    words = {"sliding_velocity": "velocity", "set_speed": "set speed", "position": "position"}
    axes.set_ylabel(label(name, words[name]))
    if name != "position":
        _symlog(axes, y, np.asarray(segments["sliding_speed"], float))
    start, stop, inner_start, inner_stop = (
        np.asarray(segments[n], float) for n in ("start", "stop", "trimmed_start", "trimmed_stop")
    )
    directions = np.asarray(segments["direction"], int)
    _shade(axes, start, stop, inner_start, inner_stop, directions)


def _symlog(axes: Axes, values: np.ndarray, speeds: np.ndarray) -> None:
    """Scale logarithmically on both sides of zero, down to the slowest segment."""
    largest = np.nanmax(np.abs(values), initial=0.0)
    speeds = speeds[np.isfinite(speeds) & (speeds > 0)]
    if not largest > 0:
        return
    slowest = min(speeds.min() if speeds.size else largest / 100, largest)
    low = int(np.floor(np.log10(slowest) + 1e-9))
    high = max(low, int(np.ceil(np.log10(largest) - 0.1)))  # a little overshoot needs no decade
    axes.set_yscale("symlog", linthresh=10.0**low, linscale=0.8)
    step = max(1, -(-(high - low) // 2))
    # the lowest decade would stand on top of the zero
    decades = 10.0 ** np.arange(high, low - (step == 1), -step)
    both = np.nanmin(values, initial=0.0) < -(10.0**low)
    axes.yaxis.set_major_locator(FixedLocator(np.r_[-decades if both else [], 0.0, decades]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_ylim(-(10.0 ** (high + 0.4)) if both else -(10.0**low), 10.0 ** (high + 0.4))


def _over_distance(
    figure: Figure,
    axes: Axes,
    signal: Signal,
    parts: list[Stroke],
    friction: xr.Dataset | None,
) -> None:
    lengths = np.array([part.distance[-1] for part in parts])
    begins = np.r_[0.0, np.cumsum(lengths)[:-1]]
    budget = max(20, _COLUMNS // len(parts))
    name = "sliding_distance"
    lowest, highest = [], []
    for begin, part in zip(begins, parts, strict=True):
        x, y = envelope(part.distance, signal.values[part.samples], budget)
        axes.plot(begin + x, y, color="black", linewidth=0.5, zorder=3)
        numbers = {column(name): begin + x, column(signal.name): y}
        keep(figure, "distance", f"segment {part.number}", **numbers)
        lowest.append(np.nanmin(y, initial=np.inf))
        highest.append(np.nanmax(y, initial=-np.inf))
    axes.set_xlabel(r"sliding distance $s$ in the segments, one after the other (m)")
    axes.set_ylabel(_ylabel(signal.name))
    axes.set_xlim(0, max(begins[-1] + lengths[-1], np.finfo(float).tiny))
    _room_above(axes, np.array(lowest + highest))
    trimmed = np.array([part.trimmed for part in parts])
    inner = begins + trimmed[:, 0], begins + trimmed[:, 1]
    directions = np.array([part.direction for part in parts])
    _shade(axes, begins, begins + lengths, *inner, directions)
    _speeds_above(axes, begins, begins + lengths, np.array([part.speed for part in parts]))
    places = np.array([part.number for part in parts])
    _means(axes, *inner, signal, friction, places, directions)


def _ylabel(name: str) -> str:
    if name == "friction_coefficient":
        return "friction coefficient\n" + r"$\mu = F_x/F_{\mathrm{N}}$"
    return "friction force\n" + r"$F_x$ (N)"


def _room_above(axes: Axes, values: np.ndarray) -> None:
    """Leave room for the panel's letter and the speeds above the trace."""
    values = values[np.isfinite(values)]
    if values.size:
        low, high = values.min(), values.max()
        span = (high - low) or abs(high) or 1.0
        axes.set_ylim(low - 0.06 * span, high + 0.26 * span)


def _shade(
    axes: Axes,
    start: np.ndarray,
    stop: np.ndarray,
    inner_start: np.ndarray,
    inner_stop: np.ndarray,
    directions: np.ndarray,
) -> None:
    """Shade the segments: the part that counts dark, the trimmed ends light."""
    across = blended_transform_factory(axes.transData, axes.transAxes)
    signs = np.sign(np.asarray(directions, int))
    for sign in np.unique(signs):
        for bounds, alpha in (((start, stop), 0.07), ((inner_start, inner_stop), 0.11)):
            boxes = [
                Path([(a, 0), (a, 1), (b, 1), (b, 0), (a, 0)], closed=True)
                for a, b in zip(bounds[0][signs == sign], bounds[1][signs == sign], strict=True)
            ]
            patch = PathPatch(  # one patch for all boxes of a kind keeps the file small
                Path.make_compound_path(*boxes),
                facecolor=_SHADE[int(sign)],
                alpha=alpha,
                linewidth=0,
                transform=across,
                zorder=1,
            )
            axes.add_artist(patch)


def _speeds_above(axes: Axes, start: np.ndarray, stop: np.ndarray, speeds: np.ndarray) -> None:
    """Write the speed (or, if unknown, the number) over the segments that have room for it.

    Neighbours of one speed share the text.
    """
    low, high = axes.get_xlim()
    width = width_mm(axes)
    groups: list[tuple[float, float, float, str]] = []
    for number, (a, b, speed) in enumerate(zip(start, stop, speeds, strict=True)):
        if groups and np.isclose(groups[-1][2], speed, rtol=0.05):
            groups[-1] = (groups[-1][0], b, speed, groups[-1][3])
        else:
            text = speed_text(speed) if np.isfinite(speed) else f"no. {number + 1}"
            groups.append((a, b, speed, text))
    ends = [6.0, 0.0]  # mm up to which each of the two rows is taken; the letter stands in one
    for a, b, _, text in groups:
        need = len(text) * 1.35 + 2.0  # mm at 7 pt
        middle = (np.clip(a, low, high) + np.clip(b, low, high)) / 2
        at = (middle - low) / (high - low) * width
        room = (b - a) / (high - low) * width
        row = next((k for k in (0, 1) if at - need / 2 >= ends[k]), None)
        if room < 0.4 * need or row is None or at + need / 2 > width:
            continue
        ends[row] = at + need / 2
        axes.annotate(
            text,
            (middle, 1),
            xytext=(0, -4 - 8.5 * row),
            xycoords=axes.get_xaxis_transform(),
            textcoords="offset points",
            ha="center",
            va="top",
            fontsize=7,
            zorder=6,
        )


def _means(
    axes: Axes,
    start: np.ndarray,
    stop: np.ndarray,
    signal: Signal,
    friction: xr.Dataset | None,
    numbers: np.ndarray,
    directions: np.ndarray,
) -> None:
    """Draw the mean of each segment where the trace runs, i.e. with the sign of the stroke."""
    if friction is None or signal.name not in friction or not numbers.size:
        return
    mean = np.asarray(friction[signal.name], float)[numbers]
    if signal.name == "friction_coefficient":
        mean = mean * np.where(directions == 0, 1, directions)
    gap = np.full(mean.size, np.nan)
    x, y = np.c_[start, stop, gap].ravel(), np.c_[mean, mean, gap].ravel()
    axes.plot(x, y, color=MEAN, linewidth=1.0, zorder=4, scalex=False, scaley=False)


def _key(axes: Axes, parts: list[Stroke], means: bool, *, joined: bool) -> None:
    words = {1: "forward", -1: "backward", 0: "direction unknown"}
    seen = sorted({int(np.sign(part.direction)) for part in parts}, reverse=True)
    handles: list[Artist] = [
        Patch(color=_SHADE[d], alpha=0.18, linewidth=0, label=words[d]) for d in seen
    ]
    if parts:
        handles.append(Patch(color=NEUTRAL, alpha=0.07, linewidth=0, label="trimmed"))
    if means:
        handles.append(Line2D([], [], color=MEAN, linewidth=1.0, label="mean"))
    if joined:  # by name, so that a legend of the user's has them, too
        for handle in handles:
            if isinstance(handle, Patch):
                fill = PolyCollection([], facecolors=handle.get_facecolor(), linewidths=0)
                fill.set_label(str(handle.get_label()))
                axes.add_collection(fill)
            else:
                axes.add_artist(handle)
        name_all(axes)
    elif handles:
        axes.legend(
            handles=handles, loc="lower right", bbox_to_anchor=(1, 1.01), ncols=4, handlelength=1.4
        )
