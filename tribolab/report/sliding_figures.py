"""The figures of the section on the sliding mode."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.friction.waveform import CLASSES
from tribolab.plot.labels import number, speed_text
from tribolab.report.figure_files import save_figure
from tribolab.report.sliding import CurveSlip, condition
from tribolab.report.wording import span, with_error

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.outcome import Outcome
    from tribolab.plot.stick_slip import Trace

_SLOWEST = 2  # speeds of each condition that are stacked
_MOST_TRACES = 8
_MOST_SPECTRA = 6


def draw_sliding(found: Sequence[CurveSlip], outcome: Outcome) -> list[dict[str, str]]:
    """Draw what the traces show: dry against wet by surface, spectra, events, and the map.

    Parameters
    ----------
    found
        Curves with the stick-slip of their runs.
    outcome
        What the campaign came to.
    """
    folder, records = Path(outcome.folder), []
    names = [surface.name for surface in outcome.surfaces]
    lowest = _lowest(found)
    for surface in dict.fromkeys(one.outcome.surface for one in lowest):
        mine = [one for one in lowest if one.outcome.surface == surface]
        records += _traces(surface, mine, outcome, names, folder)
    shown = {condition(one.outcome): one for one in found if _moves(one)}
    records += _spectra(shown or {condition(one.outcome): one for one in lowest}, folder)
    if shown:
        records += _events(shown, folder)
    records += _map(found, folder)
    return records


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
    return "waveform" in one.curve and bool((one.curve["waveform"] != CLASSES[0]).any())


def _slow_segments(one: CurveSlip) -> list[tuple[str, int]]:
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
            return [(name, k) for k in apart[:_SLOWEST]]
    return []


def _traces(
    surface: str, mine: list[CurveSlip], outcome: Outcome, names: list[str], folder: Path
) -> list[dict[str, str]]:
    from tribolab import plot
    from tribolab.io.netcdf import read_netcdf

    files = {run.name: run.data_file for run in outcome.runs}
    stack: list[Trace] = []
    for one in mine:
        for run, segment in _slow_segments(one):
            parts = [
                read_netcdf(folder / files[run], group=group)
                for group in ("run", "segments", "friction")
            ]
            speed = speed_text(float(parts[1]["sliding_speed"][segment]))
            label = f"{one.outcome.medium or run}, {speed}"
            stack.append(plot.Trace(label, *parts, segment, surface))
    if not stack:
        return []
    title = f"{surface or 'Runs'}: friction over sliding distance"
    caption = f"{title}. The slowest speeds of each medium, shifted up to be told apart."
    figure = plot.slip_traces(stack[:_MOST_TRACES], names)
    stem = "".join(c if c.isalnum() or c in "-_" else "_" for c in surface.lower()) or "runs"
    file = f"figures/slip_traces_{stem}.svg"
    alt = f"{title}. " + "; ".join(_in_words(trace) for trace in stack[:_MOST_TRACES]) + "."
    return [save_figure(figure, folder, file, caption, alt) | {"kind": "traces"}]


def _in_words(trace: Trace) -> str:
    """Say what a trace shows: how much friction varies about its mean."""
    one = trace.friction.isel(segment=trace.segment)
    for name, what, unit in (("friction_coefficient", "µ", ""), ("friction_force", "F", " N")):
        if name in one:
            error = float(one[f"{name}_std"]) if f"{name}_std" in one else None
            return f"{trace.label}: {what} = {with_error(float(one[name]), error, unit)}"
    return trace.label


def _spectra(shown: dict[str, CurveSlip], folder: Path) -> list[dict[str, str]]:
    from tribolab import plot

    chosen = {}
    for label, one in list(shown.items())[:_MOST_SPECTRA]:
        for run, segment in _slow_segments(one)[:1]:
            speed = speed_text(float(one.slips[run]["sliding_speed"][segment]))
            chosen[f"{label}, {speed}"] = (one.slips[run], segment)
    if not chosen:
        return []
    caption = (
        "Spectra of friction at the slowest speed. Orange: red and white noise, and the power that "
        "noise exceeds anywhere in one spectrum of a thousand. Blue: the strongest oscillation."
    )
    figure = plot.slip_spectra(chosen)
    alt = "Spectra of friction. " + "; ".join(
        f"{label}: {_strongest(slip, segment)}" for label, (slip, segment) in chosen.items()
    )
    record = save_figure(figure, folder, "figures/slip_spectra.svg", caption, alt + ".")
    return [record | {"kind": "spectra"}]


def _events(shown: dict[str, CurveSlip], folder: Path) -> list[dict[str, str]]:
    from tribolab import plot

    slips = {label: next(iter(one.slips.values())) for label, one in shown.items()}
    if not any(slip.sizes.get("event", 0) for slip in slips.values()):
        return []
    caption = "Events of one run of each condition, all speeds: share of events below a value."
    figure = plot.slip_events(slips)
    alt = "Share of events below a value. " + "; ".join(
        f"{label}: {slip.sizes['event']} events, drops of µ from {span(slip['event_drop'].values)}"
        for label, slip in slips.items()
        if slip.sizes.get("event", 0)
    )
    record = save_figure(figure, folder, "figures/slip_events.svg", caption, alt + ".")
    return [record | {"kind": "events"}]


def _map(found: Sequence[CurveSlip], folder: Path) -> list[dict[str, str]]:
    from tribolab import plot

    curves = {
        condition(one.outcome): one.curve
        for one in reversed(found)
        if one.curve.sizes["sliding_speed"]
    }
    if not curves:
        return []
    caption = "Waveform at every speed. The larger a marker, the larger the mean drop of friction."
    figure = plot.waveform_map(curves)
    alt = "Waveform at every speed. " + "; ".join(
        f"{label}: {_modes(curve)}" for label, curve in reversed(curves.items())
    )
    record = save_figure(figure, folder, "figures/slip_map.svg", caption, alt + ".")
    return [record | {"kind": "map"}]


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
