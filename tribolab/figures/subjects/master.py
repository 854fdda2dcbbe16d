"""Figure of the master curve: friction in several liquids against viscosity times speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from tribolab.figures.error_bars import error_bar
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Mark, Panel, Series, axis_of
from tribolab.fit.master_curve import Collapse

# Film ratios h/h_rms between which lubrication is mixed (G. Stachowiak, A. Batchelor,
# Engineering Tribology, 2013, Ch. 7)
_MIXED = ((1.0, "boundary | mixed"), (3.0, "mixed | full film"))


@plotted()
def master_curve(
    curves: Sequence[xr.Dataset],
    viscosity: Sequence[float],
    *,
    names: Sequence[str] = (),
    collapse: Collapse | None = None,
    model: xr.Dataset | None = None,
    rms_roughness: float = 0.0,
) -> FigureSpec:
    """Draw friction in several liquids against viscosity times speed, with lubrication regimes.

    Parameters
    ----------
    curves
        ``friction_coefficient`` (sliding_speed or entrainment_speed) of each liquid.
    viscosity
        Viscosity of each liquid [Pa s].
    names
        Names of the liquids.
    collapse
        From `tribolab.fit.collapse_test`: its common curve and p-value.
    model
        A computed curve with ``viscosity_Pa_s``; with `rms_roughness` [m] a second panel has the
        film ratio, and marks show where mixed lubrication begins and ends.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> v = np.geomspace(1e-4, 1e-1, 7)
    >>> made = [tl.stribeck_curve(xu2026.contact, None, eta, 310.0, 0.0, v) for eta in (0.5, 1.4)]
    >>> figure = master_curve(made, [0.5, 1.4], names=["oil", "glycerol"])
    >>> tl.plot.figure_data(figure).series.unique().tolist()
    ['oil', 'glycerol']
    """
    labels = list(names) or [f"{eta:.3g} Pa s" for eta in viscosity]
    series = []
    for number, (name, curve, eta) in enumerate(zip(labels, curves, viscosity, strict=True)):
        at, mu = _reduced(curve, eta)
        error = error_bar(curve, "friction_coefficient")[_speed(curve) > 0]
        series.append(Series(name, at, mu, "points", number, error=error))
    if collapse is not None:
        text = f"one curve (p = {collapse.p_value:.2g})"
        series.append(Series(text, collapse.abscissa, collapse.fitted, "dashed", 6))
    marks: tuple[Mark, ...] = ()
    if model is not None:
        at, mu = _reduced(model, model.attrs["viscosity_Pa_s"])
        series.append(Series("model", at, mu, "line", 6))
        if rms_roughness > 0:
            film = model["central_separation"].values[_speed(model) > 0] / rms_roughness
            series.append(Series("film ratio", at, film, "line", 6, panel=1))
            marks = _regimes(at, film)
    x = Axis("viscosity × speed", "N/m", log=True, column="viscosity_speed_N_m")
    panels = [Panel(x, axis_of("friction_coefficient", log=True))]
    if series[-1].panel == 1:
        ratio = Axis("film ratio h/h_rms", log=True, column="film_ratio")
        panels.append(Panel(x, ratio, height=0.6))
    return FigureSpec(
        id="master_curve",
        title="Master curve",
        panels=tuple(panels),
        series=tuple(series),
        marks=marks,
    )


def _speed(curve: xr.Dataset) -> np.ndarray:
    mu = curve["friction_coefficient"]
    return np.asarray(mu[mu.dims[0]].values)


def _reduced(curve: xr.Dataset, viscosity: float) -> tuple[np.ndarray, np.ndarray]:
    """Return viscosity times speed [N/m] and friction of the points with a speed above zero."""
    speed = _speed(curve)
    return viscosity * speed[speed > 0], curve["friction_coefficient"].values[speed > 0]


def _regimes(at: np.ndarray, film: np.ndarray) -> tuple[Mark, ...]:
    """Return lines at the limits of mixed lubrication, labelled with the regimes on both sides."""
    marks = [Mark("y", limit, style="dotted", panel=1) for limit, _ in _MIXED]
    for limit, text in _MIXED:
        if film[0] < limit < film[-1]:
            place = float(np.exp(np.interp(np.log(limit), np.log(film), np.log(at))))
            marks.append(Mark("x", place, style="dotted", above=text))
    return tuple(marks)
