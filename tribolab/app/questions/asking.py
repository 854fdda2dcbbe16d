"""Questions of `tribolab info FILE --write`: meaning of columns, and missing quantities."""

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
from tribolab.app.questions.typed import (
    NUMBER,
    amount_typed,
    as_amount,
    as_strokes,
    turning,
)
from tribolab.core.errors import TribolabError, shown
from tribolab.reading.dialect.zero_reading import parse_zero
from tribolab.reading.scans.extent import likely_height_unit
from tribolab.reading.unit_texts import converts, is_unit
from tribolab.reading.unknown.columns.rotating_parts import angle_of, torque_of
from tribolab.reading.unknown.derivations.derive import what_follows
from tribolab.reading.unknown.derivations.missing_inputs import lacking
from tribolab.reading.unknown.derivations.stated_lines import (
    amount_of,
    candidate_lines,
    likely_value,
)
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Reason, Understood, other_units
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
from tribolab.reading.unknown.proposal.draft import Draft, as_profile
from tribolab.units.conversion import positive
from tribolab.units.quantities import QUANTITIES, quantity

_NONE = "-"
_YES = ("yes", "y")
_SUM = re.compile(r"^\d+(?:\s*\+\s*\d+)+$")
_FRICTION = ("friction_force", TORQUE, "friction_coefficient", "shear_stress")
_LOAD = ("normal_force", "normal_stress")
_MOTION = ("sliding_velocity", "rotation_speed", "position", ANGLE)
_SCAN = {"x": "the position along the profile", "height": "the height"}


class Ask(Protocol):
    """Function that asks a question and returns the answer, or the default."""

    def __call__(self, question: str, default: str) -> str:
        """Ask a question."""


Say = Callable[[str], None]


def ask_about(draft: Draft, ask: Ask, say: Say) -> Draft:
    """Ask for the quantity and unit of columns, and for quantities without a column.

    Parameters
    ----------
    draft
        Draft of the description; its guesses are the defaults.
    ask
        Function that asks.
    say
        Function that prints why an answer is invalid, before it is asked again.

    Returns
    -------
    Draft
        The draft with the answers, which are no longer guesses.
    """
    if draft.layout is None or draft.understood is None:
        return draft
    alone = len(draft.understood.columns) == 1  # one column of numbers cannot be a run
    if draft.kind == "table" and (alone or draft.unsaid):
        return _ask_for_pitch(draft, ask, say)
    if draft.kind == "scan":
        return _ask_about_scan(draft, ask, say)
    question = "which column is the time? (its number; or the rate of the rows, such as 100 Hz; "
    question += f"{_NONE})"
    if draft.understood and not draft.understood.rate_pattern:  # else the file states it
        draft = _ask_for(draft, ("time",), question, ask, say, amount="rate")
    question = "which column is the friction force (or its torque, or a friction coefficient)?"
    draft = _ask_for(draft, _FRICTION, f"{question} (its number; {_NONE} for none)", ask, say)
    if column_of(draft, "normal_force") or not column_of(draft, "friction_coefficient"):
        question = (
            "which column is the normal force? (its number, 4 + 5 if two add up; or the load "
        )
        question += "itself: 20 N, 2 kg, 10 x 2 kg on a lever; "
        draft = _ask_for(draft, _LOAD, f"{question}{_NONE} for none)", ask, say, amount="load")
    question = (
        "which column gives the motion: a speed, turns, an angle or a position? (its number; or "
    )
    question += "the sliding speed itself: 6 mm/min, 8 rpm at 20 mm radius; or reversing strokes: "
    question += f"8 mm at 2 Hz; {_NONE} for none)"
    if not _has_speed_from_settings(draft):
        draft = _ask_for(draft, _MOTION, question, ask, say, amount="speed")
    return _ask_for_motion(draft, ask, say) if draft.kind == "run" else draft


