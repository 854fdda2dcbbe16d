"""Kill a run of a campaign at random moments; its results are the old or the new ones, whole.

    PYTHONPATH=$PWD python tests/robustness/kill_campaign.py --kills 50 --seed 1

The campaign holds runs in two media, a surface and its models. Before each kill its file is
changed, back and forth, so that runs, surface and models all are computed again; some of the runs
that are killed work in one process, some in two. The kill, SIGKILL to the whole group of
processes, comes at a moment that is uniform over the duration of a run. After it

- the results are whole: each file that the marker lists has its content, the page is there, and
  the tables are those of the campaign before the change or after it, to the byte;
- the raw files are as they were, and no process is left;
- the next run, undisturbed, gives the tables that a run in a fresh folder gives, to the byte,
  and leaves nothing next to the results.

A run that was done before its kill came is looked at as well, and is no kill.
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import numpy as np
from campaigns import fingerprint, simulated

from tribolab.campaign.store.ledger import Ledger, _digest

# What is stated before and after the change: segments (so runs and curves) and modulus (so
# contact and models) all follow.
STATED = (("trim = 0.10", '"1.5 MPa"'), ("trim = 0.12", '"1.6 MPa"'))
OWN = {"campaign.toml", "raw", "truth", "results"}


class Bench:
    """A campaign that is killed again and again, and what its tables have to be.

    Attributes
    ----------
    file, results
        The campaign file and its results folder.
    lasted, duration
        Time [s] of the latest undisturbed run, and of the latest that had everything to do.
    stated, shown
        Which of `STATED` the campaign file says, and the results show.
    wanted
        For each of `STATED`, the tables of a run in a fresh folder, by name.
    """

    def __init__(self, folder: Path):
        self.file = simulated(folder, repeats=1, scans=True, models=True)
        self.results = self.file.parent / "results"
        self.text = self.file.read_text("utf-8")
        self.raw = fingerprint(self.file.parent / "raw")
        self.wanted = []
        for which in range(len(STATED)):
            self.state(which)
            self.undisturbed("-o", str(folder / f"fresh_{which}"))
            self.wanted.append(tables(folder / f"fresh_{which}"))
        assert self.wanted[0] != self.wanted[1]
        self.state(0)
        self.undisturbed()
        self.duration, self.shown = self.lasted, 0

    def state(self, which: int) -> None:
        """Write the campaign file as one of `STATED`."""
        text, self.stated = self.text, which
        for old, new in zip(STATED[0], STATED[which], strict=True):
            assert old in text
            text = text.replace(old, new)
        self.file.write_text(text, "utf-8")

    def start(self, jobs: int, *more: str) -> subprocess.Popen:
        """Start a run in a group of processes of its own."""
        command = [sys.executable, "-m", "tribolab", "run", str(self.file), "-q", "-j", str(jobs)]
        return subprocess.Popen(
            [*command, *more],
            start_new_session=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )

    def undisturbed(self, *more: str) -> str:
        """Run to the end; returns what is wrong with that."""
        began = time.monotonic()
        process = self.start(1, *more)
        said, _ = process.communicate(timeout=600)
        self.lasted = time.monotonic() - began
        return f"exit code {process.returncode}: {said[-300:]}" if process.returncode > 1 else ""

    def kill(self, moment: float, jobs: int) -> tuple[bool, str]:
        """Run and kill at a moment [s]; returns whether it was killed, and what is wrong."""
        began = time.monotonic()
        process = self.start(jobs)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.communicate(timeout=moment)
        killed = process.poll() is None
        if not killed:  # the machine has become quicker
            self.duration = time.monotonic() - began
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        for _ in range(50):
            try:
                os.killpg(process.pid, 0)
            except ProcessLookupError:
                return killed, ""
            time.sleep(0.1)
        return killed, "processes are left"

    def beside(self) -> set[str]:
        """Return what lies next to the results and is none of the campaign's."""
        return {path.name for path in self.file.parent.iterdir()} - OWN

    def faults(self) -> list[str]:
        """Say what is wrong with the results, whichever they are, and with the raw files."""
        found = []
        ledger = Ledger.read(self.results)
        if not ledger.files:
            found.append("the marker lists nothing")
        for name, entry in ledger.files.items():
            path = self.results / name
            if not path.is_file() or _digest(path) != entry.digest:
                found.append(f"{name} is missing or changed")
        found += [f"{name} is nobody's" for name in ledger.foreign()]
        if "report.html" not in ledger.files:
            found.append("no page")
        try:
            json.loads((self.results / "report.json").read_text("utf-8"))
        except (OSError, ValueError) as error:
            found.append(f"report.json: {error}")
        if fingerprint(self.file.parent / "raw") != self.raw:
            found.append("raw files changed")
        return found


