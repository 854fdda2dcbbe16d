"""Counts of a converter, of which the text above a table says what one is."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.errors import shown
from tribolab.quantities import quantity
from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.names import matches, split_unit
from tribolab.reading.interpret.unit_texts import converts, is_unit
from tribolab.reading.lexicon.lexicon import alternatives, normalise_label, part_pattern, says
from tribolab.reading.numbers import NUMBER, decimal, numbers_in
from tribolab.reading.unknown.header.load import find_load
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.unit_names import WEIGHTS
from tribolab.units import conversion

_LONGEST = 200  # characters of a line that are looked at
COUNT_WORD = alternatives("count")
_COUNT = re.compile(COUNT_WORD, re.IGNORECASE)
_EQUALS = re.compile(rf"\s?{alternatives('equals')}\s?", re.IGNORECASE)
_SHORT_UNIT = re.compile(r"[^\W\d]{1,3}")
_FRICTION = {"friction_force", "friction_coefficient", "shear_stress", "torque"}
# "0.002 N/count, zero 118 counts": what a signal shows without force, beside its factor
_OFFSET = re.compile(
    rf"{alternatives('zero_beside')}[^\w+\-]{{0,4}}(?:(?:at|bei|=|:)\s?)?"
    rf"(?P<number>{NUMBER})\s?(?P<unit>[^\W\d_]{{1,12}}(?:/[^\W\d_]{{1,4}})?)?",
    re.IGNORECASE,
)


class CountScale(NamedTuple):
    """What one count is, the line that states it, and the counts without force."""

    number: float
    unit: str
    line: str
    zero: float = 0.0

    @property
    def as_unit(self) -> str:
        """One count as a unit: what a dialect's column says."""
        return f"{self.number:.9g} {WEIGHTS.get(self.unit, self.unit)}"

    def is_of(self, si_unit: str) -> bool:
        """Whether counts of a quantity with an SI unit may be so much."""
        return bool(si_unit) and converts(WEIGHTS.get(self.unit, self.unit), si_unit)


