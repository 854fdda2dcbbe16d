"""Even grids of scans: rounded positions become even, rows of x, y, z become a map."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.core.errors import ReadError

_JITTER = 0.01  # largest deviation from an even grid, in pitches, that is ignored
_LARGEST = 1e4  # m; longest profile
_MIN_SPACING = 1e-15  # m, about the size of a nucleus
_FILLED = 0.5  # share of grid points that must have heights
_CLOUD = (
    "of points that lie freely, as on circles, write each line as a profile (distance, height), or "
    "interpolate them to a grid"
)
_ROUNDED = 0.6  # largest deviation due to rounding, in units of the last digit


def even(
    where: str, x: np.ndarray, height: np.ndarray
) -> tuple[float, np.ndarray, dict[str, float | str]]:
    """Return a profile on an even grid, interpolated if its positions are uneven.

    Parameters
    ----------
    where
        The file's name, for messages.
    x, height
        Positions and heights [m] (x).

    Returns
    -------
    tuple
        The pitch [m], the heights by increasing x, and attributes on the changes: ``x_origin_m``;
        ``x_unevenness`` (largest deviation in pitches); ``resampled``, if the positions are uneven
        beyond rounding and heights were interpolated.

    Raises
    ------
    ReadError
        If the positions are missing, not monotonic, or constant.
    """
    if x.size < 2:
        raise ReadError(f"{where}: a profile needs at least two points, it has {x.size}")
    if x[0] > x[-1]:
        x, height = x[::-1], height[::-1]
    pitch = float(x[-1] - x[0]) / (x.size - 1)
    if not (np.isfinite(x).all() and pitch > 0):
        raise ReadError(
            f"{where}: x does not proceed, or holds gaps; a profile's positions must run from one "
            "end to the other"
        )
    count = np.arange(x.size, dtype=float)
    if not max(abs(x[0]), abs(x[-1]), pitch, *np.abs([x.min(), x.max()])) < _LARGEST:
        raise ReadError(f"{where}: x reaches {np.abs(x).max():.3g} m, no profile is so long")
    if x[-1] - x[0] < _MIN_SPACING:
        raise ReadError(f"{where}: x spans {x[-1] - x[0]:.3g} m, no profile is so short")
    ideal = x[0] + pitch * count
    unevenness = float(np.abs(ideal - x).max()) / pitch
    if unevenness > _JITTER:
        pitch, start = (float(c) for c in np.polyfit(count, x, 1))
        ideal = start + pitch * count
        unevenness = float(np.abs(ideal - x).max()) / pitch
    attrs: dict[str, float | str] = {"x_origin_m": float(ideal[0]), "x_unevenness": unevenness}
    if unevenness <= _JITTER or unevenness * pitch <= _ROUNDED * _last_digit(x):
        return pitch, height, attrs
    steps = np.diff(x)
    if steps.min() <= 0:
        at = int(np.argmin(steps))
        raise ReadError(
            f"{where}: x goes back after point {at + 1} ({x[at]:.9g} m, then {x[at + 1]:.9g} m); "
            "is the file more than one scan?"
        )
    # the fitted line may begin before the first position, where nothing is known
    pitch = float(x[-1] - x[0]) / (x.size - 1)
    ideal = x[0] + pitch * count
    unevenness = float(np.abs(ideal - x).max()) / pitch
    attrs |= {"x_origin_m": float(x[0]), "x_unevenness": unevenness}
    attrs["resampled"] = (
        f"positions deviate from an even grid by up to {unevenness:.2g} steps, more than their "
        "rounding; heights were interpolated along straight lines"
    )
    return pitch, np.interp(ideal, x, height), attrs


def _last_digit(x: np.ndarray) -> float:
    """Return the length of one unit in the last digit of positions [m]; 0 if unknown."""
    for power in range(-4, -13, -1):
        counts = x / 10.0**power
        if np.abs(counts - np.round(counts)).max() < 1e-3:
            return 10.0**power
    return 0.0


def rounder_pitch(length: float, points: int) -> float:
    """Return the rounder pitch for a length that ends at the last point or one step beyond it.

    >>> rounder_pitch(2e-4, 400), rounder_pitch(1.995e-4, 400)
    (5e-07, 5e-07)
    """
    pitches = [length / parts for parts in (points, max(points - 1, 1))]
    return min(pitches, key=lambda pitch: len(f"{pitch:.7g}"))


def gridded(where: str, x: np.ndarray, y: np.ndarray, height: np.ndarray) -> xr.Dataset:
    """Return a map (y, x) from rows of x, y and height [m] in any order.

    Grid points without a row are missing heights (NaN), as instruments leave out invalid points.

    Raises
    ------
    ReadError
        If the points do not fill more than half of a rectangular grid of even steps, occur twice,
        or end in the middle of the last line.
    """
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise ReadError(f"{where}: a point has no place: x or y is missing or no number")
    axes = []
    for name, values in (("x", x), ("y", y)):
        levels = np.unique(values)
        if levels.size < 2:
            raise ReadError(f"{where}: all points have the same {name}, this is no map")
        pitch = float(median(np.diff(levels)))
        steps = float(np.ptp(levels)) / pitch
        if not steps < 2 * x.size:
            raise ReadError(
                f"{where}: the points do not lie on an even grid along {name}: they span "
                f"{steps:.3g} steps, but there are only {x.size} points; {_CLOUD}"
            )
        number = int(round(steps)) + 1
        index = np.rint((values - levels[0]) / pitch).astype(np.intp)
        if np.abs(values - levels[0] - index * pitch).max() > 0.1 * pitch:
            raise ReadError(
                f"{where}: the points do not lie on an even grid along {name}; {_CLOUD}"
            )
        axes.append((pitch, number, index))
    (dx, nx, column), (dy, ny, row) = axes
    place = row * nx + column
    if not _FILLED * nx * ny <= x.size <= nx * ny or np.unique(place).size != x.size:
        raise ReadError(
            f"{where}: {x.size} points do not fill a grid of {nx} x {ny} points once each"
        )
    for order in (place, column * ny + row):
        if x.size < nx * ny and order[-1] == x.size - 1 and (np.diff(order) == 1).all():
            raise ReadError(
                f"{where}: {x.size} points do not fill a grid of {nx} x {ny} points: the last line "
                "of it ends early; is the file cut short?"
            )
    grid = np.full(nx * ny, np.nan)
    grid[place] = height
    return xr.Dataset(
        {"height": (("y", "x"), grid.reshape(ny, nx))},
        {"y": dy * np.arange(ny, dtype=float), "x": dx * np.arange(nx, dtype=float)},
    )
