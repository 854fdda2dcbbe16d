"""Mask of the segments that a person rejected, and results with and without them.

Rejected segments stay in every dataset, marked by ``rejected``, so that they can be shown.
Functions that combine segments exclude them by `kept`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

REJECTED = "rejected"


def rejected(data: xr.Dataset) -> np.ndarray:
    """Return a mask of the rejected segments (segment).

    Examples
    --------
    >>> import xarray as xr
    >>> rejected(xr.Dataset({"rejected": ("segment", [0, 1])})).tolist()
    [False, True]
    """
    if REJECTED in data:
        return np.asarray(data[REJECTED].values) == 1
    return np.zeros(data.sizes.get("segment", 0), dtype=bool)


def kept(data: xr.Dataset) -> xr.Dataset:
    """Return the data without rejected segments and their events."""
    out = rejected(data)
    if not out.any():
        return data
    left = data.isel(segment=np.flatnonzero(~out))
    if "event_segment" not in left:
        return left
    own = np.isin(left["event_segment"].values, left["segment"].values)
    return left.isel(event=np.flatnonzero(own))


def compute_both(segments: xr.Dataset, compute: Callable[[xr.Dataset], xr.Dataset]) -> xr.Dataset:
    """Return results of all segments; those of kept segments are computed without rejected ones.

    A stroke that slipped off the sample must not affect the zero of its neighbours; its own result
    is added for display.

    Parameters
    ----------
    segments
        With ``rejected`` if a person decided.
    compute
        Computes a result from segments.
    """
    out = rejected(segments)
    result = compute(segments)
    if not out.any():
        return result
    if not out.all():
        own = compute(kept(segments))
        for name, variable in own.data_vars.items():
            values = result[name].values.copy()
            values[~out] = variable.values
            result[name] = "segment", values, variable.attrs
        result = result.assign_attrs(own.attrs)
    if "pair" in result:  # rejected segments are in no pair
        result["pair"] = result["pair"].copy(data=np.where(out, -1, result["pair"].values))
    return result
