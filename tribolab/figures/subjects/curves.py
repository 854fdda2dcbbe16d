"""Figure of friction against speed: measured Stribeck curves, with or without a model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.core.untyped import Arguments
from tribolab.core.wording import force_text, is_dry
from tribolab.figures.colours import shade_of, surface_colours
from tribolab.figures.error_bars import ErrorBars, error_bar
from tribolab.figures.labels import column
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, SeriesLabels, axis_of

Scale = Literal["auto", "log", "linear"]
MIN_RATIO_FOR_LOG = 5.0  # ratio of highest to lowest µ from which the axis is logarithmic
_DRAWN = ("friction_coefficient", "half_loop", "friction_force")  # the first available is drawn
# coordinate in a dataset of several curves, and the equivalent attribute of a single curve
_ATTRIBUTES = {
    "surface": "surface",
    "medium": "medium",
    "normal_force": "normal_force_N",
    "nominal_normal_force": "normal_force_N",
}
MeasuredCurves = xr.Dataset | Sequence[xr.Dataset] | None
SPEED_AXIS = axis_of("sliding_speed", log=True)
FRICTION_AXIS = axis_of("friction_coefficient", log=True)


@plotted()
def stribeck(
    measured: MeasuredCurves = None,
    model: MeasuredCurves = None,
    *,
    surfaces: Sequence[str] = (),
    errors: ErrorBars = "U95",
    scale: Scale = "auto",
) -> FigureSpec:
    """Draw friction coefficients against sliding speed (on a logarithmic axis).

    Markers: means; bars: U95. Dry contacts have open markers and dashed lines. If no speed is
    known, the segments are numbered; if no load is known, the friction force is drawn.

    Parameters
    ----------
    measured
        One or several measured curves (sliding_speed) or friction results (segment). The
        attributes ``surface``, ``medium`` and ``normal_force_N`` name their conditions; a dataset
        with any of the dims (surface, medium, normal_force, run) contains several curves.
    model
        One or several calculated curves (sliding_speed), drawn as lines in the colour of the
        surface, with ``friction_coefficient_low`` and ``_high`` as a band.
    surfaces
        All surfaces of the study in their order, so that each has the same colour in all figures.
    errors
        The error bars: ``"U95"``, the expanded uncertainty of the mean (95 % coverage), or
        ``"std"``, the standard deviation while sliding (the error bar of the reference study).
    scale
        Scale of the friction coefficient; ``"auto"`` is logarithmic if the highest value is more
        than 5 times the lowest, so that the minimum can be read.

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
    every = curves + models
    name = _quantity(every)
    numbered = not any(_has_speed(curve) for curve in every)
    looks = dict(zip(map(id, every), curve_looks(every, surfaces), strict=True))
    series: list[Series] = []
    for curve in models:
        own = _attribute(curve, "label")
        label = own or " ".join(filter(None, ("model", looks[id(curve)].label)))
        series += _line(curve, name, looks[id(curve)], label)
    for curve in curves:
        series += _points(curve, name, numbered, looks[id(curve)], not models, errors)
    if not series:
        raise AnalysisError(
            f"there is nothing to draw: no curve has a finite {name.replace('_', ' ')}"
        )
    words = "half loop of the friction force" if name == "half_loop" else ""
    y = axis_of(name, words, log=_is_log(series, scale))
    y = y if y.log else Axis(y.label, y.unit, include=(0.0,), paper=y.paper, column=y.column)
    x = Axis("number of the segment (speed unknown)", column="segment") if numbered else SPEED_AXIS
    return FigureSpec(
        title="Friction over sliding speed",
        panels=(Panel(x, y, name="curve"),),
        series=tuple(series),
    )


def _is_log(series: Sequence[Series], scale: Scale) -> bool:
    if scale != "auto":
        return scale == "log"
    every = [np.asarray(s.y, float) for s in series if s.style == "points"]
    values = np.concatenate(every) if every else np.zeros(0)
    values = values[np.isfinite(values)]
    return bool(values.size and 0 < MIN_RATIO_FOR_LOG * values.min() < values.max())


def _listed(curves: MeasuredCurves) -> list[xr.Dataset]:
    if curves is None:
        return []
    given = [curves] if isinstance(curves, xr.Dataset) else list(curves)
    return [curve for data in given for curve in _each(data)]


def _each(curves: xr.Dataset) -> list[xr.Dataset]:
    """Split a dataset into its curves; the attributes of each name its conditions."""
    varying = {dim for name in _DRAWN if name in curves for dim in curves[name].dims}
    along = [dim for dim in ("surface", "medium", "normal_force", "run") if dim in varying]
    if not along:
        return [curves.copy(deep=False)]  # a copy, so that a curve given twice is drawn twice
    parts = []
    for place in range(curves.sizes[along[0]]):
        part = curves.isel({along[0]: place})
        names = _ATTRIBUTES.items()
        known = {key: part[n].item() for n, key in names if n in part.coords and not part[n].ndim}
        parts += _each(part.assign_attrs(known))
    return [p for p in parts if any(p[n].notnull().any() for n in _DRAWN if n in p)]


