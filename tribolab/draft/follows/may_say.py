"""Lines above a table that may state what a run lacks, in words that are not known."""

from __future__ import annotations

from tribolab.draft.file.header import converts
from tribolab.draft.file.layout import Layout
from tribolab.draft.follows.model import Follows
from tribolab.draft.stated.values import find_values
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
    unit = next((unit for words, unit in _LACKS.items() if lack.startswith(words)), "")
    used = {value.text for value in follows.values}
    lines = [
        value.text
        for value in find_values(layout)
        if unit and value.source != "file name" and value.text not in used
        if converts(WEIGHTS.get(value.own_unit or "", value.own_unit or ""), unit)
        if unit != "m" or not (OTHER_RADIUS.search(value.key) or STROKE.search(value.key))
    ]
    return " or ".join(f"'{shown(line, 50)}'" for line in dict.fromkeys(lines[:_QUOTED]))
