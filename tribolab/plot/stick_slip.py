"""Figures of stick-slip: stacked traces, spectra, events, and the map of waveforms."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from tribolab.errors import AnalysisError
from tribolab.friction.oscillation.waveform import CLASSES, UNDECIDED
from tribolab.plot.frame import colours, logarithmic
from tribolab.plot.labels import plain
from tribolab.plot.reduce import envelope
from tribolab.plot.signals import main_signal
from tribolab.plot.style import (
    BLACK,
    DOUBLE_MM,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    PaperFigure,
    margins,
    new_figure,
    paper_style,
    shade,
)

_COLUMNS = 500
_LETTERS = 25  # that fit into a margin of 42 mm
_GAP = 0.25  # between stacked traces, of the tallest one's height
_LOOK = {
    CLASSES[0]: ("o", GREY),
    CLASSES[1]: ("^", BLACK),
    CLASSES[2]: ("o", SKY),
    CLASSES[3]: ("v", PURPLE),
    UNDECIDED: ("s", GREY),
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
    traces: Sequence[Trace], surfaces: Sequence[str] = (), *, longest: float | None = None
) -> PaperFigure:
    """Draw friction against sliding distance, stroke above stroke, each shifted up to be seen.

    Parameters
    ----------
    traces
        From below to above.
    surfaces
        All surfaces of the study in order: they choose the colours.
    longest
        Distance up to which is drawn [m]; by default what the shortest stroke has.

    Returns
    -------
    matplotlib.figure.Figure
        Every trace keeps its scale; what it was shifted by stands beside it.

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
    with paper_style():
        figure = new_figure(DOUBLE_MM, 25.0 + 13.0 * len(drawn))
        axes = figure.add_subplot()
        margins(figure, 15, 42, 11, 4)
        base = None
        for (trace, x, y), height in zip(drawn, heights, strict=True):
            part = x <= end
            low = float(y[part].min())
            base = low if base is None else base
            shift = base - low
            base += max(height, 0.6 * gap) + gap  # room for the words
            count = sum(t.surface == trace.surface for t in traces)
            place = rank[trace.surface] = rank.get(trace.surface, -1) + 1
            colour = shade(chosen[trace.surface], place, count)
            short = envelope(x[part] * 1e6, y[part] + shift, _COLUMNS)
            axes.plot(*short, color=colour, linewidth=0.8)
            words = _wrapped(trace.label)
            words += f"\nshifted by {shift:+.2f}" if abs(shift) > 0.005 else ""
            axes.annotate(
                words,
                (1.01, short[1][-min(20, short[1].size) :].mean()),
                xycoords=("axes fraction", "data"),
                va="center",
                fontsize=7,
                annotation_clip=False,
            )
            figure.keep("traces", trace.label, sliding_distance_um=short[0], shifted=short[1])
        axes.set_xlim(0, end * 1e6)
        axes.set_xlabel("sliding distance (µm)")
        force = main_signal(traces[0].run).name == "friction_force"
        word = r"friction force $F_x$ (N), shifted" if force else r"$\mu = F_x/F_N$, shifted"
        axes.set_ylabel(word)
    return figure


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


