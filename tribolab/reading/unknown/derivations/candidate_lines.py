"""Lines above a table that may state what a run lacks, in words that are not known."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.unknown.derivations.model import Follows
from tribolab.reading.unknown.header.run_amounts import find_load
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import Agreed, Understood
from tribolab.units.spellings import WEIGHTS

_UNITS = {"track_radius": "m", "normal_force": "N", "sliding_velocity": "m/s"}
_QUOTED = 3


def candidate_lines(layout: Layout, follows: Follows, lack: str) -> str:
    """Quote the lines above the table that may state what a run lacks; "" if none does."""
    lines = [value.text for value in _perhaps(layout, follows, lack)]
    lines = [" ".join(line.split()) for line in lines]
    return " or ".join(f"'{shown(line, 50)}'" for line in dict.fromkeys(lines[:_QUOTED]))


def likely_value(layout: Layout, follows: Follows, lack: str) -> Amount | None:
    """Return what these lines state; None if they state nothing, or two amounts."""
    values = [value for value in _perhaps(layout, follows, lack) if value.value > 0]
    return values[0] if len({amount_of(value) for value in values}) == 1 else None


def amount_of(value: Amount | None) -> str:
    """Return what a value states, as "22.5 mm"; "" of none."""
    return "" if value is None else f"{value.value:.6g} {value.own_unit}"


def confirmed_value(
    values: Sequence[Amount], agreed: Sequence[tuple[Agreed, str]], what: Agreed
) -> Amount | None:
    """Return the value whose line a person took for the radius, the load or the speed."""
    lines = [line for name, line in agreed if name == what]
    return next((v for v in values if lines and v.text == lines[-1] and v.own_unit), None)


def _perhaps(layout: Layout, follows: Follows, lack: str) -> list[Amount]:
    """Return what is stated above the table in a unit of what a run lacks."""
    unit = _UNITS.get(lack, "")
    used = {value.text for value in follows.values}
    return [
        value
        for value in (numeric_settings(layout) if unit else ())
        if value.source != "file name" and value.text not in used
        if value.is_in(unit) and not (unit == "m" and value.means("other_radius", "stroke"))
    ]


def find_stated_load(values: Sequence[Amount], understood: Understood) -> Amount | None:
    """Return the load that the text states, or that a person took a line for."""
    agreed = confirmed_value(values, understood.agreed, "load")
    if agreed is None:
        return find_load(values)
    unit = WEIGHTS.get(agreed.own_unit or "", agreed.own_unit)
    return agreed._replace(name="set_normal_force", unit=unit, to=None, guess="")
