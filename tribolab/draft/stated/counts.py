"""Counts of a converter, of which the text above a table says what one is worth."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.settings import Amount, numeric_settings
from tribolab.draft.stated.stated_load import find_load
from tribolab.draft.words.stated_words import OFF_ALREADY, TAKEN_OFF, ZERO
from tribolab.errors import shown
from tribolab.quantities import quantity
from tribolab.reading.interpret.names import matches, split_unit
from tribolab.reading.interpret.unit_texts import converts, is_unit
from tribolab.reading.lexicon.lexicon import normalise_label
from tribolab.unit_names import WEIGHTS
from tribolab.units import conversion

_LONGEST = 200  # characters of a line that are looked at
_NUMBER = r"\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?"
COUNT_WORD = (
    r"(?:counts?|cts|units?|enheten|enheter|enhet|enheder|yksik\w+|einheit(?:en)?|digits?|lsb|bits?|incr(?:ement)?s?|micro?steps?|steps?|pulses?|ticks?"
    r"|conteggi[o]?|pass[io]|impulsi?|cuentas?|pasos?|pulsos?|impulsos?|contagens|passos?|coups|pas"
    r"|impulsions?|schritte?|impulse?|inkremente?|stappen|pulsen|krok\w{0,3}|impuls\w{0,3}|zlicz\w+"
    r"|pulser|steg|имп\w{0,6}|шаг\w{0,3}|отсч[её]т\w{0,3}|сч[её]т\w{0,3}|код\w{0,3}|ед\.?\s?АЦП"
    r"|say[ıi]m|darbe|ad[ıi]m|计数|脉冲|步|码|カウント|パルス|ステップ|카운트|펄스|스텝)"
)
WORTH = re.compile(
    rf"(?<![\d.,])(?P<number>{_NUMBER})\s?(?P<unit>[^\W\d]{{1,3}})\s?(?:/|per)\s?{COUNT_WORD}\b",
    re.IGNORECASE,
)
_SO_MANY = re.compile(
    rf"(?<![\d.,])(?P<number>{_NUMBER})\s?{COUNT_WORD}\s?(?:/|per)\s?(?P<unit>[^\W\d]{{1,3}})\b",
    re.IGNORECASE,
)
_IS = r"\s?(?:=|≙|≈|≅|:=|->|→|corresponds to|entspricht|entsprechen|equals?|is|are)\s?"
_ONE_IS = re.compile(  # "1 N = 4213 counts", whatever counts are called
    rf"(?<![\d.,])(?P<number>{_NUMBER})\s?(?P<unit>[^\W\d]{{1,3}}){_IS}"
    rf"(?P<counts>{_NUMBER})\s?(?P<word>[^\W\d]\w*)",
    re.IGNORECASE,
)
_COUNTS_ARE = re.compile(
    rf"(?<![\d.,])(?P<counts>{_NUMBER})\s?(?P<word>[^\W\d]\w*){_IS}"
    rf"(?P<number>{_NUMBER})\s?(?P<unit>[^\W\d]{{1,3}})(?!\w)",
    re.IGNORECASE,
)
_RAW = re.compile(  # names of a converter's numbers
    r"raw|adc|hx711|ads1|counts?|cts|digit|lsb|ham|roh|brut|grezz|crudo|bruto|surow|syrov|raa(?!d)"
    r"|生|原始|码|сыр|код"
)
_FRICTION = {"friction_force", "friction_coefficient", "shear_stress", "torque"}


# "0.002 N/count, zero 118 counts": what a signal shows without force, beside its factor
ZERO_BESIDE = re.compile(
    r"(?:zero|offset|tare|null\w*|noll\w*|nul(?:punt|punkt|stil\w*|v[æe]rdi)\w*|zéro|cero|tara|零[点位]?"
    r"|ゼロ|нол\w*|нул\w*|영점|sıfır\w*|nul(?:a|ov\w*))[^\w+\-]{0,4}(?:(?:at|bei|=|:)\s?)?"
    r"(?P<number>[-+]?\d+(?:[.,]\d+)?)\s?(?P<unit>[^\W\d_]{1,12}(?:/[^\W\d_]{1,4})?)?",
    re.IGNORECASE,
)


class _Worth(NamedTuple):
    """What one count is, and the line that states it."""

    number: float
    unit: str
    line: str
    zero: float = 0.0

    @property
    def as_unit(self) -> str:
        """The worth as a unit: what a dialect's column says."""
        return f"{self.number:.9g} {WEIGHTS.get(self.unit, self.unit)}"

    def is_of(self, si_unit: str) -> bool:
        """Whether a quantity with an SI unit may be worth it."""
        return bool(si_unit) and converts(WEIGHTS.get(self.unit, self.unit), si_unit)


