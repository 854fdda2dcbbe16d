"""Names and units of the columns of an unknown table, from its header."""

from __future__ import annotations

from tribolab.reading.interpret.names import COUNTS, is_count, matches, split_unit
from tribolab.reading.text.cells import split_name
from tribolab.reading.unit_texts import is_unit, measures_something
from tribolab.reading.unknown.columns.unit_and_sign import Bare
from tribolab.reading.unknown.layout.lvm import units_above
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_PURE = ("1", "-", ".")  # signs for the unit of a pure number


def labelled(layout: Layout) -> list[DraftColumn]:
    """Columns with their names and units from the header."""
    heading = layout.heading
    cells = list(heading.cells if heading else ())[: layout.width]
    cells += [""] * (layout.width - len(cells))
    units_row = list(heading.unit_cells if heading else ()) + [""] * layout.width
    above = units_above(layout)
    columns: list[DraftColumn] = []
    seen: dict[str, int] = {}
    for place, cell in enumerate(cells, start=1):
        in_row = heading is not None and heading.units is not None
        name, unit, spelt = _of_rows(cell, units_row[place - 1]) if in_row else _of_cell(cell)
        counted = unit is not None and is_count(unit)
        unit = None if counted else unit
        seen[name] = seen.get(name, 0) + 1
        known = name if name and heading and heading.aligned else None
        columns.append(
            DraftColumn(
                place,
                cell,
                known,
                seen[name] if known else 1,
                file_unit=None if spelt else unit,
                unit=above.get(place) if unit is None else spelt or None,
                counted=counted,
            )
        )
    return columns


def _of_cell(cell: str) -> tuple[str, str | None, str]:
    """Return name and unit of a cell such as "POSITION (MM)", and the unit as it has to be read."""
    name, unit = split_name(cell)
    spelt = ""
    if unit == "A" and matches(name, unit, scan=True):
        unit = spelt = "angstrom"  # of heights, as profilometers write it
    spelt = spelt or _in_small_letters(unit)
    unit = spelt or unit
    if unit in _PURE or not (unit is None or measures_something(unit) or is_count(unit)):
        return name, None, spelt  # brackets around something else
    return name, unit, spelt


def _of_rows(name: str, unit_cell: str) -> tuple[str, str | None, str]:
    """Return name and unit if a row of its own states units, and how the unit has to be read."""
    unit = unit_cell.strip("[]() ") or None
    spelt = _in_small_letters(unit)
    return name, None if unit in _PURE else spelt or unit, spelt


def _in_small_letters(unit: str | None) -> str:
    """Return a unit of capitals as it is usually written: MM as mm; "" if it needs no change."""
    capitals = unit is not None and unit.isupper() and not is_unit(unit)
    return unit.lower() if unit and capitals and is_unit(unit.lower()) else ""


def bare_name(column: DraftColumn) -> Bare:
    """Name without its unit, the unit, and whether the dialect must state it."""
    name = split_name(column.label)[0] if column.name is None else column.name
    if column.unit is not None:
        return name, column.unit, True
    if column.file_unit is not None:
        return name, column.file_unit, column.name is None
    if column.counted:
        return name, COUNTS, False
    if split_name(column.label)[1] in _PURE:
        return name, None, False
    name, unit = split_unit(name)
    return name, unit, unit is not None
