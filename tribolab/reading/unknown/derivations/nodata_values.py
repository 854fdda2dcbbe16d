"""No-data numbers in columns of heights, as stated in the header."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.reading.scans.stated_missing import take_stated
from tribolab.reading.text.cells import split_row
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn


def take_stated_missing(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[str]:
    """Replace no-data heights by NaN, and return their text."""
    stated = [
        (v.text, v.number) for v in numeric_settings(layout, bare=True) if v.number == v.number
    ]
    heights = [c.place - 1 for c in columns if c.used and c.quantity == "height"]
    taken = {number for place in heights for _, number, _ in take_stated(numbers[:, place], stated)}
    if not taken:
        return []
    cells = {
        row[place]
        for row in (split_row(line, layout.delimiter) for line in layout.rows())
        for place in heights
        if place < len(row)
    }
    return sorted(cell for cell in cells if _number(cell, layout.decimal) in taken)


def _number(cell: str, decimal: str) -> float | None:
    try:
        return float(cell.replace(decimal, "."))
    except ValueError:
        return None
