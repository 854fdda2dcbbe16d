"""Legal but tricky runs and scans of other labs: right, or does the result say it is not sure?

    python tests/detection/tricky_runs.py --seeds 1000:1004 --jobs 2 --verbose

Each kind of run (`tricky/kinds_*.py`) is drawn by its seed: loads of 0.05 N to 2 kN, coefficients
of 0.003 to 2, speeds of 0.5 um/s to 1 m/s, white, red, quantised, humming and spiky sensors, with
friction that depends on speed, way and distance. It reaches the analysis as its lab would hand it
over: as files with a dialect, stated or drafted, or as a dataset. Nothing of the project's own rig
is in it. Every run is judged by what the public functions give (`tricky/judge.py`):

right    every segment within its error of the truth, and all are there
unsure   a finding of status suspect or fail, or the file is refused; "off": of these, with a
         segment that is wrong, so that the finding was needed
wrong    passed, with a coefficient more than 3 standard errors from the truth (with the allowance
         for runs of several segments that `judge` states), a coefficient where nothing slides at
         constant speed, a speed 5 % off, or a clock shift 3 uncertainties off
lost     passed, every number right, but segments are missing or in pieces
>3       runs with any segment beyond 3 standard errors, whatever the status

Kinds of which small faults once passed ("new") are drawn three times as often. Sound runs have
nothing tricky about them: at most 2 % may be unsure, and none wrong. Repeats are judged as
campaigns of 18 runs of which one is 16 % off (or none), scans as in `tricky_scans.py`. Checks and
limits are tuned on seeds 0:10; the default seeds are those that are reported. The first run of each
kind is also analysed as part of a campaign, to see that `tribolab check` and `tribolab run` agree.

The exit code says whether the aims are met: at least 150 new, 200 sound runs and 60 scans, none
wrong, few sound ones unsure, and no disagreement.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import tempfile
import time
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parent))

from tricky import KINDS, NEW, SOUND, TRICKY  # noqa: E402 - it lies beside this file
from tricky.agreement import Ran, as_campaign, difference  # noqa: E402
from tricky.judge import Verdict, judge  # noqa: E402
from tricky.repeats import CAMPAIGNS, judge_repeats  # noqa: E402
from tricky_scans import FAULTS, print_scans  # noqa: E402

OUTCOMES = ("right", "unsure", "wrong", "lost")
CAMPAIGN = 12  # kinds in one campaign
SOUND_RUNS = 4  # sound runs of each kind for one tricky run
NEW_RUNS = 3
UNSURE = 0.02  # share of sound runs that may be suspect or fail


class Judged(NamedTuple):
    """A run and how it came out."""

    kind: str
    seed: int
    verdict: Verdict
    note: str
    seconds: float


def examine(task: tuple[str, int]) -> Judged:
    """Make and judge one run."""
    name, seed = task
    began = time.perf_counter()
    if name in CAMPAIGNS:
        with tempfile.TemporaryDirectory() as folder:
            verdict = judge_repeats(seed, Path(folder), CAMPAIGNS[name])
        return Judged(name, seed, verdict, "", time.perf_counter() - began)
    trial = KINDS[name].trial(seed)
    with tempfile.TemporaryDirectory() as folder:
        verdict = judge(trial, Path(folder))
    return Judged(name, seed, verdict, trial.note, time.perf_counter() - began)


def examine_campaign(task: tuple[tuple[str, ...], int]) -> dict[str, Ran]:
    """Analyse runs of some kinds as a campaign."""
    names, seed = task
    trials = {name: KINDS[name].trial(seed) for name in names}
    alike = {name: trial for name, trial in trials.items() if not trial.drop}
    with tempfile.TemporaryDirectory() as folder:
        return as_campaign(alike, Path(folder))


def tasks(seeds: range, kinds: Iterable[str]) -> list[tuple[str, int]]:
    """One run for each kind and seed; of new and of sound kinds more."""
    wanted = []
    for name in kinds:
        times = SOUND_RUNS if name in SOUND else NEW_RUNS if name in NEW else 1
        wanted += [(name, seed) for seed in range(seeds.start, seeds.start + times * len(seeds))]
    return wanted


def print_table(judged: list[Judged], kinds: Iterable[str]) -> None:
    """Print a line for each kind, and the sums."""
    print(f"{'kind':30} {'item':>5} {'runs':>5}", end="")
    print(
        f"{'right':>7} {'unsure':>7} {'(off)':>6} {'wrong':>6} {'lost':>5} {'>3':>4} {'s/run':>6}"
    )
    groups = [(name, KINDS[name].item if name in KINDS else "", {name}) for name in kinds]
    groups += [("all tricky", "", {*TRICKY, *CAMPAIGNS}), ("of these new", "", set(NEW))]
    groups += [("all sound", "", set(SOUND))]
    for title, item, names in groups:
        rows = [row for row in judged if row.kind in names]
        if not rows:
            continue
        n = {o: sum(row.verdict.outcome == o for row in rows) for o in OUTCOMES}
        off = sum(row.verdict.outcome == "unsure" and row.verdict.off for row in rows)
        beyond = sum(row.verdict.beyond for row in rows)
        seconds = sum(row.seconds for row in rows) / len(rows)
        print(
            f"{title:30} {item:>5} {len(rows):5}{n['right']:7} {n['unsure']:7} {off:6} "
            f"{n['wrong']:6} {n['lost']:5} {beyond:4} {seconds:6.2f}"
        )


def print_details(judged: list[Judged], outcomes: tuple[str, ...]) -> None:
    """Print what is known of every run that came out so, and of sound runs that are unsure."""
    for row in judged:
        told = row.verdict.outcome in outcomes
        if told or (row.kind in SOUND and row.verdict.outcome != "right"):
            note = f" ({row.note})" if row.note else ""
            print(f"\n{row.verdict.outcome} {row.kind} {row.seed}{note} [{row.verdict.status}]")
            print(f"    {row.verdict.words}")
            if row.verdict.objections:
                print(f"    {row.verdict.objections}")


def print_agreement(judged: list[Judged], ran: dict[str, Ran], seed: int) -> bool:
    """Print whether check and run said the same, and return it."""
    if not ran:
        return True
    verdicts = {row.kind: row.verdict for row in judged if row.seed == seed}
    told = {name: difference(verdicts[name], said) for name, said in ran.items()}
    differ = {name: words for name, words in told.items() if words}
    print(f"\ncheck and run agree on {len(told) - len(differ)} of {len(told)} runs")
    for name, words in differ.items():
        print(f"    {name} {seed}: {words}")
    return not differ


def aims_are_met(judged: list[Judged]) -> bool:
    """Whether there are enough runs, none wrong, and few sound ones unsure."""
    new = [row for row in judged if row.kind in NEW]
    sound = [row.verdict.outcome for row in judged if row.kind in SOUND]
    enough = len(new) >= 150 and len(sound) >= 200
    calm = sound.count("unsure") <= UNSURE * len(sound)
    return enough and calm and not any(row.verdict.outcome == "wrong" for row in judged)


def main() -> int:
    """Print the table; the exit code says whether the aims are met."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", default="1000:1004", help="FIRST:LAST+1")
    parser.add_argument("--kinds", default="", help="names, items or new, separated by commas")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--no-campaign", action="store_true", help="leave the campaigns out")
    parser.add_argument("--verbose", action="store_true", help="list the wrong and lost ones")
    parser.add_argument("--all", action="store_true", help="list the unsure ones, too")
    options = parser.parse_args()
    chosen = set(filter(None, options.kinds.split(",")))
    kinds = [n for n, kind in KINDS.items() if not chosen or {n, kind.item} & chosen]
    kinds += [n for n in NEW if "new" in chosen and n not in kinds]
    single = list(kinds)  # in one run each
    kinds += [n for n in CAMPAIGNS if not chosen or {n, "new"} & chosen]
    seeds = range(*map(int, options.seeds.split(":")))
    wanted = tasks(seeds, kinds)
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(options.jobs, mp_context=context) as pool:
        begun = [
            pool.submit(examine_campaign, (tuple(single[i : i + CAMPAIGN]), seeds.start))
            for i in range(0, 0 if options.no_campaign else len(single), CAMPAIGN)
        ]
        judged = list(pool.map(examine, wanted, chunksize=2))
        ran = {name: said for one in begun for name, said in one.result().items()}
    print_table(judged, kinds)
    agree = print_agreement(judged, ran, seeds.start)
    if options.verbose or options.all:
        print_details(judged, ("wrong", "lost", "unsure") if options.all else ("wrong", "lost"))
    print()
    sets = range(seeds.start, seeds.start + max(1, len(seeds) // 4))
    missed = print_scans(sets) if not chosen or chosen & {"scans", *FAULTS} else 0
    return 0 if agree and aims_are_met(judged) and not missed else 1


if __name__ == "__main__":
    sys.exit(main())
