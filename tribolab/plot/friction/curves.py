"""Friction over speed: measured Stribeck curves, with or without a model, and half loops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tribolab.errors import AnalysisError
from tribolab.plot.look.error_bars import ErrorBars, draw_error_bars, error_bar
from tribolab.plot.look.frame import speed_axis
from tribolab.plot.look.labels import column, label, plain
from tribolab.plot.look.panel import one_panel
from tribolab.plot.look.style import (
    GREY,
    LOAD_MARKERS,
    SurfaceStyle,
    keep,
    shade,
    surface_styles,
)
from tribolab.words import force_text, is_dry

_DRAWN = ("friction_coefficient", "half_loop", "friction_force")  # the first that is known
# Coordinates of a dataset that holds several curves, and the attributes that say the same of one.
_SAID = {
    "surface": "surface",
    "medium": "medium",
    "normal_force": "normal_force_N",
    "nominal_normal_force": "normal_force_N",
}
MeasuredCurves = xr.Dataset | Sequence[xr.Dataset] | None


class _Look(NamedTuple):
    """How a curve is drawn: by surface and load, and whether it is dry."""

    colour: str
    marker: str
    dry: bool


def stribeck(
    measured: MeasuredCurves = None,
    model: MeasuredCurves = None,
    *,
    surfaces: Sequence[str] = (),
    errors: ErrorBars = "U95",
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw friction coefficients over the logarithm of the sliding speed.

    Parameters
    ----------
    measured
        One or several measured curves (sliding_speed) or friction results (segment). The
        attributes ``surface``, ``medium`` and ``normal_force_N`` say what belongs together; a
        dataset over (surface, medium, normal_force, ...), or over some of them, holds as many.
    model
        One or several calculated curves (sliding_speed), drawn as lines in the colour of the
        measured curve with the same surface.
    surfaces
        All surfaces of the study in their order, so that each keeps its colour from figure to
        figure.
    errors
        The error bars: ``"U95"``, the expanded uncertainty of the mean (95 % coverage), or
        ``"std"``, the standard deviation while sliding (the error bar of the reference study).
    title
        Text above the figure.
    ax
        Axes to draw in, which keep their look; without them a figure is made. The legend takes in
        what is drawn there already; ``ax.legend()`` makes it anew after more has been drawn.

    Returns
    -------
    matplotlib.figure.Figure
        Marker: mean. Narrow bar with caps: U95. Wide pale bar: standard deviation.
        Dry contacts have open markers and dashed lines. Where no speed is known, the segments
        are numbered instead; where no load is known, the friction force is drawn.

    Raises
    ------
    AnalysisError
        If there is no finite point to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4, 1e-3)))
    >>> run = rig.simulate_run("Sb-S", "dry", rig=short).noise_free
    >>> segments = tl.find_segments(run)
    >>> friction = tl.friction_coefficient(run, segments)
    >>> curve = tl.measured_stribeck_curve([friction]).assign_attrs(surface="Sb-S", medium="dry")
    >>> figure = stribeck(measured=curve)
    >>> tl.plot.figure_data(figure).friction_coefficient.round(3).tolist()
    [1.907, 1.934]
    """
    curves, models = _listed(measured), _listed(model)
    name = _quantity(curves + models)
    numbered = not any(_has_speed(curve) for curve in curves + models)
    every = [_attribute(curve, "surface") for curve in curves + models]
    styles = surface_styles([*surfaces, *every])
    loads = sorted({_load(c) for c in curves + models if np.isfinite(_load(c))})
    with one_panel(ax, title) as (figure, axes):
        drawn = 0
        for curve in curves:
            look = _look(curve, styles, loads, len(set(every)))
            text = _label(curve, curves + models) or ("" if ax is None else _whole_label(curve))
            drawn += _points(figure, axes, curve, name, numbered, look, text, bool(models), errors)
        for curve in models:
            look = _look(curve, styles, loads, len(set(every)))
            words = _label(curve, curves + models)
            drawn += _line(figure, axes, curve, name, look, f"model {words}".strip())
        if not drawn:
            raise AnalysisError(
                f"there is nothing to draw: no curve has a finite {name.replace('_', ' ')}"
            )
        _scales(axes, name, numbered)
    return figure


