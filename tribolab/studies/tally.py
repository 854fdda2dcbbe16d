"""Number of published numbers with each status, as data and as text."""

from __future__ import annotations

import pandas as pd

from tribolab.core.wording import many
from tribolab.studies.verdict import (
    BY_CONSTRUCTION,
    DIFFERS,
    INCONSISTENT,
    MEASURED,
    REPRODUCED,
    WIDE,
    room_text,
)

# wording of each status, for one number and for several
_WORDS = {
    REPRODUCED: ("reproduced", "reproduced"),
    BY_CONSTRUCTION: ("by construction", "by construction"),
    WIDE: ("within a wide tolerance", "within a wide tolerance"),
    DIFFERS: ("differs", "differ"),
    INCONSISTENT: ("inconsistent as printed", "inconsistent as printed"),
    MEASURED: (
        "measured by the authors and not computed",
        "measured by the authors and not computed",
    ),
}
STUDY_STATUSES = tuple(_WORDS)


def count_statuses(table: pd.DataFrame) -> dict[str, int]:
    """Return the number of published numbers with each status, in the order of the text.

    Parameters
    ----------
    table
        From `tribolab.studies.comparison.compare_with_paper`.
    """
    return {status: int((table["status"] == status).sum()) for status in STUDY_STATUSES}


def tell_statuses(table: pd.DataFrame) -> str:
    """Return a text with the number of published numbers by status, and the wide tolerances.

    Parameters
    ----------
    table
        ``status`` and ``tolerance`` of each number, as in ``paper.csv``.

    Examples
    --------
    >>> status = ["reproduced", "within a wide tolerance", "differs"]
    >>> tell_statuses(pd.DataFrame({"status": status, "tolerance": [0.01, 0.25, 0.1]}))
    '3 published numbers: 1 reproduced, 1 within a wide tolerance (25 %), 1 differs'
    """
    texts = []
    for status, count in count_statuses(table).items():
        if count:
            words = f"{count} {_WORDS[status][count > 1]}"
            texts.append(f"{words} ({_rooms(table)})" if status == WIDE else words)
    return f"{many(len(table), 'published number')}: {', '.join(texts)}"


def _rooms(table: pd.DataFrame) -> str:
    wide = table.loc[table["status"] == WIDE, "tolerance"].astype(float)
    return ", ".join(room_text(room) for room in sorted(set(wide)))
