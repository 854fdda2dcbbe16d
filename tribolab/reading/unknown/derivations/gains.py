"""Forces in volts with a gain that a line states: "Gain Fx: 10 N/V" of a column "Fx [V]"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import matches
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.numbers import number_pattern, numbers_in
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.header.factors import states_raw_zero
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_MAX_LINE = 200  # characters of a line that are looked at


class Gain(NamedTuple):
    """The column of a force in volts, and how much force one of them is."""

    column: DraftColumn
    factor: Amount


def find_gain(layout: Layout, columns: Sequence[DraftColumn], force: str) -> Gain | None:
    """Return the gain in N/V that just one line states for the one column of a force in volts.

    `force` is "friction_force" or "normal_force".
    """
    column = column_in_volts(columns, force)
    name = re.escape(bare_name(column)[0].strip()) if column is not None else ""
    lines = [line[:_MAX_LINE].strip() for line in layout.text_above()]
    mine = [line for line in lines if name and re.search(rf"(?<!\w){name}(?!\w)", line)]
    gains = [(line, n) for line in mine for n in numbers_in(line) if converts(n.unit, "N/V")]
    if column is None or len(gains) != 1 or states_raw_zero(gains[0][0]):
        return None
    line, number = gains[0]
    pattern = number_pattern(line[: number.start])
    amount = Amount(f"{force}_gain", pattern, number.unit, "N/V", line, own_unit=number.unit)
    return Gain(column._replace(unit=bare_name(column)[1]), amount)


def column_in_volts(columns: Sequence[DraftColumn], force: str) -> DraftColumn | None:
    """Return the one column of volts that is named as a force is."""
    found = []
    for column in columns:
        name, unit, _ = bare_name(column)
        if not column.used and unit is not None and converts(unit, "V"):
            options = matches(name, None)
            found += [column] if options and options[0].quantity == force else []
    return found[0] if len(found) == 1 else None
