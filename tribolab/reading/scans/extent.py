"""Extent of a scan: measured part of a map, and limits of plausible sizes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError
from tribolab.core.provenance import history_line
from tribolab.core.wording import Count
from tribolab.reading.scans.limits import (
    DOUBTFUL_REACH,
    DOUBTFUL_SLOPE,
    FINEST_LONG_REACH,
    FINEST_PITCH,
    LARGEST_MAP,
    LARGEST_REACH,
    LONGEST_PROBE_SCAN,
    MIN_HEIGHTS_OF_LINE,
)

_LINES = 16  # lines along x and y used to judge a map
_USUAL = (0.5, 99.5)  # percentiles that exclude spikes and sentinels


class RefusedScanError(ReadError):
    """Raised if a file certainly contains a scan, and its problem is known."""


def measured_part(scan: xr.Dataset) -> xr.Dataset:
    """Crop a map to the rectangle with measured heights; x and y begin at 0.

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
    shares = " and ".join(
        f"{Count(number):{name}|{name}s}" for name, number in lost.items() if number
    )
    were = "was" if sum(lost.values()) == 1 else "were"
    text = f"{shares} at the border without a height {were} cut off"
    history = "\n".join(filter(None, [scan.attrs.get("history", ""), history_line(text)]))
    return part.assign_attrs(cropped=text, history=history)


def refuse_impossible(path: Path, scan: xr.Dataset) -> None:
    """Raise if a map is larger, or a scan finer, than any instrument can measure.

    Raises
    ------
    RefusedScanError
        If the size is impossible.
    """
    for dim in _axes(scan):
        values = scan[dim].values
        if values.size < 2:
            continue
        length = float(values[-1] - values[0])
        pitch = length / (values.size - 1)
        if "y" in scan.height.dims and length > LARGEST_MAP.value:
            raise RefusedScanError(
                f"{path}: by its units the map is {length:.4g} m long along {dim}, which no "
                "instrument measures; the unit of its positions is wrong: export it with another "
                "one, or as text, whose unit a dialect can say"
            )
        if not pitch >= FINEST_PITCH.value:
            raise RefusedScanError(
                f"{path}: by its units the points are {pitch:.3g} m apart along {dim}, less than "
                "atoms are; the unit of its positions is wrong: export it with another one"
            )


def doubt_about_heights(scan: xr.Dataset) -> str:
    """Return a doubt if heights are too large for the length of a scan (wrong unit?); else "".

    Parameters
    ----------
    scan
        ``height`` [m] (..., x) of profiles, (y, x) of a map.

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
    reach, slope = 0.0, 0.0
    if impossible := impossible_heights(scan):
        return impossible
    for dim in _axes(scan):
        x = scan[dim].values
        rows = scan.height.transpose(..., dim).values.reshape(-1, x.size)
        if "y" in scan.height.dims:
            rows = rows[:: -(-len(rows) // _LINES)]
        for row in rows:
            present = np.isfinite(row)
            if present.sum() < MIN_HEIGHTS_OF_LINE.value:
                continue
            own_reach, own_slope = _reach_and_slope(x[present], row[present])
            reach, slope = max(reach, own_reach), max(slope, own_slope)
    if reach < DOUBTFUL_REACH.value and slope < DOUBTFUL_SLOPE.value:
        return ""
    return (
        f"heights reach over {100 * reach:.2g} % of the length, with an rms slope of {slope:.2g}: "
        "is their unit, or that of x, right?"
    )


def impossible_heights(scan: xr.Dataset) -> str:
    """Return an error text if heights are impossibly large for the size of a scan; else ""."""
    length = max(float(np.ptp(scan[dim].values)) for dim in _axes(scan))
    known = scan.height.values[np.isfinite(scan.height.values)]
    span = float(np.ptp(np.percentile(known, _USUAL))) if known.size else 0.0
    if span <= LARGEST_REACH.value * length:
        return ""
    return (
        f"the heights span {span:.3g} m on a length of {length:.3g} m, which no instrument "
        "measures: the unit of the heights, or that of x, is wrong"
    )


def _axes(scan: xr.Dataset) -> tuple[str, ...]:
    return ("x", "y") if "y" in scan.height.dims else ("x",)


def _reach_and_slope(x: np.ndarray, height: np.ndarray) -> tuple[float, float]:
    """Return height range divided by length, and rms slope, of a line without its curvature."""
    rest = height - np.polynomial.Polynomial.fit(x, height, 2)(x)
    reach = float(np.ptp(np.percentile(rest, _USUAL))) / float(x[-1] - x[0])
    return reach, float(np.sqrt(np.mean((np.diff(rest) / np.diff(x)) ** 2)))


def likely_height_unit(numbers: np.ndarray, pitch: float) -> str:
    """Return the only unit that gives plausible heights; "" if several do.

    Parameters
    ----------
    numbers
        Heights of a profile as in the file (x).
    pitch
        Distance of neighbouring heights [m].

    Examples
    --------
    >>> heights = 0.4 * np.sin(np.arange(8000) / 40)
    >>> likely_height_unit(heights, 0.5e-6), likely_height_unit(heights, 0.5e-9)
    ('um', 'nm')
    """
    height = numbers[np.isfinite(numbers)]
    if height.size < MIN_HEIGHTS_OF_LINE.value:
        return ""
    x = pitch * np.arange(height.size)
    fitting = []
    for unit, metres in (("nm", 1e-9), ("um", 1e-6), ("mm", 1e-3), ("m", 1.0)):
        reach, slope = _reach_and_slope(x, metres * height)
        steep = slope >= DOUBTFUL_SLOPE.value or reach >= DOUBTFUL_REACH.value
        fine = x[-1] > LONGEST_PROBE_SCAN.value and reach * x[-1] < FINEST_LONG_REACH.value
        fitting += [] if steep or fine else [unit]
    return fitting[0] if len(fitting) == 1 else ""
