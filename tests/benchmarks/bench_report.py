"""How large the report of many runs is, and how soon Chromium shows it.

Simulates one small campaign, gives copies of its runs' data files to as many runs as asked for,
writes the report, and opens it in headless Chromium:

    python tests/benchmarks/bench_report.py 200 2000

Prints, for each number of runs, how long the report took to write, how large the page and all that
lies beside it are, how long until the page had loaded and could be scrolled (the best of three),
and how long sorting, searching and opening a run took.
"""

import os
import shutil
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from chromium import chromium  # noqa: E402 - after its folder is known

from tribolab import rig  # noqa: E402 - as above
from tribolab.campaign.executor import workers  # noqa: E402 - as above
from tribolab.report.results import write_report  # noqa: E402 - as above
from tribolab.report.run import run_campaign  # noqa: E402 - as above

_PAINTED = (
    "new Promise(done => requestAnimationFrame(() => requestAnimationFrame("
    "() => done(performance.now()))))"
)


def many(outcome, count, folder):
    """Return an outcome of so many runs, each a copy of one that is there."""
    (folder / "data").mkdir(parents=True)
    for one in (*outcome.curves, *outcome.surfaces):
        if one.data_file:
            shutil.copy(outcome.folder / one.data_file, folder / one.data_file)
    done, runs = [run for run in outcome.runs if run.done], []
    for number in range(count):
        run = done[number % len(done)]
        name = f"{run.name}_{number + 1:04d}"
        file = f"data/{name}.nc"
        os.link(outcome.folder / run.data_file, folder / file)
        runs.append(replace(run, name=name, data_file=file))
    return replace(outcome, runs=tuple(runs), folder=folder)


def measure(page_file, profile):
    """Return load times and the times of what a reader does, in seconds."""
    loads = []
    with chromium(profile) as browser:
        for _ in range(3):
            with browser.page(page_file) as page:
                loads.append(page.run(_PAINTED) / 1e3)
        with browser.page(page_file) as page:
            acts = {
                "sort": "document.querySelector('#runs-table [data-name=fastest] button').click()",
                "search": "const f = document.querySelector('input[type=search]');"
                "f.value = '_0007'; f.dispatchEvent(new Event('input'))",
                "open a run": "location.hash = '#run-7'",
            }
            spent = {}
            for name, act in acts.items():
                spent[name] = page.run(
                    f"(async () => {{ const t = performance.now(); {act};"
                    f"return (await {_PAINTED}) - t }})()"
                )
            page.wait("document.querySelector('#run-7 .plot canvas') !== null")
            assert page.console == [], page.console
    return min(loads), spent


def main(counts):
    """Print one line per number of runs."""
    with tempfile.TemporaryDirectory() as place:
        place = Path(place)
        file = rig.simulate_campaign(place / "campaign", seed=0, surfaces=["Sb-R"], n_repeats=1)
        outcome = run_campaign(file, jobs=2)
        for count in counts:
            folder = place / f"results{count}"
            made = many(outcome, count, folder)
            start = time.perf_counter()
            with workers(2, None) as pool:
                write_report(made, executor=pool)
            written = time.perf_counter() - start
            size = (folder / "report.html").stat().st_size / 1e6
            beside = sum(f.stat().st_size for f in (folder / "traces").glob("*")) / 1e6
            figures = sum(f.stat().st_size for f in (folder / "figures").glob("*")) / 1e6
            load, spent = measure(folder / "report.html", place / f"profile{count}")
            acts = ", ".join(f"{name} {1e-3 * t:.2f} s" for name, t in spent.items())
            print(
                f"{count} runs: written in {written:.0f} s; page {size:.1f} MB, traces/ "
                f"{beside:.1f} MB, figures/ {figures:.0f} MB; shown after {load:.2f} s; {acts}",
                flush=True,
            )


if __name__ == "__main__":
    main([int(count) for count in sys.argv[1:]] or [200, 2000])
