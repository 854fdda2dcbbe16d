"""Figures of the waveform and the dominant frequency of friction at each sliding speed."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.wording import force_text, number
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series
from tribolab.figures.subjects.curves import SPEED_AXIS
from tribolab.figures.subjects.slip import waveform_map
from tribolab.records.models.mode_record import ModeRecord
from tribolab.records.parts import CurveOutcome
from tribolab.report.page_figures.curves import labels_of, system_name
from tribolab.report.plain import plain_speed
from tribolab.report.slowest import Slow

_UNDECIDED = "not decided"
_STEADY = frozenset({"smooth sliding", _UNDECIDED})


class Judged(NamedTuple):
    """A measured curve, its sliding mode, and its slowest segments if they are known."""

    curve: CurveOutcome
    mode: ModeRecord
    slow: Slow | None


def system_of(curve: CurveOutcome) -> str:
    """Return the surface and medium of a curve as one name; without both, its runs."""
    return system_name(curve.surface, curve.medium, curve.run_names)


def condition_of(curve: CurveOutcome) -> str:
    """Return the surface, medium and load of a curve as one name."""
    name = system_of(curve)
    return name if curve.normal_force is None else f"{name}, {force_text(curve.normal_force)}"


def waveform_spec(judged: Sequence[Judged]) -> FigureSpec:
    """Return a map of the waveform of each condition at each speed; empty without data."""
    if not judged:
        return FigureSpec()
    curves = {condition_of(contact.curve): _waveform_curve(contact) for contact in judged}
    spec = waveform_map.spec(curves)
    waveforms = {str(row["waveform"]) for contact in judged for row in contact.mode.speeds}
    return replace(
        spec,
        id="sliding-waveforms",
        section="sliding",
        note=_waveform_note(waveforms),
        alt="Class of waveform of each condition at each sliding speed.",
        height=140 + 26 * len(judged),
    )


def _waveform_curve(contact: Judged) -> xr.Dataset:
    """Return the waveforms and drops of a curve for the map, as a dataset (sliding_speed)."""
    rows = contact.mode.speeds
    drops = [np.nan if row["drop"] is None else row["drop"] for row in rows]
    columns = {
        "waveform": [str(row["waveform"]) for row in rows],
        "drop": np.array(drops, float),
        "hover": [_waveform_tooltip(contact, row) for row in rows],
        "link": [contact.curve.run_names[0]] * len(rows),
    }
    labels = labels_of(contact.curve)
    return xr.Dataset(
        {name: ("sliding_speed", values) for name, values in columns.items()},
        {"sliding_speed": [row["sliding_speed_m_s"] for row in rows]},
        {
            "surface": labels["surface"],
            "medium": labels["medium"],
            "normal_force_N": labels["load"],
            "runs": labels["runs"],
        },
    )


def _waveform_note(waveforms: Collection[str]) -> str:
    if set(waveforms) <= _STEADY:
        return "Class for each condition and speed."
    undecided = " or not decided" if _UNDECIDED in waveforms else ""
    return f"Open: steady sliding{undecided}; filled: friction rises and falls."


def _waveform_tooltip(contact: Judged, row: Mapping[str, Any]) -> str:
    lines = [condition_of(contact.curve), f"v = {plain_speed(row['sliding_speed_m_s'])}"]
    lines.append(" ".join(filter(None, (row["regularity"], row["waveform"]))))
    if row["drop"] is not None:
        lines.append(f"µ drops by {number(row['drop'])} on average")
    if row["recurrence_distance_m"] is not None:
        lines.append(f"every {number(1e6 * row['recurrence_distance_m'])} µm")
    return "\n".join(lines)


def frequency_spec(judged: Sequence[Judged], colours: Mapping[str, int]) -> FigureSpec:
    """Return a figure of the frequency of the strongest oscillation against sliding speed."""
    series = []
    for contact in judged:
        rows = [row for row in contact.mode.speeds if row["dominant_frequency_Hz"]]
        if rows:
            series.append(
                Series(
                    system_of(contact.curve),
                    [row["sliding_speed_m_s"] for row in rows],
                    [row["dominant_frequency_Hz"] for row in rows],
                    style="points",
                    colour=colours[contact.curve.name],
                    hover=[_waveform_tooltip(contact, row) for row in rows],
                    link=(contact.curve.run_names[0],),
                    **labels_of(contact.curve),
                )
            )
    return FigureSpec(
        "sliding-frequencies",
        "sliding",
        "Frequency of the strongest oscillation",
        "With a fixed slip distance, the frequency is proportional to the speed. A resonance "
        "keeps its frequency.",
        "Dominant frequency over sliding speed.",
        (Panel(SPEED_AXIS, Axis("frequency", "Hz", log=True)),),
        tuple(series),
    )
