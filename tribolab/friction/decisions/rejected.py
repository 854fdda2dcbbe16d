"""Segments that a person rejected: which they are, results without them, and both side by side.

What is rejected stays in every dataset, marked by ``rejected``, so that it can be shown; what
combines segments leaves it out by `kept`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

REJECTED = "rejected"


def rejected(data: xr.Dataset) -> np.ndarray:
    """Return which segments a person rejected (segment); none where nobody decided.

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
    """Return the data without the segments that a person rejected, and without their events."""
    out = rejected(data)
    if not out.any():
        return data
    left = data.isel(segment=np.flatnonzero(~out))
    if "event_segment" not in left:
        return left
    own = np.isin(left["event_segment"].values, left["segment"].values)
    return left.isel(event=np.flatnonzero(own))


def beside_rejected(
    segments: xr.Dataset, compute: Callable[[xr.Dataset], xr.Dataset]
) -> xr.Dataset:
    """Compute segments as if the rejected ones were not there, and these as if they were.

    A stroke that slipped off the sample must not tell the zero of its neighbours; what it would
    have been stands beside them, to be shown.

    Parameters
    ----------
    segments
        With ``rejected`` where a person decided.
    compute
        Makes a result on the same segments from segments.
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
    if "pair" in result:  # the pairs are those of the others
        result["pair"] = result["pair"].copy(data=np.where(out, -1, result["pair"].values))
    return result
