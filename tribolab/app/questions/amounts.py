"""Load, speed and sampling rate in the draft of a dialect: from the file, or from answers."""

from __future__ import annotations

from tribolab.app.questions.typed import turns_alone
from tribolab.core.errors import ReadError
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.unknown.derivations.derive import what_follows
from tribolab.reading.unknown.derivations.missing_inputs import lacking
from tribolab.reading.unknown.derivations.stated_lines import candidate_lines, likely_value
from tribolab.reading.unknown.model import Agreed
from tribolab.reading.unknown.proposal.draft import Draft


def set_strokes(draft: Draft, strokes: tuple[str, str]) -> Draft:
    """Return a draft with the length and frequency of its strokes; raise if one is missing."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    draft = draft.with_understood(understood._replace(strokes=strokes))
    speed = what_follows(layout, understood._replace(strokes=strokes)).speed
    if speed is None or speed.source != "stroke":
        if not strokes[0] and turns_alone(strokes[1]):
            raise ReadError(
                f"a rotation speed needs the radius of the track: {strokes[1]} at 20 mm radius"
            )
        lacking_one = "frequency, such as 2 Hz" if strokes[0] else "length, such as 8 mm"
        raise ReadError(f"strokes also need a {lacking_one}")
    return draft


def answered_amount(draft: Draft, amount: str) -> str:
    """Return the load, speed or rate from the answers of the user; "" if there is none."""
    understood = draft.understood
    if understood is None:
        return ""
    return {"load": understood.load, "speed": understood.speed, "rate": understood.rate}.get(
        amount, ""
    )


def states_amount(draft: Draft, amount: str) -> bool:
    """Whether `amount` is the load, and the file clearly states it as one number."""
    layout, understood = draft.layout, draft.understood
    if amount != "load" or layout is None or understood is None or understood.load:
        return False
    follows = what_follows(layout, understood)
    formulas = {each.formula for each in follows.formulas if each.quantity == "normal_force"}
    loads = [value for value in follows.values if {value.name} == formulas]
    return bool(loads) and not loads[0].guess


def confirm_line(draft: Draft, amount: str, value: Amount) -> Draft:
    """Return a draft that takes the load or speed from a line of the file, as the user agreed."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    what: Agreed = "load" if amount == "load" else "speed"
    understood = understood._replace(agreed=(*understood.agreed, (what, value.text)))
    return draft.with_understood(understood)


def candidate_amount(draft: Draft, amount: str) -> tuple[str, Amount | None]:
    """Return the lines of the file that may state a missing load or speed, and the likely value."""
    layout, understood = draft.layout, draft.understood
    lack = {"load": "normal_force", "speed": "sliding_velocity"}.get(amount, "")
    if layout is None or understood is None or not lack:
        return "", None
    follows = what_follows(layout, understood)
    missing = any(lacked.member == lack for lacked in lacking(understood, follows))
    if not missing:
        return "", None
    return candidate_lines(layout, follows, lack), likely_value(layout, follows, lack)


def set_amount(draft: Draft, amount: str, text: str) -> Draft:
    """Return a draft with the load, speed or rate that the user has typed."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    if amount == "load":
        understood = understood._replace(load=text)
    elif amount == "speed":
        understood = understood._replace(speed=text)
    else:
        understood = understood._replace(rate=text)
    return draft.with_understood(understood)
