"""Zero of the friction force or torque, as stated in the text above a table."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.names import matches
from tribolab.reading.interpret.phrases import phrases
from tribolab.reading.lexicon.lexicon import mentions, part_pattern
from tribolab.reading.numbers import decimal
from tribolab.reading.text.cells import split_name
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.header import STEP_WORD
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_STEP_ZERO = re.compile(rf"{STEP_WORD}\W{{0,3}}0(?!\d)", re.IGNORECASE)
_ROW = re.compile(r"\s*\"?[01]\"?\s*[,;\t]")  # row of the first step in a test programme
STILL = "it is still in the signal"
_OTHER = {"normal_force", "set_normal_force", "temperature", "position"}


def find_zero(layout: Layout, values: Sequence[Amount], unit: str, said: str = "") -> Amount | None:
    """Return the stated zero of the friction signal if it has not been subtracted yet, else None.

    If it is unknown whether the zero has been subtracted, see `zero_in_doubt`.
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
    """Return the stated friction zero if it is unknown whether it was subtracted, else None."""
    zero = _stated(values, unit)
    if zero is None or said or _is_still_in(layout, zero):
        return None
    return None if _is_taken_off(layout, zero) else zero


def load_zeros_in_doubt(layout: Layout, columns: Sequence[DraftColumn]) -> list[str]:
    """Return the guesses that stated zeros of the load are already subtracted."""
    forces = any(c.used and c.quantity == "normal_force" for c in columns)
    volts = any(converts(c.file_unit or split_name(c.label)[1] or "", "V") for c in columns)
    zeros = [
        value
        for value in numeric_settings(layout)
        for read in [value._replace(unit=value.own_unit)]
        if value.source == "preamble" and value.means("zero") and value.number
        if (forces and read.is_in("N")) or (volts and read.is_in("V"))
        if _is_of_load(part_pattern("zero").sub("", value.key))
    ]
    return [
        f"'{zero.text}' was taken off the load" for zero in zeros if not _is_taken_off(layout, zero)
    ]


def unloaded_start_in_doubt(layout: Layout, columns: Sequence[DraftColumn]) -> list[str]:
    """Return a doubt about the friction zero if the text states a start or strokes without load."""
    held = {c.quantity for c in columns if c.used}
    if "normal_force" in held or "friction_coefficient" in held:
        return []  # the load or the coefficient shows when the contact is open
    said = [line for line in layout.sentences() if _says_unloaded_start(line)]
    return [f"the friction is read as it stands, although '{shown(line, 60)}'" for line in said[:1]]


def _says_unloaded_start(line: str) -> bool:
    """Whether a line states that the record begins, or strokes return, without load.

    >>> lines = ("first 3 s without load", "step 0: load 0 N", "lifted on return", "no load cell")
    >>> [_says_unloaded_start(line) for line in lines]
    [True, True, True, False]
    """
    begins = mentions("at_start", line) or _STEP_ZERO.search(line)
    if begins and mentions("zero_word", line):
        return True
    unloaded = mentions("without_contact", line.replace("load cell", "loadcell"))
    unloaded = unloaded or any(
        said.unit == "N" and not decimal(said.number) for said in phrases(line)
    )
    return bool(unloaded and (begins or mentions("on_return", line) or _ROW.match(line)))


def friction_column(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the only friction force column, else None."""
    held = [c for c in columns if c.used and c.quantity == "friction_force" and not c.optional]
    return held[0] if len(held) == 1 else None


def _is_taken_off(layout: Layout, zero: Amount) -> bool:
    own = mentions("zero_taken_off", zero.text[zero.text.find(":") + 1 :])
    return own or _another_line_says("zero_is_taken_off", layout, zero)


def _is_still_in(layout: Layout, zero: Amount | None) -> bool:
    own = zero is not None and mentions("zero_not_taken_off", zero.text)
    return own or _another_line_says("zero_not_taken_off", layout, zero)


def _another_line_says(name: str, layout: Layout, zero: Amount | None) -> bool:
    lines = (line for line in layout.sentences() if zero is None or line != zero.text)
    return any(mentions(name, line) for line in lines)


def _stated(values: Sequence[Amount], unit: str) -> Amount | None:
    fitting = [value for value in values if _is_zero(value, unit)]
    if len(fitting) > 1:  # leave out the zero of the load
        fitting = [value for value in fitting if not _is_of_load(value.key)]
    zero = Amounts(fitting).only()
    return zero if zero is not None and zero.number else None


def _is_of_load(key: str) -> bool:
    cell = part_pattern("load_cell").sub("", key)
    return part_pattern("of_load").search(cell) is not None


def _is_zero(value: Amount, unit: str) -> bool:
    if value.source != "preamble" or not value.own_unit:
        return False
    if not (value.means("zero") and value._replace(unit=value.own_unit).is_in(unit)):
        return False
    bare = part_pattern("zero").sub("", value.key)
    options = matches(bare, value.own_unit) if bare else []
    return not options or options[0].quantity not in _OTHER
