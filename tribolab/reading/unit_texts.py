"""Recognition of texts that are units, of recorded or other quantities."""

from __future__ import annotations

import functools
import re

from tribolab.core.errors import TribolabError
from tribolab.units.conversion import conversion
from tribolab.units.reciprocals import Counted
from tribolab.units.spellings import WEIGHTS

# SI units of recorded quantities: a text that converts to one of them is a unit
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
    """Whether a unit counts something per minute.

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
    """Whether a text in brackets is a unit of any quantity, and so that of the column.

    >>> measures_something("mm³"), measures_something("N"), measures_something("left")
    (True, True, False)
    """
    if is_unit(text):
        return True
    letter = len(text) == 1 and text.isascii()  # more likely a channel than amperes
    return not letter and any(converts(text, dimension) for dimension in _FURTHER)


# counted things, and a length used only by printers
_COUNTED = frozenset({"point", "points", "pixel", "pixels", "dot", "dots", "line", "lines"})


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
