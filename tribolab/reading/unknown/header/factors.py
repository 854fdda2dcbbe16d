"""Lever ratios, gains, numbers of contacts and calibrations stated above a table."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.phrases import label_of, phrases, single_number
from tribolab.reading.lexicon.lexicon import (
    alternatives,
    key_pattern,
    mentions,
    normalise_label,
    part_pattern,
    plain_text,
    plain_words,
    text_pattern,
)
from tribolab.reading.numbers import Number, decimal, numbers_in
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.spellings import MICRO

_MAX_CONTACTS = 12
_RATIO = re.compile(r"(?<![\d:.,/])(\d+(?:[.,]\d+)?)\s?:\s?(\d+(?:[.,]\d+)?)(?![\d:/])")  # 1:5
_QUOTED = 3
_RAW = re.compile(rf"[mk{MICRO}u]?V|{alternatives('count')}", re.IGNORECASE)
_EQUALS = re.compile(rf"\s?{alternatives('equals')}\s?", re.IGNORECASE)
_UNIT_OF_NAME = re.compile(r"[\[(](\w{1,12}/\w{1,12})[\])]")


def unapplied_factors(layout: Layout) -> list[str]:
    """Return sentences on stated factors that the signals may not include yet: levers, gains.

    There is one sentence per line of text. Factors of one and single contacts are left out.
    """
    lines = layout.sentences()
    if any(key_pattern("per_contact").search(label_of(line)) for line in lines):
        lines = [line for line in lines if not contacts_in(line)]  # see `find_load`
    return [sentence for line in lines if (sentence := _unapplied(line))]


def contacts_in(line: str) -> int:
    """Return the number of contacts that a line states, if there are several; else 0.

    >>> contacts_in("Number of pins: 3"), contacts_in("Pin 3")
    (3, 0)
    """
    counted = (n for n in numbers_in(line) if _counts_contacts(line, n))
    return next((int(number.value) for number in counted), 0)


def unapplied_height_factors(
    layout: Layout, heights: np.ndarray, columns: Sequence[DraftColumn]
) -> list[str]:
    """Return sentences on stated factors or step sizes that the heights may not include yet."""
    scaled = any(column.used and column.counted and column.unit for column in columns)
    present = heights[np.isfinite(heights)]
    whole = bool(present.size) and bool((present == np.round(present)).all())
    said = []
    for text in layout.sentences(bare=True):
        single = single_number(text)
        factor = (
            single and not single[2] and mentions("height_factor", single[0]) and single[1] != 1
        )
        step = whole and mentions("step_of_gauge", text) and not _states_one(text)
        counted = states_calibration(text)
        if factor or ((step or counted) and not scaled):
            said.append(f"heights are read as they stand, not times '{shown(text, 40)}'")
    return said


def _states_one(text: str) -> bool:
    """Whether the last number of a text is one: "z resolution: 1 nm"."""
    numbers = numbers_in(text)
    return bool(numbers) and numbers[-1].value == 1


def _unapplied(line: str) -> str:
    """Return a sentence on a factor in a line that the signals may not include yet, or "".

    >>> _unapplied("Multiply friction force by 1.25")
    "signals are read as they stand, and not as the file says: 'Multiply friction force by 1.25'"

    >>> _unapplied("Lever 1:5"), _unapplied("Gain: 1"), _unapplied("Time 1:05")
    ("signals are read as they stand, not times 'Lever 1:5'", '', '')
    >>> _unapplied("Number of contacts: 2")
    "friction and load are both of all contacts, or both of one: 'Number of contacts: 2'"
    """
    numbers = numbers_in(line)
    if contacts_in(line):
        return f"friction and load are both of all contacts, or both of one: '{shown(line, 40)}'"
    as_they_stand = f"signals are read as they stand, not times '{shown(line, 40)}'"
    for ratio in _RATIO.finditer(line):
        key = line[: ratio.start()]
        named = mentions("factor", key) or mentions("transmission", key)
        if named and any(key_pattern("load").search(s.key) for s in phrases(line[ratio.end() :])):
            return ""  # the line also states the resulting load
        if named and decimal(ratio[1]) != decimal(ratio[2]):
            return as_they_stand
    if mentions("lever", line) and any(not number.unit and number.value != 1 for number in numbers):
        return as_they_stand
    multiplies = any(_multiplies(line, number) and number.value != 1 for number in numbers)
    if multiplies or (mentions("signal", line) and mentions("scaled_in_words", line)):
        return f"signals are read as they stand, and not as the file says: '{shown(line, 60)}'"
    if states_raw_zero(line):
        return f"signals are read as they stand, without '{shown(line, 40)}'"
    single = single_number(line)
    if single is None or single[2] or single[1] == 1:
        return ""
    if mentions("factor", single[0]):
        return as_they_stand
    if mentions("gear", single[0]):
        return f"speeds are read as they stand, not divided by '{shown(line, 40)}'"
    return ""


def _counts_contacts(line: str, number: Number) -> bool:
    """Whether a number in a line counts contacts: "2 pins", "Number of contacts: 2"."""
    if not number.text.isdigit() or not 1 < number.value <= _MAX_CONTACTS:
        return False
    bodies = text_pattern("bodies_in_contact")
    before, behind = plain_text(line[: number.start]), plain_text(line[number.stop :])
    if bodies.match(behind.lstrip()):
        return True
    last = not behind.strip(" ;")
    return last and bool(mentions("contacts", before) or bodies.fullmatch(before.strip(" ;") + " "))


def _multiplies(line: str, number: Number) -> bool:
    """Whether signals have to be multiplied or divided by a number in a line."""
    before = line[: number.start].rstrip().rpartition(" ")
    if before[2] in ("x", "X", "×", "*"):  # "Friction force x 1.25", not "512 x 512"
        return mentions("signal", before[0]) and not any(map(str.isdigit, before[0]))
    if before[2].lower() not in plain_words("times_by"):
        return False
    words = before[0].rpartition(".")[2] if not any(map(str.isdigit, before[0])) else ""
    return mentions("multiply", words) or mentions("multiply", line[number.stop :][:30])


def calibration_lines(layout: Layout, *, bare: bool = False) -> str:
    """Return the lines that state a calibration of volts or counts, or its zero, in quotes.

    The text is "" if there are none. With `bare`, a header is not required, as for heights.
    """
    lines = layout.sentences(bare=bare)
    found = [line for line in lines if states_calibration(line) or states_raw_zero(line)]
    return " or ".join(f"'{shown(line, 50)}'" for line in dict.fromkeys(found[:_QUOTED]))


def states_calibration(line: str) -> bool:
    """Whether a line states a calibration factor for volts or counts.

    >>> stated = ("Encoder: 500 counts/mm", "1 N = 4213 counts", "Gain [N/mV]: 2.3", "2 mV/V")
    >>> [states_calibration(line) for line in (*stated, "Speed: 2 mm/s", "Supply: 5 V")]
    [True, True, True, True, False, False]
    """
    numbers = numbers_in(line)
    units = [number.unit for number in numbers] + _UNIT_OF_NAME.findall(line)
    if any("/" in unit and any(map(_RAW.fullmatch, unit.split("/"))) for unit in units):
        return True
    return any(
        _EQUALS.fullmatch(line[one.end : other.start])
        and one.unit
        and other.unit
        and bool(_RAW.fullmatch(one.unit)) != bool(_RAW.fullmatch(other.unit))
        for one, other in itertools.pairwise(numbers)
    )


def states_raw_zero(line: str) -> bool:
    """Whether a line states a zero in volts or counts, which may still be in the signal.

    >>> lines = ("Zero: 118 counts", "Offset 0.02 V (subtracted)", "Zero: 0 V", "Range: 10 V")
    >>> [states_raw_zero(line) for line in lines]
    [True, False, False, False]
    """
    raw = any(n.value and _RAW.fullmatch(n.unit) for n in numbers_in(line))
    if not raw or not part_pattern("zero").search(normalise_label(line)):
        return False
    return not (mentions("zero_taken_off", line) or mentions("zero_is_taken_off", line))
