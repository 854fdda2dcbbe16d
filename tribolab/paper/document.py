"""What the page says: the published numbers at their places, and how many of them hold."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import pandas as pd

from tribolab.errors import AnalysisError
from tribolab.paper.figures import BY_NAME, FIGURES
from tribolab.paper.laboratory import Laboratory
from tribolab.records.frames import rows_of
from tribolab.records.wording import plain_value
from tribolab.report.document import versions
from tribolab.report.sections import Section
from tribolab.studies import xu2026
from tribolab.studies.published import Published
from tribolab.studies.verdict import BOUNDS, DIFFERS, INCONSISTENT, MEASURED, REPRODUCED
from tribolab.words import many

SCHEMA_VERSION = "1.0"
# A status in words that follow a number, and how the page marks it.
STATUSES = {
    REPRODUCED: ("reproduced", "good"),
    DIFFERS: ("differ", "bad"),
    INCONSISTENT: ("inconsistent as printed", "warn"),
    MEASURED: ("measured by the authors and not computed", "none"),
}
_BODY = "paper/section.html.j2"
# Key, heading, and which words of "where a number is printed" mean it.
PARTS = (
    ("theory", "2 Theory of mixed lubrication", ("Sec. 2",)),
    ("setup", "3 Experiment", ("Sec. 3",)),
    ("topography", "4 Surface topography and contact area", ("Sec. 4",)),
    ("adhesion", "5 Adhesion", ("Sec. 5", "Eq. 13", "Eq. 14")),
    ("dry", "6 Dry friction and shear stress", ("Sec. 6",)),
    ("stribeck", "7 Stribeck curves", ("Sec. 7",)),
    ("discussion", "8 Discussion", ("Sec. 8",)),
    ("factors", "Appendix A: flow and friction factors", ("App. A",)),
    ("profiles", "Appendix B: profiles across the contact", ("App. B",)),
    ("bars", "Appendix C: friction with error bars", ("App. C",)),
)
_ABOUT = {
    "theory": "The equations are computed in full: where the paper sketches p(u) by one "
    "exponential, Eq. (8), the integral behind it is taken. The drawing of the contact is left "
    "out.",
    "setup": "Forces and lengths are the paper's. Its measurements are not public: the virtual "
    "rig stands in for the laboratory, with the noise, clocks and loggers of a real one, and its "
    "raw files go through the same analysis as any.",
    "dry": "The drawing of bonds in the contact is left out.",
    "discussion": "The drawing of a Schallamach wave is left out.",
}
_SOURCE = ("file", "sha256", "bytes")


def shown_sections() -> list[Section]:
    """Return the sections of the page: the summary, the paper's, and where it comes from."""
    return [
        Section("summary", "Summary", "paper/summary.html.j2"),
        Section("numbers", "All published numbers", "paper/numbers.html.j2"),
        *(Section(key, title, _BODY) for key, title, _ in PARTS),
        Section("provenance", "Where it comes from", "paper/provenance.html.j2"),
    ]


def paper_document(
    table: pd.DataFrame,
    figures: Sequence[dict[str, Any]],
    fits: pd.DataFrame,
    laboratory: Laboratory,
    sources: Sequence[tuple[str, str, int]],
) -> dict[str, Any]:
    """Return all that the page says as plain data: ``paper.json``.

    Parameters
    ----------
    table
        From `tribolab.studies.comparison.compare_with_paper`.
    figures
        Records of the figures.
    fits
        Shear stresses fitted to the simulated curves.
    laboratory
        What was simulated.
    sources
        Raw files of the simulation with checksum and size.
    """
    rows = [_row(record, known) for record, known in _paired(table)]
    counts = {status: sum(row["status"] == status for row in rows) for status in STATUSES}
    return plain_value(
        {
            "schema_version": SCHEMA_VERSION,
            "made_at": dt.datetime.now(dt.UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "paper": xu2026.CITATION,
            "verdict": {
                "status": "complete" if not counts[DIFFERS] else "incomplete",
                "text": _in_words(counts),
                "counts": counts,
            },
            "numbers": rows,
            "figures": list(figures),
            "shear_stress": rows_of(fits),
            "laboratory": asdict(laboratory),
            "sources": [
                dict(zip(("file", "sha256", "bytes"), source, strict=True)) for source in sources
            ],
            "versions": versions(),
        }
    )


def context_of(document: dict[str, Any]) -> dict[str, Any]:
    """Return the document with what its page wants besides."""
    rows = document["numbers"]
    return document | {
        "parts": {
            key: {
                "about": _ABOUT.get(key, ""),
                "figures": [figure for figure in document["figures"] if figure["section"] == key],
                "rows": [row for row in rows if row["section"] == key and not row["figure"]],
            }
            for key, _, _ in PARTS
        },
        "marks": {status: mark for status, (_, mark) in STATUSES.items()},
    }


def _in_words(counts: dict[str, int]) -> str:
    total = many(sum(counts.values()), "published number")
    said = (f"{count} {STATUSES[status][0]}" for status, count in counts.items() if count)
    return f"{total}: {', '.join(said)}".replace(" 1 differ,", " 1 differs,")


def _paired(table: pd.DataFrame) -> list[tuple[dict[str, Any], Published]]:
    """Put every row beside the published number that it is about, of which the order is known."""
    pairs = list(zip(rows_of(table), xu2026.published, strict=True))
    for record, known in pairs:
        if (record["quantity"], record["condition"]) != (known.quantity, known.condition):
            raise AnalysisError(f"the table of numbers is not in the paper's order: {record}")
    return pairs


def _row(record: dict[str, Any], known: Published) -> dict[str, Any]:
    figure = next((one for one in FIGURES if one.has(record)), None)
    section = BY_NAME[figure.name].section if figure else _section(known.where)
    note = str(record["note"])
    return record | {
        "note": note and note[0].upper() + note[1:].rstrip(".") + ".",
        "difference": _difference(record, known),
        "where": known.where,
        "kind": known.kind,
        "section": section,
        "figure": figure.name if figure else "",
    }


def _difference(record: dict[str, Any], known: Published) -> str:
    """Say how a number differs that has no relative difference; "" if it has one or is unknown."""
    if known.relation.startswith(BOUNDS) and record["computed"]:
        if record["status"] == REPRODUCED:
            return "within the bound"
        return "below the bound" if known.relation == ">" else "above the bound"
    if record["status"] == INCONSISTENT and not record["computed"]:
        return "inconsistent with other printed numbers"
    return ""


def _section(where: str) -> str:
    for key, _, words in PARTS:
        if where.startswith(words):
            return key
    raise AnalysisError(f"no section of the page has what the paper prints in {where}")
