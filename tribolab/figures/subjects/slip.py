"""Figures of stick-slip: friction traces, sizes of slip events, waveforms at each speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.core.untyped import Arguments
from tribolab.core.wording import number
from tribolab.figures.colours import BLACK, GREY, PURPLE, SKY, shade_of, surface_colours
from tribolab.figures.envelopes import envelope
from tribolab.figures.labelled import OneOrSeveral, RunLabel, by_label, parts
from tribolab.figures.plotted import plotted
from tribolab.figures.signals import main_signal
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series
from tribolab.figures.subjects.curves import SPEED_AXIS
from tribolab.friction.oscillation.slip_curve import one_curve
from tribolab.friction.oscillation.waveform import CLASSES, NOT_CLEAR

_COLUMNS = 500
_GAP = 0.25  # gap between stacked traces, as share of the largest range of a trace
_MAX_EVENTS = 300  # largest number of points of a distribution
_LOOKS: dict[str, Arguments] = {
    CLASSES[0]: {"colour": GREY, "marker": 0, "open": True},
    CLASSES[1]: {"colour": BLACK, "marker": 3},
    CLASSES[2]: {"colour": SKY, "marker": 0},
    CLASSES[3]: {"colour": PURPLE, "marker": 4},
    NOT_CLEAR: {"colour": GREY, "marker": 1, "open": True},
}


class Trace(NamedTuple):
    """One stroke to draw: its label, the run with its segments and friction, and its segment.

    `surface` determines the colour.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> Trace("dry", run, tl.find_segments(run), None, 0, "Smooth").label
    'dry'
    """

    label: str
    run: xr.Dataset
    segments: xr.Dataset
    friction: xr.Dataset | None
    segment: int
    surface: str = ""


@plotted()
def slip_traces(
    traces: Sequence[Trace], surfaces: Sequence[str] = (), *, longest: float | None = None
) -> FigureSpec:
    """Draw friction against sliding distance, with the strokes stacked above each other.

    All traces have the same scale; the legend states by how much each is shifted.

    Parameters
    ----------
    traces
        Strokes, the lowest in the figure first.
    surfaces
        All surfaces of the study in order, for the colours.
    longest
        Largest distance drawn [m]; by default at most 1.5 times the shortest stroke.

    Raises
    ------
    AnalysisError
        If there is nothing to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> figure = slip_traces([Trace("dry", run, tl.find_segments(run), None, 0, "Smooth")])
    >>> tl.plot.figure_data(figure).series.unique().tolist()
    ['dry']
    """
    drawn = [(trace, *_distance(trace)) for trace in traces]
    drawn = [curve for curve in drawn if curve[1].size > 1]
    if not drawn:
        raise AnalysisError("there is no stroke to draw")
    ends = [x[-1] for _, x, _ in drawn]
    end = longest or min(max(ends), 1.5 * min(ends))
    colours = surface_colours([*surfaces, *(trace.surface for trace in traces)])
    heights = [np.ptp(y[x <= end]) for _, x, y in drawn]
    gap = _GAP * max(heights)
    rank: dict[str, int] = {}
    base = -np.inf
    series = []
    for (trace, x, y), height in zip(drawn, heights, strict=True):
        part = x <= end
        low = float(y[part].min())
        shift = _round_up(base - low, gap) if base > -np.inf else 0.0
        base = low + shift + max(height, 0.6 * gap) + gap
        place = rank[trace.surface] = rank.get(trace.surface, -1) + 1
        count = sum(other.surface == trace.surface for other in traces)
        short_x, short_y = envelope(x[part] * 1e6, y[part] + shift, _COLUMNS)
        columns = {"sliding_distance_um": short_x, "shifted": short_y}
        label = f"{trace.label}, {_shift_text(shift)}" if shift else trace.label
        series.append(
            Series(
                label, short_x, short_y, colour=colours[trace.surface],
                shade=shade_of(place, count),
                surface=trace.surface, name=trace.label,
                columns=columns | {"shift": np.full(short_x.size, shift)},
            )
        )  # fmt: skip
    force = main_signal(traces[0].run).name == "friction_force"
    y_axis = (
        Axis("friction force, shifted", "N") if force else Axis("friction coefficient µ, shifted")
    )
    return FigureSpec(
        title="Slow traces",
        panels=(Panel(Axis("sliding distance", "µm"), y_axis, name="traces", height=1.4),),
        series=tuple(series),
        width="whole",
    )


def _round_up(shift: float, gap: float) -> float:
    """Return a shift, rounded up to the decimal place of the first digit of the gap."""
    digits = -math.floor(math.log10(gap)) if gap > 0 else 2
    return round(math.ceil(round(shift * 10.0**digits, 6)) / 10.0**digits, max(digits, 0))


def _shift_text(shift: float) -> str:
    """Return text for the legend on how far a trace is shifted.

    Examples
    --------
    >>> _shift_text(0.4), _shift_text(-1.0)
    ('shifted up by 0.4', 'shifted down by 1')
    """
    return f"shifted {'up' if shift > 0 else 'down'} by {number(abs(shift), 6)}"


def _distance(trace: Trace) -> tuple[np.ndarray, np.ndarray]:
    """Return distance [m] and friction (positive as resistance) between the trimmed ends."""
    signal = main_signal(trace.run, trace.friction)
    time = trace.run["time"].values
    row = trace.segments.isel(segment=int(trace.segment))
    part = slice(*np.searchsorted(time, [row["trimmed_start"].item(), row["trimmed_stop"].item()]))
    y = signal.values[part]
    y = -y if row["direction"].item() < 0 and np.nanmean(y) < 0 else y
    x = (time[part] - time[part][0]) * row["sliding_speed"].item() if y.size else np.zeros(0)
    known = np.isfinite(y)
    return x[known], y[known]


@plotted(panels=3)
def slip_events(slips: OneOrSeveral, **labels: Sequence[RunLabel]) -> FigureSpec:
    """Draw cumulative distributions of the drops, distances and slip durations of slip events.

    Unlike histograms, they need no choice of bins.

    Parameters
    ----------
    slips
        Results of `stick_slip` by label; or one such result, perhaps with further dims; or a list
        of them. All events count.
    **labels
        Labels that distinguish the results of a list, one for each, e.g. ``run=["dry", "wet"]``.

    Raises
    ------
    AnalysisError
        If there is no event.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> slip = tl.stick_slip(run, tl.find_segments(run))
    >>> len(slip_events({"dry": slip}).axes), len(slip_events([slip, slip], run=[1, 2]).axes)
    (3, 3)
    """
    every = by_label(slips, labels, "segment")
    shown = {label: slip for label, slip in every.items() if slip.sizes.get("event", 0)}
    if not shown:
        raise AnalysisError("there is no event to draw")
    series = []
    axes: list[Axis] = []
    for k, (label, slip) in enumerate(shown.items()):
        for panel, (axis, values) in enumerate(_event_columns(slip)):
            x, share = cumulative(values)
            series.append(Series(label, x, share, colour=k, panel=panel))
            axes += [axis] if k == 0 else []
    share_axis = Axis("share of the events", include=(0.0, 1.0), column="share")
    return FigureSpec(
        title="Size of the drops",
        panels=tuple(Panel(axis, share_axis, name=axis.label) for axis in axes),
        series=tuple(series),
        across=3,
    )


def cumulative(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return sorted values and their cumulative shares, with at most 300 points.

    Examples
    --------
    >>> [part.tolist() for part in cumulative(np.array([3.0, 1.0, np.nan, 2.0, 4.0]))]
    [[1.0, 2.0, 3.0, 4.0], [0.25, 0.5, 0.75, 1.0]]
    """
    values = np.sort(np.asarray(values, float))
    values = values[np.isfinite(values)]
    share = np.arange(1, values.size + 1) / max(values.size, 1)
    if values.size <= _MAX_EVENTS:
        return values, share
    kept = np.linspace(0, values.size - 1, _MAX_EVENTS).round().astype(int)
    return values[kept], share[kept]


