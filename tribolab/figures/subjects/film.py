"""Figures of the liquid film: its profile across the contact, flow and friction factors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.core.wording import speed_text
from tribolab.figures.colours import surface_colours
from tribolab.figures.envelopes import thinned
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Mark, Panel, Series, Style

_PANELS = (
    ("separation", 1e6, Axis("separation", "µm", log=True, paper=r"mean separation $\bar u$")),
    (
        "contact_pressure",
        1e-6,
        Axis("p solid", "MPa", paper=r"contact pressure $p_{\mathrm{cont}}$"),
    ),
    ("fluid_pressure", 1e-6, Axis("p liquid", "MPa", paper=r"fluid pressure $p_{\mathrm{fluid}}$")),
)
_MIN_PRESSURE_SHARE = 1e-3  # share of the maximum pressure below which a profile is cut off
_WIDEST_GAP = 100.0  # largest gap divided by smallest gap, as drawn
_MAX_POINTS = 160  # largest number of points of a profile
_ACROSS = Axis("across the contact", "mm", paper="coordinate $x$")
_FACTORS: tuple[tuple[str, str, Style, int], ...] = (
    ("pressure_flow_factor", "pressure flow factor", "line", 0),
    ("shear_flow_factor", "shear flow factor", "dashed", 0),
    ("shear_stress_factor", "friction factor of the mean shear", "line", 1),
    ("shear_stress_correction", "friction factor of roughness-induced pressure", "dashed", 1),
    ("pressure_stress_factor", "friction factor of the pressure gradient", "dotted", 1),
)


@plotted(panels=3)
def film_profiles(profiles: xr.Dataset | Sequence[xr.Dataset]) -> FigureSpec:
    """Draw separation, contact pressure and fluid pressure across the contact at several speeds.

    The flat slides to +x, so the inlet is on the left.

    Parameters
    ----------
    profiles
        ``x``, ``separation`` [m], ``contact_pressure``, ``fluid_pressure`` [Pa] (sliding_speed,
        point); or several results of `tribolab.lubrication.film_profile` (x).

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> psd = xu2026.psd("Sb-S", points=301)
    >>> films = [
    ...     tl.lubrication.film_profile(xu2026.contact, psd, "1.4 Pa s", "310 N/m", v, cells=100)
    ...     for v in ("10 um/s", "1 mm/s")
    ... ]
    >>> tl.plot.figure_data(film_profiles(films)).series.unique().tolist()
    ['10 µm/s', '1 mm/s']
    """
    if isinstance(profiles, xr.Dataset):
        profiles = [profiles.isel(sliding_speed=n) for n in range(profiles.sizes["sliding_speed"])]
    series = []
    pressures = [(p["contact_pressure"] + p["fluid_pressure"]).values for p in profiles]
    least = _MIN_PRESSURE_SHARE * max(pressure.max() for pressure in pressures)
    widest = max(
        np.abs(profile["x"].values[pressure > least]).max(initial=0.0)
        for profile, pressure in zip(profiles, pressures, strict=True)
    )
    for number, profile in enumerate(profiles):
        label = speed_text(float(profile["sliding_speed"]))
        inside = np.flatnonzero(np.abs(profile["x"].values) <= 1.05 * widest)
        kept = inside[thinned(inside.size, _MAX_POINTS)]
        for panel, (name, factor, _) in enumerate(_PANELS):
            x, y = 1e3 * profile["x"].values[kept], factor * profile[name].values[kept]
            if name == "separation":  # outside the contact, separation increases without limit
                y = np.where(y <= _WIDEST_GAP * y.min(), y, np.nan)
            series.append(Series(label, x, y, colour=number, panel=panel))
    return FigureSpec(
        title="Across the contact",
        note="The flat slides to the right. Mean separation, pressure in the solid contact and in "
        "the liquid; a colour for each sliding speed.",
        panels=tuple(Panel(_ACROSS, y, name=name) for name, _, y in _PANELS),
        series=tuple(series),
        across=3,
    )


@plotted(panels=2)
def lubrication_factors(
    factors: Mapping[str, xr.Dataset] | xr.Dataset, *, surfaces: Sequence[str] = ()
) -> FigureSpec:
    """Draw flow factors and friction factors against separation divided by the rms roughness.

    Parameters
    ----------
    factors
        The five factors (separation) with the attribute ``rms_roughness_m``, by the surface's
        name; or one dataset (surface, relative_separation), from
        `tribolab.lubrication.relative_flow_factors`.
    surfaces
        All surfaces of the study in their order, so that each has the same colour in all figures.

    Examples
    --------
    >>> import tribolab as tl
    >>> from tribolab.studies import xu2026
    >>> table = tl.lubrication.flow_factors(xu2026.psd("Sb-S", points=301))
    >>> over = table.rms_roughness * np.geomspace(0.3, 3, 5)
    >>> figure = lubrication_factors({"Sb-S": table.dataset(over)})
    >>> tl.plot.figure_data(figure).pressure_flow_factor.dropna().round(2).tolist()
    [0.0, 0.09, 0.35, 0.61, 0.8]
    """
    if isinstance(factors, xr.Dataset):
        factors = {str(s): factors.sel(surface=s) for s in factors["surface"].values}
    colours = surface_colours([*surfaces, *factors])
    series = []
    for name, data in factors.items():
        over = _relative_separation(data)
        for key, words, style, panel in _FACTORS:
            numbers = {"separation_over_rms_roughness": over, key: data[key].values}
            series.append(
                Series(name, over, data[key].values, style, colours[name], panel, surface=name,
                       hover=(f"{name}: {words}",), columns=numbers)
            )  # fmt: skip
    x = Axis(
        "mean separation / rms roughness",
        log=True,
        paper=r"mean separation / roughness $\bar u/h_{\mathrm{rms}}$",
    )
    return FigureSpec(
        title="Flow and friction factors",
        note="Effect of roughness on the flow of the liquid (first panel: solid, by pressure; "
        "dashed, by shear) and on its friction (second panel: solid, mean shear; dashed, "
        "roughness-induced pressure; dotted, pressure gradient). Where surfaces agree, their lines "
        "overlap.",
        panels=(
            Panel(x, Axis("flow factor"), name="flow factors"),
            Panel(x, Axis("friction factor", log=True, decades=4), name="friction factors"),
        ),
        series=tuple(series),
        marks=(Mark("y", 0.0),),
        keys=(
            Key(r"pressure; mean shear"),
            Key(r"shear; roughness pressure", "dashed"),
            Key(r"pressure gradient", "dotted"),
        ),
        across=2,
    )


def _relative_separation(factors: xr.Dataset) -> np.ndarray:
    """Return the separation divided by the rms roughness."""
    if "relative_separation" in factors.coords:
        return factors["relative_separation"].to_numpy()
    return factors["separation"].to_numpy() / float(factors.attrs["rms_roughness_m"])
