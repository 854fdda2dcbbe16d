"""How soon `tribolab info` answers, beside a program that reads the same numbers with pandas.

Usage: python tests/benchmarks/bench_info.py [--megabytes 5] [--repeats 5]

Writes a log of the linear slider, the same log with its motion log beside it, and one with names
that no dialect knows, and runs `tribolab info` on each in a process of its own, after one run that
does not count. Beside it `pandas.read_csv` of the same file, in a process of its own, too. Prints
the median of the wall times [s], and their ratios.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

_INFO = [sys.executable, "-c", "from tribolab.cli import main; main()", "info"]
_PANDAS = "import sys, pandas; print(pandas.read_csv(sys.argv[1], skiprows=1).describe())"
_HEADS = {
    "known": "# Linear slider, force log\nTime [s],Fx [N],Fz [N]",
    "drafted": "Slider of ours\nZeit [s],Reibkraft [N],Normalkraft [N]",
}


def velocity(time_s: np.ndarray) -> np.ndarray:
    """Strokes to and fro of 20 s, each pair 5 % faster than the one before [mm/s]."""
    stroke = (time_s // 20).astype(int)
    return np.where(stroke % 2 == 0, 1.0, -1.0) * 1.05 ** (stroke // 2 % 40)


def write_log(file: Path, head: str, megabytes: float) -> None:
    """Write a force log, sampled at 100 Hz."""
    rows = int(megabytes * 1e6 / 23)
    time_s = np.arange(rows) / 100
    speed = velocity(time_s)
    noise = np.random.default_rng(1).normal(0, 0.05, (2, rows))
    force = np.sign(speed) * (8 + np.log(np.abs(speed)))
    table = np.column_stack([time_s, force + noise[0], 20 + noise[1]])
    with file.open("w", encoding="utf-8") as out:
        out.write(head + "\n")
        np.savetxt(out, table, fmt="%.4f,%.3f,%.3f")


def write_motion(file: Path, force_log: Path) -> None:
    """Write the motion log of a force log, at 10 Hz, its clock 0.4 s behind."""
    rows = force_log.read_bytes().count(b"\n") // 10
    time_s = np.arange(rows) / 10
    speed = velocity(time_s + 0.4)
    table = np.column_stack([time_s, np.cumsum(speed) / 10, speed, np.abs(speed)])
    with file.open("w", encoding="utf-8") as out:
        out.write("# Linear slider, motion log\n")
        out.write("Time [s];Position [mm];Velocity [mm/s];Set speed [mm/s]\n")
        np.savetxt(out, table, fmt="%.3f", delimiter=";")


def seconds(command: list[str], repeats: int) -> float:
    """Return the median wall time of a command [s]."""
    spent = []
    for _ in range(repeats + 1):
        began = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        spent.append(time.perf_counter() - began)
    return statistics.median(spent[1:])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=5.0)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        files = {kind: Path(folder) / f"{kind}.csv" for kind in _HEADS}
        for kind, file in files.items():
            write_log(file, _HEADS[kind], options.megabytes)
        files["pair"] = Path(folder) / "run_force.csv"
        write_log(files["pair"], _HEADS["known"], options.megabytes)
        write_motion(Path(folder) / "run_motion.csv", files["pair"])
        beside = seconds([sys.executable, "-c", _PANDAS, str(files["known"])], options.repeats)
        print(f"pandas   {beside:.2f} s")
        for kind, file in files.items():
            told = seconds([*_INFO, str(file)], options.repeats)
            print(f"{kind:<8} {told:.2f} s, {told / beside:.2f} of pandas")


if __name__ == "__main__":
    main()
