"""Spellings of units in many languages, converted to pint's names."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import NamedTuple


class _Spellings(NamedTuple):
    """Pint's names of units by their spelling: as words, as signs, and as complete units."""

    words: dict[str, str]
    signs: dict[str, str]
    whole: dict[str, str]


def _load() -> _Spellings:
    text = Path(__file__).with_name("spellings.toml").read_text(encoding="utf-8")
    result = _Spellings({}, {}, {})
    for unit, forms in tomllib.loads(text).items():
        for form, spellings in forms.items():
            getattr(result, form).update(dict.fromkeys(spellings, unit))
    return result


MICRO = "\u00b5\u03bc"  # micro sign, and the Greek letter mu
_SPELT = _load()
_PREFIXES = {"nano": "n", "micro": "u", "milli": "m", "kilo": "k"}
_APART = re.compile(rf"(?i:(?P<prefix>{'|'.join(_PREFIXES)}))[\s-]+(?=(?:N|Pa|V|A|g|m|s)(?![a-z]))")
_WRITTEN = re.compile(
    r"(?i)(?P<prefix>nano|micro|milli|centi|kilo|mega|giga)?(?P<unit>met(?:er|re)|newton|pascal|"
    r"volt|hertz|second|minute|hour|inch|angstr(?:o|ö|oe|ø)m|ångstr(?:ö|o)m|radian|degree)(?:e?s)?"
)
_WRITTEN_AS = {"metre": "meter"} | dict.fromkeys(
    ("angström", "angstroem", "angstrøm", "ångström", "ångstrom"), "angstrom"
)
_NAME = re.compile(r"[°]?[^\W\d_]+|℃|℉")
# units of mass that are used as forces, also in torques
WEIGHTS = {"g": "gf", "kg": "kgf", "lb": "lbf", "lbs": "lbf", "oz": "ozf"}
_ON_ARM = WEIGHTS | {"lbf": "lbf", "ozf": "ozf", "kgf": "kgf", "gf": "gf", "kp": "kgf"}
_ARM = r"(?P<arm>mm|cm|m|in|inch|ft)"
_WEIGHT = rf"(?P<weight>{'|'.join(sorted(_ON_ARM, key=len, reverse=True))})"
_TIMES = r"\s?[-·⋅・∙•.* ]?\s?"
_TORQUES = tuple(
    re.compile(form) for form in (rf"{_WEIGHT}{_TIMES}{_ARM}", rf"{_ARM}{_TIMES}{_WEIGHT}")
)


def unit_in_words(text: str) -> str:
    """Return the unit that a word or a sign means; unknown text is returned unchanged.

    >>> unit_in_words("Sekunden"), unit_in_words("kN"), unit_in_words("MM/sec.")
    ('s', 'kN', 'mm/sec.')
    """
    if known := _SPELT.signs.get(text) or _SPELT.words.get(text.lower()):
        return known
    over, slash, under = text.partition("/")
    return f"{unit_in_words(over)}/{unit_in_words(under)}" if slash and over and under else text


def plain_unit(unit: str) -> str:
    """Return a unit with pint's names instead of other spellings.

    Examples
    --------
    >>> plain_unit("kOhm"), plain_unit("deg C"), plain_unit("мм/с"), plain_unit("lb-in")
    ('kohm', 'degC', 'mm/s', 'lbf*in')
    >>> plain_unit("mm/s"), plain_unit("Fx"), plain_unit("micro N.m")
    ('mm/s', 'Fx', 'uN.m')
    """
    text = unit.strip().replace("\u00b5", "u").replace("\u03bc", "u")
    if text in _SPELT.whole:
        return _SPELT.whole[text]
    if (apart := _APART.match(text)) is not None:
        text = _PREFIXES[apart["prefix"].lower()] + text[apart.end() :]
    for form in _TORQUES:
        if (torque := form.fullmatch(text)) and torque["arm"] + torque["weight"] != "mg":
            return f"{_ON_ARM[torque['weight']]}*{torque['arm']}"
    text = re.sub("(?<=/)Nm$", "(N*m)", text)
    return _NAME.sub(lambda name: _full_name(unit_in_words(name[0])), text)


_LENGTHS = {
    **{unit: unit for unit in ("m", "cm", "mm", "um", "nm", "pm", "angstrom", "inch", "thou")},
    **{"\u00c5": "angstrom", "in": "inch", "microinch": "microinch", "meter": "m"},
    **{"centimeter": "cm", "millimeter": "mm", "micrometer": "um", "nanometer": "nm"},
}


def unit_of_length(text: str) -> str:
    """Return the unit of length that a text consists of; "" for any other text.

    >>> unit_of_length("[nm]"), unit_of_length("Mikrometer"), unit_of_length("MM")
    ('nm', 'um', 'mm')
    >>> unit_of_length("nm per step"), unit_of_length("N"), unit_of_length("Å")
    ('', '', 'angstrom')
    """
    bare = text.strip(" \t[](){}.,;\"'").replace("\u212b", "\u00c5")
    return next((_LENGTHS[u] for u in map(plain_unit, (bare, bare.lower())) if u in _LENGTHS), "")


def _full_name(name: str) -> str:
    """Return the pint name of a unit that is written out in full.

    >>> _full_name("Nanometres"), _full_name("INCHES"), _full_name("Ångström"), _full_name("Fx")
    ('nanometer', 'inch', 'angstrom', 'Fx')
    """
    match = _WRITTEN.fullmatch(name)
    if match is None:
        return name
    unit = match["unit"].lower()
    return (match["prefix"] or "").lower() + _WRITTEN_AS.get(unit, unit)
