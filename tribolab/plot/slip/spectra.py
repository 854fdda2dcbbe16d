"""The figure of the spectra of stick-slip, with their background and what would be significant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import plain
from tribolab.figures.look.frame import logarithmic
from tribolab.figures.look.guests import Panels, name_all, several_panels
from tribolab.figures.look.several import RunLabel, by_label
from tribolab.figures.look.style import (
    BLACK,
    DOUBLE_MM,
    ORANGE,
    PURPLE,
    SKY,
    PaperFigure,
    keep,
    margins,
    new_figure,
)


def slip_spectra(
    slips: Mapping[str, tuple[xr.Dataset, int]] | xr.Dataset | Sequence[xr.Dataset],
    *,
    segment: int = 0,
    axes: Panels | None = None,
    **labels: Sequence[RunLabel],
) -> Figure:
    """Draw the power spectra of segments with their background and what would be significant.

    Parameters
    ----------
    slips
        Label to a result of `stick_slip` and the number of its segment; or such a result, also over
        further dims; or a list of them.
    segment
        The number of the segment of results that come without one.
    axes
        The axes to draw in, one for each segment; they keep their look. Without
        them a figure is made.
    **labels
        What tells the results of a list apart, one label for each, e.g. ``run=["dry", "wet"]``.

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
    >>> len(slip_spectra([slip, slip], run=["dry", "wet"]).axes)
    2
    """
    drawn = _chosen(slips, segment, labels)
    if not drawn:
        raise AnalysisError("there is no spectrum to draw")
    with several_panels(axes, list(drawn), lambda: _grid(len(drawn))) as (figure, panels):
        for panel, (label, (slip, number)) in zip(panels, drawn.items(), strict=True):
            _spectrum(figure, panel, label, slip, number)
        if axes is None:
            handles, words = panels[0].get_legend_handles_labels()
            figure.legend(handles, words, loc="upper center", ncols=3, fontsize=7)
        else:
            name_all(panels[0])
    return figure


def _chosen(
    slips: Mapping[str, tuple[xr.Dataset, int]] | xr.Dataset | Sequence[xr.Dataset],
    segment: int,
    labels: Mapping[str, Sequence[RunLabel]],
) -> dict[str, tuple[xr.Dataset, int]]:
    """Return what to draw by its label."""
    if isinstance(slips, Mapping) and not isinstance(slips, xr.Dataset):
        return dict(slips)
    return {name: (slip, segment) for name, slip in by_label(slips, labels, "segment").items()}


def _grid(count: int) -> tuple[PaperFigure, list[Axes]]:
    across = 2 if count == 4 else min(count, 3)
    down = -(-count // across)
    figure = new_figure(DOUBLE_MM, 15.0 + 58.0 * down)
    grid = figure.subplots(down, across, squeeze=False)
    margins(figure, 15, 3, 11, 18, wspace=0.3, hspace=0.62)
    for axes in grid.flat[count:]:
        axes.remove()
    return figure, list(grid.flat[:count])


def _spectrum(figure: Figure, axes: Axes, label: str, slip: xr.Dataset, number: int) -> None:
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
    keep(figure, label, "psd", frequency_Hz=f[known], psd=row[name].values[known])
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
