"""Description of a figure (axes, series, marks, texts), independent of the drawing program.

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
    """Axis of a panel: its label and unit, its scale, and its initial range.

    Parameters
    ----------
    label, unit
        Name of the quantity and the unit in which it is drawn.
    log
        Whether the scale is initially logarithmic.
    decades
        Number of decades initially visible below the highest value; 0 shows all.
    least
        Smallest possible value, at which error bars end.
    include
        Values always included in the initial range.
    view
        Fixed ends of the initial range.
    paper, column
        Label for papers, with the symbol as mathtext, and name of the column in `figure_data`; by
        default both follow from `label`.
    linear_below
        For an axis that is logarithmic on both sides of zero: value below which it is linear.
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
    """Return an axis for a quantity, by default with its long name and SI unit.

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
    """Panel of a figure: its two axes, title, relative height, and name in `figure_data`."""

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
        Text in the legend; a click on it shows or hides all series with this label.
    x, y
        Values in the units of the panel's axes; None or NaN if unknown.
    style
        For a "band", `y` is the lower edge and `high` the upper one; for "bars", `y` are
        names and `x` the lengths; for "heat", `high` are the colour values.
    colour
        Index of the colour in the palette.
    panel
        Index of the panel, from 0.
    surface, medium, load
        Conditions by which the page selects series; ``""`` and None fit every selection.
    error
        Half length of each error bar, in the unit of `y` (of `x` if `y` has names).
    error_below
        Half length of each error bar downward, if it differs from that upward.
    hover
        Tooltips: one text for each point, or one for all.
    runs
        Names of its runs; it is hidden if all of them are hidden.
    link
        Run that a click on a point opens; one for all points, or one for each.
    open
        Whether its markers are open, as for dry runs.
    joined
        Whether a thin line joins the points.
    shade
        Shade by load: negative is darker than the colour of the palette, positive lighter.
    marker
        Index of the marker; None takes the marker that belongs to the colour.
    sizes
        Area of each marker relative to the default.
    pale, thin
        Whether error bars are wide and pale (standard deviations); whether the line is thin.
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
    """Conditions of a `Series`, which several series have in common."""

    surface: str
    medium: str
    load: float | None
    runs: Sequence[str]
    open: bool


@dataclass(frozen=True)
class Mark:
    """Straight line across a panel at a value, or shaded interval from `value` to `until`.

    `text` is its entry in the legend; `above` is its label at the upper end (if it fits there).
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
    """Row of a table of key numbers, with the surface, medium and load that select it."""

    cells: tuple[str, ...]
    surface: str = ""
    medium: str = ""
    load: float | None = None


class KeyTable(NamedTuple):
    """Table of key numbers: column heads, and rows whose first cell is their name."""

    heads: tuple[str, ...]
    rows: tuple[KeyRow, ...]


@dataclass(frozen=True)
class FigureSpec:
    """Figure described independently of the program that draws it.

    Parameters
    ----------
    title, note, alt
        Title, explanation, and alternative text for screen readers.
    panels, series, marks, keys
        Content of the figure.
    id
        Anchor on the page, and name of its files.
    section
        Section of the page or view in which it appears.
    one_load
        Whether the page shows only one load at a time; the lowest is shown first.
    width
        Width on the page: a card, half or whole; on paper "whole" is 178 mm.
    height
        Height of its panel on the page [px]; 0 is the default.
    rows
        Whether the ordinate is a list of names, whose number determines the height.
    across
        Number of panels in a row on paper.
    numbers
        Key numbers to be shown with it, on the page and the terminal.
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
        """Loads [N] between which the reader can choose, lowest first; empty if all are shown."""
        if not self.one_load:
            return []
        return sorted({curve.load for curve in self.series if curve.load is not None})

    @property
    def surface(self) -> str:
        """Surface of all series; "" if they have several."""
        return only({curve.surface for curve in self.series})

    @property
    def medium(self) -> str:
        """Medium of all series; "" if they have several."""
        return only({curve.medium for curve in self.series})


def only(names: set[str]) -> str:
    """Return the only name of a set; "" if there are several or none."""
    return min(names) if len(names) == 1 else ""


def legend(series: Iterable[Series]) -> dict[str, Series]:
    """Return the series whose style the legend shows for each label; bands come last."""
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
    """Return a text with only the characters that are valid in anchors and file names.

    Examples
    --------
    >>> safe("Sb-R, glycerol")
    'sb-r_glycerol'
    """
    kept = "".join(c if c.isascii() and (c.isalnum() or c == "-") else " " for c in text.lower())
    return "_".join(kept.split()) or "unnamed"