def _ask_about_scan(draft: Draft, ask: Ask, say: Say) -> Draft:
    """Ask for the columns of a scan that are not known, and at once for the units of the others."""
    for name, words in _SCAN.items():
        found = _column_of_any(draft, (name,))
        known = found is not None and not (found.guessed or found.fill_in)
        if found is None or (not known and (found.counted or found.file_unit)):
            question = f"which column is {words}? (its number; {_NONE} for none)"
            draft = _ask_for(draft, (name,), question, ask, say)
    doubtful = {
        name: found for name in _SCAN if (found := _column_of_any(draft, (name,))) and found.guessed
    }
    if not doubtful:
        return draft
    guess = ", ".join(_unit_guess(column, name) for name, column in doubtful.items())
    places = " and ".join(str(column.place) for column in doubtful.values())
    question = f"in which units are {' and '.join(doubtful)} (columns {places})?"
    if len(doubtful) == 1:
        question = f"in which unit is column {places}?"
    while True:
        units = [unit for unit in re.split(r"[,;\s]+", ask(question, guess)) if unit]
        units = units * len(doubtful) if len(units) == 1 else units
        try:
            for (name, column), unit in zip(doubtful.items(), units, strict=True):
                draft = corrected(draft, name, column.place, unit)
            return draft
        except TribolabError as error:
            say(str(error.what))
        except ValueError:
            say(f"type one unit for each column, e.g. {guess}")


def _has_speed_from_settings(draft: Draft) -> bool:
    """Whether stated settings give the speed, without a guessed column."""
    if (
        draft.layout is None
        or draft.understood is None
        or _column_of_any(draft, _MOTION) is not None
    ):
        return False
    speed = what_follows(draft.layout, draft.understood).speed
    return speed is not None and speed.source != "none"


def _ask_for_motion(draft: Draft, ask: Ask, say: Say) -> Draft:
    """Ask for the settings that give the speed, if only these are missing."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    speed = what_follows(layout, understood).speed
    if speed is not None and speed.guess and speed.source == "stroke":
        crank = f"is it driven by a crank ({_NONE}: constant speed in both directions)?"
        drive = "constant speed" if ask(crank, "yes").strip() == _NONE else "crank"
        understood = understood._replace(drive=drive)
    return _ask_for_lengths(draft, layout, understood, ask, say)


def _ask_for_lengths(
    draft: Draft, layout: Layout, understood: Understood, ask: Ask, say: Say
) -> Draft:
    """Ask for a missing track radius, and whether a stated zero was already subtracted."""
    follows = what_follows(layout, understood)
    lacks = {lack.member for lack in lacking(understood, follows)}
    if follows.zero_in_doubt is not None:
        text = follows.zero_in_doubt.text
        taken = ask(f"was '{text}' subtracted from the signal ({_NONE}: not yet)?", "yes")
        understood = understood._replace(zero="in it" if taken.strip() == _NONE else "taken off")
        follows = what_follows(layout, understood)
    guessed = [value for value in follows.values if value.guess]
    if guessed or "track_radius" in lacks:
        guess = f"{guessed[0].value:.6g} {guessed[0].unit}" if guessed else _NONE
        lines = candidate_lines(layout, follows, "track_radius")
        value = likely_value(layout, follows, "track_radius")
        question = "what is the radius of the track, with its unit"
        question += f"; is it in {lines}?" if lines else "?"
        likely = amount_of(value)
        guess = _YES[0] if likely and guess == _NONE else guess
        radius = _ask_amount(question, "radius", "m", guess, ask, say, likely)
        if radius and value is not None and radius == likely:  # the value in the file
            agreed = (*understood.agreed, ("radius", value.text))
            understood = understood._replace(agreed=agreed)
        else:
            understood = understood._replace(radius=radius)
    return draft.with_understood(understood)


def _ask_for_pitch(draft: Draft, ask: Ask, say: Say) -> Draft:
    """Ask for the pitch of heights in a file without positions."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    pitch = ""
    if not understood.pitched:
        question = "what is the distance between neighbouring points, with its unit?"
        pitch = _ask_amount(question, "pitch", "m", _NONE, ask, say)
    if not (pitch or understood.pitched):
        return draft
    if draft.unsaid != "count":
        return as_profile(draft, pitch, _height_unit(understood, pitch, ask, say))
    question = "how much is one count, with its unit (e.g. 0.5 nm)?"
    count = _ask_amount(question, "count", "m", _NONE, ask, say)
    return as_profile(draft, pitch, count) if count else draft


def _height_unit(understood: Understood, pitch: str, ask: Ask, say: Say) -> str:
    """Return the unit of heights: from the file, from plausible numbers, or as typed."""
    column = understood.columns[0]
    unit = column.read_unit
    if unit is None and pitch:
        unit = likely_height_unit(understood.numbers[:, column.place - 1], positive(pitch, "m", ""))
        if unit:
            say(f"heights in {unit}: in any other unit the profile would be impossible")
    if unit:
        return unit
    guess = _unit_guess(column, "height")
    return ask(f"in which unit is column {column.place}?", guess).strip()


