"""Questions of `tribolab info FILE --write` on one column: its quantity, unit, sign and zero."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from tribolab.app.questions.amounts import (
    answered_amount,
    candidate_amount,
    confirm_line,
    set_amount,
    set_strokes,
    states_amount,
)
from tribolab.app.questions.typed import NUMBER, as_amount, as_strokes, turning
from tribolab.core.errors import TribolabError, shown
from tribolab.reading.dialect.zero_reading import parse_zero
from tribolab.reading.unit_texts import converts, is_unit
from tribolab.reading.unknown.columns.rotating_parts import angle_of, torque_of
from tribolab.reading.unknown.derivations.stated_lines import amount_of
from tribolab.reading.unknown.model import DraftColumn, Reason, other_units
from tribolab.reading.unknown.proposal.answers import (
    ANGLE,
    TORQUE,
    Worth,
    column_of,
    corrected,
    fits,
    si_unit_of,
    worth_of,
)
from tribolab.reading.unknown.proposal.draft import Draft
from tribolab.units.quantities import QUANTITIES, quantity

NONE = "-"
YES = ("yes", "y")
_SUM = re.compile(r"^\d+(?:\s*\+\s*\d+)+$")
FRICTION = ("friction_force", TORQUE, "friction_coefficient", "shear_stress")
LOAD = ("normal_force", "normal_stress")
Say = Callable[[str], None]


class Ask(Protocol):
    """Function that asks a question and returns the answer; by default the suggested one."""

    def __call__(self, question: str, default: str) -> str:
        """Ask a question and return the answer."""


def ask_for(
    draft: Draft, names: Sequence[str], question: str, ask: Ask, say: Say, amount: str = ""
) -> Draft:
    """Ask which column has one of several quantities, or for a constant value, unless known."""
    found = column_of_any(draft, names)
    if found is not None and found.quantity in names and not (found.guessed or found.fill_in):
        return draft  # already known
    earlier = answered_amount(draft, amount)
    if found is None and not earlier and states_amount(draft, amount):
        return draft
    lines, value = ("", None) if found or earlier else candidate_amount(draft, amount)
    likely = amount_of(value)
    if lines:
        question += f"; is it in {lines}?" + (f" (yes: {likely})" if likely else "")
    # if only its unit is missing, the column counts as typed
    typed = str(found.place) if found and found.fill_in and not found.guessed else ""
    while True:
        usual = YES[0] if likely else NONE
        typed = typed or ask(question, str(found.place) if found else earlier or usual).strip()
        if typed == NONE:
            return draft if found is None else _remove_quantities(draft, names)
        if value is not None and typed.lower() in (*YES, likely):
            return confirm_line(_remove_quantities(draft, names), amount, value)
        try:
            if amount == "load" and _SUM.match(typed):
                return _add_sum(_remove_quantities(draft, names), typed, ask)
            strokes = as_strokes(typed) if amount == "speed" and not turning(typed) else None
            if strokes:
                return set_strokes(_remove_quantities(draft, names), strokes)
            if amount and (text := as_amount(typed, amount)):
                return set_amount(_remove_quantities(draft, names), amount, text)
            column = _column(draft, typed)
            if found and column.place == found.place and not found.guessed and not found.fill_in:
                return draft
            known = found if found and column.place == found.place else None
            reply = _ask_unit(column, names, known, ask)
            sign = _ask_sign(draft, column, reply.name, ask)
            draft = _remove_quantities(draft, names, but=reply.name)
            draft = corrected(
                draft, reply.name, column.place, reply.unit or None, sign, scale=reply.scale
            )
            return _ask_zero(draft, column, reply, ask, say)
        except TribolabError as error:
            typed = ""
            say(str(error.what))


def column_of_any(draft: Draft, names: Sequence[str]) -> DraftColumn | None:
    """Return the column of the first quantity in `names` that has one; None if no quantity has."""
    columns = draft.understood.columns if draft.understood else ()
    for name in names:
        by_name = {TORQUE: torque_of, ANGLE: angle_of}.get(name)
        column = column_of(draft, name) if by_name is None else by_name(columns)
        if column is not None:
            return column
    return None


def _remove_quantities(draft: Draft, names: Sequence[str], but: str = "") -> Draft:
    """Return a draft in which no column has any of these quantities, except the quantity `but`."""
    for name in names:
        if name != but and (name not in QUANTITIES or column_of(draft, name) is not None):
            draft = corrected(draft, name, None)
    return draft


def _add_sum(draft: Draft, typed: str, ask: Ask) -> Draft:
    """Return a draft in which the load is the sum of several columns, typed e.g. as 4 + 5."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    wanted = [_column(draft, place.strip()) for place in typed.split("+")]
    answers = {column.place: _ask_unit(column, LOAD[:1], None, ask) for column in wanted}
    columns = [
        c._replace(
            quantity=None,
            used=False,
            guessed=(),
            options=(),
            fill_in="",
            unit=answers[c.place].unit or None,
            scale=answers[c.place].scale,
            note=Reason.ADDS.value,
            reason=Reason.ADDS,
        )
        if c.place in answers
        else c
        for c in understood.columns
    ]
    return draft.with_understood(understood._replace(kind="run", columns=tuple(columns)))


