"""Measured curves of several surfaces, media or loads on common axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, shown
from tribolab.friction.points.limits import SPEED_TOLERANCE
from tribolab.units.quantities import QUANTITIES
from tribolab.units.stamping import stamp

Label = str | float


def grouped(
    runs: Sequence[xr.Dataset], labels: Mapping[str, Sequence[Label]], function: str
) -> list[tuple[list[xr.Dataset], dict[str, Label]]]:
    """Return the runs grouped by equal labels, with these labels.

    Parameters
    ----------
    runs
        Results, one for each run.
    labels
        Labels that distinguish the runs, by name, one for each run.
    function
        Name of the calling function, for the message.

    Raises
    ------
    AnalysisError
        If there is not one label for each run.
    """
    for name, given in labels.items():
        if isinstance(given, str) or len(given) != len(runs):
            raise AnalysisError(
                f"{shown(name)}: one label for each of {len(runs)} runs is wanted",
                function=function,
            )
    groups: dict[tuple[Label, ...], list[xr.Dataset]] = {}
    for run, *label in zip(runs, *labels.values(), strict=True):
        groups.setdefault(tuple(label), []).append(run)
    return [(group, dict(zip(labels, key, strict=True))) for key, group in groups.items()]


def joined_curves(curves: Sequence[tuple[xr.Dataset, Mapping[str, Label]]]) -> xr.Dataset:
    """Return several measured curves as one dataset with common axes.

    Parameters
    ----------
    curves
        Each curve (sliding_speed) with the labels that distinguish it, the same dims for all: names
        such as ``surface`` and ``medium``, or numbers in SI such as ``normal_force`` [N]; numbers
        under other names have no unit.

    Returns
    -------
    xarray.Dataset
        All variables over these dims and sliding_speed; NaN (text: "") if nothing was measured.
        Names keep their order, numbers ascend. Speeds that differ by no more than a tenth are
        combined at their geometric mean; ``measured_speed`` is the speed of each curve.

    Examples
    --------
    >>> dry, wet = (
    ...     xr.Dataset({"friction_coefficient": ("sliding_speed", mu)}, {"sliding_speed": v})
    ...     for v, mu in (([1.0e-3, 1e-2], [0.9, 0.8]), ([1.01e-3], [0.3]))
    ... )
    >>> curves = joined_curves([(dry, {"medium": "dry"}), (wet, {"medium": "water"})])
    >>> mu = curves.friction_coefficient
    >>> mu.sel(medium="dry").values - mu.sel(medium="water").values
    array([0.6, nan])
    """
    speeds, places = _common_speeds([data["sliding_speed"].to_numpy() for data, _ in curves])
    dims = list(curves[0][1]) if curves else []
    axes = {dim: _axis([labels[dim] for _, labels in curves]) for dim in dims}
    shape = (*(axis.size for axis in axes.values()), speeds.size)
    values: dict[str, np.ndarray] = {}
    for (data, labels), place in zip(curves, places, strict=True):
        at: tuple[int | np.ndarray, ...] = tuple(_index(axes[dim], labels[dim]) for dim in dims)
        at = (*at, place)
        own = data.reset_coords().assign(measured_speed=data["sliding_speed"])
        for name, variable in own.data_vars.items():
            if variable.dims == ("sliding_speed",) and name != "sliding_speed":
                text = variable.dtype.kind in "OU"
                empty = np.full(shape, "", object) if text else np.full(shape, np.nan)
                values.setdefault(str(name), empty)[at] = variable.to_numpy()
    whole = (*dims, "sliding_speed")
    foreign = {dim: axis for dim, axis in axes.items() if _is_foreign(dim, axis)}
    joined = stamp(
        xr.Dataset(
            {name: (whole, value) for name, value in values.items()},
            {dim: axis for dim, axis in axes.items() if dim not in foreign}
            | {"sliding_speed": speeds},
        )
    )
    return joined.assign_coords(foreign)


def _is_foreign(dim: str, axis: np.ndarray) -> bool:
    """Return whether an axis has numeric labels of a user's own, without a known unit."""
    return axis.dtype != object and dim not in QUANTITIES


def _axis(labels: Sequence[Label]) -> np.ndarray:
    """Return the distinct labels: names in order of appearance, or ascending numbers, NaN last."""
    if any(isinstance(label, str) for label in labels):
        return np.array(list(dict.fromkeys(labels)), dtype=object)
    return np.unique(np.array(labels, dtype=float))


def _index(axis: np.ndarray, label: Label) -> int:
    if axis.dtype == object or isinstance(label, str):
        names: list[Label] = axis.tolist()
        return names.index(label)
    return axis.size - 1 if np.isnan(label) else int(np.searchsorted(axis, label))


def _common_speeds(given: Sequence[np.ndarray]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the common speeds of all curves [m/s], and the index of each curve's speeds."""
    owner = np.repeat(np.arange(len(given)), [speeds.size for speeds in given])
    every = np.concatenate([*given, np.zeros(0)])
    place = np.zeros(every.size, dtype=int)
    group: list[int] = []
    groups: list[list[int]] = []
    for index in np.argsort(every, kind="stable"):
        near = group and np.log(every[index] / every[group[-1]]) <= np.log1p(SPEED_TOLERANCE.value)
        if not near or owner[index] in owner[group]:  # speeds of one curve stay separate
            group = []
            groups.append(group)
        group.append(int(index))
        place[index] = len(groups) - 1
    means = np.array([np.exp(np.log(every[members]).mean()) for members in groups])
    return means, [place[owner == number] for number in range(len(given))]
