"""Unknown workbooks: the sheet of the table, and the row of its names."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from pathlib import Path

from tribolab.core.errors import ReadError, shown
from tribolab.reading.raw.containers.workbook import sheets_of
from tribolab.reading.unknown.layout.container_column import ROWS
from tribolab.reading.unknown.layout.text_layout import Held

_ABOVE = 40  # rows of a sheet above its names
_MOMENTS = (dt.datetime, dt.time, dt.timedelta)


def main_sheet(path: Path) -> Held:
    """Return the position of the sheet with the most rows of numbers below names.

    Raises
    ------
    ReadError
        If no sheet has such rows.
    """
    tables: list[tuple[int, Held, set[str]]] = []
    for sheet, rows in sheets_of(path, ROWS).items():
        place = _names_row(rows)
        if place is not None:
            held = Held("excel", sheet, place + 1, not _is_numeric(rows[place + 1]))
            tables.append((len(rows) - place, held, {str(c) for c in rows[place] if c != ""}))
    if not tables:
        raise ReadError("no sheet holds numbers below names", where=path)
    _, held, names = max(tables, key=lambda table: table[0])
    alike = [t[1].sheet for t in tables if t[1] is not held and len(t[2] & names) > 1]
    return held._replace(others=", ".join(f"'{shown(sheet, 30)}'" for sheet in alike[:4]))


def _names_row(rows: Sequence[Sequence[object]]) -> int | None:
    """Return the first row of words with numbers below it, or below a row of units."""
    for index in range(min(len(rows) - 2, _ABOVE)):
        words = [cell for cell in rows[index] if isinstance(cell, str) and cell.strip()]
        if len(words) < 2 or _is_numeric(rows[index]):
            continue
        if _is_numeric(rows[index + 1]):
            return index
        units = sum(1 for cell in rows[index + 1] if isinstance(cell, str) and cell.strip())
        if 2 * units >= len(words) and _is_numeric(rows[index + 2]):
            return index
    return None


def _is_numeric(row: Sequence[object]) -> bool:
    filled = [cell for cell in row if cell not in ("", None)]
    numbers = sum(map(_is_number, filled))
    return numbers >= 2 and 2 * numbers >= len(filled)


def _is_number(cell: object) -> bool:
    """Whether a cell is a number, a moment, or a number that was typed as text."""
    if isinstance(cell, str):
        try:
            float(cell.strip().replace(",", "."))
        except ValueError:
            return False
        return True
    return isinstance(cell, (int, float, *_MOMENTS)) and not isinstance(cell, bool)