def _event_columns(slip: xr.Dataset) -> list[tuple[Axis, np.ndarray]]:
    segment = slip["event_segment"].values
    place = {int(s): k for k, s in enumerate(slip["segment"].values)}
    speed = slip["sliding_speed"].values[[place[int(n)] for n in segment]]
    recurrence = np.diff(slip["event_time"].values) * speed[1:]
    recurrence = recurrence[segment[1:] == segment[:-1]]
    force = "force_event_drop" in slip
    drop = slip["force_event_drop" if force else "event_drop"].values
    stick, slipping = slip["event_stick"].values, slip["event_slip"].values
    first = (
        Axis("drop of the force", "N") if force else Axis("drop of µ", paper=r"drop $\Delta\mu$")
    )
    return [
        (first, drop),
        (Axis("distance between drops", "µm"), recurrence * 1e6),
        (Axis("slip share of a cycle"), slipping / (stick + slipping)),
    ]


@plotted()
def waveform_map(curves: Mapping[str, xr.Dataset] | xr.Dataset) -> FigureSpec:
    """Draw a map of the waveform class and the drop, for each condition and speed.

    Marker and colour: the class; area: the drop.

    Parameters
    ----------
    curves
        Results of `stick_slip_curve` by label, the lowest in the figure first; or one result with
        further dims, the highest first.

    Raises
    ------
    AnalysisError
        If there is nothing to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> curve = tl.friction.stick_slip_curve([tl.stick_slip(run, tl.find_segments(run))])
    >>> tl.plot.figure_data(waveform_map({"dry": curve}))["drop"].round(2).tolist()
    [0.19]
    """
    if isinstance(curves, xr.Dataset):
        curves = _each(curves)
    if not curves:
        raise AnalysisError("there is no stick-slip to map")
    largest = max(np.nanmax(_drops(curve), initial=1e-12) for curve in curves.values())
    series = []
    for label, curve in curves.items():
        kinds, v = curve["waveform"].values.astype(str), curve["sliding_speed"].values
        hover, link = (curve[key].values if key in curve else None for key in ("hover", "link"))
        drops = _drops(curve)
        for kind in dict.fromkeys(kinds.tolist()):
            part = kinds == kind
            series.append(
                Series(
                    kind, v[part], [label] * int(part.sum()), "points",
                    sizes=1 + 4 * np.nan_to_num(drops[part] / largest), name=label,
                    hover=() if hover is None else tuple(hover[part].tolist()),
                    link=() if link is None else tuple(link[part].tolist()),
                    surface=str(curve.attrs.get("surface", "")),
                    medium=str(curve.attrs.get("medium", "")),
                    load=curve.attrs.get("normal_force_N"), runs=curve.attrs.get("runs", ()),
                    columns={"sliding_speed_m_s": v[part], "drop": drops[part]},
                    **_LOOKS.get(kind, _LOOKS[NOT_CLEAR]),
                )
            )  # fmt: skip
    return FigureSpec(
        title="Steady sliding or stick-slip",
        note="Open: steady or not decided; filled: friction rises and falls. Area: the drop.",
        panels=(Panel(SPEED_AXIS, Axis("", column="condition"), name="map"),),
        series=tuple(series),
        width="whole",
        rows=True,
    )


def _each(curves: xr.Dataset) -> dict[str, xr.Dataset]:
    """Return the curves of a dataset by label, in reverse order to draw the first on top."""
    named = {label: one_curve(part) for label, part in parts(curves, "sliding_speed").items()}
    return {label: part for label, part in reversed(named.items()) if part.sizes["sliding_speed"]}


def _drops(curve: xr.Dataset) -> np.ndarray:
    nothing = np.full(curve.sizes["sliding_speed"], np.nan)
    return curve["drop"].values if "drop" in curve else nothing
