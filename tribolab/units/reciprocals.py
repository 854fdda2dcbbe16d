"""Units per time or length. SI does not distinguish cycles and radians, but conversion must.

``1/min`` of a rotation speed counts turns, ``1/s`` of a shear rate counts nothing, and ``1/s`` of
an angular frequency is ambiguous. The quantity defines the meaning of a bare reciprocal
(`tribolab.units.quantities`); if both are possible, an error asks for the
meaning.
"""

from __future__ import annotations

import functools
import math
import re
from typing import Literal, NamedTuple

from tribolab.core.errors import UnitError, shown

Counted = Literal["cycles", "radians", "nothing", "ask"]

_SECONDS = {"s": 1.0, "sec": 1.0, "secs": 1.0, "second": 1.0, "seconds": 1.0, "sek": 1.0}
_SECONDS |= {"ms": 1e-3, "msec": 1e-3, "us": 1e-6, "usec": 1e-6, "ns": 1e-9, "ks": 1e3}
_SECONDS |= dict.fromkeys(("min", "mins", "minute", "minutes", "dk", "dak", "dakika"), 60.0)
_SECONDS |= dict.fromkeys(("h", "hr", "hrs", "hour", "hours"), 3600.0)
_SECONDS |= dict.fromkeys(("d", "day", "days"), 86400.0)
_METRES = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "cm": 1e-2, "dm": 0.1, "km": 1e3}
_METRES |= {"micron": 1e-6, "microns": 1e-6, "in": 0.0254, "inch": 0.0254, "mil": 2.54e-5}
_LENGTHS = {**dict.fromkeys(_SECONDS, "s"), **dict.fromkeys(_METRES, "m")}
_PER = _SECONDS | _METRES

# turns per minute in several languages: U/min, tr/min, giri/min, ob/min, omw/min
_CYCLES = set(
    "r rev revs revolution revolutions rot rots rotation rotations turn turns cycle cycles cyc "
    "u umdr umdrehung umdrehungen tr tour tours giro giri ob obr omw varv period periods "
    "oscillation oscillations osc lp d dev devir o omdr".split()
)
_RADIANS = dict.fromkeys(("rad", "rads", "radian", "radians"), 1.0) | {"mrad": 1e-3, "urad": 1e-6}
_RADIANS |= dict.fromkeys(("deg", "degs", "degree", "degrees", "°"), math.pi / 180)
_RADIANS |= {"gon": math.pi / 200}
_WORDS = {"rpm": 1 / 60, "upm": 1 / 60, "cpm": 1 / 60, "rps": 1.0, "cps": 1.0, "krpm": 1e3 / 60}
_HERTZ = re.compile(r"([numkMGT]?)(?:Hz|HZ|hz|hertz|Hertz)")
_DECIMAL = {"": 1.0, "n": 1e-9, "u": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9, "T": 1e12}

_SIGNS = str.maketrans(
    {"⁻": "-", "−": "-", "–": "-", "¹": "1", "⁄": "/", "∕": "/", "·": " ", "⋅": " ", "*": " "}
    | {"µ": "u", "μ": "u", "\u00a0": " ", "_": " "}
)
_COUNT = r"(?P<count>1|[a-z°]*\.?)"
_FORMS = (
    re.compile(rf"{_COUNT} ?(?:/|\bper\b|\bp\.) ?\(?(?P<per>[a-z]+)\.?\)?"),
    re.compile(rf"(?:{_COUNT}[ .])? ?(?P<per>[a-z]+) ?\^? ?[({{]?-1[)}}]?"),
)


class Reciprocal(NamedTuple):
    """Unit per time or length: its factor, what it counts, and "s" or "m"."""

    scale: float
    counts: Literal["cycles", "radians", "bare"]
    per: str


