"""What moves a model Stribeck curve most: its band, and a bar for each thing that is not known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.figures.labels import label, plain
from tribolab.figures.look.frame import logarithmic, shaded_band
from tribolab.figures.look.guests import Panels, name_all, name_panel, several_panels
from tribolab.figures.look.style import (
    BLUE,
    DOUBLE_MM,
    GREY,
    ORANGE,
    PaperFigure,
    keep,
    margins,
    new_figure,
    surface_styles,
    tidy,
)

_HEIGHT = 70.0


def model_sensitivity(
    uncertainty: xr.Dataset,
    *,
    surface: str = "",
    surfaces: Sequence[str] = (),
    title: str = "",
    axes: Panels | None = None,
) -> Figure:
    """Draw the band of a model curve and, beside it, how far each unknown moves the curve.

    Parameters
    ----------
    uncertainty
        From `tribolab.model_uncertainty`.
    surface, surfaces
        Its name, and all names of the study in their order, for the colour.
    title
        Text above the figure.
    axes
        The axes to draw in, for the band and for the bars; they keep their look. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Bars: the largest change of mu over all speeds, up and down, over the height of the curve,
        for the low and the high end of each range; the longest on top.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> given = {"viscosity": 1.4, "load": 310.0, "shear_stress": 0.0}
    >>> spread = tl.model_uncertainty(xu2026.contact, None, speed=[1e-3, 1e-1], cells=100, **given)
    >>> tl.plot.figure_data(model_sensitivity(spread)).panel.unique().tolist()
    ['band', 'bars']
    """
    colour = surface_styles([*surfaces, surface])[surface].colour
    v, mu = (uncertainty[name].values for name in ("sliding_speed", "friction_coefficient"))
    with several_panels(axes, ("band", "bars"), _two) as (figure, (left, right)):
        low, high = (uncertainty[f"friction_coefficient_{end}"].values for end in ("low", "high"))
        shaded_band(left, v, low, high, colour)
        left.plot(v, mu, color=colour, linewidth=1.2, label=plain(f"model {surface}".strip()))
        numbers = {"friction_coefficient": mu, "friction_coefficient_low": low}
        keep(
            figure, "band", "model", sliding_speed_m_s=v, **numbers, friction_coefficient_high=high
        )
        logarithmic(left, "x", "y")
        left.set_xlim(v.min(), v.max())
        left.set_xlabel(label("sliding_speed"))
        left.set_ylabel(label("friction_coefficient"))
        tidy(left)
        _bars(figure, right, uncertainty, mu)
        if axes is not None:
            name_all(left)
            name_panel(left, title)
            return figure
        margins(figure, 15, 3, 10.5, 7.5 if title else 3.5, wspace=0.62)
        if title:
            figure.text(15 / DOUBLE_MM, 1 - 1.0 / _HEIGHT, plain(title), va="top", fontsize=8)
    return figure


def _two() -> tuple[PaperFigure, list[Axes]]:
    figure = new_figure(DOUBLE_MM, _HEIGHT)
    return figure, list(figure.subplots(1, 2))


def _bars(figure: Figure, axes: Axes, uncertainty: xr.Dataset, mu: np.ndarray) -> None:
    names = uncertainty["variation"].values
    change = 100 * (uncertainty["friction_coefficient_varied"].values - mu) / mu.max()
    known = np.isfinite(change).any(axis=-1)
    filled = np.nan_to_num(change)
    place = np.argmax(np.abs(filled), axis=-1)[..., None]
    most = np.take_along_axis(filled, place, axis=-1)[..., 0]  # signed, (variation, end)
    order = np.argsort(np.abs(most).max(axis=1))
    y = np.arange(names.size)
    reach = 1.08 * np.abs(most).max() or 1.0
    for end, (colour, shift) in enumerate(((BLUE, 0.19), (ORANGE, -0.19))):
        text = ("low end", "high end")[end]
        axes.barh(y + shift, most[order, end], 0.36, color=colour, label=text)
        keep(
            figure,
            "bars",
            text,
            variation=names[order],
            change_percent=np.where(known[order, end], most[order, end], np.nan),
        )
    axes.axvline(0, color=GREY, linewidth=0.6)
    axes.set_xlim(-reach, reach)
    axes.set_yticks(y, [plain(str(name)) for name in names[order]])
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(-0.6, names.size - 0.4)
    axes.set_xlabel(r"largest change of $\mu$ (% of the curve's height)")
    axes.legend(loc="lower right")
