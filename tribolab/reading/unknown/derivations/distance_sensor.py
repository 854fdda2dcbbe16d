"""Heights that a distance sensor took on its way, by the clock or by an encoder.

No run: what moves is the sensor, so nobody has to say which column holds the friction.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.errors import shown
from tribolab.reading.interpret.names import KNOWN_WORD, length_unit, matches
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.header.counts import calibration_factor
from tribolab.reading.unknown.header.profiles import (
    find_traverse_speed,
    pitch_of_clock,
    seconds_apart,
)
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units import conversion

_LONGEST = 300  # characters of a line that are looked at
_MOST_COLUMNS = 12
# what a file says of itself that holds a profile, if nothing in it is a force
_OF_PROFILES = re.compile(
    r"(?i)(?<!speed )(?<!velocity )(?<!load )(?<!motion )(?<!force )(?:profil(?!e name))|профил"
    r"|rough(?!ly)|rauh?(?:eit|igk)|rugos|ruwheid|ruvid|chropowat|drsnost|шерохов|粗[さ糙]|輪郭|轮廓"
    r"|con?foca|konfokal|конфокал|共焦|triangulat|triangolaz|topogra(?:ph|f)|chromatic|chromatisch"
    r"|stylus|tastschnitt|tastspitze|palpeur|palpador|tastatore|щуп"
    r"|(?:displacement|distance|laser)[- ](?:sensor|head|gauge|scan)|(?:weg|abstands|laser)sensor"
    r"|変位|变位|位移传感|変位計|surface scan|scan of"
)
_OF_RUNS = {
    *("friction_force", "normal_force", "friction_coefficient", "sliding_velocity"),
    *("rotation_speed", "shear_stress", "normal_stress", "film_thickness"),
}
_WEAR = re.compile(r"wear|verschleiss|usura|usure|desgaste|износ|zuzyci|opotreb|slit|磨[损耗損]")
_ALONG = re.compile(
    r"enc(?:oder)?$|^enc|encoder|stage|axis|slitta|schlitten|achse|carriage|position|posizione|lateral"
    r"|quer|^x$|^x[a-z]?(?:pos|achse)|weg$|track|riga|massstab|энкодер|编码|エンコーダ"
)
_HEIGHT_LINE = re.compile(
    r"(?i)(?<![^\W\d])z(?![^\W\d])|height|höhe|altezz|hauteur|sensor|probe|gauge|taster|palp|щуп|датчик"
    r"|confoc|konfok|laser|adc|ацп|a/d|输出|出力"
)
_LENGTH = r"(?P<number>\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)\s?(?P<unit>[^\W\d_]{1,3})"
_PER_VOLT = re.compile(rf"(?<![\d.,]){_LENGTH}\s?(?:/|per|pro|je|par|a|por)\s?(?P<per>m?V)(?!\w)")
_VOLT_IS = re.compile(rf"(?<![\d.,])1\s?(?P<per>m?V)\s?(?:=|≙|->|→|:|is)\s?{_LENGTH}(?![^\W_])")
# "цена единицы АЦП 12,5 нм", "ADC resolution: 12.5 nm", "value of one digit 12.5 nm"
_COUNT = re.compile(
    r"(?i)digit|count|\blsb\b|\bad[cu]\b|a/d|ацп|\bбит|\bкод|единиц|делени|разряд|отсч|quant|inkrement|increment"
    r"|\bbits?\b|punto di conversione|conteggi|conteo|impuls|cuenta|字|码|カウント|デジット"
)
_ALONE = re.compile(rf"(?<![\d.,]){_LENGTH}(?![^\W_])(?!\s?/)")
_RAW = re.compile(
    r"raw|adc|count|cts|digit|lsb|roh|brut|grezz|crudo|bruto|surow|生|原始|码|код|ацп|conteggi|wert|value"
)
_STILL = 0.1  # of the largest scatter: a column that moves less stands still
_REFERENCE = "another distance, which stands still beside the height"
_LARGEST_COUNT = 1e-3  # m that one count may be worth


class Sensed(NamedTuple):
    """A sensor's columns: positions where an encoder gives them, else the distance of points.

    `lacks` says what is missing of a distance, where the clock alone tells the points apart.
    """

    columns: list[DraftColumn]
    pitch: str = ""
    lacks: str = ""


class _Height(NamedTuple):
    """A column that may hold the heights: its unit, whether to say it, whether its name says so."""

    column: DraftColumn
    unit: str
    say: bool
    named: bool


def of_sensor(layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray) -> Sensed | None:
    """Understand a table as what a distance sensor took on its way; None where it may be a run.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    columns
        With their names and units.
    numbers
        Their numbers (rows, columns) as written.
    """
    if not 2 <= len(columns) <= _MOST_COLUMNS or len(numbers) < 3:
        return None
    if _is_run(columns) or _is_map(columns):
        return None
    lines = [line[:_LONGEST] for line in layout.text_above(bare=True)]
    clock = next((column for column in columns if _quantity(column) == "time"), None)
    volts, digits = _worth_of_volt(lines), _worth_of_count(lines)
    speed = find_traverse_speed(layout)
    told = any(map(_OF_PROFILES.search, (layout.file.path.stem, *lines)))
    if not (told or volts or speed):
        return None
    way = _way(columns, numbers, lines)
    others = [column for column in columns if column not in (clock, way)]
    heights = [h for column in others if (h := _height(column, numbers, volts, digits))]
    if not heights or (clock is None and way is None):
        return None
    chosen, rivals = _chosen(heights, numbers)
    guessed = ("of several distances it is the height",) if rivals else ()
    height = chosen.column._replace(
        quantity="height",
        unit=chosen.unit if chosen.say else chosen.column.unit,
        counted=False,
        used=True,
        guessed=guessed,
        options=tuple(f"column {rival.column.place}" for rival in rivals),
    )
    result = {height.place: height}
    for other in heights:
        if other is not chosen and other not in rivals:
            result[other.column.place] = other.column._replace(note=_REFERENCE)
    pitch = lacks = ""
    if way is not None:
        result[way.place] = way
    elif clock is not None:
        time = conversion(bare_name(clock)[1] or "s", "s")[0] * numbers[:, clock.place - 1]
        pitch = pitch_of_clock(layout, time, of_sensor=told or volts is not None)
        note = "its interval and how fast the sensor goes make the distance of points"
        result[clock.place] = clock._replace(unit=bare_name(clock)[1], note=note)
        step = seconds_apart(time)
        if not pitch and step:
            lacks = (
                f"the traverse speed: heights stand in it every {1e3 * step:.4g} ms, and how far "
                'the sensor goes meanwhile is the distance of points, pitch = "(a length)" in '
                "its description"
            )
        elif not pitch:
            return None
    return Sensed([result.get(column.place, column) for column in columns], pitch, lacks)


def _is_map(columns: Sequence[DraftColumn]) -> bool:
    """Whether columns are named as those of a map: x, y and z, whatever sensor took it."""
    options = [matches(*bare_name(column)[:2], scan=True) for column in columns]
    return {"x", "y", "height"} <= {some[0].quantity for some in options if some}


def _quantity(column: DraftColumn) -> str:
    name, unit, _ = bare_name(column)
    options = matches(name, unit)
    return options[0].quantity if options else ""


def _is_run(columns: Sequence[DraftColumn]) -> bool:
    """Whether a column is surely of a run, or of a profile whose positions it names itself."""
    for column in columns:
        name, unit, _ = bare_name(column)
        options = matches(name, unit)
        if options and options[0].quantity in _OF_RUNS and options[0].score >= KNOWN_WORD:
            return True
        if unit is not None and any(converts(unit, si) for si in ("N", "N m", "rad/s", "m/s")):
            return True
    return False


def _way(
    columns: Sequence[DraftColumn], numbers: np.ndarray, lines: Sequence[str]
) -> DraftColumn | None:
    """Return the column of positions along the way: an encoder's counts, or a length."""
    for column in columns:
        name, unit, say = bare_name(column)
        values = numbers[:, column.place - 1]
        if not _ALONG.search(normalise_label(name)) or not np.nanmax(np.abs(np.diff(values))) > 0:
            continue
        if unit is not None and converts(unit, "m"):
            return column._replace(
                quantity="x", unit=unit if say else column.unit, used=True, note=""
            )
        worths = [
            said for line in lines if (said := calibration_factor(line)) and converts(said, "m")
        ]
        own = [
            said
            for line in lines
            if not _HEIGHT_LINE.search(line) or _ALONG.search(normalise_label(line))
            if (said := calibration_factor(line)) and converts(said, "m")
        ]
        if (unit is None or column.counted) and (own or worths):
            taken = (own or worths)[0]
            return column._replace(
                quantity="x", unit=taken, counted=True, used=True, note="", fill_in=""
            )
    return None


