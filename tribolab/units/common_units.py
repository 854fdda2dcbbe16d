"""Common units of instruments, converted without pint, which takes half a second to load."""

from __future__ import annotations

import math
import re

_PREFIXES = {"p": 1e-12, "n": 1e-9, "u": 1e-6, "\u00b5": 1e-6, "\u03bc": 1e-6, "m": 1e-3}
_PREFIXES |= {"c": 1e-2, "k": 1e3, "M": 1e6, "G": 1e9}
# Conversions that instruments need most often, stored here; the factors equal those of
# pint.
CONVERSIONS = {
    ("", "1"): (1.0, 0.0),
    ("-", "1"): (1.0, 0.0),
    ("%", "1"): (0.01, 0.0),
    ("percent", "1"): (0.01, 0.0),
    ("sec", "s"): (1.0, 0.0),
    ("min", "s"): (60.0, 0.0),
    ("micron", "m"): (1e-6, 0.0),
    ("microns", "m"): (1e-6, 0.0),
    ("gf", "N"): (0.00980665, 0.0),
    ("bar", "Pa"): (1e5, 0.0),
    ("dyne/cm²", "Pa"): (0.1, 0.0),
    ("Pa.s", "Pa s"): (1.0, 0.0),
    ("mPa.s", "Pa s"): (1e-3, 0.0),
    ("mPa s", "Pa s"): (1e-3, 0.0),
    ("°C", "K"): (1.0, 273.15),
    ("degC", "K"): (1.0, 273.15),
    ("deg", "rad"): (math.pi / 180, 0.0),
    ("turn", "rad"): (6.28318530717959, 0.0),
    ("g", "kg"): (1e-3, 0.0),
    ("kgf", "N"): (9.80665, 0.0),
    ("h", "s"): (3600.0, 0.0),
    ("N mm", "N m"): (1e-3, 0.0),
    ("Nmm", "N m"): (1e-3, 0.0),
    ("Nm", "N m"): (1.0, 0.0),
    ("mNm", "N m"): (1e-3, 0.0),
}


def prefix_factor(unit: str, si_unit: str) -> float | None:
    """Return the factor from a prefixed unit to its SI unit, e.g. 0.001 for mm/s; else None."""
    unit, si_unit = (text.replace("^2", "2").replace("²", "2") for text in (unit, si_unit))
    if unit == si_unit:
        return 1.0
    # excludes powers such as mm2, in which the prefix is squared too
    if re.fullmatch(r"(m|s|N|Pa|V|J)(/s|/m2| s)?", si_unit) and unit[1:] == si_unit:
        return _PREFIXES.get(unit[0])
    return None


# common units of instruments, and requested units (`_ASKED`) for which a mismatch is obvious
_EVERYDAY = re.compile(r"[pnu\u00b5\u03bcmckMG]?(s|m|N|Pa|V|m/s|Hz)")
_OF_TIME = frozenset(("Hz", "1/s", "rad/s"))  # targets to which a frequency may be converted
_ASKED = frozenset(
    ("", "1", "s", "m", "m2", "m3", "m4", "m/s", "m2/s", "1/m", "1/s", "Hz", "rad", "rad/s", "N")
    + ("N/m", "N/s", "N m", "N2 m", "J/m2", "Pa", "1/Pa", "Pa s", "V", "ohm", "K", "m/s**2")
    + ("m**2", "m**3", "m**2/s", "m**3/s", "m**2/N", "W", "W/m**2", "A", "A s", "S", "farad")
    + ("kg", "kg/m**3", "S/m", "1/K", "T")
)


# further common units, each with the SI units that it may be converted to
_COMMON = {
    **dict.fromkeys(("g", "gram", "kg", "mg", "t"), ("kg",)),
    **dict.fromkeys(("gf", "kgf", "lbf"), ("N",)),
    **dict.fromkeys(("min", "h", "ms"), ("s",)),
    **dict.fromkeys(("K", "degC", "\u00b0C", "C", "degF"), ("K", "A s")),
    **dict.fromkeys(("mbar", "bar", "psi"), ("Pa",)),
    **dict.fromkeys(("in", "inch"), ("m",)),
    **dict.fromkeys(("mm/min", "m/min", "km/h", "in/s"), ("m/s",)),
    **dict.fromkeys(("turn", "turns", "rev", "revolutions", "rad", "deg"), ("", "1", "rad")),
    **dict.fromkeys(("1/min", "rpm", "rev/min", "rev/s", "1/s", "rad/s", "deg/s"), (*_OF_TIME,)),
    **dict.fromkeys(("N m", "Nm", "N*m", "N mm", "Nmm", "mNm", "N cm", "Ncm"), ("N m",)),
    **dict.fromkeys(("Pa s", "mPa s", "Pa*s", "mPa*s"), ("Pa s",)),
    **dict.fromkeys(("%", "percent"), ("", "1", "rad")),
}


def measures_another(unit: str, si_unit: str) -> bool:
    """Return whether a common unit obviously measures another quantity, without loading pint."""
    if unit in _COMMON and si_unit in _ASKED:
        return si_unit not in _COMMON[unit]
    everyday = _EVERYDAY.fullmatch(unit)
    if everyday is None or si_unit not in _ASKED:
        return False
    return everyday[1] != si_unit and not (everyday[1] == "Hz" and si_unit in _OF_TIME)