def _quantity(curves: Sequence[xr.Dataset]) -> str:
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


def _load(curve: xr.Dataset) -> float | None:
    try:
        load = float(curve.attrs.get("normal_force_N", np.nan))
    except (TypeError, ValueError):
        return None
    return load if np.isfinite(load) else None


class CurveLook(NamedTuple):
    """Look of a curve: label, colour, shade and marker; and the conditions of its series."""

    label: str
    colour: int
    shade: float
    marker: int | None
    labels: SeriesLabels


def curve_looks(curves: Sequence[xr.Dataset], surfaces: Sequence[str] = ()) -> list[CurveLook]:
    """Return the look of each curve: colour by surface, shade and marker by load.

    Parameters
    ----------
    curves
        All curves of a figure, with the attributes that `stribeck` reads.
    surfaces
        All surfaces of the study in their order.
    """
    every = [_attribute(curve, "surface") or _attribute(curve, "label") for curve in curves]
    colours = surface_colours([*surfaces, *every])
    loads = sorted({load for curve in curves if (load := _load(curve)) is not None})
    by_load = len(set(every)) == 1 and len(loads) > 1
    looks = []
    for key, curve in zip(every, curves, strict=True):
        surface, medium = _attribute(curve, "surface"), _attribute(curve, "medium")
        load = _load(curve)
        rank = 0 if load is None else loads.index(load)
        labels = SeriesLabels(surface=surface, medium=medium, load=load, open=is_dry(medium))
        labels["runs"] = tuple(curve.attrs.get("runs", ()))
        looks.append(
            CurveLook(
                _attribute(curve, "label") or _difference(curve, curves),
                colours[key],
                shade_of(rank, len(loads)),
                rank if by_load else None,
                labels,
            )
        )
    return looks


def _difference(curve: xr.Dataset, curves: Sequence[xr.Dataset]) -> str:
    """Return as a label the conditions in which a curve differs from the others in the figure."""
    words = []
    for name in ("surface", "medium"):
        if len({_attribute(c, name) for c in curves}) > 1 and _attribute(curve, name):
            words.append(_attribute(curve, name))
    if len({_load(c) for c in curves}) > 1:
        load = _load(curve)
        words.append(force_text(float("nan") if load is None else load))
    return ", ".join(words)


def _points(
    curve: xr.Dataset, name: str, numbered: bool, look: CurveLook, joined: bool, errors: ErrorBars
) -> list[Series]:
    if name not in curve:
        return []
    y = np.atleast_1d(np.asarray(curve[name], float))
    x = np.arange(1.0, y.size + 1) if numbered else np.asarray(curve["sliding_speed"], float)
    x = np.atleast_1d(x)
    size = error_bar(curve, name, errors)
    fine = np.isfinite(y) & (np.ones_like(x, bool) if numbered else np.nan_to_num(x) > 0)
    if not fine.any():
        return []
    order = np.flatnonzero(fine)[np.argsort(x[fine], kind="stable")]
    x, y, size = x[order], y[order], size[order]
    texts: Arguments = {
        key: tuple(np.asarray(curve[key].values)[order].tolist()) if key in curve else ()
        for key in ("hover", "link")
    }
    where = "segment" if numbered else column("sliding_speed")
    return [
        Series(
            look.label or "measured",
            x,
            y,
            style="points",
            colour=look.colour,
            shade=look.shade,
            marker=look.marker,
            error=size,
            pale=errors == "std",
            joined=joined and not numbered and np.unique(x).size == x.size,
            columns={where: x, column(name): y, column(f"{name}_{errors}"): size},
            **texts,
            **look.labels,
        )
    ]


def _line(curve: xr.Dataset, name: str, look: CurveLook, label: str) -> list[Series]:
    if name not in curve or not _has_speed(curve):
        return []
    x, y = (np.atleast_1d(np.asarray(curve[n], float)) for n in ("sliding_speed", name))
    fine = np.isfinite(y) & (x > 0)
    style: Literal["dashed", "line"] = "dashed" if look.labels["open"] else "line"
    drawn = [Series(label, x[fine], y[fine], style, look.colour, shade=look.shade, **look.labels)]
    if f"{name}_low" in curve:
        low, high = (np.asarray(curve[f"{name}_{end}"], float) for end in ("low", "high"))
        known = fine & np.isfinite(low) & np.isfinite(high)
        ends = low[known], high[known]
        drawn.insert(
            0,
            Series("uncertainty", x[known], ends[0], "band", look.colour, high=ends[1],
                   shade=look.shade, **look.labels),
        )  # fmt: skip
    return drawn
