"""Power spectrum of a topography map: 2D Fourier transform, averaged over annuli."""

from __future__ import annotations

import numpy as np
import scipy.fft
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.surface.character import self_affinity_objection
from tribolab.surface.form import remove_form
from tribolab.surface.gaps import (
    bridge_gaps,
    effective_values,
    gap_cutoff,
    gap_effect,
    gaps_in,
    logarithm,
)
from tribolab.surface.level import level_map, refuse_level
from tribolab.surface.limits import MIN_WAVES_OF_MAP
from tribolab.surface.spectra.annuli import confidence_band
from tribolab.surface.spectra.binning import correlation, log_bins, window
from tribolab.units.stamping import stamp

_MIN_POINTS_OF_SIDE = 16
_BLOCK = 256  # number of map rows that are multiplied by the window at a time


def _power(maps: np.ndarray) -> tuple[np.ndarray, float]:
    """Return a quadrant of the mean power spectrum of windowed maps, and their mean square."""
    rows, columns = maps.shape[-2:]
    power, square = np.zeros((rows // 2 + 1, columns // 2 + 1)), 0.0
    lines = np.empty((rows, columns // 2 + 1), complex)
    for heights in maps:  # one map at a time, windowed in blocks of rows, to save memory
        for first in range(0, rows, _BLOCK):
            block = slice(first, first + _BLOCK)
            windowed = heights[block] * window(columns)
            windowed *= window(rows)[block, None]
            square += float(np.vdot(windowed, windowed)) / maps.size
            lines[block] = scipy.fft.rfft(windowed)
        lines = scipy.fft.fft(lines, axis=0, overwrite_x=True)
        parts = lines.view(float).reshape(*lines.shape, 2)
        upper, lower = parts[: len(power)], parts[: -((rows + 1) // 2) : -1]
        power += np.einsum("yxc,yxc->yx", upper, upper) / len(maps)
        power[1 : len(lower) + 1] += np.einsum("yxc,yxc->yx", lower, lower) / len(maps)
    return power, square


def _multiplicity(count: int, size: int) -> np.ndarray:
    """Return how many Fourier lines each line of an axis represents: 2, with its mirror, or 1."""
    number = np.full(count, 2.0)
    number[0] = 1.0
    if size % 2 == 0:
        number[-1] = 1.0
    return number


def psd_2d_of_map(
    scan: xr.Dataset, *, form: str = "auto", bins_per_decade: float = 12
) -> xr.Dataset:
    """Return the radially averaged power spectrum of one or several maps of heights.

    Parameters
    ----------
    scan
        ``height`` [m] (y, x) or (scan, y, x), evenly spaced. Missing heights (NaN) are bridged,
        and the spectrum is corrected for them.
    form
        Form to remove first: ``"auto"`` (a polynomial of second order unless form was already
        removed), ``"none"`` (the mean), ``"mean"``, ``"tilt"`` or ``"polynomial"``.
    bins_per_decade
        Width of the annuli.

    Returns
    -------
    xarray.Dataset
        As returned by `psd_2d`; ``anisotropy`` in the attributes is the ratio of the power along y
        to that along x; neither it nor the mean shows the direction of a lay. Spectra of several
        maps are averaged. If heights are missing, the band includes ``gap_error``, the relative
        standard error due to the gaps. Wavenumbers above ``gaps_hide_above_1_m``, where gaps
        removed half of the power, are left out.

    Raises
    ------
    AnalysisError
        If the map is too small, more than half of it is missing, or it does not vary.

    Notes
    -----
    ``C(q) = |FT(w h)|^2 dx dy / (4 pi^2 N_x N_y <w^2>)`` with a Hann window along both axes, so
    that ``<h^2> = int C d^2q = 2 pi int q C dq``. Wavenumbers beyond the smaller of the two
    Nyquist wavenumbers, in the corners of the plane, are left out of the annuli. Half of the
    Fourier lines of an annulus mirror the other half.
    """
    if form == "auto":
        form = "none" if "form_removed" in scan.attrs else "polynomial"
    scan = remove_form(scan, "mean" if form == "none" else form)
    height = scan.height.transpose(..., "y", "x").values
    size = height.shape[-2:]
    height = height.reshape(-1, *size)
    if min(size) < _MIN_POINTS_OF_SIDE:
        raise AnalysisError(
            f"a map of {size} points is too small for a spectrum", function="psd_2d"
        )
    missing = gaps_in(scan.transpose(..., "y", "x"))
    if missing is not None:
        missing = missing.reshape(height.shape)
        height = bridge_gaps(height, missing, is_map=True)
    refuse_level("psd_2d", scan, [level_map(row) for row in height])
    steps = [float(np.ptp(scan[d].values) / (scan.sizes[d] - 1)) for d in ("y", "x")]
    power, whole = _power(height)
    scale = steps[0] * steps[1] / (4 * np.pi**2 * size[0] * size[1])
    ky, kx = (2 * np.pi * np.fft.rfftfreq(n, d) for n, d in zip(size, steps, strict=True))
    q = np.hypot(ky[:, None], kx)
    # the quadrant contains sums over +ky and -ky; +kx and -kx have equal power
    along_y, along_x = (_multiplicity(k.size, n) for k, n in zip((ky, kx), size, strict=True))
    spacing = max(2 * np.pi / (n * d) for n, d in zip(size, steps, strict=True))
    waves = int(min(np.pi / d for d in steps) / spacing)
    if waves < MIN_WAVES_OF_MAP.value:
        across, along = (f"{1e6 * d:.3g} um" for d in steps)
        raise AnalysisError(
            f"the map's points are {along} apart along x and {across} along y, so both sides "
            f"share {waves} wavenumbers, and {MIN_WAVES_OF_MAP.value:.0f} are the least; are the "
            "units of x and y right?",
            function="psd_2d",
        )
    bins = log_bins(waves, 3, bins_per_decade, 1)
    edges = bins.edges * spacing
    annulus = np.digitize(q.ravel(), edges)  # 0 and the last number are outside all annuli

    def sums(values: np.ndarray) -> np.ndarray:
        return np.bincount(annulus, (values * along_x).ravel(), bins.starts.size + 2)[1:-1]

    lines = sums(np.broadcast_to(along_y[:, None], q.shape))

    def annuli(values: np.ndarray) -> np.ndarray:
        return sums(values) * (scale / lines)

    mean = annuli(power)
    q[0, 0] = 1.0  # the mean (q = 0) is in no annulus; 1 avoids log(0)
    node = np.exp(sums(np.log(q) * along_y[:, None]) / lines)
    correlated = (1 + 2 * (correlation(1) + correlation(2))) ** 2
    independent = len(height) * np.maximum(0.5 * lines / correlated, 1.0)
    known = np.arange(node.size) > 0  # form removal and the window distort the first annulus
    lost, effect = float("inf"), None
    if missing is not None:

        def powers(maps: np.ndarray) -> np.ndarray:
            return logarithm(annuli(_power(maps)[0]))

        effect = gap_effect(height, missing, powers, is_map=True, joint=True)
        mean, independent = mean * np.exp(-effect.shift), effective_values(independent, effect)
        lost = gap_cutoff(node, effect)
        known &= node < max(lost, node[min(4, node.size - 1)])
    low, high = confidence_band(mean, independent)
    cell = (2 * np.pi) ** 2 / (size[0] * size[1] * steps[0] * steps[1])
    power *= along_x
    slope_x, slope_y = (power @ kx**2).sum(), (ky**2 @ power).sum()
    data = xr.Dataset(
        {
            "psd_2d": ("wavenumber", mean[known]),
            "psd_2d_low": ("wavenumber", low[known]),
            "psd_2d_high": ("wavenumber", high[known]),
            "independent_values": ("wavenumber", independent[known]),
            "origin": ("wavenumber", np.zeros(int(known.sum()), np.int8)),
        },
        {"wavenumber": node[known]},
    )
    if effect is not None:
        data["gap_error"] = ("wavenumber", effect.error[known])
    attrs = {
        **scan.attrs,
        "convention": "<h^2> = 2 pi int q C dq",
        "scans": len(height),
        "mean_square_height_m2": whole,
        "anisotropy": float(np.sqrt(slope_y / slope_x)),
        "parseval_error": abs(float(power.sum() * scale * cell) / whole - 1),
    }
    if why := self_affinity_objection(scan):
        attrs["not_self_affine"] = why
    if np.isfinite(lost):
        attrs["gaps_hide_above_1_m"] = lost
    return stamp(data.assign_attrs(attrs))
