"""Time find_segments against plain run-length grouping of the same velocity array.

Run from the project's root: ``python tests/benchmarks/bench_segments.py [samples]``.

The record: 10 million samples, 25 plateaus from 1 um/s to 1 cm/s, alternately forward and
backward with ramps and rests between, 3 % noise of the speed and 0.1 um/s of the sensor.
The alternatives, on the same array in the same process, best of five:

(a) exact: ``np.flatnonzero(np.diff(velocity))``, run-length grouping of the readings themselves.
    On noisy readings every sample is a run of its own, so it finds nothing; it is the price of
    looking at each sample once.
(b) labels: ``np.flatnonzero(np.diff(np.sign(v) * np.rint(log(|v| / 1 um/s) / log(ratio))))``
    with the ratio of the speeds known beforehand, which find_segments is not told. It finds a
    border wherever noise or a ramp crosses into another label.
"""

import sys

import numpy as np
import xarray as xr
from side_by_side import least_times, row

from tribolab.friction.segments.find import find_segments

PLATEAUS = 25


def record(samples: int, seed: int = 0) -> tuple[xr.Dataset, np.ndarray, np.ndarray]:
    """Build the record; return it with the first samples and the velocities of its plateaus."""
    rng = np.random.default_rng(seed)
    stroke = samples // PLATEAUS
    ramp, rest = stroke // 50, stroke // 20
    flat = stroke - 2 * ramp - rest
    velocity = np.empty(PLATEAUS * stroke)
    speeds = np.geomspace(1e-6, 1e-2, PLATEAUS) * np.where(np.arange(PLATEAUS) % 2, -1, 1)
    for i, v in enumerate(speeds):
        leg = np.linspace(0, v, ramp)
        part = np.concatenate([np.zeros(rest), leg, np.full(flat, v), leg[::-1]])
        velocity[i * stroke : (i + 1) * stroke] = part
    velocity *= 1 + 0.03 * rng.standard_normal(velocity.size)
    velocity += 1e-7 * rng.standard_normal(velocity.size)
    run = xr.Dataset(
        {"sliding_velocity": ("time", velocity)}, {"time": np.arange(velocity.size) * 1e-3}
    )
    return run, np.arange(PLATEAUS) * stroke + rest + ramp, speeds


def main() -> None:
    """Print what was found, the durations and their ratios."""
    samples = int(float(sys.argv[1])) if len(sys.argv) > 1 else 10_000_000
    run, first, speeds = record(samples)
    velocity = run["sliding_velocity"].values
    ratio = np.log(abs(speeds[1] / speeds[0]))

    def labels() -> np.ndarray:
        label = np.sign(velocity) * np.rint(np.log(np.abs(velocity) / 1e-6) / ratio)
        return np.flatnonzero(np.diff(label))

    found = find_segments(run)
    signed = found["sliding_speed"].values * found["direction"].values
    right = signed.size == PLATEAUS and np.allclose(signed, speeds, rtol=0.01)
    late = found["start"].values - first * 1e-3 if right else np.nan
    print(f"{velocity.size} samples, {PLATEAUS} plateaus: found {signed.size}, all right: {right}")
    stroke = samples // PLATEAUS / 1e3
    print(f"largest error of a start: {np.max(np.abs(late)):.3f} s of {stroke} s")
    times = least_times(
        5,
        ours=lambda: find_segments(run),
        exact=lambda: np.flatnonzero(np.diff(velocity)),
        labels=labels,
    )
    row(f"segments of {samples:.0e} samples", times["ours"], "labels", times["labels"], 1)
    row(f"segments of {samples:.0e} samples", times["ours"], "exact steps", times["exact"], 4)


if __name__ == "__main__":
    main()
