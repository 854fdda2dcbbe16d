"""Length and frequency of strokes, from the text above the table or from columns."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.names import is_stroke_frequency, is_stroke_length, split_unit
from tribolab.reading.lexicon.lexicon import alternatives, mentions, role_of
from tribolab.reading.numbers import numbers_in
from tribolab.reading.text.cells import split_name
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.model import DraftColumn, Understood

_CHANGED = 1.1  # largest ratio of highest to lowest value of a constant setting
_LIST = re.compile(rf"\d\s?(?:[/;|]|\b{alternatives('then')}\b)\s?\d", re.IGNORECASE)
_EITHER_WAY = re.compile(r"(?:\+/?-|±)\s?\d")  # "±5 mm": amplitude from the middle


class Strokes(NamedTuple):
    """Length and frequency of strokes: their settings in [speed], their sources, and a guess."""

    settings: tuple[tuple[str, str], ...]
    values: tuple[Amount, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()
    guess: str = ""


def find_strokes(values: Sequence[Amount], understood: Understood) -> Strokes | None:
    """Return length and frequency of strokes from the text above the table and from columns.

    If the text states both and no column shows that they change, the text is used.
    """
    lengths, frequencies = _of_columns(understood)
    stroke, frequency, guess = _stated(values)
    above = find_strokes_above(values)
    if above is not None and not _change(understood, frequencies):
        return above
    by_column = len(lengths) == 1 and not lengths[0].used
    return _strokes(
        lengths[0] if by_column else stroke,
        frequencies[0] if len(frequencies) == 1 else frequency,
        "" if by_column else guess,
    )


def _strokes(
    length: Amount | DraftColumn | None, often: Amount | DraftColumn | None, guess: str = ""
) -> Strokes | None:
    """Return strokes from a stated or recorded length and frequency; None if either is missing."""
    if length is None or often is None:
        return None
    given = {"stroke": length, "stroke_frequency": often}
    names = [key if isinstance(one, DraftColumn) else one.name for key, one in given.items()]
    return Strokes(
        tuple(zip(("stroke_value", "frequency_value"), names, strict=True)),
        tuple(one for one in given.values() if isinstance(one, Amount)),
        tuple((key, one) for key, one in given.items() if isinstance(one, DraftColumn)),
        guess,
    )


def strokes_from_answer(values: Sequence[Amount], said: tuple[str, str]) -> Strokes | None:
    """Return the strokes that the user stated, completed by the text above the table."""
    stated = _stated(values)[:2]
    settings, kept = [], []
    for name, text, value in zip(("stroke", "frequency"), said, stated, strict=True):
        if text:
            settings.append((name, text))
        elif value is not None:
            settings.append((f"{name}_value", value.name))
            kept.append(value)
    return Strokes(tuple(settings), tuple(kept)) if len(settings) == len(said) else None


def find_strokes_above(values: Sequence[Amount]) -> Strokes | None:
    """Return the length and frequency of strokes stated above the table."""
    return _strokes(*_stated(values))


def strokes_of_turns(values: Sequence[Amount], often: DraftColumn) -> Strokes | None:
    """Return strokes of the stated length, at the rotation speed of a crank."""
    stroke, _, guess = _stated(values)
    return _strokes(stroke, often, guess)


def stated_strokes(values: Sequence[Amount]) -> tuple[Amount, ...]:
    """Return stated length, frequency and number of strokes, for comparison with a position."""
    strokes = find_strokes_above(values)
    if strokes is None or strokes.guess:
        return ()
    if any(value.source == "step" for value in strokes.values):
        return ()
    length, frequency = strokes.values
    cycles = Amounts(values).only("number_of_cycles", unit="")
    return (
        length._replace(name="stated_stroke"),
        frequency._replace(name="stated_stroke_frequency"),
        *(() if cycles is None else (cycles._replace(name="stated_cycles"),)),
    )


def find_stroke_length(values: Sequence[Amount]) -> Amount | None:
    """Return the only stroke length that the text states, if it is certain; else None."""
    length, _, guess = _stated(values)
    return None if guess else length


def _stated(values: Sequence[Amount]) -> tuple[Amount | None, Amount | None, str]:
    """Return the stroke length and frequency that the text states, and a guess about them."""
    stroke, frequency, guess = _only(values, "stroke", "m"), _only(values, "frequency", "Hz"), ""
    if stroke is not None and _EITHER_WAY.search(stroke.text):
        stroke = stroke._replace(scale=2.0)
    if stroke is None and (half := _only(values, "half_stroke", "m")) is not None:
        whole = mentions("end_to_end", half.text)
        stroke = half if whole else half._replace(scale=2.0)
        if not whole and "half" not in half.name and not _EITHER_WAY.search(half.text):
            guess = f"'{half.text}' is half of a stroke"
    several = [v for v in (stroke, frequency) if v is not None and _says_several(v)]
    if several:
        guess = f"of '{shown(several[0].text, 60)}' the first holds all along"
    return stroke, frequency, guess


def _only(values: Sequence[Amount], concept: str, unit: str) -> Amount | None:
    """Return the only amount of a concept; a sampling rate is not taken as a stroke frequency."""
    with_unit = Amounts(value for value in values if value.unit)
    one = with_unit.only(concept, unit=unit, but=("sampling_rate",))
    return None if one is None else one._replace(to=unit)


def _says_several(value: Amount) -> bool:
    """Whether a line states several numbers in one unit: '2 Hz, then 5 Hz', '2 / 5 Hz'."""
    if value.source != "preamble" or not value.own_unit:
        return False
    said = {n.value for n in numbers_in(value.text) if n.unit == value.own_unit}
    return len(said) > 1 or _LIST.search(value.text) is not None


def _of_columns(understood: Understood) -> tuple[list[DraftColumn], list[DraftColumn]]:
    """Return the columns of stroke lengths, and those of stroke frequencies."""
    lengths, frequencies = [], []
    for column in understood.columns:
        name, unit = split_name(column.label)
        if column.file_unit is None and unit is None:
            name, unit = split_unit(column.label)
            column = column._replace(unit=column.unit or unit)
        unit = column.file_unit or column.unit or unit
        if unit is not None and converts(unit, "m") and is_stroke_length(name):
            lengths.append(column)
        elif is_stroke_frequency(name, unit) and not column.used:
            frequencies.append(column)
    # if both set and measured frequency are recorded, use the measured one
    measured = [c for c in frequencies if role_of(c.label) != "set"]
    return lengths, measured if len(frequencies) > 1 else frequencies


def _change(understood: Understood, columns: Sequence[DraftColumn]) -> bool:
    """Whether there is exactly one column of a setting, and its values differ."""
    if len(columns) != 1:
        return False
    values = understood.numbers[:, columns[0].place - 1]
    values = values[np.isfinite(values) & (values > 0)]
    return bool(values.size) and float(values.max()) > _CHANGED * float(values.min())
