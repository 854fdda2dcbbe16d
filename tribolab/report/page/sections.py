"""Sections of the report page, in order.

To add one: write ``templates/sections/<name>.html.j2`` (the body only: heading and contents are
made from the entry below; the report is its context, and ``{% import "parts.html.j2" as part with
context %}`` imports helpers), put its data into the document under one key
(`tribolab.report.results.write_report` and `tribolab.report.document.schema.ReportHead`), and add
an entry here. A section with a `key` appears if the document has data under that key.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Section:
    """Section of the page.

    Parameters
    ----------
    id
        Anchor for links to ``#id``.
    title
        Heading, also in the contents.
    template
        Path of its template under ``templates/``.
    key
        Key under which the document must have data for this section; "" if always shown.
    """

    id: str
    title: str
    template: str
    key: str = ""


_SECTIONS = (
    Section("answer", "Result", "sections/answer.html.j2"),
    Section("curves", "Curves", "sections/curves.html.j2", "curves"),
    Section("uncertainty", "Uncertainty", "sections/uncertainty.html.j2", "curves"),
    Section("model", "Model", "sections/model.html.j2", "models"),
    Section("sliding", "Stick-slip", "sections/sliding.html.j2", "sliding_mode"),
    Section("surfaces", "Surfaces", "sections/surfaces.html.j2"),
    Section("contact", "Contact", "sections/contact.html.j2", "has_contact"),
    Section("findings", "Findings", "sections/findings.html.j2"),
    Section("methods", "Methods", "sections/methods.html.j2"),
    Section("provenance", "Provenance", "sections/provenance.html.j2"),
    Section("details", "Runs", "sections/details.html.j2", "runs"),
)


def shown_sections(document: Mapping[str, Any]) -> list[Section]:
    """Return the sections for which a report has data.

    Examples
    --------
    >>> [section.id for section in shown_sections({"runs": ["one"]})]
    ['answer', 'surfaces', 'findings', 'methods', 'provenance', 'details']
    """
    return [section for section in _SECTIONS if not section.key or document.get(section.key)]
