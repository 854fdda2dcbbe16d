"""Machines with two rotating bodies: slide-roll ratio of a Stribeck curve, traction curves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.friction import limits
from tribolab.friction.points.limits import SPEED_TOLERANCE
from tribolab.friction.points.speed_groups import speed_groups
from tribolab.friction.stribeck import measured_stribeck_curve
from tribolab.units.stamping import stamp

_RATIO, _ROLLING = "slide_roll_ratio", "rolling_speed"


def stribeck_part(
    frictions: Sequence[xr.Dataset], tolerance: float = SPEED_TOLERANCE.value
) -> tuple[list[xr.Dataset], float | None]:
    """Return the segments at the slide-roll ratio of the Stribeck curve, and that ratio.

    Parameters
    ----------
    frictions
        Results of `tribolab.friction_coefficient` of one system.
    tolerance
        Largest relative difference of equal slide-roll ratios or speeds.

    Returns
    -------
    tuple
        The segments at the ratio with the most entrainment speeds; runs without such a segment are
        omitted. If no ratio is recorded, or nothing slides, the unchanged runs and None.

    Examples
    --------
    >>> run = xr.Dataset({
    ...     "slide_roll_ratio": ("segment", [0.5, 0.5, 0.5, 1.0]),
    ...     "rolling_speed": ("segment", [0.1, 0.2, 0.4, 0.4]),
    ... })
    >>> parts, ratio = stribeck_part([run])
    >>> parts[0].sizes["segment"], ratio
    (3, 0.5)
    """
    if not frictions or not all(_RATIO in f and _ROLLING in f for f in frictions):
        return list(frictions), None
    ratios = [np.abs(friction[_RATIO].values) for friction in frictions]
    every = np.concatenate(ratios)
    rolling = np.concatenate([np.abs(friction[_ROLLING].values) for friction in frictions])
    slides = (every > limits.MAX_RATIO_OF_PURE_ROLLING.value) & (rolling > 0)
    if not slides.any():
        return list(frictions), None
    level = speed_groups(every[slides], tolerance).group
    speed = speed_groups(rolling[slides], tolerance).group
    counts = [np.unique(speed[level == k]).size for k in range(level.max() + 1)]
    chosen = every[slides][level == int(np.argmax(counts))]
    low, high = chosen.min(), chosen.max()
    parts = [
        friction.isel(segment=(ratio >= low) & (ratio <= high))
        for friction, ratio in zip(frictions, ratios, strict=True)
    ]
    return [part for part in parts if part.sizes["segment"]], float(chosen.mean())


def traction_curves(
    frictions: Sequence[xr.Dataset], tolerance: float = SPEED_TOLERANCE.value
) -> xr.Dataset:
    """Return friction against slide-roll ratio at each entrainment speed with three or more ratios.

    Parameters
    ----------
    frictions
        Results of `tribolab.friction_coefficient` of one system, with ``rolling_speed`` and
        ``slide_roll_ratio`` of each segment.
    tolerance
        Largest relative difference of equal slide-roll ratios or speeds.

    Returns
    -------
    xarray.Dataset
        Over ``point``: ``rolling_speed`` [m/s], ``slide_roll_ratio`` [1], and friction with its
        errors as in `measured_stribeck_curve`. No points without such measurements.

    Raises
    ------
    AnalysisError
        If the segments have no entrainment speed or slide-roll ratio.

    Examples
    --------
    >>> run = xr.Dataset({
    ...     "slide_roll_ratio": ("segment", [0.1, 0.5, 1.0]),
    ...     "rolling_speed": ("segment", [0.1, 0.1, 0.1]),
    ...     "friction_coefficient": ("segment", [0.02, 0.05, 0.06]),
    ...     "friction_coefficient_std": ("segment", [0.001, 0.001, 0.001]),
    ...     "friction_coefficient_sem": ("segment", [0.001, 0.001, 0.001]),
    ... })
    >>> traction_curves([run]).friction_coefficient.values.tolist()
    [0.02, 0.05, 0.06]
    """
    if not frictions or not all(_RATIO in f and _ROLLING in f for f in frictions):
        raise AnalysisError(
            "the segments have no entrainment speed and slide-roll ratio",
            function="traction_curves",
        )
    sizes = [friction.sizes["segment"] for friction in frictions]
    ratio, rolling = (
        np.concatenate([np.abs(friction[name].values) for friction in frictions])
        for name in (_RATIO, _ROLLING)
    )
    slides = (ratio > limits.MAX_RATIO_OF_PURE_ROLLING.value) & (rolling > 0)
    group = np.full(ratio.size, -1)
    group[slides] = speed_groups(rolling[slides], tolerance).group
    curves = []
    for number in range(group.max(initial=-1) + 1):
        members = group == number
        if (
            np.unique(speed_groups(ratio[members], tolerance).group).size
            < limits.MIN_RATIOS_OF_TRACTION.value
        ):
            continue
        chosen = np.split(members, np.cumsum(sizes)[:-1])
        parts = [f.isel(segment=own) for f, own in zip(frictions, chosen, strict=True)]
        parts = [part for part in parts if part.sizes["segment"]]
        curve = measured_stribeck_curve(parts, tolerance, over=_RATIO)
        curve = curve.reset_index(_RATIO).reset_coords().rename_dims({_RATIO: "point"})
        speed = np.full(curve.sizes["point"], rolling[members].mean())
        curves.append(curve.assign({_ROLLING: ("point", speed)}))
    if not curves:
        return xr.Dataset({name: ("point", np.zeros(0)) for name in (_ROLLING, _RATIO)})
    return stamp(xr.concat(curves, "point", combine_attrs="drop_conflicts"))
