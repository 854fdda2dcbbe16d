"""A figure on disk: the SVG, and beside it the numbers that it shows."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab import plot
from tribolab.records.part_records import FigureRecord
from tribolab.report import tables

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Drawn:
    """A figure, its caption, what it shows in words, and what the page groups it by."""

    figure: Figure
    caption: str
    alt: str
    kind: str


# Matplotlib's fonts are not made for several threads.
DRAWING = threading.Lock()


def save_figure(drawn: Drawn, folder: Path, file: str, *, pdf: bool = False) -> FigureRecord:
    """Write a figure and its numbers, and return its record for the report.

    Parameters
    ----------
    drawn
        From one of the functions of `tribolab.plot`, with its words.
    folder
        The results folder.
    file
        Path of the SVG relative to it; the numbers go to the same name with ``.csv``.
    pdf
        Whether it is written as PDF, too.
    """
    plot.save(drawn.figure, folder / file)
    if pdf:
        plot.save(drawn.figure, (folder / file).with_suffix(".pdf"))
    numbers, data = plot.figure_data(drawn.figure), ""
    if len(numbers):
        data = Path(file).with_suffix(".csv").as_posix()
        # nine digits: more than any eye or figure resolves
        tables.write_csv(numbers, folder / data, digits=9)
    return FigureRecord(file, data, drawn.caption, drawn.alt, drawn.kind)
