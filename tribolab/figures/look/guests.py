"""Drawing in axes of the user, whose style and content are kept."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from numpy.typing import NDArray

from tribolab.core.errors import AnalysisError

# several axes: a list, or the array that `plt.subplots` returns
Panels = Sequence[Axes] | NDArray[np.object_]


def name_all(axes: Axes) -> None:
    """Add a legend to axes that lists each label once."""
    handles, texts = axes.get_legend_handles_labels()
    named = dict(zip(reversed(texts), reversed(handles), strict=True))
    if named:
        texts = list(dict.fromkeys(texts))
        axes.legend([named[text] for text in texts], texts)


def whole_figure(part: Axes | SubFigure) -> Figure:
    """Return the figure that contains axes or a subfigure."""
    figure = part.figure
    while isinstance(figure, SubFigure):
        figure = figure.figure
    if figure is None:
        raise AnalysisError("ax: these axes are in no figure any more")
    return figure


@contextlib.contextmanager
def guests(panels: Iterable[Axes]) -> Iterator[None]:
    """Context for drawing in axes of the user; afterwards, the axis limits fit old and new data."""
    before = [(ax, ax.has_data(), ax.get_xlim(), ax.get_ylim()) for ax in panels]
    yield
    for ax, had, old_x, old_y in before:
        x, y = ax.get_xlim(), ax.get_ylim()
        if had:
            ax.set_xlim(_merged_limits(x, old_x, ax.get_xscale()))
            ax.set_ylim(_merged_limits(y, old_y, ax.get_yscale()))
        ax.set_autoscale_on(True)


def _merged_limits(
    new: tuple[float, float], old: tuple[float, float], scale: str
) -> tuple[float, float]:
    """Return axis limits that include the old and the new ones; on a log axis, both positive."""
    ends = [end for end in old if scale != "log" or end > 0]
    return min([new[0], *ends]), max([new[1], *ends])
