"""Reading a text scan of 50 001 points: tribolab against pandas and against SurfaceTopography.

Run with ``python tests/benchmarks/bench_scan_read.py``. Prints ratios of the best of several runs,
taken in turn; a ratio above 1 means that tribolab takes longer.
"""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
from side_by_side import least_times, row

from tribolab.reading.scan_files import read_scans

POINTS, ROUNDS = 50_001, 30


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
        times = least_times(
            ROUNDS,
            tribolab=lambda: read_scans(scan),
            named=lambda: read_scans(scan, instrument="surftest_csv"),
            pandas=lambda: pd.read_csv(scan, skiprows=4),
            pyarrow=lambda: pd.read_csv(scan, skiprows=4, engine="pyarrow"),
        )
        times |= least_times(3, topography=lambda: read_topography(str(bare), unit="um"))
    for peer in ("pandas", "pyarrow", "topography"):
        goal = {"pandas": 1.3, "pyarrow": 1.5, "topography": 1}[peer]
        row(f"scan of {POINTS} points", times["tribolab"], peer, times[peer], goal)
    row("scan, instrument named", times["named"], "pandas", times["pandas"], 1.3)


if __name__ == "__main__":
    main()
