"""Interactive figure as the page contains it: texts, compressed data, and a static picture."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tribolab.core.wording import force_text
from tribolab.figures.page.plain_data import plain_data, written_labels
from tribolab.figures.page.still import first_series, still
from tribolab.figures.spec import FigureSpec, KeyTable, legend
from tribolab.records.packed import deflated
from tribolab.records.runs.traces import script_json


@dataclass(frozen=True)
class ShownFigure:
    """Interactive figure as the page contains it.

    Parameters
    ----------
    id, section, title, note, alt, height, rows
        As in `FigureSpec`.
    surface, medium
        Surface and medium of all series; "" if there are several.
    loads
        Selectable loads in words.
    panels, labels
        Numbers of panels and legend entries, which determine the size before drawing.
    packed
        Compressed data as text that is valid in a script element.
    still
        Initial view as SVG, shown until the figure is drawn.
    numbers
        Key numbers to show below it.
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
    numbers: KeyTable | None


def shown_figures(figures: Iterable[FigureSpec]) -> tuple[ShownFigure, ...]:
    """Return the figures in the form that the page contains; figures without data are left out."""
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
        figure.numbers,
    )
