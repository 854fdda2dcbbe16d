"""Loads of several cells that add up according to a person."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.model import DraftColumn, Reason


def loads_that_add(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the columns of loads that add up, as written in a formula."""
    return [
        c._replace(unit=unit if say else None)
        for c in columns
        if not c.used and c.reason is Reason.ADDS
        for _, unit, say in [bare_name(c)]
    ]
