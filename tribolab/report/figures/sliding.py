"""The figures of the section on the sliding mode."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab import plot
from tribolab.campaign.curves import SLIP
from tribolab.campaign.store.data_files import read_data
from tribolab.figures.signals import LOOKED_AT
from tribolab.friction.decisions.rejected import kept
from tribolab.reading.netcdf.netcdf import read_groups
from tribolab.records.mode_record import ModeRecord, condition
from tribolab.report.figures.files import Drawn
from tribolab.report.slowest import lowest_loads, slow_segments
from tribolab.words import many, number, span, speed_text

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from tribolab.campaign.store.outcome import Outcome
    from tribolab.plot.slip.stick_slip import Trace
    from tribolab.records.parts import CurveOutcome

_MOST_TRACES = 8
_MOST_SPECTRA = 6


class Shown(NamedTuple):
    """What a figure shows of one condition: its label, a data file, and a segment in it."""

    label: str
    data_file: str
    segment: int = -1


@dataclass(frozen=True)
class SlipFigure:
    """One figure to draw."""

    kind: str
    name: str
    title: str
    caption: str
    surfaces: tuple[str, ...]
    shown: tuple[Shown, ...]

    @property
    def file(self) -> str:
        """Path of the figure relative to the results folder."""
        return f"figures/{self.name}.svg"

    @property
    def files(self) -> tuple[str, ...]:
        """Data files that it reads."""
        return tuple(dict.fromkeys(slip.data_file for slip in self.shown))


def plan_sliding_figures(
    curves: Sequence[CurveOutcome], modes: Mapping[str, ModeRecord], outcome: Outcome
) -> list[SlipFigure]:
    """Plan what shows the traces: dry against wet by surface, spectra, events, and the map.

    Parameters
    ----------
    curves
        Measured curves.
    modes
        How they slide, by the curve's name.
    outcome
        What the campaign came to.
    """
    names = tuple(surface.name for surface in outcome.surfaces)
    files = {run.name: run.data_file for run in outcome.runs if run.done}
    lowest = lowest_loads(curves)
    slow = {curve.name: slow_segments(curve, outcome) for curve in lowest}
    moving = [c for c in curves if c.name in modes and modes[c.name].moves]
    slow |= {c.name: slow_segments(c, outcome) for c in moving if c.name not in slow}
    first = {c.name: files[c.run_names[0]] for c in curves if c.run_names[0] in files}
    planned: list[tuple[str, str, str, str, list[Shown]]] = []
    for surface, stem in traces_stems(curve.surface for curve in lowest).items():
        title = f"{surface or 'Runs'}: friction over sliding distance"
        caption = f"{title}. The slowest speeds of each medium, shifted by what stands beside them."
        shown = [
            Shown(curve.medium or known.run, known.file, segment)
            for curve in lowest
            if curve.surface == surface and (known := slow[curve.name])
            for segment, _ in known.segments
        ]
        planned.append(("traces", stem, title, caption, shown[:_MOST_TRACES]))
    spectra = [
        Shown(f"{speed_text(speed)}, {condition(curve)}", known.file, segment)
        for curve in (moving or lowest)[:_MOST_SPECTRA]
        if (known := slow[curve.name])
        for segment, speed in known.segments[:1]
    ]
    planned.append(("spectra", "slip_spectra", "Spectra of friction", _SPECTRA, spectra))
    runs = [Shown(condition(c), first[c.name]) for c in lowest if c.name in first]
    planned.append(("spectrogram", "slip_spectrogram", "Spectrograms", _SPECTROGRAM, runs))
    events = [Shown(condition(c), first[c.name]) for c in moving if c.name in first]
    planned.append(("events", "slip_events", "Events", _EVENTS, events))
    every = [Shown(condition(curve), curve.data_file) for curve in curves if curve.name in modes]
    planned.append(("map", "slip_map", "Waveform at every speed", _MAP, every))
    return [
        SlipFigure(kind, stem, title, caption, names, tuple(shown))
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


def draw_sliding(what: SlipFigure, folder: Path) -> Drawn | None:
    """Draw one figure on how contacts slide; None where the runs show nothing of it."""
    drawn = _KINDS[what.kind](what, folder)
    if drawn is None:
        return None
    figure, words, marks = drawn
    caption = " ".join([what.caption, *marks])
    return Drawn(figure, caption, f"{what.title}. {words}.", what.kind)


Made = tuple["Figure", str, list[str]]


def _slips(what: SlipFigure, folder: Path, group: str = "stick_slip") -> list[xr.Dataset]:
    return [read_data(folder / trace.data_file, group=group) for trace in what.shown]


def _traces(what: SlipFigure, folder: Path) -> Made:
    stack: list[Trace] = []
    opened: dict[str, list[xr.Dataset]] = {}
    surface = what.title.partition(":")[0]
    for medium, file, segment in what.shown:
        if file not in opened:
            wanted = ("run", "segments", "friction")
            groups = read_groups(folder / file, wanted, only={"run": LOOKED_AT})
            opened[file] = list(groups.values())
        run, segments, friction = opened[file]
        speed = speed_text(float(segments["sliding_speed"][segment]))
        label = f"{speed}, {medium}"
        stack.append(plot.Trace(label, run, segments, friction, segment, surface))
    return plot.slip_traces(stack, what.surfaces), "; ".join(map(_in_words, stack)), []


def _in_words(trace: Trace) -> str:
    """Say what a trace shows: how much friction varies about its mean."""
    if trace.friction is None:
        return trace.label
    mean = trace.friction.isel(segment=trace.segment)
    for name, what, unit in (("friction_coefficient", "µ", ""), ("friction_force", "F", " N")):
        if name in mean:
            text = f"{trace.label}: {what} = {number(float(mean[name]))}{unit}"
            if f"{name}_std" in mean:
                text += f" (standard deviation {number(float(mean[f'{name}_std']), 2)}{unit})"
            return text
    return trace.label


def _spectra(what: SlipFigure, folder: Path) -> Made:
    shown = [(trace, slip) for trace, slip in zip(what.shown, _slips(what, folder), strict=True)]
    figure = plot.slip_spectra({trace.label: (slip, trace.segment) for trace, slip in shown})
    said = [f"{trace.label}: {_strongest(slip, trace.segment)}" for trace, slip in shown]
    marks = {"dominant": "Blue: the strongest oscillation.", "mains": "Violet: the mains."}
    drawn = [
        text
        for name, text in marks.items()
        if any(np.isfinite(slip[f"{name}_frequency"][trace.segment]) for trace, slip in shown)
    ]
    return figure, "; ".join(said), drawn


def _with(what: SlipFigure, slips: Sequence[xr.Dataset], dim: str) -> dict[str, xr.Dataset]:
    """Return what has something along a dimension, by its label."""
    pairs = zip(what.shown, slips, strict=True)
    return {trace.label: kept(slip) for trace, slip in pairs if kept(slip).sizes.get(dim, 0)}


def _spectrogram(what: SlipFigure, folder: Path) -> Made | None:
    shown = dict(list(_with(what, _slips(what, folder), "frequency").items())[:_MOST_SPECTRA])
    if not shown:
        return None
    said = []
    for label, slip in shown.items():
        count = int(np.isfinite(slip["dominant_frequency"].values).sum())
        where = f"in {count} of {many(slip.sizes['segment'], 'segment')} an oscillation stands out"
        said.append(f"{label}: {where if count else 'no oscillation stands out'}")
    return plot.slip_spectrogram(shown), "; ".join(said), []


def _events(what: SlipFigure, folder: Path) -> Made | None:
    shown = _with(what, _slips(what, folder), "event")
    if not shown:
        return None
    said = [
        f"{label}: {many(slip.sizes['event'], 'event')}, "
        f"drops of µ from {span(slip['event_drop'].values)}"
        for label, slip in shown.items()
    ]
    return plot.slip_events(shown), "; ".join(said), []


def _map(what: SlipFigure, folder: Path) -> Made | None:
    found = _with(what, _slips(what, folder, SLIP), "sliding_speed")
    # where no speed could be judged there is none to show
    shown = {label: curve for label, curve in found.items() if "waveform" in curve}
    if not shown:
        return None
    said = [f"{label}: {_modes(curve)}" for label, curve in shown.items()]
    return plot.waveform_map(dict(reversed(shown.items()))), "; ".join(said), []


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


_KINDS: dict[str, Callable[[SlipFigure, Path], Made | None]] = {
    "traces": _traces,
    "spectra": _spectra,
    "spectrogram": _spectrogram,
    "events": _events,
    "map": _map,
}
