"""Quantities that a column name may mean, and units at the end of names."""

from __future__ import annotations

import functools
import re
from typing import NamedTuple

from tribolab.reading.lexicon.lexicon import (
    Word,
    alternatives,
    key_pattern,
    keys_of,
    known_words,
    names,
    normalise_label,
    part_pattern,
    role_of,
    without_role,
)
from tribolab.reading.unit_texts import converts, is_turns, is_unit
from tribolab.units.quantities import quantity
from tribolab.units.spellings import WEIGHTS, unit_in_words

_VAGUE = 0.6  # factor on the score of a word that several quantities share
_OF_DEVICE = 0.98  # factor on the score of a name without its device: "Fz" of "DAQ.Fz"
_TERM = 0.98  # score of a name that is a complete term: "normal force", "Reibkraft"
_LATE = 0.2  # largest reduction of the score of a symbol that is late in the list
KNOWN_WORD = 0.7  # lowest score of a name whose meaning is certain
# "Stage.X", "DAQ.Fz": letters on both sides of the last point
_DEVICE = re.compile(r"(?P<device>.*[^\W\d]\w*)\.(?P<name>[^\W\d].*)$")
_ACROSS = re.compile(r"(?:^|[\s_.\-])z(?:$|[\s_.\-])", re.IGNORECASE)
_INSTEAD = {"position": "height_displacement"}
_ANGLES = ("deg", "rad", "°")
_MAX_NAME = 1000  # characters of a name, as searches take quadratic time
_WIDE_BRACKETS = re.compile(r"^(?P<name>.+?)\s*[（［【](?P<unit>[^（）［］【】]+)[）］】]$")
# by SI unit of the quantity, units to be read as another unit: g of a force is gf
_MEANT = {"N": WEIGHTS}
_OF_HEIGHTS = {"m": {"A": "angstrom"}}
_NO_TORQUE = ("N", "1", "Pa")
COUNTS = "counts"
# names of time columns that are only a unit, e.g. from microcontroller clocks
_CLOCKS = {"millis": "ms", "msec": "ms", "msecs": "ms", "ms": "ms", "micros": "us", "usec": "us"}
_CLOCKS |= {"usecs": "us", "mus": "us", "sec": "s", "secs": "s"}
_RPM = re.compile(r"(?<![^\W_])rpm(?![^\W_])", re.IGNORECASE)  # a name that is its unit: "rpm_set"
_NUMBERED = re.compile(r"#?\s*(?:N[°ºr]|No|№)\.?", re.IGNORECASE)  # row numbers, not rotation
# a set speed is not the actual speed
_AS_SET = {"sliding_velocity": "set_speed", "normal_force": "set_normal_force"}


_SYMBOLS = frozenset(
    symbol for word in (*known_words("run"), *known_words("scan")) for symbol in word.symbols
)


class Match(NamedTuple):
    """Quantity that a column name may mean; a higher score is more certain."""

    quantity: str
    score: float
    unit: str | None  # unit to read instead of the written one: gf for g


def device_of(name: str) -> tuple[str, str]:
    """Split a channel name into the device, which some programs prepend, and the rest.

    >>> device_of("DAQ.Fz"), device_of("Coeff. of friction"), device_of("Fz")
    (('DAQ', 'Fz'), ('', 'Coeff. of friction'), ('', 'Fz'))
    """
    parts = _DEVICE.match(name.strip()) if len(name) <= _MAX_NAME else None
    return (parts["device"], parts["name"]) if parts else ("", name)


def is_axis(name: str) -> bool:
    """Whether a column name means the position of a machine axis: 'Stage.X', 'X axis position'.

    >>> is_axis("XYStage.X"), is_axis("Position")
    (True, False)
    """
    device, own = device_of(name)
    return bool(part_pattern("machine_axis").search(normalise_label(device or own)))


_ABOUT_UNIT = re.compile(r"(?<=\w)\s{0,3}\([^()]{1,30}\)\s*$")  # "uin (microinch)"


def length_unit(text: str) -> str:
    """Return the standard notation of a text that is only a unit of length; else "".

    >>> length_unit("[nm]"), length_unit("Mikrometer"), length_unit("nm per step")
    ('nm', 'um', '')
    >>> length_unit("uin (microinch)")
    'uin'
    """
    text = _ABOUT_UNIT.sub("", text)
    bare = text.strip(" \t[](){}.,;\"'")
    unit = unit_in_words(bare)
    for spelt in (unit, unit.lower()) if unit != "Mm" else ("mm",):
        if converts(spelt, "m"):
            return spelt
    return ""


_GAPS = re.compile(rf"\s+{alternatives('in')}\s+|[\s_/,]+")
_PER = re.compile(r"[\s_]+per[\s_]+|(?<=[mN°])_(?=(?:s|min|h)$)")  # mm_per_s, mm_s


