"""Read thousands of damaged files: each is a dataset, or one TribolabError that names the file.

    PYTHONPATH=$PWD python tests/robustness/fuzz.py --first 0 --cases 10000 --jobs 2
    PYTHONPATH=$PWD python tests/robustness/fuzz.py --kinds new --cases 2000

Case n is damaged copy number n: the seed of everything random in it. Every case runs in a child
process with a limit of 1 GB above what the imports take, a limit of 5 s of computing, and
whatever kills the child is counted too. What took too long is tried once more: only what takes
too long twice is a violation. A violation is printed with its seed; ``--case n`` runs that one
alone, here, and shows the traceback. ``--keep FOLDER`` writes the damaged files of violations
there.

The kind ``new`` are files made rather than damaged: wide, deep, endless lines, foreign encodings,
numbers beyond all numbers, long headers; they are drafted from too.
"""

from __future__ import annotations

import argparse
import collections
import multiprocessing
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Sequence
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import NamedTuple

os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np
from mutations import MADE, mutate

from tribolab.core.errors import TribolabError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.results import read_tester_results
from tribolab.reading.unknown.proposal.draft import draft_dialect

SECONDS, MEMORY, LONGEST_MESSAGE = 5.0, 1 << 30, 1500
NO_ANSWER = "did not answer the alarm"
REAL = Path(__file__).resolve().parents[3] / "shared" / "data"
SKIPPED = {"LICENSE", "LICENSE.txt", "LICENSE.md", "README.md", "README_upstream.md"}
# How often a family is drawn: what labs have most, most often; slow readers less.
WEIGHT = {".csv": 4, ".txt": 3, ".TXT": 3, ".mat": 4, ".tdms": 6, ".xlsx": 4, ".nc": 6, ".xls": 1}
OWN_DIALECT = {
    "nanovea_map_MIT": "nanovea_map",
    "bearing_profiles_MIT": "bearing_profile",
    "rig_scan": "surftest_csv",
    "rig_run": "linear_slider",
    "actuator_friction_CC0": "pneumatic_actuator",
    "rock_velstep_MIT": "biaxial_rock",
    "cetr_umt2_MIT": "cetr_umt2",
    "stickslip_paper_CeCILL-B": "paper_stick_slip",
    "tdms_force_MIT": "optical_trap_tdms",
}


class Timeout(BaseException):
    """Raised by the alarm: no reader may catch it."""


class Verdict(NamedTuple):
    """What became of one damaged file."""

    case: int
    source: str
    ways: str
    reader: str
    outcome: str  # dataset | error | a violation
    detail: str
    seconds: float


def rig_files(folder: Path) -> None:
    """Files of the virtual rig, and what tribolab writes itself."""
    from tribolab import rig
    from tribolab.reading.netcdf.netcdf import write_netcdf
    from tribolab.rig.files import scan_file
    from tribolab.rig.parameters import Protocol, Rig

    campaign = rig.simulate_campaign(
        folder / "campaign",
        0,
        surfaces=["Sb-R"],
        loads=[31.0],
        n_repeats=1,
        n_scans=1,
        rig=Rig(Protocol(speeds=(1e-4, 1e-3, 1e-2))),
    ).parent
    (folder / "rig_run").mkdir()
    for file in (campaign / "raw" / "friction").glob("*glycerol*01*.csv"):
        shutil.copy(file, folder / "rig_run")
    shutil.rmtree(campaign)
    (folder / "rig_scan").mkdir()
    scan = rig.scans("Sb-R", 1, length=2e-3)
    (folder / "rig_scan" / "sb-r_1.csv").write_bytes(
        scan_file(scan.x.values, scan.height.values[0])
    )
    (folder / "own").mkdir()
    run = read(next((folder / "rig_run").glob("*_force.csv")))
    run = run.isel(time=slice(None, 8000))
    write_netcdf(run, folder / "own" / "run.nc")
    write_netcdf(run, folder / "own" / "grouped.nc", group="run")
    plain = run.copy()
    plain.attrs = {}
    plain.to_netcdf(folder / "own" / "classic.nc", format="NETCDF3_64BIT")