def tables(results: Path) -> dict[str, bytes]:
    """Return the content of all tables, those beside figures included."""
    files = (*results.glob("tables/*"), *results.glob("figures/*.csv"))
    return {str(path.relative_to(results)): path.read_bytes() for path in sorted(files)}


def one_kill(bench: Bench, rng: np.random.Generator) -> tuple[bool, str, list[str]]:
    """Change, run, kill, look; returns whether it was killed, how it went, and faults."""
    before, after = bench.shown, 1 - bench.shown
    bench.state(after)
    files, jobs = fingerprint(bench.results), int(rng.integers(1, 3))
    moment, lasts = rng.uniform(0, bench.duration), bench.duration
    killed, left = bench.kill(moment, jobs)
    faults = [left] if left else []
    faults += bench.faults()
    now = tables(bench.results)
    which = "old" if now == bench.wanted[before] else "new" if now == bench.wanted[after] else ""
    if not which:
        faults.append("tables are neither the old nor the new ones")
    if which == "old" and fingerprint(bench.results) != files:
        faults.append("old results, but touched")
    bench.shown = after if which == "new" else before
    end = "killed" if killed else "was done"
    beside = "a room was left" if bench.beside() else "nothing left"
    said = f"{moment:5.1f} s of {lasts:5.1f} s, -j {jobs}: {end}, {which or '?'}, {beside}"
    return killed, said, faults


def next_run(bench: Bench) -> list[str]:
    """Run undisturbed; returns what differs from a run that was never killed."""
    wrong = bench.undisturbed()
    if bench.shown != bench.stated:  # it had everything to do
        bench.duration = bench.lasted
    bench.shown = bench.stated
    faults = [wrong] if wrong else []
    faults += bench.faults()
    now, wanted = tables(bench.results), bench.wanted[bench.stated]
    differ = sorted(name for name in {*now, *wanted} if now.get(name) != wanted.get(name))
    faults += [f"{name} is not that of a fresh run" for name in differ]
    faults += [f"{name} was left behind" for name in sorted(bench.beside())]
    return [f"next run: {fault}" for fault in faults]


def main() -> int:
    """Run the kills of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--in-a-row", type=int, default=1, help="kills before the next whole run")
    given = parser.parse_args()
    rng = np.random.default_rng(given.seed)
    failed, kills, number, whole, kinds = 0, 0, 0, 0, collections.Counter()
    with tempfile.TemporaryDirectory(prefix="kill_campaign_") as name:
        bench = Bench(Path(name))
        print(f"a run takes {bench.duration:.1f} s", flush=True)
        while kills < given.kills:
            killed, said, faults = one_kill(bench, rng)
            kills, number = kills + killed, number + 1
            kinds[said.split(": ")[1]] += 1
            if number % given.in_a_row == 0 or kills == given.kills:
                whole += 1
                faults += next_run(bench)
            failed += bool(faults)
            print(f"{number:>4}  {said}  {'; '.join(faults) or 'ok'}", flush=True)
    for said, count in sorted(kinds.items()):
        print(f"{count:>4}  {said}")
    print(f"{kills} kills, {whole} whole runs after them, {failed} failures")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
