"""What one run of 5 MB costs: processor time of its parts, and of its data file.

Usage: python tests/benchmarks/bench_one_run.py [--rounds 5]

Simulates a pair of logs and processes it in this process as a worker of a campaign does, several
times; the least processor time counts. Reading and analysis are one part; writing the data file,
the record and the trace that the page draws are the rest. The time of a file's bytes is what it
takes to compress what is stored compressed, to write the bytes and to take their checksum: all
beyond it is what the library adds. Ends with 1 if a limit is missed.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import tempfile
import time
import warnings
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import xarray as xr
from threadpoolctl import threadpool_limits

from tribolab import rig
from tribolab.campaign.runs.analysis import analyse_run
from tribolab.campaign.runs.stage import RunTask, process_run
from tribolab.campaign.settings.load import load_and_plan
from tribolab.campaign.store.data_files import write_data
from tribolab.reading.netcdf.storage import CHUNK, storage

_MORE = 1.5  # times reading and analysis alone
_NETCDF = 0.05  # s, and the time of the bytes
_CAMPAIGN = """
[campaign]
name = "one run"
raw = "raw"
[[surface]]
name = "Sb-S"
[medium.glycerol]
[[run]]
files = "*.csv"
surface = "Sb-S"
medium = "glycerol"
normal_force = "31 N"
instrument = "linear_slider"
"""


def least(work: Callable[[], object], rounds: int) -> float:
    """Return the least processor time of several rounds [s], after one that does not count."""
    work()
    spent = []
    for _ in range(rounds):
        began = time.process_time()
        work()
        spent.append(time.process_time() - began)
    return min(spent)


def write_bytes(groups: Mapping[str | None, xr.Dataset], file: Path) -> None:
    """Compress, write and sum up what a data file is made of, without a library around it."""
    digest = hashlib.sha256()
    with file.open("wb") as target:
        for data in groups.values():
            for variable in data.variables.values():
                for stored in chunks(variable.values):
                    digest.update(stored)
                    target.write(stored)


def chunks(values: np.ndarray) -> list[bytes]:
    """Return the chunks of an array as they are stored."""
    if values.dtype.kind not in "fiu":
        return ["".join(map(str, values.flat)).encode()]
    how = storage(values)
    parts = [values.reshape(-1)[k : k + CHUNK] for k in range(0, max(values.size, 1), CHUNK)]
    if not how.get("zlib"):
        return [part.tobytes() for part in parts]
    if how["shuffle"]:
        parts = [part.view(np.uint8).reshape(part.size, -1).T for part in parts]
    return [zlib.compress(part.tobytes(), how["complevel"]) for part in parts]


def line(what: str, measured: str, wanted: str, kept: bool) -> bool:
    """Print a row; return whether its limit is kept."""
    print(f"{what:52} {measured:>42}   wanted {wanted}{'' if kept else '   MISSED'}", flush=True)
    return kept


def main() -> int:
    """Print the table; 1 if a limit is missed."""
    asked = argparse.ArgumentParser()
    asked.add_argument("--rounds", type=int, default=5)
    rounds = asked.parse_args().rounds
    warnings.filterwarnings("ignore", category=RuntimeWarning)  # as in a worker
    with tempfile.TemporaryDirectory() as place, threadpool_limits(1, user_api="blas"):
        folder = Path(place)
        (folder / "data").mkdir()
        long = rig.Rig(rig.Protocol(stroke=0.9e-3))
        rig.write_run(rig.simulate_run("Sb-S", "glycerol", rig=long), folder / "raw")
        (folder / "campaign.toml").write_text(_CAMPAIGN)
        size = sum(file.stat().st_size for file in (folder / "raw").iterdir())
        print(f"raw files: {size / 1e6:.1f} MB")
        _, (run,) = load_and_plan(folder / "campaign.toml")
        alone = least(lambda: analyse_run(run), rounds)
        whole = least(lambda: process_run(RunTask(run, folder)), rounds)
        analysed = analyse_run(run)
        groups: dict[str | None, xr.Dataset] = {None: xr.Dataset(), **analysed.groups}
        file = least(lambda: write_data(groups, folder / "data" / "run.nc"), rounds)
        plain = least(lambda: write_bytes(groups, folder / "data" / "run.bytes"), rounds)
        sizes = [(folder / "data" / name).stat().st_size for name in ("run.nc", "run.bytes")]
    kept = [
        line(
            "read, analyse, write, record over read and analyse",
            f"{whole:.3f} over {alone:.3f} s CPU: {whole / alone:.2f}",
            f"{_MORE}",
            whole <= _MORE * alone,
        ),
        line(
            f"writing a run's netCDF ({sizes[0] / 1e6:.1f} MB)",
            f"{file:.3f} s CPU, its bytes {plain:.3f} s ({sizes[1] / 1e6:.1f} MB)",
            f"{_NETCDF} s and the time of the bytes",
            file <= _NETCDF + plain,
        ),
    ]
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
