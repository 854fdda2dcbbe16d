"""The report as one HTML file that opens offline and asks nothing of the network.

What the page has is listed in `tribolab.report.page.sections`, which also says how to add a
section.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from tribolab.records.packed import deflated
from tribolab.records.traces import script_json
from tribolab.report.live.shown import ShownFigure
from tribolab.report.page.answer import cards, of_nothing
from tribolab.report.page.glossary import words_of
from tribolab.report.page.in_short import in_short
from tribolab.report.page.sections import shown_sections
from tribolab.report.page.templating import environment, framing, library
from tribolab.untyped import Json
from tribolab.words import force_text

if TYPE_CHECKING:
    from tribolab.campaign.store.catalogue import Catalogue

_MOST_ROWS = 100  # of the table of runs; more are packed, and laid out when they are asked for
RunDocuments = Callable[[], Iterable[Json]]


class Detail(NamedTuple):
    """What stands under one run: its place from 1, and all the rest compressed."""

    run: Json
    place: int
    packed: str


def write_page(
    document: Json,
    folder: Path,
    runs: RunDocuments,
    store: Catalogue,
    live: Sequence[ShownFigure] = (),
) -> Path:
    """Write ``report.html`` into the results folder, with what it shows inside it.

    The details of runs are compressed, and the page unpacks them when they are asked for. The
    page is written piece by piece: the details of one run at a time are in memory.

    Parameters
    ----------
    document
        From `tribolab.report.document.document.report_document`, with what is brief of the runs,
        and with ``review`` from `tribolab.report.page.reviewing.review_data` if the reader may
        decide on them.
    folder
        Results folder.
    runs
        Gives the runs as report.json has them.
    store
        It has the traces of the runs.
    live
        Figures that the page draws.
    """
    context = _context(document, folder, runs, store, live)
    template, frame = framing("report.html.j2", shown_sections(context), folder, draws=True)
    path = folder / "report.html"
    stream = template.stream(context | frame)
    stream.enable_buffering(256)
    stream.dump(str(path), encoding="utf-8")
    return path


def prepare_page() -> None:
    """Compile the templates, and compress the library: what a page takes before its numbers."""
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
) -> Json:
    surfaces = document.get("surfaces", [])
    every = document["runs"]
    first, rest = parted(grouped_runs(every), _MOST_ROWS)
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
        "cards": cards(document),
        "short": in_short(document),
        "unnamed": of_nothing(document),
        "live": live,
        "decided": document["review"]["entries"] if "review" in document else [],
        "review": script_json(document["review"]) if "review" in document else "",
        "groups": first,
        "more_groups": rest,
        "said": grouped_findings(document["findings"]),
    }
    template = environment(folder).get_template("run.html.j2")

    def details() -> Iterator[Detail]:
        for place, run in enumerate(runs(), start=1):
            points = store.trace("run", run["name"])
            trace: dict[str, str] | None = None
            if points is not None:
                key = Path(run["data_file"]).stem
                trace = {"json": Markup(points.coarse), "fine": Markup(points.fine), "key": key}
            text = template.render(context, run=run, trace=trace, index=place)
            yield Detail(run, place, deflated(text.encode()))

    return context | {"details": details}


class Group(NamedTuple):
    """Runs of one condition with their places on the page; with `head` its name stands above."""

    title: str
    total: int
    runs: list[tuple[int, Json]]
    head: bool


def grouped_runs(runs: Sequence[Json]) -> list[Group]:
    """Return the runs of each condition, under its name.

    Examples
    --------
    >>> run = {"surface": "Sb-R", "medium": "dry", "nominal_normal_force_N": 31.0}
    >>> [(one.title, [place for place, _ in one.runs]) for one in grouped_runs([run, run])]
    [('Sb-R, dry, 31 N', [1, 2])]
    """
    groups: dict[tuple[str, str, float | None], list[tuple[int, Json]]] = {}
    for place, run in enumerate(runs, start=1):
        key = run["surface"], run["medium"], run["nominal_normal_force_N"]
        groups.setdefault(key, []).append((place, run))
    named = []
    for (surface, medium, load), members in groups.items():
        words = [surface, medium, "" if load is None else force_text(load)]
        title = ", ".join(filter(None, words)) or "condition not named"
        named.append(Group(title, len(members), members, True))
    return named


def parted(groups: Sequence[Group], most: int) -> tuple[list[Group], list[Group]]:
    """Return groups up to so many runs, and what is left of them.

    Examples
    --------
    >>> first, rest = parted([Group("dry", 3, [(1, {}), (2, {}), (3, {})], True)], 2)
    >>> [len(one.runs) for one in first + rest], rest[0].head
    ([2, 1], False)
    """
    first: list[Group] = []
    rest: list[Group] = []
    for group in groups:
        room = max(most - sum(len(group.runs) for group in first), 0)
        if room:
            first.append(group._replace(runs=group.runs[:room]))
        if group.runs[room:]:
            rest.append(group._replace(runs=group.runs[room:], head=not room))
    return first, rest


def grouped_findings(findings: Sequence[Json]) -> list[Json]:
    """Return findings, those that say the same once for all runs that they hold for.

    Examples
    --------
    >>> one = {"severity": "note", "where": "hum", "message": "50 Hz"}
    >>> [row["runs"] for row in grouped_findings([one | {"run": "a"}, one | {"run": "b"}])]
    [['a', 'b']]
    """
    rows: dict[tuple[str, str, str], Json] = {}
    for finding in findings:
        where, message = finding["where"], finding["message"]
        # surfaces and models are named in the place: what is said of all of them is said once
        kind, _, name = where.partition(" ")
        part = name if kind in ("surface", "model") else ""
        key = finding["severity"], kind if part else where, message
        row = rows.setdefault(
            key,
            {"severity": key[0], "where": key[1], "message": message, "runs": [], "parts": []},
        )
        row["runs"] += [name for name in finding["run"].split("; ") if name]
        row["parts"] += [part] if part else []
    return list(rows.values())


def omitted_rows(runs: Sequence[Json]) -> list[Json]:
    """Return what was left out of all runs, a row per reason, the longest first."""
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
