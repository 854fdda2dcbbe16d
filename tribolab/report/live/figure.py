"""What a live figure is: panels, series and words, small enough to stand inside the page.

`assets/chart.js` draws all of them (and `still` before it), so a figure says what it shows and
nothing of how.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, Literal, TypedDict

import numpy as np

Style = Literal["points", "line", "dashed", "dotted", "dashdot", "band", "bars", "heat"]
Width = Literal["card", "half", "whole"]
Values = Sequence[Any] | np.ndarray
_MOST_LABELS = 8  # in the legend of a card, as in `assets/picture.js`
_DIGITS = 6  # more than any screen resolves


@dataclass(frozen=True)
class Axis:
    """What is drawn along one side: its name, its unit, whether logarithmic at first.

    Of `decades` so many below the highest value are seen at first; 0 is all of them. Error bars end
    at `least`, below which no value can lie. Of axes that are to be compared, `also` has values
    that all of them show at first.
    """

    label: str
    unit: str = ""
    log: bool = False
    decades: int = 0
    least: float | None = None
    also: tuple[float, ...] = ()


@dataclass(frozen=True)
class Panel:
    """One pair of axes; panels of a figure stand below each other."""

    x: Axis
    y: Axis


@dataclass(frozen=True)
class Series:
    """One curve, band or set of points.

    Parameters
    ----------
    label
        In the legend; series with the same label are switched together.
    x, y
        In the units of the panel's axes; where nothing is known, None.
    style
        How it is drawn. Of a "band" `y` is the lower edge, `high` the upper one; of "bars" `y`
        has names and `x` the lower, `high` the upper end; of "heat" `high` has the colours.
    colour
        Place in the palette: that of the surface in comparisons, else in the order of appearance.
    panel
        Number of the panel, from 0.
    surface, medium, load
        What it is of, for the choice of loads and the filters; ``""`` and None are of all.
    error
        Half lengths of the error bars, as `y`.
    told
        What the pointer reads: a text for each point, or one for all of them.
    runs
        Names of the runs in it: it goes when all of them are hidden.
    goes_to
        The run that a click on each point leads to; one for all of them, or one for each.
    open
        Whether its markers are open, as those of dry runs are.
    """

    label: str
    x: Values
    y: Values
    style: Style = "line"
    colour: int = 0
    panel: int = 0
    high: Values = ()
    surface: str = ""
    medium: str = ""
    load: float | None = None
    error: Values = ()
    told: Sequence[str] = ()
    runs: Sequence[str] = ()
    goes_to: Sequence[str] = ()
    open: bool = False


class SeriesLabels(TypedDict, total=False):
    """What several series are of: fields of `Series`."""

    surface: str
    medium: str
    load: float | None
    runs: Sequence[str]
    open: bool


@dataclass(frozen=True)
class LiveFigure:
    """A figure that the page draws.

    Parameters
    ----------
    id
        Its address on the page, and the name of its downloads.
    section
        Section of the page, or card of the answer, that it belongs to.
    title, note, alt
        What stands above and below it, and what it shows in words for who does not see it.
    panels, series
        What is drawn.
    one_load
        Whether one load is shown at a time, the lowest at first; else all may be seen together.
    width
        Whether it stands in a card, is one of two beside each other, or has the whole width.
    height
        Of its panel [px]; 0 is as usual.
    rows
        Whether names stand below each other, so that it cannot be made lower.
    """

    id: str
    section: str
    title: str
    note: str
    alt: str
    panels: tuple[Panel, ...]
    series: tuple[Series, ...]
    one_load: bool = False
    width: Width = "half"
    height: int = 0
    rows: bool = False

    @property
    def loads(self) -> list[float]:
        """Loads among which one is chosen, the lowest first; none where all are shown at once."""
        if not self.one_load:
            return []
        return sorted({curve.load for curve in self.series if curve.load is not None})

    @property
    def surface(self) -> str:
        """Surface that all of it is of; "" where there are several."""
        return only({curve.surface for curve in self.series})

    @property
    def medium(self) -> str:
        """Medium that all of it is of; "" where there are several."""
        return only({curve.medium for curve in self.series})


def only(names: set[str]) -> str:
    """Return the name that there is; "" where there are several."""
    return min(names) if len(names) == 1 else ""


def written_labels(figure: LiveFigure, labels: Collection[str]) -> int:
    """Return how many labels the legend shows: a card has no room for many, points say theirs."""
    return 0 if figure.width == "card" and len(labels) > _MOST_LABELS else len(labels)


def legend(series: Iterable[Series]) -> dict[str, Series]:
    """Return what stands in a legend: a band where it has a name that no line or point has."""
    named: dict[str, Series] = {}
    for curve in sorted(series, key=lambda curve: curve.style == "band"):
        if curve.label or curve.style != "band":
            named.setdefault(curve.label, curve)
    return named


def plain_data(value: Any) -> Any:
    """Return a figure as plain data, without what is as usual and with the digits that are seen."""
    if is_dataclass(value) and not isinstance(value, type):
        values = {field.name: getattr(value, field.name) for field in fields(value)}
        usual = {field.name: field.default for field in fields(value)}
        return {
            name: plain_data(item)
            for name, item in values.items()
            if item is not usual[name] and not (isinstance(item, str | tuple | list) and not item)
        }
    if isinstance(value, np.ndarray):
        return plain_data(value.tolist())
    if isinstance(value, list | tuple):
        return [_seen(item) if type(item) is float else plain_data(item) for item in value]
    if isinstance(value, np.generic):
        return plain_data(value.item())
    return _seen(value) if isinstance(value, float) else value


def _seen(value: float) -> float | None:
    return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else None


def thinned(count: int, most: int = 400) -> np.ndarray:
    """Return which of so many points of a smooth curve are kept, both ends among them.

    Examples
    --------
    >>> thinned(5).tolist(), thinned(1000, 5).tolist()
    ([0, 1, 2, 3, 4], [0, 250, 500, 749, 999])
    """
    if count <= most:
        return np.arange(count)
    return np.round(np.linspace(0, count - 1, most)).astype(int)


def places(names: Iterable[str]) -> dict[str, int]:
    """Return the place of each name in the palette, in the order of appearance.

    Examples
    --------
    >>> places(["Smooth", "Sb-R", "Smooth"])
    {'Smooth': 0, 'Sb-R': 1}
    """
    return {name: place for place, name in enumerate(dict.fromkeys(names))}


def safe(text: str) -> str:
    """Return text as a part of an address or a file's name.

    Examples
    --------
    >>> safe("Sb-R, glycerol")
    'sb-r_glycerol'
    """
    kept = "".join(c if c.isascii() and (c.isalnum() or c == "-") else " " for c in text.lower())
    return "_".join(kept.split()) or "unnamed"
