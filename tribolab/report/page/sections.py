"""The sections of the report page, in the order in which it has them.

To add one: write ``templates/sections/<name>.html.j2`` (the body only: heading and place in the
contents are made from the entry below; the whole report is its context, the helpers come with
``{% import "parts.html.j2" as part with context %}``), put what it shows into the document under
one key (`tribolab.report.results.write_report` and
`tribolab.report.document.schema.ReportHead`), and add an entry here. A section with a `key`
appears once the document has something under that key.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Section:
    """A section of the page.

    Parameters
    ----------
    id
        Its address on the page: links to ``#id`` lead here.
    title
        Heading, and what the contents say.
    template
        Path of its template under ``templates/``.
    key
        Key of the document without which the section is left out; "" is always there.
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
    """Return the sections that have something to say about a report.

    Examples
    --------
    >>> [section.id for section in shown_sections({"runs": ["one"]})]
    ['answer', 'surfaces', 'findings', 'methods', 'provenance', 'details']
    """
    return [section for section in _SECTIONS if not section.key or document.get(section.key)]
