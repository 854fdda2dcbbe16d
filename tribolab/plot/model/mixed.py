"""Mixed lubrication beside the measurement: curve, residuals, shear stress, friction factors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tribolab.figures.error_bars import COVERAGE, ErrorBars, draw_error_bars, error_bar
from tribolab.figures.labels import column, label, plain
from tribolab.figures.look.frame import (
    SurfaceOrSeveral,
    by_surface,
    colours,
    logarithmic,
    shaded_band,
    speed_axis,
)
from tribolab.figures.look.guests import Panels, name_all, name_panel, one_panel, several_panels
from tribolab.figures.look.style import (
    BLACK,
    GREY,
    SINGLE_MM,
    PaperFigure,
    SurfaceStyle,
    keep,
    margins,
    new_figure,
    surface_styles,
)
from tribolab.untyped import Arguments

_MODEL_HEIGHT, _MISFIT_HEIGHT = 50.0, 20.0  # mm


def mixed_curve(
    fit: xr.Dataset,
    curve: xr.Dataset,
    *,
    uncertainty: xr.Dataset | None = None,
    dry: xr.Dataset | None = None,
    surface: str = "",
    surfaces: Sequence[str] = (),
    errors: ErrorBars = "U95",
    title: str = "",
    axes: Panels | None = None,
) -> Figure:
    """Draw a measured Stribeck curve, the model with its parts, and what is left between them.

    Parameters
    ----------
    fit
        ``friction_coefficient`` with ``_U95``, ``_sem`` and, if known, ``_std`` (sliding_speed);
        ``friction_coefficient_residual`` from `tribolab.fit_shear_stress`: the group "fit" of a
        model's data file.
    curve
        The model over a wider range of speeds, with its parts.
    uncertainty
        From `tribolab.model_uncertainty`: the band about the model.
    dry
        The measured curve of the dry contact at the same load.
    surface, surfaces
        Its name, and all names of the study in their order, for the colour.
    errors
        ``"U95"`` or ``"std"``, as for `tribolab.plot.stribeck`.
    title
        Text above the figure.
    axes
        The axes to draw in, for the curve and for the differences; they keep their look. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Where the fitted shear stress is not positive there is no model: of its lines only the
        viscous part is drawn, and the differences are from that.
        Above: points with their error bars, the model as a line, its solid part dashed and its
        viscous part dotted, dry points open. Below: the residuals (measured minus model) with
        their 95 % uncertainty, the model's included where the fit knows it.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psd, given = xu2026.psd("Sb-S", 301), {"viscosity": 1.4, "load": 310.0, "cells": 100}
    >>> speed = [1e-6, 1e-5, 1e-4, 1e-3]
    >>> curve = tl.stribeck_curve(xu2026.contact, psd, shear_stress=8e5, speed=speed, **given)
    >>> measured = curve[["friction_coefficient"]] * 1.01
    >>> measured["friction_coefficient_sem"] = 0.01 * measured.friction_coefficient
    >>> fit = tl.fit_shear_stress(measured, xu2026.contact, psd, **given)
    >>> residual = fit.curve.friction_coefficient_residual
    >>> points = measured.assign(friction_coefficient_residual=residual)
    >>> figure = mixed_curve(points, curve, surface="Sb-S")
    >>> tl.plot.figure_data(figure).series.unique().tolist()
    ['model', 'solid', 'viscous', 'measured', 'measured less model']
    """
    style = surface_styles([*surfaces, surface])[surface]
    with several_panels(axes, ("friction", "difference"), _stacked) as (figure, (above, below)):
        modelled = fit.attrs.get("shear_stress_Pa", 1.0) > 0
        if uncertainty is not None and modelled:
            _band(figure, above, uncertainty, style.colour)
        _model(figure, above, curve, style.colour, () if modelled else ("viscous",))
        _measured(figure, above, fit, style, "measured", errors)
        if dry is not None:
            _measured(figure, above, dry, style, "dry", errors, hollow=True)
        _misfit(figure, below, fit, style, "model" if modelled else "viscous part")
        speed_axis(below, curve["sliding_speed"].values, room=1.0)
        if axes is not None:
            speed_axis(above, curve["sliding_speed"].values, room=1.0)
        above.set_ylabel(label("friction_coefficient"))
        low, high = above.dataLim.intervaly
        above.set_ylim(1.2 * low if low < -0.01 * high else 0, 1.06 * high)
        if isinstance(figure, PaperFigure) and axes is None:
            _two_panels(figure, above, title)
        else:
            name_all(above)
            name_panel(above, title)
    return figure


def _stacked() -> tuple[PaperFigure, list[Axes]]:
    figure = new_figure(SINGLE_MM, _MODEL_HEIGHT + _MISFIT_HEIGHT)
    ratios = {"height_ratios": [_MODEL_HEIGHT, _MISFIT_HEIGHT]}
    return figure, list(figure.subplots(2, 1, sharex=True, gridspec_kw=ratios))


def _model(
    figure: Figure, axes: Axes, curve: xr.Dataset, colour: str, only: tuple[str, ...] = ()
) -> None:
    v = curve["sliding_speed"].values
    fluid = curve["friction_coefficient_couette"] + curve["friction_coefficient_pressure"]
    lines: tuple[tuple[str, xr.DataArray, Arguments, str], ...] = (
        ("model", curve["friction_coefficient"], {"linestyle": "-", "linewidth": 1.2}, "model"),
        ("solid", curve["friction_coefficient_solid"], {"linestyle": "--"}, "solid part"),
        ("viscous", fluid, {"linestyle": (0, (1, 1.2)), "color": BLACK}, "viscous part"),
    )
    for name, values, look, text in lines:
        if only and name not in only:
            continue
        look = {"color": colour, "linewidth": 0.9, "zorder": 3, **look}
        axes.plot(v, values, **look, label=text)
        numbers = {column("sliding_speed"): v, "friction_coefficient": values.values}
        keep(figure, "friction", name, **numbers)


def _band(figure: Figure, axes: Axes, uncertainty: xr.Dataset, colour: str) -> None:
    v = uncertainty["sliding_speed"].values
    low, high = (uncertainty[f"friction_coefficient_{end}"].values for end in ("low", "high"))
    shaded_band(axes, v, low, high, colour)
    axes.fill_between([], [], [], color=colour, alpha=0.2, linewidth=0, label="its band")
    numbers = {column("sliding_speed"): v, "friction_coefficient_low": low}
    keep(figure, "friction", "band", **numbers, friction_coefficient_high=high)


def _measured(
    figure: Figure,
    axes: Axes,
    data: xr.Dataset,
    style: SurfaceStyle,
    text: str,
    errors: ErrorBars,
    hollow: bool = False,
) -> None:
    v, mu = data["sliding_speed"].values, data["friction_coefficient"].values
    size = error_bar(data, "friction_coefficient", errors)
    draw_error_bars(axes, v, mu, size, style.colour, errors)
    axes.plot(
        v, mu, color=style.colour, marker=style.marker, markersize=4.2, markeredgewidth=0.9,
        markerfacecolor="white" if hollow else style.colour, linewidth=0.7,
        linestyle="--" if hollow else "none", label=text, zorder=5,
    )  # fmt: skip
    columns = {column("sliding_speed"): v, "friction_coefficient": mu}
    keep(figure, "friction", text, **columns, **{f"friction_coefficient_{errors}": size})


def _misfit(figure: Figure, axes: Axes, fit: xr.Dataset, style: SurfaceStyle, what: str) -> None:
    v, off = fit["sliding_speed"].values, fit["friction_coefficient_residual"].values
    sizes = fit.get("friction_coefficient_residual_u", fit["friction_coefficient_sem"])
    error = COVERAGE * np.nan_to_num(sizes.values)
    axes.axhline(0, color=GREY, linewidth=0.8, zorder=1)
    axes.errorbar(
        v, off, error, color=style.colour, marker=style.marker, markersize=3.2,
        linestyle="none", elinewidth=0.8, capsize=1.8, capthick=0.8,
    )  # fmt: skip
    columns = {"sliding_speed_m_s": v, "residual": off, "error": error}
    keep(figure, "residual", f"measured less {what}", **columns)
    axes.set_ylabel(r"difference $\Delta\mu$")
    axes.yaxis.set_major_locator(MaxNLocator(3, symmetric=True))
    reach = 1.15 * np.nanmax(np.abs(off) + error) or 1.0
    axes.set_ylim(-reach, reach)


def _two_panels(figure: PaperFigure, axes: Axes, title: str) -> None:
    handles, texts = axes.get_legend_handles_labels()
    rows = -(-len(texts) // 3)
    top = 2.5 + 3.8 * rows + (4.5 if title else 0)
    height = _MODEL_HEIGHT + _MISFIT_HEIGHT + top + 10.5
    figure.set_size_inches(SINGLE_MM / 25.4, height / 25.4)
    margins(figure, 17, 3, 10.5, top, hspace=0.06)
    figure.align_ylabels()
    axes.legend(
        handles,
        texts,
        loc="lower left",
        ncols=3,
        bbox_to_anchor=(0, 1 + 0.8 / _MODEL_HEIGHT),
        handlelength=1.8,
        columnspacing=1.1,
    )
    if title:
        figure.text(17 / SINGLE_MM, 1 - 1.3 / height, plain(title), va="top", fontsize=8)


def shear_stress(
    table: pd.DataFrame, *, surfaces: Sequence[str] = (), title: str = "", ax: Axes | None = None
) -> Figure:
    """Draw fitted shear stresses over the load: as fitted, and in the area that adhesion makes.

    Parameters
    ----------
    table
        A row per fit with ``surface``, ``normal_force_N``, ``shear_stress_Pa`` and its
        ``shear_stress_low_Pa`` and ``_high_Pa``; ``corrected_shear_stress_Pa`` and
        ``corrected_shear_stress_error_Pa``.
    surfaces, title, ax
        As for `mixed_curve`.

    Returns
    -------
    matplotlib.figure.Figure
        Open symbols: effective, for the area without adhesion, with the 95 % interval. Filled:
        corrected for adhesion, with 1.96 standard errors. Bars end at zero, since no shear stress
        is negative: one that reaches it is not told from zero. The numbers kept are not cut.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> table = pd.DataFrame(
    ...     {
    ...         "surface": "Sb-S",
    ...         "normal_force_N": [31.0, 91.0],
    ...         "shear_stress_Pa": [0.84e6, 0.78e6],
    ...         "shear_stress_low_Pa": [0.80e6, 0.75e6],
    ...         "shear_stress_high_Pa": [0.88e6, 0.81e6],
    ...         "corrected_shear_stress_Pa": [0.49e6, 0.47e6],
    ...         "corrected_shear_stress_error_Pa": [0.03e6, 0.03e6],
    ...     }
    ... )
    >>> figure_data(shear_stress(table)).shear_stress_Pa.tolist()
    [840000.0, 780000.0]
    """
    names = list(dict.fromkeys(table["surface"]))
    styles = surface_styles([*surfaces, *names])
    with one_panel(ax, title) as (figure, axes):
        for name in names:
            rows = table[table["surface"] == name].sort_values("normal_force_N")
            load, stress = rows["normal_force_N"].to_numpy(), rows["shear_stress_Pa"].to_numpy()
            ends = rows[["shear_stress_low_Pa", "shear_stress_high_Pa"]].to_numpy().T
            bars = _above_zero(stress, np.abs(ends - stress))
            corrected = rows["corrected_shear_stress_Pa"].to_numpy()
            error = COVERAGE * rows["corrected_shear_stress_error_Pa"].to_numpy()
            error = _above_zero(corrected, np.stack([error, error]))
            for y, bar, face, line in (
                (stress, bars, "white", "--"),
                (corrected, error, styles[name].colour, "-"),
            ):
                axes.errorbar(
                    load, 1e-6 * y, 1e-6 * bar, color=styles[name].colour, markersize=4.5,
                    marker=styles[name].marker, markerfacecolor=face, linestyle=line, capsize=1.8,
                    linewidth=0.8,
                    label=plain(name) if line == "-" else "_nolegend_",
                )  # fmt: skip
            keep(figure, "shear stress", name, **{k: rows[k].to_numpy() for k in rows.columns[1:]})
        axes.plot([], [], color=GREY, marker="o", markerfacecolor="white", linestyle="--",
                  label="as fitted")  # fmt: skip
        axes.plot([], [], color=GREY, marker="o", linestyle="-", label="in the adhesive area")
        axes.set_xlim(0, 1.08 * table["normal_force_N"].max())
        axes.set_ylim(min(0.0, 1.1 * axes.dataLim.y0), 1.08 * axes.dataLim.y1)
        axes.axhline(0, color=GREY, linewidth=0.6, zorder=0)
        axes.set_xlabel(label("normal_force"))
        axes.set_ylabel(r"shear stress $\sigma_{\mathrm{f}}$ (MPa)")
    return figure


def _above_zero(value: np.ndarray, bars: np.ndarray) -> np.ndarray:
    """Cut error bars (lower and upper; value) that reach below zero from a value above it."""
    return np.stack([np.where(value > 0, np.minimum(bars[0], value), bars[0]), bars[1]])


def friction_factor_effect(
    curves: SurfaceOrSeveral,
    *,
    scale: Literal["log", "linear"] = "log",
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw model curves with the friction factors of the roughness and without them.

    Parameters
    ----------
    curves
        ``friction_coefficient`` and ``friction_without_factors`` (sliding_speed) by the surface's
        name.
    scale
        Of the friction coefficient; the sliding speed is always on a logarithmic one.
    surfaces, title, ax
        As for `mixed_curve`.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> curve = tl.stribeck_curve(
    ...     xu2026.contact, xu2026.psd("Sb-R", 301), 1.4, 310.0, "1 MPa", [1e-4, 1e-3], cells=100
    ... )
    >>> tl.plot.figure_data(friction_factor_effect({"Sb-R": curve})).friction.round(3).tolist()
    [1.011, 0.866, 1.007, 0.837]
    """
    curves = by_surface(curves)
    chosen = colours(list(curves), surfaces)
    with one_panel(ax, title) as (figure, axes):
        for name, curve in curves.items():
            v = curve["sliding_speed"].values
            for key, style in (("friction_coefficient", "-"), ("friction_without_factors", "--")):
                mu = curve[key].values
                text = plain(name) if style == "-" else "_nolegend_"
                axes.plot(v, mu, color=chosen[name], linestyle=style, linewidth=1.1, label=text)
                keep(figure, "friction", f"{name}, {key}", sliding_speed_m_s=v, friction=mu)
        axes.plot([], [], color=GREY, linestyle="-", label="with factors")
        axes.plot([], [], color=GREY, linestyle="--", label="without")
        bottom, top = axes.dataLim.intervaly
        logarithmic(axes, *(("x", "y") if scale == "log" else ("x",)))
        axes.set_xlim(v.min(), v.max())
        if scale == "log":
            axes.set_ylim(max(bottom / 1.3, 1e-4 * top), 1.4 * top)
        else:
            axes.set_ylim(0, 1.08 * top)
        axes.set_xlabel(label("sliding_speed"))
        axes.set_ylabel(label("friction_coefficient"))
    return figure


