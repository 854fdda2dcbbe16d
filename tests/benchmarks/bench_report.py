"""How large the report of many runs is, and how soon Chromium shows it.

Simulates one small campaign, repeats what its report says of a run until there are as many runs
as asked for, and opens the page in headless Chromium:

    python tests/benchmarks/bench_report.py 200 2000

Prints, for each number of runs, how large the page is and what of it are finer traces, how long
until it had loaded and was painted with its first figures, until the first of these answered (the
best of three, each in a browser that has just started), and how long sorting, searching and opening
a run took.
"""

import json
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from chromium import chromium  # noqa: E402 - after its folder is known

from tribolab import rig  # noqa: E402 - as above
from tribolab.app.run import run_campaign  # noqa: E402 - as above
from tribolab.reading.netcdf.netcdf import read_groups  # noqa: E402 - as above
from tribolab.records.part_records import CurveRecord  # noqa: E402 - as above
from tribolab.records.runs.traces import page_trace, trace_size  # noqa: E402 - as above
from tribolab.report.page.page import write_page  # noqa: E402 - as above
from tribolab.report.page_figures.curves import FrictionOverSpeed, card_figures  # noqa: E402 - as above
from tribolab.report.page_figures.shown import shown_figures  # noqa: E402 - as above

_PAINTED = (
    "new Promise(done => requestAnimationFrame(() => requestAnimationFrame("
    "() => done(performance.now()))))"
)


_ANSWERS = (
    "(async () => { while (!document.querySelector('#card-1 .main-svg'))"
    " await new Promise(r => setTimeout(r, 5)); return performance.now() })()"
)
_PICTURES = "document.querySelectorAll('#card-1 :is(.still, .main-svg)').length"


def repeated(document, count):
    """Return the document with so many runs, and the findings and raw files that go with them."""
    runs, findings, sources = [], [], []
    first = document["runs"]
    for number in range(count):
        run = first[number % len(first)]
        name = f"{run['name']}_{number + 1:04d}"
        runs.append(run | {"name": name})
        mine = [f for f in document["findings"] if f["run"] == run["name"]]
        findings += [finding | {"run": name} for finding in mine]
        sources += [s for s in document["sources"] if s["file"] in run["files"]]
    return document | {"runs": runs, "findings": findings, "sources": sources}


class Traces(dict):
    """The traces of the document's runs, by name, as a catalogue gives them."""

    def trace(self, kind, name):
        """Return the trace of a run."""
        return self[name]


def traces(document, outcome, count):
    """Return the traces of the document's runs, with what so many runs may have."""
    packed = []
    for run in outcome.runs:
        groups = read_groups(outcome.folder / run.data_file, ("run", "segments", "friction"))
        packed.append(page_trace(*groups.values(), *trace_size(count)))
    runs = document["runs"]
    return Traces({run["name"]: packed[place % len(packed)] for place, run in enumerate(runs)})


def cards(outcome):
    """Return the figures of the answer's cards."""
    curves = [entry.record for entry in outcome.store.all("curve", CurveRecord)]
    return shown_figures(card_figures(FrictionOverSpeed(curves, {}, {}, {}, ())))


def measure(page_file, profile):
    """Return when the page is shown and answers, and the times of what a reader does [s]."""
    loads, spent = [], {}
    for number in range(3):
        with chromium(f"{profile}-{number}") as browser, browser.page(page_file) as page:
            shown = page.run(_PAINTED)
            assert page.run(_PICTURES) > 0, "shown with its first figure"
            loads.append((shown / 1e3, page.run(_ANSWERS) / 1e3))
    with chromium(profile) as browser:
        with browser.page(page_file) as page:
            acts = {
                "sort": "document.querySelector('#runs-table [data-name=load] button').click()",
                "search": "const f = document.querySelector('#runs input[type=search]');"
                "f.value = '_0007'; f.dispatchEvent(new Event('input'))",
                "open a run": "location.hash = '#run-7'; while (!document.querySelector("
                "'#run-7 .main-svg')) await new Promise(r => setTimeout(r, 5))",
            }
            for name, act in acts.items():
                script = f"{act}; return (await {_PAINTED}) - t"
                took = page.run(f"(async () => {{ const t = performance.now(); {script} }})()")
                spent[name] = took / 1e3
            assert page.console == [], page.console
    return min(loads), spent


def main(counts):
    """Print one line per number of runs."""
    with tempfile.TemporaryDirectory() as place:
        place = Path(place)
        file = rig.simulate_campaign(
            place / "campaign", seed=0, surfaces=["Sb-R"], loads=[31.0], n_repeats=1
        )
        outcome = run_campaign(file, jobs=1)
        document = json.loads((outcome.folder / "report.json").read_text(encoding="utf-8"))
        figures = cards(outcome)
        for count in counts:
            folder = place / f"results{count}"
            folder.mkdir()
            (folder / "figures").symlink_to(outcome.folder / "figures")
            many = repeated(document, count)
            chosen = traces(many, outcome, count)
            fine = sum(len(one.fine) for one in chosen.values()) / 1e6
            write_page(many, folder, lambda many=many: iter(many["runs"]), chosen, figures)
            size = (folder / "report.html").stat().st_size / 1e6
            (load, answers), spent = measure(folder / "report.html", place / f"profile{count}")
            acts = ", ".join(f"{name} {took:.2f} s" for name, took in spent.items())
            print(
                f"{count} runs: page {size:.1f} MB, {fine:.1f} MB of it finer traces before the "
                f"details are packed; shown after {load:.2f} s, "
                f"answers after {answers:.2f} s; {acts}",
                flush=True,
            )


if __name__ == "__main__":
    main([int(count) for count in sys.argv[1:]] or [200, 2000])