class Sources:
    """All files there are to damage, with their weights."""

    def __init__(self, folder: Path, new: bool = False):
        self.new = new
        files = [p for p in sorted(REAL.rglob("*")) if p.is_file() and p.name not in SKIPPED]
        files = [p for p in files if not p.name.startswith("Licence")]
        self.files = files + sorted(p for p in folder.rglob("*") if p.is_file())
        weight = np.array([WEIGHT.get(p.suffix, 2) for p in self.files], dtype=float)
        self.chance = weight / weight.sum()

    def draw(self, rng: np.random.Generator) -> Path:
        return self.files[rng.choice(len(self.files), p=self.chance)]


def readers(source: Path) -> list:
    """Ways to read a file: (name, function of its path)."""
    own = OWN_DIALECT.get(source.parent.name)
    found = [("read", read), ("read_scans", read_scans)]
    found.append(("read_scans units", lambda p: read_scans(p, x_unit="mm", height_unit="um")))
    if own:
        scan = own in ("nanovea_map", "bearing_profile", "surftest_csv")
        reader = read_scans if scan else read
        found += 3 * [(f"{reader.__name__} {own}", lambda p: reader(p, own))]
    if source.parent.name == "mitutoyo_sj410_res_MIT":
        found += 3 * [("read_results", read_tester_results)]
    if source.suffix == ".nc":
        found += 3 * [("read_netcdf", read_netcdf)]
    if source.suffix in (".mat", ".tdms", ".nc"):
        found += 3 * [("read", read)]
    return found


def damaged(case: int, sources: Sources, folder: Path):
    """Write damaged copy number `case` to a folder; say how it is to be read."""
    rng = np.random.default_rng(case)
    if sources.new:
        return _made(rng, folder)
    source = sources.draw(rng)
    choices = readers(source)
    name, reader = choices[rng.integers(len(choices))]
    content, ways = mutate(source.read_bytes(), rng)
    target = folder / source.name
    if rng.random() < 0.05:
        target = folder / ("no extension", "Ü µ.dat", "x.nc", "a.xlsx", "b.sdf")[rng.integers(5)]
        ways += "+other name"
    target.write_bytes(content)
    for ending, other in (("_force", "_motion"), ("_motion", "_force")):
        mate = source.with_name(source.name.replace(ending, other))
        if target.stem.endswith(ending) and mate.is_file():
            shutil.copy(mate, folder / mate.name)
            if ending == "_motion":  # the run is read by its main log
                target = folder / mate.name
    return source, ways, name, reader, target


def _made(rng: np.random.Generator, folder: Path):
    """Write a file of an unusual kind, as `damaged` does."""
    kind = MADE[rng.integers(len(MADE))]
    target = folder / ("made.csv", "made.txt", "made.xlsx", "made.sdf", "made.dat")[rng.integers(5)]
    choices = readers(target)
    choices += [("draft", draft_dialect)] * 2
    choices += [(f"read {name}", lambda p, n=name: read(p, n)) for name in OWN_DIALECT.values()][
        3:6
    ]
    name, reader = choices[rng.integers(len(choices))]
    target.write_bytes(kind(rng))
    return Path("new") / target.name, kind.__name__, name, reader, target


def sound(data) -> str:
    """What is wrong with a dataset that a reader gave; empty if nothing is."""
    if not hasattr(data, "dims"):  # a draft
        return ""
    if "time" in data.dims and data.sizes["time"] and "instrument" in data.attrs:
        time_axis = np.asarray(data["time"].values, dtype=float)
        if not (np.isfinite(time_axis).all() and (np.diff(time_axis) > 0).all()):
            return "time is not finite and increasing"
    if "height" in data and not np.isfinite(data["height"].values).any():
        return "no height is a number"
    if "x" in data.coords and not np.isfinite(data["x"].values.astype(float)).all():
        return "x is not finite"
    return ""


