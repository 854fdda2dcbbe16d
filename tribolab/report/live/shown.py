"""A live figure as the page has it: its words, its data compressed, and a still picture."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tribolab.core.wording import force_text
from tribolab.figures.page.still import first_series, still
from tribolab.figures.spec import FigureSpec, legend, plain_data, written_labels
from tribolab.records.packed import deflated
from tribolab.records.runs.traces import script_json


@dataclass(frozen=True)
class ShownFigure:
    """A live figure as it stands in the page.

    Parameters
    ----------
    id, section, title, note, alt, height, rows
        As of `FigureSpec`.
    surface, medium
        What all of it is of; "" where there are several.
    loads
        In words, if one of them is chosen.
    panels, labels
        How many there are, which tell how much room it takes before it is drawn.
    packed
        What it shows, compressed, as text that may stand in a script element.
    still
        Its first view as SVG, which stands there until it is drawn.
    """

    id: str
    section: str
    title: str
    note: str
    alt: str
    height: int
    rows: bool
    surface: str
    medium: str
    loads: tuple[str, ...]
    panels: int
    labels: int
    packed: str
    still: str


def shown_figures(figures: Iterable[FigureSpec]) -> tuple[ShownFigure, ...]:
    """Return what the page has of figures; one without anything to show is left out."""
    return tuple(_shown(figure) for figure in figures if figure.series)


def _shown(figure: FigureSpec) -> ShownFigure:
    return ShownFigure(
        figure.id,
        figure.section,
        figure.title,
        figure.note,
        figure.alt,
        figure.height,
        figure.rows,
        figure.surface,
        figure.medium,
        tuple(map(force_text, figure.loads)),
        len(figure.panels),
        written_labels(figure, legend(first_series(figure))),
        deflated(script_json(plain_data(figure)).encode()),
        still(figure),
    )