def shear_stress_over_speed(
    curves: SurfaceOrSeveral,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the shear stress in the real contact over the sliding speed.

    Parameters
    ----------
    curves
        ``shear_stress`` [Pa] with ``shear_stress_std`` (sliding_speed) by the surface's name.
    surfaces, title, ax
        As for `mixed_curve`.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> values = {"shear_stress": [6e5, 6.1e5], "shear_stress_std": [1e4, 1e4]}
    >>> curve = xr.Dataset(
    ...     {name: ("sliding_speed", one) for name, one in values.items()},
    ...     {"sliding_speed": [1e-5, 1e-3]},
    ... )
    >>> figure_data(shear_stress_over_speed({"Sb-S": curve})).shear_stress_Pa.tolist()
    [600000.0, 610000.0]
    """
    curves = by_surface(curves)
    styles = surface_styles([*surfaces, *curves])
    with one_panel(ax, title) as (figure, axes):
        for name, curve in curves.items():
            v, stress = curve["sliding_speed"].values, curve["shear_stress"].values
            spread = curve["shear_stress_std"].values
            axes.errorbar(
                v, 1e-6 * stress, 1e-6 * np.nan_to_num(spread), color=styles[name].colour,
                marker=styles[name].marker, markersize=4.2, markerfacecolor="white",
                linestyle="--", linewidth=0.7, elinewidth=0.8, capsize=1.8, label=plain(name),
            )  # fmt: skip
            columns = {"shear_stress_Pa": stress, "shear_stress_std_Pa": spread}
            keep(figure, "shear stress", name, **{column("sliding_speed"): v}, **columns)
        speed_axis(axes, np.array(axes.dataLim.intervalx) * (0.6, 1.7), room=1.0)
        axes.set_ylim(0, 1.08 * axes.dataLim.y1)
        axes.set_ylabel(r"shear stress $\sigma_{\mathrm{f}}$ (MPa)")
    return figure
