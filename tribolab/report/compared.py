"""All runs, or all measured curves, of a results folder in one dataset, to be compared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from tribolab.stamping import stamp

_TOLERANCE = 0.1  # of speeds that belong together, as for `measured_stribeck_curve`


def joined_runs(results: Mapping[str, xr.Dataset], facts: Mapping[str, Any]) -> xr.Dataset:
    """Put the segments of runs side by side.

    Parameters
    ----------
    results
        Results over (segment), by the run's name; what is over other dims is left out.
    facts
        ``surface``, ``medium``, ``quality`` and ``normal_force`` [N] of each run, by name.

    Returns
    -------
    xarray.Dataset
        Everything over (run, segment). Where a run has fewer segments, or lacks a variable,
        numbers are NaN and texts empty.

    Examples
    --------
    >>> one, two = (xr.Dataset({"friction_coefficient": ("segment", mu)}) for mu in ([1, 2], [3]))
    >>> known = {"surface": "Sb-R", "medium": "dry", "quality": "pass", "normal_force": 31.0}
    >>> joined_runs({"a": one, "b": two}, {"a": known, "b": known}).friction_coefficient.values
    array([[ 1.,  2.],
           [ 3., nan]])
    """
    names = list(results)
    longest = max((data.sizes.get("segment", 0) for data in results.values()), default=0)
    variables: dict[str, xr.DataArray] = {}
    for data in results.values():
        for name, variable in data.data_vars.items():
            if variable.dims == ("segment",):
                variables.setdefault(str(name), variable)
    columns = {
        name: _rows([data.get(name) for data in results.values()], longest, first)
        for name, first in variables.items()
    }
    labels: dict[str, tuple[str, np.ndarray]] = {
        key: ("run", np.array([facts[name][key] for name in names], dtype=object))
        for key in ("surface", "medium", "quality")
    }
    loads = [facts[name]["normal_force"] for name in names]
    labels["nominal_normal_force"] = "run", np.array(loads, dtype=float)
    joined = xr.Dataset(
        {name: (("run", "segment"), values) for name, values in columns.items()},
        {"run": np.array(names, dtype=object), "segment": np.arange(longest), **labels},
    )
    for name, first in variables.items():
        joined[name].attrs = dict(first.attrs)
    joined["nominal_normal_force"].attrs = {
        "units": "N",
        "long_name": "set-point of the normal force",
    }
    return joined


def _rows(given: Sequence[xr.DataArray | None], longest: int, first: xr.DataArray) -> np.ndarray:
    """Values of a variable (run, segment), filled where a run has none."""
    text = first.dtype.kind in "OUS"
    whole = all(one is not None and one.size == longest for one in given)
    dtype = object if text else first.dtype if whole else float
    rows = np.full((len(given), longest), "" if text else 0 if whole else np.nan, dtype=dtype)
    for row, one in zip(rows, given, strict=True):
        if one is not None and one.dims == ("segment",):
            row[: one.size] = one.to_numpy()
    return rows


def joined_curves(curves: Sequence[tuple[xr.Dataset, str, str, float]]) -> xr.Dataset:
    """Put measured curves on common axes.

    Parameters
    ----------
    curves
        Each curve (sliding_speed) with its surface, medium and normal force [N].

    Returns
    -------
    xarray.Dataset
        Everything over (surface, medium, normal_force, sliding_speed); NaN where nothing was
        measured. Speeds that differ by no more than a tenth stand together at their geometric
        mean; ``measured_speed`` is each curve's own.

    Examples
    --------
    >>> dry, wet = (
    ...     xr.Dataset({"friction_coefficient": ("sliding_speed", mu)}, {"sliding_speed": v})
    ...     for v, mu in (([1.0e-3, 1e-2], [0.9, 0.8]), ([1.01e-3], [0.3]))
    ... )
    >>> curves = joined_curves([(dry, "Sb-R", "dry", 31.0), (wet, "Sb-R", "water", 31.0)])
    >>> mu = curves.friction_coefficient.sel(surface="Sb-R", normal_force=31)
    >>> mu.sel(medium="dry").values - mu.sel(medium="water").values
    array([0.6, nan])
    """
    speeds, places = _common_speeds([data["sliding_speed"].to_numpy() for data, *_ in curves])
    surfaces = list(dict.fromkeys(surface for _, surface, _, _ in curves))
    media = list(dict.fromkeys(medium for _, _, medium, _ in curves))
    loads = np.unique(np.array([load for *_, load in curves], dtype=float))
    shape = (len(surfaces), len(media), loads.size, speeds.size)
    values: dict[str, np.ndarray] = {}
    for (data, surface, medium, load), place in zip(curves, places, strict=True):
        rank = loads.size - 1 if np.isnan(load) else int(np.searchsorted(loads, load))
        at = (surfaces.index(surface), media.index(medium), rank, place)
        own = data.reset_coords().assign(measured_speed=data["sliding_speed"])
        for name, variable in own.data_vars.items():
            if variable.dims == ("sliding_speed",) and name != "sliding_speed":
                values.setdefault(str(name), np.full(shape, np.nan))[at] = variable.to_numpy()
    dims = ("surface", "medium", "normal_force", "sliding_speed")
    texts = (np.array(surfaces, dtype=object), np.array(media, dtype=object))
    coords = dict(zip(dims, (*texts, loads, speeds), strict=True))
    return stamp(xr.Dataset({name: (dims, one) for name, one in values.items()}, coords))


def _common_speeds(given: Sequence[np.ndarray]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Speeds of all curves [m/s], and the places of each curve's among them."""
    owner = np.repeat(np.arange(len(given)), [speeds.size for speeds in given])
    every = np.concatenate([*given, np.zeros(0)])
    place = np.zeros(every.size, dtype=int)
    group: list[int] = []
    groups: list[list[int]] = []
    for index in np.argsort(every, kind="stable"):
        near = group and np.log(every[index] / every[group[-1]]) <= np.log1p(_TOLERANCE)
        if not near or owner[index] in owner[group]:  # a curve's own speeds stay apart
            group = []
            groups.append(group)
        group.append(int(index))
        place[index] = len(groups) - 1
    means = np.array([np.exp(np.log(every[members]).mean()) for members in groups])
    return means, [place[owner == number] for number in range(len(given))]
