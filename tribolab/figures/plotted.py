"""Decorator that turns a function that describes a figure into one that draws it."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ParamSpec, Protocol, cast

from tribolab.figures.spec import FigureSpec

if TYPE_CHECKING:
    from matplotlib.figure import Figure

P = ParamSpec("P")
_PARAMETERS = """    title
        Text above the figure.
    {ax}
    width
        Of a new figure [mm]: 86 (one column) or 178 (two); 0 leaves it to the figure.

    Returns
    -------
    matplotlib.figure.Figure
        To be saved with `tribolab.plot.save` as SVG, PDF or PNG; `tribolab.plot.figure_data` gives
        its numbers."""
_ONE = """ax
        Axes to draw in, which keep their look; without them a figure is made. The legend includes
        what they show already; make it again after drawing more."""
_SEVERAL = """axes
        Axes to draw in, one for each panel; they keep their look. Without them a figure is made."""


class Plot(Protocol[P]):
    """Function that draws a figure with matplotlib; its attribute `spec` only describes it."""

    spec: Callable[P, FigureSpec]
    __name__: str

    def __call__(self, *args: Any, **kwargs: Any) -> Figure:
        """Draw the figure with matplotlib."""


def plotted(*, panels: int = 1) -> Callable[[Callable[P, FigureSpec]], Plot[P]]:
    """Return a decorator: a function that describes a figure becomes one that draws it.

    The drawing function has the parameters of the describing one, and `title`, `ax` (`axes` if
    there are several panels) and `width`.

    Examples
    --------
    >>> @plotted()
    ... def empty() -> FigureSpec:
    ...     '''Draw nothing.'''
    ...     return FigureSpec()
    >>> list(inspect.signature(empty).parameters), empty.spec().panels
    (['title', 'ax', 'width'], ())
    """
    axes_name = "ax" if panels == 1 else "axes"

    def decorate(describe: Callable[P, FigureSpec]) -> Plot[P]:
        @functools.wraps(describe)
        def plot(
            *args: Any, title: str = "", width: float = 0.0, ax: Any = None, axes: Any = None,
            **kwargs: Any,
        ) -> Figure:  # fmt: skip
            # imported late: a description does not need matplotlib
            from tribolab.figures.look.drawing import draw

            spec = describe(*args, **kwargs)
            return draw(spec, title=title, ax=ax if axes is None else axes, width=width)

        signature = inspect.signature(describe)
        added = {"title": "", axes_name: None, "width": 0.0}
        more = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default)
            for name, default in added.items()
        ]
        given = list(signature.parameters.values())
        last = [p for p in given if p.kind is inspect.Parameter.VAR_KEYWORD]
        own = [p for p in given if p.kind is not inspect.Parameter.VAR_KEYWORD]
        made = cast("Plot[P]", plot)
        made.spec = describe
        plot.__signature__ = signature.replace(  # type: ignore[attr-defined]
            parameters=[*own, *more, *last], return_annotation="Figure"
        )
        plot.__doc__ = _completed(describe.__doc__ or "", _ONE if panels == 1 else _SEVERAL)
        return made

    return decorate


def _completed(text: str, ax: str) -> str:
    """Return the docstring of a figure, completed by the parameters that all figures have."""
    common = _PARAMETERS.format(ax=ax)
    before, found, after = text.partition("\n\n    Notes\n")
    if not found:
        before, found, after = text.partition("\n\n    Raises\n")
    if not found:
        before, found, after = text.partition("\n\n    Examples\n")
    if "Parameters\n" not in before:
        before += "\n\n    Parameters\n    ----------"
    return f"{before}\n{common}{found}{after}"
