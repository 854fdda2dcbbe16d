"""Figure of the friction of a run against time and distance, with its segments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from tribolab.core.wording import speed_text
from tribolab.figures.colours import BLACK, GREY, ORANGE, SKY, VERMILLION
from tribolab.figures.envelopes import envelope
from tribolab.figures.labels import column
from tribolab.figures.plotted import plotted
from tribolab.figures.signals import Signal, Stroke, main_signal, strokes_of
from tribolab.figures.spec import Axis, FigureSpec, Mark, Panel, Series, axis_of

_COLUMNS = 420  # columns of a panel in which extremes of a signal are drawn
_MOTION = {"sliding_velocity": "velocity", "set_speed": "set speed", "position": "position"}
# colours of directions, distinct from those of surfaces
SHADES = {1: (GREY, "forward"), -1: (ORANGE, "backward"), 0: (SKY, "direction unknown")}
MEAN = VERMILLION
_MAX_MARKED = 60  # largest number of segments that are shaded one by one
_ROOM = 0.2  # space for labels above a trace, as share of the range of the trace


def friction_axis(name: str) -> Axis:
    """Return the ordinate for the friction coefficient or the friction force of a run."""
    if name == "friction_coefficient":
        paper = "friction coefficient\n" + r"$\mu = F_x/F_{\mathrm{N}}$"
        return Axis("friction coefficient µ", paper=paper, column=name)
    return Axis("friction force", "N", paper="friction force\n$F_x$", column=column(name))


@plotted(panels=0)
def trace(
    run: xr.Dataset, segments: xr.Dataset | None = None, friction: xr.Dataset | None = None
) -> FigureSpec:
    """Draw friction in a run against time and sliding distance, with its segments shaded.

    Panels: friction coefficient (or force, if no load was recorded) against time; sliding velocity
    (else set speed or position) against time; friction against the distance slid in the segments.
    Missing or constant signals have no panel.

    Parameters
    ----------
    run
        A run (time).
    segments
        Its segments (segment); the trimmed ends are shaded more lightly. None for the signals
        alone.
    friction
        Its friction result (segment): the mean of every segment is drawn, and the offset is removed
        from the trace.

    Raises
    ------
    AnalysisError
        If the run has neither a friction force nor a friction coefficient.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4, 1e-3)))
    >>> run = rig.simulate_run("Sb-S", "dry", rig=short).noise_free
    >>> segments = tl.find_segments(run)
    >>> friction = tl.friction_coefficient(run, segments)
    >>> figure = trace(run, segments, friction, title="Sb-S, dry")
    >>> tl.plot.figure_data(figure).panel.unique().tolist()
    ['time', 'motion', 'distance']
    """
    signal = main_signal(run, friction)
    parts = [] if segments is None else strokes_of(run, segments)
    time = np.asarray(run["time"], float)
    time_axis = axis_of("time", "time")
    motion = next((n for n in _MOTION if n in run and np.ptp(np.asarray(run[n], float)) != 0), "")
    y = friction_axis(signal.name)
    if parts:  # space for the speeds, which are written above the trace
        low, high = np.nanmin(signal.values), np.nanmax(signal.values)
        y = replace(y, include=(float(high + _ROOM * (high - low)),))
    panels = [Panel(time_axis, y, name="time")]
    x, short = envelope(time, signal.values, _COLUMNS)
    series = [Series("", x, short, colour=BLACK, thin=True, name="trace")]
    marks: list[Mark] = []
    if motion:
        values = np.asarray(run[motion], float)
        series.append(
            Series(
                "", *envelope(time, values, _COLUMNS), colour=BLACK, panel=1, thin=True, name=motion
            )
        )
        panels.append(
            Panel(time_axis, _motion_axis(motion, values, segments), height=0.6, name="motion")
        )
    if segments is not None:
        places = [_ends(part.number, segments) for part in parts]
        for panel in range(len(panels)):
            marks += _shaded(parts, places, panel, named=panel == 0)
        series += _means(parts, [inner for _, inner in places], signal, friction, 0)
    if parts and np.isfinite([part.speed for part in parts]).all():
        more, shades = _over_distance(parts, signal, friction, len(panels))
        series += more
        marks += shades
        words = "sliding distance in the segments, in sequence"
        distance = Axis(words, "m", paper=r"sliding distance $s$ in the segments, in sequence",
                        column=column("sliding_distance"))  # fmt: skip
        panels.append(Panel(distance, y, name="distance"))
    return FigureSpec(
        title="Trace",
        note="Shaded: segments, their trimmed ends lighter; red: mean of each segment.",
        panels=tuple(panels),
        series=tuple(series),
        marks=tuple(marks),
        width="whole",
    )


def _motion_axis(name: str, values: np.ndarray, segments: xr.Dataset | None) -> Axis:
    """Return the ordinate of a motion signal; for a speed, it is logarithmic except near zero."""
    largest = float(np.nanmax(np.abs(values), initial=0.0))
    speeds = np.zeros(0) if segments is None else np.asarray(segments["sliding_speed"], float)
    speeds = speeds[np.isfinite(speeds) & (speeds > 0)]
    slowest = min(float(speeds.min()) if speeds.size else largest / 100, largest)
    below = slowest if name != "position" and largest > 0 else None
    return axis_of(name, _MOTION[name], linear_below=below)


Span = tuple[float, float]


def _ends(number: int, segments: xr.Dataset) -> tuple[Span, Span]:
    """Return start and stop [s] of a segment, and those of its part between the trimmed ends."""
    row = segments.isel(segment=number)
    ends = [float(row[n]) for n in ("start", "stop", "trimmed_start", "trimmed_stop")]
    return (ends[0], ends[1]), (ends[2], ends[3])


def _shaded(
    parts: Sequence[Stroke], places: Sequence[tuple[Span, Span]], panel: int, *, named: bool
) -> list[Mark]:
    """Return the shading of up to 60 segments: dark, with light trimmed ends."""
    marks = []
    last = ""
    every = max(1, -(-len(parts) // _MAX_MARKED))
    for k in range(0, len(parts), every):
        (start, stop), (inner, outer) = places[k]
        colour, direction = SHADES[int(np.sign(parts[k].direction))]
        words = _segment_text(parts[k])
        above = words if named and words != last else ""
        last = words
        marks.append(Mark("x", start, stop, "trimmed", colour=colour, opacity=0.08, panel=panel))
        marks.append(
            Mark(
                "x", inner, outer, direction, colour=colour, opacity=0.14, panel=panel, above=above
            )
        )
    return marks


def _segment_text(part: Stroke) -> str:
    return speed_text(part.speed) if np.isfinite(part.speed) else f"no. {part.number + 1}"


def _means(
    parts: Sequence[Stroke], spans: Sequence[Span], signal: Signal, friction: xr.Dataset | None,
    panel: int,
) -> list[Series]:  # fmt: skip
    """Return lines at the mean friction of each segment, negative in backward strokes."""
    if friction is None or signal.name not in friction or not parts:
        return []
    mean = np.asarray(friction[signal.name], float)[[part.number for part in parts]]
    if signal.name == "friction_coefficient":
        directions = np.array([part.direction for part in parts])
        mean = mean * np.where(directions == 0, 1, directions)
    ends = np.array(spans, float)
    gap = np.full(mean.size, np.nan)
    x, y = np.c_[ends[:, 0], ends[:, 1], gap].ravel(), np.c_[mean, mean, gap].ravel()
    return [Series("mean", x, y, colour=MEAN, panel=panel, columns={})]


def _over_distance(
    parts: Sequence[Stroke], signal: Signal, friction: xr.Dataset | None, panel: int
) -> tuple[list[Series], list[Mark]]:
    lengths = np.array([part.distance[-1] for part in parts])
    begins = np.r_[0.0, np.cumsum(lengths)[:-1]]
    budget = max(20, _COLUMNS // len(parts))
    series, places = [], []
    for begin, length, part in zip(begins, lengths, parts, strict=True):
        x, y = envelope(part.distance, signal.values[part.samples], budget)
        series.append(
            Series(
                "",
                begin + x,
                y,
                colour=BLACK,
                panel=panel,
                thin=True,
                name=f"segment {part.number}",
            )
        )
        inner = (begin + part.trimmed[0], begin + part.trimmed[1])
        places.append(((begin, begin + length), inner))
    series += _means(parts, [inner for _, inner in places], signal, friction, panel)
    return series, _shaded(parts, places, panel, named=True)
