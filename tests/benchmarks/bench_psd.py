"""Spectra of 1000 scans of 50 001 points against one batched FFT of the same array.

Run with ``python tests/benchmarks/bench_psd.py [scans] [threads]``. The yardstick is
``scipy.fft.rfft`` of the raw array at the length that the spectra use, and SurfaceTopography's own
averaged spectrum on a few of the scans. Best of several runs, taken in turn.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable

import numpy as np
import scipy.fft
import xarray as xr

from tribolab.studies import xu2026
from tribolab.surface.spectra.fourier import fast_length
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.synthesis import synthesise_profiles

POINTS, PITCH, ROUNDS, FEW = 50_001, 0.5e-6, 3, 20


def best_of(rounds: int, **tasks: Callable[[], object]) -> dict[str, float]:
    """Shortest time [s] of each task; they take turns, so that all see the same machine."""
    times = {name: [] for name in tasks}
    for _ in range(rounds):
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            times[name].append(time.perf_counter() - start)
    return {name: min(values) for name, values in times.items()}


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

    def one() -> None:
        psd_1d(scans, form="none", workers=threads)

    def both() -> None:
        psd_2d(psd_1d(scans, form="none", workers=threads))

    def other() -> None:
        InMemorySurfaceContainer(few).power_spectrum(unit="m")

    times = best_of(ROUNDS, bare=bare, one=one, both=both)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        times |= best_of(2, other=other)
    circle = best_of(1, circle=lambda: psd_1d(scans.isel(scan=slice(0, 100)), workers=threads))
    print(f"{number} scans of {POINTS} points, FFT length {length}, {threads} thread(s)")
    print(f"  scipy.fft.rfft of the raw array       : {times['bare']:.3f} s")
    print(f"  psd_1d                                : {times['one']:.3f} s")
    print(f"  psd_1d and psd_2d                     : {times['both']:.3f} s")
    print(f"  1D and 2D spectra / bare FFT          : {times['both'] / times['bare']:.2f}")
    ours, theirs = times["both"] / number, times["other"] / FEW
    print(f"  a scan: tribolab / SurfaceTopography  : {ours / theirs:.4f}  ({theirs:.3f} s)")
    print(f"  a scan with its circle removed first  : {circle['circle'] / 100 * 1e3:.2f} ms")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
