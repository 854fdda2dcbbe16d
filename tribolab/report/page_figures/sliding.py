"""Figures on stick-slip: waveforms, frequencies, and traces at the slowest speeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.wording import is_dry
from tribolab.figures.colours import surface_colours
from tribolab.figures.envelopes import envelope_index
from tribolab.figures.signals import LOOKED_AT, main_signal
from tribolab.figures.spec import (
    Axis,
    FigureSpec,
    Panel,
    Series,
    SeriesLabels,
    Style,
    Values,
    places,
)
from tribolab.figures.subjects.curves import SPEED_AXIS
from tribolab.figures.subjects.slip import cumulative
from tribolab.figures.subjects.slip_spectrum import power_levels
from tribolab.report.page_figures.curves import distinguish_media, labels_of
from tribolab.report.page_figures.waveforms import (
    Judged,
    condition_of,
    frequency_spec,
    system_of,
    waveform_spec,
)
from tribolab.report.plain import plain_speed
from tribolab.report.slowest import lowest_loads

_MIN_SPEED_RATIO = 1.2  # a spectrogram needs speeds that differ by more than this factor
_MAX_POINTS = 800  # most points of a trace
# line styles (in a liquid, dry) of the first quantity, and of the second one
_STYLES: tuple[tuple[Style, Style], ...] = (("line", "dashed"), ("dotted", "dashdot"))


def sliding_specs(
    judged: Sequence[Judged], surfaces: Sequence[str], folder: Path
) -> list[FigureSpec]:
    """Return the figures of the section on stick-slip; those without data are empty.

    Parameters
    ----------
    judged
        Curves with a sliding mode.
    surfaces
        All surfaces in the order of the campaign, which determines their colours.
    folder
        The results folder with the data files of the runs.
    """
    # a mode without recorded traces has no waveforms
    judged = [contact for contact in judged if any("waveform" in r for r in contact.mode.speeds)]
    colours = _colours(judged, surfaces)
    by_name = {contact.curve.name: contact for contact in judged}
    lowest = [by_name[curve.name] for curve in lowest_loads(contact.curve for contact in judged)]
    opened = [_opened(contact, colours, folder) for contact in lowest if contact.slow is not None]
    return [
        waveform_spec(judged),
        frequency_spec(judged, colours),
        _traces(opened),
        _spectra(opened),
        _events(opened),
        _spectrogram(opened),
    ]


def _colours(judged: Sequence[Judged], surfaces: Sequence[str]) -> dict[str, int]:
    """Return the colour of each curve: that of its surface, unless two curves would look alike."""
    curves = [contact.curve for contact in judged]
    # only one load per surface is shown; dry and wet differ in line style
    drawn = {(curve.surface, is_dry(curve.medium), system_of(curve)) for curve in curves}
    if len({key[:2] for key in drawn}) == len(drawn):
        of_surface = surface_colours([*surfaces, *(curve.surface for curve in curves)])
        return {curve.name: of_surface[curve.surface] for curve in curves}
    own = places(system_of(curve) for curve in curves)
    return {curve.name: own[system_of(curve)] for curve in curves}


class _Opened(NamedTuple):
    """Data of one condition, read from its file: slowest traces, and results on stick-slip."""

    name: str
    labels: SeriesLabels
    colour: int
    run: str
    traces: tuple[tuple[float, np.ndarray, np.ndarray], ...]
    slip: xr.Dataset
    segment: int

    def series(
        self,
        label: str,
        x: Values,
        y: Values,
        style: Style,
        *,
        high: Values = (),
        hover: str = "",
        link: Sequence[str] = (),
    ) -> Series:
        return Series(
            label,
            x,
            y,
            style,
            self.colour,
            high=high,
            hover=(hover,) if hover else (),
            link=link,
            **self.labels,
        )


def _opened(contact: Judged, colours: Mapping[str, int], folder: Path) -> _Opened:
    # imported late for a quick start
    from tribolab.reading.netcdf.netcdf import read_groups

    assert contact.slow is not None
    wanted = ("run", "segments", "friction", "stick_slip")
    groups = read_groups(folder / contact.slow.file, wanted, only={"run": LOOKED_AT})
    run, segments, friction, slip = groups.values()
    traces = tuple(
        (speed, *_trace(run, segments, friction, number)) for number, speed in contact.slow.segments
    )
    labels = labels_of(contact.curve)
    labels |= {"load": None, "runs": (contact.slow.run,)}
    colour = colours[contact.curve.name]
    first = contact.slow.segments[0][0]
    name = condition_of(contact.curve)
    return _Opened(name, labels, colour, contact.slow.run, traces, slip, first)


def _trace(
    run: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset, number: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return sliding distance [um] and friction in a segment without its trimmed ends."""
    time = np.asarray(run["time"], float)
    start, stop = (float(segments[f"trimmed_{end}"][number]) for end in ("start", "stop"))
    inside = np.flatnonzero((time >= start) & (time <= stop))
    values = np.asarray(main_signal(run, friction).values, float)[inside]
    sign = int(segments["direction"][number]) or 1
    kept = envelope_index(time[inside], values, _MAX_POINTS // 2)
    distance = 1e6 * float(segments["sliding_speed"][number]) * (time[inside] - start)
    return distance[kept], sign * values[kept]


def _media(opened: Sequence[_Opened]) -> list[str]:
    return [contact.labels["medium"] for contact in opened]


def _line_legend(opened: Sequence[_Opened], first: str, second: str) -> str:
    """Return a sentence that explains the line styles of two quantities, dry and in a liquid."""
    wet, dry = (
        f"{looked}: {first}; {other_dash}: {second}"
        for looked, other_dash in (("solid line", "dotted"), ("dashed", "dash-dotted"))
    )
    media = _media(opened)
    if not distinguish_media(media, "", ""):
        alone = dry if media and is_dry(media[0]) else wet
        return f"{alone[:1].upper()}{alone[1:]}."
    unnamed = " or a medium that is not named" if "" in media else ""
    return f"In a liquid{unnamed}, {wet}. Dry, {dry}."


# unit of distance, 1 µm in this unit, and the distance [µm] from which it is used
_DISTANCE_UNITS = (("m", 1e-6, 1e6), ("mm", 1e-3, 1e4), ("µm", 1.0, 0.0))


def _traces(opened: Sequence[_Opened]) -> FigureSpec:
    series = []
    longest = max((d[-1] for c in opened for _, d, _ in c.traces if d.size), default=0.0)
    unit, scale = next((u, s) for u, s, least in _DISTANCE_UNITS if longest >= least)
    for contact in opened:
        for number_, (speed, distance, values) in enumerate(contact.traces):
            style = _STYLES[number_ > 0][contact.labels["open"]]
            label, run = f"{contact.name}, {plain_speed(speed)}", (contact.run,)
            line = contact.series(
                contact.name, scale * distance, values, style, hover=label, link=run
            )
            series.append(line)
    return FigureSpec(
        "sliding-traces",
        "sliding",
        "Friction over sliding distance at the slowest speeds",
        _line_legend(opened, "slowest speed", "next speed")
        + " At the lowest load of each surface and medium.",
        "Friction over sliding distance, a line for each condition and speed.",
        (Panel(Axis("sliding distance", unit), Axis("friction coefficient µ")),),
        tuple(series),
    )


def _spectra(opened: Sequence[_Opened]) -> FigureSpec:
    series = []
    for contact in opened:
        if not contact.slip.sizes.get("frequency", 0):
            continue
        spectrum = contact.slip.isel(segment=contact.segment)
        f = spectrum["frequency"].values
        kept = np.isfinite(spectrum["psd"].values)
        of, noise = (style[contact.labels["open"]] for style in _STYLES)
        power, limit = (spectrum[name].values[kept] for name in ("psd", "psd_significant"))
        label = f"{contact.name}: limit of noise"
        series.append(contact.series(contact.name, f[kept], power, of))
        series.append(contact.series(contact.name, f[kept], limit, noise, hover=label))
    return FigureSpec(
        "sliding-spectra",
        "sliding",
        "Spectra of friction at the slowest speed",
        _line_legend(
            opened, "power", ("level that noise alone exceeds in one spectrum of a thousand")
        )
        + " A peak above that level is an oscillation.",
        "Power spectrum of the friction coefficient over frequency.",
        (Panel(Axis("frequency", "Hz", log=True), Axis("power spectrum of µ", "1/Hz", log=True)),),
        tuple(series),
    )


def _events(opened: Sequence[_Opened]) -> FigureSpec:
    series = []
    for contact in opened:
        if not contact.slip.sizes.get("event", 0):
            continue
        drops = contact.slip["event_drop"].values
        name = f"{contact.name}: {int(np.isfinite(drops).sum())} drops"
        series.append(contact.series(name, *cumulative(drops), _STYLES[0][contact.labels["open"]]))
    return FigureSpec(
        "sliding-events",
        "sliding",
        "Size of the drops",
        "Cumulative distribution of the drops of µ, all speeds of a run together. "
        + distinguish_media(_media(opened), "solid line", "dashed"),
        "Cumulative distribution of the drops of friction.",
        (Panel(Axis("drop of µ", log=True), Axis("share of drops below")),),
        tuple(series),
    )


def _spectrogram(opened: Sequence[_Opened]) -> FigureSpec:
    """Return a map of power relative to noise against speed and frequency; empty for one speed."""
    series: list[Series] = []
    low, high = np.inf, 0.0
    for contact in opened:
        levels = power_levels(contact.slip) if contact.slip.sizes.get("frequency", 0) else None
        if levels is None or not levels[0].size:
            continue
        speed, f, level = levels
        low, high = min(low, speed.min()), max(high, speed.max())
        series.append(contact.series(contact.name, speed, f, "heat", high=level))
    return FigureSpec(
        "sliding-spectrogram",
        "sliding",
        "Power relative to noise, over speed and frequency",
        " ".join(
            filter(
                None,
                (
                    "Only power of at least twice the noise is drawn.",
                    distinguish_media(_media(opened), "filled", "open"),
                    "Click on the legend to hide or show a condition." if len(series) > 1 else "",
                ),
            )
        ),
        "Ratio of the power spectrum to its noise over speed and frequency.",
        (Panel(SPEED_AXIS, Axis("frequency", "Hz", log=True)),),
        tuple(series) if high > _MIN_SPEED_RATIO * low else (),
    )
