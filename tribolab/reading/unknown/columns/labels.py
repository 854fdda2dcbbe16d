"""Names and units of the columns of an unknown table, and columns of heights."""

from __future__ import annotations

import re

from tribolab.reading.interpret.names import COUNTS, KNOWN_WORD, is_count, matches, split_unit
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label
from tribolab.reading.text.cells import split_name
from tribolab.reading.unit_texts import converts, is_unit, measures_something
from tribolab.reading.unknown.columns.unit_and_sign import Bare
from tribolab.reading.unknown.layout.lvm import units_above
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, other_units

_PURE = ("1", "-", ".")  # signs for the unit of a pure number


def labelled(layout: Layout) -> list[DraftColumn]:
    """Return the columns of a table with their names and units from the header."""
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
    """Return name and unit of a header cell, and the unit as the dialect must state it.

    The last is "" if the reader understands the unit: it is "mm" for "POSITION (MM)".
    """
    name, unit = split_name(cell)
    spelt = ""
    if unit == "A" and matches(name, unit, scan=True):
        unit = spelt = "angstrom"  # profilometers write A for angstrom
    spelt = spelt or _in_small_letters(unit)
    unit = spelt or unit
    if unit in _PURE or not (unit is None or measures_something(unit) or is_count(unit)):
        return name, None, spelt  # the brackets contain something else
    return name, unit, spelt


def _of_rows(name: str, unit_cell: str) -> tuple[str, str | None, str]:
    """Return the same as `_of_cell` for a header with units in a row of their own."""
    unit = unit_cell.strip("[]() ") or None
    spelt = _in_small_letters(unit)
    return name, None if unit in _PURE else spelt or unit, spelt


def _in_small_letters(unit: str | None) -> str:
    """Return a unit in capitals in lower case: MM as mm; "" if the unit is correct as written."""
    capitals = unit is not None and unit.isupper() and not is_unit(unit)
    return unit.lower() if unit and capitals and is_unit(unit.lower()) else ""


def bare_name(column: DraftColumn) -> Bare:
    """Return the name of a column without unit, its unit, and whether a dialect must state it."""
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


def in_stated_unit(columns: list[DraftColumn], unit: str, along: str = "") -> list[DraftColumn]:
    """Give heights and positions without a unit the units stated above the table."""
    return [_in_unit(column, unit, along, alone=len(columns) == 1) for column in columns]


def _in_unit(column: DraftColumn, unit: str, along: str, *, alone: bool) -> DraftColumn:
    name, own, _ = bare_name(column)
    if own is not None:
        return column
    options = matches(name, None, scan=True)
    quantity = options[0].quantity if options else None
    if quantity in ("x", "y") and along:
        return column._replace(unit=along)
    unknown = alone and quantity is None and not matches(name, None)
    heights = not column.label or quantity == "height" or unknown
    return column._replace(unit=unit) if unit and heights else column


def side_by_side(columns: list[DraftColumn]) -> bool:
    """Whether columns are profiles side by side: their names differ only by a number."""
    names = [bare_name(column)[0] for column in columns]
    units = {column.file_unit or column.unit for column in columns}
    alike = {re.sub(r"\d+", "", name).strip() for name in names}
    lengths = all(unit is None or converts(unit, "m") for unit in units)
    return len(set(names)) == len(names) > 1 and len(alike) == 1 and lengths


def are_traces(columns: list[DraftColumn]) -> bool:
    """Whether all columns are lengths with names of numbered traces: "Profile 1 [um]"."""
    bare = [bare_name(column) for column in columns]
    named = (_trace_name(name) for name, _, _ in bare)
    return all(named) and all(unit is not None and converts(unit, "m") for _, unit, _ in bare)


def _trace_name(name: str) -> bool:
    bare = re.sub(r"[\W_]*\d+$", "", name)
    return key_pattern("trace_name").search(normalise_label(bare)) is not None


def as_heights(column: DraftColumn, *, stated: bool, unit: str = "um") -> DraftColumn:
    """Return a column as heights whose pitch is stated above the table."""
    name, own, say = bare_name(column)
    if say and own is not None and column.file_unit is None:
        column = column._replace(unit=own)  # "Hauteurs en µm"
    known = column.file_unit or column.unit
    guess = "it is the height" + ("" if known else f" in {unit}")
    said = matches(name, own, scan=True)
    named = bool(said and said[0].quantity == "height" and said[0].score >= KNOWN_WORD)
    named = bool(known and (named or key_pattern("values_name").search(normalise_label(name))))
    guessed = () if named or (stated and column.unit) else (guess,)
    return column._replace(
        quantity="height",
        unit=column.unit if known else unit,
        used=True,
        guessed=guessed,
        options=() if known else other_units("height", unit),
    )
