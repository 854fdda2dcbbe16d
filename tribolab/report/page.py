"""The report as one HTML file that opens offline and asks nothing of the network.

What the page has is listed in `tribolab.report.sections`, which also says how to add a section.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import quote

import jinja2
from markupsafe import Markup

from tribolab import words
from tribolab.report import judgement, wording
from tribolab.report.model_words import stress_interval
from tribolab.report.packed import deflated
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
_FIGURES_BYTES = 5e6  # of the runs' own figures that are put inside the page


@dataclass(frozen=True)
class PageTrace:
    """A run's trace for the page.

    Parameters
    ----------
    key
        What the run's own files are called.
    json
        From `tribolab.report.traces.trace`.
    fine
        From `tribolab.report.traces.finer_trace`; "" if there is none.
    """

    key: str
    json: Markup
    fine: Markup = Markup("")


def write_page(
    document: dict[str, Any], folder: Path, traces: Mapping[str, PageTrace] | None = None
) -> Path:
    """Write ``report.html`` into the results folder, with what it shows inside it.

    Of very many runs the details are compressed, and the page unpacks them when they are asked for.
    """
    path = folder / "report.html"
    path.write_text(render(document, folder, traces), encoding="utf-8")
    return path


def render(
    document: dict[str, Any], folder: Path, traces: Mapping[str, PageTrace] | None = None
) -> str:
    """Return the page of a report.

    Parameters
    ----------
    document
        From `tribolab.report.document.report_document`.
    folder
        Results folder, in which the figures lie.
    traces
        Of the runs, by name; those without have a picture in its place.

    Returns
    -------
    str
        HTML. Text from files is escaped, and a content security policy forbids every script but
        the page's own, wherever it lies, and every request.
    """
    surfaces = document.get("surfaces", [])
    context = document | {
        "traces": traces or {},
        "embed_runs": _bytes_of_figures(document["runs"], folder) <= _FIGURES_BYTES,
        "has_contact": any(surface["contact"] or surface["adhesion"] for surface in surfaces),
        "left_out": left_out(document["runs"]),
        "places": {run["name"]: place + 1 for place, run in enumerate(document["runs"])},
    }
    context["packed"] = _packed_details(_environment(folder), context)
    return framed("report.html.j2", context, shown_sections(context), folder)


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
    style = "".join(asset(name) for name in _STYLES)
    scripts = [_script(name) for name in _SCRIPTS]
    hashes = " ".join(f"'{fingerprint(script)}'" for script in scripts)
    page = _environment(folder).get_template(template)
    return page.render(
        context,
        style=style,
        scripts=scripts,
        sections=sections,
        policy=(
            "default-src 'none'; img-src data: 'self' file:; connect-src 'none'; base-uri 'none'; "
            f"form-action 'none'; style-src '{fingerprint(style)}'; script-src {hashes}"
        ),
    )


def _script(name: str) -> str:
    """Return one of the page's scripts, what is not ours with its licence."""
    notice = f"/*\n{asset(_LICENCES[name])}*/\n" if name in _LICENCES else ""
    return notice + asset(name)


def _bytes_of_figures(runs: Sequence[dict[str, Any]], folder: Path) -> int:
    named = [folder / figure["file"] for run in runs for figure in run["figures"]]
    return sum(path.stat().st_size for path in named if not path.stem.endswith("_trace"))


def _packed_details(environment: jinja2.Environment, context: dict[str, Any]) -> dict[str, str]:
    """Return the details of very many runs, compressed, by the runs' names."""
    if len(context["runs"]) <= _MOST_OPEN:
        return {}
    template = environment.get_template("run.html.j2")
    return {
        run["name"]: deflated(template.render(context, run=run, index=index).encode())
        for index, run in enumerate(context["runs"], start=1)
    }


def _environment(folder: Path) -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("tribolab.report"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
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
    environment.globals |= {
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
    return environment


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


def left_out(runs: list[dict[str, Any]]) -> list[dict[str, Any]]:
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
