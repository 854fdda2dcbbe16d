"""Figures of the scatter of friction: half loops of stroke pairs, and lengths of error bars."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.core.untyped import Arguments
from tribolab.figures.colours import BLACK
from tribolab.figures.error_bars import error_bar
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Mark, Panel, Series, axis_of
from tribolab.figures.subjects.curves import SPEED_AXIS, curve_looks


@plotted()
def half_loop(friction: xr.Dataset) -> FigureSpec:
    """Draw the half loop of each pair of strokes: the friction force without its offset.

    One point for each pair, in the order of the run; the line is their mean.

    Parameters
    ----------
    friction
        A friction result (segment) with `half_loop` and `pair`.

    Raises
    ------
    AnalysisError
        If no stroke has a partner.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4, 1e-3)))
    >>> run = rig.simulate_run("Sb-S", "dry", rig=short).noise_free
    >>> segments = tl.find_segments(run)
    >>> friction = tl.friction_coefficient(run, segments)
    >>> tl.plot.figure_data(half_loop(friction)).half_loop_N.round(1).tolist()
    [59.2, 60.1]
    """
    if "half_loop" not in friction or "pair" not in friction:
        raise AnalysisError("the friction result has no 'half_loop' and 'pair', so no pairs")
    pair = np.asarray(friction["pair"], int)
    loop = np.asarray(friction["half_loop"], float)
    numbers, first = np.unique(np.where(np.isfinite(loop), pair, -1), return_index=True)
    first = first[numbers >= 0]
    if not first.size:
        raise AnalysisError("no stroke of this run has a partner, so there is no half loop to draw")
    x, y = pair[first] + 1, loop[first]
    span = 1.2 * (max(np.ptp(y), 0.1 * abs(y.mean())) or 1.0)
    axis = axis_of("half_loop", "half loop", include=(y.mean() - span, y.mean() + span))
    return FigureSpec(
        title="Half loop of each pair of strokes",
        panels=(Panel(Axis("pair of strokes", column="pair"), axis, name="half loop"),),
        series=(Series("half loop", x, y, "points", BLACK, name="pairs"),),
        marks=(Mark("y", float(y.mean())),),
    )


@plotted(panels=2)
def friction_spread(
    measured: xr.Dataset | Sequence[xr.Dataset], *, surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw friction with error bars against speed, and below it the lengths of these bars.

    Above: bars of one standard deviation while sliding, the error bar of the reference study; lines
    guide the eye. Below: the standard deviation with filled markers, the expanded uncertainty of
    the mean with open ones.

    Parameters
    ----------
    measured
        One or several measured curves, as for `tribolab.plot.stribeck`, each with
        ``friction_coefficient_std`` and, if known, ``friction_coefficient_U95``.
    surfaces
        All surfaces of the study in their order, so that each has the same colour in all figures.

    Raises
    ------
    AnalysisError
        If no curve has a standard deviation above zero.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> curve = xr.Dataset(
    ...     {
    ...         "friction_coefficient": ("sliding_speed", [1.1, 0.9]),
    ...         "friction_coefficient_std": ("sliding_speed", [5e-3, 4e-3]),
    ...     },
    ...     {"sliding_speed": [1e-6, 1e-4]},
    ... )
    >>> figure_data(friction_spread(curve)).friction_coefficient_std.dropna().tolist()
    [0.005, 0.004]
    """
    curves = [measured] if isinstance(measured, xr.Dataset) else list(measured)
    curves = [curve for curve in curves if _has_spread(curve)]
    if not curves:
        raise AnalysisError("there is nothing to draw: no curve has a standard deviation")
    series: list[Series] = []
    for curve, look in zip(curves, curve_looks(curves, surfaces), strict=True):
        x, mu = curve["sliding_speed"].values, curve["friction_coefficient"].values
        bars = {kind: error_bar(curve, "friction_coefficient", kind) for kind in ("std", "U95")}
        numbers = {f"friction_coefficient_{kind}": size for kind, size in bars.items()}
        drawn: Arguments = {"colour": look.colour, "shade": look.shade, "marker": look.marker}
        label = look.label or "measured"
        series.append(
            Series(label, x, mu, "points", error=bars["std"], joined=True, **drawn,
                   columns={SPEED_AXIS.column: x, "friction_coefficient": mu, **numbers})
        )  # fmt: skip
        for kind, size in bars.items():
            y = np.where(size > 0, size, np.nan)
            series.append(
                Series(label, x, y, "points", panel=1, joined=True, open=kind == "U95", columns={},
                       **drawn)
            )  # fmt: skip
    return FigureSpec(
        title="Friction over speed and its error bars",
        panels=(
            Panel(SPEED_AXIS, axis_of("friction_coefficient"), name="error bars"),
            Panel(SPEED_AXIS, Axis("error bar of µ", log=True), height=0.6),
        ),
        series=tuple(series),
        keys=(Key("standard deviation", "points"), Key("U95", "points", open=True)),
    )


def _has_spread(curve: xr.Dataset) -> bool:
    name = "friction_coefficient_std"
    return name in curve and bool((curve[name] > 0).any())