def examine(case: int, sources: Sources, folder: Path, show: bool = False) -> Verdict:
    """Damage a file, read it, and say what came out."""
    source, ways, name, reader, target = damaged(case, sources, folder)
    label = f"{source.parent.name}/{source.name}"
    before = {p for p in folder.parent.rglob("*")}
    outcome, detail = "dataset", ""
    signal.signal(signal.SIGPROF, _alarm)
    start = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            data = reader(target)
        if problem := sound(data):
            outcome, detail = "unsound", problem
    except TribolabError as error:
        outcome, detail = "error", str(error)
        stem = target.stem.replace("_force", "").replace("_motion", "")
        if stem not in detail:
            outcome = "nameless"
        elif len(detail) > LONGEST_MESSAGE:
            outcome = "too long"
        elif (
            "Traceback" in detail or "\n" in error.message_for("campaign").strip()
        ):  # a table elsewhere
            outcome = "message of several lines"
    except Timeout:
        outcome, detail = "hang", "".join(traceback.format_exc(limit=-4))
    except MemoryError:
        outcome, detail = "memory", "".join(traceback.format_exc(limit=-4))
    except BaseException as error:
        if show:
            traceback.print_exc()
        frames = traceback.extract_tb(error.__traceback__)
        ours = [f for f in frames if "tribolab" in f.filename] or frames
        where = f"{Path(ours[-1].filename).name}:{ours[-1].lineno} {ours[-1].line}"
        outcome, detail = type(error).__name__, f"{error} @ {where}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    if set(folder.parent.rglob("*")) - before:
        outcome, detail = "wrote a file", str(set(folder.parent.rglob("*")) - before)
    return Verdict(case, label, ways, name, outcome, detail, time.process_time() - start)


def _alarm(*_) -> None:
    raise Timeout


