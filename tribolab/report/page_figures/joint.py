"""Figures of joint fits: one shear-stress fit to the curves at all loads of a surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from tribolab.campaign.store.data_files import read_data
from tribolab.core.wording import many
from tribolab.figures.spec import FigureSpec, safe
from tribolab.figures.subjects.fits import joint_fit
from tribolab.records.models.joint_record import JointRecord
from tribolab.report.page_figures.curves import system_name


class _Fitted(NamedTuple):
    """Measured points and fitted curves of a joint fit, as the figure needs them."""

    points: xr.Dataset
    curves: xr.Dataset


def joint_specs(
    joints: Sequence[JointRecord], surfaces: Sequence[str], folder: Path
) -> list[FigureSpec]:
    """Return a figure for each joint fit: measured points, fitted curves and residuals.

    Parameters
    ----------
    joints
        Joint fits with results.
    surfaces
        Names in the order of the campaign, which sets colours.
    folder
        The results folder with their data files.
    """
    specs = []
    for joint in joints:
        fit = _Fitted(*(read_data(folder / joint.file, part) for part in ("points", "curves")))
        name = system_name(joint.surface, joint.medium)
        counted = many(fit.curves.sizes["curve"], "curve")
        spec = joint_fit.spec(fit, surface=joint.surface, surfaces=surfaces)
        specs.append(
            replace(
                spec,
                id=f"model-joint-{safe(name)}",
                section="model",
                title=f"{name}: all loads in one fit",
                alt=f"Measured friction of {name}, {counted}, with the joint fit and residuals.",
                width="whole",
            )
        )
    return specs
