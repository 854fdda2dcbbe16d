"""Questions of `tribolab info FILE --write`, in order: columns, motion, pitch of heights."""

from __future__ import annotations

import re

from tribolab.app.questions.column_questions import (
    FRICTION,
    LOAD,
    NONE,
    YES,
    Ask,
    Say,
    ask_for,
    column_of_any,
    unit_guess,
)
from tribolab.app.questions.typed import amount_typed
from tribolab.core.errors import TribolabError
from tribolab.reading.scans.extent import likely_height_unit
from tribolab.reading.unknown.derivations.derive import what_follows
from tribolab.reading.unknown.derivations.missing_inputs import lacking
from tribolab.reading.unknown.derivations.stated_lines import (
    amount_of,
    candidate_lines,
    likely_value,
)
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import Understood
from tribolab.reading.unknown.proposal.answers import ANGLE, column_of, corrected
from tribolab.reading.unknown.proposal.draft import Draft, as_profile
from tribolab.units.conversion import positive

_MOTION = ("sliding_velocity", "rotation_speed", "position", ANGLE)
_SCAN = {"x": "the position along the profile", "height": "the height"}


def ask_about(draft: Draft, ask: Ask, say: Say) -> Draft:
    """Ask which quantity and unit each column has, and for quantities that have no column.

    Parameters
    ----------
    draft
        Draft of the description; its guesses are the defaults.
    ask
        Function that asks.
    say
        Function that prints why an answer is invalid, before the question is repeated.

    Returns
    -------
    Draft
        The draft with the answers in place of its guesses.
    """
    if draft.layout is None or draft.understood is None:
        return draft
    alone = len(draft.understood.columns) == 1  # a run has at least two columns
    if draft.kind == "table" and (alone or draft.unsaid):
        return _ask_for_pitch(draft, ask, say)
    if draft.kind == "scan":
        return _ask_about_scan(draft, ask, say)
    question = "which column is the time? (its number; or the rate of the rows, such as 100 Hz; "
    question += f"{NONE})"
    if draft.understood and not draft.understood.rate_pattern:  # else the file states the rate
        draft = ask_for(draft, ("time",), question, ask, say, amount="rate")
    question = "which column is the friction force (or its torque, or a friction coefficient)?"
    draft = ask_for(draft, FRICTION, f"{question} (its number; {NONE} for none)", ask, say)
    if column_of(draft, "normal_force") or not column_of(draft, "friction_coefficient"):
        question = (
            "which column is the normal force? (its number, 4 + 5 if two add up; or the load "
        )
        question += "itself: 20 N, 2 kg, 10 x 2 kg on a lever; "
        draft = ask_for(draft, LOAD, f"{question}{NONE} for none)", ask, say, amount="load")
    question = (
        "which column gives the motion: a speed, turns, an angle or a position? (its number; or "
    )
    question += "the sliding speed itself: 6 mm/min, 8 rpm at 20 mm radius; or reversing strokes: "
    question += f"8 mm at 2 Hz; {NONE} for none)"
    if not _has_speed_from_settings(draft):
        draft = ask_for(draft, _MOTION, question, ask, say, amount="speed")
    return _ask_for_motion(draft, ask, say) if draft.kind == "run" else draft


def _ask_about_scan(draft: Draft, ask: Ask, say: Say) -> Draft:
    """Ask which columns of a scan are position and height if unknown, then for guessed units."""
    for name, words in _SCAN.items():
        found = column_of_any(draft, (name,))
        known = found is not None and not (found.guessed or found.fill_in)
        if found is None or (not known and (found.counted or found.file_unit)):
            question = f"which column is {words}? (its number; {NONE} for none)"
            draft = ask_for(draft, (name,), question, ask, say)
    doubtful = {
        name: found for name in _SCAN if (found := column_of_any(draft, (name,))) and found.guessed
    }
    if not doubtful:
        return draft
    guess = ", ".join(unit_guess(column, name) for name, column in doubtful.items())
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
    """Whether the settings stated in the file give the speed, and no column does."""
    if (
        draft.layout is None
        or draft.understood is None
        or column_of_any(draft, _MOTION) is not None
    ):
        return False
    speed = what_follows(draft.layout, draft.understood).speed
    return speed is not None and speed.source != "none"


def _ask_for_motion(draft: Draft, ask: Ask, say: Say) -> Draft:
    """Ask for the settings from which the speed follows: crank, radius, and zero of the signal."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    speed = what_follows(layout, understood).speed
    if speed is not None and speed.guess and speed.source == "stroke":
        crank = f"is it driven by a crank ({NONE}: constant speed in both directions)?"
        drive = "constant speed" if ask(crank, "yes").strip() == NONE else "crank"
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
        taken = ask(f"was '{text}' subtracted from the signal ({NONE}: not yet)?", "yes")
        understood = understood._replace(zero="in it" if taken.strip() == NONE else "taken off")
        follows = what_follows(layout, understood)
    guessed = [value for value in follows.values if value.guess]
    if guessed or "track_radius" in lacks:
        guess = f"{guessed[0].value:.6g} {guessed[0].unit}" if guessed else NONE
        lines = candidate_lines(layout, follows, "track_radius")
        value = likely_value(layout, follows, "track_radius")
        question = "what is the radius of the track, with its unit"
        question += f"; is it in {lines}?" if lines else "?"
        likely = amount_of(value)
        guess = YES[0] if likely and guess == NONE else guess
        radius = _ask_amount(question, "radius", "m", guess, ask, say, likely)
        if (
            radius and value is not None and radius == likely
        ):  # the user confirms the value in the file
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
        pitch = _ask_amount(question, "pitch", "m", NONE, ask, say)
    if not (pitch or understood.pitched):
        return draft
    if draft.unsaid != "count":
        return as_profile(draft, pitch, _height_unit(understood, pitch, ask, say))
    question = "how much is one count, with its unit (e.g. 0.5 nm)?"
    count = _ask_amount(question, "count", "m", NONE, ask, say)
    return as_profile(draft, pitch, count) if count else draft


def _height_unit(understood: Understood, pitch: str, ask: Ask, say: Say) -> str:
    """Return the unit of the heights: stated in the file, the only plausible one, or typed."""
    column = understood.columns[0]
    unit = column.read_unit
    if unit is None and pitch:
        unit = likely_height_unit(understood.numbers[:, column.place - 1], positive(pitch, "m", ""))
        if unit:
            say(f"heights in {unit}: in any other unit the profile would be impossible")
    if unit:
        return unit
    guess = unit_guess(column, "height")
    return ask(f"in which unit is column {column.place}?", guess).strip()


def _ask_amount(
    question: str, name: str, si_unit: str, guess: str, ask: Ask, say: Say, likely: str = ""
) -> str:
    """Return a typed number with its unit, or `likely` after "yes"; "" if it is unknown."""
    while True:
        agree = f"yes: {likely}; " if likely else ""
        typed = ask(f"{question} ({agree}{NONE}: not known)", guess).strip()
        if typed == NONE:
            return ""
        if likely and typed.lower() in YES:
            typed = likely
        try:
            return amount_typed(typed, name, si_unit)
        except TribolabError as error:
            say(str(error.what))
