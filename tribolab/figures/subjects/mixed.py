"""Figures of mixed lubrication: fitted curve with residuals, shear stress, friction factors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pandas as pd
import xarray as xr

from tribolab.core.untyped import Arguments
from tribolab.core.wording import is_dry
from tribolab.figures.colours import BLACK, GREEN, surface_colours
from tribolab.figures.error_bars import COVERAGE, ErrorBars, error_bar
from tribolab.figures.labelled import SurfaceOrSeveral, by_surface
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Mark, Panel, Series, Style, axis_of
from tribolab.figures.subjects.curves import FRICTION_AXIS, SPEED_AXIS

_MPA = 1e-6
_STRESS = Axis(
    "shear stress σ", "MPa", include=(0.0,), least=0.0, column="shear_stress_MPa",
    paper=r"shear stress $\sigma_{\mathrm{f}}$",
)  # fmt: skip
_DIFFERENCE = Axis("measured − model", paper=r"difference $\Delta\mu$", column="residual")


@plotted(panels=2)
def mixed_curve(
    fit: xr.Dataset,
    curve: xr.Dataset,
    *,
    uncertainty: xr.Dataset | None = None,
    dry: xr.Dataset | None = None,
    surface: str = "",
    surfaces: Sequence[str] = (),
    errors: ErrorBars = "U95",
    scale: Literal["log", "linear"] = "log",
) -> FigureSpec:
    """Draw a measured Stribeck curve, the model and its contributions, and the residuals.

    Above: points with their error bars, the model as a line, its solid part dashed and its viscous
    part dotted, dry points open. Below: the residuals (measured minus model) with their 95 %
    uncertainty, that of the model included if the fit knows it. If the fitted shear stress is not
    positive there is no model: only the viscous part is drawn, and the residuals refer to it.

    Parameters
    ----------
    fit
        ``friction_coefficient`` with ``_U95``, ``_sem`` and, if known, ``_std`` (sliding_speed);
        ``friction_coefficient_residual`` from `tribolab.fit_shear_stress`: the group "fit" of a
        model's data file.
    curve
        The model in a wider range of speeds, with its solid and viscous parts.
    uncertainty
        Band of the model, from `tribolab.fit.model_uncertainty`.
    dry
        The measured curve of the dry contact at the same load.
    surface, surfaces
        Name of the surface, and all names of the study in their order, for the colour.
    errors
        ``"U95"`` or ``"std"``, as for `tribolab.plot.stribeck`.
    scale
        Scale of the friction coefficient.

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
    >>> tl.plot.figure_data(figure).series.unique().tolist()[:3]
    ['model', 'solid part', 'without friction factors']
    """
    own: Arguments = {"colour": surface_colours([*surfaces, surface])[surface], "surface": surface}
    modelled = fit.attrs.get("shear_stress_Pa", 1.0) > 0
    series: list[Series] = []
    v = curve["sliding_speed"].values
    fluid = curve["friction_coefficient_couette"] + curve["friction_coefficient_pressure"]
    if modelled:
        if uncertainty is not None:
            low, high = (uncertainty[f"friction_coefficient_{e}"].values for e in ("low", "high"))
            at = uncertainty["sliding_speed"].values
            fine = np.isfinite(low) & np.isfinite(high)
            band = Series("uncertainty", at[fine], low[fine], "band", high=high[fine], **own)
            series.append(band)
        series.append(Series("model", v, curve["friction_coefficient"].values, **own))
        solid = curve["friction_coefficient_solid"].values
        series.append(Series("solid part", v, solid, "dashed", **own))
        if "friction_without_factors" in curve:
            bare = curve["friction_without_factors"].values
            look = own | {"colour": GREEN if own["colour"] != GREEN else BLACK}
            series.append(Series("without friction factors", v, bare, "dashdot", **look))
    series.append(Series("viscous part", v, fluid.values, "dotted", **(own | {"colour": BLACK})))
    series.append(_measured(fit, "measured", errors, own))
    if dry is not None:
        series.append(_measured(dry, "dry", errors, own | {"open": True, "joined": True}))
    off = fit["friction_coefficient_residual"].values
    sizes = fit.get("friction_coefficient_residual_u", fit["friction_coefficient_sem"])
    series.append(
        Series(
            "measured", fit["sliding_speed"].values, off, "points", panel=1,
            error=COVERAGE * np.nan_to_num(sizes.values), **own,
            name=f"measured minus {'model' if modelled else 'viscous part'}",
        )
    )  # fmt: skip
    y = FRICTION_AXIS if scale == "log" else axis_of("friction_coefficient", include=(0.0,))
    y = Axis(y.label, log=y.log, decades=4 * y.log, include=y.include, paper=y.paper,
             column=y.column)  # fmt: skip
    return FigureSpec(
        title="Measured friction and mixed lubrication",
        note="Points: measured, with U95; solid line: model with the fitted shear stress; dashed: "
        "contribution of the solid contact; dotted: viscous contribution; shaded: uncertainty "
        "of the model. Below: the "
        "residuals with their 95 % uncertainty, including that of viscosity, speed, load, radius "
        "and modulus if stated."
        if modelled
        else "Points: measured, with U95; dotted: the model's viscous part. No shear stress "
        "describes this curve. Below: the residuals.",
        panels=(
            Panel(SPEED_AXIS, y, name="friction"),
            Panel(SPEED_AXIS, _DIFFERENCE, height=0.45, name="residual"),
        ),
        series=tuple(series),
        marks=(Mark("y", 0.0, panel=1),),
    )


def _measured(data: xr.Dataset, text: str, errors: ErrorBars, own: Arguments) -> Series:
    size = error_bar(data, "friction_coefficient", errors)
    v, mu = data["sliding_speed"].values, data["friction_coefficient"].values
    return Series(text, v, mu, "points", error=size, pale=errors == "std", **own)


@plotted()
def shear_stress(table: pd.DataFrame, *, surfaces: Sequence[str] = ()) -> FigureSpec:
    """Draw fitted shear stresses against load, for the contact area without and with adhesion.

    Open symbols: effective, for the area without adhesion, with the 95 % interval. Filled:
    corrected for adhesion, with U95. Bars end at zero, since no shear stress is negative.

    Parameters
    ----------
    table
        A row per fit with ``surface``, ``normal_force_N``, ``shear_stress_Pa`` and its
        ``shear_stress_low_Pa`` and ``_high_Pa``; ``corrected_shear_stress_Pa`` and
        ``corrected_shear_stress_error_Pa``; ``medium``, ``corrected_u95_Pa``, ``hover`` and
        ``corrected_hover`` if known.
    surfaces
        As for `mixed_curve`.

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
    >>> figure_data(shear_stress(table)).shear_stress_Pa.dropna().tolist()
    [840000.0, 780000.0]
    """
    table = table.assign(medium=table.get("medium", ""))
    colours = surface_colours([*surfaces, *table["surface"]])
    media = table["medium"].nunique()
    series = []
    for (surface, medium), rows in table.groupby(["surface", "medium"], sort=False):
        rows = rows.sort_values("normal_force_N")
        stress = rows["shear_stress_Pa"].to_numpy(float)
        corrected = rows["corrected_shear_stress_Pa"].to_numpy(float)
        u95 = rows.get("corrected_u95_Pa", COVERAGE * rows["corrected_shear_stress_error_Pa"])
        ends = [rows[f"shear_stress_{end}_Pa"].to_numpy(float) for end in ("low", "high")]
        name = ", ".join(filter(None, (str(surface), str(medium) if media > 1 else "")))
        numbers = {key: rows[key].to_numpy() for key in rows.columns if str(key).endswith(_UNITS)}
        look: Arguments = {"colour": colours[str(surface)], "surface": surface, "medium": medium}
        look |= {"joined": True, "name": str(surface)}
        drawn: tuple[tuple[np.ndarray, Sequence[np.ndarray], str, Arguments], ...] = (
            (stress, [np.abs(end - stress) for end in ends], "hover", {"columns": numbers}),
            (corrected, [u95.to_numpy(float)] * 2, "corrected_hover", {"columns": {}}),
        )
        for value, (below, above), words, more in drawn:
            fine = np.isfinite(value)
            cut = np.where(value > 0, np.minimum(below, value), below)
            hover = tuple(rows[words].to_numpy()[fine]) if words in rows else ()
            series.append(
                Series(
                    name, rows["normal_force_N"].to_numpy(float)[fine], _MPA * value[fine],
                    "points", error=_MPA * above[fine], error_below=_MPA * cut[fine],
                    open=words == "hover", hover=hover, **look, **more,
                )
            )  # fmt: skip
    return FigureSpec(
        title="Shear stress in the contact",
        note="Open: as fitted, for the contact area without adhesion; filled: for the larger area "
        "with adhesion. Bars: U95, including the uncertainty of the spectrum if known; a bar that "
        "reaches zero means that the shear stress may be zero.",
        panels=(Panel(axis_of("normal_force", "load", include=(0.0,)), _STRESS),),
        series=tuple(one for one in series if len(one.x)),
        keys=(Key("as fitted", "points", open=True), Key("in the adhesive area", "points")),
        width="half",
    )


_UNITS = ("_N", "_Pa")  # endings of the columns that `figure_data` returns


@plotted()
def friction_factor_effect(
    curves: SurfaceOrSeveral,
    *,
    scale: Literal["log", "linear"] = "log",
    surfaces: Sequence[str] = (),
) -> FigureSpec:
    """Draw computed friction with and without the friction factors of rough surfaces.

    Parameters
    ----------
    curves
        ``friction_coefficient`` and ``friction_without_factors`` (sliding_speed) by the surface's
        name.
    scale
        Scale of the friction coefficient; that of the sliding speed is always logarithmic.
    surfaces
        As for `mixed_curve`.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> curve = tl.stribeck_curve(
    ...     xu2026.contact, xu2026.psd("Sb-R", 301), 1.4, 310.0, "1 MPa", [1e-4, 1e-3], cells=100
    ... )
    >>> figure = friction_factor_effect({"Sb-R": curve})
    >>> tl.plot.figure_data(figure).friction_coefficient.round(3).tolist()
    [1.011, 0.866, 1.007, 0.837]
    """
    curves = by_surface(curves)
    colours = surface_colours([*surfaces, *curves])
    styles: dict[str, Style] = {
        "friction_coefficient": "line",
        "friction_without_factors": "dashed",
    }
    series = [
        Series(
            name, curve["sliding_speed"].values, curve[key].values, style, colours[name],
            surface=name, name=f"{name}, {key}",
        )
        for name, curve in curves.items()
        for key, style in styles.items()
    ]  # fmt: skip
    mu = axis_of("friction_coefficient", log=scale == "log", decades=4, include=(0.0,))
    return FigureSpec(
        title="Friction with and without friction factors",
        panels=(Panel(SPEED_AXIS, mu, name="friction"),),
        series=tuple(series),
        keys=(Key("with factors"), Key("without", "dashed")),
    )


@plotted()
def shear_stress_over_speed(
    curves: SurfaceOrSeveral, *, surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw the shear stress in the real contact area against sliding speed.

    Parameters
    ----------
    curves
        ``shear_stress`` [Pa] with ``shear_stress_std`` (sliding_speed) by the surface's name.
    surfaces
        As for `mixed_curve`.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> values = {"shear_stress": [6e5, 6.1e5], "shear_stress_std": [1e4, 1e4]}
    >>> curve = xr.Dataset(
    ...     {name: ("sliding_speed", one) for name, one in values.items()},
    ...     {"sliding_speed": [1e-5, 1e-3]},
    ... )
    >>> figure_data(shear_stress_over_speed({"Sb-S": curve})).shear_stress_MPa.tolist()
    [0.6, 0.61]
    """
    curves = by_surface(curves)
    colours = surface_colours([*surfaces, *curves])
    series = [
        Series(
            name, curve["sliding_speed"].values, _MPA * curve["shear_stress"].values, "points",
            colours[name], error=_MPA * np.nan_to_num(curve["shear_stress_std"].values),
            open=is_dry(str(curve.attrs.get("medium", "dry"))), joined=True, surface=name,
            pale=True,
        )
        for name, curve in curves.items()
    ]  # fmt: skip
    return FigureSpec(
        title="Shear stress over sliding speed",
        panels=(Panel(SPEED_AXIS, _STRESS),),
        series=tuple(series),
    )
