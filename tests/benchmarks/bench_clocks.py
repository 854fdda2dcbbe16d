"""The match of the clocks of two logs, against pandas reading both files.

Run with ``python tests/benchmarks/bench_clocks.py``: pairs of a small run (three speeds) and of a
run of the demo, simulated. The least processor time of alternating runs counts.
"""

from __future__ import annotations

import datetime as dt
import tempfile
from pathlib import Path

import pandas as pd
from side_by_side import least_times, row

from tribolab.reading.clocks.merge import merge
from tribolab.reading.run_files import read
from tribolab.reading.signals import signals_of
from tribolab.rig import Protocol, Rig, simulate_run
from tribolab.rig.files import force_file, motion_file


def main() -> None:
    """Print a row for each kind of run."""
    for name, rig in (
        ("small run", Rig(Protocol(speeds=(4.64e-6, 1e-4, 2.15e-3)))),
        ("run of the demo", Rig()),
    ):
        run = simulate_run("Sb-R", "glycerol", 31.0, seed=1, rig=rig)
        with tempfile.TemporaryDirectory() as place:
            force, motion = Path(place) / "a.csv", Path(place) / "b.csv"
            date = dt.datetime(2026, 3, 2)  # noqa: DTZ001 - instruments know no time zone
            force.write_bytes(force_file(run.force_log, date))
            motion.write_bytes(motion_file(run.motion_log, date))
            logs = signals_of(read(force)), signals_of(read(motion, "linear_slider_motion"))
            times = least_times(
                5,
                match=lambda logs=logs: merge(*logs),
                files=lambda files=(force, motion): [pd.read_csv(f, comment="#") for f in files],
            )
        row(f"clock match of a {name}", times["match"], "pandas", times["files"], 3.2)


if __name__ == "__main__":
    main()