def _listed(curves: MeasuredCurves) -> list[xr.Dataset]:
    if curves is None:
        return []
    given = [curves] if isinstance(curves, xr.Dataset) else list(curves)
    return [curve for data in given for curve in _each(data)]


def _each(curves: xr.Dataset) -> list[xr.Dataset]:
    """Return the curves of a dataset that holds several, named after their coordinates."""
    varying = {dim for name in _DRAWN if name in curves for dim in curves[name].dims}
    along = [dim for dim in ("surface", "medium", "normal_force", "run") if dim in varying]
    if not along:
        return [curves]
    parts = []
    for place in range(curves.sizes[along[0]]):
        part = curves.isel({along[0]: place})
        known = {n: key for n, key in _SAID.items() if n in part.coords and not part[n].ndim}
        parts += _each(part.assign_attrs({key: part[name].item() for name, key in known.items()}))
    return [p for p in parts if any(p[n].notnull().any() for n in _DRAWN if n in p)]


def _quantity(curves: list[xr.Dataset]) -> str:
    for name in _DRAWN:
        if any(name in c and np.isfinite(np.asarray(c[name], float)).any() for c in curves):
            return name
    return "friction_coefficient"


def _has_speed(curve: xr.Dataset) -> bool:
    return "sliding_speed" in curve.variables and bool(
        (np.asarray(curve["sliding_speed"], float) > 0).any()
    )


def _attribute(curve: xr.Dataset, name: str) -> str:
    return str(curve.attrs.get(name, ""))


def _load(curve: xr.Dataset) -> float:
    try:
        return float(curve.attrs.get("normal_force_N", np.nan))
    except (TypeError, ValueError):
        return float("nan")


def _look(
    curve: xr.Dataset, styles: dict[str, SurfaceStyle], loads: list[float], surfaces: int
) -> _Look:
    own = styles[_attribute(curve, "surface")]
    rank = loads.index(_load(curve)) if _load(curve) in loads else 0
    colour = shade(own.colour, rank, len(loads))
    by_load = surfaces == 1 and len(loads) > 1
    marker = LOAD_MARKERS[rank % len(LOAD_MARKERS)] if by_load else own.marker
    return _Look(colour, marker, is_dry(_attribute(curve, "medium")))


def curve_looks(
    curves: Sequence[xr.Dataset], surfaces: Sequence[str] = ()
) -> list[tuple[str, _Look]]:
    """Return of each curve what sets it apart in words, and how it is drawn.

    Parameters
    ----------
    curves
        All curves of a figure, with the attributes that `stribeck` reads.
    surfaces
        All surfaces of the study in their order.
    """
    every = [_attribute(curve, "surface") for curve in curves]
    styles = surface_styles([*surfaces, *every])
    loads = sorted({_load(curve) for curve in curves if np.isfinite(_load(curve))})
    return [
        (_label(curve, list(curves)), _look(curve, styles, loads, len(set(every))))
        for curve in curves
    ]


def _label(curve: xr.Dataset, curves: list[xr.Dataset]) -> str:
    """Say what sets this curve apart from the others in the figure."""
    words = []
    for name in ("surface", "medium"):
        if len({_attribute(c, name) for c in curves}) > 1 and _attribute(curve, name):
            words.append(plain(_attribute(curve, name)))
    if len({str(_load(c)) for c in curves}) > 1:
        words.append(force_text(_load(curve)))
    return ", ".join(words)


def _whole_label(curve: xr.Dataset) -> str:
    """Name a curve that stands beside others, of which only the user knows."""
    return (
        ", ".join(filter(None, (_attribute(curve, n) for n in ("surface", "medium")))) or "measured"
    )


