"""Lines above a table with the calibration or the zero of a signal in volts or counts.

They are quoted when a person is asked for it.
"""

from __future__ import annotations

import itertools
import re

from tribolab.core.errors import shown
from tribolab.reading.lexicon.lexicon import alternatives, mentions, normalise_label, part_pattern
from tribolab.reading.numbers import numbers_in
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.units.spellings import MICRO

_MAX_LINE = 200  # characters of a line that are looked at
_QUOTED = 3
_RAW = re.compile(rf"[mk{MICRO}u]?V|{alternatives('count')}", re.IGNORECASE)
_EQUALS = re.compile(rf"\s?{alternatives('equals')}\s?", re.IGNORECASE)
_UNIT_OF_NAME = re.compile(r"[\[(](\w{1,12}/\w{1,12})[\])]")


def calibration_lines(layout: Layout, *, bare: bool = False) -> str:
    """Quote the lines with a calibration of volts or counts, or its zero; "" without any.

    With `bare`, heights are meant, which may have no header.
    """
    lines = [line[:_MAX_LINE].strip() for line in layout.text_above(bare=bare)]
    found = [line for line in lines if states_calibration(line) or states_raw_zero(line)]
    return " or ".join(f"'{shown(line, 50)}'" for line in dict.fromkeys(found[:_QUOTED]))


def states_calibration(line: str) -> bool:
    """Whether a line states the calibration of a volt or a count.

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
