"""Writing of report.html: one file with all its data, which opens without a network.

The sections are listed in `tribolab.report.page.sections`, with instructions for adding one.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from tribolab.core.untyped import Json
from tribolab.records.packed import deflated
from tribolab.records.runs.traces import script_json
from tribolab.report.page.doubts import doubts
from tribolab.report.page.glossary import words_of
from tribolab.report.page.run_list import listed_runs
from tribolab.report.page.scan_list import listed_scans
from tribolab.report.page.sections import shown_sections
from tribolab.report.page.templating import environment, framing, library
from tribolab.report.page.views import views
from tribolab.report.page_figures.points import RunPoint
from tribolab.report.page_figures.shown import ShownFigure

if TYPE_CHECKING:
    from tribolab.campaign.store.catalogue import Catalogue

_MAX_ROWS = 100  # rows in the list of runs; more are compressed and added on request
_MAX_DOUBTS = 4  # most doubts on the first screen
_RUNS_PER_PACK = 8  # runs compressed together
_BETWEEN = "<!--next run-->"  # as in assets/files.js
RunDocuments = Callable[[], Iterable[Json]]


class Detail(NamedTuple):
    """Details of one run: short entry, run number from 1 (`place`), and the compressed rest.

    Several runs are compressed together, because their details share most of their text: the first
    has the details of all in `packed`, which is empty for the others. `part` is the index in them.
    """

    run: Json
    place: int
    part: int
    packed: str


def write_page(
    document: Json,
    folder: Path,
    runs: RunDocuments,
    store: Catalogue,
    live: Sequence[ShownFigure] = (),
    points: Mapping[str, Sequence[RunPoint]] | None = None,
) -> Path:
    """Write report.html with all its data into the results folder.

    The details of runs are compressed, and the page unpacks them on request. The page is written
    piece by piece, with the details of only a few runs in memory.

    Parameters
    ----------
    document
        From `tribolab.report.document.document.report_document`, with short entries of the runs,
        and with ``review`` from `tribolab.report.page.reviewing.review_data` if the reader may
        decide on runs.
    folder
        Results folder.
    runs
        Function that yields the runs as in report.json.
    store
        Store with the traces of the runs.
    live
        Figures that the page draws.
    points
        Friction against speed, by name of the run.
    """
    context = _context(document, folder, runs, store, live, points or {})
    template, frame = framing("report.html.j2", shown_sections(context), folder, draws=True)
    path = folder / "report.html"
    stream = template.stream(context | frame)
    stream.enable_buffering(256)
    stream.dump(str(path), encoding="utf-8")
    return path


def prepare_page() -> None:
    """Compile the templates and compress the drawing library in advance, e.g. during drawing."""
    library()
    jinja = environment(Path())
    for name in jinja.list_templates():
        if not name.startswith(("across/", "paper/")):
            jinja.get_template(name)


def _context(
    document: Json,
    folder: Path,
    runs: RunDocuments,
    store: Catalogue,
    live: Sequence[ShownFigure],
    points: Mapping[str, Sequence[RunPoint]],
) -> Json:
    surfaces = document.get("surfaces", [])
    every = document["runs"]
    traces = {
        run["name"]: json.loads(trace.coarse)
        for run in every
        if (trace := store.trace("run", run["name"])) is not None
    }
    context = dict(document) | {
        "has_contact": any(surface["contact"] or surface["adhesion"] for surface in surfaces),
        "words": words_of(
            runs=bool(every),
            surfaces=bool(surfaces),
            contact=any(surface["contact"] or surface["adhesion"] for surface in surfaces),
            models=bool(document.get("models")),
        ),
        "left_out": omitted_rows(every),
        "places": {run["name"]: place + 1 for place, run in enumerate(every)},
        "first_screen": True,
        "views": views(document, live),
        "doubts": doubts(document),
        "most_doubts": _MAX_DOUBTS,
        "listed": listed_runs(every, points, traces),
        "scans": listed_scans(document) if not every else [],
        "most_rows": _MAX_ROWS,
        "live": live,
        "decided": document["review"]["entries"] if "review" in document else [],
        "review": script_json(document["review"]) if "review" in document else "",
        "said": grouped_findings(document["findings"]),
    }
    template = environment(folder).get_template("run.html.j2")

    def text(run: Json, place: int) -> str:
        points = store.trace("run", run["name"])
        trace: dict[str, str] | None = None
        if points is not None:
            key = Path(run["data_file"]).stem
            trace = {"json": Markup(points.coarse), "fine": Markup(points.fine), "key": key}
        return template.render(context, run=run, trace=trace, index=place)

    def details() -> Iterator[Detail]:
        numbered = enumerate(runs(), start=1)
        while group := list(itertools.islice(numbered, _RUNS_PER_PACK)):
            packed = deflated(_BETWEEN.join(text(run, place) for place, run in group).encode())
            for part, (place, run) in enumerate(group):
                yield Detail(run, place, part, "" if part else packed)

    return context | {"details": details}


def grouped_findings(findings: Sequence[Json]) -> list[Json]:
    """Return findings without repetition: those with one message in one entry, with all runs.

    Examples
    --------
    >>> one = {"severity": "note", "where": "hum", "message": "50 Hz"}
    >>> [row["runs"] for row in grouped_findings([one | {"run": "a"}, one | {"run": "b"}])]
    [['a', 'b']]
    """
    rows: dict[tuple[str, str, str], Json] = {}
    for finding in findings:
        where, message = finding["where"], finding["message"]
        # "surface A" and "surface B": group both under "surface", with the names in `parts`
        kind, _, name = where.partition(" ")
        part = name if kind in ("surface", "model") else ""
        key = finding["severity"], kind if part else where, message
        row = rows.setdefault(
            key, {"severity": key[0], "where": key[1], "message": message, "runs": [], "parts": []}
        )
        row["runs"] += [name for name in finding["run"].split("; ") if name]
        row["parts"] += [part] if part else []
    return list(rows.values())


def omitted_rows(runs: Sequence[Json]) -> list[Json]:
    """Return the time left out of the records: a row for each reason, the longest time first."""
    total = sum(run["duration_s"] or 0.0 for run in runs)
    rows: dict[str, Json] = {}
    for run in runs:
        for entry in run["omitted"]:
            row = rows.setdefault(
                entry["reason"],
                {"reason": entry["reason"], "runs": 0, "intervals": 0, "duration_s": 0.0},
            )
            row["runs"] += 1
            row["intervals"] += entry["intervals"]
            row["duration_s"] += entry["duration_s"] or 0.0
    for row in rows.values():
        row["share"] = row["duration_s"] / total if total else None
    return sorted(rows.values(), key=lambda row: -row["duration_s"])
