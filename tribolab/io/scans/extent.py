"""How large a scan is: the part of a map that was measured, and sizes that no scan has."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.errors import ReadError
from tribolab.provenance import history_line
from tribolab.words import Count

_LARGEST_MAP = 10.0  # m; gantries with optical gauges reach one
_FINEST = 1e-13  # m, a tenth of the finest steps of a tunnelling microscope


def measured_part(scan: xr.Dataset) -> xr.Dataset:
    """Cut a map to the rectangle outside of which no height was measured; x and y begin at 0.

    Examples
    --------
    >>> nan = np.nan
    >>> axes = {"y": [0.0, 1e-6], "x": [0.0, 1e-6, 2e-6]}
    >>> scan = xr.Dataset({"height": (("y", "x"), [[nan, 1.0, nan], [nan, 1.0, 2.0]])}, axes)
    >>> part = measured_part(scan)
    >>> part.height.shape, part.x.values.tolist(), part.attrs["cropped"]
    ((2, 2), [0.0, 1e-06], '1 column at the border without a height was cut off')
    """
    if "y" not in scan.height.dims:
        return scan
    present = np.isfinite(scan.height.transpose("y", "x").values)
    if not present.any():
        return scan
    cut, lost = {}, {}
    for axis, dim, name in ((1, "y", "row"), (0, "x", "column")):
        measured = np.flatnonzero(present.any(axis=axis))
        first, last = int(measured[0]), int(measured[-1]) + 1
        cut[dim], lost[name] = slice(first, last), scan.sizes[dim] - (last - first)
    if not any(lost.values()) or min(part.stop - part.start for part in cut.values()) < 2:
        return scan
    part = scan.isel(cut)
    part = part.assign_coords({dim: part[dim] - part[dim][0] for dim in ("y", "x")})
    told = " and ".join(
        f"{Count(number):{name}|{name}s}" for name, number in lost.items() if number
    )
    were = "was" if sum(lost.values()) == 1 else "were"
    text = f"{told} at the border without a height {were} cut off"
    history = "\n".join(filter(None, [scan.attrs.get("history", ""), history_line(text)]))
    return part.assign_attrs(cropped=text, history=history)


def refuse_impossible(path: Path, scan: xr.Dataset) -> None:
    """Refuse a map that is larger, or a scan that is finer, than any instrument measures.

    Raises
    ------
    ReadError
        If it is.
    """
    for dim in ("x", "y") if "y" in scan.height.dims else ("x",):
        values = scan[dim].values
        if values.size < 2:
            continue
        length = float(values[-1] - values[0])
        pitch = length / (values.size - 1)
        if "y" in scan.height.dims and length > _LARGEST_MAP:
            raise ReadError(
                f"{path}: by its units the map is {length:.4g} m long along {dim}, which no "
                "instrument measures; the unit of its positions is wrong: export it with another "
                "one, or as text, whose unit a dialect can say"
            )
        if not pitch >= _FINEST:
            raise ReadError(
                f"{path}: by its units the points are {pitch:.3g} m apart along {dim}, less than "
                "atoms are; the unit of its positions is wrong: export it with another one"
            )