def _child(link: Connection, cases: list[int], sources: Sources, folder: Path) -> None:
    """Work through cases, telling each before and after it."""
    sys.stderr = Path(os.devnull).open("w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    for case in cases:
        link.send(case)
        place = Path(tempfile.mkdtemp(dir=folder)) / "raw"
        place.mkdir()
        try:
            link.send(examine(case, sources, place))
        except MemoryError:  # while the damaged file was made
            link.send(Verdict(case, "", "", "", "not made", "", 0.0))
        shutil.rmtree(place.parent)


class Worker:
    """A child process with the cases that it still has to do."""

    def __init__(self, cases: list[int], sources: Sources, folder: Path):
        self.left, self.sources, self.folder = cases, sources, folder
        self.start()

    def start(self) -> None:
        context = multiprocessing.get_context("fork")
        self.link, end = context.Pipe()
        arguments = (end, self.left, self.sources, self.folder)
        self.process = context.Process(target=_child, args=arguments, daemon=True)
        self.process.start()
        end.close()
        self.current, self.since = None, time.monotonic()

    def hear(self) -> Verdict | None:
        """Take one message, or find that the child died."""
        try:
            said = self.link.recv()
        except (EOFError, OSError):
            self.process.join()
            return self.lost(f"killed by signal {-(self.process.exitcode or 0)}")
        self.since = time.monotonic()
        if isinstance(said, Verdict):
            self.left = self.left[1:]
            if said.outcome == "hang" and self.left:  # an import that was cut short stays so
                self.process.kill()
                self.process.join()
                self.start()
            return said
        self.current = said
        return None

    def lost(self, why: str) -> Verdict | None:
        if not self.left:
            return None
        case, self.left = self.left[0], self.left[1:]
        rng = np.random.default_rng(case)
        source = self.sources.draw(rng)
        if self.left:
            self.start()
        seconds = time.monotonic() - self.since
        return Verdict(case, f"{source.parent.name}/{source.name}", "?", "?", "crash", why, seconds)

    def stuck(self) -> bool:
        return bool(self.left) and time.monotonic() - self.since > 20 * SECONDS

    def kill(self) -> Verdict | None:
        self.process.kill()
        self.process.join()
        return self.lost(NO_ANSWER)


def run(cases: range, jobs: int, folder: Path, budget: float, new: bool) -> list[Verdict]:
    """Do all cases, as far as the time goes; those that took too long, once more."""
    rig_files(folder / "made")
    import SurfaceTopography.IO  # noqa: F401 - loaded before the children, whose time is measured

    sources = Sources(folder / "made", new)
    verdicts = _work(cases, jobs, folder, budget, sources)
    slow = [v.case for v in verdicts if v.outcome == "hang" or v.detail == NO_ANSWER]
    if slow:
        print(f"  too slow, tried once more: {slow}", flush=True)
        again = {v.case: v for v in _work(slow, 1, folder, budget, sources)}
        verdicts = [again.get(v.case, v) for v in verdicts]
    return verdicts


def _work(
    cases: Sequence[int], jobs: int, folder: Path, budget: float, sources: Sources
) -> list[Verdict]:
    workers = [Worker(list(cases[n::jobs]), sources, folder) for n in range(jobs)]
    verdicts: list[Verdict] = []
    end = time.monotonic() + budget
    while any(w.left for w in workers) and time.monotonic() < end:
        busy = {w.link: w for w in workers if w.left}
        for link in wait(list(busy), timeout=1.0):
            verdict = busy[link].hear()
            if verdict:
                verdicts.append(verdict)
                if verdict.outcome not in ("dataset", "error"):
                    print(f"  {verdict}", flush=True)
        for worker in workers:
            if worker.stuck() and (verdict := worker.kill()):
                verdicts.append(verdict)
                print(f"  {verdict}", flush=True)
    for worker in workers:
        worker.process.kill()
    return verdicts


def report(verdicts: list[Verdict]) -> int:
    """Print counts by family, way and outcome; return the number of violations."""
    good = ("dataset", "error")
    outcomes = sorted({v.outcome for v in verdicts}, key=lambda o: (o not in good, o))
    for title, key in (
        ("source", lambda v: v.source.split("/")[0]),
        ("damage", lambda v: v.ways.split("+")[0]),
        ("reader", lambda v: v.reader.split()[0] if v.reader else ""),
    ):
        count = collections.Counter((key(v), v.outcome) for v in verdicts)
        print(f"\n{title:<28}" + "".join(f"{o:>12}" for o in outcomes))
        for name in sorted({key(v) for v in verdicts}):
            print(f"{name:<28}" + "".join(f"{count[name, o]:>12}" for o in outcomes))
    slow = max((v.seconds for v in verdicts), default=0.0)
    bad = [v for v in verdicts if v.outcome not in good]
    print(f"\n{len(verdicts)} damaged files, {len(bad)} violations, slowest {slow:.2f} s")
    return len(bad)


def main() -> int:
    """Run the cases of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--budget", type=float, default=540.0, help="seconds")
    parser.add_argument("--case", type=int, help="this one alone, with its traceback")
    parser.add_argument("--keep", type=Path, help="folder for the damaged file of --case")
    parser.add_argument("--kinds", choices=("old", "new"), default="old")
    given = parser.parse_args()
    new = given.kinds == "new"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "made").mkdir()
        if given.case is None:
            cases = range(given.first, given.first + given.cases)
            return int(report(run(cases, given.jobs, folder, given.budget, new)) > 0)
        rig_files(folder / "made")
        place = folder / "one" / "raw"
        place.mkdir(parents=True)
        print(examine(given.case, Sources(folder / "made", new), place, show=True))
        if given.keep:
            shutil.copytree(place, given.keep, dirs_exist_ok=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
