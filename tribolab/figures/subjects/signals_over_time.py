"""Figure of all recorded signals of a run against time."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, Cure
from tribolab.figures.colours import BLACK
from tribolab.figures.envelopes import envelope
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import FigureSpec, Panel, Series, axis_of

_COLUMNS = 420  # columns of a panel in which extremes of a signal are drawn
_FIRST = ("friction_force", "normal_force", "friction_coefficient", "sliding_velocity", "position")
_MAX_PANELS = 6


@plotted(panels=0)
def run(run: xr.Dataset) -> FigureSpec:
    """Draw the signals of a run against time as recorded, one panel each.

    Forces and motion come first; at most six signals are drawn.

    Parameters
    ----------
    run
        From `read` (time).

    Raises
    ------
    AnalysisError
        If there is no signal over time.

    Examples
    --------
    >>> import tribolab as tl
    >>> made = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> tl.plot.figure_data(tl.plot.run(made)).panel.unique().tolist()[0]
    'friction_coefficient'
    """
    numbers = [
        str(name)
        for name, signal in run.data_vars.items()
        if signal.dims == ("time",) and signal.dtype.kind in "fiu" and "_qc" not in str(name)
    ]
    if not numbers:
        raise AnalysisError(
            "there is no signal over time to draw",
            cure=Cure(notebook="give what tl.read returns; tl.variables(run) lists its signals"),
        )
    ordered = sorted(
        numbers, key=lambda name: _FIRST.index(name) if name in _FIRST else len(_FIRST)
    )
    shown = ordered[:_MAX_PANELS]
    time, left = np.asarray(run["time"], float), len(numbers) - len(shown)
    series = [
        Series("", *envelope(time, np.asarray(run[name], float), _COLUMNS), colour=BLACK,
               panel=panel, thin=True, name=name)
        for panel, name in enumerate(shown)
    ]  # fmt: skip
    return FigureSpec(
        title="Signals as recorded",
        note=f"{left} more signals are not drawn." if left else "",
        panels=tuple(Panel(axis_of("time", "time"), axis_of(name), name=name) for name in shown),
        series=tuple(series),
        across=1,
    )