@functools.lru_cache(maxsize=512)
def reciprocal(unit: str) -> Reciprocal | None:
    """Return a parsed unit per time or length; None for other units.

    Examples
    --------
    >>> reciprocal("U/min")
    Reciprocal(scale=0.016666666666666666, counts='cycles', per='s')
    >>> reciprocal("rad/s").counts, reciprocal("min⁻¹").counts, reciprocal("mm/s")
    ('radians', 'bare', None)
    """
    text = unit.replace("**", "^").translate(_SIGNS).strip().strip("[]").strip()
    text = re.sub(r"\s+", " ", text)
    if hertz := _HERTZ.fullmatch(text):
        return Reciprocal(_DECIMAL[hertz[1]], "cycles", "s")
    small = text.lower()
    if (word := small.replace(".", "")) in _WORDS:
        return Reciprocal(_WORDS[word], "cycles", "s")
    for form in _FORMS:
        match = form.fullmatch(small)
        if match and match["per"] in _PER:
            return _parse_parts(match["count"] or "", match["per"])
    return None


def _parse_parts(count: str, per: str) -> Reciprocal | None:
    name, scale = count.rstrip("."), 1 / _PER[per]
    if name in ("", "1"):
        return Reciprocal(scale, "bare", _LENGTHS[per])
    if name in _CYCLES:
        return Reciprocal(scale, "cycles", _LENGTHS[per])
    if name in _RADIANS:
        return Reciprocal(scale * _RADIANS[name], "radians", _LENGTHS[per])
    return None


def counts_turns(unit: str) -> bool:
    """Return whether a unit is just a word for turns or cycles.

    Examples
    --------
    >>> counts_turns("cycles"), counts_turns("Umdr."), counts_turns("rad")
    (True, True, False)
    """
    return unit.strip().rstrip(".").lower() in _CYCLES


def usual_reading(si_unit: str) -> Counted:
    """Return what a bare unit such as 1/s counts if the quantity is unknown; "ask" if ambiguous.

    Examples
    --------
    >>> usual_reading("Hz"), usual_reading("rad/s"), usual_reading("1/m"), usual_reading("1/s")
    ('cycles', 'ask', 'radians', 'nothing')
    """
    usual: dict[str, Counted] = {"Hz": "cycles", "rad/s": "ask", "1/m": "radians"}
    return usual.get(si_unit, "nothing")


def scale_of_reciprocal(unit: str, si_unit: str, bare: Counted) -> float | None:
    """Return the factor to SI of a unit per time or length; None for other units.

    Parameters
    ----------
    unit, si_unit
        The unit as written, and the requested one.
    bare
        Meaning of a unit that names neither cycles nor radians.

    Raises
    ------
    UnitError
        If the unit is ambiguous, or counts something else than the quantity.

    Examples
    --------
    >>> round(scale_of_reciprocal("1/min", "rad/s", "cycles"), 6)
    0.10472
    """
    wanted, given = reciprocal(si_unit), reciprocal(unit)
    if wanted is None or given is None or wanted.per != given.per:
        return None
    counts = bare if given.counts == "bare" else given.counts
    into = bare if wanted.counts == "bare" else wanted.counts
    if counts == "ask":
        per = re.sub(r"[^A-Za-z]", "", unit) or "s"
        raise UnitError(
            f"'{shown(unit)}' may count cycles or radians, a factor of 2 pi apart; "
            f"write 'cycles/{per}' or 'rad/{per}'"
        )
    if "nothing" in (counts, into) and counts != into:
        raise UnitError(f"'{shown(unit)}' counts {counts}, but what is wanted counts {into}")
    turn = {("cycles", "radians"): 2 * math.pi, ("radians", "cycles"): 0.5 / math.pi}
    return given.scale * turn.get((counts, into), 1.0)


_ANGLES = re.compile(
    r"(?<![a-z])[kmgnuµ]?(rad|radians?|deg|degrees?|°|rev|revolutions?|turns?|cycles?|rpm|rps|hz"
    r"|hertz)(?![a-z])",
    re.IGNORECASE,
)


def contains_angle(unit: str) -> bool:
    """Return whether a unit contains cycles or an angle, which pint treats as pure numbers.

    Examples
    --------
    >>> contains_angle("rad s/m"), contains_angle("°C"), contains_angle("degC")
    (True, False, False)
    """
    return _ANGLES.search(unit) is not None
