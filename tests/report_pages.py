"""A report with a flagged run, a long one and a failed one, and readers of its page."""

import base64
import json
import re
import zlib
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
from reporting import made_outcome, made_run, with_run

from tribolab.figures.spec import Axis, FigureSpec, Panel, Series
from tribolab.qc.flags import attach
from tribolab.report.results import write_report

RUNS = [
    ("sb-r_1", "Sb-R", "glycerol", 31.0, 0.8),
    ("sb-s_1", "Sb-S", "dry", 31.0, 1.1),
    ("sb-s_long", "Sb-S", "glycerol", 31.0, 0.9),
]
FLAGGED = 1  # index of the run with a flagged sample at 3 s
LONG = 2, 2500  # index of a run with more samples than the page holds; samples a segment


def made(folder):
    """Write results with a flagged run and a long one."""
    outcome = made_outcome(
        folder, RUNS, "Glycerol & PMMA", [("broken", "bad.csv: column 'Fx' has no unit")]
    )
    for index, samples in ((FLAGGED, 400), LONG):
        name, _, _, load, mu = RUNS[index]
        run, segments, friction = made_run([1e-3, 1e-2], load, mu, seed=9, samples=samples)
        if index == FLAGGED:
            flags = np.ones(run.sizes["time"], np.int8)
            flags[np.searchsorted(run.time.values, 3.0)] = 3
            run = attach(run, "friction_force", {"spikes": flags}, {"spikes": 14})
            run.attrs |= {
                "quality": "suspect",
                "findings": [
                    {
                        "check": "spikes",
                        "status": "suspect",
                        "variable": "friction_force",
                        "message": "1 sample stands out",
                        "value": 1.0,
                        "unit": "1",
                        "cure": "Look at it",
                    }
                ],
            }
        outcome = with_run(outcome, index, (run, segments, friction))
    write_report(outcome, figures="none")  # the page draws its own
    return outcome.folder


def made_with_repeats(folder):
    """Write results of two conditions, one of them at two loads, both with repeats."""
    runs = [("a1", "Sb-R", "glycerol", 31.0, 0.8), ("a2", "Sb-R", "glycerol", 31.0, 0.84)]
    runs += [("b1", "Sb-R", "glycerol", 91.0, 0.7)]
    runs += [("c1", "Sb-S", "dry", 31.0, 1.1), ("c2", "Sb-S", "dry", 31.0, 1.14)]
    outcome = made_outcome(folder, runs, "Repeats")
    write_report(outcome, figures="none")  # the page draws its own
    return outcome.folder


class Reader(HTMLParser):
    """Collects the elements of a page, and checks that they are closed in order."""

    VOID = {"meta", "link", "img", "br", "input", "hr", "wbr"}

    def __init__(self, text):
        super().__init__()
        self.elements, self.open, self.text = [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)

    def all(self, tag):
        return [attrs for name, attrs in self.elements if name == tag]


def sent(folder, factory):
    """A folder of its own with nothing but the page, as it is sent by mail."""
    place = factory.mktemp("sent")
    (place / "report.html").write_text(page_of(folder), encoding="utf-8")
    return place


def page_of(folder):
    return (folder / "report.html").read_text(encoding="utf-8")


SAVING = "window.saved = []; report.save = (...file) => saved.push(file); 0"
SHOWN = (
    "document.querySelector('#{} .plot')._fullData.filter(one => one.visible === true)"
    ".map(one => one.name)"
)


def drawn(page, figure="card-1"):
    """Bring a figure near, wait until it is drawn, and return the names of what it shows."""
    page.run(f"document.getElementById('{figure}').scrollIntoView({{behavior: 'instant'}})")
    page.wait(f"document.querySelector('#{figure} .js-plotly-plot')?._fullData !== undefined")
    return names(page, figure)


def names(page, figure):
    """Return the names of what a figure shows."""
    return page.run(SHOWN.format(figure))


# For a browser: all that is folded away is opened, and all figures are drawn; returns how many.
OPEN_ALL = (
    "document.documentElement.classList.add('every'),"
    "Promise.all(Array.from(document.querySelectorAll('details'),"
    "one => { one.open = true; return report.unfold(one) })).then(() => 0)"
)
DRAW_ALL = (
    "Promise.all(Array.from(document.querySelectorAll('figure.live'),"
    "one => report.charts.chartOf(one).draw()))"
    ".then(() => document.querySelectorAll('figure.live .js-plotly-plot').length)"
)
AXE = (Path(__file__).parent / "vendor" / "axe.min.js").read_text(encoding="utf-8")
# of one page seen twice: what hangs on its width and its colours
BY_LOOKS = "runOnly: ['color-contrast', 'scrollable-region-focusable', 'target-size']"


def faults_of(page, rules=""):
    """What keeps somebody from reading a page: the rules it breaks, and where."""
    page.run(f"{AXE};0")
    return page.run(
        f"axe.run(document, {{resultTypes: ['violations'], preload: false, {rules}}})"
        ".then(told => told.violations"
        ".filter(v => ['serious', 'critical'].includes(v.impact))"
        ".map(v => [v.id, v.nodes.map(n => n.html.slice(0, 200))]))"
    )


PACKED = r'<script type="application/octet-stream"%s>([^<]*)</script>'


def folded_of(folder):
    """All that is folded away, as HTML."""
    return [_unpacked(one) for one in re.findall(PACKED % ' class="packed"', page_of(folder))]


def details_of(folder):
    """What stands under each run, as HTML."""
    folded = r'<details class="run.*?' + PACKED % ' class="packed"'
    groups = re.findall(folded, page_of(folder), re.DOTALL)
    return [run for one in groups for run in _unpacked(one).split("<!--next run-->")]


def figures_of(folder):
    """What the figures of a page show, by their ids."""
    packed = re.findall(PACKED % "", page_of(folder))
    return {figure["id"]: figure for figure in (json.loads(_unpacked(one)) for one in packed)}


def live_of(data):
    """A figure of a page as it was before it became plain data."""
    axes = ([Axis(**{"label": ""} | panel[side]) for side in "xy"] for panel in data["panels"])
    panels = tuple(Panel(*pair) for pair in axes)
    series = tuple(Series(**one) for one in data["series"])
    words = dict.fromkeys(("section", "title", "note", "alt"), "")
    return FigureSpec(**words | data | {"panels": panels, "series": series})


def _unpacked(text):
    return zlib.decompress(base64.b64decode(text)).decode()
