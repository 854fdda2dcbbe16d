"""Description of a figure: axes with quantity and unit, series, marks and texts.

A function of this package turns results into a `FigureSpec`. `look.draw` draws it for publications
and notebooks, `page.still` for the page before its script runs, `assets/chart.js` on the live page.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypedDict

import numpy as np

from tribolab.figures.labels import column, plain_symbol, plain_unit, symbol
from tribolab.units.quantities import quantity

Style = Literal["points", "line", "dashed", "dotted", "dashdot", "longdash", "band", "bars", "heat"]
Width = Literal["card", "half", "whole"]
Values = Sequence[Any] | np.ndarray


@dataclass(frozen=True)
class Axis:
    """Axis of a panel: its quantity and unit, and its initial range.

    Parameters
    ----------
    label, unit
        Name of the quantity and the unit in which it is drawn.
    log
        Whether it is initially logarithmic.
    decades
        Decades initially visible below the highest value; 0 shows all.
    least
        Smallest possible value: error bars end there.
    include
        Values always included in the initial range.
    view
        Fixed ends of the initial range.
    paper, column
        Label for papers, with the symbol as mathtext, and name of the column in `figure_data`; by
        default both follow from `label`.
    linear_below
        Absolute value below which an axis with logarithmic scales on both sides of zero is linear.
    """

    label: str
    unit: str = ""
    log: bool = False
    decades: int = 0
    least: float | None = None
    include: tuple[float, ...] = ()
    view: tuple[float, float] | None = None
    paper: str = ""
    linear_below: float | None = None
    column: str = ""


def axis_of(name: str, words: str = "", unit: str = "", **more: Any) -> Axis:
    """Return the axis of a quantity, by default with its long name and SI unit.

    Examples
    --------
    >>> axis_of("sliding_speed", log=True).label, axis_of("pressure", unit="MPa").unit
    ('sliding speed v', 'MPa')
    """
    known = quantity(name)
    words = words or known.long_name
    paper = " ".join(filter(None, (words, symbol(name))))
    of_unit = column(name) if unit in ("", plain_unit(name)) else f"{name}_{unit}"
    label = f"{words} {plain_symbol(name)}".strip()
    return Axis(label, unit or plain_unit(name), paper=paper, column=of_unit, **more)


@dataclass(frozen=True)
class Panel:
    """Panel of a figure: two axes, a title, its relative height, and its name in `figure_data`."""

    x: Axis
    y: Axis
    title: str = ""
    height: float = 1.0
    name: str = ""


@dataclass(frozen=True)
class Series:
    """One curve, band or set of points in a panel.

    Parameters
    ----------
    label
        Text in the legend; series with the same label are switched together.
    x, y
        Values in the units of the panel's axes; None or NaN if unknown.
    style
        Style. For a "band", `y` is the lower edge and `high` the upper one; for "bars", `y` are
        names and `x` the lengths; for "heat", `high` are the colour values.
    colour
        Index in the palette: of the surface in comparisons, else by order of appearance.
    panel
        Number of the panel, from 0.
    surface, medium, load
        Labels for the choice of loads and the filters; ``""`` and None apply to all.
    error
        Half lengths of the error bars, in the unit of `y` (of `x` if `y` has names).
    error_below
        Half lengths downward if they differ from those upward.
    hover
        Tooltips: one text for each point, or one for all.
    runs
        Names of its runs: it is hidden if all of them are.
    link
        Run that a click on a point opens; one for all points, or one for each.
    open
        Whether its markers are open, as for dry runs.
    joined
        Whether a thin line joins the points.
    shade
        Darker (below 0) or lighter (above 0) than the colour of the palette: the rank of the load.
    marker
        Index of its marker; None for that of the colour.
    sizes
        Area of each marker relative to the default.
    pale, thin
        Wide pale error bars (for a standard deviation); thin line (for a long trace).
    columns, name
        Numbers and name for `figure_data`, by column with the unit in its name; by default the
        drawn values under the label.
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
    error_below: Values = ()
    hover: Sequence[str] = ()
    runs: Sequence[str] = ()
    link: Sequence[str] = ()
    open: bool = False
    joined: bool = False
    shade: float = 0.0
    marker: int | None = None
    sizes: Values = ()
    pale: bool = False
    thin: bool = False
    name: str = ""
    columns: Mapping[str, Values] | None = None