def apply_count_scale(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Guess what a count of a column is from the one line that states it: "Encoder: 500 counts/mm".

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    columns
        As they are understood. If none holds friction, the one of whole numbers that is named
        for a converter is the force that the line speaks of.
    numbers
        Their numbers (rows, columns) as written.
    """
    stated = [scale for line in layout.text_above() if (scale := count_scale(line[:_LONGEST]))]
    if not stated:
        return list(columns)
    result = [_scaled(column, columns, stated, numbers) for column in columns]
    return _with_raw_force(layout, result, stated, numbers)


def stated_offset(text: str, start: int) -> re.Match[str] | None:
    """Return where a text states a zero that is still in the signal, behind some place.

    >>> stated_offset("0.002 N/count, zero 118 counts", 14)["number"]
    '118'
    >>> stated_offset("0.002 N/count, zero 118 counts (subtracted)", 14)
    """
    match = next((m for m in _OFFSET.finditer(text) if m.start() >= start), None)
    if match is None or says("zero_is_taken_off", text):
        return None
    return None if says("zero_taken_off", text[match.end() :]) else match


def calibration_factor(line: str) -> str:
    """Return what a line says that one count is, as a unit; "" if it says nothing.

    >>> calibration_factor("Encoder: 500 counts/mm"), calibration_factor("Sample 12")
    ('0.002 mm', '')
    """
    scale = count_scale(line)
    return scale.as_unit if scale is not None else ""


def count_scale(line: str) -> CountScale | None:
    """Return what a line says that one count is.

    >>> stated = ("500 counts/mm", "1 N = 4213 sayım", "12 bits = 6 g", "gain 2 mN per digit")
    >>> [count_scale(line).as_unit for line in stated]
    ['0.002 mm', '0.000237360551 N', '0.5 gf', '2 mN']
    >>> count_scale("1 N = 0.102 kg"), count_scale("Step 2 = 5 N")
    (None, None)
    """
    numbers = numbers_in(line)
    for number in numbers:
        over, _, under = number.unit.partition("/")
        for unit, count, size in ((over, under, 1.0), (under, over, -1.0)):
            if _COUNT.fullmatch(count) and _SHORT_UNIT.fullmatch(unit) and number.value > 0:
                return _behind(line, number.end, number.value**size, unit)
    for one, other in itertools.pairwise(numbers):
        if _EQUALS.fullmatch(line[one.end : other.start]) and one.value * other.value > 0:
            for force, counts in ((one, other), (other, one)):
                if _is_measure(force.unit) and counts.unit and not _is_measure(counts.unit):
                    return _behind(line, other.end, force.value / counts.value, force.unit)
    return None


def zero_in_counts(
    values: Sequence[Amount], column: DraftColumn, numbers: np.ndarray
) -> Amount | None:
    """Return the zero that a file states as a converter's reading; None if none, or several.

    Parameters
    ----------
    values
        From `numeric_settings`.
    column
        The friction force in counts, of which one is known.
    numbers
        Its numbers as written.
    """
    present = numbers[np.isfinite(numbers)]
    if not column.counted or column.unit is None or not present.size:
        return None
    # of that size: an offset in another unit is none
    least, most = float(present.min()), float(present.max())
    reach = max(most - least, 1.0)
    zeros = Amounts(
        value
        for value in Amounts(values).of("zero", source="preamble")
        if value.number and not (value.own_unit and _is_measure(value.own_unit))
        if least - reach <= value.number <= most + reach
    )
    zero = zeros.only()
    return None if zero is None else zero._replace(name="friction_zero", unit=column.unit, to="N")


def _scaled(
    column: DraftColumn,
    columns: Sequence[DraftColumn],
    stated: list[CountScale],
    numbers: np.ndarray,
) -> DraftColumn:
    """Return a column of counts with what one is, if a line says it of this quantity."""

    def is_open(one: DraftColumn, scale: CountScale) -> bool:
        counted = one.counted or _is_raw(one, numbers[:, one.place - 1])
        fits = one.quantity is not None and scale.is_of(quantity(one.quantity).unit)
        return counted and bool(one.fill_in) and fits

    mine = [scale for scale in stated if is_open(column, scale)]
    if len(mine) > 1:
        mine = [scale for scale in mine if _named(scale.line) == column.quantity]
    if len(mine) != 1:
        return column
    scale = mine[0]
    others = [one for one in columns if one is not column and is_open(one, scale)]
    sure = _named(scale.line) in ("" if not others else column.quantity, column.quantity)
    guess = f"one count is {scale.as_unit}: '{shown(scale.line, 40)}'"
    return column._replace(
        unit=scale.as_unit,
        offset=-scale.zero,
        used=True,
        fill_in="",
        counted=True,
        guessed=column.guessed if sure else (*column.guessed, guess),
        options=column.options if not sure or column.guessed else (),
    )


def _with_raw_force(
    layout: Layout, columns: list[DraftColumn], stated: list[CountScale], numbers: np.ndarray
) -> list[DraftColumn]:
    """Take a converter's counts for the friction force if nothing else holds it."""
    held = {column.quantity for column in columns if column.used or column.fill_in}
    of_force = [scale for scale in stated if scale.is_of("N")]
    if held & _FRICTION or len(of_force) != 1:
        return columns
    unknown = (column for column in columns if not column.quantity)
    raw = [column for column in unknown if _is_raw(column, numbers[:, column.place - 1])]
    if len(raw) != 1:
        return columns
    known = "normal_force" in held or find_load(numeric_settings(layout)) is not None
    guess = f"it is the friction force, for '{shown(of_force[0].line, 40)}'"
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
    converter = part_pattern("converter").search(normalise_label(name))
    if not unit_free or not converter or not present.size:
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


def _behind(line: str, end: int, size: float, unit: str) -> CountScale:
    """Return a scale with the zero that the line states behind it."""
    scale = CountScale(size, unit, line.strip())
    match = stated_offset(line, end)
    if match is None:
        return scale
    zero, own = decimal(match["number"]), match["unit"] or ""
    own, base = WEIGHTS.get(own, own), WEIGHTS.get(unit, unit)
    if own and _is_measure(own) and converts(own, base):
        zero *= conversion(own, base)[0] / size
    return scale._replace(zero=zero)


def _is_measure(unit: str) -> bool:
    """Whether a text is a unit, and not that of what is only counted."""
    return (is_unit(unit) and not converts(unit, "1")) or unit in WEIGHTS
