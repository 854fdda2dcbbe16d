"""Figures of stick-slip: power spectra, and power against speed and frequency."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.figures.colours import BLACK, ORANGE, PURPLE, SKY
from tribolab.figures.labelled import RunLabel, by_label
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Mark, Panel, Series, Style
from tribolab.figures.subjects.curves import SPEED_AXIS

_HIGHEST, _LOWEST = 3.0, 0.3  # highest and lowest value of a map: log10(power / noise)
Slips = Mapping[str, tuple[xr.Dataset, int]] | xr.Dataset | Sequence[xr.Dataset]


@plotted(panels=0)
def slip_spectra(slips: Slips, *, segment: int = 0, **labels: Sequence[RunLabel]) -> FigureSpec:
    """Draw the power spectra of friction in segments, with the noise and its significance limit.

    One panel per segment. The dominant oscillation and the mains frequency are marked.

    Parameters
    ----------
    slips
        Results of `stick_slip` by label, each with the index of a segment; or one such result,
        perhaps with further dims; or a list of them.
    segment
        Index of the segment, for results that are given without one.
    **labels
        Labels that distinguish the results of a list, one for each, e.g. ``run=["dry", "wet"]``.

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
    ['measured', 'red and white noise', 'exceeded by noise in 1 of 1000 spectra']
    >>> len(slip_spectra([slip, slip], run=["dry", "wet"]).axes)
    2
    """
    if isinstance(slips, Mapping) and not isinstance(slips, xr.Dataset):
        drawn = dict(slips)
    else:
        drawn = {name: (one, segment) for name, one in by_label(slips, labels, "segment").items()}
    if not drawn:
        raise AnalysisError("there is no spectrum to draw")
    panels, series, marks = [], [], []
    for panel, (label, (slip, place)) in enumerate(drawn.items()):
        row = slip.isel(segment=place)
        name = "psd" if "psd" in row else "force_psd"
        known = np.isfinite(row[name].values)
        f = row["frequency"].values[known]
        lines: tuple[tuple[str, str, Style, int], ...] = (
            ("", "measured", "line", BLACK),
            ("_background", "red and white noise", "line", ORANGE),
            ("_significant", "exceeded by noise in 1 of 1000 spectra", "dotted", ORANGE),
        )
        for end, words, style, colour in lines:
            power = row[f"{name}{end}"].values[known]
            series.append(Series(words, f, power, style, colour, panel))
        for which, words, colour in (("dominant", "dominant", SKY), ("mains", "mains", PURPLE)):
            own = row[f"{which}_frequency"].item()
            if np.isfinite(own):
                marks.append(Mark("x", own, None, words, "dashed", colour, panel=panel))
        y = Axis("power spectrum", "N²/Hz" if name == "force_psd" else "1/Hz", log=True)
        panels.append(
            Panel(Axis("frequency f", "Hz", log=True), y, _heading(label, row), name=label)
        )
    return FigureSpec(
        title="Spectra of friction",
        note="A peak above the dotted line is an oscillation.",
        panels=tuple(panels),
        series=tuple(series),
        marks=tuple(marks),
        across=2 if len(panels) in (2, 4) else min(len(panels), 3),
    )


def _heading(label: str, row: xr.Dataset) -> str:
    """Return the heading of a panel: label, waveform and dominant frequency."""
    words = " ".join(filter(None, (str(row["regularity"].item()), str(row["waveform"].item()))))
    own = row["dominant_frequency"].item()
    return f"{label}: {words}" + (f", {own:.3g} Hz" if np.isfinite(own) else "")


@plotted(panels=0)
def slip_spectrogram(slips: Mapping[str, xr.Dataset]) -> FigureSpec:
    """Draw the ratio of power to noise against speed and frequency, a panel for each run.

    Only power of at least twice the noise is drawn. Crosses: dominant oscillation.

    Parameters
    ----------
    slips
        Results of `stick_slip` by label.

    Raises
    ------
    AnalysisError
        If no segment has a spectrum.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> slip = tl.stick_slip(run, tl.find_segments(run))
    >>> drawn = tl.plot.figure_data(slip_spectrogram({"dry": slip}))
    >>> drawn.panel.unique().tolist(), "log10_power_over_noise" in drawn
    (['dry'], True)
    """
    levels = {label: power_levels(slip) for label, slip in slips.items()}
    shown = {label: level for label, level in levels.items() if level is not None}
    if not shown:
        raise AnalysisError("no segment has a spectrum to draw")
    y = Axis("frequency f", "Hz", log=True, column="frequency_Hz")
    series = []
    for panel, (label, (speed, frequency, level)) in enumerate(shown.items()):
        columns = {"sliding_speed_m_s": speed, "frequency_Hz": frequency}
        columns["log10_power_over_noise"] = level
        heat = Series(label, speed, frequency, "heat", BLACK, panel, high=level, columns=columns)
        series.append(heat)
        slip = slips[label]
        dominant = slip["dominant_frequency"].values
        if np.isfinite(dominant).any():
            v = slip["sliding_speed"].values
            series.append(
                Series("dominant oscillation", v, dominant, "points", ORANGE, panel, open=True)
            )
    return FigureSpec(
        title="Ratio of power to noise over speed and frequency",
        note="Only power of at least twice the noise is drawn.",
        panels=tuple(Panel(SPEED_AXIS, y, label, name=label) for label in shown),
        series=tuple(series),
        across=min(len(shown), 2),
    )


def power_levels(slip: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return speed, frequency and log10(power / noise) wherever power exceeds twice the noise.

    None if no segment has a spectrum.
    """
    name = "psd" if "psd" in slip else "force_psd"
    if name not in slip or not np.isfinite(slip[name].values).any():
        return None
    forward = np.flatnonzero(slip["direction"].values >= 0)
    order = forward[np.argsort(slip["sliding_speed"].values[forward], kind="stable")]
    with np.errstate(invalid="ignore", divide="ignore"):
        level = np.log10((slip[name] / slip[f"{name}_background"]).values[order])
    speed = np.repeat(slip["sliding_speed"].values[order, None], level.shape[1], axis=1)
    frequency = np.broadcast_to(slip["frequency"].values, level.shape)
    kept = np.isfinite(level) & (level > _LOWEST)
    rounded = np.array([float(f"{v:.3g}") for v in level[kept]])
    return speed[kept], frequency[kept], np.minimum(rounded, _HIGHEST)
