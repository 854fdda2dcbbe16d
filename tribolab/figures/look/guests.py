"""Drawing in the user's own axes, whose style and content are kept."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from numpy.typing import NDArray

from tribolab.core.errors import AnalysisError

# several axes, as from `plt.subplots` or in a list
Panels = Sequence[Axes] | NDArray[np.object_]


def name_all(axes: Axes) -> None:
    """Make a legend of all labelled items in the axes, each label once."""
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
    """Draw into the user's axes: their limits are extended to new data, old data remain visible."""
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
    """Return limits that contain old and new ones; on a logarithmic axis only positive ones."""
    ends = [end for end in old if scale != "log" or end > 0]
    return min([new[0], *ends]), max([new[1], *ends])
