"""Sampling rate or sampling interval, as stated in the text above a table."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.phrases import single_number
from tribolab.reading.interpret.settings import amounts_of
from tribolab.reading.lexicon.lexicon import (
    alternatives,
    key_pattern,
    normalise_label,
    part_pattern,
)
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.lvm import interval_above
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_MOST = 200  # amounts above the table that are inspected
_THOUSANDS = re.compile(r"[1-9]\d{0,2}(?:,\d{3})+")
_LABEL = re.compile(r"\W*(?P<name>[^\W\d][^:=\t;\[(]*)(?:[\[(](?P<unit>[^\[\]()]+)[\])])?")
_SAMPLE, _PER = alternatives("sample"), alternatives("per")
_PER_TIME = re.compile(
    rf"(?P<many>[kmKM]?)(?:{_SAMPLE}\.?\s*{_PER}\s*"
    rf"(?:(?P<second>{alternatives('second')})|(?P<minute>{alternatives('minute')}))\.?|[sp]ps)"
)
_EVERY = re.compile(  # "every 10th sample"
    rf"\b{alternatives('every')}\s(?!1\D)\d+(?:st|nd|rd|th|\.)\s?(?:{_SAMPLE}|points?|rows?|values?)",
    re.IGNORECASE,
)
_PER_SAMPLE = re.compile(rf"(?P<time>[mµun]?s|sec|min)\s*{_PER}\s*{_SAMPLE}\.?")
_RATE_UNITS = {"": "Hz", "k": "kHz", "m": "MHz"}  # "m" means mega, as no instrument samples at mHz


class Sampling(NamedTuple):
    """Sampling rate or interval as stated above the table, and a guess about it.

    `pattern` finds the number in the text. `unit` is a unit of frequency for a rate, of time for
    an interval, and of speed for a position. Without `has_unit` the text states none, and the
    usual unit is assumed.
    """

    pattern: str
    unit: str
    guess: str = ""
    has_unit: bool = True


def find_sampling(layout: Layout) -> Sampling | None:
    """Return the stated sampling rate or interval; None if there is none."""
    if (above := interval_above(layout)) is not None:
        return Sampling(*above)
    amounts = amounts_of(layout.text_above(bare=layout.width == 1), _MOST)
    stated = [found for value in amounts if (found := _stated(value, layout.decimal))]
    said = next((found for found in stated if found.has_unit), None)
    said = said or next(iter(stated), None) or _rate_by_first_word(amounts)
    if said is None or not (fewer := _fewer_rows(layout)):
        return said
    doubt = f"every sample is taken for a row, although the file states '{fewer}'"
    return said._replace(guess=f"{said.guess}; {doubt}" if said.guess else doubt)


def find_pace(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> Sampling | None:
    """Return the stated constant speed, e.g. of a crosshead, that gives time from a position.

    None unless the text states one speed, and the position is strictly monotonic.
    """
    names = {column.quantity for column in columns if column.used}
    way = next((c for c in columns if c.used and c.quantity == "position"), None)
    speeds = [value for value in numeric_settings(layout) if value.name == "set_speed"]
    if way is None or "sliding_velocity" in names or len(speeds) != 1 or not speeds[0].own_unit:
        return None
    edges = np.cumsum([0, *(len(block.rows) for block in layout.blocks)])
    parts = zip(edges[:-1], edges[1:], strict=True)
    goes = [np.diff(numbers[a:b, way.place - 1]) for a, b in parts]
    if not all(bool((steps > 0).all()) or bool((steps < 0).all()) for steps in goes):
        return None
    return Sampling(speeds[0].pattern, speeds[0].unit or speeds[0].own_unit or "")


def sample_rate_unit(text: str) -> str:
    """Return the unit of frequency of a text such as "samples/s"; "" for any other text.

    Examples
    --------
    >>> [sample_rate_unit(text) for text in ("pts/s", "kS/s", "échant./s", "Points per second")]
    ['Hz', 'kHz', 'Hz', 'Hz']
    >>> sample_rate_unit("samples/min"), sample_rate_unit("mm/s")
    ('1/min', '')
    """
    # in lower case without accents, but with signs such as "/"
    per = _PER_TIME.fullmatch("".join(normalise_label(sign) or sign for sign in text.strip()))
    if per is None or (per["many"] and per["minute"]):
        return ""
    return "1/min" if per["minute"] else _RATE_UNITS[per["many"].lower()]


def _fewer_rows(layout: Layout) -> str:
    """Return the line that states averaged or omitted samples; "" if there is none."""
    for line in layout.sentences():
        said = single_number(line)
        averaged = said and key_pattern("averaging").search(normalise_label(said[0]))
        if _EVERY.search(line) or (said and averaged and said[1] > 1 and said[1] % 1 == 0):
            return shown(line, 40)
    return ""


def _stated(value: Amount, decimal: str) -> Sampling | None:
    """Return the sampling rate or interval that an amount states; None if it states neither."""
    label = _LABEL.match(value.text)
    unit = (value.own_unit or (label["unit"] if label else "") or "").rstrip(".")
    by_key = sample_rate_unit(label["name"]) if label else ""
    number = re.search(value.pattern, value.text)
    if number is None or not value.number > 0:
        return None
    thousands = decimal == "." and _THOUSANDS.fullmatch(number[1])
    doubt = f"the comma in '{value.text}' parts thousands" if thousands else ""
    if rate := sample_rate_unit(unit) or ("" if unit else by_key):
        return Sampling(value.pattern, rate, doubt)
    if apart := _PER_SAMPLE.fullmatch(unit):
        return Sampling(value.pattern, apart["time"])
    interval = value.means("sampling_interval")
    if not (interval or value.means("sampling_rate")):
        return None
    if converts(unit, "Hz") or converts(unit, "s"):
        return Sampling(value.pattern, unit, doubt)
    kind, si_unit = ("interval of samples", "s") if interval else ("sample rate", "Hz")
    guess = f"'{value.text}' is the {kind} in {si_unit}"
    return None if unit else Sampling(value.pattern, si_unit, guess, has_unit=False)


def _rate_by_first_word(amounts: Amounts) -> Sampling | None:
    """Return the only frequency whose name begins with "sampling" or the like, even if misspelt.

    File: "Sampling fequency [Hz]" (liampond/EgbertsTribometer).
    """
    taken = part_pattern("taken")
    rates = [v for v in amounts if v.is_in("Hz") and taken.match(v.key)]
    return Sampling(rates[0].pattern, rates[0].unit or "Hz") if len(rates) == 1 else None
