"""CPU time and memory of `tribolab info` and `tribolab check` next to pandas.

Usage: python tests/benchmarks/bench_info.py [--megabytes 5] [--rows 1e7] [--repeats 5]

Writes a log of the linear slider, the same log with its motion log, and one of an unknown
instrument, and runs `tribolab info` on each in a process of its own; a small log for `tribolab
check`; and a log of an unknown instrument of 1e7 rows for `tribolab info`. The peer is
`pandas.read_csv` of the same file (of the long one its import alone) in a process of its own.
The commands take turns, after a run of each that does not count. Prints medians of the CPU time of
the processes [s], their ratio to the peer, and the peak memory [MB].
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from side_by_side import row

_INFO = [sys.executable, "-c", "from tribolab.cli import main; main()", "info"]
_CHECK = [*_INFO[:-1], "check"]
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


def write_long_log(file: Path, rows: int) -> None:
    """Write the force log of an unknown instrument, block by block."""
    block = 100_000
    noise = np.random.default_rng(1).normal(0, 0.05, (2, block))
    with file.open("w", encoding="utf-8") as out:
        out.write("Slider at 10 kHz\nTime [s],Friction force [N],Normal force [N],Speed [mm/s]\n")
        for start in range(0, rows, block):
            time_s = (start + np.arange(min(block, rows - start))) / 1e4
            speed = velocity(time_s)
            force = np.sign(speed) * (8 + np.log(np.abs(speed))) + noise[0, : time_s.size]
            load = 20 + noise[1, : time_s.size]
            table = zip(*(c.tolist() for c in (time_s, force, load, speed)), strict=True)
            out.writelines(f"{t:.4f},{x:.3f},{z:.3f},{v:.4f}\n" for t, x, z, v in table)


class Spent(NamedTuple):
    """Median CPU time [s] and greatest peak memory [MB] of a command."""

    cpu: float
    memory: float


def measure(commands: dict[str, list[str]], repeats: int) -> dict[str, Spent]:
    """Run commands in turn."""
    cpu: dict[str, list[float]] = {name: [] for name in commands}
    memory = dict.fromkeys(commands, 0.0)
    for _ in range(repeats + 1):
        for name, command in commands.items():
            child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
            if child.returncode not in (0, 1):  # 1: a finding
                raise SystemExit(f"{' '.join(command)}: exit code {child.returncode}")
            cpu[name].append(used.ru_utime + used.ru_stime)
            memory[name] = max(memory[name], used.ru_maxrss / 1024)
    return {name: Spent(statistics.median(cpu[name][1:]), memory[name]) for name in commands}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=5.0)
    parser.add_argument("--rows", type=float, default=1e7)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        files = {kind: folder / f"{kind}.csv" for kind in _HEADS}
        for kind, file in files.items():
            write_log(file, _HEADS[kind], options.megabytes)
        files["pair"] = folder / "run_force.csv"
        write_log(files["pair"], _HEADS["known"], options.megabytes)
        write_motion(folder / "run_motion.csv", files["pair"])
        small, long = folder / "small.csv", folder / "long.csv"
        write_log(small, _HEADS["known"], 0.1)
        write_long_log(long, int(options.rows))
        commands = {"pandas": [sys.executable, "-c", _PANDAS, str(files["known"])]}
        commands |= {f"info, {kind}": [*_INFO, str(file)] for kind, file in files.items()}
        commands["import pandas"] = [sys.executable, "-c", "import pandas"]
        commands["check, small"] = [*_CHECK, str(small)]
        commands[f"info, {options.rows:.0e} rows"] = [*_INFO, str(long)]
        spent = measure(commands, options.repeats)
    peer = "pandas"
    for name, (cpu, memory) in spent.items():
        if "pandas" in name:
            peer = name
            continue
        row(name, cpu, peer, spent[peer].cpu, 1)
        row(f"{name}, memory", memory, peer, spent[peer].memory, 1.3, "MB")


if __name__ == "__main__":
    main()
