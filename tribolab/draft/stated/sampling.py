"""The sample rate, or the interval of samples, that the text before a table states."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.draft.file.layout import Layout
from tribolab.draft.file.lvm import interval_above
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.settings import numeric_settings
from tribolab.draft.words.stated_words import INTERVAL, RATE
from tribolab.errors import shown
from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label

# "# Cadence d'acquisition : 1000 pts/s", "Rate (kS/s) = 1"; "1000 samples per second" alone
_GROUPS = r"[1-9]\d{0,2}(?:[ \u00a0\u202f']\d{3})+"  # 1 000
_NUMBER = rf"(?P<number>{_GROUPS}|\d[\d.,]*(?:e[-+]?\d+)?)"
_UNIT = r"[\[(]?(?P<unit>(?:1/)?[^\W\d][^\d;\t,\[\]()]*(?:\^?-1)?)?[\])]?"
_STATES = re.compile(
    rf"(?P<before>\W*(?P<key>[^\W\d][^:=\t;]*?)\s*[:=\t;]+\s*){_NUMBER}[\s;]*{_UNIT}[\s;,]*$",
    re.IGNORECASE,
)
_ALONE = re.compile(rf"(?P<before>\W*){_NUMBER}\s*{_UNIT}[\s;,]*$", re.IGNORECASE)
_SOME_SAMPLES = re.compile(
    r"\W*(?P<key>[^\W\d][^:=\t;,\d]{0,60}?)\s*[:=\t;, ]\s*[x×]?\s?(?P<number>\d{1,6})"
    r"\s*(?:[x×]|[^\W\d]{1,12})?\W*$"
)
_AVERAGES = re.compile(
    r"(?:data|signal|samples?)?(?:averag(?:e|es|ed|ing)|mittelung|mittelwerte|moyennage|promedios?"
    r"|decimation|dezimierung|downsampling|oversampling|undersampling|subsampling|datareduction)"
    r"(?:over|of|factor|faktor|facteur|samples?|points?|count|number|n)*"
)
_LONGEST = 200  # characters of a line that are looked at
_BRACKET = re.compile(r"[\[(]([^\[\]()]+)[\])]\s*$")
# a sample in the languages of laboratories, as it is written in a unit
_SAMPLE = (
    r"(?:s|sa|smp|smpl|spl|samples?|pts?|points?|punkte?|pkt|werte?|messwerte?|mesures?|ech|ech\w*"
    r"|muestras?|puntos?|datos?|campion[ei]|punti|letture|amostras?|pontos?|punten|monsters"
    r"|scans?|readings?|data(?:points?)?|probek|probki|punktow|vzork\w*|отсч\w*|точек|точки|выборок"
    r"|点|个|样点|サンプル|データ)"
)
_TIME = (
    r"(?:(?P<second>s|sec|secs|seconds?|sek|sekunden?|seconde|segundo|secondo|sekund\w*|с|сек|秒)"
    r"|(?P<minute>min|minutes?|minuten?|minuto|мин|分))"
)
_PER_TIME = re.compile(
    rf"(?P<many>[kmKM]?){_SAMPLE}\.?\s*(?:/|per|par|pro|por|al|p\.|na|в|每)\s*{_TIME}\.?"
)
_SHORT = re.compile(r"(?P<many>[kmKM]?)(?:sps|pps)", re.IGNORECASE)
_PER_SAMPLE = re.compile(rf"(?P<time>[mµun]?s|sec|min)\s*(?:/|per|par|pro|por)\s*{_SAMPLE}\.?")
_MANY = {"": "Hz", "k": "kHz", "m": "MHz"}  # nobody takes a sample in a thousand seconds


class Sampling(NamedTuple):
    """What the text before the table says of the distance of samples, and what of it is guessed.

    `pattern` finds the number; `unit` is one of frequency, or of time where it is an interval, and
    may be taken for what a rate is usually in (`has_unit` False).
    """

    pattern: str
    unit: str
    guess: str = ""
    has_unit: bool = True


def find_sampling(layout: Layout) -> Sampling | None:
    """Return the sample rate, or the interval of samples, before the table; None if there is none.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    if (above := interval_above(layout)) is not None:
        return Sampling(*above)
    said = _stated(layout)
    if said is None or not (fewer := _fewer_rows(layout)):
        return said
    doubt = f"every sample is taken for a row, although the file states '{fewer}'"
    return said._replace(guess=f"{said.guess}; {doubt}" if said.guess else doubt)


