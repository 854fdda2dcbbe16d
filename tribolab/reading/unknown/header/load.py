"""The load that the text before a table states."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.unknown.header.factors import contacts_in
from tribolab.units.spellings import WEIGHTS

_SAME_FORCE = 0.01  # relative difference of a weight and of the force of it, both rounded


def find_load(values: Sequence[Amount]) -> Amount | None:
    """Return the load that the text before the table states, as a force; None if none, or several.

    If the text states none, that of the file's name. A load of zero is none.
    """
    contacts = next(filter(None, (contacts_in(v.text) for v in values if not v.own_unit)), 1)
    fitting = Amounts(
        value._replace(
            name="set_normal_force",
            unit=_force_unit(value),
            to=None,
            scale=value.scale * (contacts if value.means("per_contact") else 1),
        )
        for value in Amounts(values).of("load", unit="N")
        # "step 0: no contact (load 0 N)": nothing that friction is divided by
        if value.source != "file name" and (value.source == "step" or stated_number(value) != 0)
    )
    if not fitting:
        named = (v for v in values if v.source == "file name" and v.name == "set_normal_force")
        return next(named, None)
    if len(fitting) == 2 and _are_one(*fitting):
        return fitting[fitting[0].unit in WEIGHTS.values()]  # the force, as it is stated
    return fitting.only()


def _force_unit(value: Amount) -> str:
    return WEIGHTS.get(value.own_unit or "", value.own_unit or "")


def _are_one(one: Amount, other: Amount) -> bool:
    """Whether two loads are a weight and the force of it, as "2.5 kg" and "24.5 N"."""
    if "step" in (one.source, other.source) or one.unit == other.unit:
        return False
    sizes = one.si("N"), other.si("N")
    return abs(sizes[0] - sizes[1]) <= _SAME_FORCE * max(sizes)


def stated_number(value: Amount) -> float:
    """Return the number of an amount, in its unit; NaN if the text is no amount."""
    return value.scale * value.number
