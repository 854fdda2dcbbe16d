"""How time and memory grow: scans of 1e4 to 1e7 points, campaigns of 10 to 400 runs.

    PYTHONPATH=$PWD python tests/robustness/scaling.py [--points 4 7] [--runs 10 400]

Each job is a process of its own. Printed are its processor time with its children, the largest
memory of one process, and the exponent of the time from one size to the next: 1 is proportional.
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

SCAN = (
    "import sys, tribolab as tl; s = tl.read_scans(sys.argv[1]); "
    "tl.roughness_parameters(s); tl.surface.psd_1d(s)"
)
SPEEDS = (1e-4, 1e-3, 1e-2)  # m/s


def measure(*command: object, codes: tuple[int, ...] = (0,)) -> tuple[float, float]:
    """Run a command; return its processor time [s] and largest memory [MB]."""
    process = subprocess.Popen([*map(str, command)], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in codes:
        raise SystemExit(f"{command[-1]}: exit code {process.returncode}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def table(what: str, sizes: list[int], rows: list[tuple[float, float]]) -> None:
    """Print sizes, times, memory and exponents."""
    print(f"{what:>10}  CPU (s)  memory (MB)  exponent")
    for k, (size, (seconds, memory)) in enumerate(zip(sizes, rows, strict=True)):
        grown = math.log(seconds / rows[k - 1][0]) / math.log(size / sizes[k - 1]) if k else None
        print(
            f"{size:>10}  {seconds:7.2f}  {memory:11.0f}  {'' if grown is None else f'{grown:.2f}'}"
        )


def scan(folder: Path, points: int) -> Path:
    """Write a profile as text."""
    rng = np.random.default_rng(points)
    heights = np.cumsum(rng.standard_normal(points)) * 0.01
    x = np.arange(points) * 0.5
    file = folder / f"{points}.csv"
    np.savetxt(file, np.c_[x, heights], ("%.1f", "%.5f"), ",", header="x [um],z [um]", comments="")
    return file


def campaign(folder: Path, runs: int) -> Path:
    """Write runs with three speeds forward and back, four repeats of each condition."""
    rng = np.random.default_rng(runs)
    lab = folder / f"lab_{runs}"
    lab.mkdir()
    time = np.arange(0.0, 60.0, 0.02)
    phase = (time // 10).astype(int)
    velocity = np.array([w * u for u in SPEEDS for w in (1, -1)])[phase]
    velocity = np.where(time % 10 < 0.5, 0.0, velocity)
    head = "Time (s),Velocity (mm/s),Friction force (N),Normal force (N)"
    for run in range(runs):
        load = 30 + 0.05 * rng.standard_normal(time.size)
        force = (0.8 + 0.01 * (run // 4)) * load * np.sign(velocity)
        force += 0.2 * rng.standard_normal(time.size)
        columns = np.c_[time, 1e3 * velocity, force, load]
        file = lab / f"pdms{run // 4:03d}_dry_{run % 4}.csv"
        np.savetxt(file, columns, "%.5g", ",", header=head, comments="")
    return lab


def main() -> None:
    """Measure and print both tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--points", type=int, nargs=2, default=(4, 7), help="powers of ten")
    parser.add_argument("--runs", type=int, nargs=2, default=(10, 400), help="fewest and most")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        points = [10**k for k in range(given.points[0], given.points[1] + 1)]
        rows = [measure(sys.executable, "-c", SCAN, scan(folder, n)) for n in points]
        table("points", points, rows)
        few, most = given.runs
        runs = [n for n in (few, 4 * few, 10 * few) if n < most] + [most]
        command = (sys.executable, "-m", "tribolab", "run", "-q", "-j", "2")
        table("runs", runs, [measure(*command, campaign(folder, n), codes=(0, 1)) for n in runs])


if __name__ == "__main__":
    main()
