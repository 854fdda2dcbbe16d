"""What one long run costs in a campaign, part by part.

Usage: python tests/benchmarks/bench_big_run.py [--rows 1e7] [--folder FOLDER]

Writes a csv of a linear slider's strokes at 10 kHz (1e7 rows take some 430 MB, 1e8 rows 4.4 GB; it
is kept in the folder if one is named, and taken from there the next time), and processes it as a
worker of a campaign does, in a process of its own. Prints CPU seconds of each part, the time on the
clock, the peak of the memory after it (resident, of the whole process, libraries and mapped files
included), and the size of the data file beside that of the csv.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pacsv

_RATE = 1e4  # Hz
_STROKE = 0.02  # m
_REST = 0.02  # of a stroke's duration, at each end
_STEP = 0.0153  # N, of the converter
_BLOCK = 1_000_000
_ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # as in a worker
_DIALECT = """
name = "bench"
title = "Linear slider at 10 kHz"
[header]
line = 2
units = "brackets"
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
[[column]]
quantity = "sliding_velocity"
name = "Velocity"
"""
_WORKER = """
import importlib, resource, sys, time
from pathlib import Path
sys.path.insert(0, {root!r})
import netCDF4, pyarrow.csv, scipy.signal, scipy.stats, xarray
from tribolab.campaign.runs import stage
from tribolab.campaign.settings.plan import PlannedRun

def timed(module, name, part):
    place = importlib.import_module(module)
    function = getattr(place, name)
    def wrapped(*args, **more):
        clock, cpu = time.perf_counter(), time.process_time()
        result = function(*args, **more)
        spent = time.process_time() - cpu, time.perf_counter() - clock
        print("%-12s %7.2f s CPU %7.2f s   peak %6.0f MB" % (part, *spent, peak()), flush=True)
        return result
    setattr(place, name, wrapped)

def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024

print("%-12s %33s %6.0f MB" % ("libraries", "peak", peak()))
friction = "tribolab.friction."
timed("tribolab.reading.unknown_run", "read_run", "read")
timed(friction + "segments.find", "find_segments", "segments")
timed(friction + "coefficient.coefficient", "friction_coefficient", "coefficient")
timed(friction + "oscillation.slip_segments", "stick_slip", "stick-slip")
timed("tribolab.qc.run.checks", "check_run", "checks")
timed("tribolab.campaign.runs.stage", "write_data", "write")
timed("tribolab.campaign.runs.stage", "_trace", "trace")
folder = Path({folder!r})
run = PlannedRun("big", (folder / "big.csv",), ("big.csv",), "S", "dry", 31.0, None, None,
                 str(folder / "bench.toml"))
clock, cpu = time.perf_counter(), time.process_time()
record = stage.process_run(stage.RunTask(run, folder)).record
spent = time.process_time() - cpu, time.perf_counter() - clock
print("%-12s %7.2f s CPU %7.2f s   peak %6.0f MB" % ("all", *spent, peak()))
outcome = record.outcome
print(outcome.status, outcome.reason, outcome.segments, "segments, quality", outcome.quality)
"""


def write_csv(path: Path, rows: int) -> None:
    """Write strokes to and fro at ten speeds a factor of 1.6 apart, with rests between them."""
    rng = np.random.default_rng(1)
    slowness = 1.6 ** -np.arange(10)
    length = np.repeat(slowness / slowness.sum() / 2, 2) * rows / _RATE / (1 + 2 * _REST)  # s
    ends = np.cumsum(np.repeat(length, 3) * np.tile([_REST, 1.0, _REST], length.size))
    speed = np.zeros(ends.size)
    speed[1::3] = _STROKE / length * np.tile([1.0, -1.0], length.size // 2)
    begins = np.r_[0.0, ends[:-1]]
    places = np.r_[0.0, np.cumsum(speed * (ends - begins))]
    with path.open("wb") as file:
        file.write(
            b"# Linear slider at 10 kHz\nTime [s],Fx [N],Fz [N],Position [mm],Velocity [mm/s]\n"
        )
        for start in range(0, rows, _BLOCK):
            time = np.arange(start, min(start + _BLOCK, rows)) / _RATE
            piece = np.minimum(np.searchsorted(ends, time, side="right"), ends.size - 1)
            velocity = speed[piece]
            position = places[piece] + velocity * (time - begins[piece])
            slip = 0.05 * ((position / 5e-5) % 1.0 - 0.5)  # a sawtooth of 50 um
            force = np.sign(velocity) * 31.0 * (0.8 + slip) + rng.normal(0, 0.1, time.size)
            load = 31.0 + rng.normal(0, 0.05, time.size)
            columns = {
                "t": time,
                "x": np.round(np.round(force / _STEP) * _STEP, 4),
                "z": np.round(np.round(load / _STEP) * _STEP, 4),
                "p": np.round(position * 1e3, 5),
                "v": np.round(velocity * 1e3 + rng.normal(0, 1e-4, time.size), 6),
            }
            table = pa.table({name: np.round(column, 6) for name, column in columns.items()})
            pacsv.write_csv(table, file, pacsv.WriteOptions(include_header=False))


def main() -> None:
    """Print the table."""
    asked = argparse.ArgumentParser(description="What one long run costs in a campaign.")
    asked.add_argument("--rows", type=float, default=1e7)
    asked.add_argument("--folder", type=Path)
    options = asked.parse_args()
    rows = int(options.rows)
    with tempfile.TemporaryDirectory() as scratch:
        folder = (options.folder or Path(scratch)).absolute()
        (folder / "data").mkdir(parents=True, exist_ok=True)
        (folder / "bench.toml").write_text(_DIALECT)
        raw = folder / "big.csv"
        if not raw.exists():
            write_csv(raw, rows)
        print(f"{rows:.0e} rows, csv {raw.stat().st_size / 1e6:.0f} MB", flush=True)
        environment = os.environ | _ONE_THREAD
        code = _WORKER.format(folder=str(folder), root=str(Path(__file__).parents[2]))
        subprocess.run([sys.executable, "-W", "ignore", "-c", code], check=True, env=environment)
        print(f"data file {(folder / 'data' / 'big.nc').stat().st_size / 1e6:.0f} MB")


if __name__ == "__main__":
    main()
