"""Reading a text scan of 50 001 points: tribolab against pandas and against SurfaceTopography.

Run with ``python tests/benchmarks/bench_scan_read.py``. Prints ratios of the best of several runs,
taken in turn; a ratio above 1 means that tribolab takes longer.
"""

from __future__ import annotations

import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from tribolab.reading.scan_files import read_scans

POINTS, ROUNDS = 50_001, 30


def best_of(rounds: int, **tasks: Callable[[], object]) -> dict[str, float]:
    """Shortest time [s] of each task; they take turns, so that all see the same machine."""
    times = {name: [] for name in tasks}
    for _ in range(rounds + 1):  # the first round warms up
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            times[name].append(time.perf_counter() - start)
    return {name: min(values[1:]) for name, values in times.items()}


def write_scan(folder: Path) -> tuple[Path, Path]:
    """Write the same scan as the stylus exports it, and as two bare columns."""
    x = 0.5e-3 * np.arange(POINTS)
    z = 1e3 * (np.sqrt(70**2 - (x - 12.5) ** 2) - 70) + np.random.default_rng(1).normal(size=POINTS)
    head = (
        "# Surftest profile\n# tip radius: 2 um\n# pitch: 0.5 um\n# length: 25 mm\nx [mm],z [um]\n"
    )
    rows = [f"{a:.4f},{b:.3f}\n" for a, b in zip(x, z, strict=True)]
    scan, bare = folder / "sb-r_1.csv", folder / "bare.txt"
    scan.write_text(head + "".join(rows))
    bare.write_text("".join(row.replace(",", " ") for row in rows))
    return scan, bare


def main() -> None:
    """Print the ratios."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)
        from SurfaceTopography.IO import read_topography
    with tempfile.TemporaryDirectory() as name:
        scan, bare = write_scan(Path(name))
        times = best_of(
            ROUNDS,
            tribolab=lambda: read_scans(scan),
            named=lambda: read_scans(scan, instrument="surftest_csv"),
            pandas=lambda: pd.read_csv(scan, skiprows=4),
            pyarrow=lambda: pd.read_csv(scan, skiprows=4, engine="pyarrow"),
        )
        times |= best_of(3, topography=lambda: read_topography(str(bare), unit="um"))
    ours = times["tribolab"]
    print(f"one scan of {POINTS} points, {ours * 1e3:.2f} ms, SI dataset with checksum")
    print(f"  with instrument= named             : {times['named'] * 1e3:.2f} ms")
    print(f"  / pandas.read_csv                  : {ours / times['pandas']:.2f}")
    print(f"  / pandas.read_csv(engine='pyarrow'): {ours / times['pyarrow']:.2f}")
    print(f"  / SurfaceTopography (xyz)          : {ours / times['topography']:.2f}")


if __name__ == "__main__":
    main()