def _points(
    figure: Figure,
    axes: Axes,
    curve: xr.Dataset,
    name: str,
    numbered: bool,
    look: _Look,
    text: str,
    with_model: bool,
    errors: ErrorBars,
) -> int:
    if name not in curve:
        return 0
    y = np.atleast_1d(np.asarray(curve[name], float))
    x = np.arange(1.0, y.size + 1) if numbered else np.asarray(curve["sliding_speed"], float)
    x = np.atleast_1d(x)
    size = error_bar(curve, name, errors)
    fine = np.isfinite(y) & (np.ones_like(x, bool) if numbered else np.nan_to_num(x) > 0)
    if not fine.any():
        return 0
    order = np.argsort(x[fine], kind="stable")
    x, y, size = (a[fine][order] for a in (x, y, size))
    colour, dry = look.colour, look.dry
    draw_error_bars(axes, x, y, size, colour, errors)
    joined = not with_model and not numbered and np.unique(x).size == x.size
    axes.plot(
        x, y, color=colour, marker=look.marker, markersize=4.2, markeredgewidth=0.9,
        markerfacecolor="white" if dry else colour, markeredgecolor=colour,
        linestyle=("--" if dry else "-") if joined else "none", linewidth=0.7,
        label=text or "_nolegend_", zorder=4,
    )  # fmt: skip
    where = "segment" if numbered else column("sliding_speed")
    numbers = {where: x, column(name): y, column(f"{name}_{errors}"): size}
    keep(figure, "curve", text or "measured", **numbers)
    return int(fine.sum())


def _line(figure: Figure, axes: Axes, curve: xr.Dataset, name: str, look: _Look, text: str) -> int:
    if name not in curve or not _has_speed(curve):
        return 0
    x, y = (np.atleast_1d(np.asarray(curve[n], float)) for n in ("sliding_speed", name))
    fine = np.isfinite(y) & (x > 0)
    axes.plot(
        x[fine], y[fine], color=look.colour, linestyle="--" if look.dry else "-",
        linewidth=1.2, label=text, zorder=3,
    )  # fmt: skip
    keep(figure, "curve", text, **{column("sliding_speed"): x[fine], column(name): y[fine]})
    return int(fine.sum())


def _scales(axes: Axes, name: str, numbered: bool) -> None:
    if numbered:
        axes.set_xlabel("number of the segment (speed unknown)")
        axes.xaxis.set_major_locator(MaxNLocator(8, integer=True))
        low, high = axes.dataLim.intervalx
        axes.set_xlim(low - 0.6, high + 0.6)
    else:
        low, high = axes.dataLim.intervalx
        room = 1.8 if high / low > 3 else 10.0
        speed_axis(axes, room=room)
    axes.set_ylabel(label(name, "half loop of the friction force" if name == "half_loop" else None))
    low, high = axes.dataLim.intervaly  # with the error bars
    low = 0.0 if low >= 0 else low
    room = 0.08 * ((high - low) or 1.0)  # of the whole axis: a flat curve far from 0 is not cut
    axes.set_ylim(low - room if low < 0 else 0.0, high + room)


def half_loop(friction: xr.Dataset, *, title: str = "", ax: Axes | None = None) -> Figure:
    """Draw half the force difference of each pair of strokes: friction without the offset.

    Parameters
    ----------
    friction
        A friction result (segment) with `half_loop` and `pair`.
    title
        Text above the figure.
    ax
        Axes to draw in, which keep their look; without them a figure is made. The legend takes in
        what is drawn there already; ``ax.legend()`` makes it anew after more has been drawn.

    Returns
    -------
    matplotlib.figure.Figure
        A point per pair, in the order of the run, with their mean as a line.

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
    name = "_nolegend_" if ax is None else "half loop"
    with one_panel(ax, title, left=16) as (figure, axes):
        axes.plot(x, y, color="black", marker="o", linestyle="none", markersize=4, label=name)
        axes.axhline(y.mean(), color=GREY, linewidth=0.8, zorder=1)
        axes.set_xlabel("pair of strokes")
        axes.set_ylabel("half loop of the\nfriction force (N)")
        axes.xaxis.set_major_locator(MaxNLocator(8, integer=True))
        axes.set_xlim(x.min() - 0.6, x.max() + 0.6)
        span = max(np.ptp(y), 0.1 * abs(y.mean())) or 1.0
        axes.set_ylim(y.mean() - 1.2 * span, y.mean() + 1.2 * span)
        keep(figure, "half loop", "pairs", pair=x, half_loop_N=y)
    return figure
