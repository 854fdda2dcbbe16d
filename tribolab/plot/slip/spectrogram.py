"""The spectrogram of a run: what oscillates in which of its segments."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import plain
from tribolab.figures.look.decades import power_of_ten
from tribolab.figures.look.frame import logarithmic
from tribolab.figures.look.guests import Panels, several_panels
from tribolab.figures.look.style import BLACK, DOUBLE_MM, PaperFigure, keep, margins, new_figure
from tribolab.untyped import Arguments
from tribolab.words import speed_text

_LOUDEST = 1e3  # times the background; what is above has the same colour
_LABELS = 7  # speeds that are written below a panel


def slip_spectrogram(slips: Mapping[str, xr.Dataset], *, axes: Panels | None = None) -> Figure:
    """Draw the spectra of all segments of a run side by side, in their order of time.

    Parameters
    ----------
    slips
        Label to a result of `stick_slip`.
    axes
        The axes to draw in, one for each run that has a spectrum; they keep their look. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each run: frequency over the segment's number, with its speed; the colour is the
        power over that of the red and white noise. Dots: the dominant oscillation.

    Raises
    ------
    AnalysisError
        If no segment has a spectrum.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> slip = tl.stick_slip(run, tl.find_segments(run))
    >>> tl.plot.figure_data(slip_spectrogram({"dry": slip})).panel.unique().tolist()
    ['dry']
    """
    shown = {label: slip for label, slip in slips.items() if _ratio(slip).size}
    if not shown:
        raise AnalysisError("no segment has a spectrum to draw")
    with several_panels(axes, list(shown), lambda: _grid(len(shown))) as (figure, panels):
        for panel, (label, slip) in zip(panels, shown.items(), strict=True):
            ratio, frequency = _ratio(slip), slip["frequency"].values
            number = slip["segment"].values + 1
            edges = _edges(np.log(frequency))
            image = panel.pcolormesh(
                np.append(number - 0.5, number[-1] + 0.5), np.exp(edges), ratio.T,
                norm=LogNorm(1.0, _LOUDEST), cmap="cividis", rasterized=True,
            )  # fmt: skip
            own = slip["dominant_frequency"].values
            panel.plot(number, own, "o", markersize=2.5, color="white", markeredgecolor=BLACK)
            keep(figure, 
                label, "power over background",
                segment=np.repeat(number, frequency.size),
                frequency_Hz=np.tile(frequency, number.size),
                ratio=ratio.ravel(),
            )  # fmt: skip
            logarithmic(panel, "y", small=False)
            some = np.unique(np.linspace(0, number.size - 1, _LABELS).round().astype(int))
            speeds = [speed_text(float(slip["sliding_speed"].values[k])) for k in some]
            panel.set_xticks(
                number[some],
                [f"{n}\n{_stacked(v)}" for n, v in zip(number[some], speeds, strict=True)],
            )
            panel.tick_params(axis="x", labelsize=6)
            panel.set_xlabel("number and speed of the segment")
            panel.set_ylabel("frequency $f$ (Hz)")
            panel.set_title(plain(label), fontsize=7, loc="left", pad=3)
        if axes is None:
            width = 1 - 22 / DOUBLE_MM
            place: Arguments = {"cax": figure.add_axes((width, 0.25, 0.015, 0.5))}
        else:
            place = {"ax": panels}
        words = "power over background $S/S_0$"
        figure.colorbar(image, **place, label=words, format=power_of_ten).minorticks_off()
    return figure


def _grid(count: int) -> tuple[PaperFigure, list[Axes]]:
    across = 2 if count > 1 else 1
    down = -(-count // across)
    figure = new_figure(DOUBLE_MM, 14.0 + 60.0 * down)
    grid = figure.subplots(down, across, squeeze=False)
    margins(figure, 15, 26, 18, 8, wspace=0.25, hspace=0.55)
    for axes in grid.flat[count:]:
        axes.remove()
    return figure, list(grid.flat[:count])


def _ratio(slip: xr.Dataset) -> np.ndarray:
    """Power over background (segment, frequency); NaN where a segment has no spectrum."""
    name = "psd" if "psd" in slip else "force_psd"
    if name not in slip or not np.isfinite(slip[name].values).any():
        return np.zeros((0, 0))
    return slip[name].values / slip[f"{name}_background"].values


def _edges(middle: np.ndarray) -> np.ndarray:
    if middle.size == 1:
        return middle[0] + np.array([-0.05, 0.05])
    inner = 0.5 * (middle[1:] + middle[:-1])
    return np.concatenate([[2 * middle[0] - inner[0]], inner, [2 * middle[-1] - inner[-1]]])


def _stacked(speed: str) -> str:
    return speed.replace(" ", "\n", 1)
