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

_REACH = 0.05  # of a profile's length, from which on its heights are doubted
_STEEP = 1.0  # rms slope: 45 deg all over
_FEWEST = 16  # heights of a profile that is doubted


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


def doubt_about_heights(scan: xr.Dataset) -> str:
    """Say that a profile's heights are large for its length, as they are in a wrong unit; else "".

    Parameters
    ----------
    scan
        ``height`` [m] (..., x); of a map nothing is said.

    Examples
    --------
    >>> x = 1e-6 * np.arange(1000)
    >>> rough = xr.Dataset({"height": ("x", 1e-4 * np.sin(x / 2e-6))}, {"x": x})
    >>> doubt_about_heights(rough)
    'heights reach over 20 % of the length, with an rms slope of 35: is their unit, or that of x, \
right?'
    >>> doubt_about_heights(rough.assign(height=rough.height / 1000))
    ''
    """
    if "y" in scan.height.dims or scan.sizes["x"] < _FEWEST:
        return ""
    x = scan.x.values
    length = float(x[-1] - x[0])
    reach, slope = 0.0, 0.0
    for row in scan.height.transpose(..., "x").values.reshape(-1, x.size):
        present = np.isfinite(row)
        if present.sum() < _FEWEST:
            continue
        bowed = np.polynomial.Polynomial.fit(x[present], row[present], 2)
        rest = row[present] - bowed(x[present])
        low, high = np.percentile(rest, [0.5, 99.5])  # spikes are no surface
        steps = np.diff(rest) / np.diff(x[present])
        reach = max(reach, float(high - low) / length)
        slope = max(slope, float(np.sqrt(np.mean(steps**2))))
    if reach < _REACH and slope < _STEEP:
        return ""
    return (
        f"heights reach over {100 * reach:.2g} % of the length, with an rms slope of {slope:.2g}: "
        "is their unit, or that of x, right?"
    )
