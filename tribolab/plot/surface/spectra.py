"""Figures of surfaces: their power spectra, and what roughness does to sliding rubber."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import column, label, plain
from tribolab.figures.look.frame import (
    SurfaceOrSeveral,
    by_surface,
    colours,
    logarithmic,
    name_style,
    name_surfaces,
    shaded_band,
)
from tribolab.figures.look.guests import one_panel
from tribolab.figures.look.style import BLACK, VERMILLION, keep

_MEASURED = 0


def spectra(
    psds: SurfaceOrSeveral, *, surfaces: Sequence[str] = (), title: str = "", ax: Axes | None = None
) -> Figure:
    """Draw two-dimensional power spectra with their bands, measured and extrapolated parts apart.

    Parameters
    ----------
    psds
        Spectra with ``psd_2d`` (wavenumber) by the surface's name, or one dataset over (surface,
        wavenumber); ``psd_2d_low``, ``psd_2d_high`` and ``origin`` where known.
    surfaces
        All surfaces of the study in their order, so that each keeps its colour.
    title
        Text above the figure.
    ax
        Axes to draw in, which keep their look; without them a figure is made. The legend takes in
        what is drawn there already; ``ax.legend()`` makes it anew after more has been drawn.

    Returns
    -------
    matplotlib.figure.Figure
        Full lines are measured, dashed ones extrapolated; shaded the 95 % band.

    Raises
    ------
    AnalysisError
        If there is no spectrum to draw.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab import rig
    >>> psd = tl.extrapolate(tl.psd_2d(rig.scans("Sb-R", 2, length=2e-3)))
    >>> tl.plot.figure_data(spectra({"Sb-R": psd})).series.unique().tolist()
    ['Sb-R']
    """
    psds = by_surface(psds)
    if not psds:
        raise AnalysisError("there is nothing to draw: no spectrum was given")
    chosen = colours(list(psds), surfaces)
    with one_panel(ax, title, left=16) as (figure, axes):
        dashed = False
        for name, psd in psds.items():
            q, value = psd.wavenumber.values, psd.psd_2d.values
            low, high = (
                psd[f"psd_2d{end}"].values if f"psd_2d{end}" in psd else value * np.nan
                for end in ("_low", "_high")
            )
            shaded_band(axes, q, low, high, chosen[name])
            origin = psd.origin.values if "origin" in psd else np.zeros(q.size, int)
            dashed |= bool((origin != _MEASURED).any())
            for part, style in ((origin == _MEASURED, "-"), (origin != _MEASURED, "--")):
                # a stretch begins where the one before it ends, so that no gap is seen
                shown = part | (np.roll(part, 1) & (np.arange(q.size) > 0) & (style == "--"))
                shown |= np.roll(part, -1) & (np.arange(q.size) < q.size - 1) & (style == "--")
                line = np.where(shown & (value > 0), value, np.nan)
                axes.plot(q, line, color=chosen[name], linestyle=style, linewidth=1.0)
            keep(
                figure,
                "spectrum",
                name,
                **{
                    column("wavenumber"): q,
                    column("psd_2d"): value,
                    column("psd_2d_low"): low,
                    column("psd_2d_high"): high,
                    "origin": origin,
                },
            )
        name_surfaces(axes, chosen)
        if dashed:
            name_style(axes, "measured")
            name_style(axes, "extrapolated", linestyle="--")
        logarithmic(axes, "x", "y")
        axes.set_xlabel(label("wavenumber"))
        axes.set_ylabel(label("psd_2d", "power spectrum"))
    return figure


def modulus(table: xr.Dataset, *, title: str = "", ax: Axes | None = None) -> Figure:
    """Draw storage and loss modulus over the angular frequency.

    Parameters
    ----------
    table
        ``storage_modulus``, ``loss_modulus`` [Pa] (angular_frequency).
    title
        Text above the figure.
    ax
        Axes to draw in, which keep their look; without them a figure is made. The legend takes in
        what is drawn there already; ``ax.legend()`` makes it anew after more has been drawn.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> numbers = np.array([[1e6, 1e7, 1e8], [1e5, 5e6, 2e7]])
    >>> table = xr.Dataset(
    ...     {
    ...         "storage_modulus": ("angular_frequency", numbers[0]),
    ...         "loss_modulus": ("angular_frequency", numbers[1]),
    ...     },
    ...     {"angular_frequency": [1.0, 1e3, 1e6]},
    ... )
    >>> figure_data(modulus(table)).series.unique().tolist()
    ['storage_modulus', 'loss_modulus']
    """
    omega = table.angular_frequency.values
    with one_panel(ax, title) as (figure, axes):
        for name, colour, style in (
            ("storage_modulus", BLACK, "-"),
            ("loss_modulus", VERMILLION, "--"),
        ):
            value = table[name].values
            text = label(name).removesuffix(" (Pa)")
            positive = np.where(value > 0, value, np.nan)
            axes.plot(omega, positive, color=colour, linestyle=style, linewidth=1.1, label=text)
            keep(
                figure, "modulus", name, **{column("angular_frequency"): omega, "modulus_Pa": value}
            )
        logarithmic(axes, "x", "y")
        axes.set_xlabel(label("angular_frequency"))
        axes.set_ylabel("modulus (Pa)")
    return figure


def viscoelastic(
    frictions: SurfaceOrSeveral,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    ax: Axes | None = None,
) -> Figure:
    """Draw the viscoelastic friction coefficient over the sliding speed.

    Parameters
    ----------
    frictions
        ``friction_coefficient`` (sliding_speed) by the surface's name, each at one pressure. What
        has something in brackets behind its name, such as "Smooth (complete contact)", is dashed.
    surfaces, title, ax
        As for `spectra`.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> mu = xr.Dataset(
    ...     {"friction_coefficient": ("sliding_speed", [0.01, 0.03, 0.02])},
    ...     {"sliding_speed": [1e-6, 1e-4, 1e-2]},
    ... )
    >>> figure_data(viscoelastic({"Sb-R": mu})).friction_coefficient.tolist()
    [0.01, 0.03, 0.02]
    """
    frictions = by_surface(frictions)
    chosen = colours(list(frictions), surfaces)
    with one_panel(ax, title) as (figure, axes):
        for name, friction in frictions.items():
            v, mu = friction.sliding_speed.values, friction.friction_coefficient.values
            style = "--" if " (" in name else "-"
            axes.plot(v, mu, color=chosen[name], linestyle=style, linewidth=1.1, label=plain(name))
            columns = {column("sliding_speed"): v, "friction_coefficient": mu}
            keep(figure, "viscoelastic friction", name, **columns)
        logarithmic(axes, "x")
        axes.set_xlim(v.min(), v.max())
        axes.set_ylim(0, 1.08 * axes.dataLim.y1)
        axes.set_xlabel(label("sliding_speed"))
        axes.set_ylabel(r"viscoelastic friction $\mu_{\mathrm{visc}}$")
    return figure
