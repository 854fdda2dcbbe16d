"""Web page with texts, figures and tables, in the layout common to all reports."""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.core.wording import aligned
from tribolab.report.document.document import versions
from tribolab.report.page.sections import Section
from tribolab.report.page.templating import data_address, framed

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_BODY = "across/section.html.j2"
_NARROW_MM = 120.0


@dataclass(frozen=True)
class Picture:
    """Figure on the page, with a text for those who cannot see it."""

    figure: Figure
    caption: str
    alt: str

    @property
    def wide(self) -> bool:
        """Whether the figure takes the full width of the page."""
        return bool(self.figure.get_size_inches()[0] * 25.4 > _NARROW_MM)

    @property
    def address(self) -> str:
        """Figure encoded as a data URL."""
        # imported late: matplotlib loads slowly
        from tribolab.figures.look.style import svg

        return data_address(svg(self.figure))


@dataclass(frozen=True)
class PageCell:
    """Cell of a table: its text, and the number by which it is sorted."""

    text: str
    value: float | None = None


@dataclass(frozen=True)
class Sheet:
    """Table on the page: title, file name without ending, column heads and rows."""

    label: str
    file: str
    heads: Sequence[str]
    rows: Sequence[Sequence[PageCell]]


@dataclass(frozen=True)
class Part:
    """Section of the page."""

    id: str
    title: str
    texts: Sequence[str] = ()
    figures: Sequence[Picture] = ()
    tables: Sequence[Sheet] = ()
    notes: Sequence[str] = ()


def cells(row: Iterable[object], digits: int = 3) -> list[PageCell]:
    """Return the cells of a row: numbers rounded to the given digits, texts unchanged.

    Examples
    --------
    >>> [cell.text for cell in cells(["dry", 0.51234, 4, float("nan")])]
    ['dry', '0.512', '4', '–']
    """
    made = []
    for value in row:
        if isinstance(value, bool) or not isinstance(value, int | float):
            made.append(PageCell(str(value)))
        elif isinstance(value, int):
            made.append(PageCell(str(value), value))
        else:
            known = math.isfinite(value)
            made.append(PageCell(aligned(value, digits), value if known else None))
    return made


def write_parts(
    path: Path, *, kind: str, heading: str, verdict: str, fine: bool, parts: Sequence[Part]
) -> None:
    """Write a self-contained HTML page of sections.

    Parameters
    ----------
    path
        The file.
    kind, heading, verdict
        Kind of page, its subject, and the result in one sentence.
    fine
        Whether no action is needed: the colour of the banner.
    parts
        Its sections.
    """
    context = {
        "kind": kind,
        "heading": heading,
        "verdict": {"status": "complete" if fine else "incomplete", "text": verdict},
        "made_at": dt.datetime.now(dt.UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "versions": versions(),
        "parts": {part.id: part for part in parts},
    }
    sections = [Section(part.id, part.title, _BODY) for part in parts]
    text = framed("across/page.html.j2", context, sections, path.parent)
    path.write_text(text, encoding="utf-8")
