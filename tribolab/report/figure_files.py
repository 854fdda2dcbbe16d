"""A figure on disk: the SVG, and beside it the numbers that it shows."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.report import tables

if TYPE_CHECKING:
    from matplotlib.figure import Figure


# Matplotlib's fonts and the netCDF library are not made for several threads.
DRAWING = threading.Lock()


def save_figure(figure: Figure, folder: Path, file: str, caption: str, alt: str) -> dict[str, str]:
    """Write a figure and its numbers, and return its record for the report.

    Parameters
    ----------
    figure
        From one of the functions of `tribolab.plot`.
    folder
        The results folder.
    file
        Path of the SVG relative to it; the numbers go to the same name with ``.csv``.
    caption
        What stands below it.
    alt
        What it shows, in words and numbers, for who does not see it.

    Returns
    -------
    dict
        ``file``, ``data`` (empty if the figure keeps no numbers), ``caption`` and ``alt``.
    """
    from tribolab import plot

    plot.save(figure, folder / file)
    numbers, data = plot.figure_data(figure), ""
    if len(numbers):
        data = str(Path(file).with_suffix(".csv").as_posix())
        # nine digits: more than any eye or figure resolves
        tables.write(numbers, folder / data, digits=9)
    return {"file": file, "data": data, "caption": caption, "alt": alt}
