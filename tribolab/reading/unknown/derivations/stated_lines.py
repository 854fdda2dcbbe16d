"""Lines above a table that may state a missing input, a gain, or the no-data value of heights."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import matches
from tribolab.reading.numbers import number_pattern, numbers_in
from tribolab.reading.scans.sentinels import take_stated
from tribolab.reading.text.cells import split_row
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.derivations.model import Follows
from tribolab.reading.unknown.header.factors import states_raw_zero
from tribolab.reading.unknown.header.run_amounts import find_load
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import Agreed, DraftColumn, Understood
from tribolab.units.spellings import WEIGHTS

_UNITS = {"track_radius": "m", "normal_force": "N", "sliding_velocity": "m/s"}
_QUOTED = 3


def candidate_lines(layout: Layout, follows: Follows, lack: str) -> str:
    """Return the lines above the table that may state a missing input, in quotes; else ""."""
    lines = [value.text for value in _fitting_amounts(layout, follows, lack)]
    lines = [" ".join(line.split()) for line in lines]
    return " or ".join(f"'{shown(line, 50)}'" for line in dict.fromkeys(lines[:_QUOTED]))


def likely_value(layout: Layout, follows: Follows, lack: str) -> Amount | None:
    """Return the amount in the lines that may state a missing input; None if not unique."""
    values = [value for value in _fitting_amounts(layout, follows, lack) if value.value > 0]
    return values[0] if len({amount_of(value) for value in values}) == 1 else None


def amount_of(value: Amount | None) -> str:
    """Return an amount as text, such as "22.5 mm"; "" for None."""
    return "" if value is None else f"{value.value:.6g} {value.own_unit}"


def confirmed_value(
    values: Sequence[Amount], agreed: Sequence[tuple[Agreed, str]], what: Agreed
) -> Amount | None:
    """Return the value whose line the user confirmed as the radius, the load or the speed."""
    lines = [line for name, line in agreed if name == what]
    return next((v for v in values if lines and v.text == lines[-1] and v.own_unit), None)


def _fitting_amounts(layout: Layout, follows: Follows, lack: str) -> list[Amount]:
    """Return the stated amounts whose unit fits the missing input `lack`."""
    unit = _UNITS.get(lack, "")
    used = {value.text for value in follows.values}
    return [
        value
        for value in (numeric_settings(layout) if unit else ())
        if value.source != "file name" and value.text not in used
        if value.is_in(unit) and not (unit == "m" and value.means("other_radius", "stroke"))
    ]


def find_stated_load(values: Sequence[Amount], understood: Understood) -> Amount | None:
    """Return the load from the line that the user confirmed, else the load that the text states."""
    agreed = confirmed_value(values, understood.agreed, "load")
    if agreed is None:
        return find_load(values)
    unit = WEIGHTS.get(agreed.own_unit or "", agreed.own_unit)
    return agreed._replace(name="set_normal_force", unit=unit, to=None, guess="")


class Gain(NamedTuple):
    """Column of a force in volts, and its gain (force per volt)."""

    column: DraftColumn
    factor: Amount


def find_gain(layout: Layout, columns: Sequence[DraftColumn], force: str) -> Gain | None:
    """Return column and gain of a force in volts, if both are unique in the file; else None.

    `force` is "friction_force" or "normal_force".
    """
    column = column_in_volts(columns, force)
    name = re.escape(bare_name(column)[0].strip()) if column is not None else ""
    mine = [
        line for line in layout.sentences() if name and re.search(rf"(?<!\w){name}(?!\w)", line)
    ]
    gains = [(line, n) for line in mine for n in numbers_in(line) if converts(n.unit, "N/V")]
    if column is None or len(gains) != 1 or states_raw_zero(gains[0][0]):
        return None
    line, number = gains[0]
    pattern = number_pattern(line[: number.start])
    amount = Amount(f"{force}_gain", pattern, number.unit, "N/V", line, own_unit=number.unit)
    return Gain(column._replace(unit=bare_name(column)[1]), amount)


def column_in_volts(columns: Sequence[DraftColumn], force: str) -> DraftColumn | None:
    """Return the only column in volts whose name means the given force; else None."""
    found = []
    for column in columns:
        name, unit, _ = bare_name(column)
        if not column.used and unit is not None and converts(unit, "V"):
            options = matches(name, None)
            found += [column] if options and options[0].quantity == force else []
    return found[0] if len(found) == 1 else None


def take_stated_missing(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[str]:
    """Replace heights equal to a stated no-data value by NaN; return the texts of these cells."""
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