def _height(
    column: DraftColumn, numbers: np.ndarray, volts: tuple[float, str] | None, digits: str
) -> _Height | None:
    """Return a column as one of heights, with the unit that it is read in."""
    name, unit, say = bare_name(column)
    key = normalise_label(name)
    values = numbers[:, column.place - 1]
    present = values[np.isfinite(values)]
    if present.size < 3 or not np.ptp(present) > 0 or _WEAR.search(key):
        return None
    steps = np.diff(present)
    if (steps == steps[0]).all():  # a number of rows
        return None
    options = matches(name, unit, scan=True)
    named = bool(options and options[0].quantity == "height" and options[0].score >= KNOWN_WORD)
    if unit is not None and converts(unit, "m"):
        return _Height(column, unit, say, named)
    if unit is not None and converts(unit, "V") and volts is not None:
        worth = volts[0] * conversion(unit, "V")[0]
        return _Height(column, f"{worth:.9g} {volts[1]}", True, named)
    if (unit is None or column.counted) and digits and _RAW.search(key):
        return _Height(column, digits, True, True)
    return None


def _chosen(heights: list[_Height], numbers: np.ndarray) -> tuple[_Height, list[_Height]]:
    """Return the heights, and what may be them instead; what hardly moves is a reference."""
    if sum(height.named for height in heights) == 1:
        return next(height for height in heights if height.named), []
    moves = [_scatter(h, numbers[:, h.column.place - 1]) for h in heights]
    moving = [h for h, own in zip(heights, moves, strict=True) if own > _STILL * max(moves)]
    moving = moving or heights
    return moving[0], moving[1:]