def _ask_amount(
    question: str, name: str, si_unit: str, guess: str, ask: Ask, say: Say, likely: str = ""
) -> str:
    """Ask until a valid number with a unit is typed, or "yes" to `likely`; "" if unknown."""
    while True:
        agree = f"yes: {likely}; " if likely else ""
        typed = ask(f"{question} ({agree}{_NONE}: not known)", guess).strip()
        if typed == _NONE:
            return ""
        if likely and typed.lower() in _YES:
            typed = likely
        try:
            return amount_typed(typed, name, si_unit)
        except TribolabError as error:
            say(str(error.what))


def _ask_for(
    draft: Draft, names: Sequence[str], question: str, ask: Ask, say: Say, amount: str = ""
) -> Draft:
    """Ask which column contains one of several quantities, or for an amount instead, if open."""
    found = _column_of_any(draft, names)
    if found is not None and found.quantity in names and not (found.guessed or found.fill_in):
        return draft  # nothing is open
    earlier = answered_amount(draft, amount)
    if found is None and not earlier and states_amount(draft, amount):
        return draft
    lines, value = ("", None) if found or earlier else candidate_amount(draft, amount)
    likely = amount_of(value)
    if lines:
        question += f"; is it in {lines}?" + (f" (yes: {likely})" if likely else "")
    # which column it is can be seen above: only its unit is open
    typed = str(found.place) if found and found.fill_in and not found.guessed else ""
    while True:
        usual = _YES[0] if likely else _NONE
        typed = typed or ask(question, str(found.place) if found else earlier or usual).strip()
        if typed == _NONE:
            return draft if found is None else _remove_quantities(draft, names)
        if value is not None and typed.lower() in (*_YES, likely):
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


def _column_of_any(draft: Draft, names: Sequence[str]) -> DraftColumn | None:
    """Return the column of the first quantity that has one."""
    columns = draft.understood.columns if draft.understood else ()
    for name in names:
        by_name = {TORQUE: torque_of, ANGLE: angle_of}.get(name)
        column = column_of(draft, name) if by_name is None else by_name(columns)
        if column is not None:
            return column
    return None


def _remove_quantities(draft: Draft, names: Sequence[str], but: str = "") -> Draft:
    """Return a draft without columns for any of the quantities except one."""
    for name in names:
        if name != but and (name not in QUANTITIES or column_of(draft, name) is not None):
            draft = corrected(draft, name, None)
    return draft


def _add_sum(draft: Draft, typed: str, ask: Ask) -> Draft:
    """Return a draft in which several columns add up to the load, e.g. 4 + 5."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    wanted = [_column(draft, place.strip()) for place in typed.split("+")]
    answers = {column.place: _ask_unit(column, _LOAD[:1], None, ask) for column in wanted}
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
    """Return the column with the typed number or name."""
    columns = draft.understood.columns if draft.understood else ()
    for column in columns:
        if typed.strip() in (str(column.place), column.label, column.name):
            return column
    raise TribolabError(f"there is no column '{shown(typed)}': type a number from 1 on")


def _ask_unit(
    column: DraftColumn, names: Sequence[str], known: DraftColumn | None, ask: Ask
) -> Worth:
    """Ask for the unit of a column, unless the file states a suitable unit."""
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
    guess = _unit_guess(column, asked[0])
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


def _unit_guess(column: DraftColumn, name: str) -> str:
    if column.unit and fits(column.unit, name):
        return column.unit
    return other_units("height" if name == "height" else quantity(name).unit)[0]


def _ask_sign(draft: Draft, column: DraftColumn, name: str, ask: Ask) -> int:
    """Ask for the sign of a force whose values all have the unexpected sign."""
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
    """Ask for the reading of a force column without contact, if it has a calibration factor."""
    layout, understood = draft.layout, draft.understood
    forces = {*_FRICTION, *_LOAD}
    if unit.scale == 1 or unit.name not in forces or layout is None or understood is None:
        return draft
    question = f"what does column {column.place} show without contact, in its own unit? "
    question += f"(or when there is no contact: first 5 s; {_NONE}: zero)"
    while True:
        typed = ask(question, _NONE).strip()
        if typed == _NONE:
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
