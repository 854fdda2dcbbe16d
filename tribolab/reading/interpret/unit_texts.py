"""Texts that are units: of what an instrument records, or of anything else."""

from __future__ import annotations

import functools
import re

from tribolab.core.errors import TribolabError
from tribolab.units.conversion import conversion
from tribolab.units.reciprocals import Counted
from tribolab.units.spellings import WEIGHTS

# SI units of what an instrument records: a text that converts to one of them is a unit
DIMENSIONS = (
    *("s", "m", "N", "m/s", "1", "Pa", "K", "V", "1/s", "Hz", "rad/s", "Pa s", "N/m"),
    *("m/s**2", "N m"),
)
# what else files hold and no quantity of ours is: areas, volumes, wear rates, power, charges
_FURTHER = (
    *("ohm", "m**2", "m**3", "m**2/s", "m**3/s", "m**2/N", "W", "W/m**2", "A", "A s", "S"),
    *("farad", "kg", "kg/m**3", "S/m", "1/K", "T"),
)
_TURNS = re.compile(
    r"rpm|(?P<own>1/min|min-1)|(?:rev|r|U|tr|ot|obr|giri|omw|d|dev|devir)\.?/\s?(?P<time>min|s|dk|dak)",
    re.IGNORECASE,
)


def is_turns(unit: str) -> bool:
    """Whether a unit counts revolutions, whatever the name: rpm, U/min.

    >>> is_turns("U/min"), is_turns("1/min")
    (True, False)
    """
    turns = _TURNS.fullmatch(unit)
    return turns is not None and not turns["own"]


def is_per_minute(unit: str) -> bool:
    """Whether a unit counts something a minute.

    >>> is_per_minute("1/min"), is_per_minute("rev/s")
    (True, False)
    """
    turns = _TURNS.fullmatch(unit)
    return turns is not None and (turns["time"] or "").lower() != "s"


def is_unit(text: str) -> bool:
    """Whether a text is a unit of something that an instrument records.

    >>> is_unit("mm/sec"), is_unit("°C"), is_unit("Fx"), is_unit("3")
    (True, True, False, False)
    """
    return text in WEIGHTS or any(converts(text, dimension) for dimension in DIMENSIONS)


def measures_something(text: str) -> bool:
    """Whether a text in brackets is a unit, of whatever: then the column is in nothing else.

    >>> measures_something("mm³"), measures_something("N"), measures_something("left")
    (True, True, False)
    """
    if is_unit(text):
        return True
    letter = len(text) == 1 and text.isascii()  # of a channel rather than of amperes
    return not letter and any(converts(text, dimension) for dimension in _FURTHER)


# what is counted, and a length to printers alone
_COUNTED = frozenset({"point", "points", "pixel", "pixels", "dot", "dots", "line", "lines"})


@functools.lru_cache(maxsize=4096)  # a failed conversion is not remembered elsewhere
def converts(text: str, si_unit: str, bare: Counted | None = None) -> bool:
    """Whether a text is a unit that can be turned into an SI unit (`bare`: see `conversion`)."""
    if not text or re.fullmatch(r"[\d.,+]+", text) or text.lower() in _COUNTED:
        return False
    try:
        conversion(text, si_unit, bare)
    except TribolabError:
        return False
    return True
