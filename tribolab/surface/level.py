"""Detection of scans without roughness: perfectly flat or straight apart from rounding."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError

# Smaller deviations, relative to the largest height, are rounding errors: floats have 16 digits,
# of which the form fit loses a few; the best instruments resolve 8.
_ROUNDING = 1e-12
_CHUNK = 1 << 20


def rounding_only(deviation: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """Return a mask of the rows whose residual heights are only rounding errors.

    Parameters
    ----------
    deviation
        Heights [m] (row, ...) after form removal; NaN is ignored.
    heights
        The measured heights [m] (row, x), whose size determines the rounding errors.

    Returns
    -------
    numpy.ndarray
        Mask (row). Rows without any height are not level.

    Examples
    --------
    >>> heights = np.array([[1e-6, 1e-6], [1e-6, 2e-6]])
    >>> rounding_only(heights - heights.mean(1, keepdims=True), heights).tolist()
    [True, False]
    """
    largest, left = _largest(heights), _largest(deviation)
    return (np.nan_to_num(left) <= _ROUNDING * np.nan_to_num(largest)) & ~np.isnan(left)


def _largest(rows: np.ndarray) -> np.ndarray:
    """Return the largest magnitude of the finite values of each row; NaN if there are none."""
    largest = np.maximum(np.fmax.reduce(rows, axis=-1), -np.fmin.reduce(rows, axis=-1))
    for row in np.flatnonzero(np.isinf(largest)):
        finite = rows[row][np.isfinite(rows[row])]
        largest[row] = np.abs(finite).max() if finite.size else np.nan
    return np.asarray(largest)


def level_rows(height: np.ndarray) -> np.ndarray:
    """Return a mask of the rows (row, x) whose heights all lie on one straight line.

    Examples
    --------
    >>> level_rows(np.array([[1e-6, 1e-6, 1e-6], [1e-6, 2e-6, 3e-6], [0.0, 1e-9, 0.0]])).tolist()
    [True, True, False]
    """
    rows, points = height.shape
    way = np.linspace(0.0, 1.0, points)
    step = max(1, _CHUNK // points)
    level = np.zeros(rows, dtype=bool)
    for first in range(0, rows, step):
        part = np.asarray(height[first : first + step], dtype=float)
        chord = part[:, :1] + (part[:, -1:] - part[:, :1]) * way
        level[first : first + step] = rounding_only(part - chord, part)
    return level


def level_map(height: np.ndarray) -> bool:
    """Return whether all heights (y, x) of a map lie on one plane."""
    first = slice(0, 8)  # the first rows already show that most maps are rough
    return bool(
        level_rows(height[first]).all() and level_rows(height).all() and level_rows(height.T).all()
    )


def refuse_level(who: str, scans: xr.Dataset, level: Sequence[bool] | np.ndarray) -> None:
    """Raise an error that names the first scan without roughness, if there is one.

    Parameters
    ----------
    who
        Name of the calling function.
    scans
        The scans, for their names.
    level
        Mask of the scans without roughness (scan).

    Raises
    ------
    AnalysisError
        If a scan is level.
    """
    at = np.flatnonzero(level)
    if not at.size:
        return
    if "file" in scans and np.size(scans["file"]) == len(level):
        name = str(np.atleast_1d(scans["file"].values)[at[0]])
    elif len(level) > 1:
        name = f"scan {at[0] + 1}"
    else:
        name = str(scans.attrs.get("source", ""))
    others = f" and {at.size - 1} more" if at.size > 1 else ""
    raise AnalysisError(
        "all heights are equal, or on a perfect line, plane or circle: without rounding there is "
        "no roughness. Check that the file contains the heights with enough digits, or leave "
        "that scan out",
        where=f"{name}{others}" if name else "",
        function=who,
    )
