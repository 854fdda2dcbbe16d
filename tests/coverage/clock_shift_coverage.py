"""How often the stated shift between two clocks holds the true one, over pairs of logs.

    python tests/coverage/clock_shift_coverage.py --seeds 1000:1020 --jobs 2
    python tests/coverage/clock_shift_coverage.py --rig --seeds 1000:1100 --jobs 2

Each seed makes one pair of every kind (see `tests/clock_pairs.py`): a force log and a motion log
with clocks of their own, written to files and read back with `tl.read` (or only merged, with
``--merge``). With ``--rig`` the pairs are sound runs of the virtual rig instead: three speeds, on
two surfaces in two media; 100 seeds make 400 runs. A pair is answered if the run states a shift,
else the run is `fail` until `clock_shift` is stated. Printed by kind: how many are answered, how
often the 95 % interval includes the truth, the usual uncertainty in milliseconds and in parts of
the shortest stroke's duration, and the greatest error in standard deviations. The exit code says
whether the interval of all that are answered covers 93 % or more, and three quarters are answered
(of the rig's runs all).
"""

from __future__ import annotations

import argparse
import datetime as dt
import multiprocessing
import sys
import tempfile
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.clocks.merge import merge
from tribolab.reading.run_files import read
from tribolab.reading.signals import signals_of
from tribolab.rig import Protocol, Rig, simulate_run
from tribolab.rig.files import force_file, motion_file

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from clock_pairs import KINDS, make_pair, write_pair  # noqa: E402  the path has to be set first

RIG_RUNS = {
    f"{surface} {medium}": (surface, medium, 31.0)
    for surface in ("Smooth", "Sb-R")
    for medium in ("glycerol", "dry")
}
FEW_SPEEDS = Rig(Protocol(speeds=(4.64e-6, 1e-4, 2.15e-3)))  # of a small simulated campaign
_DATE = dt.datetime(2026, 3, 2)  # noqa: DTZ001 - instruments know no time zone


class Row(NamedTuple):
    """What came of one pair."""

    kind: str
    seed: int
    answered: bool
    error: float
    uncertainty: float
    stroke: float
    why: str


def examine(task: tuple[str, int, bool]) -> Row:
    """Make, read and judge one pair."""
    kind, seed, only_merge = task
    pair = make_pair(seed, kind)
    try:
        if only_merge:
            attrs = merge(signals_of(pair.force), signals_of(pair.motion)).attrs
        else:
            with tempfile.TemporaryDirectory() as folder:
                attrs = read(write_pair(pair, Path(folder))).attrs
    except ReadError as error:
        return Row(kind, seed, False, np.nan, np.nan, pair.shortest, str(error))
    return row_of(kind, seed, attrs, pair.shift, pair.shortest)


def examine_rig_run(task: tuple[str, int, bool]) -> Row:
    """Simulate, read and judge one run of the virtual rig."""
    kind, seed, _ = task
    run = simulate_run(*RIG_RUNS[kind], seed=seed, rig=FEW_SPEEDS)
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{run.name}_{log}.csv" for log in ("force", "motion")]
        paths[0].write_bytes(force_file(run.force_log, _DATE))
        paths[1].write_bytes(motion_file(run.motion_log, _DATE))
        attrs = read(paths, instrument="linear_slider").attrs
    shortest = float((run.segments["stop_s"] - run.segments["start_s"]).min())
    return row_of(kind, seed, attrs, run.facts["clock_shift_at_middle_s"], shortest)


def row_of(kind: str, seed: int, attrs: Mapping[str, Any], shift: float, stroke: float) -> Row:
    """Compare what a run states of its clocks with the true shift [s]."""
    return Row(
        kind,
        seed,
        attrs["clock_shift_source"] == "estimated",
        attrs["clock_shift_s"] - shift,
        attrs["clock_shift_uncertainty_s"],
        stroke,
        str(attrs.get("clock_shift_refused", "the force does not follow the motion")),
    )


def line(name: str, rows: list[Row]) -> str:
    """One line of the table."""
    told = [row for row in rows if row.answered]
    if not told:
        return f"{name:20} {len(rows):5} {0:9.0%}"
    pull = np.array([abs(row.error) / row.uncertainty for row in told])
    error = np.array([row.uncertainty for row in told])
    share = error / np.array([row.stroke for row in told])
    return (
        f"{name:20} {len(rows):5} {len(told) / len(rows):9.0%} {np.mean(pull < 1.96):8.1%} "
        f"{1e3 * np.median(error):8.1f} {np.median(share):8.2%} {pull.max():8.1f}"
    )


def main() -> int:
    """Print the table; the exit code says whether the aims are met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", default="1000:1020", help="FIRST:LAST+1")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--rig", action="store_true", help="sound runs of the virtual rig")
    parser.add_argument("--merge", action="store_true", help="no files")
    parser.add_argument("--verbose", action="store_true", help="list what was missed or refused")
    options = parser.parse_args()
    seeds = range(*map(int, options.seeds.split(":")))
    kinds, judge = (tuple(RIG_RUNS), examine_rig_run) if options.rig else (KINDS, examine)
    tasks = [(kind, seed, options.merge) for kind in kinds for seed in seeds]
    with ProcessPoolExecutor(options.jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
        rows = list(pool.map(judge, tasks, chunksize=4))
    print(f"{'kind':20} pairs  answered  covered   u [ms]  of stroke  worst")
    for kind in kinds:
        print(line(kind, [row for row in rows if row.kind == kind]))
    print(line("all", rows))
    if options.verbose:
        for row in rows:
            if not row.answered:
                print(f"refused {row.kind}, seed {row.seed}: {row.why}")
            elif abs(row.error) > 1.96 * row.uncertainty:
                print(
                    f"missed {row.kind}, seed {row.seed}: {row.error:.4f} s "
                    f"for {row.uncertainty:.4f} s"
                )
    told = [row for row in rows if row.answered]
    held = np.mean([abs(row.error) < 1.96 * row.uncertainty for row in told])
    return 0 if held >= 0.93 and len(told) >= (1.0 if options.rig else 0.75) * len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
