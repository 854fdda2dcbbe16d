"""Stick-slip of a trace of a million samples against Welch's spectrum of the same trace.

    python tests/benchmarks/bench_stick_slip.py [--samples 1e6]

The least processor time of nine alternating runs counts, and the peak of memory over the trace.
"""

from __future__ import annotations

import argparse
import tracemalloc

import numpy as np
import xarray as xr
from scipy.signal import welch
from side_by_side import least_times, row

from tribolab.friction.oscillation.slip_segments import stick_slip

_STRETCH = 8192


def make(samples: int, period: float) -> tuple[xr.Dataset, xr.Dataset]:
    """One segment of sawtooth stick-slip with noise; its period in samples."""
    rng = np.random.default_rng(0)
    place = np.arange(samples, dtype=float)
    values = 1 + 0.2 * (place / period % 1.0)
    values += 0.01 * rng.standard_normal(samples)
    moments = place * 1e-3
    run = xr.Dataset({"friction_coefficient": ("time", values)}, {"time": moments})
    ends = {"start": 0, "trimmed_start": 0, "stop": -1, "trimmed_stop": -1}
    data = {name: ("segment", moments[[at]]) for name, at in ends.items()}
    data |= {"sliding_speed": ("segment", [1e-4]), "direction": ("segment", np.int8([1]))}
    return run, xr.Dataset(data, {"segment": [0]})


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=float, default=1e6)
    samples = int(parser.parse_args().samples)
    for period in (40.0, 2500.0):
        run, segments = make(samples, period)
        values = run["friction_coefficient"].values
        times = least_times(
            9,
            ours=lambda run=run, segments=segments: stick_slip(run, segments),
            welch=lambda values=values: welch(values, nperseg=_STRETCH),
        )
        job = f"stick-slip, {samples:.0e} samples, {period:g} in a period"
        row(job, times["ours"], "welch", times["welch"], 1.2)
        tracemalloc.start()
        stick_slip(run, segments)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        row(f"{job}, memory", peak / 1e6, "the trace", values.nbytes / 1e6, 3, "MB")


if __name__ == "__main__":
    main()
