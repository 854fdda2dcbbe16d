"""The joint fit of all loads on the page: curves with their band, and what they leave over."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.campaign.store.data_files import read_data
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, safe
from tribolab.records.joint_record import JointRecord
from tribolab.report.live.curves import system_name
from tribolab.report.live.record import LiveRecord
from tribolab.report.live.shown import shown_figures
from tribolab.words import many


def record_of_joint_fits(joints: Sequence[JointRecord], folder: Path) -> LiveRecord:
    """Return a figure for each joint fit.

    Parameters
    ----------
    joints
        Those that are done.
    folder
        The results folder with their data files.
    """
    return LiveRecord(shown_figures(_figure(joint, folder) for joint in joints))


def _figure(joint: JointRecord, folder: Path) -> FigureSpec:
    points, curves = (read_data(folder / joint.file, part) for part in ("points", "curves"))
    series: list[Series] = []
    for number, name in enumerate(curves["curve"].values.tolist()):
        mine = points.isel(point=points["curve"].values == name)
        series += _of_load(str(name), number, mine, curves.sel(curve=name))
    name = system_name(joint.surface, joint.medium)
    x = Axis("sliding speed v", "m/s", log=True)
    return FigureSpec(
        f"model-joint-{safe(name)}",
        "model",
        f"{name}: all loads in one fit",
        "Lines: the model at each load; bands: 95 %, by the parameters and by the errors that the "
        "points of a load share. Below: measured over computed less 1; lines: what of it is "
        "ascribed to the level of a load and to neighbouring speeds.",
        f"Measured friction of {name}, {many(curves.sizes['curve'], 'curve')} beside the joint "
        "fit, and what is left.",
        (Panel(x, Axis("friction coefficient µ")), Panel(x, Axis("difference", "% of µ"))),
        tuple(series),
        width="whole",
    )


def _of_load(name: str, number: int, points: xr.Dataset, curve: xr.Dataset) -> list[Series]:
    """Return band, line, points and differences of one load."""
    v, measured = curve["sliding_speed"].values, points["sliding_speed"].values
    mu, sem = (points[f"friction_coefficient{end}"].values for end in ("", "_sem"))
    off, shared = (
        100 * np.expm1(points[part].values) for part in ("relative_residual", "shared_residual")
    )
    ends = (curve[f"friction_coefficient_load_{end}"].values for end in ("low", "high"))
    low, high = ends
    return [
        Series(name, v, low, "band", number, high=high),
        Series(name, v, curve["friction_coefficient"].values, "line", number),
        Series(name, measured, mu, "points", number, error=sem.tolist()),
        Series(name, measured, off, "points", number, 1, error=(100 * sem / mu).tolist()),
        Series(name, measured, shared, "line", number, 1),
    ]
