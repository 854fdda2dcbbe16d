"""What campaigns cost: seconds, processor time, memory and bytes, beside what was set as a limit.

Run with ``python tests/benchmarks/bench_scale.py [--repeats 100] [--runs 0] [--demo]``. ``--demo``
times `tribolab demo` with its simulation. A campaign of ``4 * repeats`` small runs is simulated,
analysed, analysed again unchanged, and again with another trim. ``--runs N`` takes N small runs
through a Dask LocalCluster of two workers, one of which is killed on the way. The processor time of
all child processes counts; nothing else should be running.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TRIBOLAB = [sys.executable, "-m", "tribolab"]
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def timed(*words: object) -> tuple[float, float]:
    """Run the program; return seconds, and seconds of processor time of it and its workers."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [*TRIBOLAB, *map(str, words), "-q"]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | ONE_THREAD)
    if done.returncode not in (0, 1):
        raise SystemExit(f"{' '.join(command)}: {done.stderr}")
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return wall, cpu


def size(folder: Path) -> int:
    """Return the bytes of all files below a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def line(what: str, measured: str, wanted: str) -> None:
    """Print a row of docs/benchmarks.md."""
    print(f"| {what} | {measured} | limit | | | {wanted} |", flush=True)


def demo(folder: Path) -> None:
    """Time the demo, simulation included."""
    wall, cpu = timed("demo", folder / "demo")
    line("tribolab demo, 30 runs", f"{wall:.1f} s, {cpu:.1f} s CPU", "25 s, 50 s CPU")
    share = size(folder / "demo/results") / size(folder / "demo/raw")
    line("results folder over raw folder, demo", f"{share:.2f}", "1.2")


def small(folder: Path, repeats: int) -> None:
    """Time a campaign of small runs: new, unchanged, with another trim."""
    campaign = folder / "small"
    timed("simulate", campaign, "--small", "--repeats", repeats)
    runs = 4 * repeats
    wall, cpu = timed("run", campaign)
    line(f"{runs} small runs", f"{wall:.0f} s, {cpu / runs:.2f} s CPU a run", "0.30 s CPU a run")
    share = size(campaign / "results") / size(campaign / "raw")
    line("results folder over raw folder", f"{share:.2f}", "1.2")
    wall, cpu = timed("run", campaign)
    line("the same again, nothing changed", f"{wall:.1f} s, {cpu:.1f} s CPU", "1.5 s")
    file = campaign / "campaign.toml"
    text = file.read_text("utf-8")
    text, changed = re.subn(r"(?m)^trim = .*$", "trim = 0.12", text)
    assert changed == 1
    file.write_text(text, "utf-8")
    wall, cpu = timed("run", campaign)
    line("the same again, trim changed", f"{wall:.0f} s, {cpu / runs:.2f} s CPU a run", "0.25 s")


def cluster(folder: Path, runs: int) -> None:
    """Take many runs through a Dask cluster that loses a worker on the way."""
    campaign = folder / "many"
    timed("simulate", campaign, "--small", "--repeats", max(runs // 4, 1))
    text = (campaign / "campaign.toml").read_text("utf-8")
    (campaign / "campaign.toml").write_text(re.sub(r"(?m)^scans = .*\n", "", text), "utf-8")
    script = folder / "many.py"
    script.write_text(_CLUSTER, "utf-8")
    for what, kill, limit in (
        ("one worker killed", 1, "60 min for 10 000"),
        ("unchanged", 0, "20 s"),
    ):
        command = [sys.executable, str(script), str(campaign), str(kill)]
        began = time.perf_counter()
        done = subprocess.run(command, capture_output=True, text=True, env=os.environ | ONE_THREAD)
        if done.returncode:
            raise SystemExit(done.stderr)
        wall = time.perf_counter() - began
        line(
            f"{runs} runs on a LocalCluster, {what}", f"{wall:.0f} s; {done.stdout.strip()}", limit
        )


_CLUSTER = """
import os, resource, signal, sys, threading, time
from distributed import LocalCluster
import tribolab as tl
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
        pids = [worker.pid for worker in cluster.workers.values()]
        if int(sys.argv[2]):
            threading.Timer(10, lambda: os.kill(pids[0], signal.SIGKILL)).start()
        began = time.time()
        outcome = tl.run_campaign(sys.argv[1], scheduler=cluster.scheduler_address)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
        done = sum(run.done for run in outcome.runs)
        print(f"{done} of {len(outcome.runs)} done, main process {peak:.2f} GB")
"""

if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--repeats", type=int, default=100)
    parser.add_argument("--runs", type=int, default=0)
    parser.add_argument("--demo", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        if given.demo:
            demo(Path(place))
        if given.repeats:
            small(Path(place), given.repeats)
        if given.runs:
            cluster(Path(place), given.runs)
