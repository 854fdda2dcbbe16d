"""Content of the web page: published numbers by section, with their status."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from dataclasses import asdict
from typing import NamedTuple

import pandas as pd

from tribolab.core.errors import AnalysisError
from tribolab.core.untyped import Json
from tribolab.paper.figures import BY_NAME, FIGURES
from tribolab.paper.hurst import steep_spectra
from tribolab.paper.laboratory import Laboratory
from tribolab.records.frames import rows_of
from tribolab.records.wording import plain_value
from tribolab.report.document.document import versions
from tribolab.report.page.sections import Section
from tribolab.studies import xu2026
from tribolab.studies.published import Published
from tribolab.studies.tally import STUDY_STATUSES, count_statuses, tell_statuses
from tribolab.studies.verdict import (
    BOUNDS,
    BY_CONSTRUCTION,
    DIFFERS,
    INCONSISTENT,
    MEASURED,
    REPRODUCED,
    WIDE,
    room_text,
)

_SCHEMA_VERSION = "1.1"


class StatusMark(NamedTuple):
    """How the page shows a status: look (colour), sign, word and meaning."""

    look: str
    sign: str
    word: str
    meaning: str


_MARKS = {
    REPRODUCED: StatusMark(
        "good",
        "✓",
        "reproduced",
        "computed from other numbers than itself, and it agrees within 1 % or its last digit",
    ),
    BY_CONSTRUCTION: StatusMark(
        "none",
        "=",
        "by construction",
        "it was put in, an input was chosen for it, or it follows from such numbers alone: its "
        "agreement tests nothing",
    ),
    WIDE: StatusMark("none", "≈", "wide tolerance", "it agrees only with more room than that"),
    DIFFERS: StatusMark("bad", "✕", "differs", "the computed number is another one"),
    INCONSISTENT: StatusMark(
        "warn",
        "▲",
        "inconsistent",
        "the paper's own numbers exclude what is printed, or it is a power of ten or the "
        "reciprocal of the computed one",
    ),
    MEASURED: StatusMark(
        "none", "·", "measured", "from the authors' own measurements, quoted and not computed"
    ),
}
_BODY = "paper/section.html.j2"
# key and heading of a section of the page, and the sections of the paper whose numbers it shows
_PARTS = (
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
    "theory": "The equations are computed in full: where the paper sketches the "
    "contact pressure over the separation, p(u), by one exponential, Eq. (8), the integral behind "
    "it is taken. The drawing of the contact is left "
    "out.",
    "setup": "Forces and lengths are the paper's. Its measurements are not public: the virtual "
    "rig replaces the laboratory, with the noise, clocks and loggers of a real one, and its "
    "raw files go through the same analysis as any.",
    "dry": "The drawing of bonds in the contact is left out.",
    "discussion": "The drawing of a Schallamach wave is left out.",
}
# words added to names of quantities that are ambiguous on their own
_WORDS = {
    "hertz_contact_width": "2a of a smooth cylinder",
    "contact_area_ratio": "real over nominal area, A/A₀",
    "macroscopic_work_of_adhesion": "at magnification 1; above 0 it takes a force to pull off",
    "area_enhancement": "growth of the contact area by adhesion",
    "viscoelastic_friction": "losses in the rubber",
    "corrected_shear_stress": "in the contact area with adhesion",
    "corrected_shear_stress_ratio": "in the contact areas with adhesion",
    "boundary_onset_speed": "below it solids carry nearly all friction",
    "percolation_separation": "below it no channel lets liquid through",
    "separation_decay_alpha": "how fast contact pressure falls with separation",
    "dry_over_glycerol_area": "less 1",
}


def paper_sections() -> list[Section]:
    """Return the sections of the page: summary, those of the paper, and sources."""
    return [
        Section("summary", "Summary", "paper/summary.html.j2"),
        Section("numbers", "All published numbers", "paper/numbers.html.j2"),
        *(Section(key, title, _BODY) for key, title, _ in _PARTS),
        Section("provenance", "Where it comes from", "paper/provenance.html.j2"),
    ]


def paper_document(
    table: pd.DataFrame,
    figures: Sequence[Json],
    fits: pd.DataFrame,
    laboratory: Laboratory,
    sources: Sequence[tuple[str, str, int]],
) -> Json:
    """Return the content of the page as plain data, as in ``paper.json``.

    Parameters
    ----------
    table
        From `tribolab.studies.comparison.compare_with_paper`.
    figures
        Records of the figures.
    fits
        Shear stresses fitted to the simulated curves.
    laboratory
        Simulated measurement.
    sources
        Raw files of the simulation with checksum and size.
    """
    rows = [_row(record, known) for record, known in _pair_rows(table)]
    counts = count_statuses(table)
    return plain_value(
        {
            "schema_version": _SCHEMA_VERSION,
            "made_at": dt.datetime.now(dt.UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "paper": xu2026.CITATION,
            "verdict": {
                "status": "complete" if not counts[DIFFERS] else "incomplete",
                "text": tell_statuses(table),
                "counts": counts,
            },
            "numbers": rows,
            "figures": list(figures),
            "shear_stress": rows_of(fits),
            "steep_spectra": steep_spectra(),
            "laboratory": asdict(laboratory),
            "sources": [
                dict(zip(("file", "sha256", "bytes"), source, strict=True)) for source in sources
            ],
            "versions": versions(),
        }
    )


def context_of(document: Json) -> Json:
    """Return the document with further entries that the templates of the page need."""
    rows = document["numbers"]
    return document | {
        "parts": {
            key: {
                "about": _ABOUT.get(key, ""),
                "figures": [figure for figure in document["figures"] if figure["section"] == key],
                "rows": [row for row in rows if row["section"] == key and not row["figure"]],
            }
            for key, _, _ in _PARTS
        },
        "marks": {status: _MARKS[status]._asdict() for status in STUDY_STATUSES},
    }


def _pair_rows(table: pd.DataFrame) -> list[tuple[Json, Published]]:
    """Return each row of the table with its published number, after a check of their order."""
    pairs = list(zip(rows_of(table), xu2026.published, strict=True))
    for record, known in pairs:
        if (record["quantity"], record["condition"]) != (known.quantity, known.condition):
            raise AnalysisError(f"the table of numbers is not in the paper's order: {record}")
    return pairs


def _row(record: Json, known: Published) -> Json:
    figure = next((known_figure for known_figure in FIGURES if known_figure.has(record)), None)
    section = BY_NAME[figure.name].section if figure else _section(known.where)
    note = str(record["note"])
    return record | {
        "note": note and note[0].upper() + note[1:].rstrip(".") + ".",
        "words": _WORDS.get(known.quantity, ""),
        "difference": _difference(record, known),
        "where": known.where,
        "kind": known.kind,
        "section": section,
        "figure": figure.name if figure else "",
    }


def _difference(record: Json, known: Published) -> str:
    """Return the difference as text for numbers without a relative one; "" for all others."""
    if known.relation.startswith(BOUNDS) and record["computed"]:
        if record["status"] in (REPRODUCED, BY_CONSTRUCTION):
            return "within the bound"
        if record["status"] == WIDE:
            return f"within the bound, or above it by {room_text(record['tolerance'])}"
        return "below the bound" if known.relation == ">" else "above the bound"
    if record["status"] == INCONSISTENT and not record["computed"]:
        return "inconsistent with other printed numbers"
    return ""


def _section(where: str) -> str:
    for key, _, words in _PARTS:
        if where.startswith(words):
            return key
    raise AnalysisError(f"no section of the page has what the paper prints in {where}")
