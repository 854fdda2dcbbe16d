"""How many faults the checks on runs find, and how many sound runs they complain about.

    python tests/detection/detection_table.py --seeds 0:20 --jobs 2

Every fault is put into one run per seed, written to raw files, read back and checked; it is found
if its own check reports at least the stated severity (or, for faults that make a file unreadable,
if the reader refuses it). Sound runs are full runs of 13 speeds, in all conditions of the paper.
"""

from __future__ import annotations

import argparse
import collections
import datetime as dt
import multiprocessing
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tribolab.core.errors import ReadError
from tribolab.qc.register import STATUSES
from tribolab.qc.run.checks import check_run
from tribolab.reading.run_files import read
from tribolab.rig import FAULTS, Protocol, Rig, simulate_run
from tribolab.rig.files import force_file, motion_file
from tribolab.studies import xu2026

_DATE = dt.datetime(2026, 3, 2)  # noqa: DTZ001 - instruments know no time zone
_SHORT = Rig(Protocol(speeds=(4.64e-6, 2.15e-5, 1e-4, 4.64e-4, 2.15e-3)))
_ROUGH = [(s, m, f) for s in ("Sb-S", "Sb-R") for m, f in (("glycerol", 91.0), ("dry", 31.0))]
_ALL = [
    *((s, "glycerol", f) for s in ("Smooth", "Sb-S", "Sb-R") for f in xu2026.system.loads),
    *((s, "dry", 31.0) for s in ("Smooth", "Sb-S", "Sb-R")),
]


def examine(task: tuple[str, str, str, float, int]) -> tuple[str, str, dict[str, str]]:
    """Make, write, read and check one run; the gravest status of each check."""
    fault, surface, medium, force, seed = task
    rig = _SHORT if fault else Rig()
    run = simulate_run(surface, medium, force, seed=seed, rig=rig, faults=fault or ())
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{run.name}_{log}.csv" for log in ("force", "motion")]
        paths[0].write_bytes(force_file(run.force_log, _DATE))
        paths[1].write_bytes(motion_file(run.motion_log, _DATE))
        try:
            data = read(paths, instrument="linear_slider")
        except ReadError as error:
            return fault, f"{surface} {medium} {force:g} N, seed {seed}", {"": str(error)}
    worst: dict[str, str] = {}
    for row in check_run(data, normal_force=force, contact_width=2e-2).rows:
        known = worst.get(row["check"], "pass")
        worst[row["check"]] = max(known, row["status"], key=STATUSES.index)
    return fault, f"{surface} {medium} {force:g} N, seed {seed}", worst


def tasks(seeds: range) -> list[tuple[str, str, str, float, int]]:
    """One run for each fault and seed, one sound run for each condition and seed."""
    wanted = []
    for fault in FAULTS.values():
        some = [(fault.surface, fault.medium, 31.0)] if fault.surface else _ROUGH
        wanted += [(fault.name, *some[seed % len(some)], seed) for seed in seeds]
    return wanted + [("", *condition, seed) for seed in seeds for condition in _ALL]


def main() -> int:
    """Print the table; the exit code says whether the aims are met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", default="0:20", help="FIRST:LAST+1")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--verbose", action="store_true", help="list what was missed")
    options = parser.parse_args()
    seeds = range(*map(int, options.seeds.split(":")))
    found, exact = collections.Counter(), collections.Counter()
    others = collections.defaultdict(collections.Counter)
    sound, missed = collections.Counter(), []
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(options.jobs, mp_context=context) as pool:
        for name, where, worst in pool.map(examine, tasks(seeds), chunksize=4):
            objections = {c: s for c, s in worst.items() if s in ("suspect", "fail", "error")}
            if not name:
                sound["runs"] += 1
                sound["unreadable"] += "" in worst
                sound["fail"] += bool({"fail", "error"} & set(worst.values())) or "" in worst
                sound["suspect"] += "suspect" in worst.values()
                if objections or "" in worst:
                    missed.append(f"sound run {where}: {objections or worst}")
                continue
            fault = FAULTS[name]
            status = "unreadable" if "" in worst else worst[fault.check]
            order = (*STATUSES, "unreadable")
            hit = order.index(status) >= order.index(fault.severity) and status != "error"
            found[name] += hit
            exact[name] += status == fault.severity
            others[name].update(set(objections) - {fault.check})
            if not hit:
                missed.append(f"{name} {where}: {status}; {objections}")
    n = len(seeds)
    print(f"{'fault':14} {'found by':21} {'as':11} {'found':>6} {'exactly':>8}  others")
    for fault in FAULTS.values():
        k = fault.name
        too = ", ".join(f"{name} {times / n:.0%}" for name, times in others[k].most_common(3))
        print(
            f"{k:14} {fault.check:21} {fault.severity:11} "
            f"{found[k] / n:6.0%} {exact[k] / n:8.0%}  {too}"
        )
    runs = sound["runs"]
    print(
        f"\nsound runs: {runs}; with a fail {sound['fail'] / runs:.1%}, "
        f"with a suspect {sound['suspect'] / runs:.1%}"
    )
    if options.verbose:
        print(*missed, sep="\n")
    met = min(found[k] / n for k in FAULTS) >= 0.95
    met &= sound["fail"] <= 0.01 * runs and sound["suspect"] <= 0.05 * runs
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
