"""Lines above a table that may state what a run lacks, in words that are not known."""

from __future__ import annotations

from tribolab.draft.file.header import converts
from tribolab.draft.file.layout import Layout
from tribolab.draft.follows.model import Follows
from tribolab.draft.stated.stated_load import stated_number
from tribolab.draft.stated.values import DraftValue, find_values
from tribolab.draft.vocabulary import WEIGHTS
from tribolab.draft.words.stated_words import OTHER_RADIUS
from tribolab.draft.words.strokes import STROKE
from tribolab.errors import shown

_LACKS = {"the radius": "m", "the load": "N", "the sliding speed": "m/s"}
_QUOTED = 3


def may_say(layout: Layout, follows: Follows, lack: str) -> str:
    """Quote the lines above the table that may state what a run lacks; "" if none does.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    follows
        What was found out about the file: what it rests on is not quoted.
    lack
        One of what `lacking` returns.
    """
    lines = [value.text for value in _perhaps(layout, follows, lack)]
    lines = [" ".join(line.split()) for line in lines]
    return " or ".join(f"'{shown(line, 50)}'" for line in dict.fromkeys(lines[:_QUOTED]))


def likely_amount(layout: Layout, follows: Follows, lack: str) -> str:
    """Return the one amount that these lines state, as "22.5 mm"; "" if they state none or two.

    Parameters
    ----------
    layout, follows, lack
        As `may_say` takes them.
    """
    stated = {
        f"{number:.6g} {value.own_unit}"
        for value in _perhaps(layout, follows, lack)
        if (number := stated_number(value)) > 0
    }
    return stated.pop() if len(stated) == 1 else ""


def _perhaps(layout: Layout, follows: Follows, lack: str) -> list[DraftValue]:
    """Return what is stated above the table in a unit of what a run lacks."""
    unit = next((unit for words, unit in _LACKS.items() if lack.startswith(words)), "")
    used = {value.text for value in follows.values}
    return [
        value
        for value in find_values(layout)
        if unit and value.source != "file name" and value.text not in used
        if converts(WEIGHTS.get(value.own_unit or "", value.own_unit or ""), unit)
        if unit != "m" or not (OTHER_RADIUS.search(value.key) or STROKE.search(value.key))
    ]
