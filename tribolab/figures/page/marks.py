"""SVG of the parts of a static figure: markers, lines, bands and error bars."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from tribolab.figures.spec import Series, Style

PlacedPoint = tuple[float, float]
_HUES = 8  # number of palette colours, as in `assets/report.css`
_DASHES: dict[Style, str] = {
    "dashed": "6 4",
    "dotted": "2 3",
    "dashdot": "6 3 2 3",
    "longdash": "10 3",
}
_MARKER = 3.6  # half the width of a marker [px]
_MAX_DEVIATION = 0.3  # largest distance of a line from the original points [px]
_LEVELS = 5  # number of colours in a heat map
_LOW, _HIGH = 0.3, 3.0  # values at the ends of the colour scale, as in `assets/chart.js`
# number of corners of each marker (0 is a circle), and angle of the first [turns from the top]
_CORNERS = ((0, 0.0), (4, 0.125), (4, 0.0), (3, 0.0), (3, 0.5), (5, 0.0), (6, 0.25), (5, 0.0))


def hue(colour: int) -> str:
    """Return the CSS class of a palette colour."""
    return f"h{colour % _HUES}"


def coordinate(value: float) -> str:
    """Return a length [px] as text, rounded to a tenth.

    Examples
    --------
    >>> coordinate(12.0), coordinate(12.345)
    ('12', '12.3')
    """
    return f"{value:.1f}".removesuffix(".0")


def path(points: Iterable[PlacedPoint | None]) -> str:
    """Return an SVG path through points; None interrupts the line.

    Examples
    --------
    >>> path([(0, 0), (1, 2), None, (3, 4), (5, 6)])
    'M0 0L1 2M3 4L5 6'
    """
    text, pen = [], "M"
    for point in points:
        if point is None:
            pen = "M"
            continue
        text.append(f"{pen}{coordinate(point[0])} {coordinate(point[1])}")
        pen = "L"
    return "".join(text)


def straightened(points: Sequence[PlacedPoint | None]) -> Iterator[PlacedPoint | None]:
    """Yield the points of a line without those that make no visible difference.

    Examples
    --------
    >>> list(straightened([(0, 0), (1, 1), (2, 2.1), (3, 0), None, (5, 5)]))
    [(0, 0), (2, 2.1), (3, 0), None, (5, 5), None]
    """
    part: list[PlacedPoint] = []
    for point in [*points, None]:
        if point is not None:
            part.append(point)
        elif part:
            yield from _straight(part)
            yield None
            part = []


def _straight(part: Sequence[PlacedPoint]) -> Iterator[PlacedPoint]:
    """Yield the points of an uninterrupted line that the Ramer-Douglas-Peucker algorithm keeps."""
    x, y = np.array(part, float).T
    kept = {0, len(part) - 1}
    spans = [(0, len(part) - 1)]
    while spans:
        first, last = spans.pop()
        dx, dy = x[last] - x[first], y[last] - y[first]
        inner = slice(first + 1, last)
        off = np.abs(dx * (y[inner] - y[first]) - dy * (x[inner] - x[first]))
        off /= math.hypot(dx, dy) or 1.0
        if off.size and off.max() > _MAX_DEVIATION:
            middle = first + 1 + int(off.argmax())
            kept.add(middle)
            spans += [(first, middle), (middle, last)]
    yield from (part[k] for k in sorted(kept))


def markers(points: Sequence[PlacedPoint], marker: int, sizes: Iterable[float]) -> str:
    """Return an SVG path with a marker at each point; `sizes` are half widths [px]."""
    corners, turn = _CORNERS[marker % _HUES]
    return "".join(
        _marker(*at, size, corners, turn) for at, size in zip(points, sizes, strict=True)
    )


def _marker(x: float, y: float, size: float, corners: int, turn: float) -> str:
    if not corners:
        across = f"{coordinate(size)} {coordinate(size)} 0 1 0 {coordinate(2 * size)} 0"
        back = across.replace(f" {coordinate(2 * size)} 0", f" {coordinate(-2 * size)} 0")
        return f"M{coordinate(x - size)} {coordinate(y)}a{across}a{back}"
    angles = [2 * math.pi * (turn + k / corners) for k in range(corners)]
    reach = size * (1.15 if corners < 5 else 1.05)
    at = [(x + reach * math.sin(a), y - reach * math.cos(a)) for a in angles]
    return path(at) + "z"


def error_bars(
    bars: Iterable[tuple[float, float, float]], cap: float, *, lying: bool = False
) -> str:
    """Return an SVG path of vertical (horizontal if `lying`) error bars with caps; all in px."""
    parts = []
    for at, low, high in bars:
        lines = [[(at, low), (at, high)]]
        lines += [[(at - cap, end), (at + cap, end)] for end in (low, high)]
        parts += [path([(y, x) for x, y in line] if lying else line) for line in lines]
    return "".join(parts)


def drawn_points(
    points: Sequence[PlacedPoint], series: Series, bars: str = "", areas: Sequence[float] = ()
) -> Iterator[str]:
    """Yield the SVG of the error bars and markers of a series; `areas` scale the markers."""
    if bars:
        kind = "bar pale" if series.pale else "bar"
        yield f'<path class="{_hue(series)} {kind}" d="{bars}"/>'
    kind = "open" if series.open else "full"
    sizes = [_MARKER * math.sqrt(max(area or 0.0, 0.0)) for area in areas or [1.0] * len(points)]
    shape = markers(points, series.colour if series.marker is None else series.marker, sizes)
    yield f'<path class="{_hue(series)} {kind}" d="{shape}"/>'


def drawn_line(points: Sequence[PlacedPoint | None], series: Series) -> Iterator[str]:
    """Yield the SVG of the line of a series."""
    dash = _DASHES.get(series.style)
    look = f' stroke-dasharray="{dash}"' if dash else ""
    kind = "line thin" if series.thin else "line"
    yield f'<path class="{_hue(series)} {kind}"{look} d="{path(straightened(points))}"/>'


def _hue(series: Series) -> str:
    """Return the CSS classes for the colour and shade of a series (see `assets/still.css`)."""
    tenths = round(10 * series.shade)
    shade = f" {'dark' if tenths < 0 else 'pale'}{abs(tenths)}" if tenths else ""
    return hue(series.colour) + shade


def drawn_band(
    low: Sequence[PlacedPoint], high: Sequence[PlacedPoint], series: Series
) -> Iterator[str]:
    """Yield the SVG of the area between two lines."""
    if low and high:
        around = straightened([*low, *reversed(high)])
        yield f'<path class="{_hue(series)} band" d="{path(around)}z"/>'


def drawn_heat(points: Sequence[tuple[PlacedPoint, float]]) -> Iterator[str]:
    """Yield the SVG of a heat map: dots with a colour for each value."""
    by_level: dict[int, list[PlacedPoint]] = {}
    for point, value in points:
        share = (value - _LOW) / (_HIGH - _LOW)
        by_level.setdefault(min(max(int(share * _LEVELS), 0), _LEVELS - 1), []).append(point)
    for level, mine in sorted(by_level.items()):
        dots = "".join(f"M{coordinate(x)} {coordinate(y)}h0" for x, y in mine)
        yield f'<path class="l{level} dot" d="{dots}"/>'
