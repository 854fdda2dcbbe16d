"""Where a figure is drawn: in one of its own and in our look, or in axes that the user has."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from numpy.typing import NDArray

from tribolab.errors import AnalysisError
from tribolab.figures.labels import plain
from tribolab.figures.look.frame import legend_above
from tribolab.figures.look.style import SINGLE_MM, PaperFigure, new_figure, paper_style

# Several axes, as `plt.subplots` returns them or as a list.
Panels = Sequence[Axes] | NDArray[np.object_]


@contextlib.contextmanager
def one_panel(
    ax: Axes | None, title: str = "", *, left: float = 14
) -> Iterator[tuple[Figure, Axes]]:
    """Yield figure and axes of a one-column figure, and set its legend when all is drawn.

    Parameters
    ----------
    ax
        Axes of the user's, which keep the look of their figure: the legend takes in what is there
        already, and nothing that is there is cut off. None for a figure of our own.
    title
        Text above.
    left
        Margin of a figure of our own [mm].
    """
    if ax is None:
        with paper_style():
            own = new_figure(SINGLE_MM, 60.0)
            axes = own.add_subplot()
            yield own, axes
            legend_above(own, axes, title, left)
    else:
        with guests([ax]):
            yield whole_figure(ax), ax
        name_all(ax)
        name_panel(ax, title)


@contextlib.contextmanager
def several_panels(
    axes: Panels | None, wanted: Sequence[str], make: Callable[[], tuple[PaperFigure, list[Axes]]]
) -> Iterator[tuple[Figure, list[Axes]]]:
    """Yield figure and axes of a figure with several panels.

    Parameters
    ----------
    axes
        The user's, one for each panel; None for a figure of our own.
    wanted
        What each panel shows, in order.
    make
        Makes a figure of our own and its axes.

    Raises
    ------
    AnalysisError
        If there are more axes than panels, or fewer.
    """
    if axes is None:
        with paper_style():
            yield make()
        return
    given = [axes] if isinstance(axes, Axes) else list(np.ravel(np.asarray(axes, dtype=object)))
    if len(given) != len(wanted):
        raise AnalysisError(
            f"axes: {len(wanted)} {'is' if len(wanted) == 1 else 'are'} wanted, for "
            f"{', '.join(map(plain, wanted))}; got {len(given)}"
        )
    with guests(given):
        yield whole_figure(given[0]), given


def name_all(axes: Axes) -> None:
    """Set a legend with everything in the axes that has a name, each name once."""
    handles, texts = axes.get_legend_handles_labels()
    named = dict(zip(reversed(texts), reversed(handles), strict=True))
    if named:
        texts = list(dict.fromkeys(texts))
        axes.legend([named[text] for text in texts], texts)


def name_panel(axes: Axes, title: str) -> None:
    """Set the title of the user's axes, if there is one."""
    if title:
        axes.set_title(plain(title))


def width_mm(axes: Axes) -> float:
    """Return how wide axes are on paper [mm]."""
    return float(25.4 * axes.get_window_extent().width / whole_figure(axes).dpi)


def whole_figure(part: Axes | SubFigure) -> Figure:
    """Return the whole figure that axes, or a part of it, are in."""
    figure = part.figure
    while isinstance(figure, SubFigure):
        figure = figure.figure
    if figure is None:
        raise AnalysisError("ax: these axes are in no figure any more")
    return figure


@contextlib.contextmanager
def guests(panels: Iterable[Axes]) -> Iterator[None]:
    """Draw into the user's axes: what was in sight stays so, what comes later is brought so."""
    before = [(ax, ax.has_data(), ax.get_xlim(), ax.get_ylim()) for ax in panels]
    yield
    for ax, had, old_x, old_y in before:
        x, y = ax.get_xlim(), ax.get_ylim()
        if had:
            ax.set_xlim(_wider(x, old_x, ax.get_xscale()))
            ax.set_ylim(_wider(y, old_y, ax.get_yscale()))
        ax.set_autoscale_on(True)


def _wider(new: tuple[float, float], old: tuple[float, float], scale: str) -> tuple[float, float]:
    """Return limits that hold both; on a logarithmic axis only what is above zero."""
    ends = [end for end in old if scale != "log" or end > 0]
    return min([new[0], *ends]), max([new[1], *ends])
