"""Initial range and ticks of an axis; the script `assets/chart.js` computes the same."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from tribolab.figures.spec import Axis, Panel, Series

_MARGIN = 0.06  # margin at each end of an axis, as share of the range of the data
_EQUAL_WITHIN = 1e-5  # values are equal if they differ by less: relative, or in decades if log
_LEAST_DECADES = 0.1  # smallest range of a logarithmic axis, in decades
_LOW_ENDS = (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9)  # low ends of log axes, times 10^n
_LEAST_SHARE = 0.02  # smallest range of a linear axis, as share of the largest value
_BELOW = 20  # error bars extend a log axis down to a point's value divided by this, no further


@dataclass(frozen=True)
class Scale:
    """Visible range of an axis, from `low` to `high`; on a log axis, both are decimal logarithms.

    `names` are the texts along a categorical axis, from below; empty for an axis of numbers.
    """

    low: float
    high: float
    log: bool = False
    names: tuple[str, ...] = ()

    def place(self, value: object) -> float | None:
        """Return the position of a value along the axis, 0 at its low end and 1 at its high end.

        None if the value is not a finite number, not positive on a log axis, or an unknown name.
        """
        if self.names:
            known = isinstance(value, str) and value in self.names
            return self._share(self.names.index(str(value))) if known else None
        if not isinstance(value, int | float) or not math.isfinite(value):
            return None
        if self.log:
            return self._share(math.log10(value)) if value > 0 else None
        return self._share(float(value))

    def _share(self, number: float) -> float:
        return (number - self.low) / (self.high - self.low)


def scales(panel: Panel, number: int, series: Sequence[Series]) -> tuple[Scale, Scale]:
    """Return the initial axis ranges of a panel, which contain all data except bands.

    Parameters
    ----------
    panel, number
        The panel, and its number in the figure.
    series
        Visible series of the figure.
    """
    mine = [curve for curve in series if curve.panel == number]
    x = _scale(panel.x, _x_values(mine, panel.x), level=False)
    names = dict.fromkeys(str(y) for curve in mine for y in curve.y if isinstance(y, str))
    if names:
        return x, Scale(-0.5, len(names) - 0.5, names=tuple(names))
    return x, _scale(panel.y, _y_values(mine, panel.y, x), level=True)


def comparable(panels: Sequence[tuple[Panel, Sequence[Series]]]) -> Panel:
    """Return a panel whose initial ranges contain the data of several one-panel figures."""
    alike = panels[0][0]
    along = [x for panel, series in panels for x in _x_values(series, panel.x)]
    x = replace(alike.x, include=_ends(along, alike.x))
    seen = _scale(x, iter(()), level=False)
    ends = _ends([y for p, series in panels for y in _y_values(series, p.y, seen)], alike.y)
    if ends and alike.y.log and ends[1] < 10 * ends[0]:  # so that a tick is below the data
        power = 10.0 ** math.floor(math.log10(ends[0]))
        ends = max(m * power for m in _LOW_ENDS if m * power <= ends[0]), ends[1]
    return Panel(x, replace(alike.y, include=ends))


def _ends(values: Sequence[float], axis: Axis) -> tuple[float, ...]:
    known = [v for v in values if math.isfinite(v) and (v > 0 or not axis.log)]
    return (min(known), max(known)) if known else ()


def _x_values(series: Iterable[Series], axis: Axis) -> Iterator[float]:
    for curve in series:
        if curve.style == "bars":
            yield from (0.8 * float(x) if axis.log else 0.0 for x in curve.x)
        if curve.style != "band":
            named = len(curve.y) and isinstance(curve.y[0], str)
            above, below = bar_lengths(curve) if named else ([0.0] * len(curve.x),) * 2
            for x, up, down in zip(curve.x, above, below, strict=True):
                if x is not None:
                    yield from (float(x), float(x) + up, float(x) - down)


def _y_values(series: Iterable[Series], axis: Axis, x: Scale) -> Iterator[float]:
    least = -math.inf if axis.least is None else axis.least
    for curve in series:
        if curve.style == "band":
            continue
        for at, y, above, below in zip(curve.x, curve.y, *bar_lengths(curve), strict=True):
            place = x.place(at)
            if y is None or place is None or not 0 <= place <= 1:
                continue
            ends = (max(y - below, least), y + above, float(y))
            yield from (end for end in ends if not axis.log or end >= y / _BELOW)


def bar_lengths(curve: Series) -> tuple[list[float], list[float]]:
    """Return the lengths of error bars upward and downward; 0 for points without an error."""
    above = [_known(e) for e in curve.error] if len(curve.error) else [0.0] * len(curve.y)
    below = [_known(e) for e in curve.error_below] if len(curve.error_below) else above
    return above, below


def _known(value: object) -> float:
    """Return the length of an error bar; 0 if it is unknown."""
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else 0.0


def _scale(axis: Axis, values: Iterator[float], *, level: bool) -> Scale:
    if axis.view is not None:
        low, high = (math.log10(end) if axis.log else end for end in axis.view)
        return Scale(low, high, axis.log)
    ends = _ends([*values, *axis.include], axis)
    if not ends:
        return Scale(0.0, 1.0, axis.log)
    low, high = ends
    if axis.log:
        low, high = math.log10(low), math.log10(high)
        if axis.decades:
            low = max(low, high - axis.decades)
    elif level and 0 < low < 0.6 * high:
        low = 0.0
    low, high = _widen(low, high, axis.log)
    room = (high - low) * _MARGIN
    return Scale(low if low == 0 and not axis.log else low - room, high + room, axis.log)


def _widen(low: float, high: float, log: bool) -> tuple[float, float]:
    """Return an axis range, widened if it is so narrow that it would show rounding errors."""
    largest = max(abs(low), abs(high))
    alone = high - low <= (_EQUAL_WITHIN if log else _EQUAL_WITHIN * largest)
    least = 0.6 if log else largest or 1.0
    if not alone:
        least = _LEAST_DECADES if log else _LEAST_SHARE * largest
    wider = max(0.0, (least - (high - low)) / 2)
    return low - wider, high + wider


def ticks(scale: Scale, most: int) -> list[tuple[float, float]]:
    """Return the ticks of a numeric axis: each value, and its position from 0 to 1.

    Examples
    --------
    >>> [value for value, _ in ticks(Scale(0, 2.2), 6)]
    [0.0, 0.5, 1.0, 1.5, 2.0]
    >>> [value for value, _ in ticks(Scale(-3.1, 0.2, True), 6)]
    [0.001, 0.01, 0.1, 1.0]
    >>> [value for value, _ in ticks(Scale(0.1, 0.8, True), 6)]
    [2.0, 5.0]
    >>> [value for value, _ in ticks(Scale(0.041, 0.07, True), 4)]
    [1.1, 1.12, 1.14, 1.16]
    """
    low, high = scale.low, scale.high
    values = _decades(low, high, most) if scale.log else _steps(low, high, most)
    return [(value, place) for value in values if (place := scale.place(value)) is not None]


def _decades(low: float, high: float, most: int) -> list[float]:
    first, last = math.ceil(low - 1e-9), math.floor(high + 1e-9)
    step = max(1, math.ceil((last - first + 1) / most))
    whole = [float(f"1e{k}") for k in range(last, first - 1, -step)][::-1]
    if len(whole) > 2:  # otherwise, values between the decades are labelled too
        return whole
    parts = (float(f"{m}e{k}") for k in range(first - 1, last + 1) for m in (1, 2, 5))
    seen = [value for value in parts if low <= math.log10(value) <= high]
    if len(seen) > 1:
        return seen if len(seen) <= most or len(whole) < 2 else whole
    return _steps(10.0**low, 10.0**high, most)


def _steps(low: float, high: float, most: int) -> list[float]:
    power = 10.0 ** math.floor(math.log10((high - low) / most))
    step = next(m * power for m in (1, 2, 5, 10, 20) if (high - low) / (m * power) <= most)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [float(f"{k * step:.10g}") for k in range(first, last + 1)]
