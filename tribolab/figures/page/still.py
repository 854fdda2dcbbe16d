"""Static picture (SVG) of an interactive figure, for print and until the script draws it.

It shows the initial view. Hence the first screen is complete immediately, and pages have figures if
they are printed early or scripts do not run. Colours are classes of `assets/still.css`, for light
and dark mode.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from markupsafe import escape

from tribolab.core.wording import MINUS, number
from tribolab.figures.axes import Scale, bar_lengths, scales, ticks
from tribolab.figures.envelopes import thinned
from tribolab.figures.page import marks
from tribolab.figures.page.marks import PlacedPoint, coordinate
from tribolab.figures.page.plain_data import plain_data, written_labels
from tribolab.figures.spec import Axis, FigureSpec, Mark, Series, Style, Width, legend

_WIDTHS: dict[Width, int] = {"card": 340, "half": 400, "whole": 680}  # width of a figure [px]
_HEIGHTS = (300, 430, 580)  # height of a figure with one, two and three panels [px]
_LETTER = 6.6  # mean width of a character [px]
_LINE = 18  # height of a legend row [px]
_TOP, _RIGHT, _BOTTOM = 8, 12, 42
_BETWEEN = 16  # distance between panels [px]
_MAX_POINTS = 240  # largest number of points of a line
_MAX_HEAT = 400  # largest number of points of a heat map


@dataclass(frozen=True)
class _Box:
    """Position of one panel [px], and the ranges of its axes."""

    left: float
    top: float
    width: float
    height: float
    x: Scale
    y: Scale

    def at(self, x: object, y: object) -> PlacedPoint | None:
        """Return the position of a point in the panel [px]; None if it cannot be drawn."""
        across, up = self.x.place(x), self.y.place(y)
        if across is None or up is None:
            return None
        return self.width * _clip(across), self.height * (1 - _clip(up))


def _clip(share: float) -> float:
    return min(max(share, -1.0), 2.0)


def still(figure: FigureSpec) -> str:
    """Return the initial view of a figure as SVG; a choice of loads starts at the lowest."""
    width = _WIDTHS[figure.width]
    series, seen = first_view(figure)
    labels = legend(series)
    written = written_labels(figure, labels)
    rows = math.ceil(written / _columns(width, labels)) if written > 1 else 0
    top = _TOP + rows * _LINE
    height = (figure.height or _HEIGHTS[len(figure.panels) - 1]) + rows * _LINE
    parts = list(_legend(labels, width)) if rows else []
    for place, box in enumerate(_boxes(seen, width, top, height)):
        parts += _panel(figure, place, box, series)
    body = "".join(parts)
    return (
        f'<svg class="still" viewBox="0 0 {width} {height}" height="{height}" '
        f'aria-hidden="true" focusable="false">{body}</svg>'
    )


def first_view(figure: FigureSpec) -> tuple[list[Series], list[tuple[Scale, Scale]]]:
    """Return the series of the initial view, and the ranges of both axes of each panel."""
    series = first_series(figure)
    seen = [scales(panel, place, series) for place, panel in enumerate(figure.panels)]
    if len(seen) > 1:  # panels in a column share their abscissa
        low, high = min(x.low for x, _ in seen), max(x.high for x, _ in seen)
        seen = [(replace(x, low=low, high=high), y) for x, y in seen]
    return series, seen


def first_series(figure: FigureSpec) -> list[Series]:
    """Return the series of the initial view, with their data as plain numbers."""
    shown = []
    for curve in figure.series:
        other = figure.one_load and curve.load is not None and curve.load != figure.loads[0]
        if not other:
            shown.append(replace(curve, x=plain_data(curve.x), y=plain_data(curve.y)))
    return shown


def _columns(width: int, labels: dict[str, Series]) -> int:
    longest = max(map(len, labels), default=1) * _LETTER + 30
    return max(1, min(len(labels), int((width - 10) / longest)))


def _legend(labels: dict[str, Series], width: int) -> Iterator[str]:
    columns = _columns(width, labels)
    for place, (label, curve) in enumerate(labels.items()):
        x, y = 10 + (place % columns) * (width - 10) / columns, 12 + place // columns * _LINE
        sample = replace(curve, style="points" if curve.style in ("bars", "heat") else curve.style)
        if sample.style == "points":
            yield from marks.drawn_points([(x + 9, y - 4)], sample, "")
        elif sample.style == "band":
            edges = [(x, y - 9), (x + 18, y - 9)], [(x, y + 1), (x + 18, y + 1)]
            yield from marks.drawn_band(*edges, sample)
        else:
            yield from marks.drawn_line([(x, y - 4), (x + 18, y - 4)], sample)
        yield _text(x + 23, y, label)


def _boxes(
    seen: Sequence[tuple[Scale, Scale]], width: int, top: float, height: float
) -> list[_Box]:
    """Return the positions of panels below each other, with room for labels on the left."""
    names = max((len(name) for _, y in seen for name in y.names), default=0)
    left = min(names * _LETTER + 12, 0.45 * width) if names else 58
    count = len(seen)
    each = (height - top - _BOTTOM - _BETWEEN * (count - 1)) / count
    return [
        _Box(left, top + place * (each + _BETWEEN), width - left - _RIGHT, each, x, y)
        for place, (x, y) in enumerate(seen)
    ]


def _panel(figure: FigureSpec, place: int, box: _Box, series: Sequence[Series]) -> Iterator[str]:
    panel = figure.panels[place]
    last = place == len(figure.panels) - 1
    yield from _x_ticks(box, panel.x, shown=last)
    yield from _names(box) if box.y.names else _y_ticks(box, panel.y)
    sides = ("x", box.left), ("y", box.top), ("width", box.width), ("height", box.height)
    size = " ".join(f'{name}="{coordinate(value)}"' for name, value in sides)
    yield f"<svg {size}>"
    yield from (_line(mark, box) for mark in figure.marks if mark.panel == place)
    mine = [curve for curve in series if curve.panel == place]
    bars = [curve for curve in mine if curve.style == "bars"]
    for curve in sorted(mine, key=lambda curve: curve.style != "band"):
        if curve.style == "bars":
            yield from _rows(curve, box, bars)
        else:
            yield from _drawn(curve, box, panel.y)
    yield "</svg>"
    yield f'<path class="axis" d="{_corner(box)}"/>'


def _line(mark: Mark, box: _Box) -> str:
    """Return the SVG of a straight line across a panel, or of a shaded interval."""
    scale, size = (box.x, box.width) if mark.side == "x" else (box.y, box.height)
    ends = [scale.place(value) for value in (mark.value, mark.until) if value is not None]
    at = [size * (_clip(e) if mark.side == "x" else 1 - _clip(e)) for e in ends if e is not None]
    hue, low, high = marks.hue(mark.colour), min(at, default=-1.0), max(at, default=-1.0)
    if mark.until is not None and len(at) == 2:
        place = {"x": low, "y": 0.0, "width": high - low, "height": box.height}
        if mark.side == "y":
            place = {"x": 0.0, "y": low, "width": box.width, "height": high - low}
        sides = " ".join(f'{name}="{coordinate(value)}"' for name, value in place.items())
        return f'<rect class="{hue} full" opacity="{mark.opacity:g}" {sides}/>'
    across = [(low, 0.0), (low, box.height)]
    across = across if mark.side == "x" else [(0.0, low), (box.width, low)]
    line = Series("", (), (), mark.style, mark.colour, thin=True)
    return "".join(marks.drawn_line(list(across), line))


def _corner(box: _Box) -> str:
    bottom = box.top + box.height
    return marks.path([(box.left, box.top), (box.left, bottom), (box.left + box.width, bottom)])


def _drawn(curve: Series, box: _Box, axis: Axis) -> Iterator[str]:
    if curve.style == "points":
        at = [box.at(x, y) for x, y in zip(curve.x, curve.y, strict=True)]
        bars = marks.error_bars(_bars(curve, box, axis), 3, lying=bool(box.y.names))
        if curve.joined:
            dash: Style = "dashed" if curve.open else "line"
            yield from marks.drawn_line(at, replace(curve, style=dash, thin=True))
        sizes = curve.sizes if len(curve.sizes) else [1.0] * len(at)
        shown = [(point, size) for point, size in zip(at, sizes, strict=True) if point]
        yield from marks.drawn_points([p for p, _ in shown], curve, bars, [s for _, s in shown])
    elif curve.style == "band":
        lower = [box.at(x, _band_edge(y, box)) for x, y in zip(curve.x, curve.y, strict=True)]
        upper = [box.at(x, y) for x, y in zip(curve.x, curve.high, strict=True)]
        yield from marks.drawn_band([p for p in lower if p], [p for p in upper if p], curve)
    elif curve.style == "heat":
        kept = thinned(len(curve.x), _MAX_HEAT)
        levels = [(box.at(curve.x[k], curve.y[k]), float(curve.high[k])) for k in kept]
        yield from marks.drawn_heat([(at, value) for at, value in levels if at])
    else:
        kept = thinned(len(curve.x), _MAX_POINTS)
        yield from marks.drawn_line([box.at(curve.x[k], curve.y[k]) for k in kept], curve)


def _band_edge(value: Any, box: _Box) -> Any:
    """Return the lower edge of a band; on a log axis, a value <= 0 is moved out of view."""
    if box.y.log and value is not None and not value > 0:
        return 10.0 ** (box.y.low - (box.y.high - box.y.low))
    return value


def _bars(curve: Series, box: _Box, axis: Axis) -> Iterator[tuple[float, float, float]]:
    least = -math.inf if axis.least is None else axis.least
    for x, y, above, below in zip(curve.x, curve.y, *bar_lengths(curve), strict=True):
        middle = box.at(x, y)
        if middle is None or not above > 0:
            continue
        if isinstance(y, str):
            ends = box.at(x - below, y), box.at(x + above, y)
            yield from ((middle[1], ends[0][0], ends[1][0]) for _ in (1,) if ends[0] and ends[1])
            continue
        high = box.at(x, y + above)
        low = box.at(x, _band_edge(max(y - below, least), box))
        if low is not None and high is not None:
            yield middle[0], low[1], high[1]


def _rows(curve: Series, box: _Box, every: Sequence[Series]) -> Iterator[str]:
    """Yield the SVG of the bars of a series; series with equal names share the rows."""
    every = [one for one in every if set(one.y) & set(curve.y)]
    thick = 0.8 * box.height / len(box.y.names) / len(every)
    below = next(k for k, other in enumerate(every) if other is curve) - 0.5 * len(every)
    for x, y in zip(curve.x, curve.y, strict=True):
        end = box.at(x, y)
        if end is not None and end[0] > 0:
            top = coordinate(end[1] - (below + 1) * thick)
            yield (
                f'<rect class="{marks.hue(curve.colour)} full" x="0" y="{top}" '
                f'width="{coordinate(end[0])}" height="{coordinate(thick)}"/>'
            )


def _x_ticks(box: _Box, axis: Axis, *, shown: bool) -> Iterator[str]:
    bottom = box.top + box.height
    for value, place in ticks(box.x, max(2, int(box.width / 70))):
        x = box.left + place * box.width
        yield f'<path class="grid" d="{marks.path([(x, box.top), (x, bottom)])}"/>'
        if shown:
            yield _text(x, bottom + 15, _tick(value, box.x.log, axis.unit), "middle")
    if shown:
        yield _text(box.left + box.width / 2, bottom + 34, _named(axis), "middle")


def _y_ticks(box: _Box, axis: Axis) -> Iterator[str]:
    for value, place in ticks(box.y, max(2, int(box.height / 40))):
        y = box.top + box.height * (1 - place)
        yield f'<path class="grid" d="{marks.path([(box.left, y), (box.left + box.width, y)])}"/>'
        yield _text(box.left - 6, y + 4, _tick(value, box.y.log, axis.unit), "end")
    middle = coordinate(box.top + box.height / 2)
    turned = f'transform="translate(13 {middle}) rotate(-90)" text-anchor="middle"'
    yield f"<text {turned}>{escape(_named(axis))}</text>"


def _names(box: _Box) -> Iterator[str]:
    most = max(4, int((box.left - 8) / (0.9 * _LETTER)))
    for name in box.y.names:
        y = box.top + box.height * (1 - (box.y.place(name) or 0.0))
        text = name if len(name) <= most else name[: most - 1].rstrip() + "…"
        yield _text(box.left - 6, y + 4, text, "end")


def _named(axis: Axis) -> str:
    return f"{axis.label} ({axis.unit})" if axis.unit else axis.label


def _tick(value: float, log: bool, unit: str) -> str:
    """Return a tick label as in the interactive figure; with a unit, decades are powers of ten."""
    text = number(value, 6)
    power = math.log10(value) if log else 0.0
    if not (log and unit or "e" in text) or power != round(power) or power in (0, 1):
        return text
    return "10" + str(round(power)).replace("-", MINUS).translate(_RAISED)


_RAISED = str.maketrans(f"{MINUS}0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _text(x: float, y: float, words: str, anchor: str = "") -> str:
    where = f' text-anchor="{anchor}"' if anchor else ""
    return f'<text x="{coordinate(x)}" y="{coordinate(y)}"{where}>{escape(words)}</text>'
