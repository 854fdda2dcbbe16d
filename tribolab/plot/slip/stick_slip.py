"""Figures of stick-slip: stacked traces, events, and the map of waveforms."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.envelope import envelope
from tribolab.figures.labels import plain
from tribolab.figures.look.frame import colours, logarithmic
from tribolab.figures.look.guests import Panels, name_all, several_panels
from tribolab.figures.look.several import OneOrSeveral, RunLabel, by_label, parts
from tribolab.figures.look.style import (
    BLACK,
    DOUBLE_MM,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    PaperFigure,
    keep,
    margins,
    new_figure,
    shade,
)
from tribolab.figures.signals import main_signal
from tribolab.friction.oscillation.slip_curve import one_curve
from tribolab.friction.oscillation.waveform import CLASSES, NOT_CLEAR
from tribolab.untyped import Arguments
from tribolab.words import number

_COLUMNS = 500
_LETTERS = 25  # that fit into a margin of 42 mm
_GAP = 0.25  # between stacked traces, of the tallest one's height
_LOOK = {
    CLASSES[0]: ("o", GREY),
    CLASSES[1]: ("^", BLACK),
    CLASSES[2]: ("o", SKY),
    CLASSES[3]: ("v", PURPLE),
    NOT_CLEAR: ("s", GREY),
}


class Trace(NamedTuple):
    """One stroke to draw: what to call it, its run, segments and friction, number of the segment.

    `surface` chooses the colour.

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


