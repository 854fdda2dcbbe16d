"""Columns of heights: alone, side by side, or behind their positions."""

from __future__ import annotations

import re

from tribolab.reading.interpret.names import KNOWN_WORD, matches
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.model import DraftColumn, other_units


def in_stated_unit(columns: list[DraftColumn], unit: str, along: str = "") -> list[DraftColumn]:
    """Give heights and positions without a unit those that the text before the table states."""
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
    """Whether columns are profiles side by side: their names differ by a number alone."""
    names = [bare_name(column)[0] for column in columns]
    units = {column.file_unit or column.unit for column in columns}
    alike = {re.sub(r"\d+", "", name).strip() for name in names}
    lengths = all(unit is None or converts(unit, "m") for unit in units)
    return len(set(names)) == len(names) > 1 and len(alike) == 1 and lengths


def are_traces(columns: list[DraftColumn]) -> bool:
    """Whether columns in units of length are named as numbered traces: "Profile 1 [um]"."""
    bare = [bare_name(column) for column in columns]
    named = (_trace_name(name) for name, _, _ in bare)
    return all(named) and all(unit is not None and converts(unit, "m") for _, unit, _ in bare)


def _trace_name(name: str) -> bool:
    bare = re.sub(r"[\W_]*\d+$", "", name)
    return key_pattern("trace_name").search(normalise_label(bare)) is not None


def as_heights(column: DraftColumn, *, stated: bool, unit: str = "um") -> DraftColumn:
    """Take a column without a known name for heights: what a pitch before it is of."""
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
