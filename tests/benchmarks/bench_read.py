"""Time and memory of `tribolab.read` next to pandas' C reader and polars.

Usage: python tests/benchmarks/bench_read.py [rows] [repeats]

Writes a four-column csv of the linear slider (default 1e7 rows) to a temporary folder and reads it
with each candidate in a process of its own, after a small file that loads its libraries. tribolab
does more in that time: SI units, a check that time increases, the SHA-256 of the file. The least
processor time and the least peak memory (of the whole process, libraries included) count.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from side_by_side import row

_CANDIDATES = {
    "tribolab": "import tribolab as tl\ngo = lambda path: tl.read(path, {instrument!r})",
    "polars": "import polars\ngo = lambda path: polars.read_csv(path, skip_rows=1)",
    "pandas": "import pandas\ngo = lambda path: pandas.read_csv(path, skiprows=1, engine='c')",
}
_TIMER = """
import resource, time
{setup}
go({small!r})
begin = time.process_time()
data = go({path!r})
seconds = time.process_time() - begin
print(seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""
_DIALECT = """
name = "bench"
title = "Four columns of numbers"
[header]
line = 2
[[column]]
quantity = "time"
name = "Time"
[[column]]
quantity = "friction_force"
name = "Fx"
[[column]]
quantity = "normal_force"
name = "Fz"
[[column]]
quantity = "position"
name = "Position"
"""


def write_csv(path: Path, rows: int) -> None:
    """Write a force log with a position column."""
    rng = np.random.default_rng(1)
    with path.open("w") as file:
        file.write("# Linear slider, force log\nTime [s],Fx [N],Fz [N],Position [mm]\n")
        for start in range(0, rows, 100_000):
            time = np.arange(start, min(start + 100_000, rows)) * 1e-3
            table = np.column_stack(
                [
                    time,
                    rng.normal(5.0, 1.0, len(time)),
                    rng.normal(31.0, 0.1, len(time)),
                    40.0 * np.sin(time),
                ]
            )
            table = table.tolist()
            file.writelines(f"{t:.3f},{x:.4f},{z:.4f},{p:.5f}\n" for t, x, z, p in table)


def measure(name: str, path: Path, dialect: Path) -> tuple[float, float]:
    """Time [s] and peak memory [MB] of one candidate, in a new process."""
    setup = _CANDIDATES[name].format(instrument=str(dialect))
    small = path.with_name("small.csv")
    code = _TIMER.format(setup=setup, path=str(path), small=str(small))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    seconds, memory = map(float, done.stdout.split())
    return seconds, memory


def main() -> None:
    """Run all candidates, interleaved, and print the ratios."""
    rows = int(float(sys.argv[1])) if len(sys.argv) > 1 else 10_000_000
    repeats = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    with tempfile.TemporaryDirectory() as folder:
        path, dialect = Path(folder) / "bench.csv", Path(folder) / "bench.toml"
        write_csv(path, rows)
        write_csv(path.with_name("small.csv"), 1000)
        dialect.write_text(_DIALECT)
        path.read_bytes()  # into the page cache, for all alike
        results: dict[str, list[tuple[float, float]]] = {name: [] for name in _CANDIDATES}
        for _ in range(repeats):
            for name in _CANDIDATES:
                results[name].append(measure(name, path, dialect))
    best = {name: tuple(map(min, zip(*runs, strict=True))) for name, runs in results.items()}
    seconds, memory = best["tribolab"]
    peer = min(("polars", "pandas"), key=lambda name: best[name][0])
    row(f"csv of {rows:.0e} rows", seconds, peer, best[peer][0], 1)
    row(f"csv of {rows:.0e} rows, memory", memory, "polars", best["polars"][1], 1, "MB")


if __name__ == "__main__":
    main()