@functools.lru_cache(maxsize=4096)
def split_unit(label: str) -> tuple[str, str | None]:
    """Split a column name without brackets from the unit at its end: 'Lateral um', 'Force/N'.

    >>> split_unit("Lateral um"), split_unit("F_x"), split_unit("Force/N")
    (('Lateral', 'um'), ('F_x', None), ('Force', 'N'))
    >>> split_unit("Hauteurs en µm")
    ('Hauteurs', 'µm')
    >>> split_unit("speed_um_per_s"), split_unit("speed_mm_s")
    (('speed', 'um/s'), ('speed', 'mm/s'))
    >>> split_unit("Zeit（s）")
    ('Zeit', 's')
    >>> split_unit("angle_deg")
    ('angle', 'deg')
    >>> split_unit("rpm_set"), split_unit("Basic")
    (('rpm_set', 'rpm'), ('Basic', None))
    """
    if len(label) > _MAX_NAME:
        return label, None
    wide = _WIDE_BRACKETS.match(label.strip())
    if wide and is_unit(wide["unit"].strip()):
        return wide["name"], wide["unit"].strip()
    if "_" not in label and normalise_label(label) in _CLOCKS:  # "mu_s" is no µs
        return "time", _CLOCKS[normalise_label(label)]
    if _RPM.fullmatch(label.strip()):
        return label, "rpm"
    if normalise_label(label) in _SYMBOLS or _is_ratio(label):
        return _symbol_and_unit(label) or (label, None)
    for gap in _GAPS.finditer(label.strip()):
        name, unit = label.strip()[: gap.start()], label.strip()[gap.end() :]
        unit = _PER.sub("/", unit)
        unit = unit_in_words(unit)
        for text in (unit, unit.lower() if len(unit) > 3 else unit):
            # a dimensionless ending belongs to the name: "N/N" in "F_N/N"
            unitless = converts(text, "1") and text != "%"
            if name and ((not unitless and is_unit(text)) or text in _ANGLES):
                return name, text
    if _RPM.search(label):
        return label, "rpm"
    return label, None


def _symbol_and_unit(label: str) -> tuple[str, str] | None:
    """Split a symbol from its unit, even if together they look like a ratio: Ff_N is not F/Fn.

    A unit may follow a slash, as in ISO 80000-1.

    >>> _symbol_and_unit("Ff_N"), _symbol_and_unit("F_N"), _symbol_and_unit("t_s")
    (('Ff', 'N'), None, ('t', 's'))
    >>> _symbol_and_unit("Ff/N"), _symbol_and_unit("F / N"), _symbol_and_unit("Fx/Fz")
    (('Ff', 'N'), ('F', 'N'), None)
    >>> _symbol_and_unit("mu / %"), _symbol_and_unit("COF in %")
    (('mu', '%'), ('COF', '%'))
    """
    percent = re.fullmatch(r"(.*?[^\s/])\s*(?:/|\bin\b)?\s*%", label.strip())
    if percent:
        return percent[1], "%"
    name, _, unit = (part.strip() for part in label.rpartition("/"))
    if name and is_unit(unit) and not converts(unit, "1"):
        return name, unit
    name, _, unit = label.strip().rpartition("_")
    meant = [word.quantity for word in known_words("run") if normalise_label(name) in word.symbols]
    fits = any(converts(unit, quantity(q).unit) for q in meant if quantity(q).unit != "1")
    return (name, unit) if fits else None


def is_count(unit: str) -> bool:
    """Whether a unit means raw counts of an analogue-to-digital converter.

    >>> is_count("Counts"), is_count("N")
    (True, False)
    """
    return unit.lower() in keys_of("count")


def is_stroke_length(name: str) -> bool:
    """Whether a column name means the stroke length.

    >>> is_stroke_length("Stroke"), is_stroke_length("Set stroke length")
    (True, True)
    >>> is_stroke_length("Stroke No")
    False
    """
    stroke = key_pattern("stroke")
    return any(stroke.search(normalise_label(text)) for text in (name, without_role(name)))


def is_stroke_frequency(name: str, unit: str | None) -> bool:
    """Whether a column name and its unit mean the stroke frequency.

    >>> is_stroke_frequency("Frequency", "Hz"), is_stroke_frequency("Speed", "mm/s")
    (True, False)
    """
    plain = normalise_label(without_role(name))
    # name first, as the conversion of a rare unit loads a slow library
    return bool(unit and key_pattern("frequency").search(plain) and converts(unit, "Hz"))


def is_date(name: str) -> bool:
    """Whether a column name means a date and nothing else, with or without the time of day.

    >>> is_date("Date and time"), is_date("Datum der Messung")
    (True, False)
    """
    return key_pattern("date_name").search(normalise_label(name)) is not None