def _scatter(height: _Height, values: np.ndarray) -> float:
    """Return how much a column moves in steps of a few rows [m]: a drift is no surface."""
    present = values[np.isfinite(values)]
    level = np.polynomial.Polynomial.fit(np.arange(present.size), present, 1)
    rest = present - level(np.arange(present.size))
    low, high = np.percentile(rest, [5, 95])
    return float((high - low) * abs(conversion(height.unit, "m")[0]))


def _worth_of_volt(lines: Sequence[str]) -> tuple[float, str] | None:
    """Return the length that a volt is worth, if the lines state just one: "30 um/V"."""
    found = set()
    for line in lines:
        for said in (*_PER_VOLT.finditer(line), *_VOLT_IS.finditer(line)):
            if unit := length_unit(said["unit"]):
                number = float(said["number"].replace(",", "."))
                found.add((number * (1e3 if said["per"] == "mV" else 1.0), unit))
    return found.pop() if len(found) == 1 else None


def _worth_of_count(lines: Sequence[str]) -> str:
    """Return the length that a count of the height is worth, if just one line states it, or ""."""
    found = set()
    for line in lines:
        if not _COUNT.search(line) or _ALONG.search(normalise_label(line)):
            continue
        if (said := calibration_factor(line)) and converts(said, "m"):
            found.add(said)
            continue
        alone = [m for m in _ALONE.finditer(line) if length_unit(m["unit"])]
        if len(alone) == 1:
            number = float(alone[0]["number"].replace(",", "."))
            unit = length_unit(alone[0]["unit"])
            if 0 < number * conversion(unit, "m")[0] < _LARGEST_COUNT:
                found.add(f"{number:.9g} {unit}")
    return found.pop() if len(found) == 1 else ""


# "0 V = signal lost", "-FFFFFFF: out of range" (which is text, and told by itself)
_LOST = (
    r"lost|no signal|out of range|invalid|pers[oa]|fuori (?:scala|campo)|nessun segnale|verloren"
    r"|kein signal|ung(?:ü|ue)ltig|perdu|pas de signal|perdid|sin señal|sem sinal|geen signaal"
    r"|brak sygna|utracon|потер|нет сигнал|bez sign|无信号|丢失|信号なし|測定不可|missing|no data"
)
_VALUE_IS_LOST = re.compile(
    rf"(?i)(?<![\d.,+/\w])(?P<number>[-+]?\d+(?:[.,]\d+)?)\s?(?:m?V|[nuµμ]m|mm|counts?|digits?)?\s?"
    rf"(?:=|≙|->|→|:|means?|bedeutet|is|ist)\s?(?:[^\W\d]+\s){{0,2}}(?:{_LOST})"
)
_LOST_IS_VALUE = re.compile(
    rf"(?i)(?:{_LOST})(?:\s[^\W\d]+){{0,2}}\s?(?:=|≙|->|→|:|as)\s?(?P<number>[-+]?\d+(?:[.,]\d+)?)"
    r"(?![\d.,]*\s?%)"
)


def lost_values(lines: Sequence[str]) -> list[tuple[str, float]]:
    """Return numbers that lines say to stand for a lost signal, with what they say.

    >>> lost_values(["confocal sensor: 30 um/V (0 V = signal lost)"])
    [('no value: 0 V = signal lost', 0.0)]
    """
    found = []
    for line in (line[:_LONGEST] for line in lines):
        for said in (*_VALUE_IS_LOST.finditer(line), *_LOST_IS_VALUE.finditer(line)):
            number = float(said["number"].replace(",", "."))
            found.append((f"no value: {shown(said[0], 40)}", number))
    return found
