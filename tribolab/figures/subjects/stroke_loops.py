"""Figure of all strokes of a run: friction against distance, one panel per speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.core.wording import aligned, speed_text
from tribolab.figures.colours import BLACK, GREY, ORANGE, SKY
from tribolab.figures.envelopes import envelope
from tribolab.figures.plotted import plotted
from tribolab.figures.signals import Signal, Stroke, main_signal, strokes_of
from tribolab.figures.spec import Axis, FigureSpec, Mark, Panel, Series
from tribolab.figures.subjects.traces import MEAN, SHADES, Span, friction_axis

_LINES = {1: BLACK, -1: ORANGE, 0: SKY}
_MAX_PANELS, _MAX_LINES = 24, 6  # largest numbers of panels, and of lines per direction and panel
_POINTS = 1700  # total number of pixel columns, so that the file is smaller than 150 kB
_TOLERANCE = 0.05  # largest relative difference between speeds that count as equal
_Item = TypeVar("_Item")


@plotted(panels=0)
def strokes(
    run: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset | None = None
) -> FigureSpec:
    """Draw friction against distance along each stroke, one panel per speed, slowest first.

    A run that takes 1000 s at 1 um/s and 1 s at 1 cm/s cannot be judged on one time axis; here
    every speed has the same width. Forward and backward strokes overlap, both positive in their own
    direction; the trimmed ends are grey. Of many strokes at one speed only some are drawn, as the
    panel's title states.

    Parameters
    ----------
    run
        A run (time).
    segments
        Its segments (segment).
    friction
        Its friction result (segment), for the means and the offset to remove.

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
    groups = _grouped(parts)
    shown = _evenly(groups, _MAX_PANELS)
    budget = int(np.clip(_POINTS // sum(len(_chosen(group)) for group in shown), 30, 300))
    known = bool(np.isfinite([part.speed for part in parts]).all()) or "position" in run
    words = "distance / length" if known else "time / duration"
    x, y = (
        Axis(words, include=(0.0, 1.0), column="distance_over_length"),
        friction_axis(signal.name),
    )
    panels, series, marks = [], [], []
    for number, group in enumerate(shown):
        drawn, mean, ends = _strokes_of_speed(group, signal, friction, budget, number)
        series += drawn
        y = replace(y, view=_view(drawn, ends))
        name = speed_text(float(np.median([part.speed for part in group])))
        chosen = len(_chosen(group))
        title = name if chosen == len(group) else f"{name} ({chosen} of {len(group)})"
        panels.append(Panel(x, y, f"{title}{mean}", 0.55, name))
        marks += [
            Mark("x", low, high, "trimmed", colour=GREY, opacity=0.18, panel=number)
            for low, high in ((0.0, ends[0]), (ends[1], 1.0))
        ]
    across = min((4, 3), key=lambda n: -len(shown) % n) if len(shown) > 4 else len(shown)
    return FigureSpec(
        title="Strokes",
        panels=tuple(panels),
        series=tuple(series),
        marks=tuple(marks),
        width="whole",
        across=across,
    )


def _strokes_of_speed(
    group: list[Stroke], signal: Signal, friction: xr.Dataset | None, budget: int, panel: int
) -> tuple[list[Series], str, Span]:
    """Return the series at one speed, text on the mean, and the range between trimmed ends."""
    series, ends = [], []
    for part in _chosen(group):
        length = part.distance[-1] or 1.0
        sign = _sign(part, signal, friction)
        x, y = envelope(part.distance / length, sign * signal.values[part.samples], budget)
        direction = int(np.sign(part.direction))
        label = SHADES[direction][1]
        series.append(
            Series(label, x, y, colour=_LINES[direction], panel=panel, thin=True,
                   name=f"segment {part.number}")
        )  # fmt: skip
        inner = part.trimmed[0] / length, part.trimmed[1] / length
        ends.append(inner)
        if friction is not None and signal.name in friction:
            mean = float(friction[signal.name][part.number])
            mean = mean if signal.name == "friction_coefficient" else sign * mean
            series.append(Series("mean", inner, [mean, mean], colour=MEAN, panel=panel, columns={}))
    trimmed = np.array(ends)
    return series, _mean_text(group, signal, friction), (trimmed[:, 0].min(), trimmed[:, 1].max())


def _view(series: Sequence[Series], ends: Span) -> Span:
    """Return limits of the ordinate that fit the strokes between their trimmed ends."""
    inside = []
    for one in series:
        x, y = np.asarray(one.x, float), np.asarray(one.y, float)
        inside.append(y[(x >= ends[0]) & (x <= ends[1]) & np.isfinite(y)])
    values = np.concatenate(inside)
    if not values.size:
        return 0.0, 1.0
    low, high = float(values.min()), float(values.max())
    span = max(high - low, 0.02 * abs(high)) or 1.0
    return (low + high) / 2 - 0.65 * span, (low + high) / 2 + 0.65 * span


def _grouped(parts: list[Stroke]) -> list[list[Stroke]]:
    """Return strokes grouped by equal speed; those of unknown speed come last."""
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
    return [part for side in sides for part in _evenly(side, _MAX_LINES)]


def _sign(part: Stroke, signal: Signal, friction: xr.Dataset | None) -> float:
    """Return the sign that makes friction positive in both directions, even after rectification."""
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
    return f", µ = {aligned(float(np.nanmean(means)))}"