def _column(draft: Draft, typed: str) -> DraftColumn:
    """Return the column with the typed number or name; raise if there is none."""
    columns = draft.understood.columns if draft.understood else ()
    for column in columns:
        if typed.strip() in (str(column.place), column.label, column.name):
            return column
    raise TribolabError(f"there is no column '{shown(typed)}': type a number from 1 on")


def _ask_unit(
    column: DraftColumn, names: Sequence[str], known: DraftColumn | None, ask: Ask
) -> Worth:
    """Return the quantity and unit of a column; ask for them unless the file states them."""
    name = next((name for name in names if known is not None and known.quantity == name), "")
    asked = (name,) if name else tuple(names)
    stated = column.file_unit or ""
    for wanted in asked if stated else ():
        if _fits(stated, wanted) and (column.unit is None or wanted not in QUANTITIES):
            return Worth(wanted, "")
    if name and quantity(name).unit == "1":
        return Worth(name, "")
    foreign = (
        bool(stated) and is_unit(stated) and not any(_fits(stated, wanted) for wanted in asked)
    )
    question = f"in which unit is column {column.place}?"
    guess = unit_guess(column, asked[0])
    if foreign:
        question = f"column {column.place} is in {shown(stated)}: how much is 1 {shown(stated)}?"
        question += f" (e.g. 8.2 {guess}/{shown(stated)})"
        guess = "?"
    elif "friction_force" in names or "normal_force" in names:
        question = question.removesuffix("?") + ", or what is one count of it (0.5 mN)?"
    typed = ask(question, guess).strip()
    unit = worth_of(typed, asked, column.file_unit)
    if foreign and not typed[:1].isdigit() and typed[:1] not in "+-.":
        raise TribolabError(f"state how many {shown(typed, 20)} are 1 {shown(stated)}")
    return unit


def _fits(unit: str, name: str) -> bool:
    return fits(unit, name) if name in QUANTITIES else converts(unit, si_unit_of(name))


def unit_guess(column: DraftColumn, name: str) -> str:
    """Return the unit to suggest: that of the draft if it suits the quantity, else a common one."""
    if column.unit and fits(column.unit, name):
        return column.unit
    return other_units("height" if name == "height" else quantity(name).unit)[0]


def _ask_sign(draft: Draft, column: DraftColumn, name: str, ask: Ask) -> int:
    """Ask whether a pressing force is negative, if a normal force has negative values."""
    if name != "normal_force" or draft.understood is None:
        return 1
    values = draft.understood.numbers[:, column.place - 1]
    values = values[np.isfinite(values)]
    if not values.size or not values.min() < 0:
        return 1
    counted = f"{values.min():.4g} to {values.max():.4g}"
    guess = "yes" if column.sign < 0 or values.max() <= 0 else "no"
    typed = ask(
        (f"column {column.place} ranges from {counted}: is a pressing force negative?"), guess
    )
    return -1 if typed.strip().lower().startswith(("y", "j", "o", "s")) else 1


def _ask_zero(draft: Draft, column: DraftColumn, unit: Worth, ask: Ask, say: Say) -> Draft:
    """Ask for the zero (reading without contact) of a force column with a calibration factor."""
    layout, understood = draft.layout, draft.understood
    forces = {*FRICTION, *LOAD}
    if unit.scale == 1 or unit.name not in forces or layout is None or understood is None:
        return draft
    question = f"what does column {column.place} show without contact, in its own unit? "
    question += f"(or when there is no contact: first 5 s; {NONE}: zero)"
    while True:
        typed = ask(question, NONE).strip()
        if typed == NONE:
            return draft
        offset, zero = 0.0, ""
        if NUMBER.match(typed):
            offset = -unit.scale * float(typed.replace(",", "."))
            break
        try:
            parse_zero(typed)
        except TribolabError as error:
            say(str(error.what))
            continue
        zero = typed
        break
    columns = [
        c._replace(offset=offset, zero=zero) if c.place == column.place else c
        for c in understood.columns
    ]
    return draft.with_understood(understood._replace(columns=tuple(columns)))
