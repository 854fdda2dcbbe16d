"""Interactive controls for a figure in a notebook."""

from __future__ import annotations

import inspect
import io
import sys
from collections.abc import Callable
from typing import Any, TypeVar

from matplotlib.figure import Figure

from tribolab.core.untyped import Arguments
from tribolab.figures.look.style import PaperFigure

Draw = TypeVar("Draw", bound=Callable[..., Figure])
_FINE = 2  # pixels of the picture per pixel of the screen


def knobs(**ranges: Any) -> Callable[[Draw], Draw]:
    """Return a decorator that shows a figure in a notebook with a control for each parameter.

    The picture is an ordinary output of the cell, drawn again after each change. Unlike with
    `ipywidgets.interact`, it remains in a saved or exported notebook, with the last settings.

    Parameters
    ----------
    **ranges
        Ranges by name of the parameter, as for `ipywidgets.interact`: ``(lowest, highest, step)``,
        a list to choose from, or a widget. Controls start at the parameters' defaults.

    Returns
    -------
    callable
        Decorator of a function that returns a figure of matplotlib or `tribolab.plot`.

    Examples
    --------
    In a notebook:

    >>> from tribolab import plot
    >>> import xarray as xr
    >>> @plot.knobs(level=(0.1, 1.0, 0.1))  # doctest: +SKIP
    ... def draw(level=0.5):
    ...     mu = xr.Dataset(
    ...         {"friction_coefficient": ("sliding_speed", [level])}, {"sliding_speed": [1e-3]}
    ...     )
    ...     return plot.stribeck(mu)
    >>> plot.knobs().__name__
    'show'
    """

    def show(draw: Draw) -> Draw:
        # imported late: IPython loads slowly
        from IPython.display import Markdown, display, update_display

        defaults = {
            name: parameter.default
            for name, parameter in inspect.signature(draw).parameters.items()
            if parameter.default is not inspect.Parameter.empty
        }
        try:
            controls = _controls(ranges, defaults)
        except ImportError:
            controls = {}
            display(Markdown("*The knobs want ipywidgets: `pip install 'tribolab[lab]'`*"))

        def values() -> Arguments:
            return {name: control.value for name, control in controls.items()}

        def redraw(change: object) -> None:
            data, metadata = _picture(draw(**values()))
            update_display(data, metadata=metadata, raw=True, display_id=place)

        place = f"tribolab-knobs-{id(redraw):x}"
        if controls:
            display(_box(controls), raw=True)
        data, metadata = _picture(draw(**values()))
        display(data, metadata=metadata, raw=True, display_id=place)
        for control in controls.values():
            control.observe(redraw, "value")
        return draw

    return show


def _controls(ranges: Arguments, defaults: Arguments) -> Arguments:
    """Return a widget for each parameter, set to the default of the parameter."""
    # imported late: ipywidgets loads slowly
    from ipywidgets import interactive

    controls = {}
    for name, given in ranges.items():
        default = defaults.get(name, inspect.Parameter.empty)
        control = interactive.widget_from_abbrev(given, default)
        control.description = control.description or name.replace("_", " ")
        if hasattr(control, "continuous_update"):
            control.continuous_update = False  # draw only when the control is released
        control.style.description_width = "initial"
        controls[name] = control
    return controls


def _box(controls: Arguments) -> Arguments:
    """Return the controls as notebook output, with a text for notebooks without a kernel."""
    # imported late: ipywidgets loads slowly
    from ipywidgets import VBox

    places = ", ".join(f"{c.description} = {c.value}" for c in controls.values())
    shown = VBox(list(controls.values()))._repr_mimebundle_() or {}
    return {**shown, "text/plain": f"to be turned in a running notebook: {places}"}


def _picture(figure: Figure) -> tuple[dict[str, bytes], Arguments]:
    """Return a figure as PNG with the width for display, and close it in pyplot."""
    if isinstance(figure, PaperFigure):
        return {"image/png": figure._repr_png_()}, {}
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=_FINE * 100)
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close(figure)
    width = round(100 * figure.get_figwidth())
    return {"image/png": buffer.getvalue()}, {"image/png": {"width": width}}
