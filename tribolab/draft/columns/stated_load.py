"""The load that the text before a table states, and the number of what any text states."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.draft.columns.stated_words import LOAD
from tribolab.draft.columns.values import DraftValue
from tribolab.draft.file.header import converts
from tribolab.draft.vocabulary import WEIGHTS
from tribolab.io.dialects.patterns import guarded


def find_load(values: Sequence[DraftValue]) -> DraftValue | None:
    """Return the load that the text before the table states, as a force; None if none, or several.

    Where the text states none, that of the file's name.

    Parameters
    ----------
    values
        From `tribolab.draft.columns.values.find_values`.
    """
    fitting = []
    of_name = [v for v in values if v.source == "file name" and v.name == "set_normal_force"]
    for value in values:
        if value.source == "file name" or not LOAD.search(value.key):
            continue
        unit = WEIGHTS.get(value.own_unit or "", value.own_unit or "")
        if converts(unit, "N"):
            fitting.append(value._replace(name="set_normal_force", unit=unit, to=None))
    if not fitting and len(of_name) == 1:
        return of_name[0]
    return fitting[0] if len(fitting) == 1 else None


def stated_number(value: DraftValue) -> float:
    """Return the number that a value's text states, in the value's unit.

    Parameters
    ----------
    value
        From `tribolab.draft.columns.values.find_values`.
    """
    stated = guarded(value.pattern).first(value.text) or "nan"
    return value.scale * float(stated.rstrip(".,").replace(",", "."))
