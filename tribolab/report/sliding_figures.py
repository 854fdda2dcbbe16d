"""The figures of the section on the sliding mode."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribolab.friction.oscillation.waveform import oscillating
from tribolab.report.figure_files import DRAWING, save_figure
from tribolab.report.sliding import CurveSlip, condition
from tribolab.report.wording import with_error
from tribolab.words import many, number, span, speed_text

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from tribolab.campaign.outcome import Outcome
    from tribolab.plot.stick_slip import Trace

_SLOWEST = 2  # speeds of each condition that are stacked
_MOST_TRACES = 8
_MOST_SPECTRA = 6


@dataclass(frozen=True)
class SlipFigure:
    """One figure to draw into a results folder; it may travel to another process."""

    kind: str
    file: str
    title: str
    caption: str
    folder: Path
    surfaces: tuple[str, ...]
    shown: tuple[Any, ...]


def plan_sliding_figures(found: Sequence[CurveSlip], outcome: Outcome) -> list[SlipFigure]:
    """Plan what shows the traces: dry against wet by surface, spectra, events, and the map.

    Parameters
    ----------
    found
        Curves with the stick-slip of their runs.
    outcome
        What the campaign came to.
    """
    names = tuple(surface.name for surface in outcome.surfaces)
    lowest = _lowest(found)
    planned: list[tuple[str, str, str, str, tuple[Any, ...]]] = []
    stems = traces_stems(one.outcome.surface for one in lowest)
    for surface, stem in stems.items():
        title = f"{surface or 'Runs'}: friction over sliding distance"
        caption = f"{title}. The slowest speeds of each medium, shifted up to be told apart."
        mine = [one for one in lowest if one.outcome.surface == surface]
        shown = _stretches(mine, outcome)
        planned.append(("traces", stem, title, caption, shown))
    moving = [one for one in found if _moves(one)]
    shown = _slowest(moving or lowest)
    planned.append(("spectra", "slip_spectra", "Spectra of friction", _marked(shown), shown))
    runs = tuple((condition(one.outcome), next(iter(one.slips.values()))) for one in lowest)
    runs = tuple((label, slip) for label, slip in runs if slip.sizes.get("frequency", 0))
    runs = runs[:_MOST_SPECTRA]
    planned.append(("spectrogram", "slip_spectrogram", "Spectrograms", _SPECTROGRAM, runs))
    events = tuple((condition(one.outcome), next(iter(one.slips.values()))) for one in moving)
    events = tuple((label, slip) for label, slip in events if slip.sizes.get("event", 0))
    planned.append(("events", "slip_events", "Events", _EVENTS, events))
    curves = tuple((condition(o.outcome), o.curve) for o in found if o.curve.sizes["sliding_speed"])
    planned.append(("map", "slip_map", "Waveform at every speed", _MAP, curves))
    return [
        SlipFigure(kind, f"figures/{stem}.svg", title, caption, Path(outcome.folder), names, shown)
        for kind, stem, title, caption, shown in planned
        if shown
    ]


def traces_stems(surfaces: Iterable[str]) -> dict[str, str]:
    """Name the figure of each surface's traces: safe as a file's name, and no two alike.

    Examples
    --------
    >>> traces_stems(["Sand S", "Sb-R", "sand/s", ""])
    {'Sand S': 'slip_traces_sand_s', 'Sb-R': 'slip_traces_sb-r', 'sand/s': 'slip_traces_sand_s_2', \
'': 'slip_traces_runs'}
    """
    stems: dict[str, str] = {}
    for surface in dict.fromkeys(surfaces):
        safe = "".join(c if c.isalnum() or c in "-_" else "_" for c in surface.lower())
        stem, number = f"slip_traces_{safe or 'runs'}", 1
        while stem in stems.values():
            number += 1
            stem = f"slip_traces_{safe or 'runs'}_{number}"
        stems[surface] = stem
    return stems


_SPECTRA = (
    "Spectra of friction at the slowest speed. Orange: red and white noise, and the power that "
    "noise exceeds anywhere in one spectrum of a thousand."
)
_SPECTROGRAM = (
    "Spectrograms of one run of each condition at the lowest load: power over that of red and "
    "white noise, segment by segment. Dots: the dominant oscillation where one is claimed."
)
_EVENTS = "Events of one run of each condition, all speeds: share of events below a value."
_MAP = "Waveform at every speed. The larger a marker, the larger the mean drop of friction."


def _marked(shown: Sequence[tuple[str, xr.Dataset, int]]) -> str:
    """Return the caption of the spectra, with what is marked in them."""
    marks = {"dominant": "Blue: the strongest oscillation.", "mains": "Violet: the mains."}
    drawn = (
        text
        for name, text in marks.items()
        if any(np.isfinite(slip[f"{name}_frequency"][segment]) for _, slip, segment in shown)
    )
    return " ".join([_SPECTRA, *drawn])


def draw_sliding(task: SlipFigure) -> dict[str, str]:
    """Draw one figure into the results and return its record."""
    with DRAWING:
        figure, words = _KINDS[task.kind](task)
        alt = f"{task.title}. {words}."
        record = save_figure(figure, task.folder, task.file, task.caption, alt)
    return record | {"kind": task.kind}


def _lowest(found: Sequence[CurveSlip]) -> list[CurveSlip]:
    """Curves at the lowest load of their surface and medium."""
    best: dict[tuple[str, str], CurveSlip] = {}
    for one in found:
        key = one.outcome.surface, one.outcome.medium
        force = one.outcome.normal_force or 0.0
        if key not in best or force < (best[key].outcome.normal_force or 0.0):
            best[key] = one
    return list(best.values())


def _moves(one: CurveSlip) -> bool:
    """Whether stick-slip is claimed at any speed; a segment that stands alone is no claim."""
    return "waveform" in one.curve and bool(oscillating(one.curve["waveform"].values).any())


def _slow_segments(one: CurveSlip) -> tuple[str, list[int]]:
    """Name of the first run, and its forward segments at the slowest speeds."""
    for name, slip in one.slips.items():
        speed = slip["sliding_speed"].values
        forward = np.flatnonzero((slip["direction"].values >= 0) & (speed > 0))
        slowest = forward[np.argsort(speed[forward], kind="stable")]
        apart = []
        for k in slowest:
            if not apart or speed[k] > 1.2 * speed[apart[-1]]:
                apart.append(int(k))
        if apart:
            return name, apart[:_SLOWEST]
    return "", []


def _stretches(mine: Sequence[CurveSlip], outcome: Outcome) -> tuple[tuple[str, str, int], ...]:
    """Medium, data file and segment of what is stacked in one figure."""
    files = {run.name: run.data_file for run in outcome.runs}
    stack = []
    for one in mine:
        run, segments = _slow_segments(one)
        stack += [(one.outcome.medium or run, files[run], segment) for segment in segments]
    return tuple(stack[:_MOST_TRACES])


def _slowest(found: Sequence[CurveSlip]) -> tuple[tuple[str, xr.Dataset, int], ...]:
    """Condition with its slowest speed, stick-slip and segment."""
    chosen = []
    for one in found[:_MOST_SPECTRA]:
        run, segments = _slow_segments(one)
        for segment in segments[:1]:
            speed = speed_text(float(one.slips[run]["sliding_speed"][segment]))
            chosen.append((f"{speed}, {condition(one.outcome)}", one.slips[run], segment))
    return tuple(chosen)


def _traces(task: SlipFigure) -> tuple[Figure, str]:
    from tribolab import plot
    from tribolab.io.netcdf import read_groups

    stack: list[Trace] = []
    parts: dict[str, list[xr.Dataset]] = {}
    surface = task.title.partition(":")[0]
    for medium, file, segment in task.shown:
        if file not in parts:
            groups = read_groups(task.folder / file, ("run", "segments", "friction"))
            parts[file] = list(groups.values())
        speed = speed_text(float(parts[file][1]["sliding_speed"][segment]))
        stack.append(plot.Trace(f"{speed}, {medium}", *parts[file], segment, surface))
    return plot.slip_traces(stack, task.surfaces), "; ".join(_in_words(trace) for trace in stack)


def _in_words(trace: Trace) -> str:
    """Say what a trace shows: how much friction varies about its mean."""
    one = trace.friction.isel(segment=trace.segment)
    for name, what, unit in (("friction_coefficient", "µ", ""), ("friction_force", "F", " N")):
        if name in one:
            error = float(one[f"{name}_std"]) if f"{name}_std" in one else None
            return f"{trace.label}: {what} = {with_error(float(one[name]), error, unit)}"
    return trace.label


def _spectra(task: SlipFigure) -> tuple[Figure, str]:
    from tribolab import plot

    figure = plot.slip_spectra({label: (slip, segment) for label, slip, segment in task.shown})
    said = [f"{label}: {_strongest(slip, segment)}" for label, slip, segment in task.shown]
    return figure, "; ".join(said)


def _spectrogram(task: SlipFigure) -> tuple[Figure, str]:
    from tribolab import plot

    said = []
    for label, slip in task.shown:
        count = int(np.isfinite(slip["dominant_frequency"].values).sum())
        where = f"in {count} of {many(slip.sizes['segment'], 'segment')} an oscillation stands out"
        said.append(f"{label}: {where if count else 'no oscillation stands out'}")
    return plot.slip_spectrogram(dict(task.shown)), "; ".join(said)


def _events(task: SlipFigure) -> tuple[Figure, str]:
    from tribolab import plot

    said = [
        f"{label}: {many(slip.sizes['event'], 'event')}, "
        f"drops of µ from {span(slip['event_drop'].values)}"
        for label, slip in task.shown
    ]
    return plot.slip_events(dict(task.shown)), "; ".join(said)


def _map(task: SlipFigure) -> tuple[Figure, str]:
    from tribolab import plot

    said = [f"{label}: {_modes(curve)}" for label, curve in task.shown]
    return plot.waveform_map(dict(reversed(task.shown))), "; ".join(said)


def _strongest(slip: xr.Dataset, segment: int) -> str:
    """Say which oscillation of a segment stands out of the noise."""
    frequency = float(slip["dominant_frequency"][segment])
    if not np.isfinite(frequency):
        return "no oscillation stands out"
    return f"an oscillation at {number(frequency)} Hz stands out"


def _modes(curve: xr.Dataset) -> str:
    """Count the speeds of each waveform."""
    names, counts = np.unique(curve["waveform"].values.astype(str), return_counts=True)
    said = [f"{name} at {count}" for name, count in zip(names, counts, strict=True)]
    return ", ".join(said) + " of the speeds"


_KINDS = {
    "traces": _traces,
    "spectra": _spectra,
    "spectrogram": _spectrogram,
    "events": _events,
    "map": _map,
}