def apply_count_scale(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Guess what a count of a column is from the one line that states it: "Encoder: 500 counts/mm".

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        As they are understood. Where none holds friction, the one of whole numbers that is named
        for a converter is the force that the line speaks of.
    numbers
        Their numbers (rows, columns) as written.
    """
    above = layout.text_above()
    stated = [worth for line in above if (worth := _worth(line[:_LONGEST]))]
    if not stated:
        return list(columns)
    result = [_with_worth(column, columns, stated, numbers) for column in columns]
    return _raw_force(layout, result, stated, numbers)


def stated_offset(text: str, start: int) -> re.Match[str] | None:
    """Return where a text states a zero that is still in the signal, behind some place.

    >>> stated_offset("0.002 N/count, zero 118 counts", 14)["number"]
    '118'
    >>> stated_offset("0.002 N/count, zero 118 counts (subtracted)", 14)
    """
    match = next((m for m in ZERO_BESIDE.finditer(text) if m.start() >= start), None)
    if match is None or TAKEN_OFF.search(text) or OFF_ALREADY.search(text[match.end() :]):
        return None
    return match


def calibration_factor(line: str) -> str:
    """Return what a line says that one count is worth, as a unit; "" if it says nothing.

    >>> calibration_factor("Encoder: 500 counts/mm"), calibration_factor("Sample 12")
    ('0.002 mm', '')
    """
    worth = _worth(line)
    return worth.as_unit if worth is not None else ""


def zero_in_counts(
    values: Sequence[Amount], column: DraftColumn, numbers: np.ndarray
) -> Amount | None:
    """Return the zero that a file states as a converter's reading; None if none, or several.

    Parameters
    ----------
    values
        From `tribolab.draft.stated.settings.numeric_settings`.
    column
        The friction force in counts, whose worth is known.
    numbers
        Its numbers as written.
    """
    present = numbers[np.isfinite(numbers)]
    if not column.counted or column.unit is None or not present.size:
        return None
    # of that size: an offset in another unit is none
    least, most = float(present.min()), float(present.max())
    reach = max(most - least, 1.0)
    found = [
        value
        for value in values
        if value.source == "preamble" and ZERO.search(value.key) and value.number
        if not (value.own_unit and _measures(value.own_unit))
        if least - reach <= value.number <= most + reach
    ]
    if len(found) != 1:
        return None
    return found[0]._replace(name="friction_zero", unit=column.unit, to="N")


def _with_worth(
    column: DraftColumn, columns: Sequence[DraftColumn], stated: list[_Worth], numbers: np.ndarray
) -> DraftColumn:
    """Return a column of counts with what one is worth, where a line says it of this quantity."""

    def is_open(one: DraftColumn, worth: _Worth) -> bool:
        counted = one.counted or _is_raw(one, numbers[:, one.place - 1])
        fits = one.quantity is not None and worth.is_of(quantity(one.quantity).unit)
        return counted and bool(one.fill_in) and fits

    mine = [worth for worth in stated if is_open(column, worth)]
    named = [worth for worth in mine if _named(worth.line) == column.quantity]
    mine = named if len(mine) > 1 else mine
    if len(mine) != 1:
        return column
    others = [one for one in columns if one is not column and is_open(one, mine[0])]
    sure = _named(mine[0].line) in ("" if not others else column.quantity, column.quantity)
    guess = f"one count is {mine[0].as_unit}: '{shown(mine[0].line, 40)}'"
    return column._replace(
        unit=mine[0].as_unit,
        offset=-mine[0].zero,
        used=True,
        fill_in="",
        counted=True,
        guessed=column.guessed if sure else (*column.guessed, guess),
        options=column.options if not sure or column.guessed else (),
    )


def _raw_force(
    layout: Layout, columns: list[DraftColumn], stated: list[_Worth], numbers: np.ndarray
) -> list[DraftColumn]:
    """Take a converter's counts for the friction force where nothing else holds it."""
    held = {column.quantity for column in columns if column.used or column.fill_in}
    of_force = [worth for worth in stated if worth.is_of("N")]
    if held & _FRICTION or len(of_force) != 1:
        return columns
    unknown = (column for column in columns if not column.quantity)
    raw = [column for column in unknown if _is_raw(column, numbers[:, column.place - 1])]
    if len(raw) != 1:
        return columns
    known = "normal_force" in held or find_load(numeric_settings(layout)) is not None
    line = shown(of_force[0].line, 40)
    guess = f"it is the friction force, for '{line}'"
    taken = raw[0]._replace(
        quantity="friction_force",
        unit=of_force[0].as_unit,
        offset=-of_force[0].zero,
        counted=True,
        used=True,
        note="",
        guessed=() if known else (guess,),
        options=() if known else ("normal_force", "not used"),
    )
    return [taken if column is raw[0] else column for column in columns]


def _is_raw(column: DraftColumn, values: np.ndarray) -> bool:
    """Whether a column of whole numbers is named for a converter, and for nothing else."""
    present = values[np.isfinite(values)]
    unit_free = column.file_unit is None and column.unit is None
    name = split_unit(column.label)[0] if column.label else ""
    if not unit_free or not _RAW.search(normalise_label(name)) or not present.size:
        return False
    return bool((present == np.round(present)).all()) and bool(np.ptp(present) > 0)


def _named(line: str) -> str:
    """Return the quantity of a line's first words: "Friction channel: 0.002 N/count"; "" if none.

    >>> _named("Friction channel: 0.002 N/count"), _named("1 N = 4213 counts")
    ('friction_force', '')
    """
    said = re.split(r"[:=]|\d", line, maxsplit=1)[0]
    told = (matches(words, None) for words in (said, *said.split()))
    return next((options[0].quantity for options in told if options), "")


def _worth(line: str) -> _Worth | None:
    """Return what a line says that one count is worth.

    >>> [_worth(line).as_unit for line in ("500 counts/mm", "1 N = 4213 sayım", "12 bits = 6 g")]
    ['0.002 mm', '0.000237360551 N', '0.5 gf']
    >>> _worth("1 N = 0.102 kg"), _worth("Step 2 = 5 N")
    (None, None)
    """
    each, many = WORTH.search(line), _SO_MANY.search(line)
    stated = each or many
    if stated is not None:
        number = _number(stated["number"])
        size = number if each or not number else 1 / number
        zero = _zero_beside(line, stated.end(), size, stated["unit"])
        return _Worth(size, stated["unit"], line.strip(), zero) if number else None
    both = _ONE_IS.search(line) or _COUNTS_ARE.search(line)
    if both is None or _measures(both["word"]):
        return None
    number, counts = _number(both["number"]), _number(both["counts"])
    if not (number and counts) or not (is_unit(both["unit"]) or both["unit"] in WEIGHTS):
        return None
    worth = number / counts
    zero = _zero_beside(line, both.end(), worth, both["unit"])
    return _Worth(worth, both["unit"], line.strip(), zero)


def _zero_beside(line: str, start: int, worth: float, unit: str) -> float:
    """Return the counts without force that a line states behind what one is worth; else 0."""
    match = stated_offset(line, start)
    if match is None:
        return 0.0
    zero, own = _number(match["number"]), WEIGHTS.get(match["unit"] or "", match["unit"] or "")
    if own and _measures(own) and converts(own, base := WEIGHTS.get(unit, unit)):
        return zero * conversion(own, base)[0] / worth
    return zero


def _measures(unit: str) -> bool:
    """Whether a text is a unit, and not that of what is only counted."""
    return (is_unit(unit) and not converts(unit, "1")) or unit in WEIGHTS


def _number(text: str) -> float:
    return float(text.replace(",", "."))