class SeriesLabels(TypedDict, total=False):
    """Fields of `Series` that several series have in common."""

    surface: str
    medium: str
    load: float | None
    runs: Sequence[str]
    open: bool


@dataclass(frozen=True)
class Mark:
    """Straight line across a panel at a value, or shaded interval from `value` to `until`.

    `text` is its entry in the legend; `above` is its label at the upper end, if there is room.
    """

    side: Literal["x", "y"]
    value: float
    until: float | None = None
    text: str = ""
    style: Style = "line"
    colour: int = 6
    opacity: float = 1.0
    panel: int = 0
    above: str = ""


@dataclass(frozen=True)
class Key:
    """Grey entry in the legend of a publication, which explains a style common to all surfaces."""

    label: str
    style: Style = "line"
    open: bool = False
    marker: bool = False
    colour: int = 6


class KeyRow(NamedTuple):
    """Row of texts, with the surface, medium and load by which it can be selected."""

    cells: tuple[str, ...]
    surface: str = ""
    medium: str = ""
    load: float | None = None


class KeyTable(NamedTuple):
    """Table of a figure: column heads, and rows that start with their name."""

    heads: tuple[str, ...]
    rows: tuple[KeyRow, ...]


@dataclass(frozen=True)
class FigureSpec:
    """Figure described independently of the program that draws it.

    Parameters
    ----------
    title, note, alt
        Title; explanation; and alternative text for screen readers.
    panels, series, marks, keys
        Content of the figure.
    id
        Anchor on the page, and name of its files.
    section
        Section of the page or view in which it appears.
    one_load
        Whether the page shows one load at a time, initially the lowest.
    width
        Width on the page: a card, half or whole; on paper "whole" is 178 mm.
    height
        Height of its panel on the page [px]; 0 is the default.
    rows
        Whether names are listed along the ordinate, which fixes its height.
    across
        Number of panels in a row on paper.
    numbers
        Its key numbers, for the page and the terminal.
    """

    id: str = ""
    section: str = ""
    title: str = ""
    note: str = ""
    alt: str = ""
    panels: tuple[Panel, ...] = ()
    series: tuple[Series, ...] = ()
    one_load: bool = False
    width: Width = "half"
    height: int = 0
    rows: bool = False
    across: int = 1
    marks: tuple[Mark, ...] = ()
    keys: tuple[Key, ...] = ()
    numbers: KeyTable | None = None

    @property
    def loads(self) -> list[float]:
        """Selectable loads, lowest first; empty if all loads are shown at once."""
        if not self.one_load:
            return []
        return sorted({curve.load for curve in self.series if curve.load is not None})

    @property
    def surface(self) -> str:
        """Surface that all series have in common; "" if there are several."""
        return only({curve.surface for curve in self.series})

    @property
    def medium(self) -> str:
        """Medium that all series have in common; "" if there are several."""
        return only({curve.medium for curve in self.series})


def only(names: set[str]) -> str:
    """Return the name if there is exactly one; otherwise ""."""
    return min(names) if len(names) == 1 else ""


def legend(series: Iterable[Series]) -> dict[str, Series]:
    """Return the series drawn in the legend for each label; lines and points precede bands."""
    named: dict[str, Series] = {}
    ranks = {"line": 0, "points": 0, "bars": 0, "heat": 0, "band": 2}
    for curve in series:
        known = named.get(curve.label)
        if not curve.label and curve.style == "band":
            continue
        if known is None or ranks.get(curve.style, 1) < ranks.get(known.style, 1):
            named[curve.label] = curve
    return dict(sorted(named.items(), key=lambda item: item[1].style == "band"))


def places(names: Iterable[str]) -> dict[str, int]:
    """Return the palette index of each name, in order of appearance.

    Examples
    --------
    >>> places(["Smooth", "Sb-R", "Smooth"])
    {'Smooth': 0, 'Sb-R': 1}
    """
    return {name: place for place, name in enumerate(dict.fromkeys(names))}


def safe(text: str) -> str:
    """Return a text in a form that is valid in anchors and file names.

    Examples
    --------
    >>> safe("Sb-R, glycerol")
    'sb-r_glycerol'
    """
    kept = "".join(c if c.isascii() and (c.isalnum() or c == "-") else " " for c in text.lower())
    return "_".join(kept.split()) or "unnamed"
