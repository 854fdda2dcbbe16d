"""The figures that compare measured curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab import plot
from tribolab.campaign.store.data_files import read_data
from tribolab.report.figures.files import Drawn
from tribolab.words import force_text, many, span, speeds

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.records.parts import CurveOutcome

_MOST_IN_ONE = 9  # curves that can be told apart in one figure
_BARS = (
    "Markers: mean over the strokes; bars: U95 (expanded uncertainty, 95 % coverage). Dry: open "
    "markers, dashed."
)


@dataclass(frozen=True)
class CurveFigure:
    """A figure to draw: which curves, what it is called, where it goes."""

    curves: tuple[CurveOutcome, ...]
    title: str
    file: str
    kind: str
    surfaces: tuple[str, ...]

    @property
    def files(self) -> tuple[str, ...]:
        """Data files that it reads."""
        return tuple(curve.data_file for curve in self.curves)


def surface_of(curve: CurveOutcome) -> str:
    """Return the surface; runs that name neither surface nor medium stand for themselves."""
    if curve.surface or curve.medium:
        return curve.surface
    return "; ".join(curve.run_names)


def read_curve(folder: Path, curve: CurveOutcome) -> xr.Dataset:
    """Open a measured curve, labelled for `tribolab.plot.stribeck`."""
    data = read_data(folder / curve.data_file)
    data.attrs |= {"surface": surface_of(curve), "medium": curve.medium}
    if curve.normal_force is not None:
        data.attrs["normal_force_N"] = curve.normal_force
    return data


def plan_figures(curves: Sequence[CurveOutcome]) -> list[CurveFigure]:
    """Choose the figures: one per surface with all its loads, one per load with all surfaces."""
    surfaces = tuple(dict.fromkeys(surface_of(curve) for curve in curves))
    planned = []
    for number, surface in enumerate(surfaces):
        mine = [curve for curve in curves if surface_of(curve) == surface]
        for part, chosen in enumerate(_parts(mine)):
            file = (
                f"figures/stribeck_surface_{number + 1}{'abcdefgh'[part % 8] if part else ''}.svg"
            )
            title = surface or "surface not named"
            planned.append(CurveFigure(chosen, title, file, "surface", surfaces))
    loads = dict.fromkeys(curve.normal_force for curve in curves)
    for number, load in enumerate(sorted(loads, key=lambda x: (x is None, x or 0.0))):
        mine = [curve for curve in curves if curve.normal_force == load and curve.surface]
        if len({curve.surface for curve in mine}) > 1:
            file = f"figures/stribeck_load_{number + 1}.svg"
            title = force_text(load)
            chosen = tuple(mine[:_MOST_IN_ONE])
            planned.append(CurveFigure(chosen, title, file, "load", surfaces))
    return planned


def _parts(curves: list[CurveOutcome]) -> list[tuple[CurveOutcome, ...]]:
    steps = range(0, len(curves), _MOST_IN_ONE)
    return [tuple(curves[k : k + _MOST_IN_ONE]) for k in steps]


def draw_curves(what: CurveFigure, folder: Path) -> Drawn:
    """Draw one figure of measured curves."""
    data = [read_curve(folder, curve) for curve in what.curves]
    values = [v for curve in data for v in curve["friction_coefficient"].values.tolist()]
    speed = [v for curve in data for v in curve["sliding_speed"].values.tolist()]
    count = many(len(data), "measured curve")
    alt = (
        f"Friction coefficient over sliding speed, {what.title}: {count} at {speeds(speed)}, "
        f"µ from {span(values)}."
    )
    figure = plot.stribeck(data, surfaces=what.surfaces, title=what.title)
    return Drawn(figure, f"{what.title}. {_BARS}", alt, what.kind)
