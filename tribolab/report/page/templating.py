"""What all pages share: template environment, scripts, styles, content security policy."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import quote

import jinja2
import jinja2.bccache
import numpy as np
from markupsafe import Markup

from tribolab.core import wording as words
from tribolab.core.coverage import NORMAL
from tribolab.core.provenance import escape_controls
from tribolab.core.untyped import Json
from tribolab.core.wording import aligned, force_text, number
from tribolab.friction.points.strokes import wider_error
from tribolab.records import judgement, wording
from tribolab.records.models.model_words import is_described, shear_stress_u95, stress_interval
from tribolab.records.packed import deflated
from tribolab.records.parts import Row, number_of
from tribolab.records.runs import trends
from tribolab.records.surfaces.hurst_words import hurst_verdict, is_steep
from tribolab.records.surfaces.roughness_words import form_in_words, roughness_u95
from tribolab.records.verdict import MEANINGS
from tribolab.report.document.document import state_of
from tribolab.report.page.glossary import HEADS, TERMS
from tribolab.report.page.in_words import budget_shares, conditions, oscillation_text
from tribolab.report.page.run_list import STATES
from tribolab.report.page.sections import Section
from tribolab.report.plain import plain_speed, plain_speeds, without_exponents

_PROLOGUE = re.compile(r"^.*?(?=<svg)", re.DOTALL)
# characters that need no escape in a data URL inside a quoted HTML attribute
_SAFE = " !$'()*+,-./:;=?@[]^_`{|}~"
_STYLES = ("report.css", "still.css", "review.css")
_SCRIPTS = (
    "first.js",
    "report.js",
    "view.js",
    "files.js",
    "table.js",
    "asked.js",
    "first_screen.js",
    "start.js",
)
_REVIEW = ("review.js", "review_marks.js", "review_panel.js", "review_bar.js")
_DRAWING = ("drawing.js", "picture.js", "touch.js", "chart.js", "charts.js", "trace.js", *_REVIEW)
_LIBRARY, _LICENCE = "plotly-basic.min.js", "plotly.LICENSE"


def framed(
    template: str, context: Mapping[str, Any], sections: Sequence[Section], folder: Path
) -> str:
    """Return the HTML of a page whose template extends ``frame.html.j2``.

    Parameters
    ----------
    template
        Path of the template under ``templates/``.
    context
        Data for the template and its sections; the frame uses ``versions`` and, for the colour of
        the banner, the ``status`` of the ``verdict``.
    sections
        Sections of the page, in order.
    folder
        Folder of the figures.
    """
    page, frame = framing(template, sections, folder, draws=False)
    return page.render(dict(context) | frame)


def framing(
    template: str, sections: Sequence[Section], folder: Path, *, draws: bool
) -> tuple[jinja2.Template, Json]:
    """Return the template of a page, and the variables that its frame needs.

    Parameters
    ----------
    template, sections, folder
        As for `framed`.
    draws
        Whether the page draws figures and needs the drawing library.

    Notes
    -----
    The browser accepts only scripts and styles with a listed checksum. These include the drawing
    library, and the empty style element that the library creates and then fills.
    """
    style = "".join(asset(name) for name in _STYLES)
    names = (*_SCRIPTS[:4], *_DRAWING, *_SCRIPTS[4:]) if draws else _SCRIPTS
    scripts = [asset(name) for name in names]
    started = [*scripts, asset(_LIBRARY)] if draws else scripts
    hashes = " ".join(f"'{csp_hash(script)}'" for script in started)
    styles = " ".join(f"'{csp_hash(text)}'" for text in ((style, "") if draws else (style,)))
    policy = (
        "default-src 'none'; img-src data: blob: 'self' file:; connect-src 'none'; "
        f"base-uri 'none'; form-action 'none'; style-src {styles}; "
        f"script-src {hashes}"
    )
    frame = {"style": style, "scripts": scripts, "sections": sections, "policy": policy}
    frame["library"] = library() if draws else ""
    frame["licence"] = asset(_LICENCE) if draws else ""
    return environment(folder).get_template(template), frame


@cache
def library() -> str:
    """Return the drawing library (plotly) as compressed text."""
    return deflated(asset(_LIBRARY).encode())


class _Compiled(jinja2.BytecodeCache):
    """Compiled templates, so that several pages in one process compile them only once."""

    def __init__(self) -> None:
        self._codes: dict[str, bytes] = {}

    def load_bytecode(self, bucket: jinja2.bccache.Bucket) -> None:
        if bucket.key in self._codes:
            bucket.bytecode_from_string(self._codes[bucket.key])

    def dump_bytecode(self, bucket: jinja2.bccache.Bucket) -> None:
        self._codes[bucket.key] = bucket.bytecode_to_string()


_COMPILED = _Compiled()


def _printed(value: object) -> object:
    """Escape control characters of a text; HTML markup remains markup."""
    if not isinstance(value, str):
        return value
    kind = Markup if isinstance(value, Markup) else str
    return kind(escape_controls(value))


def environment(folder: Path) -> jinja2.Environment:
    """Return the template environment of a page, with its filters; figures are in `folder`."""
    jinja = jinja2.Environment(
        loader=jinja2.PackageLoader("tribolab.report"),
        bytecode_cache=_COMPILED,
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=_printed,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    jinja.filters |= {
        "number": lambda value, digits=3: "–" if value is None else number(value, digits),
        "aligned": lambda value, digits=3: "–" if value is None else aligned(value, digits),
        "scaled": lambda value, factor, digits=3: (
            "–" if value is None else aligned(value * factor, digits)
        ),
        "speed": plain_speed,
        "plain": plain_speeds,
        "without_exponents": without_exponents,
        "force": lambda value: "–" if value is None else force_text(value),
        "duration": words.duration,
        "percent": words.percent,
        "many": words.many,
        "size": words.size,
        "breakable": breakable,
        "is_bad": judgement.is_bad,
        "status_word": judgement.status_word,
        "state_of": state_of,
        "check": judgement.check_words,
        "stem": lambda file: Path(file).stem,
        "deflated": lambda text: deflated(str(text).encode()),
        "numbers": lambda file: deflated((folder / file).read_bytes()),
        "figure": lambda file: data_address((folder / file).read_text(encoding="utf-8")),
    }
    jinja.tests["is_bad"] = judgement.is_bad
    jinja.globals |= {
        "with_error": wording.error_text,
        "span": words.span,
        "load_text": words.load_text,
        "judge": judgement.judge,
        "trend_texts": trends.trend_texts,
        "stress_interval": stress_interval,
        "shear_stress_u95": shear_stress_u95,
        "roughness_u95": roughness_u95,
        "NORMAL": NORMAL,
        "wider_error": _wider_error,
        "budget_shares": budget_shares,
        "conditions": conditions,
        "oscillating": oscillation_text,
        "is_described": is_described,
        "is_steep": is_steep,
        "form_in_words": form_in_words,
        "hurst_verdict": hurst_verdict,
        "HEADS": HEADS,
        "MEANINGS": MEANINGS,
        "STATES": STATES,
        "explained": explained,
        "UNITS": wording.UNITS,
        "SYMBOLS": wording.SYMBOLS,
    }
    return jinja


def _wider_error(row: Row, name: str, ending: str) -> float | None:
    """Return the larger of two errors of a segment: within its path, or beyond it (trend)."""

    def column(key: str) -> np.ndarray:
        return np.array(number_of(row, key), float)

    return wording.plain_value(float(wider_error(column, name, ending)))


def asset(name: str) -> str:
    """Return the text of a script, style or licence file of the page."""
    return (files("tribolab.report") / "assets" / name).read_text(encoding="utf-8")


def csp_hash(text: str) -> str:
    """Return the hash of inline code for a content security policy."""
    digest = hashlib.sha256(text.encode()).digest()
    return "sha256-" + base64.b64encode(digest).decode()


def data_address(svg: str) -> Markup:
    """Return an SVG figure as a data URL for an image.

    As an image it is isolated from the page: its ids cannot collide and its scripts cannot run.
    """
    body = _PROLOGUE.sub("", svg, count=1).replace('"', "'").replace("\n", " ")
    # safe in HTML, because quote() percent-encodes " & < >
    return Markup("data:image/svg+xml," + quote(body, safe=_SAFE))


_TERM = re.compile("|".join(map(re.escape, TERMS)), re.IGNORECASE)


def explained(text: str) -> list[tuple[str, str]]:
    """Split a sentence at glossary terms; return pieces, each with its explanation or "".

    Examples
    --------
    >>> [(words, bool(tip)) for words, tip in explained("no stick-slip, no stick-slip")]
    [('no ', False), ('stick-slip', True), (', no stick-slip', False)]
    """
    explained_terms: set[str] = set()
    pieces, end = [], 0
    for match in _TERM.finditer(text):
        if (term := match[0].lower()) in explained_terms:
            continue
        explained_terms.add(term)
        pieces += [(text[end : match.start()], ""), (match[0], TERMS[term])]
        end = match.end()
    return [*pieces, (text[end:], "")]


def breakable(name: str) -> Markup:
    """Return a name as HTML that may break into two lines after ``_`` or ``-``."""
    return Markup("<wbr>").join(re.findall(r"[^_-]+[_-]*|[_-]+", name))
