"""Spectra of 1000 scans of 50 001 points against one batched FFT of the same array.

Run with ``python tests/benchmarks/bench_psd.py [scans] [threads]``. The yardstick is
``scipy.fft.rfft`` of the raw array at the length that the spectra use, and SurfaceTopography's own
averaged spectrum on a few of the scans. The least processor time of
alternating runs counts.
"""

from __future__ import annotations

import sys
import warnings

import numpy as np
import scipy.fft
import xarray as xr
from side_by_side import least_times, row

from tribolab.studies import xu2026
from tribolab.surface.spectra.fourier import fast_length
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.synthesis import synthesise_profiles

POINTS, PITCH, ROUNDS, FEW = 50_001, 0.5e-6, 3, 20


def main(number: int = 1000, threads: int = 1) -> None:
    """Print the ratios."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)
        from SurfaceTopography import UniformLineScan
        from SurfaceTopography.Container.SurfaceContainer import InMemorySurfaceContainer
    rng = np.random.default_rng(1)
    base = synthesise_profiles(
        xu2026.surface("Sb-S").spectrum, points=8 * 65_536, pitch=PITCH, rng=rng
    ).height.values[0]
    starts = rng.integers(0, base.size - POINTS, number)
    height = np.stack([base[start : start + POINTS] for start in starts])
    x = PITCH * np.arange(POINTS)
    scans = xr.Dataset({"height": (("scan", "x"), height)}, {"x": x}, {"tip_radius_m": 2e-6})
    length = fast_length(POINTS)
    few = [UniformLineScan(row, POINTS * PITCH, unit="m") for row in height[:FEW]]

    def bare() -> None:
        with scipy.fft.set_workers(threads):
            scipy.fft.rfft(height, n=length, axis=-1)

    def both() -> None:
        psd_2d(psd_1d(scans, form="none", workers=threads))

    def other() -> None:
        InMemorySurfaceContainer(few).power_spectrum(unit="m")

    times = least_times(ROUNDS, bare=bare, both=both)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        times |= least_times(2, other=other)
    row(f"PSD 1D and 2D of {number} scans", times["both"], "rfft of all", times["bare"], 2)
    ours, theirs = times["both"] / number, times["other"] / FEW
    row("PSD 1D and 2D, a scan", ours, "SurfaceTopography", theirs, 1)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