def is_track_radius(name: str) -> bool:
    """Whether a normalised column name means the track radius.

    >>> is_track_radius("trackradius"), is_track_radius("radiomediodelapista")
    (True, True)
    >>> is_track_radius("ballradius")
    False
    """
    other = key_pattern("other_radius").search(name)
    return bool(key_pattern("track_radius").search(name) and not other)


def matches(name: str, unit: str | None, *, scan: bool = False) -> list[Match]:
    """Return the possible quantities of a column, the most likely first.

    Parameters
    ----------
    name
        Name of the column without its unit.
    unit
        Its unit; None if unknown. Quantities of other dimensions are left out; counts may be any
        quantity except a pure number.
    scan
        Whether the file contains a profile instead of a run.

    Examples
    --------
    >>> matches("Reibkraft", "N")[0].quantity, matches("T", "degC")[0].quantity
    ('friction_force', 'temperature')
    >>> matches("friction_torque", None), matches("mu_s", None)[0].quantity
    ([], 'friction_coefficient')
    """
    return list(_matches(name, unit, scan))


@functools.lru_cache(maxsize=8192)  # each rule asks about each column
def _matches(name: str, unit: str | None, scan: bool) -> tuple[Match, ...]:
    text = "mu" if _is_ratio(name) else normalise_label(name)
    device, of_device = device_of(name)
    own = normalise_label(of_device) if device else ""
    if not text or _NUMBERED.fullmatch(name.strip()):
        return ()
    options = []
    counted = unit is not None and is_count(unit)
    alone = unit is not None and not scan and not counted and _count_quantities(unit) == 1
    turns = unit is not None and not scan and converts(unit, "Hz")
    role = "" if scan else role_of(name)
    plain = normalise_label(without_role(name)) if role in ("set", "measured") else ""
    torque = unit is None and key_pattern("torque").search(text)  # "friction_torque" is no force
    for word in known_words("scan") if scan else known_words("run"):
        score = max(_score(text, word), _OF_DEVICE * _score(own, word) if own else 0.0)
        score = max(score, _score(plain, word) if plain else 0.0)
        known = quantity(word.quantity)
        read_as = (_OF_HEIGHTS if scan else _MEANT).get(known.unit, {}).get(unit or "")
        fits = unit is None or converts(read_as or unit, known.unit, known.bare)
        if torque and known.unit in _NO_TORQUE:
            continue
        if score and (known.unit != "1" if counted else fits):
            # a unit that only one quantity has identifies this quantity, whatever the name
            by_unit = alone or (turns and word.quantity == "rotation_speed")
            score = KNOWN_WORD + (1 - KNOWN_WORD) * score if by_unit else score
            meant = _AS_SET.get(word.quantity, word.quantity) if role == "set" else word.quantity
            options.append(Match(meant, score, read_as))
    if not scan and role != "set" and is_turns(unit or ""):
        options.append(Match("rotation_speed", KNOWN_WORD, None))
    if not scan and _ACROSS.search(name):  # "Z position" is perpendicular to the motion
        options = [m._replace(quantity=_INSTEAD.get(m.quantity, m.quantity)) for m in options]
    best: dict[str, Match] = {}
    for match in sorted(options, key=lambda match: -match.score):
        best.setdefault(match.quantity, match)
    return tuple(best.values())


def _is_ratio(name: str) -> bool:
    """Whether a column name is a ratio of the symbols of friction force and normal force.

    >>> _is_ratio("F_R/F_N"), _is_ratio("F / W"), _is_ratio("v/s")
    (True, True, False)
    """
    force, _, load = (normalise_label(part) for part in name.partition("/"))
    over = {word.quantity: word.symbols for word in known_words("run")}
    return force in (*over["friction_force"], "f") and load in (*over["normal_force"], "n")


@functools.lru_cache(maxsize=256)
def _count_quantities(unit: str) -> int:
    """Return how many quantities of a run can be in a given unit."""
    known = [quantity(word.quantity) for word in known_words("run")]
    return sum(converts(unit, kind.unit, kind.bare) for kind in known)


def _score(text: str, word: Word) -> float:
    term = _TERM if text in names(word.quantity) else 0.0
    if text in word.symbols:
        return max(term, 1.0 - min(0.01 * word.symbols.index(text), _LATE))
    if term:
        return term
    return max(_covered_share(text, word.stems), _VAGUE * _covered_share(text, word.vague))


def _covered_share(text: str, stems: tuple[str, ...]) -> float:
    """Return the share of the letters of a name that its longest known stem covers."""
    return max((len(stem) for stem in stems if stem in text), default=0) / len(text)
