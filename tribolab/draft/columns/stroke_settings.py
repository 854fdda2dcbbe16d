"""Length and frequency of strokes: where a file states them, above the table or in columns."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.columns.stated_words import RATE
from tribolab.draft.columns.strokes import (
    END_TO_END,
    FREQUENCY,
    HALF_STROKE,
    STROKE,
    is_frequency,
    is_length,
)
from tribolab.draft.columns.values import DraftValue
from tribolab.draft.file.header import converts
from tribolab.draft.model import DraftColumn, Understood
from tribolab.io.dialects.cells import split_name

_CYCLES = re.compile(
    r"^(?:(?:number|no|nr|nombre|nb|numero|anzahl|total|liczba|pocet|antal|aantal)(?:of|de|dei|di|der)?)?"
    r"(?:cycles?|zyklen|zykluszahl|ciclos|cicli|cykli|cyklu|cykler|cycli|循环次数|サイクル数)$"
)
_EITHER_WAY = re.compile(r"(?:\+/?-|±)\s?\d")  # from the middle


class Strokes(NamedTuple):
    """Length and frequency of strokes: what [speed] says of them, where they stand, a guess."""

    settings: tuple[tuple[str, str], ...]
    values: tuple[DraftValue, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()
    guess: str = ""


def strokes_of_values(values: Sequence[DraftValue]) -> Strokes | None:
    """Return the length and frequency of strokes that stand above the table."""
    stroke, frequency, guess = _only(values, STROKE, "m"), _only(values, FREQUENCY, "Hz"), ""
    if stroke is not None and _EITHER_WAY.search(stroke.text):
        stroke = stroke._replace(scale=2.0)
    if stroke is None and (half := _only(values, HALF_STROKE, "m")) is not None:
        whole = END_TO_END.search(half.text) is not None
        stroke = half if whole else half._replace(scale=2.0)
        if not whole and "half" not in half.name and not _EITHER_WAY.search(half.text):
            guess = f"'{half.text}' is half of a stroke"
    if stroke is None or frequency is None:
        return None
    settings = (("stroke_value", stroke.name), ("frequency_value", frequency.name))
    return Strokes(settings, (stroke, frequency), guess=guess)


def as_stated(values: Sequence[DraftValue]) -> tuple[DraftValue, ...]:
    """Return what stands above the table of strokes, to be held against a recorded position."""
    strokes = strokes_of_values(values)
    if strokes is None or strokes.guess or any(value.source == "step" for value in strokes.values):
        return ()
    length, frequency = strokes.values
    counts = [v for v in values if v.own_unit is None and _CYCLES.search(v.key)]
    return (
        length._replace(name="stated_stroke"),
        frequency._replace(name="stated_stroke_frequency"),
        *(count._replace(name="stated_cycles") for count in counts[:1] if len(counts) == 1),
    )


def strokes_of_columns(understood: Understood) -> Strokes | None:
    """Return the columns that hold the length and the frequency of strokes."""
    lengths, frequencies = [], []
    for column in understood.columns:
        name, unit = split_name(column.label)
        unit = column.file_unit or unit
        if unit is not None and converts(unit, "m") and is_length(name):
            lengths.append(column)
        elif is_frequency(name, unit) and not column.used:
            frequencies.append(column)
    if len(lengths) != 1 or len(frequencies) != 1 or lengths[0].used:
        return None
    settings = (("stroke_value", "stroke"), ("frequency_value", "stroke_frequency"))
    return Strokes(settings, symbols=(("stroke", lengths[0]), ("stroke_frequency", frequencies[0])))


def _only(values: Sequence[DraftValue], key: re.Pattern[str], unit: str) -> DraftValue | None:
    """Return the one value of that name and kind; None if there is none, or several."""
    fitting = [
        value
        for value in values
        if value.unit
        and converts(value.unit, unit)
        and key.search(value.key)
        and not RATE.search(value.key)  # how often samples are taken
    ]
    return fitting[0]._replace(to=unit) if len(fitting) == 1 else None
