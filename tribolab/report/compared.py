"""Segments of all runs of a results folder in one dataset, to compare runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr


def joined_runs(results: Mapping[str, xr.Dataset], facts: Mapping[str, Any]) -> xr.Dataset:
    """Return the segments of several runs as one dataset (run, segment).

    Parameters
    ----------
    results
        Results (segment) by name of the run; variables with other dims are left out.
    facts
        ``surface``, ``medium``, ``quality`` and ``normal_force`` [N] of each run, by name.

    Returns
    -------
    xarray.Dataset
        Variables (run, segment). If a run has fewer segments or lacks a variable, numbers are
        NaN and texts empty.

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
    """Return one variable of all runs (run, segment), padded with NaN, or "" for texts."""
    text = first.dtype.kind in "OUS"
    whole = all(values is not None and values.size == longest for values in given)
    dtype = object if text else first.dtype if whole else float
    rows = np.full((len(given), longest), "" if text else 0 if whole else np.nan, dtype=dtype)
    for row, values in zip(rows, given, strict=True):
        if values is not None and values.dims == ("segment",):
            row[: values.size] = values.to_numpy()
    return rows
