"""The report as one HTML file that opens offline and asks nothing of the network.

What the page has is listed in `tribolab.report.sections`, which also says how to add a section.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple, Protocol
from urllib.parse import quote

import jinja2
from markupsafe import Markup

from tribolab import words
from tribolab.records import judgement, wording
from tribolab.records.model_words import stress_interval
from tribolab.records.packed import deflated
from tribolab.records.parts import PageTrace
from tribolab.report.sections import Section, shown_sections
from tribolab.report.sliding_figures import traces_stems
from tribolab.words import aligned, force_text, number, speed_text

_PROLOGUE = re.compile(r"^.*?(?=<svg)", re.DOTALL)
# Everything that may stand in a data address inside a quoted HTML attribute.
_SAFE = " !$'()*+,-./:;=?@[]^_`{|}~"
_STYLES = ("uplot.min.css", "report.css")
_SCRIPTS = ("uplot.min.js", "report.js", "files.js", "table.js", "drawing.js", "chart.js")
_LICENCES = {"uplot.min.js": "uplot.LICENSE"}
_MOST_OPEN = 300  # runs whose details are not compressed; with more the page would open slowly


Runs = Callable[[], Iterable[dict[str, Any]]]


class Detail(NamedTuple):
    """What stands under one run: all of it, its trace, its place from 1, or all that compressed."""

    run: dict[str, Any]
    trace: dict[str, str] | None
    place: int
    packed: str


def write_page(document: Mapping[str, Any], folder: Path, runs: Runs, store: Traces) -> Path:
    """Write ``report.html`` into the results folder, with what it shows inside it.

    Of very many runs the details are compressed, and the page unpacks them when they are asked
    for. The page is written piece by piece: the details of one run at a time are in memory.

    Parameters
    ----------
    document
        From `tribolab.report.document.report_document`, with what is brief of the runs.
    folder
        Results folder, in which the figures lie.
    runs
        Gives the runs as report.json has them.
    store
        It has the traces of the runs.
    """
    context = _context(document, folder, runs, store)
    template, frame = _framing("report.html.j2", context, shown_sections(context), folder)
    path = folder / "report.html"
    stream = template.stream(context | frame)
    stream.enable_buffering(256)
    stream.dump(str(path), encoding="utf-8")
    return path


class Traces(Protocol):
    """What knows the traces of runs."""

    def trace(self, kind: str, name: str) -> PageTrace | None:
        """Return the trace of a part."""


def _context(
    document: Mapping[str, Any], folder: Path, runs: Runs, store: Traces
) -> dict[str, Any]:
    surfaces = document.get("surfaces", [])
    context = dict(document) | {
        "has_contact": any(surface["contact"] or surface["adhesion"] for surface in surfaces),
        "left_out": left_out(document["runs"]),
        "places": {run["name"]: place + 1 for place, run in enumerate(document["runs"])},
    }
    many = len(document["runs"]) > _MOST_OPEN
    template = environment(folder).get_template("run.html.j2")

    def details() -> Iterator[Detail]:
        for place, run in enumerate(runs(), start=1):
            points = store.trace("run", run["name"])
            trace: dict[str, str] | None = None
            if points is not None:
                key = Path(run["data_file"]).stem
                trace = {"json": Markup(points.coarse), "fine": Markup(points.fine), "key": key}
            packed = ""
            if many:
                text = template.render(context, run=run, trace=trace, index=place)
                packed = deflated(text.encode())
            yield Detail(run, trace, place, packed)

    return context | {"details": details}


def framed(
    template: str, context: Mapping[str, Any], sections: Sequence[Section], folder: Path
) -> str:
    """Return a page made from a template that extends ``frame.html.j2``.

    Parameters
    ----------
    template
        Its path under ``templates/``.
    context
        What the template and its sections show; of it the frame itself takes ``versions`` and the
        ``status`` of the ``verdict``, the banner's colour.
    sections
        What the page has, in order.
    folder
        Folder in which the figures lie.
    """
    page, frame = _framing(template, context, sections, folder)
    return page.render(dict(context) | frame)


def _framing(
    template: str, context: Mapping[str, Any], sections: Sequence[Section], folder: Path
) -> tuple[jinja2.Template, dict[str, Any]]:
    """Return a template, and what the frame of a page wants to know."""
    style = "".join(asset(name) for name in _STYLES)
    scripts = [_script(name) for name in _SCRIPTS]
    hashes = " ".join(f"'{fingerprint(script)}'" for script in scripts)
    policy = (
        "default-src 'none'; img-src data: 'self' file:; connect-src 'none'; base-uri 'none'; "
        f"form-action 'none'; style-src '{fingerprint(style)}'; script-src {hashes}"
    )
    frame = {"style": style, "scripts": scripts, "sections": sections, "policy": policy}
    return environment(folder).get_template(template), frame


def _script(name: str) -> str:
    """Return one of the page's scripts, what is not ours with its licence."""
    notice = f"/*\n{asset(_LICENCES[name])}*/\n" if name in _LICENCES else ""
    return notice + asset(name)


