"""The zero of a friction signal that the text above a table states, as a force or a torque."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.settings import Amount
from tribolab.draft.words.stated_words import NOT_TAKEN_OFF, OFF_ALREADY, TAKEN_OFF, ZERO
from tribolab.reading.interpret.names import matches
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import part_pattern

_LONGEST = 300  # characters of a line that are looked at
STILL = "it is still in the signal"
_OF_LOAD = re.compile(
    r"normal|load(?!cell)|last|belast|charge|carga|carico|vertical|verti[kc]al|axial|assial|nacisk"
    r"|obci[aą]|нагруз|нормал|载荷|法向|荷重|垂直|하중|fz|fn"
)
_OTHER = {"normal_force", "set_normal_force", "temperature", "position"}


def find_zero(layout: Layout, values: Sequence[Amount], unit: str, said: str = "") -> Amount | None:
    """Return the zero of the friction signal that a file states and that is still in the signal.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    values
        From `tribolab.draft.stated.settings.numeric_settings`.
    unit
        "N" of a force, "N m" of a torque.
    said
        What a person said of it: "taken off", or "in it".

    Returns
    -------
    Amount or None
        None, too, where nothing says whether it was taken off: see `zero_in_doubt`.
    """
    zero = _stated(values, unit)
    in_it = said == "in it" or (not said and _is_still_in(layout, zero))
    if zero is None or not in_it:
        return None
    name = "torque_zero" if unit == "N m" else "friction_zero"
    return zero._replace(name=name, unit=zero.own_unit, to=unit)


def zero_in_doubt(
    layout: Layout, values: Sequence[Amount], unit: str, said: str = ""
) -> Amount | None:
    """Return a stated zero of which nothing says whether it was taken off the signal.

    Parameters
    ----------
    layout, values, unit, said
        As for `find_zero`.
    """
    zero = _stated(values, unit)
    if zero is None or said or _is_still_in(layout, zero):
        return None
    behind = zero.text[zero.text.find(":") + 1 :]
    told = _says(layout, zero, TAKEN_OFF) or OFF_ALREADY.search(behind)
    return None if told else zero


def _is_still_in(layout: Layout, zero: Amount | None) -> bool:
    own = zero is not None and NOT_TAKEN_OFF.search(zero.text)
    return bool(own) or _says(layout, zero, NOT_TAKEN_OFF)


def _stated(values: Sequence[Amount], unit: str) -> Amount | None:
    fitting = [value for value in values if _is_zero(value, unit)]
    if len(fitting) > 1:  # that of the load beside it is another
        fitting = [value for value in fitting if not _OF_LOAD.search(value.key)]
    return fitting[0] if len(fitting) == 1 and fitting[0].number else None


def _says(layout: Layout, zero: Amount | None, words: re.Pattern[str]) -> bool:
    """Whether another line above the table says something of zeros."""
    others = (
        line[:_LONGEST] for line in layout.text_above() if zero is None or line.strip() != zero.text
    )
    return any(words.search(line) for line in others)


def friction_column(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the column that holds the friction force, of which a zero may be taken off.

    Parameters
    ----------
    columns
        As they are understood.
    """
    held = [c for c in columns if c.used and c.quantity == "friction_force" and not c.optional]
    return held[0] if len(held) == 1 else None


def _is_zero(value: Amount, unit: str) -> bool:
    if value.source != "preamble" or not ZERO.search(value.key):
        return False
    if not (value.own_unit and converts(value.own_unit, unit)):
        return False
    bare = part_pattern("zero").sub("", value.key)
    options = matches(bare, value.own_unit) if bare else []
    return not options or options[0].quantity not in _OTHER
