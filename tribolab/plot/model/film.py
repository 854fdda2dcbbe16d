"""Figures of the film: profiles across the contact, flow and friction factors."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.typing import LineStyleType

from tribolab.figures.labels import plain
from tribolab.figures.look.frame import colours, logarithmic, name_surfaces
from tribolab.figures.look.guests import Panels, name_all, name_panel, several_panels
from tribolab.figures.look.style import (
    DOUBLE_MM,
    GREY,
    PaperFigure,
    keep,
    margins,
    new_figure,
    tidy,
)
from tribolab.untyped import Arguments
from tribolab.words import speed_text

# From dark to light and from blue to yellow: in order for everybody, on paper too.
_SPEED_COLOURS = ("#00204D", "#31446B", "#666970", "#958F78", "#CBBA69")
_HEIGHT = 66.0
_PANELS = (
    ("separation", 1e6, r"mean separation $\bar u$ (µm)"),
    ("contact_pressure", 1e-6, r"contact pressure $p_{\mathrm{cont}}$ (MPa)"),
    ("fluid_pressure", 1e-6, r"fluid pressure $p_{\mathrm{fluid}}$ (MPa)"),
)
_FLOW: tuple[tuple[str, LineStyleType, str], ...] = (
    ("pressure_flow_factor", "-", r"$\phi_{\mathrm{p}}$"),
    ("shear_flow_factor", "--", r"$\phi_{\mathrm{s}}$"),
)
_FRICTION: tuple[tuple[str, LineStyleType, str], ...] = (
    ("shear_stress_factor", "-", r"$\phi_{\mathrm{f}}$"),
    ("shear_stress_correction", "--", r"$\phi_{\mathrm{fs}}$"),
    ("pressure_stress_factor", ":", r"$\phi_{\mathrm{fp}}$"),
)


def film_profiles(
    profiles: xr.Dataset | Sequence[xr.Dataset], *, title: str = "", axes: Panels | None = None
) -> Figure:
    """Draw separation, contact and fluid pressure across the contact at several speeds.

    Parameters
    ----------
    profiles
        ``x``, ``separation`` [m], ``contact_pressure``, ``fluid_pressure`` [Pa] over
        (sliding_speed, point); or several results of `tribolab.film_profile`, each over (x).
    title
        Text above the figure.
    axes
        The axes to draw in, three of them; they keep their look. Without
        them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels over x; the flat slides to +x, so the inlet is on the left.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psd = xu2026.psd("Sb-S", points=301)
    >>> films = [
    ...     tl.film_profile(xu2026.contact, psd, "1.4 Pa s", "310 N/m", v, cells=100)
    ...     for v in ("10 um/s", "1 mm/s")
    ... ]
    >>> tl.plot.figure_data(film_profiles(films)).series.unique().tolist()
    ['10 µm/s', '1 mm/s']
    """
    if isinstance(profiles, xr.Dataset):
        profiles = [profiles.isel(sliding_speed=n) for n in range(profiles.sliding_speed.size)]
    with several_panels(axes, [name for name, _, _ in _PANELS], _side_by_side(3)) as drawn:
        figure, panels = drawn
        widest = centre = 0.0
        for rank, profile in enumerate(profiles):
            v, x = float(profile["sliding_speed"]), 1e3 * profile["x"].values
            total = (profile["contact_pressure"] + profile["fluid_pressure"]).values
            widest = max(widest, np.abs(x[total > 5e-3 * total.max()]).max())
            place = round(rank * (len(_SPEED_COLOURS) - 1) / max(len(profiles) - 1, 1))
            centre = max(centre, float(profile["separation"].values[np.abs(x).argmin()]))
            look: Arguments = {"color": _SPEED_COLOURS[place], "linewidth": 1.1}
            for panel, (name, factor, _) in zip(panels, _PANELS, strict=True):
                panel.plot(x, factor * profile[name].values, **look, label=speed_text(v))
            numbers = {f"{name}_{unit}": profile[name].values for name, unit in _UNITS}
            keep(figure, "profiles", speed_text(v), x_m=profile["x"].values, **numbers)
        for panel, (_, _, text), letter in zip(panels, _PANELS, "abc", strict=True):
            panel.set_xlim(-1.05 * widest, 1.05 * widest)
            panel.set_xlabel("coordinate $x$ (mm)")
            panel.set_ylabel(text)
            tidy(panel, letter if axes is None else "")
        panels[0].set_ylim(0, 4e6 * centre)  # the gap outside grows without end
        for panel in panels[1:]:
            panel.set_ylim(0, 1.18 * panel.dataLim.y1 or 1)  # smooth bodies do not touch
        if axes is None:
            _finish(figure, panels[0], title, wspace=0.32)
        else:
            name_all(panels[1])  # where the curves leave room
            name_panel(panels[0], title)
    return figure


def _side_by_side(count: int) -> Callable[[], tuple[PaperFigure, list[Axes]]]:
    def make() -> tuple[PaperFigure, list[Axes]]:
        figure = new_figure(DOUBLE_MM, _HEIGHT)
        return figure, list(figure.subplots(1, count))

    return make


def _finish(figure: Figure, named: Axes, title: str, *, wspace: float) -> None:
    """Set margins, and above the panels the names in one of them and the title."""
    margins(figure, 13, 3, 10.5, 10.5 if title else 6.5, wspace=wspace)
    handles, texts = named.get_legend_handles_labels()
    figure.legend(
        handles, texts, loc="upper right", ncols=len(texts),
        bbox_to_anchor=(1 - 3 / DOUBLE_MM, 1 - (4.5 if title else 0.8) / _HEIGHT),
    )  # fmt: skip
    if title:
        figure.text(13 / DOUBLE_MM, 1 - 1.0 / _HEIGHT, plain(title), va="top", fontsize=8)


_UNITS = (("separation", "m"), ("contact_pressure", "Pa"), ("fluid_pressure", "Pa"))


def lubrication_factors(
    factors: Mapping[str, xr.Dataset] | xr.Dataset,
    *,
    surfaces: Sequence[str] = (),
    title: str = "",
    axes: Panels | None = None,
) -> Figure:
    """Draw flow and friction factors over the separation in units of the roughness.

    Parameters
    ----------
    factors
        The five factors (separation) with the attribute ``rms_roughness_m``, by the surface's
        name; or over (surface, relative_separation), from `tribolab.relative_flow_factors`.
    surfaces
        All surfaces of the study in their order, so that each keeps its colour.
    title
        Text above the figure.
    axes
        The axes to draw in, for flow and friction factors; they keep their look. Without
        them a figure is made.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> table = tl.flow_factors(xu2026.psd("Sb-S", points=301))
    >>> over = table.rms_roughness * np.geomspace(0.3, 3, 5)
    >>> figure = lubrication_factors({"Sb-S": table.dataset(over)})
    >>> tl.plot.figure_data(figure).pressure_flow_factor.dropna().round(2).tolist()
    [0.0, 0.09, 0.35, 0.61, 0.8]
    """
    if isinstance(factors, xr.Dataset):
        factors = {str(s): factors.sel(surface=s) for s in factors["surface"].values}
    chosen = colours(list(factors), surfaces)
    both = ("flow factors", "friction factors")
    with several_panels(axes, both, _side_by_side(2)) as (figure, (flow, friction)):
        for panel, names in ((flow, _FLOW), (friction, _FRICTION)):
            for name, data in factors.items():
                over = _over(data)
                for key, style, _ in names:
                    panel.plot(over, data[key], color=chosen[name], linestyle=style, linewidth=1.1)
                numbers = {key: data[key].values for key, _, _ in names}
                keep(figure, "factors", name, separation_over_rms_roughness=over, **numbers)
            lines = [
                Line2D([], [], color=GREY, linestyle=style, linewidth=1.1, label=text)
                for _, style, text in names
            ]
            if axes is not None:  # by name, for the one legend of the panel
                for line in lines:
                    panel.add_artist(line)
            elif panel is flow:
                panel.legend(handles=lines, loc="center right")
            else:
                panel.legend(handles=lines, loc="lower right")
            logarithmic(panel, *("x" if panel is flow else "xy"))
            panel.set_xlim(over.min(), over.max())
            panel.set_xlabel(r"mean separation / roughness $\bar u/h_{\mathrm{rms}}$")
        flow.axhline(0, color=GREY, linewidth=0.6, zorder=0)
        friction.set_ylim(1e-3, 2 * friction.dataLim.y1)
        flow.set_ylabel("flow factor")
        friction.set_ylabel("friction factor")
        tidy(flow, "a" if axes is None else "")
        tidy(friction, "b" if axes is None else "")
        name_surfaces(flow, chosen)
        if axes is None:
            _finish(figure, flow, title, wspace=0.2)
        else:
            name_all(flow)
            name_all(friction)
            name_panel(flow, title)
    return figure


def _over(factors: xr.Dataset) -> np.ndarray:
    """Return the separation in units of the roughness."""
    if "relative_separation" in factors.coords:
        return factors["relative_separation"].to_numpy()
    return factors["separation"].to_numpy() / float(factors.attrs["rms_roughness_m"])