def slip_spectra(slips: Mapping[str, tuple[xr.Dataset, int]]) -> PaperFigure:
    """Draw the power spectra of segments with their background and what would be significant.

    Parameters
    ----------
    slips
        Label to a result of `stick_slip` and the number of its segment.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each, over frequency below and sliding distance above; the dominant oscillation
        and lines of the mains are marked.

    Raises
    ------
    AnalysisError
        If there is nothing to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> slip = tl.stick_slip(run, tl.find_segments(run))
    >>> tl.plot.figure_data(slip_spectra({"dry": (slip, 0)})).series.unique().tolist()
    ['psd']
    """
    if not slips:
        raise AnalysisError("there is no spectrum to draw")
    across = 2 if len(slips) == 4 else min(len(slips), 3)
    down = -(-len(slips) // across)
    with paper_style():
        figure = new_figure(DOUBLE_MM, 15.0 + 58.0 * down)
        grid = figure.subplots(down, across, squeeze=False)
        margins(figure, 15, 3, 11, 18, wspace=0.3, hspace=0.62)
        for axes, (label, (slip, number)) in zip(grid.flat, slips.items(), strict=False):
            _spectrum(figure, axes, label, slip, number)
        for axes in grid.flat[len(slips) :]:
            axes.remove()
        handles, words = grid.flat[0].get_legend_handles_labels()
        figure.legend(handles, words, loc="upper center", ncols=3, fontsize=7)
    return figure


def _spectrum(figure: PaperFigure, axes: Axes, label: str, slip: xr.Dataset, number: int) -> None:
    row = slip.isel(segment=number)
    name = "psd" if "psd" in row else "force_psd"
    f = row["frequency"].values
    known = np.isfinite(row[name].values)
    axes.plot(f[known], row[name].values[known], color=BLACK, label="measured")
    axes.plot(
        f[known], row[f"{name}_background"].values[known], color=ORANGE, label="red and white noise"
    )
    level = row[f"{name}_significant"].values[known]
    axes.plot(f[known], level, color=ORANGE, linestyle=":", label="chance of 1 in 1000")
    figure.keep(label, "psd", frequency_Hz=f[known], psd=row[name].values[known])
    logarithmic(axes, "x", "y")
    top = row[name].values[known].max()
    own = row["dominant_frequency"].item()
    if np.isfinite(own):
        axes.axvline(own, color=SKY, linewidth=0.8, zorder=0)
        wavelength = row["dominant_wavelength"].item() * 1e6
        axes.annotate(
            f"{own:.3g} Hz, {wavelength:.3g} µm",
            (own, top),
            xytext=(3, 2),
            textcoords="offset points",
            fontsize=7,
            color="#006699",
        )
    if np.isfinite(row["mains_frequency"].item()):
        axes.axvline(row["mains_frequency"].item(), color=PURPLE, linewidth=0.8, linestyle="--")
        axes.annotate(
            "mains",
            (row["mains_frequency"].item(), level.min()),
            xytext=(2, 2),
            textcoords="offset points",
            fontsize=7,
            color=PURPLE,
        )
    axes.set_ylim(top=top * 12)
    axes.set_xlabel("frequency $f$ (Hz)")
    unit = "N$^2$/Hz" if name == "force_psd" else "Hz$^{-1}$"
    axes.set_ylabel(f"power $S$ ({unit})")
    words = row["waveform"].item()
    if row["regularity"].item():
        words += f", {row['regularity'].item()}"
    axes.set_title(f"{plain(label)}\n{words}", fontsize=7, loc="left", pad=3)


def slip_events(slips: Mapping[str, xr.Dataset], surfaces: Sequence[str] = ()) -> PaperFigure:
    """Draw how drops, recurrence distances and durations of the events are distributed.

    Parameters
    ----------
    slips
        Label to a result of `stick_slip`; all its events count.
    surfaces
        Not used but for the order of colours.

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
    >>> len(slip_events({"dry": slip}).axes)
    3
    """
    shown = {label: slip for label, slip in slips.items() if slip.sizes.get("event", 0)}
    if not shown:
        raise AnalysisError("there is no event to draw")
    lines = [BLACK, SKY, ORANGE, PURPLE, GREY]
    with paper_style():
        figure = new_figure(DOUBLE_MM, 62.0)
        panels = figure.subplots(1, 3)
        margins(figure, 13, 3, 11, 10, wspace=0.3)
        for k, (label, slip) in enumerate(shown.items()):
            look = {"color": lines[k % len(lines)], "linestyle": "-" if k < len(lines) else "--"}
            for axes, (name, values) in zip(panels, _event_columns(slip).items(), strict=True):
                values = np.sort(values[np.isfinite(values)])
                share = np.arange(1, values.size + 1) / max(values.size, 1)
                axes.step(values, share, where="post", label=plain(label), **look)
                figure.keep(name, label, value=values, share=share)
        for axes, name in zip(panels, _event_columns(next(iter(shown.values()))), strict=True):
            axes.set_xlabel(name)
            axes.set_ylim(0, 1)
        panels[0].set_ylabel("share of the events")
        handles, words = panels[0].get_legend_handles_labels()
        figure.legend(handles, words, loc="upper center", ncols=4, fontsize=7)
    return figure


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


def waveform_map(curves: Mapping[str, xr.Dataset]) -> PaperFigure:
    """Draw the class of waveform of every condition at every speed, and how large the drops are.

    Parameters
    ----------
    curves
        Label to a result of `stick_slip_curve`, from below to above.

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
    if not curves:
        raise AnalysisError("there is no stick-slip to map")
    drops = np.concatenate([_drops(curve) for curve in curves.values()])
    largest = np.nanmax(np.append(drops[np.isfinite(drops)], 1e-12))
    with paper_style():
        figure = new_figure(DOUBLE_MM, 24.0 + 7.0 * len(curves))
        axes = figure.add_subplot()
        margins(figure, 42, 5, 11, 8)
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
            figure.keep("map", label, sliding_speed_m_s=v, drop=_drops(curve))
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
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1.02), ncols=5, fontsize=7)
    return figure


def _drops(curve: xr.Dataset) -> np.ndarray:
    nothing = np.full(curve.sizes["sliding_speed"], np.nan)
    return curve["drop"].values if "drop" in curve else nothing
