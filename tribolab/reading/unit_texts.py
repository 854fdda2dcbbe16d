"""Recognition of units in text, also at the end of keys: "contact_radius_mm"."""

from __future__ import annotations

import functools
import re

from tribolab.core.errors import TribolabError
from tribolab.units.conversion import conversion
from tribolab.units.reciprocals import Counted
from tribolab.units.spellings import WEIGHTS

# SI units of recorded quantities; text is taken as a unit if it converts to any of them
DIMENSIONS = (
    *("s", "m", "N", "m/s", "1", "Pa", "K", "V", "1/s", "Hz", "rad/s", "Pa s", "N/m"),
    *("m/s**2", "N m"),
)
# dimensions of other columns in files: areas, volumes, wear rates, power, charges
_FURTHER = (
    *("ohm", "m**2", "m**3", "m**2/s", "m**3/s", "m**2/N", "W", "W/m**2", "A", "A s", "S"),
    *("farad", "kg", "kg/m**3", "S/m", "1/K", "T"),
)
_TURNS = re.compile(
    r"rpm|(?P<own>1/min|min-1)|(?:rev|r|U|tr|ot|obr|giri|omw|d|dev|devir)\.?/\s?(?P<time>min|s|dk|dak)",
    re.IGNORECASE,
)


def is_turns(unit: str) -> bool:
    """Whether a unit counts revolutions, in any notation: rpm, U/min.

    >>> is_turns("U/min"), is_turns("1/min")
    (True, False)
    """
    turns = _TURNS.fullmatch(unit)
    return turns is not None and not turns["own"]


def is_per_minute(unit: str) -> bool:
    """Whether a unit is a number per minute, such as revolutions or 1/min.

    >>> is_per_minute("1/min"), is_per_minute("rev/s")
    (True, False)
    """
    turns = _TURNS.fullmatch(unit)
    return turns is not None and (turns["time"] or "").lower() != "s"


def is_unit(text: str) -> bool:
    """Whether a text is a unit of a recorded quantity.

    >>> is_unit("mm/sec"), is_unit("°C"), is_unit("Fx"), is_unit("3")
    (True, True, False, False)
    """
    return text in WEIGHTS or any(converts(text, dimension) for dimension in DIMENSIONS)


def measures_something(text: str) -> bool:
    """Whether a text in brackets is a unit of any quantity, recorded by tribolab or not.

    >>> measures_something("mm³"), measures_something("N"), measures_something("left")
    (True, True, False)
    """
    if is_unit(text):
        return True
    letter = len(text) == 1 and text.isascii()  # "A" is more likely a channel than amperes
    return not letter and any(converts(text, dimension) for dimension in _FURTHER)


# not units here: counted things, and "mass", which pint reads as milliarcseconds
_COUNTED = frozenset({"point", "points", "pixel", "pixels", "dot", "dots", "line", "lines", "mass"})


@functools.lru_cache(maxsize=4096)  # failed conversions are not cached elsewhere
def converts(text: str, si_unit: str, bare: Counted | None = None) -> bool:
    """Whether a text is a unit that converts to an SI unit (`bare`: see `conversion`)."""
    if not text or re.fullmatch(r"[\d.,+]+", text) or text.lower() in _COUNTED:
        return False
    try:
        conversion(text, si_unit, bare)
    except TribolabError:
        return False
    return True


_LOWER_CASE_UNITS = {"hz": "Hz", "khz": "kHz", "n": "N", "mn": "mN", "kn": "kN"}  # in keys
_NO_UNIT = frozenset(("percent", "%", "-", "1"))


def is_unit_of_key(text: str) -> bool:
    """Whether the last part of a key, such as "mm" in "radius_mm", is a unit.

    >>> is_unit_of_key("mm/s"), is_unit_of_key("degC"), is_unit_of_key("raw"), is_unit_of_key("3")
    (True, True, False, False)
    """
    if text.lower() in _NO_UNIT or text == "A" or converts(text, "rad"):
        return True
    return measures_something(text) and not converts(text, "1")


def without_unit(key: str) -> tuple[str, str]:
    """Split a key into name and unit suffix.

    >>> without_unit("contact_radius_mm"), without_unit("speed_mm_s"), without_unit("stroke")
    (('contact_radius', 'mm'), ('speed', 'mm/s'), ('stroke', ''))
    >>> without_unit("sample_rate_hz")
    ('sample_rate', 'Hz')
    """
    words = key.split("_")
    for count, mark in ((2, "/"), (1, "")):
        unit = mark.join(words[-count:])
        unit = _LOWER_CASE_UNITS.get(unit, unit)
        if len(words) > count and is_unit_of_key(unit):
            return "_".join(words[:-count]), unit
    return key, ""
