"""Tests for periodic waves and a lay, which show that a surface is not self-affine."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.surface.gaps import bridge_gaps, gaps_in

_MAX_POINTS = 8192  # most points used per profile: a dominant wave needs several points per period
_BLOCK = 256  # map rows whose slopes are computed at a time
_MAX_ROWS = 512  # most map rows used; the mean power of a spectral line is then accurate to 6 %
_PERIODS = 12  # fewest periods of a wave in a scan; up to six periods can arise by chance
_LOBE = 2  # spectral lines on each side over which a Hann window spreads a wave
_DOMINANT = 0.55  # share of the mean square height that no single wave of a random surface reaches
_NEIGHBOURS, _EXCLUDED = 24, 4  # lines on each side for the background level, nearest ones excluded
_CHANCE = 1e-6  # accepted probability that random heights cause such a line
_MAX_SLOPE_RATIO = 0.4  # ratio of rms slopes along and across the lay; smooth maps reach 0.6


def self_affinity_objection(scans: xr.Dataset) -> str:
    """Return why a spectrum must not be extrapolated as self-affine; "" if there is no reason.

    Parameters
    ----------
    scans
        ``height`` [m] (scan, x), (y, x) or (scan, y, x), without form.

    Returns
    -------
    str
        The reason, as part of a sentence; "" if the surface can be self-affine.

    Notes
    -----
    A single wave of at least twelve periods with more than half of the mean square height is a
    groove, a gauge, or marks of a tool. The lay of a map is the ratio of the rms slopes along the
    main axes of ``<grad h grad h>``, which no rotation of the map changes.

    Examples
    --------
    >>> x = 1e-6 * np.arange(4000)
    >>> wave = xr.Dataset({"height": ("x", 1e-6 * np.sin(2 * np.pi * x / 8e-5))}, {"x": x})
    >>> self_affinity_objection(wave)
    'one wave of 80 um holds 100 % of the mean square height: a gauge, a groove or marks of a tool'
    """
    is_map = "y" in scans.height.dims
    dims = ("y", "x") if is_map else ("x",)
    height = scans.height.transpose(..., *dims)
    values, missing = height.values, gaps_in(scans.assign(height=height))
    if missing is not None:
        values = bridge_gaps(values, missing, is_map=is_map)
    if not np.isfinite(values).all() or min(values.shape[-len(dims) :]) < 2 * _PERIODS:
        return ""
    steps = {dim: float(np.ptp(scans[dim].values)) / (scans.sizes[dim] - 1) for dim in dims}
    for dim in dims:
        rows = np.moveaxis(values, -1, -2) if dim == "y" else values
        share, length = dominant_wave(rows.reshape(-1, rows.shape[-1]), steps[dim])
        if share >= _DOMINANT:
            return (
                f"one wave of {1e6 * length:.3g} um holds {100 * share:.0f} % of the mean square "
                "height: a gauge, a groove or marks of a tool"
            )
    if is_map and (ratio := slope_ratio(values, steps["y"], steps["x"])) < _MAX_SLOPE_RATIO:
        return (
            f"slopes one way are {1 / ratio:.2g} times those across it: the surface has a lay, or "
            "the rows of the map are not in line"
        )
    return ""


def dominant_wave(rows: np.ndarray, pitch: float) -> tuple[float, float]:
    """Return the share of the mean square height in the strongest wave, and its wavelength [m].

    Parameters
    ----------
    rows
        Heights [m] (row, x) without gaps.
    pitch
        Distance of neighbouring points [m].
    """
    power, step = _power_of(rows, pitch)
    total = float(power.sum())
    if power.size < 2 * _PERIODS or not total > 0:
        return 0.0, float("nan")
    lobes = np.convolve(power, np.ones(2 * _LOBE + 1), mode="same")
    lobes[:_PERIODS] = 0.0
    line = _PERIODS + int(np.argmax(power[_PERIODS:]))
    near = np.arange(line - _LOBE, min(line + _LOBE + 1, power.size))
    middle = float(near @ power[near] / power[near].sum())
    return min(float(lobes[line]) / total, 1.0), step / middle


def repeating_wave(rows: np.ndarray, pitch: float) -> tuple[float, float]:
    """Return a periodic wave's share of the mean square height, and its wavelength [m].

    Parameters
    ----------
    rows
        Heights [m] (row, x) without gaps.
    pitch
        Distance of neighbouring points [m].

    Returns
    -------
    tuple
        Share and wavelength; 0 and NaN without such a wave. Feed marks and chatter repeat,
        roughness does not.

    Notes
    -----
    A line of the spectrum, of at least 48 periods, is compared with the median power on both sides.
    With random heights a line exceeds the mean power r times with the probability exp(-r), which is
    kept below 1e-6 for all lines together. Some 2 in 1000 simulated self-affine profiles are
    reported.
    """
    power, length = _power_of(rows, pitch)
    total = float(power.sum())
    if power.size < 4 * _NEIGHBOURS or not total > 0:
        return 0.0, float("nan")
    inner = np.arange(2 * _NEIGHBOURS, power.size - _NEIGHBOURS)
    windows = np.lib.stride_tricks.sliding_window_view(power, _NEIGHBOURS - _EXCLUDED)
    middle = np.median(windows, axis=1)
    left, right = middle[inner - _NEIGHBOURS], middle[inner + _EXCLUDED + 1]
    # the background is the geometric mean of both sides if the spectrum falls, else the right side
    usual = np.where(left >= right, np.sqrt(left * right), right) / np.log(2)
    ratio = power[inner] / np.where(usual > 0, usual, np.inf)
    best = int(np.argmax(ratio))
    line = int(inner[best])
    if inner.size * np.exp(-ratio[best]) > _CHANCE:
        return 0.0, float("nan")
    near = slice(line - _LOBE, line + _LOBE + 1)
    return float(power[near].sum()) / total, length / line


def _power_of(rows: np.ndarray, pitch: float) -> tuple[np.ndarray, float]:
    """Return the mean power spectrum of rows (Hann window), and its longest wavelength [m]."""
    joined = -(-rows.shape[-1] // _MAX_POINTS)
    number = rows.shape[-1] // joined
    rows = rows[:: -(-len(rows) // _MAX_ROWS), : joined * number]
    rows = rows.reshape(len(rows), number, joined).mean(axis=-1)
    taper = np.hanning(number)
    rows = rows - (rows @ taper / taper.sum())[:, None]
    power = (np.abs(np.fft.rfft(rows * taper, axis=-1)) ** 2).mean(axis=0)
    return power, number * joined * pitch


def slope_ratio(height: np.ndarray, step_y: float, step_x: float) -> float:
    """Return the ratio of rms slopes along and across the lay of a map; 1 without a lay."""
    height = height.reshape(-1, *height.shape[-2:])
    sums = np.zeros(3)
    starts = range(0, height.shape[1] - 1, _BLOCK)
    for rows in (one[first : first + _BLOCK + 1] for one in height for first in starts):
        along_x = np.diff(rows[:-1], axis=1)
        along_y = np.diff(rows[:, :-1], axis=0)
        pairs = ((along_x, along_x), (along_x, along_y), (along_y, along_y))
        sums += [np.vdot(first, second) for first, second in pairs]
    xx, xy, yy = sums / (step_x**2, step_x * step_y, step_y**2)
    tensor = np.array([[xx, xy], [xy, yy]])
    least, most = np.linalg.eigvalsh(tensor)
    return float(np.sqrt(max(least, 0.0) / most)) if most > 0 else 1.0
