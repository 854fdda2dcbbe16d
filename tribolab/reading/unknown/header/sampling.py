"""The sample rate, or the interval of samples, that the text before a table states."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.phrases import single_number
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import (
    alternatives,
    key_pattern,
    normalise_label,
    part_pattern,
)
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.lvm import interval_above
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

# "# Cadence d'acquisition : 1000 pts/s", "Rate (kS/s) = 1"; "1000 samples per second" alone
_GROUPS = r"[1-9]\d{0,2}(?:[ \u00a0\u202f']\d{3})+"  # 1 000
_STATES = re.compile(
    r"(?P<before>\W*(?:(?P<key>[^\W\d][^:=\t;]*?)\s*[:=\t;]+\s*)?)"
    rf"(?P<number>{_GROUPS}|\d[\d.,]*(?:e[-+]?\d+)?)[\s;]*"
    r"[\[(]?(?P<unit>(?:1/)?[^\W\d][^\d;\t,\[\]()]*(?:\^?-1)?)?[\])]?[\s;,]*$",
    re.IGNORECASE,
)
_MAX_LINE = 200  # characters of a line that are looked at
_BRACKET = re.compile(r"[\[(]([^\[\]()]+)[\])]\s*$")
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
_RATE_UNITS = {"": "Hz", "k": "kHz", "m": "MHz"}  # nobody takes a sample in a thousand seconds


class Sampling(NamedTuple):
    """Sampling as stated above the table, and the parts of it that are guessed.

    `pattern` finds the number; `unit` is one of frequency, or of time if it is an interval, and
    may be taken for what a rate is usually in (`has_unit` False).
    """

    pattern: str
    unit: str
    guess: str = ""
    has_unit: bool = True


def find_sampling(layout: Layout) -> Sampling | None:
    """Return the stated sample rate, or interval of samples; None if there is none."""
    if (above := interval_above(layout)) is not None:
        return Sampling(*above)
    lines = layout.text_above(bare=layout.width == 1)
    stated = [found for line in lines if (found := _of_line(line.rstrip(), layout.decimal))]
    said = next((found for found in stated if found.has_unit), None)
    said = said or _in_amounts(layout) or next(iter(stated), None)
    if said is None or not (fewer := _fewer_rows(layout)):
        return said
    doubt = f"every sample is taken for a row, although the file states '{fewer}'"
    return said._replace(guess=f"{said.guess}; {doubt}" if said.guess else doubt)


def find_pace(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> Sampling | None:
    """Return the speed of a position that gives the time, such as a crosshead's.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    columns
        As they are understood, without a time.
    numbers
        Their numbers (rows, columns) as written.

    Returns
    -------
    Sampling or None
        None unless the text states one speed, and the position does nothing but go on.
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
    """Return the unit of frequency that a text of samples per time means; "" if it means none.

    Parameters
    ----------
    text
        A unit, or what a file calls a rate.

    Examples
    --------
    >>> [sample_rate_unit(text) for text in ("pts/s", "kS/s", "échant./s", "Points per second")]
    ['Hz', 'kHz', 'Hz', 'Hz']
    >>> sample_rate_unit("samples/min"), sample_rate_unit("mm/s")
    ('1/min', '')
    """
    # without accents and capitals, but with its signs
    per = _PER_TIME.fullmatch("".join(normalise_label(sign) or sign for sign in text.strip()))
    if per is None or (per["many"] and per["minute"]):
        return ""
    return "1/min" if per["minute"] else _RATE_UNITS[per["many"].lower()]


def _fewer_rows(layout: Layout) -> str:
    """Return the line on averaged or omitted samples; "" if there is none."""
    for line in layout.text_above():
        if _EVERY.search(line[:_MAX_LINE]):
            return shown(line.strip(), 40)
        said = single_number(line.strip()[:_MAX_LINE])
        averaged = said and key_pattern("averaging").search(normalise_label(said[0]))
        if said and averaged and said[1] > 1 and said[1] % 1 == 0:
            return shown(line.strip(), 40)
    return ""


def _in_amounts(layout: Layout) -> Sampling | None:
    """Return a value within a sentence or among other numbers of a line."""
    concepts = "sampling_interval", "sampling_rate"
    for value in numeric_settings(layout).of(*concepts, source="preamble"):
        if value.is_in("Hz") or value.is_in("s"):
            return Sampling(value.pattern, value.unit or value.own_unit or "")
        if value.own_unit is None:
            interval = value.means("sampling_interval")
            return _without_unit(value.pattern, value.text, interval=interval)
    taken = part_pattern("taken")  # "Sampling fequency [Hz]" (liampond/EgbertsTribometer)
    rates = [v for v in numeric_settings(layout) if v.is_in("Hz") and taken.match(v.key)]
    return Sampling(rates[0].pattern, rates[0].unit or "Hz") if len(rates) == 1 else None


def _without_unit(pattern: str, text: str, *, interval: bool) -> Sampling:
    kind, si_unit = ("interval of samples", "s") if interval else ("sample rate", "Hz")
    return Sampling(pattern, si_unit, f"'{text}' is the {kind} in {si_unit}", has_unit=False)


def _of_line(line: str, decimal: str) -> Sampling | None:
    """Return what a line of one value states of the samples."""
    said = _STATES.match(line)
    if said is None:
        return None
    key = said["key"] or ""
    bracket = _BRACKET.search(key)
    unit = (said["unit"] or "").strip() or (bracket[1].strip() if bracket else "")
    bare = _BRACKET.sub("", key)
    name = normalise_label(bare)
    digits = rf"({_GROUPS}|[-+\d.,]+(?:[eE][-+]?\d+)?)"
    pattern = r"^\s*" + escaped(said["before"].strip()) + rf"\s*{digits}"
    if not said["before"].strip():  # a number alone is found by the text after it
        pattern = rf"^\s*{digits}\s*{escaped(unit)}"
    thousands = ""
    if decimal == "." and re.fullmatch(r"[1-9]\d{0,2}(?:,\d{3})+", said["number"]):
        thousands = f"the comma in '{line.strip()}' parts thousands"
    by_key = sample_rate_unit(bare)
    if rate := sample_rate_unit(unit) or ("" if unit else by_key):
        return Sampling(pattern, rate, thousands)
    if not name:
        return None
    if apart := _PER_SAMPLE.fullmatch(unit):
        return Sampling(pattern, apart["time"])
    unit = unit.rstrip(".")
    interval = key_pattern("sampling_interval").search(name) is not None
    if not (interval or by_key or key_pattern("sampling_rate").search(name)):
        return None
    if converts(unit, "Hz") or converts(unit, "s"):
        return Sampling(pattern, unit, thousands)
    return None if unit else _without_unit(pattern, line.strip(), interval=interval)
