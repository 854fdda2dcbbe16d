"""Names and units of the columns of an unknown table, from its header."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.reading.interpret.names import COUNTS, is_count, matches, split_unit
from tribolab.reading.interpret.unit_texts import is_unit, measures_something
from tribolab.reading.lexicon.lexicon import alternatives, normalise_label, part_pattern
from tribolab.reading.text.cells import split_name
from tribolab.reading.unknown.columns.unit_and_sign import Bare
from tribolab.reading.unknown.header.settings import text_settings
from tribolab.reading.unknown.layout.lvm import units_above
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.spellings import unit_in_words

_MAX_LINE = 300  # characters of a line that are looked at
_PURE = ("1", "-", ".")  # signs for the unit of a pure number


def labelled(layout: Layout) -> list[DraftColumn]:
    """Columns with their names and units from the header."""
    heading = layout.heading
    cells = list(heading.cells if heading else ())[: layout.width]
    if heading is None and layout.width == 1:
        cells = [_named_above(layout)]
    cells += [""] * (layout.width - len(cells))
    units_row = list(heading.unit_cells if heading else ()) + [""] * layout.width
    above = _stated_units(layout, cells) | units_above(layout)
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


_MAX_NAMES = 64
_IN = (
    rf"\s{{0,3}}(?:{alternatives('in')}\s|[:=]|(?=[\[(]))"
    r"\s{0,3}[\[(]?"
)
# "t - time [s];  Fx: friction force (N), Fz = load (N)", up to where another name is explained
_LEGEND = (
    r"(?:^\W*|[;,|]\s*|\s\s){name}\s{{0,3}}[-–—=:]\s{{0,3}}"
    r"(?P<about>[^\W\d](?:(?![,;|]\s*[^\W\d]\w{{0,12}}\s{{0,3}}[-–—=:]\s)[^;|]){{1,90}})"
)
_SAID_UNIT = r"(?P<unit>[^\W\d_%][^\s,;:()\[\]]{0,20}|%|°C)(?=$|[\s,;.)\]])"


def _stated_units(layout: Layout, cells: Sequence[str]) -> dict[int, str]:
    """Return units of columns (from 1) stated in the text above: "F in gf, t in ms"."""
    bare = [place for place, cell in enumerate(cells, 1) if cell and split_name(cell)[1] is None]
    if len(bare) > _MAX_NAMES or layout.heading is None or layout.heading.units is not None:
        return {}
    lines = [line[:_MAX_LINE] for line in layout.text_above()]
    found = {}
    for place in bare:
        name = cells[place - 1].strip()
        words = re.compile(rf"(?<!\w){re.escape(name)}{_IN}{_SAID_UNIT}")
        told = [match["unit"].rstrip(".") for line in lines for match in words.finditer(line)]
        explained = re.compile(_LEGEND.format(name=re.escape(name)))
        for match in (match for line in lines for match in explained.finditer(line)):
            brackets = (unit_in_words(text.strip()) for text in _UNIT_IN.findall(match["about"]))
            told += [unit for unit in brackets if is_unit(unit)][:1]
        units = {unit for text in told if is_unit(unit := unit_in_words(text))}
        if len(units) == 1:
            found[place] = units.pop()
    return found


_UNIT_IN = re.compile(r"[\[(]\s*([^\[\]()]+?)\s*[\])]")


def _named_above(layout: Layout) -> str:
    """Return what a line above a single column calls it, with its unit; "" if none does.

    "Signal: friction force [N], zero not corrected" names it as a header does.
    """
    for key, text in text_settings(layout, bare=True):
        unit = _UNIT_IN.search(text)
        if (
            unit is None
            or not is_unit(unit[1])
            or not part_pattern("signal").fullmatch(normalise_label(key))
        ):
            continue
        name = text[: unit.start()].strip()
        if name and matches(name, unit[1]):
            return f"{name} [{unit[1]}]"
    return ""


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
