"""Spectrum of a map of 2000 x 2000 heights, its form removed, against one real FFT of the heights.

Run with ``python tests/benchmarks/bench_map.py [points]``. The least processor time of alternating
runs counts, and the most memory that the spectrum takes beyond its map.
"""

from __future__ import annotations

import sys
import tracemalloc

import numpy as np
import scipy.fft
import xarray as xr
from side_by_side import least_times, row

from tribolab.studies import xu2026
from tribolab.surface.spectra.psd import psd_2d
from tribolab.surface.synthesis import synthesise_map


def main(points: int = 2000) -> None:
    """Print both rows."""
    rng = np.random.default_rng(1)
    scan = synthesise_map(xu2026.surface("Sb-S").spectrum, points=2048, pitch=1e-6, rng=rng)
    height = np.ascontiguousarray(scan.height.values.reshape(-1, 2048)[:points, :points])
    axis = 1e-6 * np.arange(points)
    tilted = height + 0.01 * axis + 3 * axis[:, None] ** 2
    scan = xr.Dataset({"height": (("y", "x"), tilted)}, {"y": axis, "x": axis})
    times = least_times(3, ours=lambda: psd_2d(scan), bare=lambda: scipy.fft.rfft2(tilted))
    job = f"PSD of a map of {points} x {points}"
    row(job, times["ours"], "rfft2", times["bare"], 5.8)
    tracemalloc.start()
    psd_2d(scan)
    peak = tracemalloc.get_traced_memory()[1] / 1e6
    row(
        f"PSD of a map of {points} x {points}, memory",
        peak,
        "the map",
        height.nbytes / 1e6,
        3,
        "MB",
    )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