def _fewer_rows(layout: Layout) -> str:
    """Return the line that says that several samples are averaged or left out; "" if none does."""
    for line in layout.text_above():
        said = _SOME_SAMPLES.match(line.strip()[:_LONGEST])
        if said and int(said["number"]) > 1 and _AVERAGES.fullmatch(normalise_label(said["key"])):
            return shown(line.strip(), 40)
    return ""


def _stated(layout: Layout) -> Sampling | None:
    guessed = None
    for line in layout.text_above(bare=layout.width == 1):
        if (said := _of_line(line.rstrip(), layout.decimal)) is None:
            continue
        if said.has_unit:
            return said
        guessed = guessed or said
    return _in_values(layout) or guessed


def find_pace(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> Sampling | None:
    """Return the speed at which a position goes on that holds the time: a crosshead's.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
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
    speed = speeds[0]
    return Sampling(speed.pattern, speed.unit or speed.own_unit or "")


def _in_values(layout: Layout) -> Sampling | None:
    """Return what stands in a sentence or among other values of a line."""
    for value in numeric_settings(layout):
        interval = INTERVAL.search(value.key) is not None
        if value.source != "preamble" or not (interval or RATE.search(value.key)):
            continue
        unit = value.unit or value.own_unit
        if unit and any(converts(unit, si_unit) for si_unit in ("Hz", "s")):
            return Sampling(value.pattern, unit)
        if unit is None:
            return _without_unit(value.pattern, value.text, interval=interval)
    return None


def _without_unit(pattern: str, text: str, *, interval: bool) -> Sampling:
    kind, si_unit = ("interval of samples", "s") if interval else ("sample rate", "Hz")
    return Sampling(pattern, si_unit, f"'{text}' is the {kind} in {si_unit}", has_unit=False)


def _of_line(line: str, decimal: str) -> Sampling | None:
    """Return what a line of one value states of the samples."""
    said = _STATES.match(line) or _ALONE.match(line)
    if said is None:
        return None
    key = said.groupdict().get("key") or ""
    bracket = _BRACKET.search(key)
    unit = (said["unit"] or "").strip() or (bracket[1].strip() if bracket else "")
    name = normalise_label(_BRACKET.sub("", key))
    digits = rf"({_GROUPS}|[-+\d.,]+(?:[eE][-+]?\d+)?)"
    pattern = r"^\s*" + escaped(said["before"].strip()) + rf"\s*{digits}"
    if not said["before"].strip():  # a number alone is found by what stands behind it
        pattern = rf"^\s*{digits}\s*{escaped(unit)}"
    thousands = ""
    if decimal == "." and re.fullmatch(r"[1-9]\d{0,2}(?:,\d{3})+", said["number"]):
        thousands = f"the comma in '{line.strip()}' parts thousands"
    by_key = sample_rate_unit(_BRACKET.sub("", key))
    if rate := sample_rate_unit(unit) or ("" if unit else by_key):
        return Sampling(pattern, rate, thousands)
    if not name:
        return None
    interval = INTERVAL.search(name) is not None
    if apart := _PER_SAMPLE.fullmatch(unit):
        return Sampling(pattern, apart["time"])
    unit = unit.rstrip(".")
    if not (interval or by_key or RATE.search(name)):
        return None
    if unit and any(converts(unit, si_unit) for si_unit in ("Hz", "s")):
        return Sampling(pattern, unit, thousands)
    return None if unit else _without_unit(pattern, line.strip(), interval=interval)


def sample_rate_unit(text: str) -> str:
    """Return the unit of frequency that a text of samples per time means; "" if it means none.

    Examples
    --------
    >>> [sample_rate_unit(text) for text in ("pts/s", "kS/s", "échant./s", "Points per second")]
    ['Hz', 'kHz', 'Hz', 'Hz']
    >>> sample_rate_unit("samples/min"), sample_rate_unit("mm/s")
    ('1/min', '')
    """
    plain = squeezed_signs(text)
    if short := _SHORT.fullmatch(plain):
        return _MANY[short["many"].lower()]
    per = _PER_TIME.fullmatch(plain)
    if per is None or per["many"] and per["minute"]:
        return ""
    return _MANY[per["many"].lower()] if per["second"] else "1/min"


def squeezed_signs(text: str) -> str:
    """Return a text without accents and capitals, but with its signs.

    >>> squeezed_signs("Échant./s")
    'echant./s'
    """
    return "".join(normalise_label(sign) or sign for sign in text.strip())