def environment(folder: Path) -> jinja2.Environment:
    """Return what fills the templates of pages whose figures lie in a folder."""
    jinja = jinja2.Environment(
        loader=jinja2.PackageLoader("tribolab.report"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    jinja.filters |= {
        "number": lambda value, digits=3: "–" if value is None else number(value, digits),
        "aligned": lambda value, digits=3: "–" if value is None else aligned(value, digits),
        "scaled": lambda value, factor, digits=3: (
            "–" if value is None else aligned(value * factor, digits)
        ),
        "speed": lambda value: speed_text(float("nan") if value is None else value),
        "force": lambda value: "–" if value is None else force_text(value),
        "duration": words.duration,
        "percent": words.percent,
        "many": words.many,
        "size": words.size,
        "breakable": breakable,
        "is_bad": judgement.is_bad,
        "status_word": judgement.status_word,
        "why": judgement.why,
        "stem": lambda file: Path(file).stem,
        "numbers": lambda file: deflated((folder / file).read_bytes()),
        "figure": lambda file: data_address((folder / file).read_text(encoding="utf-8")),
    }
    jinja.globals |= {
        "with_error": wording.with_error,
        "span": words.span,
        "speeds": words.speeds,
        "judge": judgement.judge,
        "trend_texts": judgement.trend_texts,
        "traces_stems": traces_stems,
        "stress_interval": stress_interval,
        "note_of": note_of,
        "UNITS": wording.UNITS,
        "SYMBOLS": wording.SYMBOLS,
    }
    return jinja


def asset(name: str) -> str:
    """Return the text of one of the page's own files."""
    return (files("tribolab.report") / "assets" / name).read_text(encoding="utf-8")


def fingerprint(text: str) -> str:
    """Return what a content security policy calls a piece of inline code."""
    digest = hashlib.sha256(text.encode()).digest()
    return "sha256-" + base64.b64encode(digest).decode()


def data_address(svg: str) -> Markup:
    """Return a figure as an address that holds the figure itself.

    As an image it is shut off from the page: its ids meet no others, and nothing in it can run.
    """
    body = _PROLOGUE.sub("", svg, count=1).replace('"', "'").replace("\n", " ")
    # what HTML would have to escape in a quoted attribute (" & < >) is escaped already
    return Markup("data:image/svg+xml," + quote(body, safe=_SAFE))


def note_of(captions: Iterable[str]) -> str:
    """Return what stands once below figures of one kind: their captions without the titles.

    Where they differ, the longest explains all that is drawn in any of them.

    Examples
    --------
    >>> note_of(["31 N: no line. Points: measured.", "91 N. Points: measured; line: model."])
    'Points: measured; line: model.'
    """
    return max((caption.split(". ", 1)[1] for caption in captions), key=len)


def breakable(name: str) -> Markup:
    """Return a name that a narrow column may break after ``_`` or ``-``, else as it is."""
    return Markup("<wbr>").join(re.findall(r"[^_-]+[_-]*|[_-]+", name))


def left_out(runs: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return what was left out of all runs, a row per reason, the longest first."""
    total = sum(run["duration_s"] or 0.0 for run in runs)
    rows: dict[str, dict[str, Any]] = {}
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