def slip_traces(
    traces: Sequence[Trace],
    surfaces: Sequence[str] = (),
    *,
    longest: float | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Draw friction against sliding distance, stroke above stroke, each shifted to be seen.

    Parameters
    ----------
    traces
        From below to above.
    surfaces
        All surfaces of the study in order: they choose the colours.
    longest
        Distance up to which is drawn [m]; by default what the shortest stroke has.
    ax
        Axes to draw in, which keep their look; the words stand on their right. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Every trace keeps its scale; what it was shifted by, up or down, stands beside it, and is
        a round number, so that it can be taken off again.

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
    chosen = colours([trace.surface for trace in traces], surfaces)
    heights = [np.ptp(y[x <= end]) for _, x, y in drawn]
    gap = _GAP * max(heights)
    rank: dict[str, int] = {}
    make = _wide(25.0 + 13.0 * len(drawn), left=15, right=42, top=4)
    with several_panels(None if ax is None else [ax], ("traces",), make) as (figure, (axes,)):
        base = -np.inf
        for (trace, x, y), height in zip(drawn, heights, strict=True):
            part = x <= end
            low = float(y[part].min())
            shift = _round_up(base - low, gap) if base > -np.inf else 0.0
            base = low + shift + max(height, 0.6 * gap) + gap  # room for the words
            count = sum(t.surface == trace.surface for t in traces)
            place = rank[trace.surface] = rank.get(trace.surface, -1) + 1
            colour = shade(chosen[trace.surface], place, count)
            short = envelope(x[part] * 1e6, y[part] + shift, _COLUMNS)
            axes.plot(*short, color=colour, linewidth=0.8, label=plain(trace.label))
            words = _wrapped(trace.label)
            words += f"\n{_shift_text(shift)}" if shift else ""
            axes.annotate(
                words,
                (1.01, short[1][-min(20, short[1].size) :].mean()),
                xycoords=("axes fraction", "data"),
                va="center",
                fontsize=7,
                annotation_clip=False,
            )
            up = np.full(len(short[0]), shift)
            x_y = {"sliding_distance_um": short[0], "shifted": short[1]}
            keep(figure, "traces", trace.label, **x_y, shift=up)
        axes.set_xlim(0, end * 1e6)
        axes.set_xlabel("sliding distance (µm)")
        force = main_signal(traces[0].run).name == "friction_force"
        word = r"friction force $F_x$ (N), shifted" if force else r"$\mu = F_x/F_N$, shifted"
        axes.set_ylabel(word)
        if ax is not None:
            name_all(ax)
    return figure


def _round_up(shift: float, gap: float) -> float:
    """Next larger shift with one digit at the place of the gap's first."""
    digits = -math.floor(math.log10(gap)) if gap > 0 else 2
    return round(math.ceil(round(shift * 10.0**digits, 6)) / 10.0**digits, max(digits, 0))


def _shift_text(shift: float) -> str:
    """Say how far, and which way, a trace was shifted.

    Examples
    --------
    >>> _shift_text(0.4), _shift_text(-1.0)
    ('shifted up by 0.4', 'shifted down by 1')
    """
    return f"shifted {'up' if shift > 0 else 'down'} by {number(abs(shift), 6)}"


def _wide(
    height: float, *, left: float, right: float, top: float
) -> Callable[[], tuple[PaperFigure, list[Axes]]]:
    """Return what makes a figure of two columns with one panel; its height and margins [mm]."""

    def make() -> tuple[PaperFigure, list[Axes]]:
        figure = new_figure(DOUBLE_MM, height)
        axes = figure.add_subplot()
        margins(figure, left, right, 11, top)
        return figure, [axes]

    return make


def _wrapped(label: str) -> str:
    """Break a label, so that it fits the margin of 42 mm."""
    apart = str(label).replace("_", "_ ")  # a long name breaks at its underscores
    lines = textwrap.wrap(apart, _LETTERS, max_lines=2, placeholder=" …") or [""]
    return "\n".join(plain(line.replace("_ ", "_")) for line in lines)


def _distance(trace: Trace) -> tuple[np.ndarray, np.ndarray]:
    """Distance within the trimmed part of a stroke [m], friction positive as resistance."""
    signal = main_signal(trace.run, trace.friction)
    number = int(trace.segment)
    time = trace.run["time"].values
    row = trace.segments.isel(segment=number)
    part = slice(*np.searchsorted(time, [row["trimmed_start"].item(), row["trimmed_stop"].item()]))
    y = signal.values[part]
    y = -y if row["direction"].item() < 0 and np.nanmean(y) < 0 else y
    x = (time[part] - time[part][0]) * row["sliding_speed"].item() if y.size else np.zeros(0)
    known = np.isfinite(y)
    return x[known], y[known]


def slip_events(
    slips: OneOrSeveral,
    surfaces: Sequence[str] = (),
    *,
    axes: Panels | None = None,
    **labels: Sequence[RunLabel],
) -> Figure:
    """Draw how drops, recurrence distances and durations of the events are distributed.

    Parameters
    ----------
    slips
        Label to a result of `stick_slip`; or such a result, also over further dims; or a list of
        them. All events count.
    surfaces
        Not used but for the order of colours.
    axes
        The axes to draw in, three of them; they keep their look. Without
        them a figure is made.
    **labels
        What tells the results of a list apart, one label for each, e.g. ``run=["dry", "wet"]``.

    Returns
    -------
    matplotlib.figure.Figure
        Cumulative shares: no bins to choose.

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
    lines = [BLACK, SKY, ORANGE, PURPLE, GREY]
    names = list(_event_columns(next(iter(shown.values()))))
    with several_panels(axes, names, _three) as (figure, panels):
        for k, (label, slip) in enumerate(shown.items()):
            look: Arguments = {
                "color": lines[k % len(lines)],
                "linestyle": "-" if k < len(lines) else "--",
            }
            for panel, (name, values) in zip(panels, _event_columns(slip).items(), strict=True):
                values = np.sort(values[np.isfinite(values)])
                share = np.arange(1, values.size + 1) / max(values.size, 1)
                panel.step(values, share, where="post", label=plain(label), **look)
                keep(figure, name, label, value=values, share=share)
        for panel, name in zip(panels, names, strict=True):
            panel.set_xlabel(name)
            panel.set_ylim(0, 1)
        panels[0].set_ylabel("share of the events")
        if axes is None:
            handles, words = panels[0].get_legend_handles_labels()
            figure.legend(handles, words, loc="upper center", ncols=4, fontsize=7)
        else:
            name_all(panels[0])
    return figure


def _three() -> tuple[PaperFigure, list[Axes]]:
    figure = new_figure(DOUBLE_MM, 62.0)
    panels = figure.subplots(1, 3)
    margins(figure, 13, 3, 11, 10, wspace=0.3)
    return figure, list(panels)


def _event_columns(slip: xr.Dataset) -> dict[str, np.ndarray]:
    number = slip["event_segment"].values
    place = {int(s): k for k, s in enumerate(slip["segment"].values)}
    speed = slip["sliding_speed"].values[[place[int(n)] for n in number]]
    recurrence = np.diff(slip["event_time"].values) * speed[1:]
    recurrence = recurrence[number[1:] == number[:-1]]
    force = "force_event_drop" in slip
    drop = slip["force_event_drop" if force else "event_drop"].values
    stick, slipping = slip["event_stick"].values, slip["event_slip"].values
    return {
        r"drop of the force (N)" if force else r"drop of friction $\Delta\mu$": drop,
        "distance from drop to drop (µm)": recurrence * 1e6,
        "part of a cycle that slips": slipping / (stick + slipping),
    }


def waveform_map(
    curves: Mapping[str, xr.Dataset] | xr.Dataset, *, ax: Axes | None = None
) -> Figure:
    """Draw the class of waveform of every condition at every speed, and how large the drops are.

    Parameters
    ----------
    curves
        Label to a result of `stick_slip_curve`, from below to above; or its result over further
        dims, from above to below.
    ax
        Axes to draw in, which keep their look; without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Marker and colour: the class; its area: the drop.

    Raises
    ------
    AnalysisError
        If there is nothing to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> curve = tl.stick_slip_curve([tl.stick_slip(run, tl.find_segments(run))])
    >>> tl.plot.figure_data(waveform_map({"dry": curve}))["drop"].round(2).tolist()
    [0.19]
    """
    if isinstance(curves, xr.Dataset):
        curves = _each(curves)
    if not curves:
        raise AnalysisError("there is no stick-slip to map")
    drops = np.concatenate([_drops(curve) for curve in curves.values()])
    largest = np.nanmax(np.append(drops[np.isfinite(drops)], 1e-12))
    make = _wide(24.0 + 7.0 * len(curves), left=42, right=5, top=8)
    with several_panels(None if ax is None else [ax], ("map",), make) as (figure, (axes,)):
        for place, (label, curve) in enumerate(curves.items()):
            kinds, v = curve["waveform"].values.astype(str), curve["sliding_speed"].values
            for kind in dict.fromkeys(kinds):
                marker, colour = _LOOK.get(kind, ("s", GREY))
                part = kinds == kind
                size = 14 + 90 * np.nan_to_num(_drops(curve)[part] / largest)
                filled = colour if kind in CLASSES[1:] else "none"
                axes.scatter(
                    v[part], np.full(part.sum(), place), size, marker=marker,
                    facecolors=filled, edgecolors=colour, linewidths=0.7,
                )  # fmt: skip
            keep(figure, "map", label, sliding_speed_m_s=v, drop=_drops(curve))
        for kind, (marker, colour) in _LOOK.items():
            filled = colour if kind in CLASSES[1:] else "none"
            axes.scatter(
                [], [], 22, marker=marker, facecolors=filled, edgecolors=colour, label=kind,
                linewidths=0.7,
            )  # fmt: skip
        speeds = np.concatenate([curve["sliding_speed"].values for curve in curves.values()])
        if speeds.size:  # stated, as a single speed has no range of its own
            axes.set_xlim(speeds.min() / 1.8, 1.8 * speeds.max())
        logarithmic(axes, "x")
        axes.set_yticks(range(len(curves)), [_wrapped(label) for label in curves])
        axes.set_ylim(-0.7, len(curves) - 0.3)
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel("sliding speed $v$ (m/s)")
        if ax is None:
            handles, words = axes.get_legend_handles_labels()
            figure.legend(handles, words, loc="upper center", ncols=5, fontsize=7)
        else:
            name_all(ax)
    return figure


def _each(curves: xr.Dataset) -> dict[str, xr.Dataset]:
    """Return the curves of a dataset that holds several by their labels, the last one first."""
    named = {label: one_curve(part) for label, part in parts(curves, "sliding_speed").items()}
    return {label: part for label, part in reversed(named.items()) if part.sizes["sliding_speed"]}


def _drops(curve: xr.Dataset) -> np.ndarray:
    nothing = np.full(curve.sizes["sliding_speed"], np.nan)
    return curve["drop"].values if "drop" in curve else nothing
