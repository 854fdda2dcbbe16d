"""Forces that stand in volts: what a volt is worth is said in the text before the table."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.columns.labels import bare_name
from tribolab.draft.file.layout import Layout
from tribolab.draft.follows.gains import with_unit
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.settings import numeric_settings
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import matches
from tribolab.reading.interpret.unit_texts import converts

_FORCES = {"friction_force": "friction", "normal_force": "load"}  # and names of their volts
_RATIO = re.compile(
    r"(?<![^\s\[(=:;,\d])(?P<unit>(?:[mkµu]?N|k?gf|kp|lbf)\s?/\s?[mµu]?V"
    r"|[mµu]?V\s?/\s?(?:[mkµu]?N|k?gf|kp|lbf))(?![\w/])"
)


class Calibrated(NamedTuple):
    """A force, the column of its volts, and the value that says what one is worth."""

    quantity: str
    column: DraftColumn
    value: Amount

    @property
    def symbol(self) -> str:
        """What the column is called in a formula."""
        return f"{_FORCES[self.quantity]}_signal"

    @property
    def formula(self) -> str:
        """How the force follows."""
        sign = "*" if self.value.to == "N/V" else "/"
        return f"{self.symbol} {sign} {self.value.name}"


def calibrated_forces(layout: Layout, columns: Sequence[DraftColumn]) -> list[Calibrated]:
    """Return the forces that a column in volts and a stated factor make, where both are sure.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        As they are understood.

    Returns
    -------
    list
        A force that a column holds is not among them; nor is one of which several columns, or
        several factors, speak.
    """
    held = {c.quantity for c in columns if c.quantity and (c.used or c.fill_in)}
    told = [(column, _force_of(column)) for column in columns if not column.used]
    factors = [
        factor for value in numeric_settings(layout) if (factor := _factor(value)) is not None
    ]
    made = []
    for quantity in _FORCES:
        mine = [column for column, force in told if force == quantity]
        fitting = [factor for factor in factors if _speaks_of(factor, quantity)]
        if quantity not in held and len(mine) == len(fitting) == 1:
            name = f"{_FORCES[quantity]}_factor"
            made.append(Calibrated(quantity, with_unit(mine[0]), fitting[0]._replace(name=name)))
    return made


def in_volts(columns: Sequence[DraftColumn], quantity: str) -> DraftColumn | None:
    """Return the one column of a force's volts, whatever one of them is worth.

    Parameters
    ----------
    columns
        As they are understood.
    quantity
        "friction_force" or "normal_force".
    """
    mine = [column for column in columns if not column.used and _force_of(column) == quantity]
    return mine[0] if len(mine) == 1 else None


def _force_of(column: DraftColumn) -> str:
    """Return the force that a column in volts names; "" if none."""
    name, unit, _ = bare_name(column)
    if not converts(column.file_unit or column.unit or unit or "", "V"):
        return ""
    options = matches(name, None)
    return options[0].quantity if options and options[0].quantity in _FORCES else ""


def _factor(value: Amount) -> Amount | None:
    """Return a value as a force per volt, or volts per force, where its text states one."""
    stated = _RATIO.search(value.text)
    if stated is None or value.source != "preamble":
        return None
    unit = stated["unit"]
    return value._replace(unit=unit, to="N/V" if unit.endswith("V") else "V/N")


def _speaks_of(factor: Amount, quantity: str) -> bool:
    """Whether a factor's name is of a force, or of none."""
    options = [option for option in matches(factor.key, None) if option.quantity in _FORCES]
    return not options or options[0].quantity == quantity
